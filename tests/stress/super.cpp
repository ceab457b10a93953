// Superquadrics (design S10) against a judge of their own: every root along a ray isolated by intervals in MPFR, which shares nothing with the library.
//
// Legend: X_i = (R^T ((o + t d) - c))_i / r_i, p = 2/e, q = 2/n, f = (|X0|^p + |X1|^p)^(e/n) + |X2|^q; size = 2 / max |D_i|, the longest stretch that a line with direction D has in
// the box |X_i| <= 1. Between coordinate planes f has a derivative; a piece of the line is done when f - 1 has a sign on it (plainly, or by the mean value theorem), when f' has one, or when
// it is shorter than 2^-50 size: all in intervals, rounded outward. So the roots are known to 2^-60 size, but for pairs closer than 2^-50.
// Judged: each end that quoin says is a root of the right direction, within 2^-44 size and 8 last bits of t, or, where t is beyond 128 sizes, half a last bit; each root that has no end is one of a
// pair of neighbours that are no wider apart than 2^-40 size, or than t's last bit. A point has the sign of f - 1 where that is known to 2^-200.
//
// Usage: stress_super [--seed S] [--seconds T | --models N] [--again MODELSEED]
#include "interval.hpp"
#include "../oracle/random.hpp"

#include "quoin/quoin.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

using namespace stress;

