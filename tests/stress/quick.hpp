// The quick judge: a ray's stretches in quadruple precision, every number with a bound on its error. Where all bounds keep apart it
// knows the exact answer; else it says that it does not know, and the exact judge is asked.
//
// A number is v with |truth - v| <= e. One operation in round to nearest of __float128 has a relative error of at most u = 2^-113;
// e is a double, so each sum of errors is widened by 1 + 2^-40, which covers its own roundings, and by the least number that counts,
// 2^-960, which covers underflow of e (numbers whose products fall below 2^-900 are left to the exact judge).
#pragma once
#include "spec.hpp"
#include "../oracle/evaluate.hpp"

#include <cstring>
#include <map>

namespace stress {
using Wide = __float128;
struct Num { Wide v; double e; };

inline double mag(Wide v) { return std::fabs((double)v) * (1 + 0x1p-50); }
inline Num made(Wide v, double e) { return {v, (e + mag(v) * 0x1p-112 + 0x1p-960) * (1 + 0x1p-40)}; }
inline Num exactly(double v) { return {v, 0}; }
inline bool none(const Num &a) { return a.v == 0 && a.e == 0; }
// Significant bits of a number, 0 to 113.
inline int bits_of(Wide v) {
  unsigned __int128 m;
  memcpy(&m, &v, 16);
  m &= ((unsigned __int128)1 << 112) - 1;
  m |= (unsigned __int128)1 << 112;
  uint64_t low = (uint64_t)m;
  return 113 - (low ? __builtin_ctzll(low) : 64 + __builtin_ctzll((uint64_t)(m >> 64)));
}
inline bool plain_size(Wide v) { return mag(v) > 0x1p-900 && mag(v) < 0x1p900; }
inline Num operator+(const Num &a, const Num &b) {
  if (none(a)) return b;
  if (none(b)) return a;
  Wide s = a.v + b.v;
  if (a.e == 0 && b.e == 0) { // the error of a sum is itself a number: 0 says that it is exact
    Wide t = s - a.v;
    if ((a.v - (s - t)) + (b.v - t) == 0) return {s, 0};
  }
  return made(s, a.e + b.e);
}
inline Num operator-(const Num &a) { return {-a.v, a.e}; }
inline Num operator-(const Num &a, const Num &b) { return a + -b; }
inline Num operator*(const Num &a, const Num &b) {
  if (none(a) || none(b)) return {0, 0};
  if (a.e == 0 && b.e == 0 && plain_size(a.v) && plain_size(b.v) && bits_of(a.v) + bits_of(b.v) <= 113) return {a.v * b.v, 0};
  return made(a.v * b.v, mag(a.v) * b.e + mag(b.v) * a.e + a.e * b.e);
}
// 1, -1; 0: zero for certain; 2: not known
inline int sign_of(const Num &a) {
  if (a.v > a.e) return 1;
  if (-a.v > a.e) return -1;
  return none(a) ? 0 : 2;
}
// b of a known sign.
inline Num operator/(const Num &a, const Num &b) {
  if (none(a)) return a;
  if (a.e == 0 && b.e == 0) {
    Num q{a.v / b.v, 0}, back = q * b;
    if (back.e == 0 && back.v == a.v) return q;
  }
  double least = (double)(b.v < 0 ? -b.v : b.v) * (1 - 0x1p-50) - b.e, q = mag(a.v / b.v);
  return made(a.v / b.v, (a.e + q * b.e) / least);
}
// a > a.e
inline Num root_of(const Num &a) {
  int e;
  double m = std::frexp((double)a.v, &e);
  if (e & 1) m *= 2, e--;
  Wide s = std::sqrt(m), x = a.v;
  // x = m 4^(e/2): scaled by a power of two, which is exact
  Wide half = 1;
  for (int k = std::abs(e / 2); k > 0;) {
    int step = std::min(k, 500);
    half *= (Wide)std::ldexp(1.0, e < 0 ? -step : step);
    k -= step;
  }
  s *= half;
  for (int i = 0; i < 3; i++) s = (s + x / s) / 2;
  if (a.e == 0) {
    Num r{s, 0}, back = r * r;
    if (back.e == 0 && back.v == x) return r;
  }
  // |s - sqrt x| <= |s^2 - x| / s, and the truth's root is within a.e / sqrt(x - e)
  double least = std::sqrt((double)a.v * (1 - 0x1p-50) - a.e) * (1 - 0x1p-40);
  return made(s, (mag(s * s - x) + mag(x) * 0x1p-111) / ((double)s * (1 - 0x1p-40)) + a.e / least);
}

inline Num from_rational(const Q &q) {
  if (q == 0) return {0, 0};
  // 116 leading bits by integer division
  CGAL::Gmpz n = q.numerator(), d = q.denominator();
  bool negative = n < 0;
  if (negative) n = -n;
  long shift = 116 - ((long)mpz_sizeinbase(n.mpz(), 2) - (long)mpz_sizeinbase(d.mpz(), 2));
  mpz_t t;
  mpz_init(t);
  if (shift >= 0) mpz_mul_2exp(t, n.mpz(), (unsigned long)shift), mpz_tdiv_q(t, t, d.mpz());
  else {
    mpz_t w;
    mpz_init(w);
    mpz_mul_2exp(w, d.mpz(), (unsigned long)-shift), mpz_tdiv_q(t, n.mpz(), w);
    mpz_clear(w);
  }
  Wide v = 0;
  mpz_t part;
  mpz_init(part);
  for (int i = 3; i >= 0; i--) { // 32 bits a time, exactly until the last rounding
    mpz_tdiv_q_2exp(part, t, 32u * (unsigned)i);
    mpz_tdiv_r_2exp(part, part, 32);
    v = v * (Wide)4294967296.0 + (Wide)(double)mpz_get_ui(part);
  }
  mpz_clear(part), mpz_clear(t);
  for (long k = std::labs(shift); k > 0;) {
    long step = std::min(k, 500L);
    v *= (Wide)std::ldexp(1.0, shift > 0 ? (int)-step : (int)step);
    k -= step;
  }
  if (negative) v = -v;
  double back = (double)v;
  if (std::isfinite(back) && v == (Wide)back && Q(back) == q) return {v, 0};
  return made(v, mag(v) * 0x1p-110);
}

// A place on the ray where a surface's sign changes.
struct Cut { Num t; uint32_t surface; int which; };
struct Solved { int state = -1; int first = 0, roots = 0; Num root[2]; }; // state: -1 not yet, 0 not known, 1 known

// The scene as the quick judge holds it.
struct Quick {
  struct Form { // about the pivot: y'Ay + 2 b.y + c
    Num a[6], b[3], c;
    double pivot[3];
    bool plane;
  };
  struct Use { uint32_t leaf; int side; };
  struct Gate { Node::Op op; uint32_t parent; bool first; };
  std::vector<Form> forms;
  std::vector<std::vector<Use>> uses;
  std::vector<Ball> balls;
  std::vector<uint32_t> leaf_parent, leaf_halves;
  std::vector<uint8_t> leaf_first;
  std::vector<Gate> gates;

