// The promise of --snap (docs/exactness.md, Near surfaces), on random models with gaps made around the limit: no pair of surfaces with a gap of the limit or less is
// left, nothing moved farther, nothing moved that had nothing near, and what moved moved onto a surface of the file that stands.
//
// Gaps are taken here in rationals, from the judge's own half-spaces; a square root that is not rational is enclosed to 2^-600. Of the library only the exact
// surfaces are asked for that each half-space has before and after. Not judged, and counted: pairs whose gap is over a region (planes at an angle
// below 2^-6, similar ellipsoids of different size).
//
// Usage: stress_snap [--seed S] [--seconds T | --models N] [--leaves N] [--finds DIR] [--command QUOIN] [--again MODELSEED]
#include "../oracle/judge.hpp"
#include "grammar.hpp"
#include "smaller.hpp"

extern "C" {
#include "snap_forms.h"
}

#include <unistd.h>

namespace stress {
// --- gaps ---------------------------------------------------------------------------------------------------------------

struct Gap {
  enum Kind { None, Known, Region } kind = None;
  Q lo = 0, hi = 0; // around it; equal where it is rational
};
inline Gap known(const Q &lo, const Q &hi) { return {Gap::Known, lo, hi}; }
inline Gap root(const Q &square) {
  Z n = square.numerator() * square.denominator(), s;
  if (mpz_perfect_square_p(n.mpz())) {
    mpz_sqrt(s.mpz(), n.mpz());
    return known(Q(s, square.denominator()), Q(s, square.denominator()));
  }
  const long bits = 700;
  n = n * shifted_one(2 * bits);
  mpz_sqrt(s.mpz(), n.mpz());
  const Z by = square.denominator() * shifted_one(bits);
  return known(Q(s, by), Q(s + Z(1), by));
}
inline Gap plus(const Gap &a, const Gap &b) { return known(a.lo + b.lo, a.hi + b.hi); }
inline Gap apart(const Gap &a, const Gap &b) { // |a - b|
  Q lo = a.lo - b.hi, hi = a.hi - b.lo;
  if (lo >= 0) return known(lo, hi);
  if (hi <= 0) return known(-hi, -lo);
  return known(0, std::max(Q(-lo), hi));
}
struct Form { // x'Mx + 2 g.x + j
  Q m[3][3], j;
  V g;
  bool plane = true;
  explicit Form(const Quadric &q) : j(q.a[3][3]) {
    for (size_t i = 0; i < 3; i++) {
      g[i] = q.a[i][3];
      for (size_t k = 0; k < 3; k++) m[i][k] = q.a[i][k], plane = plane && q.a[i][k] == 0;
    }
  }
  V times(const V &x) const {
    V y{0, 0, 0};
    for (size_t i = 0; i < 3; i++)
      for (size_t k = 0; k < 3; k++) y[i] += m[i][k] * x[k];
    return y;
  }
  V row(size_t i) const { return {m[i][0], m[i][1], m[i][2]}; }
  Q at(const V &x) const { return dot(x, times(x)) + 2 * dot(g, x) + j; }
};
inline V solve3(const Form &f, const V &b) { // M x = b, M regular
  V c0 = cross(f.row(1), f.row(2)), c1 = cross(f.row(2), f.row(0)), c2 = cross(f.row(0), f.row(1));
  Q det = dot(f.row(0), c0);
  return (1 / det) * (b[0] * c0 + b[1] * c1 + b[2] * c2);
}
// turn: 1 where the insides of q <= 0 lie on one side, else -1.
inline Gap gap_of(const Quadric &qx, const Quadric &qy, int *turn) {
  Form x(qx), y(qy);
  *turn = 1;
  if (x.plane != y.plane) return {};
  if (x.plane) {
    V c = cross(x.g, y.g);
    *turn = dot(x.g, y.g) > 0 ? 1 : -1;
    if (!zero(c)) return {dot(c, c) * 4096 > dot(x.g, x.g) * dot(y.g, y.g) ? Gap::None : Gap::Region, 0, 0};
    Q f = dot(x.g, y.g) / dot(y.g, y.g), d = x.j - f * y.j; // (x.g) = f (y.g)
    return root(d * d / (4 * dot(x.g, x.g)));
  }
  Q f = 0;
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++)
      if (f == 0 && y.m[i][k] != 0) f = x.m[i][k] / y.m[i][k];
  if (f == 0) return {};
  for (size_t i = 0; i < 3; i++)
    for (size_t k = 0; k < 3; k++) {
      if (x.m[i][k] != f * y.m[i][k]) return {};
      y.m[i][k] = x.m[i][k];
    }
  y.g = f * y.g, y.j = f * y.j, *turn = f > 0 ? 1 : -1;
  V w{0, 0, 0}; // the kernel
  Q det = dot(x.row(0), cross(x.row(1), x.row(2)));
  for (size_t i = 0; i < 3 && det == 0 && zero(w); i++) w = cross(x.row(i), x.row((i + 1) % 3));
  if (det == 0 && zero(w)) return {}; // rank 1
  const Q p = dot(x.g, w), r = dot(y.g, w);
  Form full = x; // regular, and M on what is across w
  if (det == 0)
    for (size_t i = 0; i < 3; i++)
      for (size_t k = 0; k < 3; k++) full.m[i][k] += w[i] * w[k];
  if (det == 0 && p != r) return {};
  if (det != 0 || p == 0) { // a centre, or an axis
    V cx = solve3(full, Q(-1) * x.g), cy = solve3(full, Q(-1) * y.g), t = cx - cy;
    Q ex = x.at(cx), ey = y.at(cy), m = 0;
    if (det == 0) t = t - (dot(t, w) / dot(w, w)) * w;
    bool round = true;
    for (size_t i = 0; i < 3; i++) m += x.m[i][i];
    m = m / (det != 0 ? 3 : 2);
    for (size_t i = 0; i < 3; i++)
      for (size_t k = 0; k < 3; k++) round = round && x.m[i][k] == m * (Q(i == k) - (det != 0 ? Q(0) : w[i] * w[k] / dot(w, w)));
    if (round && ex != 0 && ey != 0 && -ex / m > 0 && -ey / m > 0) return plus(root(dot(t, t)), apart(root(-ex / m), root(-ey / m)));
    if (ex == ey) return root(dot(t, t));
    return {(ex > 0) == (ey > 0) && ex != 0 && ey != 0 ? Gap::Region : Gap::None, 0, 0};
  }
  V across = x.g - y.g; // y(v) = x(v - t): g_y = g_x - M t
  if (dot(across, w) != 0) return {};
  V t = solve3(full, across);
  t = t - (dot(t, w) / dot(w, w)) * w;
  Q rest = y.j - x.j - dot(t, x.times(t)) + 2 * dot(x.g, t);
  t = t - (rest / (2 * p)) * w;
  return root(dot(t, t));
}