namespace {
using oracle::Random;

enum { Most = 6000 };
enum Aim { Anywhere, Pole, Tangent, Slanted, Arms, Plane, Edge, Aims };
const char *const AIMS[] = {"anywhere", "pole", "tangent", "slanted", "arms", "plane", "edge"};

struct Solid {
  std::string c[3], r[3], angle[3], e, n, text;
  bool turned = false;
  Real C[3], S[3], R[3][3], E, N; // S: radii
  Span p, q, s;
  void make() {
    for (int i = 0; i < 3; i++) {
      C[i] = Real(c[i].c_str()), S[i] = Real(r[i].c_str());
      for (int j = 0; j < 3; j++) R[i][j] = Real(i == j ? 1.0 : 0.0);
    }
    for (int i = 0; turned && i < 3; i++) { // rotate([a, b, c]) turns about x first
      Real sine, cosine, next[3][3];
      turn(angle[i].c_str(), sine, cosine);
      int j = (i + 1) % 3, k = (i + 2) % 3;
      for (int m = 0; m < 3; m++) next[i][m] = R[i][m], next[j][m] = cosine * R[j][m] - sine * R[k][m], next[k][m] = sine * R[j][m] + cosine * R[k][m];
      for (int m = 0; m < 9; m++) R[m / 3][m % 3] = next[m / 3][m % 3];
    }
    E = Real(e.c_str()), N = Real(n.c_str());
    p = quotient(Real(2.0), E), q = quotient(Real(2.0), N), s = quotient(E, N);
    text = "translate([" + c[0] + "," + c[1] + "," + c[2] + "]) ";
    if (turned) text += "rotate([" + angle[0] + "," + angle[1] + "," + angle[2] + "]) ";
    text += "superquadric(r=[" + r[0] + "," + r[1] + "," + r[2] + "],e=" + e + ",n=" + n + ");\n";
  }
  Real local(const Real x[3], int i) const { return (R[0][i] * x[0] + R[1][i] * x[1] + R[2][i] * x[2]) / S[i]; }
  double world(const double X[3], int i) const { // of a vector
    double w = 0;
    for (int j = 0; j < 3; j++) w += R[i][j].to_double() * S[j].to_double() * X[j];
    return w;
  }
  double f(const double X[3]) const {
    double P = 2 / E.to_double(), Q = 2 / N.to_double();
    return std::pow(std::pow(std::fabs(X[0]), P) + std::pow(std::fabs(X[1]), P), Q / P) + std::pow(std::fabs(X[2]), Q);
  }
};

struct Line {
  const Solid *s;
  Real O[3], D[3], size;
  // f - 1 and f' over [t0, t1], on which no coordinate changes its sign but at the ends.
  void look(const Real &t0, const Real &t1, Span &value, Span *slope) const {
    Span x[3], pw[3], g[3];
    for (int i = 0; i < 3; i++) {
      Real a = O[i] + t0 * D[i], b = O[i] + t1 * D[i];
      bool across = a.sign() * b.sign() < 0;
      int way = (a + b).sign();
      a = a.abs(), b = b.abs();
      x[i] = Span(across ? Real(0.0) : a < b ? a : b, a < b ? b : a);
      x[i].widen(); // O + t D was rounded
      pw[i] = power(x[i], i < 2 ? s->p : s->q);
      if (slope) g[i] = D[i].sign() ? pw[i] / x[i] * Span(way < 0 ? -D[i] : D[i]) : Span(Real(0.0));
    }
    Span A = pw[0] + pw[1], inner = power(A, s->s);
    value = inner + pw[2] - Span(Real(1.0));
    if (slope) {
      // inner/A = A^(e/n - 1)
      *slope = s->q * (inner / A * (g[0] + g[1]) + g[2]);
    }
  }
  int sign(const Real &t) const {
    Span v;
    look(t, t, v, nullptr);
    return v.sign();
  }
};

struct Root { Real t; int way; }; // way 1: out of the solid

// The roots in [t0, t1] between coordinate planes, in order; false: too much work.
bool roots_of(const Line &l, const Real &t0, const Real &t1, std::vector<Root> &out, int &work) {
  std::vector<std::pair<Real, Real>> todo{{t0, t1}};
  const Real least = l.size * Real(0x1p-50), fine = l.size * Real(0x1p-60);
  while (!todo.empty()) {
    if (++work > Most) return false;
    auto [a, b] = todo.back();
    todo.pop_back();
    Span v, slope, at;
    l.look(a, b, v, &slope);
    if (v.sign()) continue;
    bool monotone = slope.sign() != 0;
    if (!monotone && !(b - a < least)) {
      Real m = (a + b) * Real(0.5);
      l.look(m, m, at, nullptr);
      Span half = Span(Real(0.0) - (b - m), b - m);
      if ((at + slope * half).sign()) continue;
      todo.push_back({m, b}), todo.push_back({a, m});
      continue;
    }
    int sa = l.sign(a), sb = l.sign(b);
    sa = sa ? sa : 1, sb = sb ? sb : 1; // on the surface for all that can be told: a touch
    if (sa == sb) continue;
    while (fine < b - a) {
      Real m = (a + b) * Real(0.5);
      if (!(a < m && m < b)) break;
      int sm = l.sign(m);
      (sm == sa ? a : b) = m;
    }
    out.push_back({(a + b) * Real(0.5), sb});
  }
  return true;
}

struct Totals { unsigned long long models = 0, rays = 0, judged = 0, unjudged = 0, ends = 0, points = 0, on = 0, wrong = 0, hits = 0, aims[Aims] = {0}, lost = 0; double most = 0; };

struct Asked { quoin_model *model = nullptr; quoin_scene *scene = nullptr; quoin_work *work = nullptr; };

void wrong(Totals &t, uint64_t seed, const Solid &s, const double v[6], const std::vector<double> &ends, const std::vector<Root> *roots, const char *what, int aim) {
  t.wrong++;
  fprintf(stderr, "WRONG (%s, %s; stress_super --again %llu)\n%sray", what, AIMS[aim], (unsigned long long)seed, s.text.c_str());
  for (int i = 0; i < 6; i++) fprintf(stderr, " %.17g", v[i]);
  fprintf(stderr, "\nquoin:");
  for (double e : ends) fprintf(stderr, " %.17g", e);
  fprintf(stderr, "\njudge:");
  if (roots)
    for (auto &r : *roots) fprintf(stderr, " %.17g", r.t.to_double());
  fprintf(stderr, "\n");
}

// All roots of the line; false: not judged.
bool truth(const Line &l, std::vector<Root> &out) {
  std::vector<Real> cut;
  Real lo, hi;
  bool first = true, any = true;
  for (int i = 0; i < 3; i++) {
    if (!l.D[i].sign()) {
      any = any && !(Real(1.0) < l.O[i].abs());
      continue;
    }
    Real u = (Real(-1.0) - l.O[i]) / l.D[i], v = (Real(1.0) - l.O[i]) / l.D[i];
    if (v < u) std::swap(u, v);
    if (first || lo < u) lo = u;
    if (first || v < hi) hi = v;
    first = false;
  }
  if (!any || hi < lo) return true;
  Real more = l.size * Real(0x1p-20);
  lo = lo - more, hi = hi + more;
  cut.push_back(lo);
  for (int i = 0; i < 3; i++)
    if (l.D[i].sign()) {
      Real t = Real(0.0) - l.O[i] / l.D[i];
      if (lo < t && t < hi) cut.push_back(t);
    }
  cut.push_back(hi);
  for (size_t i = 1; i < cut.size(); i++)
    for (size_t k = i; k && cut[k] < cut[k - 1]; k--) std::swap(cut[k], cut[k - 1]);
  int work = 0;
  for (size_t i = 0; i + 1 < cut.size(); i++)
    if (!roots_of(l, cut[i], cut[i + 1], out, work)) return false;
  return true;
}

void judge_ray(const Solid &s, const Asked &a, const double v[6], bool as_text, int aim, uint64_t seed, Totals &t) {
  quoin_intervals said;
  quoin_status status;
  if (as_text) {
    std::string words[6];
    const char *w[6];
    for (int i = 0; i < 6; i++) {
      char buffer[40];
      snprintf(buffer, sizeof buffer, "%.12g", v[i]);
      words[i] = buffer, w[i] = words[i].c_str();
    }
    status = quoin_ray_intervals_text(a.scene, a.work, w, nullptr, nullptr, 0, &said);
  } else {
    quoin_ray ray = {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}, -INFINITY, INFINITY};
    status = quoin_ray_intervals(a.scene, a.work, &ray, 0, &said);
  }
  std::vector<double> ends;
  t.rays++, t.aims[aim]++;
  if (status != QUOIN_OK) return wrong(t, seed, s, v, ends, nullptr, quoin_status_text(status), aim);
  for (size_t i = 0; i < said.count; i++) ends.push_back(said.inside[i].enter.t), ends.push_back(said.inside[i].leave.t);
  Line l;
  l.s = &s;
  Real o[3], d[3], most(0.0);
  for (int i = 0; i < 3; i++) {
    char buffer[40];
    snprintf(buffer, sizeof buffer, "%.12g", v[i]);
    o[i] = (as_text ? Real(buffer) : Real(v[i])) - s.C[i];
    snprintf(buffer, sizeof buffer, "%.12g", v[3 + i]);
    d[i] = as_text ? Real(buffer) : Real(v[3 + i]);
  }
  for (int i = 0; i < 3; i++) {
    l.O[i] = s.local(o, i), l.D[i] = s.local(d, i);
    if (most < l.D[i].abs()) most = l.D[i].abs();
  }
  for (int i = 0; i < 3; i++) { // what is 0 but for the 400 bits
    if (l.D[i].abs() < most * Real(0x1p-300)) l.D[i] = Real(0.0);
    if (l.O[i].abs() < Real(0x1p-300)) l.O[i] = Real(0.0);
  }
  l.size = Real(2.0) / most;
  std::vector<Root> roots;
  if (!truth(l, roots)) {
    t.unjudged++;
    return;
  }
  const double size = l.size.to_double();
  auto last_bit = [](double x) { return std::nextafter(std::fabs(x), INFINITY) - std::fabs(x); };
  size_t k = 0;
  for (size_t i = 0; i <= ends.size(); i++) {
    double far = i < ends.size() ? std::fabs(ends[i]) : roots.empty() ? 0 : roots.back().t.abs().to_double(), close = 0x1p-44 * size + (far > 128 * size ? 0.5 : 8) * last_bit(far);
    // Roots before this end must be pairs that need not be found.
    while (k < roots.size() && (i == ends.size() || roots[k].way != (i % 2 ? 1 : -1) || close < (roots[k].t - Real(ends[i])).abs().to_double())) {
      double wide = k + 1 < roots.size() ? (roots[k + 1].t - roots[k].t).to_double() : INFINITY;
      if (wide > std::max(0x1p-40 * size, std::max(last_bit(roots[k].t.to_double()), k + 1 < roots.size() ? last_bit(roots[k + 1].t.to_double()) : 0))) return wrong(t, seed, s, v, ends, &roots, "a root without its end", aim);
      t.lost++;
      k += 2;
    }
    if (i == ends.size()) break;
    if (k == roots.size()) return wrong(t, seed, s, v, ends, &roots, "an end that is no root", aim);
    double off = (roots[k].t - Real(ends[i])).abs().to_double() / (size + far * 0x1p-8);
    t.most = off > t.most ? off : t.most;
    k++, t.ends++;
  }
  t.judged++, t.hits += !ends.empty();
}

