// What quoin says of a ray or a point, asked in every way there is, against what it must say: the quick judge, or CGAL's exact numbers.
#pragma once
#include "grid.hpp"
#include "point.hpp"
#include "quick.hpp"
#include "ring.hpp"
#include "ulps.hpp"
#include "../oracle/judge.hpp"

namespace stress {
using oracle::Model; // the scene asked; from here on the name is this one

struct End { double t; bool part; };
struct Piece { End enter, leave; };
struct Answer2 {
  quoin_status status = QUOIN_OK;
  std::vector<Piece> inside, boundary;
};
inline Answer2 copy(const quoin_intervals &a) {
  Answer2 r;
  auto end = [](const quoin_end &e) { return End{e.t, e.part != QUOIN_NO_PART}; };
  for (size_t i = 0; i < a.count; i++) r.inside.push_back({end(a.inside[i].enter), end(a.inside[i].leave)});
  for (size_t i = 0; i < a.boundary_count; i++) r.boundary.push_back({end(a.boundary[i].enter), end(a.boundary[i].leave)});
  return r;
}
inline quoin_ray plain(const Ray &r) { return {{r.o[0], r.o[1], r.o[2]}, {r.d[0], r.d[1], r.d[2]}, r.from, r.to}; }

// How a ray is asked.
enum Way { One, Many, ManyBoundary, Hits, Hit, Text, Spots, Blocked, ManyText, GridHits, GridIntervals, GridBoundary, Ways };
static const char *const WAYS[Ways] = {"quoin_ray_intervals", "quoin_ray_intervals_many", "quoin_ray_intervals_many with boundary", "quoin_first_hits", "quoin_first_hit", "quoin_ray_intervals_text",
                                        "quoin_first_spots", "quoin_rays_blocked", "quoin_ray_intervals_many_text", "quoin_grid_hits", "quoin_grid_intervals", "quoin_grid_intervals with boundary"};
inline bool is_hit(int way) { return way == Hits || way == Hit || way == Spots || way == Blocked || way == GridHits; }
inline bool is_grid(int way) { return way >= GridHits; }
struct Reply { Answer2 answer; quoin_hit hit{}; };

// Scratch that runs the wide code of one instruction set (or of the widest below it that this machine has).
static const char *const ISAS[] = {"sse2", "avx2", "avx512"};
struct Work {
  quoin_work *work = nullptr;
  Work(const Model &m, int isa) {
    setenv("QUOIN_ISA", ISAS[isa], 1);
    quoin_status s = quoin_work_new(m.scene, &work);
    unsetenv("QUOIN_ISA");
    if (s != QUOIN_OK) throw std::runtime_error("no work");
  }
  ~Work() { quoin_work_free(work); }
  Work(const Work &) = delete;
};

inline std::vector<Reply> ask_rays(const Model &model, quoin_work *work, const std::vector<Ray> &rays, int way, const GridPart &grid = GridPart()) { // grid: whose rays they are, when it is asked
  struct { quoin_scene *scene; quoin_work *work; } m{model.scene, work};
  std::vector<Reply> out(rays.size());
  std::vector<quoin_ray> q;
  for (auto &r : rays) q.push_back(plain(r));
  if (way == Many || way == ManyBoundary) {
    quoin_status s = quoin_ray_intervals_many(m.scene, m.work, q.size(), q.data(), way == ManyBoundary ? QUOIN_WANT_BOUNDARY : 0,
      [](void *user, size_t i, const quoin_intervals *a) {
        (*(std::vector<Reply> *)user)[i].answer = copy(*a);
        return 0;
      }, &out);
    if (s != QUOIN_OK)
      for (auto &o : out) o.answer.status = s;
  } else if (way == ManyText) { // one range for all
    std::vector<std::string> t;
    std::vector<const char *> p;
    for (auto &r : q)
      for (int k = 0; k < 6; k++) t.push_back(decimal(Q(k < 3 ? r.o[k] : r.d[k - 3])));
    for (auto &s : t) p.push_back(s.c_str());
    std::string from, to;
    if (std::isfinite(q[0].from)) from = decimal(Q(q[0].from));
    if (std::isfinite(q[0].to)) to = decimal(Q(q[0].to));
    quoin_status s = quoin_ray_intervals_many_text(m.scene, m.work, q.size(), p.data(), from.empty() ? nullptr : from.c_str(), to.empty() ? nullptr : to.c_str(), QUOIN_WANT_BOUNDARY,
      [](void *user, size_t i, const quoin_intervals *a) {
        (*(std::vector<Reply> *)user)[i].answer = copy(*a);
        return 0;
      }, &out);
    if (s != QUOIN_OK)
      for (auto &o : out) o.answer.status = s;
  } else if (way == GridIntervals || way == GridBoundary) {
    quoin_grid_answer a;
    quoin_status s = quoin_grid_intervals(m.scene, m.work, &grid.of, grid.x0, grid.y0, grid.x1, grid.y1, way == GridBoundary ? QUOIN_WANT_BOUNDARY : 0, &a);
    if (s == QUOIN_OK && (a.rays != q.size() || !a.boundary_of != (way != GridBoundary))) s = QUOIN_E_ARGUMENT; // a wrong answer
    for (size_t i = 0; i < out.size(); i++) {
      quoin_intervals one{};
      if (s == QUOIN_OK) one.count = a.inside_of[i].count, one.inside = a.inside + a.inside_of[i].first;
      if (s == QUOIN_OK && a.boundary_of) one.boundary_count = a.boundary_of[i].count, one.boundary = a.boundary + a.boundary_of[i].first;
      out[i].answer = copy(one), out[i].answer.status = s;
    }
  } else if (way == Spots || way == GridHits) {
    std::vector<quoin_spot> spots(rays.size());
    quoin_status s = way == Spots ? quoin_first_spots(m.scene, m.work, q.size(), q.data(), QUOIN_WANT_T, spots.data())
                                  : quoin_grid_hits(m.scene, m.work, &grid.of, grid.x0, grid.y0, grid.x1, grid.y1, QUOIN_WANT_T, spots.data());
    for (size_t i = 0; i < out.size(); i++) {
      out[i].hit.found = spots[i].surface != QUOIN_NO_SURFACE, out[i].hit.t = spots[i].t, out[i].hit.leaving = spots[i].leaving != 0;
      out[i].answer.status = s;
    }
  } else if (way == Blocked) {
    std::vector<uint8_t> blocked(rays.size());
    quoin_status s = quoin_rays_blocked(m.scene, m.work, q.size(), q.data(), nullptr, blocked.data());
    for (size_t i = 0; i < out.size(); i++) out[i].hit.found = blocked[i], out[i].answer.status = s;
  } else if (way == Hits) {
    std::vector<quoin_hit> hits(rays.size());
    quoin_status s = quoin_first_hits(m.scene, m.work, q.size(), q.data(), hits.data());
    for (size_t i = 0; i < out.size(); i++) out[i].hit = hits[i], out[i].answer.status = s;
  } else {
    for (size_t i = 0; i < q.size(); i++) {
      if (way == Hit) out[i].answer.status = quoin_first_hit(m.scene, m.work, &q[i], &out[i].hit);
      else {
        quoin_intervals a;
        quoin_status s;
        if (way == Text) {
          std::string t[8];
          const char *p[6];
          for (int k = 0; k < 6; k++) t[k] = decimal(Q(k < 3 ? q[i].o[k] : q[i].d[k - 3])), p[k] = t[k].c_str();
          if (std::isfinite(q[i].from)) t[6] = decimal(Q(q[i].from));
          if (std::isfinite(q[i].to)) t[7] = decimal(Q(q[i].to));
          s = quoin_ray_intervals_text(m.scene, m.work, p, std::isfinite(q[i].from) ? t[6].c_str() : nullptr, std::isfinite(q[i].to) ? t[7].c_str() : nullptr, QUOIN_WANT_BOUNDARY, &a);
        } else s = quoin_ray_intervals(m.scene, m.work, &q[i], QUOIN_WANT_BOUNDARY, &a);
        if (s == QUOIN_OK) out[i].answer = copy(a);
        out[i].answer.status = s;
      }
    }
  }
  return out;
}

enum Verdict { Wrong = 0, Right = 1, Unknown = 2, Unjudged = 3 };

// Stretches of one kind that must be said, over ends of type E (compare: e against a double, 2 not known; nearest likewise).
template <class E, class Compare, class Nearest>
Verdict check(const std::vector<std::pair<const E *, const E *>> &truth, const Ray &ray, const std::vector<Piece> &said, Compare compare, Nearest nearest, size_t &rounded) {
  Verdict v = Right;
  size_t k = 0;
  for (auto &s : truth) { // null: infinite
    int lo = s.first ? compare(*s.first, ray.from) : -1, hi = s.second ? compare(*s.second, ray.to) : 1;
    int gone1 = s.second ? compare(*s.second, ray.from) : 1, gone2 = s.first ? compare(*s.first, ray.to) : -1;
    if (lo == 2 || hi == 2 || gone1 == 2 || gone2 == 2) return Unknown;
    if (gone1 <= 0 || gone2 >= 0 || ray.from == ray.to) continue;
    if (k == said.size()) return Wrong;
    const Piece &p = said[k++];
    auto end = [&](const End &e, const E *root, double cut) { // root: null when the range or infinity makes the end
      if (!root) {
        if (e.t != cut || e.part) v = Wrong;
        return;
      }
      int n = nearest(e.t, *root);
      rounded += n == 1;
      if (n == 0 || !e.part) v = Wrong;
      if (n == 2 && v == Right) v = Unknown;
    };
    end(p.enter, s.first && lo >= 0 ? s.first : nullptr, ray.from);
    end(p.leave, s.second && hi <= 0 ? s.second : nullptr, ray.to);
  }
  return k == said.size() ? v : Wrong;
}
// Whether any stretch reaches into the range.
template <class E, class Compare>
Verdict check_blocked(const std::vector<std::pair<const E *, const E *>> &truth, const Ray &ray, const quoin_hit &hit, Compare compare) {
  bool any = false, open = false;
  for (auto &s : truth) {
    int gone1 = s.second ? compare(*s.second, ray.from) : 1, gone2 = s.first ? compare(*s.first, ray.to) : -1;
    open = open || gone1 == 2 || gone2 == 2;
    any = any || (gone1 > 0 && gone1 != 2 && gone2 < 0 && ray.from < ray.to);
  }
  return any ? (hit.found ? Right : Wrong) : open ? Unknown : hit.found ? Wrong : Right;
}
template <class E, class Compare, class Nearest>
Verdict check_hit(const std::vector<std::pair<const E *, const E *>> &truth, const Ray &ray, const quoin_hit &hit, Compare compare, Nearest nearest, size_t &rounded) {
  for (auto &s : truth) {
    int lo = s.first ? compare(*s.first, ray.from) : -1, hi = s.second ? compare(*s.second, ray.to) : 1;
    int gone1 = s.second ? compare(*s.second, ray.from) : 1, gone2 = s.first ? compare(*s.first, ray.to) : -1;
    if (lo == 2 || hi == 2 || gone1 == 2 || gone2 == 2) return Unknown;
    if (gone1 <= 0 || gone2 >= 0 || ray.from == ray.to) continue;
    const E *e = s.first && lo >= 0 ? s.first : s.second && hi <= 0 ? s.second : nullptr;
    if (!e) return hit.found ? Wrong : Right;
    if (!hit.found || (hit.leaving != 0) != (e == s.second)) return Wrong;
    int n = nearest(hit.t, *e);
    rounded += n == 1;
    return n == 0 ? Wrong : n == 1 ? Right : Unknown;
  }
  return hit.found ? Wrong : Right;
}

struct Bench { // one model and its judges
  Spec spec;
  std::string text;
  std::vector<Ball> balls;
  std::vector<Spot> contacts;
  Node solid;
  Surfaces surfaces;
  Quick quick;
  Model model;
  Work sse2, avx2, avx512;
  std::vector<const Spot *> spots;
  quoin_work *work(int isa) const { return (isa == 0 ? sse2 : isa == 1 ? avx2 : avx512).work; }
  static Node build(const Spec &s, uint64_t seed, std::vector<Ball> &b, std::vector<Spot> &c) {
    Random r(seed);
    return node_of(s, Map(), r, b, &c);
  }
  Bench(const Spec &s, uint64_t seed)
      : spec(s), text(text_of(s)), solid(build(s, seed, balls, contacts)), surfaces(solid), quick(solid, surfaces, balls), model(text), sse2(model, 0), avx2(model, 1), avx512(model, 2) {
    std::vector<const Leaf *> leaves;
    collect(solid, leaves);
    for (auto *l : leaves)
      for (auto &p : l->spots) spots.push_back(&p);
    for (auto &p : contacts)
      for (int k = 0; k < 3; k++) spots.push_back(&p); // few among many
  }
  Bench(const Bench &) = delete;