// --- models ---------------------------------------------------------------------------------------------------------------

struct Limit { Q value; std::string text; };
inline Limit a_limit(Random &r) {
  Limit l;
  static const int digits[] = {1, 1, 1, 5, 25, 123, 999};
  l.value = Q(digits[r.below(7)]) / pow10(r.range(3, 9));
  l.text = decimal(l.value);
  return l;
}
inline Q a_gap_near(Random &r, const Q &limit, Census *census) {
  const char *kind = "none";
  Q g = 0;
  switch (r.below(10)) {
  case 0: case 1: kind = "exactly the limit", g = limit; break;
  case 2: kind = "just below", g = limit * (1 - (r.chance(50) ? pow2(-r.range(20, 120)) : 1 / pow10(r.range(6, 20)))); break;
  case 3: kind = "just above", g = limit * (1 + (r.chance(50) ? pow2(-r.range(20, 120)) : 1 / pow10(r.range(6, 20)))); break;
  case 4: case 5: kind = "below", g = limit * Q(r.range(1, 9)) / 10; break;
  case 6: kind = "above", g = limit * Q(r.range(11, 30)) / 10; break;
  case 7: kind = "far below", g = limit * pow2(-r.range(4, 60)); break;
  default: break;
  }
  if (census) census->count("limit", kind);
  return r.chance(50) ? g : Q(-1) * g;
}
// The same solid, written otherwise.
inline Spec otherwise(Random &r, Spec s) {
  const Shape::Kind k = s.shape.kind;
  const bool about_z = k == Shape::Cylinder || k == Shape::Frustum || k == Shape::Paraboloid || k == Shape::OneSheet || k == Shape::TwoSheets || k == Shape::Sphere;
  if (s.shape.placed || r.chance(30)) return s;
  if (about_z && r.chance(60)) { // turned about its axis
    Step t;
    t.kind = Step::Matrix;
    auto c = circle(r);
    t.map.m[0][0] = t.map.m[1][1] = c[0], t.map.m[0][1] = -c[1], t.map.m[1][0] = c[1];
    s.steps.push_back(t);
    return s;
  }
  Step there, back; // to and fro
  there.v = V{tenth(r, -30, 30), tenth(r, -30, 30), tenth(r, -30, 30)}, back.v = Q(-1) * there.v;
  s.steps.push_back(there), s.steps.push_back(back);
  if (r.chance(50)) {
    Step big, small;
    big.kind = small.kind = Step::Scale;
    Q f = r.chance(50) ? Q(10) : Q(4);
    big.v = {f, f, f}, small.v = {1 / f, 1 / f, 1 / f};
    s.steps.push_back(big), s.steps.push_back(small);
  }
  return s;
}
inline Spec a_snap_model(Random &r, const Limit &limit, int leaves, Census *census) {
  Style st;
  st.dyadic = r.chance(40);
  std::vector<Spec> all;
  const bool shuffled = r.chance(50);
  while ((int)all.size() < leaves) {
    Spec s = leaf_spec(a_shape(r, st));
    if (r.chance(60)) s = moved({a_place(r, st), a_place(r, st), a_place(r, st)}, s);
    if (r.chance(40)) s = around(a_turn(r), s);
    int copies = r.range(1, 5), axis = r.below(3), way = r.below(4);
    V u = r.chance(50) ? along_axis(axis, 1) : on_sphere(r);
    Q sum = 0;
    if (census) census->count("copies", way == 0 ? "moved in a row" : way == 1 ? "larger" : way == 2 ? "moved any way" : "along the axis");
    for (int i = 0; i < copies; i++) {
      Spec k = s;
      Q g = i ? a_gap_near(r, limit.value, census) : Q(0);
      sum += i ? CGAL::abs(g) : Q(0);
      if (way == 0) k = moved(sum * u, k); // chains
      else if (way == 1 && k.shape.kind != Shape::Saddle && k.shape.kind != Shape::General && k.shape.kind != Shape::HalfSpace && k.shape.p[0] + sum > 0) {
        size_t which = (size_t)r.below((int)k.shape.p.size());
        if (k.shape.p[which] > sum) k.shape.p[which] += sum;
        if (k.shape.kind == Shape::HalfSpace) k.shape.p[3] += sum;
      } else if (way == 2) k = moved(g * (r.chance(50) ? on_sphere(r) : along_axis(r.below(3), 1)), k);
      else {
        Step t;
        t.v = along_axis(2, sum);
        k.steps.push_back(t); // along its own axis
      }
      if (k.shape.kind == Shape::Frustum && k.shape.p[1] == k.shape.p[2]) continue;
      if ((k.shape.kind == Shape::OneSheet && k.shape.p[1] <= k.shape.p[2]) || (k.shape.kind == Shape::TwoSheets && k.shape.p[0] <= k.shape.p[2])) continue;
      all.push_back(otherwise(r, k));
    }
  }
  for (size_t i = all.size(); i > 1 && shuffled; i--) std::swap(all[i - 1], all[(size_t)r.below((int)i)]);
  Spec m = gate(Node::Union, all);
  if (all.size() > 3 && r.chance(30)) m = gate(an_op(r), {gate(Node::Union, std::vector<Spec>(all.begin(), all.begin() + 2)), gate(Node::Union, std::vector<Spec>(all.begin() + 2, all.end()))});
  if (r.chance(30)) m = moved(pow10(r.range(1, 9)) * V{Q(r.range(-1, 1)), Q(r.range(-1, 1)), Q(r.range(-1, 1))}, m);
  if (r.chance(30)) m = around(a_turn(r), m);
  return m;
}