void judge_point(const Solid &s, const Asked &a, const double x[3], uint64_t seed, Totals &t) {
  quoin_side side;
  quoin_status status = quoin_point_side(a.scene, a.work, x, &side);
  Line l;
  l.s = &s;
  Real o[3];
  for (int i = 0; i < 3; i++) o[i] = Real(x[i]) - s.C[i];
  for (int i = 0; i < 3; i++) l.O[i] = s.local(o, i), l.D[i] = Real(0.0);
  Span v;
  l.look(Real(0.0), Real(0.0), v, nullptr);
  int sign = v.sign();
  t.points++, t.on += sign == 0;
  if (status != QUOIN_OK || (sign && side != (sign > 0 ? QUOIN_OUTSIDE : QUOIN_INSIDE))) {
    const double shown[6] = {x[0], x[1], x[2], 0, 0, 0};
    wrong(t, seed, s, shown, {}, nullptr, "side of a point", 0);
  }
}

std::string decimal(Random &r, int lo, int hi, int places) { // lo, hi in units of the last place
  char text[64];
  long v = lo + (long)(r.next() % (uint64_t)(hi - lo + 1)), unit = 1;
  for (int i = 0; i < places; i++) unit *= 10;
  snprintf(text, sizeof text, "%s%ld.%0*ld", v < 0 ? "-" : "", std::labs(v) / unit, places ? places : 1, places ? std::labs(v) % unit : 0L);
  return text;
}

