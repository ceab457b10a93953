// Rational vectors, affine maps and quadrics: the oracle's own textbook forms, sharing nothing with the library.
#pragma once
#include "random.hpp"

#include <CGAL/Gmpq.h>
#include <CGAL/Gmpz.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

namespace oracle {
using Q = CGAL::Gmpq;
using V = std::array<Q, 3>;

inline CGAL::Gmpz shifted_one(int by) {
  CGAL::Gmpz z(1);
  mpz_mul_2exp(z.mpz(), z.mpz(), (unsigned long)by);
  return z;
}
inline Q pow2(int e) { return e < 0 ? Q(CGAL::Gmpz(1), shifted_one(-e)) : Q(shifted_one(e)); }
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
  std::array<std::array<Q, 4>, 4> qw; // Q W, then W^T of that
  Quadric r;
  auto product = [](auto left, auto right, auto &to) {
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) {
        Q s(0);
        for (int k = 0; k < 4; k++)
          if (left(i, k) != 0 && right(k, j) != 0) s += left(i, k) * right(k, j);
        to[i][j] = s;
      }
  };
  product([&](int i, int k) { return q.a[i][k]; }, [&](int k, int j) { return w[k][j]; }, qw);
  product([&](int i, int k) { return w[k][i]; }, [&](int k, int j) { return qw[k][j]; }, r.a);
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

// How often 2 and 5 divide a denominator; false when another prime does.
inline bool places_of(const CGAL::Gmpz &den, unsigned long &twos, unsigned long &fives) {
  mpz_t z, five;
  mpz_init_set(z, den.mpz()), mpz_init_set_ui(five, 5);
  twos = mpz_scan1(z, 0);
  mpz_tdiv_q_2exp(z, z, twos);
  fives = mpz_remove(z, z, five);
  bool clean = mpz_cmp_ui(z, 1) == 0;
  mpz_clear(z), mpz_clear(five);
  return clean;
}
inline bool is_decimal(const Q &q) {
  unsigned long twos, fives;
  return places_of(q.denominator(), twos, fives);
}
// A finite decimal as text; throws when the number is none.
inline std::string decimal(const Q &q) {
  unsigned long twos, fives;
  if (!places_of(q.denominator(), twos, fives)) throw std::logic_error("not a decimal");
  size_t places = std::max(twos, fives);
  mpz_t n;
  mpz_init(n);
  mpz_ui_pow_ui(n, fives < twos ? 5 : 2, fives < twos ? twos - fives : fives - twos);
  mpz_mul(n, n, q.numerator().mpz());
  bool negative = mpz_sgn(n) < 0;
  mpz_abs(n, n);
  std::string s(mpz_sizeinbase(n, 10) + 2, 0);
  mpz_get_str(&s[0], 10, n);
  s.resize(strlen(s.c_str()));
  mpz_clear(n);
  if (places) {
    if (s.size() <= places) s.insert(0, places + 1 - s.size(), '0');
    s.insert(s.size() - places, ".");
  }
  return (negative ? "-" : "") + s;
}
inline std::string text(const V &v) { return "[" + decimal(v[0]) + "," + decimal(v[1]) + "," + decimal(v[2]) + "]"; }

inline Q tenth(Random &r, int lo, int hi) { return Q(r.range(lo, hi)) / Q(10); }
} // namespace oracle