// --- the judge ------------------------------------------------------------------------------------------------------------

struct Half { Quadric q; size_t surface; }; // the half-space is q <= 0
using Halves = std::map<std::pair<uint32_t, uint32_t>, Half>;
inline Halves halves_of(const quoin_scene *scene) {
  Halves out;
  auto each = [](void *user, const snap_half *h) {
    static const int at[10][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}, {3, 3}};
    Half half;
    half.surface = h->surface;
    for (int k = 0; k < 10; k++) {
      size_t i = (size_t)at[k][0], j = (size_t)at[k][1];
      half.q.a[i][j] = half.q.a[j][i] = Q(Z(h->q[k])) * Q(h->side) / Q(i == j ? 1 : 2);
    }
    ((Halves *)user)->emplace(std::make_pair(h->leaf, h->half), half);
  };
  if (!snap_forms(scene, each, &out)) throw std::runtime_error("no exact forms");
  return out;
}
inline bool same(const Quadric &p, const Quadric &q, bool either_side) {
  Q f = 0;
  for (size_t i = 0; i < 4; i++)
    for (size_t j = 0; j < 4; j++) {
      if ((p.a[i][j] == 0) != (q.a[i][j] == 0)) return false;
      if (f == 0 && q.a[i][j] != 0) f = p.a[i][j] / q.a[i][j];
    }
  if (f == 0 || (f < 0 && !either_side)) return false;
  for (size_t i = 0; i < 4; i++)
    for (size_t j = 0; j < 4; j++)
      if (p.a[i][j] != f * q.a[i][j]) return false;
  return true;
}
struct Tally { unsigned long long models = 0, leaves = 0, pairs = 0, moved = 0, stood = 0, unjudged = 0, gone = 0, refused = 0, wrong = 0, commands = 0; };