void one_model(uint64_t seed, Totals &t) {
  Random r{seed};
  Solid s;
  static const char *const exponents[] = {"0.5", "1", "2", "3", "4", "0.25", "0.1", "0.05", "1.5", "2.5", "6", "0.02", "8", "0.3", "0.2", "1.9", "2.1", "20", "0.001", "0.0001"};
  auto exponent = [&] { return r.chance(70) ? std::string(exponents[r.below(r.chance(80) ? 16 : 20)]) : decimal(r, 5, 350, 2); };
  s.e = exponent(), s.n = r.chance(15) ? s.e : exponent();
  if (s.e == "1" && s.n == "1") s.e = "1.1";
  int far = r.chance(20) ? r.range(1, 6) : 0;
  for (int i = 0; i < 3; i++) {
    s.c[i] = r.chance(15) ? "0" : decimal(r, -50, 50, 1);
    for (int k = 0; k < far && s.c[i] != "0"; k++) s.c[i] = s.c[i].substr(0, s.c[i].find('.')) + std::string(1, (char)('0' + r.below(10))) + s.c[i].substr(s.c[i].find('.'));
    s.r[i] = r.chance(10) ? decimal(r, 1, 9, r.range(3, 6)) : r.chance(20) ? std::string(1, (char)('1' + r.below(9))) : decimal(r, 1, 500, 2);
    s.angle[i] = r.chance(30) ? "0" : r.chance(50) ? std::to_string(90 * r.below(4)) : r.chance(50) ? std::to_string(15 * r.below(24)) : decimal(r, 0, 3600, 1);
  }
  s.turned = r.chance(35);
  s.make();
  Asked a;
  if (quoin_model_new(nullptr, &a.model) != QUOIN_OK || quoin_model_read_text(a.model, QUOIN_ROOT, "super", s.text.data(), s.text.size(), nullptr) != QUOIN_OK ||
      quoin_scene_compile(a.model, nullptr, &a.scene) != QUOIN_OK || quoin_work_new(a.scene, &a.work) != QUOIN_OK) {
    fprintf(stderr, "refused: %s", s.text.c_str());
    exit(2);
  }
  t.models++;
  for (int k = 0; k < 16; k++) {
    double X[3], D[3], v[6];
    int aim = r.below(Aims), axis = r.below(3);
    for (int i = 0; i < 3; i++) X[i] = r.chance(10) ? 0 : r.real(-1.1, 1.1), D[i] = r.chance(20) ? 0 : r.real(-1, 1);
    auto to_surface = [&](double scale) {
      double m = std::pow(s.f(X), -0.5 * s.N.to_double()) * scale;
      for (double &x : X)
        if (std::isfinite(m)) x *= m;
    };
    auto tangent = [&] { // D at right angles to the gradient, by differences
      double g[3], gg = 0, gd = 0;
      for (int i = 0; i < 3; i++) {
        double Y[3] = {X[0], X[1], X[2]};
        Y[i] += 1e-6, g[i] = s.f(Y), Y[i] -= 2e-6, g[i] -= s.f(Y);
        gg += g[i] * g[i], gd += g[i] * D[i];
      }
      for (int i = 0; gg > 0 && i < 3; i++) D[i] -= g[i] * gd / gg;
    };
    double depth = (r.chance(50) ? -1 : 1) * std::ldexp(1, -r.range(3, 54));
    switch (aim) {
    case Pole: // along the plane of a pole
      for (int i = 0; i < 3; i++) X[i] = r.chance(30) ? 0 : r.real(-1, 1) * std::ldexp(1, -r.range(0, 20));
      X[axis] = r.chance(50) ? 1 : -1, D[axis] = 0;
      if (r.chance(40)) X[axis] *= 1 + depth;
      if (r.chance(20)) D[axis] = std::ldexp(r.real(-1, 1), -r.range(10, 52));
      break;
    case Tangent: to_surface(1 + depth), tangent(); break;
    case Slanted: // next to a pole, nearly along its plane
      for (int i = 0; i < 3; i++) X[i] = r.real(-1, 1) * std::ldexp(1, -r.range(0, 12));
      X[axis] = r.chance(50) ? 1 : -1, to_surface(1 + depth), tangent();
      break;
    case Arms: // from one axis' arm to another's
      for (int i = 0; i < 3; i++) X[i] = r.real(-0.03, 0.03), D[i] = r.real(-0.03, 0.03);
      X[axis] = r.real(0.2, 1), D[(axis + 1) % 3] = r.real(0.2, 1) * (r.chance(50) ? 1 : -1);
      for (int i = 0; i < 3; i++) D[i] -= X[i];
      if (r.chance(30)) tangent();
      break;
    case Plane: // in a coordinate plane, or next to it
      to_surface(1 + depth), tangent(), X[axis] = 0, D[axis] = 0;
      if (r.chance(40)) X[axis] = std::ldexp(r.real(-1, 1), -r.range(10, 60));
      if (r.chance(40)) D[axis] = std::ldexp(r.real(-1, 1), -r.range(10, 60));
      break;
    case Edge: // |x| = |y|, or rho = |z|
      if (r.chance(50)) X[1] = X[0] * (r.chance(50) ? 1 : -1);
      else X[2] = std::hypot(X[0], X[1]);
      to_surface(1 + depth), tangent();
      break;
    default: break;
    }
    if (D[0] == 0 && D[1] == 0 && D[2] == 0) D[axis == 0] = 1;
    double back = r.chance(20) ? 0 : r.chance(85) ? r.real(0, 10) : std::ldexp(1, r.range(4, 52)), o[3], d[3];
    for (int i = 0; i < 3; i++) d[i] = s.world(D, i);
    for (int i = 0; i < 3; i++) {
      o[i] = s.C[i].to_double() + s.world(X, i) - back * d[i];
      v[i] = o[i], v[3 + i] = d[i];
    }
    if (aim == Pole && !s.turned && r.chance(60)) // some last bits from it
      for (int m = r.below(4); m > 0; m--) v[axis] = std::nextafter(v[axis], r.chance(50) ? INFINITY : -INFINITY);
    if ((v[3] == 0 && v[4] == 0 && v[5] == 0) || !std::isfinite(v[0] + v[1] + v[2] + v[3] + v[4] + v[5])) continue; // a gradient may be beyond doubles
    judge_ray(s, a, v, r.chance(15), aim, seed, t);
    if (r.chance(40)) {
      to_surface(1 + depth * std::ldexp(1, -r.range(0, 2)));
      double x[3];
      for (int i = 0; i < 3; i++) x[i] = s.C[i].to_double() + s.world(X, i);
      if (std::isfinite(x[0] + x[1] + x[2])) judge_point(s, a, x, seed, t);
    }
  }
  quoin_work_free(a.work), quoin_scene_free(a.scene), quoin_model_free(a.model);
}
} // namespace