  // Stretches inside, and on the boundary, over ends of type E.
  template <class E> struct Truth {
    std::vector<std::pair<const E *, const E *>> in, on; // null: infinite
    void take(const std::vector<E> &cuts, const std::vector<Answer::What> &what) {
      in.clear(), on.clear();
      for (size_t i = 0; i < what.size(); i++)
        if (what[i] != Answer::Outside) (what[i] == Answer::Inside ? in : on).push_back({i ? &cuts[i - 1] : nullptr, i < cuts.size() ? &cuts[i] : nullptr});
    }
    template <class Compare, class Nearest> Verdict judge(const Ray &ray, const Reply &reply, int way, size_t &rounded, Compare compare, Nearest nearest) const {
      if (reply.answer.status != QUOIN_OK) return Wrong;
      if (way == Blocked) return check_blocked<E>(in, ray, reply.hit, compare);
      if (is_hit(way)) return check_hit<E>(in, ray, reply.hit, compare, nearest, rounded);
      Verdict v = check<E>(in, ray, reply.answer.inside, compare, nearest, rounded);
      if (v != Right || way == Many || way == GridIntervals) return v;
      return check<E>(on, ray, reply.answer.boundary, compare, nearest, rounded);
    }
  };
  // A double beyond the largest, or its neighbour, against a root.
  static int nearest_far(double t, const Root &n) {
    if (std::isinf(t)) { // beyond the largest double, with the halfway point going to even
      Root most((Q(0x1.fffffffffffffp+1023) + pow2(970)) * Q(t > 0 ? 1 : -1));
      return (int)(t > 0 ? n >= most : n <= most);
    }
    return 2;
  }
  static bool far_away(double t) { return std::isinf(t) || std::fabs(t) == 0x1.fffffffffffffp+1023; }