struct Scene { // a compiled one
  quoin_model *model = nullptr;
  quoin_scene *scene = nullptr;
  Scene(const std::string &text, const char *snap) {
    quoin_compile_options o = quoin_compile_options_default();
    o.threads = 1, o.snap = snap;
    quoin_status s = quoin_model_new(nullptr, &model);
    if (s == QUOIN_OK) s = quoin_model_read_text(model, QUOIN_ROOT, "stress", text.data(), text.size(), nullptr);
    if (s == QUOIN_OK) s = quoin_scene_compile(model, &o, &scene);
    if (s != QUOIN_OK) {
      quoin_model_free(model);
      throw std::runtime_error(quoin_status_text(s));
    }
  }
  ~Scene() { quoin_scene_free(scene), quoin_model_free(model); }
  Scene(const Scene &) = delete;
};

// What is wrong, or "".
inline std::string judge_snap(const Spec &spec, const Limit &limit, const char *command, Tally &t) {
  const std::string text = text_of(spec);
  std::ostringstream why;
  Random r(1);
  std::vector<Ball> balls;
  Node solid = node_of(spec, Map(), r, balls);
  std::vector<const Leaf *> leaves;
  collect(solid, leaves);
  Scene plain(text, nullptr), snapped(text, limit.text.c_str());
  Halves was = halves_of(plain.scene), now = halves_of(snapped.scene);
  std::vector<const Quadric *> file; // every surface of the file
  for (auto *l : leaves)
    for (auto &q : l->halves)
      if (std::none_of(file.begin(), file.end(), [&](const Quadric *f) { return same(*f, q, true); })) file.push_back(&q);
  for (auto &h : was) {
    if (h.first.first >= leaves.size()) return "a leaf that the file has not";
    auto &mine = leaves[h.first.first]->halves;
    if (std::none_of(mine.begin(), mine.end(), [&](const Quadric &q) { return same(q, h.second.q, false); })) return "a half-space of a leaf that is none of its own";
  }
  auto within = [&](const Gap &g) { return g.kind != Gap::Known ? -1 : g.hi <= limit.value ? 1 : g.lo > limit.value ? 0 : -1; };
  auto name = [](const std::pair<uint32_t, uint32_t> &h) { return "half-space " + std::to_string(h.second) + " of leaf " + std::to_string(h.first); };
  std::map<size_t, std::pair<const Quadric *, std::string>> left; // surfaces
  int turn;
  std::vector<Quadric> movers, targets;
  for (auto &h : now) {
    left.emplace(h.second.surface, std::make_pair(&h.second.q, name(h.first)));
    auto before = was.find(h.first);
    if (before == was.end()) {
      t.gone++; // dropped when nothing is snapped
      continue;
    }
    const Quadric &from = before->second.q, &to = h.second.q;
    if (same(from, to, false)) {
      t.stood++;
      continue;
    }
    t.moved++;
    Gap g = gap_of(from, to, &turn);
    int in = within(g);
    if (g.kind == Gap::None || in == 0) return name(h.first) + " moved too far: " + std::to_string(CGAL::to_double(g.lo));
    t.unjudged += in < 0;
    if (g.kind == Gap::Known && turn < 0) return name(h.first) + " changed its side";
    if (std::none_of(file.begin(), file.end(), [&](const Quadric *f) { return same(*f, to, true); })) return name(h.first) + " moved onto no surface of the file";
    bool near = false;
    for (auto *f : file) near = near || (!same(*f, from, true) && within(gap_of(from, *f, &turn)) != 0 && gap_of(from, *f, &turn).kind != Gap::None);
    if (!near) return name(h.first) + " moved, with nothing near";
    movers.push_back(from), targets.push_back(to);
  }
  for (auto &q : targets) // what was moved onto stands
    for (auto &m : movers)
      if (same(q, m, true)) return "a surface that was moved onto moved itself";
  for (auto a = left.begin(); a != left.end(); ++a)
    for (auto b = left.begin(); b != a; ++b) {
      if (same(*a->second.first, *b->second.first, true)) return "two surfaces that are equal: " + a->second.second + ", " + b->second.second;
      Gap g = gap_of(*a->second.first, *b->second.first, &turn);
      t.pairs++, t.unjudged += g.kind == Gap::Region;
      if (within(g) == 1) return "a pair is left, " + std::to_string(CGAL::to_double(g.hi / limit.value)) + " of the limit apart: " + a->second.second + ", " + b->second.second;
      t.unjudged += g.kind == Gap::Known && within(g) < 0;
    }
  if (command) { // the command line says the same
    std::string path = "/tmp/stress_snap_" + std::to_string(getpid()) + ".csg";
    FILE *f = fopen(path.c_str(), "w");
    if (!f) return "no temporary file";
    fputs(text.c_str(), f), fclose(f);
    FILE *p = popen((std::string(command) + " check -q --snap " + limit.text + " " + path + " 2>/dev/null").c_str(), "r");
    long count = -1;
    char line[400];
    while (p && fgets(line, sizeof line, p))
      if (strncmp(line, "snapped ", 8) == 0) count = atol(line + 8);
    if (p) pclose(p);
    unlink(path.c_str());
    t.commands++;
    if (count != (long)quoin_near_count(quoin_scene_snapped(snapped.scene))) return "the command line says that it moved " + std::to_string(count) + " surfaces, the library " + std::to_string(quoin_near_count(quoin_scene_snapped(snapped.scene)));
  }
  return "";
}
} // namespace stress