int main(int argc, char **argv) {
  uint64_t seed = 1, again = 0;
  double seconds = 5;
  long models = 0;
  for (int i = 1; i + 1 < argc; i += 2) {
    std::string a = argv[i];
    if (a == "--seed") seed = strtoull(argv[i + 1], nullptr, 10);
    else if (a == "--seconds") seconds = atof(argv[i + 1]);
    else if (a == "--models") models = atol(argv[i + 1]);
    else if (a == "--again") again = strtoull(argv[i + 1], nullptr, 10);
    else if (a != "--leaves" && a != "--finds") return fprintf(stderr, "unknown option %s\n", a.c_str()), 2;
  }
  Totals t;
  auto begin = std::chrono::steady_clock::now();
  auto passed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  if (again) one_model(again, t);
  else {
    Random seeds{seed};
    for (long k = 0; (models ? k < models : passed() < seconds) && t.wrong < 20; k++) one_model(seeds.next() | 1, t);
  }
  printf("super seed=%llu seconds=%.1f models=%llu rays=%llu exact=%llu unjudged=%llu ends=%llu points=%llu wrong=%llu n.super.rays_with_stretches=%llu n.super.pairs_not_found=%llu n.super.points_on=%llu",
         (unsigned long long)seed, passed(), t.models, t.rays, t.judged, t.unjudged, t.ends, t.points, t.wrong, t.hits, t.lost, t.on);
  for (int i = 0; i < Aims; i++) printf(" n.super_aim.%s=%llu", AIMS[i], t.aims[i]);
  printf(" off=%.3g\n", t.most);
  return t.wrong != 0;
}
