// Long numbers and intervals of them, in MPFR, as the judge of superquadrics needs them.
#pragma once
#include <mpfr.h>

#include <utility>

namespace stress {
enum { LongBits = 400, SpanBits = 256 };

struct Real { // rounded to nearest
  mpfr_t v;
  Real() { mpfr_init2(v, LongBits), mpfr_set_zero(v, 1); }
  explicit Real(double d) : Real() { mpfr_set_d(v, d, MPFR_RNDN); }
  explicit Real(const char *text) : Real() { mpfr_set_str(v, text, 10, MPFR_RNDN); }
  Real(const Real &o) : Real() { mpfr_set(v, o.v, MPFR_RNDN); }
  Real(Real &&o) : Real() { mpfr_swap(v, o.v); }
  Real &operator=(const Real &o) { return mpfr_set(v, o.v, MPFR_RNDN), *this; }
  Real &operator=(Real &&o) { return mpfr_swap(v, o.v), *this; }
  ~Real() { mpfr_clear(v); }
  int sign() const { return mpfr_sgn(v); }
  double to_double() const { return mpfr_get_d(v, MPFR_RNDN); }
  Real abs() const { Real r(*this); return mpfr_abs(r.v, r.v, MPFR_RNDN), r; }
  Real operator-() const { Real r(*this); return mpfr_neg(r.v, r.v, MPFR_RNDN), r; }
  bool operator<(const Real &o) const { return mpfr_less_p(v, o.v); }
};
inline Real operator+(const Real &a, const Real &b) { Real r; return mpfr_add(r.v, a.v, b.v, MPFR_RNDN), r; }
inline Real operator-(const Real &a, const Real &b) { Real r; return mpfr_sub(r.v, a.v, b.v, MPFR_RNDN), r; }
inline Real operator*(const Real &a, const Real &b) { Real r; return mpfr_mul(r.v, a.v, b.v, MPFR_RNDN), r; }
inline Real operator/(const Real &a, const Real &b) { Real r; return mpfr_div(r.v, a.v, b.v, MPFR_RNDN), r; }

// Of degrees; quarter turns exactly.
inline void turn(const char *degrees, Real &sine, Real &cosine) {
  Real a(degrees), quarters = a / Real(90.0), pi;
  if (mpfr_integer_p(quarters.v)) {
    static const int S[] = {0, 1, 0, -1};
    long k = ((mpfr_get_si(quarters.v, MPFR_RNDN) % 4) + 4) % 4;
    sine = Real((double)S[k]), cosine = Real((double)S[(k + 1) % 4]);
    return;
  }
  mpfr_const_pi(pi.v, MPFR_RNDN);
  a = a * pi / Real(180.0);
  mpfr_sin(sine.v, a.v, MPFR_RNDN), mpfr_cos(cosine.v, a.v, MPFR_RNDN);
}

struct Span { // lo <= truth <= hi, rounded outward; everything when it is no number
  mpfr_t lo, hi;
  Span() { mpfr_init2(lo, SpanBits), mpfr_init2(hi, SpanBits), mpfr_set_zero(lo, 1), mpfr_set_zero(hi, 1); }
  explicit Span(const Real &a) : Span() { mpfr_set(lo, a.v, MPFR_RNDD), mpfr_set(hi, a.v, MPFR_RNDU); }
  Span(const Real &a, const Real &b) : Span() { mpfr_set(lo, a.v, MPFR_RNDD), mpfr_set(hi, b.v, MPFR_RNDU); }
  Span(const Span &o) : Span() { *this = o; }
  Span &operator=(const Span &o) { return mpfr_set(lo, o.lo, MPFR_RNDD), mpfr_set(hi, o.hi, MPFR_RNDU), *this; }
  ~Span() { mpfr_clear(lo), mpfr_clear(hi); }
  int sign() const { return mpfr_sgn(lo) > 0 ? 1 : mpfr_sgn(hi) < 0 ? -1 : 0; }
  void check() {
    if (mpfr_nan_p(lo) || mpfr_nan_p(hi)) mpfr_set_inf(lo, -1), mpfr_set_inf(hi, 1);
  }
  void widen() { // a nonnegative one, by a little of itself
    if (mpfr_sgn(lo) > 0) mpfr_nextbelow(lo);
    if (mpfr_sgn(hi) > 0) mpfr_nextabove(hi);
  }
};
inline Span operator+(const Span &a, const Span &b) { Span r; return mpfr_add(r.lo, a.lo, b.lo, MPFR_RNDD), mpfr_add(r.hi, a.hi, b.hi, MPFR_RNDU), r.check(), r; }
inline Span operator-(const Span &a, const Span &b) { Span r; return mpfr_sub(r.lo, a.lo, b.hi, MPFR_RNDD), mpfr_sub(r.hi, a.hi, b.lo, MPFR_RNDU), r.check(), r; }
inline Span operator*(const Span &a, const Span &b) {
  Span r;
  mpfr_t x;
  mpfr_init2(x, SpanBits);
  mpfr_srcptr A[2] = {a.lo, a.hi}, B[2] = {b.lo, b.hi};
  for (int i = 0; i < 4; i++) {
    mpfr_mul(x, A[i & 1], B[i >> 1], MPFR_RNDD);
    if (i == 0 || mpfr_less_p(x, r.lo) || mpfr_nan_p(x)) mpfr_set(r.lo, x, MPFR_RNDD);
    if (mpfr_nan_p(x)) break;
    mpfr_mul(x, A[i & 1], B[i >> 1], MPFR_RNDU);
    if (i == 0 || mpfr_greater_p(x, r.hi)) mpfr_set(r.hi, x, MPFR_RNDU);
  }
  mpfr_clear(x);
  r.check();
  return r;
}
// b >= 0
inline Span operator/(const Span &a, const Span &b) {
  Span r;
  mpfr_div(r.lo, a.lo, mpfr_sgn(a.lo) < 0 ? b.lo : b.hi, MPFR_RNDD), mpfr_div(r.hi, a.hi, mpfr_sgn(a.hi) < 0 ? b.hi : b.lo, MPFR_RNDU);
  r.check();
  return r;
}
inline Span quotient(const Real &a, const Real &b) { return Span(a) / Span(b); }
// x >= 0 to the power y > 0: it grows with x, and with y where x > 1, else falls.
inline Span power(const Span &x, const Span &y) {
  Span r;
  mpfr_pow(r.lo, x.lo, mpfr_cmp_ui(x.lo, 1) < 0 ? y.hi : y.lo, MPFR_RNDD);
  mpfr_pow(r.hi, x.hi, mpfr_cmp_ui(x.hi, 1) < 0 ? y.lo : y.hi, MPFR_RNDU);
  r.check();
  return r;
}
} // namespace stress