using namespace stress;

struct Options {
  uint64_t seed = 1;
  double seconds = 5;
  long models = 0;
  int leaves = 12;
  std::string finds = ".";
  const char *command = nullptr;
};

static void one_model(uint64_t seed, const Options &o, Tally &t, Census &census) {
  Random r(seed);
  Limit limit = a_limit(r);
  Spec spec = a_snap_model(r, limit, r.range(2, std::max(2, o.leaves)), &census);
  note_shapes(Style{true, &census, -1, nullptr}, spec);
  std::string why;
  try {
    why = judge_snap(spec, limit, o.command && r.chance(10) ? o.command : nullptr, t);
  } catch (const std::runtime_error &e) {
    if (t.refused++ < 3) fprintf(stderr, "refused (%s): --again %llu\n", e.what(), (unsigned long long)seed);
    return;
  }
  t.models++, t.leaves += leaves_of(spec);
  if (why.empty()) return;
  t.wrong++;
  const std::string again = "stress_snap --leaves " + std::to_string(o.leaves) + " --again " + std::to_string(seed);
  fprintf(stderr, "WRONG: %s (%s)\n", why.c_str(), again.c_str());
  if (t.wrong > 3) return;
  const double end = now() + 40;
  auto fails = [&](const Spec &s) {
    if (now() > end) return false;
    Tally unused;
    try {
      std::string w = judge_snap(s, limit, nullptr, unused);
      if (!w.empty()) why = w;
      return !w.empty();
    } catch (const std::exception &) {
      return false;
    }
  };
  while (smaller(spec, [&](const Spec &s) { return fails(s) ? (spec = s, true) : false; })) {}
  std::string path = o.finds + "/snap_" + std::to_string(seed) + ".csg", text = "// the promise of --snap is broken: " + why + "\n// quoin check --snap " + limit.text + "\n// again: " + again + "\n" + text_of(spec);
  FILE *f = fopen(path.c_str(), "w");
  if (f) fputs(text.c_str(), f), fclose(f);
  fprintf(stderr, "%s\n%s\n", path.c_str(), text.c_str());
}

