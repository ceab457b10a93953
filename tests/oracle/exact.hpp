// Rational vectors, affine maps and quadrics: the oracle's own textbook forms, sharing nothing with the library.
#pragma once
#include <CGAL/Gmpq.h>
#include <CGAL/Gmpz.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace oracle {
using Q = CGAL::Gmpq;
using V = std::array<Q, 3>;

inline Q pow2(int e) {
  Q r(1), two(2);
  for (int i = 0; i < (e < 0 ? -e : e); i++) r *= two;
  return e < 0 ? Q(1) / r : r;
}
inline Q pow10(int e) {
  Q r(1), ten(10);
  for (int i = 0; i < (e < 0 ? -e : e); i++) r *= ten;
  return e < 0 ? Q(1) / r : r;
}
inline V operator+(const V &a, const V &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline V operator-(const V &a, const V &b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline V operator*(const Q &s, const V &a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Q dot(const V &a, const V &b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline V cross(const V &a, const V &b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline bool zero(const V &a) { return a[0] == 0 && a[1] == 0 && a[2] == 0; }

// An affine map x' = m x + t.
struct Map {
  std::array<V, 3> m{V{1, 0, 0}, V{0, 1, 0}, V{0, 0, 1}};
  V t{0, 0, 0};
  V linear(const V &x) const { return {dot(m[0], x), dot(m[1], x), dot(m[2], x)}; }
  V operator()(const V &x) const { return linear(x) + t; }
};
inline Map compose(const Map &a, const Map &b) { // a after b
  Map r;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      r.m[i][j] = 0;
      for (int k = 0; k < 3; k++) r.m[i][j] += a.m[i][k] * b.m[k][j];
    }
  r.t = a(b.t);
  return r;
}
inline Map inverse(const Map &a) {
  V r0 = cross(a.m[1], a.m[2]), r1 = cross(a.m[2], a.m[0]), r2 = cross(a.m[0], a.m[1]);
  Q det = dot(a.m[0], r0);
  if (det == 0) throw std::logic_error("singular map");
  Map r;
  for (int i = 0; i < 3; i++) r.m[i] = V{r0[i] / det, r1[i] / det, r2[i] / det};
  r.t = Q(-1) * r.linear(a.t);
  return r;
}

// q(x) = (x,1)^T A (x,1), A symmetric.
struct Quadric {
  std::array<std::array<Q, 4>, 4> a{};
  Quadric() {
    for (auto &r : a)
      for (auto &e : r) e = 0;
  }
  Q bilinear(const std::array<Q, 4> &x, const std::array<Q, 4> &y) const {
    Q s(0);
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) s += x[i] * a[i][j] * y[j];
    return s;
  }
  Q operator()(const V &x) const {
    std::array<Q, 4> h{x[0], x[1], x[2], 1};
    return bilinear(h, h);
  }
  V gradient(const V &x) const {
    V g;
    for (int i = 0; i < 3; i++) g[i] = 2 * (a[i][0] * x[0] + a[i][1] * x[1] + a[i][2] * x[2] + a[i][3]);
    return g;
  }
};
inline Quadric diagonal(const Q &x, const Q &y, const Q &z, const Q &k) {
  Quadric q;
  q.a[0][0] = x, q.a[1][1] = y, q.a[2][2] = z, q.a[3][3] = k;
  return q;
}
inline Quadric plane(const V &n, const Q &d) { // n.x - d
  Quadric q;
  for (int i = 0; i < 3; i++) q.a[i][3] = q.a[3][i] = n[i] / 2;
  q.a[3][3] = -d;
  return q;
}
inline Quadric transformed(const Quadric &q, const Map &map) { // M^-T Q M^-1
  Map inv = inverse(map);
  std::array<std::array<Q, 4>, 4> w;
  for (int i = 0; i < 3; i++) w[i] = {inv.m[i][0], inv.m[i][1], inv.m[i][2], inv.t[i]};
  w[3] = {Q(0), Q(0), Q(0), Q(1)};
  Quadric r;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      Q s(0);
      for (int k = 0; k < 4; k++)
        for (int l = 0; l < 4; l++) s += w[k][i] * q.a[k][l] * w[l][j];
      r.a[i][j] = s;
    }
  return r;
}
inline bool proportional(const Quadric &p, const Quadric &q) {
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      if (p.a[i][j] != 0) {
        Q f = q.a[i][j] / p.a[i][j];
        if (f == 0) return false;
        for (int k = 0; k < 4; k++)
          for (int l = 0; l < 4; l++)
            if (q.a[k][l] != f * p.a[k][l]) return false;
        return true;
      }
  return false;
}

// A finite decimal as text; throws when the number is none.
inline std::string decimal(const Q &q) {
  CGAL::Gmpz num = q.numerator(), den = q.denominator();
  int places = 0;
  while (den != 1) {
    CGAL::Gmpz g = CGAL::gcd(den, CGAL::Gmpz(10));
    if (g == 1) throw std::logic_error("not a decimal");
    num *= CGAL::Gmpz(10), places++;
    CGAL::Gmpz c = CGAL::gcd(num, den);
    num = CGAL::integral_division(num, c), den = CGAL::integral_division(den, c);
  }
  bool negative = num < 0;
  std::ostringstream os;
  os << (negative ? -num : num);
  std::string s = os.str();
  if (places) {
    while ((int)s.size() <= places) s = "0" + s;
    s.insert(s.size() - places, ".");
  }
  return (negative ? "-" : "") + s;
}
inline bool is_decimal(const Q &q) {
  CGAL::Gmpz den = q.denominator();
  while (den != 1) {
    CGAL::Gmpz g = CGAL::gcd(den, CGAL::Gmpz(10));
    if (g == 1) return false;
    den = CGAL::integral_division(den, g);
  }
  return true;
}
inline std::string text(const V &v) { return "[" + decimal(v[0]) + "," + decimal(v[1]) + "," + decimal(v[2]) + "]"; }

// A small generator of its own, the same everywhere: splitmix64.
struct Random {
  uint64_t x;
  explicit Random(uint64_t seed) : x(seed) {}
  uint64_t next() {
    uint64_t z = (x += 0x9E3779B97F4A7C15u);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }
  int below(int n) { return (int)(next() % (uint64_t)n); }
  int range(int lo, int hi) { return lo + below(hi - lo + 1); }
  bool chance(int percent) { return below(100) < percent; }
  Q tenth(int lo, int hi) { return Q(range(lo, hi)) / Q(10); }
};
} // namespace oracle
