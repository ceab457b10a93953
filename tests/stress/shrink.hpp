// A failing case made small: parts of the tree, transforms, numbers, rays of the bundle and numbers of the rays are taken away as
// long as what is left still fails.
#pragma once
#include "judge.hpp"
#include "smaller.hpp"


namespace stress {
// Rays that are asked together, on the work of an instruction set.
struct Asked {
  std::vector<Ray> rays;
  int way = One, isa = 2;
  GridPart grid{}; // whose rays they are, when it is asked
};
struct Case {
  Spec spec;
  std::vector<Ray> rays;
  int way = One, isa = 2;
  uint64_t spots_seed = 0;
  GridPart grid{};
  std::vector<Asked> before{}; // what was asked on the same works first, where that matters
};

// The first ray that is answered wrong for certain, or -1.
inline int first_wrong(const Case &c, std::string *said = nullptr) {
  try {
    Bench b(c.spec, c.spots_seed);
    for (auto &a : c.before) ask_rays(b.model, b.work(a.isa), a.rays, a.way, a.grid);
    auto replies = ask_rays(b.model, b.work(c.isa), c.rays, c.way, c.grid);
    for (size_t i = 0; i < c.rays.size(); i++) {
      size_t rounded = 0;
      b.aim_quick(c.rays[i]);
      Verdict v = b.judge_quick(c.rays[i], replies[i], c.way, rounded);
      if (v == Right) continue;
      b.aim_exact(c.rays[i]);
      if (b.judge_exact(c.rays[i], replies[i], c.way, rounded) != Wrong) continue;
      if (said) {
        std::ostringstream w;
        w.precision(17);
        w << "status " << quoin_status_text(replies[i].answer.status);
        if (is_hit(c.way)) w << ", found " << replies[i].hit.found << " t " << replies[i].hit.t << " leaving " << replies[i].hit.leaving;
        else {
          for (auto &p : replies[i].answer.inside) w << ", inside " << p.enter.t << (p.enter.part ? "" : " (cut)") << " to " << p.leave.t << (p.leave.part ? "" : " (cut)");
          for (auto &p : replies[i].answer.boundary) w << ", boundary " << p.enter.t << " to " << p.leave.t;
        }
        w << "\n// should be:";
        const Answer &a = b.exact_answer;
        for (size_t k = 0; k < a.what.size(); k++) {
          if (k) w << " | " << CGAL::to_double(a.cuts[k - 1]) << " |";
          w << (a.what[k] == Answer::Inside ? " inside" : a.what[k] == Answer::On ? " boundary" : " outside");
        }
        *said = w.str();
      }
      return (int)i;
    }
  } catch (const std::exception &) {
  }
  return -1;
}

inline void shrink(Case &c, double seconds) {
  const double end = now() + seconds;
  auto fails = [&](const Case &x) { return first_wrong(x) >= 0; };
  auto keep = [&](Case x) { // the case becomes x if that fails too
    if (now() > end || !fails(x)) return false;
    c = std::move(x);
    return true;
  };
  for (size_t half = c.before.size() / 2 + 1; half > 0 && !c.before.empty(); half /= 2)
    for (size_t i = 0; i + half <= c.before.size();) {
      Case x = c;
      x.before.erase(x.before.begin() + (long)i, x.before.begin() + (long)(i + half));
      if (!keep(x)) i += half;
    }
  for (int way : {(int)One, (int)Hit}) { // the grid's rays, if asked alone they fail
    Case x = c;
    x.way = way;
    if (is_grid(c.way)) keep(x);
  }
  for (bool again = is_grid(c.way); again && now() < end;) { // else a smaller grid, plainer
    again = false;
    auto edit = [&](const std::function<void(GridPart &)> &f) {
      Case x = c;
      f(x.grid);
      x.rays = rays_of(x.grid);
      for (auto &ray : x.rays)
        if (ray.d[0] == 0 && ray.d[1] == 0 && ray.d[2] == 0) return;
      if (memcmp(&x.grid, &c.grid, sizeof x.grid) != 0 && !x.rays.empty() && keep(x)) again = true;
    };
    edit([](GridPart &g) { g.x1 -= (g.x1 - g.x0) / 2; });
    edit([](GridPart &g) { g.x0 += (g.x1 - g.x0) / 2; });
    edit([](GridPart &g) { g.y1 -= (g.y1 - g.y0) / 2; });
    edit([](GridPart &g) { g.y0 += (g.y1 - g.y0) / 2; });
    edit([](GridPart &g) { g.of.from = -INFINITY; });
    edit([](GridPart &g) { g.of.to = INFINITY; });
    for (int k = 0; k < 12; k++)
      edit([k](GridPart &g) { (k < 3 ? g.of.o : k < 6 ? g.of.d : k < 9 ? g.of.u : g.of.v)[k % 3] = 0; });
    again = smaller(c.spec, [&](const Spec &s) {
              Case x = c;
              x.spec = s;
              return keep(x);
            }) || again;
  }
  if (is_grid(c.way)) return;
  { // one ray alone, if that fails; a plainer way to ask
    int w = first_wrong(c);
    if (w < 0) return;
    Case x = c;
    x.rays = {c.rays[(size_t)w]};
    if (!keep(x))
      for (size_t half = c.rays.size() / 2; half > 0; half /= 2)
        for (size_t i = 0; i + half <= c.rays.size() && c.rays.size() > half;) {
          x = c;
          x.rays.erase(x.rays.begin() + (long)i, x.rays.begin() + (long)(i + half));
          if (!keep(x)) i += half;
        }
    for (int way : {(int)One, (int)Hit}) {
      x = c;
      x.way = way;
      if (c.way != One && c.way != way) keep(x);
    }
  }
  for (bool again = true; again && now() < end;) {
    again = smaller(c.spec, [&](const Spec &s) {
      Case x = c;
      x.spec = s;
      return keep(x);
    });
    for (size_t i = 0; i < c.rays.size() && c.rays.size() <= 8; i++) {
      auto edit = [&](const std::function<void(Ray &)> &f) {
        Case x = c;
        f(x.rays[i]);
        const Ray &a = x.rays[i], &b = c.rays[i];
        bool same = memcmp(&a, &b, sizeof a) == 0, still = a.d[0] == 0 && a.d[1] == 0 && a.d[2] == 0;
        if (!same && !still && a.from <= a.to && keep(x)) again = true;
      };
      edit([](Ray &r) { r.from = -INFINITY; });
      edit([](Ray &r) { r.to = INFINITY; });
      for (int k = 0; k < 6; k++) {
        auto at = [k](Ray &r) -> double & { return k < 3 ? r.o[k] : r.d[k - 3]; };
        edit([&](Ray &r) { at(r) = 0; });
        for (int bits : {1, 4, 12, 24})
          edit([&](Ray &r) {
            int e;
            double m = std::frexp(at(r), &e);
            at(r) = std::ldexp(std::nearbyint(std::ldexp(m, bits)), e - bits);
          });
      }
    }
  }
}

// --- points ----------------------------------------------------------------------------------------------------------

struct Points {
  Spec spec;
  std::vector<V> at; // as decimals one by one, or as doubles in a batch
  bool text = false;
  int isa = 2;
  uint64_t spots_seed = 0;
};
inline quoin_status ask_points(const Bench &b, const Points &c, std::vector<quoin_side> &said) {
  said.assign(c.at.size(), QUOIN_OUTSIDE);
  if (!c.text) {
    std::vector<double> x;
    for (auto &p : c.at)
      for (auto &e : p) x.push_back(CGAL::to_double(e));
    return quoin_point_sides(b.model.scene, b.work(c.isa), c.at.size(), x.data(), said.data());
  }
  quoin_status s = QUOIN_OK;
  for (size_t i = 0; i < c.at.size() && s == QUOIN_OK; i++) {
    std::string d[3];
    const char *t[3];
    for (size_t k = 0; k < 3; k++) d[k] = decimal(c.at[i][k]), t[k] = d[k].c_str();
    s = quoin_point_side_text(b.model.scene, b.model.work, t, &said[i]);
  }
  return s;
}
// The first point that is answered wrong, or -1.
inline int first_wrong(const Points &c, std::string *words = nullptr) {
  static const char *const sides[] = {"outside", "boundary", "inside"};
  try {
    Bench b(c.spec, c.spots_seed);
    std::vector<quoin_side> said;
    quoin_status status = ask_points(b, c, said);
    for (size_t i = 0; i < c.at.size(); i++) {
      const char *hard = nullptr, *why = nullptr;
      int should = b.side(c.at[i], false, &hard, &why);
      if (should < 0 || (status == QUOIN_OK && (said[i] == should || (said[i] == QUOIN_BOUNDARY && Bench::may_be_undecided(hard))))) continue;
      if (words) *words = std::string(quoin_status_text(status)) + ", " + sides[said[i]] + ", should be " + sides[should];
      return (int)i;
    }
  } catch (const std::exception &) {
  }
  return -1;
}
inline void shrink(Points &c, double seconds) {
  const double end = now() + seconds;
  auto keep = [&](Points x) {
    if (now() > end || first_wrong(x) < 0) return false;
    c = std::move(x);
    return true;
  };
  int w = first_wrong(c);
  if (w < 0) return;
  Points x = c;
  x.at = {c.at[(size_t)w]};
  if (!keep(x))
    for (size_t half = c.at.size() / 2; half > 0; half /= 2)
      for (size_t i = 0; i + half <= c.at.size() && c.at.size() > half;) {
        x = c;
        x.at.erase(x.at.begin() + (long)i, x.at.begin() + (long)(i + half));
        if (!keep(x)) i += half;
      }
  for (bool again = true; again && now() < end;) {
    again = smaller(c.spec, [&](const Spec &s) {
      Points y = c;
      y.spec = s;
      return keep(y);
    });
    for (size_t i = 0; i < c.at.size() && c.at.size() <= 8; i++)
      for (size_t k = 0; k < 3; k++)
        for (const Q &to : {Q(0), whole(c.at[i][k])})
          if (c.at[i][k] != to && c.at[i][k] != 0) {
            Points y = c;
            y.at[i][k] = to;
            again = keep(y) || again;
          }
  }
}
inline std::string report(const Points &c, const std::string &again) {
  std::ostringstream w;
  std::string said;
  int wrong = first_wrong(c, &said);
  w << "// wrong side of a point\n// again: " << again << "\n// asked: " << (c.text ? "quoin_point_side_text" : "quoin_point_sides") << ", " << c.at.size() << " points, the wrong one is number " << wrong << "\n";
  w << "// QUOIN_ISA=" << ISAS[c.isa] << "\n";
  for (auto &p : c.at) w << "// point " << decimal(p[0]) << " " << decimal(p[1]) << " " << decimal(p[2]) << "\n";
  w << "// quoin says: " << said << "\n" << text_of(c.spec);
  return w.str();
}

// The file to keep: the model, with the rays in comments.
inline std::string report(const Case &c, const std::string &title, const std::string &again) {
  std::ostringstream w;
  std::string said;
  int wrong = first_wrong(c, &said);
  w << "// " << title << "\n// again: " << again << "\n// asked: " << WAYS[c.way] << ", " << c.rays.size() << " rays, the wrong one is number " << wrong << "\n";
  w << "// QUOIN_ISA=" << ISAS[c.isa] << "\n";
  w.precision(17);
  if (is_grid(c.way)) {
    const quoin_grid &g = c.grid.of;
    const std::pair<const char *, const double *> all[] = {{"o", g.o}, {" u", g.u}, {" v", g.v}, {" d", g.d}};
    w << "// grid ";
    for (auto &a : all) w << a.first << " " << a.second[0] << " " << a.second[1] << " " << a.second[2];
    w << " of " << g.width << " x " << g.height << (g.converging ? ", converging" : "") << ": columns " << c.grid.x0 << " to " << c.grid.x1 << ", rows " << c.grid.y0 << " to " << c.grid.y1 << "\n";
  }
  auto list = [&](const std::vector<Ray> &rays) {
    for (auto &r : rays) {
      w << "// ray";
      for (double v : r.o) w << " " << v;
      for (double v : r.d) w << " " << v;
      w << "  from " << r.from << " to " << r.to << "\n";
    }
  };
  list(c.rays);
  for (auto &a : c.before) {
    w << "// asked before on the work of " << ISAS[a.isa] << ": " << WAYS[a.way] << ", " << a.rays.size() << " rays\n";
    list(a.rays);
  }
  w << "// quoin says: " << said << "\n" << text_of(c.spec);
  return w.str();
}
} // namespace stress