int main(int argc, char **argv) {
  Options o;
  uint64_t again = 0;
  bool once = false;
  for (int i = 1; i < argc; i++) {
    std::string a = argv[i];
    auto value = [&]() -> const char * {
      if (i + 1 >= argc) fprintf(stderr, "a value is missing after %s\n", a.c_str()), exit(2);
      return argv[++i];
    };
    if (a == "--seed") o.seed = strtoull(value(), nullptr, 10);
    else if (a == "--seconds") o.seconds = atof(value());
    else if (a == "--models") o.models = atol(value());
    else if (a == "--leaves") o.leaves = atoi(value());
    else if (a == "--finds") o.finds = value();
    else if (a == "--command") o.command = value();
    else if (a == "--again") again = strtoull(value(), nullptr, 10), once = true;
    else return fprintf(stderr, "unknown option %s\n", a.c_str()), 2;
  }
  Tally t;
  Census census;
  if (once) {
    one_model(again, o, t, census);
    return t.wrong != 0;
  }
  Random seeds(Random(o.seed).next()); // far apart in one sequence: neighbours must not share models
  double begin = now();
  for (long k = 0; (o.models ? k < o.models : now() - begin < o.seconds) && t.wrong < 10; k++) one_model(seeds.next(), o, t, census);
  printf("snap seed=%llu seconds=%.1f models=%llu leaves=%llu pairs=%llu moved=%llu stood=%llu unjudged=%llu commands=%llu refused=%llu wrong=%llu", (unsigned long long)o.seed, now() - begin, t.models,
         t.leaves, t.pairs, t.moved, t.stood, t.unjudged, t.commands, t.refused, t.wrong);
  for (auto &c : census.counts) printf(" n.snap_%s=%llu", Census::word(c.first).c_str(), c.second);
  putchar('\n');
  return t.wrong != 0;
}
