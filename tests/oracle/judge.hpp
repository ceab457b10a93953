// Asks quoin and the evaluator the same ray and compares: the stretches, their order, and every printed parameter.
#pragma once
#include "evaluate.hpp"

#include "quoin/quoin.h"

#include <cstdio>
#include <cstring>

namespace oracle {
struct Model {
  quoin_model *model = nullptr;
  quoin_scene *scene = nullptr;
  quoin_work *work = nullptr;
  explicit Model(const std::string &text) {
    if (quoin_model_new(nullptr, &model) != QUOIN_OK) throw std::runtime_error("no model");
    quoin_status s = quoin_model_read_text(model, QUOIN_ROOT, "oracle", text.data(), text.size(), nullptr);
    if (s == QUOIN_OK) s = quoin_scene_compile(model, nullptr, &scene);
    if (s == QUOIN_OK) s = quoin_work_new(scene, &work);
    if (s != QUOIN_OK) {
      for (size_t i = 0; i < quoin_model_diag_count(model); i++) {
        quoin_diag d;
        char line[2000];
        quoin_model_diag(model, i, &d);
        quoin_diag_format(&d, line, sizeof line);
        fputs(line, stderr);
      }
      throw std::runtime_error(std::string("model refused: ") + quoin_status_text(s) + "\n" + text);
    }
  }
  ~Model() { quoin_work_free(work), quoin_scene_free(scene), quoin_model_free(model); }
  Model(const Model &) = delete;
  Model &operator=(const Model &) = delete;
};

struct Stretch { double from, to; };

// What quoin says of the line o + t d, given as decimals.
struct Said {
  quoin_status status;
  std::vector<Stretch> inside, boundary;
};
inline Said ask(const Model &m, const V &o, const V &d, unsigned want = QUOIN_WANT_BOUNDARY) {
  std::string s[6];
  const char *p[6];
  for (int i = 0; i < 6; i++) s[i] = decimal(i < 3 ? o[i] : d[i - 3]), p[i] = s[i].c_str();
  quoin_intervals a;
  Said out;
  out.status = quoin_ray_intervals_text(m.scene, m.work, p, nullptr, nullptr, want, &a);
  if (out.status != QUOIN_OK) return out;
  for (size_t i = 0; i < a.count; i++) out.inside.push_back({a.inside[i].enter.t, a.inside[i].leave.t});
  for (size_t i = 0; i < a.boundary_count; i++) out.boundary.push_back({a.boundary[i].enter.t, a.boundary[i].leave.t});
  return out;
}

inline bool agrees(const Answer &a, Answer::What what, const std::vector<Stretch> &said) {
  size_t k = 0;
  for (size_t i = 0; i < a.what.size(); i++) {
    if (a.what[i] != what) continue;
    if (k == said.size()) return false;
    const Stretch &s = said[k++];
    if (i == 0 ? s.from != -INFINITY : !nearest(s.from, a.cuts[i - 1])) return false;
    if (i == a.cuts.size() ? s.to != INFINITY : !nearest(s.to, a.cuts[i])) return false;
  }
  return k == said.size();
}

inline void print(const Answer &a) {
  for (size_t i = 0; i < a.what.size(); i++) {
    if (i) fprintf(stderr, " | %.17g | ", CGAL::to_double(a.cuts[i - 1]));
    fputs(a.what[i] == Answer::Inside ? "inside" : a.what[i] == Answer::On ? "ON" : "outside", stderr);
  }
  fputc('\n', stderr);
}
inline void print(const Said &s) {
  for (auto &i : s.inside) fprintf(stderr, "  inside %.17g %.17g\n", i.from, i.to);
  for (auto &i : s.boundary) fprintf(stderr, "  ON %.17g %.17g\n", i.from, i.to);
}

// 1 right, 0 wrong (said aloud), -1 not judged. a: the oracle's answer.
inline int judge(const Node &solid, const Answer &a, const Model &m, const V &o, const V &d, const char *kind) {
  if (a.skipped) return -1;
  Said s = ask(m, o, d);
  if (s.status == QUOIN_OK && agrees(a, Answer::Inside, s.inside) && agrees(a, Answer::On, s.boundary)) return 1;
  fprintf(stderr, "WRONG (%s), status %s\nray %s %s %s %s %s %s\nquoin says\n", kind, quoin_status_text(s.status), decimal(o[0]).c_str(), decimal(o[1]).c_str(),
          decimal(o[2]).c_str(), decimal(d[0]).c_str(), decimal(d[1]).c_str(), decimal(d[2]).c_str());
  print(s);
  fprintf(stderr, "the oracle says: ");
  print(a);
  fprintf(stderr, "model:\n%s\n", solid.text.c_str());
  return 0;
}
} // namespace oracle