  Quick::Found found;
  bool known = false;
  Truth<Cut> quick_truth;
  // Prepares the quick judge for a ray; then judge_quick may be asked for several replies.
  void aim_quick(const Ray &ray) {
    known = quick.shoot(ray.o, ray.d, found);
    if (known) quick_truth.take(found.cuts, found.what);
  }
  Verdict judge_quick(const Ray &ray, const Reply &reply, int way, size_t &rounded, Ulps *const *ulps = nullptr) { // ulps: two to add to
    if (!known) return Unknown;
    auto compare = [this](const Cut &n, double t) { return quick.compare(n, t); };
    auto nearest_ = [this, ulps](double t, const Cut &n) {
      if (far_away(t)) return nearest_far(t, quick.exact_root(n));
      int v = quick.nearest(t, n);
      if (ulps && v == 1 && ulps[0]->add(t, quick.wide(n))) ulps[1]->add(t, quick.wide(n));
      return v;
    };
    return quick_truth.judge(ray, reply, way, rounded, compare, nearest_);
  }
  Answer exact_answer;
  Truth<Root> exact_truth;
  void aim_exact(const Ray &ray) {
    exact_answer = intersect(solid, surfaces, origin(ray), direction(ray));
    if (exact_answer.skipped) exact_answer = beside(solid, surfaces, origin(ray), direction(ray));
    exact_truth.take(exact_answer.cuts, exact_answer.what);
  }
  mutable unsigned long long middles = 0; // ends that lie in the very middle between two doubles
  Verdict judge_exact(const Ray &ray, const Reply &reply, int way, size_t &rounded) const {
    if (exact_answer.skipped) return Unjudged;
    auto compare = [](const Root &n, double t) {
      if (std::isinf(t)) return t > 0 ? -1 : 1;
      return (int)CGAL::compare(n, Root(Q(t)));
    };
    auto nearest_ = [this](double t, const Root &n) {
      if (far_away(t)) return nearest_far(t, n);
      if (!n.is_extended() && n.a0() != Q(t)) {
        Q gap = n.a0() - Q(t);
        double beside = std::nextafter(t, gap > 0 ? INFINITY : -INFINITY);
        middles += gap + gap == Q(beside) - Q(t);
      }
      return (int)nearest(t, n);
    };
    return exact_truth.judge(ray, reply, way, rounded, compare, nearest_);
  }