  // scratch of one ray
  std::vector<Solved> solved;
  std::vector<uint32_t> failing;
  std::vector<int> leaf_on, gate_first, gate_others, sign;
  std::vector<uint8_t> touched;
  bool root_on = false;

  Quick(const Node &solid, const std::vector<Ball> &b) : balls(b) {
    std::map<std::vector<Q>, uint32_t> known;
    add(solid, UINT32_MAX, false, known);
    solved.resize(forms.size()), sign.resize(forms.size());
    failing.resize(leaf_halves.size()), leaf_on.resize(leaf_halves.size()), touched.resize(leaf_halves.size());
    gate_first.resize(gates.size()), gate_others.resize(gates.size());
  }
  void add(const Node &n, uint32_t parent, bool first, std::map<std::vector<Q>, uint32_t> &known) {
    if (n.op != Node::IsLeaf) {
      uint32_t me = (uint32_t)gates.size();
      gates.push_back({n.op, parent, first});
      for (size_t i = 0; i < n.kids.size(); i++) add(n.kids[i], me, i == 0, known);
      return;
    }
    uint32_t leaf = (uint32_t)leaf_halves.size();
    leaf_parent.push_back(parent), leaf_first.push_back(first), leaf_halves.push_back((uint32_t)n.leaf.halves.size());
    for (auto &q : n.leaf.halves) {
      std::vector<Q> key;
      Q by = 0;
      for (int i = 0; i < 4; i++)
        for (int j = i; j < 4; j++) {
          if (by == 0) by = q.a[i][j];
          key.push_back(by == 0 ? Q(0) : q.a[i][j] / by);
        }
      int side = CGAL::sign(by);
      auto found = known.find(key);
      if (found == known.end()) {
        found = known.emplace(key, (uint32_t)forms.size()).first;
        Form f;
        V p;
        const Ball &b = balls[leaf];
        for (int i = 0; i < 3; i++) f.pivot[i] = b.centre[i], p[i] = Q(f.pivot[i]);
        auto at = [&](int i, int j) { return q.a[i][j] / by; };
        int k = 0;
        f.plane = true;
        for (int i = 0; i < 3; i++)
          for (int j = i; j < 3; j++, k++) f.a[k] = from_rational((i == j ? Q(1) : Q(2)) * at(i, j)), f.plane = f.plane && at(i, j) == 0;
        Q c = at(3, 3);
        for (int i = 0; i < 3; i++) {
          Q g = at(i, 3);
          for (int j = 0; j < 3; j++) g += at(i, j) * p[j];
          f.b[i] = from_rational(g);
          c += (g + at(i, 3)) * p[i];
        }
        f.c = from_rational(c);
        forms.push_back(f), uses.emplace_back();
      }
      uses[found->second].push_back({leaf, side});
    }
  }
  int gate_value(uint32_t g) const {
    switch (gates[g].op) {
    case Node::Union: return gate_first[g] + gate_others[g] > 0;
    case Node::Difference: return gate_first[g] > 0 && gate_others[g] == 0;
    default: return gate_first[g] == 0; // counts of children that do not hold
    }
  }
  void pass(uint32_t parent, bool first, int on) {
    for (uint32_t g = parent; g != UINT32_MAX; g = gates[g].parent) {
      int before = gate_value(g);
      if (gates[g].op == Node::Intersection) gate_first[g] += on ? -1 : 1;
      else (first ? gate_first[g] : gate_others[g]) += on ? 1 : -1;
      int after = gate_value(g);
      if (after == before) return;
      on = after, first = gates[g].first;
    }
    root_on = on;
  }
  void set_leaf(uint32_t l, int on) {
    if (leaf_on[l] != on) leaf_on[l] = on, pass(leaf_parent[l], leaf_first[l], on);
  }
  // Every leaf off. Intersections count children that do not hold: all of them.
  void rest() {
    root_on = false;
    std::fill(leaf_on.begin(), leaf_on.end(), 0);
    std::fill(failing.begin(), failing.end(), 0);
    std::fill(gate_first.begin(), gate_first.end(), 0);
    std::fill(gate_others.begin(), gate_others.end(), 0);
    auto off = [&](uint32_t parent) {
      if (parent != UINT32_MAX && gates[parent].op == Node::Intersection) gate_first[parent]++;
    };
    for (auto &g : gates) off(g.parent);
    for (uint32_t p : leaf_parent) off(p);
  }
  // The side of a point: 0 outside, 2 inside, -1 not known.
  int side(const double p[3]) {
    for (size_t l = 0; l < touched.size(); l++) {
      const Ball &b = balls[l];
      double far = 0, size = 0;
      for (int i = 0; i < 3; i++) far = std::hypot(far, p[i] - b.centre[i]), size += std::fabs(p[i]) + std::fabs(b.centre[i]);
      touched[l] = !(far > b.radius * 1.001 + size * 0x1p-40);
    }
    rest();
    for (uint32_t s = 0; s < forms.size(); s++) {
      bool any = false;
      for (auto &use : uses[s]) any |= touched[use.leaf] != 0;
      if (!any) continue;
      const Form &f = forms[s];
      Num y[3], c = f.c;
      for (int i = 0; i < 3; i++) y[i] = exactly(p[i]) - exactly(f.pivot[i]), c = c + exactly(2) * (f.b[i] * y[i]);
      static const int at[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
      for (int k = 0; k < 6; k++)
        if (!none(f.a[k])) c = c + f.a[k] * (y[at[k][0]] * y[at[k][1]]);
      int sc = sign_of(c);
      if (sc == 2 || sc == 0) return -1;
      for (auto &use : uses[s]) failing[use.leaf] += sc * use.side > 0;
    }
    for (uint32_t l = 0; l < touched.size(); l++) set_leaf(l, touched[l] && failing[l] == 0);
    return root_on ? 2 : 0;
  }
  void solve(uint32_t s, const double o[3], const double d[3]) {
    Solved &r = solved[s];
    const Form &f = forms[s];
    r = Solved();
    r.state = 0;
    Num y[3], D[3], h{0, 0}, c = f.c;
    for (int i = 0; i < 3; i++) y[i] = exactly(o[i]) - exactly(f.pivot[i]), D[i] = exactly(d[i]);
    for (int i = 0; i < 3; i++) h = h + f.b[i] * D[i], c = c + exactly(2) * (f.b[i] * y[i]);
    if (f.plane) {
      h = h + h;
      int sh = sign_of(h), sc = sign_of(c);
      if (sh == 0) {
        if (sc == 2 || sc == 0) return;
        r.state = 1, r.first = sc;
      } else if (sh != 2) {
        r.state = 1, r.first = -sh, r.roots = 1, r.root[0] = -c / h;
      }
      return;
    }
    Num a{0, 0};
    static const int at[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
    for (int k = 0; k < 6; k++) {
      if (none(f.a[k])) continue;
      int i = at[k][0], j = at[k][1];
      a = a + f.a[k] * (D[i] * D[j]);
      c = c + f.a[k] * (y[i] * y[j]);
      h = h + f.a[k] * (i == j ? y[i] * D[i] : (y[i] * D[j] + y[j] * D[i]) * exactly(0.5));
    }
    int sa = sign_of(a), sh = sign_of(h);
    if (sa == 2) return;
    if (sa == 0) {
      if (sh == 2) return;
      int sc = sign_of(c);
      if (sh == 0) {
        if (sc == 2 || sc == 0) return;
        r.state = 1, r.first = sc;
      } else r.state = 1, r.first = -sh, r.roots = 1, r.root[0] = -c / (h + h);
      return;
    }
    Num disc = h * h - a * c;
    int sd = sign_of(disc);
    if (sd == 2) return;
    r.first = sa;
    if (sd <= 0) {
      r.state = 1;
      return;
    }
    Num s1 = root_of(disc);
    if (sh == 2 && !(mag(h.v) + h.e < mag(s1.v) * 0.5)) return;
    bool plus = h.v >= 0;
    Num q = plus ? -(h + s1) : s1 - h; // no cancellation
    if (sign_of(q) == 2) return;
    Num x1 = q / a, x2 = c / q;
    if (x1.v > x2.v) std::swap(x1, x2);
    r.root[0] = x1, r.root[1] = x2, r.roots = 2, r.state = 1;
  }
  static bool before(const Num &a, const Num &b) { return b.v - a.v > (Wide)a.e + (Wide)b.e; }
  static bool same(const Num &a, const Num &b) { return a.e == 0 && b.e == 0 && a.v == b.v; }

  struct Found { std::vector<Cut> cuts; std::vector<uint8_t> in; }; // stretch i lies before cut i
  // False: not known.
  bool shoot(const double o[3], const double d[3], Found &out) {
    out.cuts.clear(), out.in.clear();
    for (int i = 0; i < 3; i++) {
      if (o[i] != 0 && !(std::fabs(o[i]) > 0x1p-300 && std::fabs(o[i]) < 0x1p300)) return false;
      if (d[i] != 0 && !(std::fabs(d[i]) > 0x1p-300 && std::fabs(d[i]) < 0x1p300)) return false;
    }
    double big = std::max({std::fabs(d[0]), std::fabs(d[1]), std::fabs(d[2])}), u[3] = {d[0] / big, d[1] / big, d[2] / big};
    double uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    for (size_t l = 0; l < touched.size(); l++) { // leaves far from the line are off all along
      const Ball &b = balls[l];
      touched[l] = 1;
      if (std::isfinite(b.radius)) {
        double y[3], size = 0;
        for (int i = 0; i < 3; i++) y[i] = o[i] - b.centre[i], size += std::fabs(o[i]) + std::fabs(b.centre[i]);
        double c[3] = {y[1] * u[2] - y[2] * u[1], y[2] * u[0] - y[0] * u[2], y[0] * u[1] - y[1] * u[0]};
        double far = std::sqrt((c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) / uu);
        touched[l] = !(far > b.radius * 1.001 + size * 0x1p-40);
      }
    }
    for (auto &s : solved) s.state = -1;
    rest();
    for (uint32_t s = 0; s < forms.size(); s++) {
      bool any = false;
      for (auto &use : uses[s]) any |= touched[use.leaf] != 0;
      if (!any) continue;
      solve(s, o, d);
      if (solved[s].state == 0) return false;
      for (int k = 0; k < solved[s].roots; k++) out.cuts.push_back({solved[s].root[k], s, k});
      if (solved[s].roots == 2 && !before(solved[s].root[0], solved[s].root[1])) return false;
      sign[s] = solved[s].first;
      for (auto &use : uses[s])
        if (sign[s] * use.side > 0) failing[use.leaf]++;
    }
    std::sort(out.cuts.begin(), out.cuts.end(), [](const Cut &a, const Cut &b) { return a.t.v < b.t.v; });
    for (size_t i = 1; i < out.cuts.size(); i++)
      if (!before(out.cuts[i - 1].t, out.cuts[i].t) && !same(out.cuts[i - 1].t, out.cuts[i].t)) return false;
    for (uint32_t l = 0; l < touched.size(); l++) set_leaf(l, touched[l] && failing[l] == 0);
    size_t kept = 0;
    bool on = root_on;
    out.in.push_back(on);
    for (size_t i = 0; i < out.cuts.size();) {
      const Cut first = out.cuts[i];
      for (; i < out.cuts.size() && (out.cuts[i].t.v == first.t.v); i++) { // equal only where both are exact
        uint32_t s = out.cuts[i].surface;
        sign[s] = -sign[s];
        for (auto &use : uses[s]) {
          if (!touched[use.leaf]) continue;
          failing[use.leaf] += sign[s] * use.side > 0 ? 1 : -1;
          set_leaf(use.leaf, failing[use.leaf] == 0);
        }
      }
      if (root_on != on) on = root_on, out.cuts[kept++] = first, out.in.push_back(on);
    }
    out.cuts.resize(kept);
    return true;
  }
};
// Is t the double nearest to r? 1 yes, 0 no, 2 not known.
inline int nearest_quick(double t, const Num &r) {
  if (!std::isfinite(t)) return 2;
  double below = std::nextafter(t, -INFINITY), above = std::nextafter(t, INFINITY);
  if (!std::isfinite(below) || !std::isfinite(above)) return 2;
  Wide lo = ((Wide)t + (Wide)below) / 2, hi = ((Wide)t + (Wide)above) / 2;
  if (r.v - r.e > lo && r.v + r.e < hi) return 1;
  if (r.v + r.e < lo || r.v - r.e > hi) return 0;
  return 2;
}
} // namespace stress
