// Numbers with a bound on their error, in doubles and in quadruple precision.
//
// A number is v with |truth - v| <= e. One operation in round to nearest has a relative error of at most u, 2^-53 or 2^-113; e is a double,
// so each sum of errors is widened by 1 + 2^-40, which covers its own roundings, and by 2^-960, which covers underflow of e (products
// below 2^-900 are never taken to be exact). e = 0 says that v is exact: ties can be decided among such numbers.
#pragma once
#include "../oracle/evaluate.hpp"

#include <cmath>
#include <cstring>

namespace stress {
using namespace oracle;
using oracle::operator+, oracle::operator-, oracle::operator*; // of vectors: the operators here would hide them
using Wide = __float128;
template <class T> struct About { T v; double e; };
using Fast = About<double>;
using Num = About<Wide>;

inline double mag(double v) { return std::fabs(v); }
inline double mag(Wide v) { return std::fabs((double)v) * (1 + 0x1p-50); }
template <class T> constexpr double rounding() { return sizeof(T) == 8 ? 0x1p-52 : 0x1p-112; } // 2u
template <class T> About<T> made(T v, double e) { return {v, (e + mag(v) * rounding<T>() + 0x1p-960) * (1 + 0x1p-40)}; }
template <class T> bool none(const About<T> &a) { return a.e == 0 && a.v == 0; }
// Significant bits of a number, 0 to 113.
inline int bits_of(Wide v) {
  unsigned __int128 m;
  memcpy(&m, &v, 16);
  m &= ((unsigned __int128)1 << 112) - 1;
  m |= (unsigned __int128)1 << 112;
  uint64_t low = (uint64_t)m;
  return 113 - (low ? __builtin_ctzll(low) : 64 + __builtin_ctzll((uint64_t)(m >> 64)));
}
template <class T> bool plain_size(T v) { return mag(v) > 0x1p-900 && mag(v) < 0x1p900; }
inline bool exact_product(double a, double b, double p) { return plain_size(p) && std::fma(a, b, -p) == 0; }
inline bool exact_product(Wide a, Wide b, Wide) { return plain_size(a) && plain_size(b) && bits_of(a) + bits_of(b) <= 113; }
template <class T> About<T> operator+(const About<T> &a, const About<T> &b) {
  if (none(a)) return b;
  if (none(b)) return a;
  T s = a.v + b.v;
  if (a.e == 0 && b.e == 0) { // the error of a sum is itself a number: 0 says that it is exact
    T t = s - a.v;
    if ((a.v - (s - t)) + (b.v - t) == 0) return {s, 0};
  }
  return made(s, a.e + b.e);
}
template <class T> About<T> operator-(const About<T> &a) { return {-a.v, a.e}; }
template <class T> About<T> operator-(const About<T> &a, const About<T> &b) { return a + -b; }
template <class T> About<T> operator*(const About<T> &a, const About<T> &b) {
  if (none(a) || none(b)) return {0, 0};
  T p = a.v * b.v;
  if (a.e == 0 && b.e == 0 && exact_product(a.v, b.v, p)) return {p, 0};
  return made(p, mag(a.v) * b.e + mag(b.v) * a.e + a.e * b.e);
}
// 1, -1; 0: zero for certain; 2: not known
template <class T> int sign_of(const About<T> &a) {
  if (a.v > a.e) return 1;
  if (-a.v > a.e) return -1;
  return none(a) ? 0 : 2;
}
// b of a known sign.
template <class T> About<T> operator/(const About<T> &a, const About<T> &b) {
  if (none(a)) return a;
  T v = a.v / b.v;
  if (a.e == 0 && b.e == 0) {
    About<T> q{v, 0}, back = q * b;
    if (back.e == 0 && back.v == a.v) return q;
  }
  double least = std::fabs((double)b.v) * (1 - 0x1p-50) - b.e;
  return made(v, least > 0 ? (a.e + mag(v) * b.e) / least * (1 + 0x1p-40) : INFINITY);
}
// a > a.e
inline Fast root_of(const Fast &a) {
  double s = std::sqrt(a.v);
  if (a.e == 0 && exact_product(s, s, a.v)) return {s, 0};
  double least = std::sqrt(a.v - a.e) * (1 - 0x1p-40); // a.v - a.e rounds to no less than 2^-53 of a.v off
  return made(s, least > 0 ? a.e / least : INFINITY);
}
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
  for (int i = 0; i < 2; i++) s = (s + x / s) / 2;
  if (a.e == 0) {
    Num r{s, 0}, back = r * r;
    if (back.e == 0 && back.v == x) return r;
  }
  // |s - sqrt x| <= |s^2 - x| / s, and the truth's root is within a.e / sqrt(x - e)
  double least = std::sqrt((double)a.v * (1 - 0x1p-50) - a.e) * (1 - 0x1p-40);
  if (!(least > 0)) return {s, INFINITY};
  return made(s, (mag(s * s - x) + mag(x) * 0x1p-111) / ((double)s * (1 - 0x1p-40)) + a.e / least);
}
// z 2^-shift
inline Num from_integer(const Z &z, long shift) {
  if (z == 0) return {0, 0};
  mpz_srcptr p = z.mpz();
  size_t n = mpz_size(p), used = std::min<size_t>(n, 3);
  Wide v = 0;
  for (size_t i = 0; i < used; i++) { // 32 bits a time; three limbs are at least 129 bits, and rounded within 2^-112 each time
    uint64_t limb = mpz_getlimbn(p, (mp_size_t)(n - 1 - i));
    v = v * (Wide)4294967296.0 + (Wide)(double)(limb >> 32);
    v = v * (Wide)4294967296.0 + (Wide)(double)(limb & 0xffffffffu);
  }
  long up = (long)(64 * (n - used)) - shift;
  bool whole = mpz_sizeinbase(p, 2) - mpz_scan1(p, 0) <= 113;
  for (long k = std::labs(up); k > 0;) {
    long step = std::min(k, 500L);
    v *= (Wide)std::ldexp(1.0, up < 0 ? (int)-step : (int)step);
    k -= step;
  }
  if (z < 0) v = -v;
  return whole && n <= 3 ? Num{v, 0} : made(v, mag(v) * 0x1p-108);
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