  // Where docs/exactness.md calls a point undecided, "boundary" may be said of any.
  static bool may_be_undecided(const char *hard) { return hard && !strstr(hard, "planes"); }
  mutable std::map<V, int> around_known;
  // The side a point must have: the tree on every combination of sides of the surfaces through it, when these are at most three with
  // independent gradients; else what a small tetrahedron around it meets (point.hpp), and *hard says why (names that
  // end in planes: no such point is undecided). again: look at that all the same, and
  // compare. -1: not judged, *why then.
  int side(const V &p, bool again, const char **hard, const char **why) const {
    std::optional<Line4> at;
    std::vector<int> sign, group;
    std::vector<const Quadric *> through;
    std::vector<size_t> which;
    Num x[3];
    for (int i = 0; i < 3; i++) x[i] = from_rational(p[(size_t)i]);
    for (size_t s = 0; s < surfaces.forms.size(); s++) {
      int known = Quick::sign_at(quick.surfaces[s], quick.surfaces[s].wide, x);
      if (known == 2) {
        if (!at) at = whole(p, V{0, 0, 0});
        known = CGAL::sign(along(surfaces.forms[s], *at).c);
      }
      sign.push_back(known), group.push_back(-1);
      if (known == 0) group[s] = (int)through.size(), sign[s] = 1, through.push_back(surfaces.quadrics[s]), which.push_back(s);
    }
    std::vector<Cursor> cursors(surfaces.of.size());
    for (size_t h = 0; h < cursors.size(); h++) {
      size_t s = surfaces.of[h];
      cursors[h].sign = sign[s] * surfaces.side[h], cursors[h].group = group[s];
    }
    std::vector<V> g;
    for (auto *q : through) g.push_back(q->gradient(p));
    bool singular = std::any_of(g.begin(), g.end(), [](const V &v) { return zero(v); });
    auto curved = [](const Quadric *q) {
      for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++)
          if (q->a[i][j] != 0) return true;
      return false;
    };
    const auto bodies = std::count_if(through.begin(), through.end(), curved);
    *hard = nullptr;
    if (singular) *hard = bodies > 1 ? "at an apex" : "at an apex among planes";
    else if (through.size() > 3) *hard = bodies ? "on more than three surfaces" : "on more than three planes";
    else if ((g.size() == 2 && zero(cross(g[0], g[1]))) || (g.size() == 3 && dot(g[0], cross(g[1], g[2])) == 0)) *hard = bodies ? "on surfaces with dependent gradients" : "on dependent planes";
    int looked = -1;
    if (*hard || (again && !through.empty())) {
      auto before = around_known.find(p); // rays and batches ask for one place again and again
      if (before == around_known.end()) before = around_known.emplace(p, around(solid, surfaces, which, sign, p, why)).first;
      looked = before->second;
      if (*hard) return looked;
    }
    unsigned in = 0, n = 1u << through.size();
    for (unsigned k = 0; k < n; k++) {
      size_t half = 0;
      in += evaluate(solid, cursors, half, k);
    }
    int found = in == 0 ? QUOIN_OUTSIDE : in == n ? QUOIN_INSIDE : QUOIN_BOUNDARY;
    if (looked >= 0 && looked != found) throw std::logic_error("the judges of points disagree");
    return found;
  }
};
} // namespace stress
