// Hard rays: aimed at edges, rims, apexes, contacts, along faces and generators, exactly and a little beside; from near and from far.
// A bundle is the ray's neighbours with it, as packets take them.
#pragma once
#include "grammar.hpp"

namespace stress {
struct Line { V o, d; int kind; double t; const Spot *spot; }; // t: about where the spot is; NaN where it is not met
enum Aim { Tangent, NearTangent, Along, Parallel, At, TwoSpots, Far, Axis, Scaled, Random_, Gap, Aims };
static const char *const AIMS[Aims] = {"tangent", "near-tangent", "along", "parallel", "at a spot", "two spots", "far", "axis", "scaled", "random", "gap as wide as bounds"};

inline V small_vector(Random &r) {
  V v;
  do v = {Q(r.range(-4, 4)), Q(r.range(-4, 4)), Q(r.range(-4, 4))};
  while (zero(v));
  return v;
}
// A positive multiple of v with decimal entries, where there is one with a small common denominator.
inline bool clear(V &v) {
  CGAL::Gmpz den(1);
  for (auto &e : v) {
    CGAL::Gmpz d = e.denominator();
    den = CGAL::integral_division(den, CGAL::gcd(den, d)) * d;
  }
  if (den != 1 && mpz_sizeinbase(den.mpz(), 2) < 4000) v = Q(den) * v;
  return !zero(v) && is_decimal(v[0]) && is_decimal(v[1]) && is_decimal(v[2]);
}
// Divides by a power of two so that the greatest entry is between 1 and 2: a direction of ordinary length.
inline V shorter(const V &v) {
  double m = 0;
  for (auto &e : v) m = std::max(m, std::fabs(CGAL::to_double(e)));
  if (!(m > 0) || !std::isfinite(m)) return v;
  return pow2(-std::ilogb(m)) * v;
}
// A number with all bits of a double, from 1 to 2, often next to either.
inline double mantissa(Random &r) {
  double m = 1 + (double)(r.next() >> 12) * 0x1p-52;
  if (r.chance(25)) m = 1 + (double)r.below(1 << r.range(1, 12)) * 0x1p-52;
  else if (r.chance(15)) m = 2 - (double)r.range(1, 1 << r.range(1, 12)) * 0x1p-52;
  return m;
}
// gaps: between faces that nearly meet. A ray that comes from so far that a bound on its places' errors, a few to some thousand spacings of doubles, is just as
// wide as such a gap tries every comparison with that bound.
inline bool aim(Random &r, const std::vector<const Spot *> &spots, const std::vector<double> &gaps, Line &out, int only = -1) {
  if (spots.empty()) return false;
  const Spot &s = *spots[(size_t)r.below((int)spots.size())];
  V p = s.point, d;
  int kind = only < 0 ? r.below(Aims) : only;
  switch (kind) {
  case Tangent:
    if (zero(s.normal)) return false;
    d = cross(s.normal, small_vector(r));
    break;
  case NearTangent: {
    if (zero(s.normal)) return false;
    d = cross(s.normal, small_vector(r));
    V n = s.normal;
    if (!clear(n)) return false;
    p = p + (r.chance(50) ? Q(1) : Q(-1)) * pow2(-r.range(20, 60)) * shorter(n);
    break;
  }
  case Along:
    if (zero(s.along)) return false;
    d = s.along;
    break;
  case Parallel:
    if (zero(s.along)) return false;
    d = s.along;
    p = p + pow2(-r.range(0, 50)) * small_vector(r);
    break;
  case TwoSpots: d = spots[(size_t)r.below((int)spots.size())]->point - p; break;
  case Axis: d = along_axis(r.below(3), r.chance(50) ? 1 : -1); break;
  case Random_:
    p = p + V{tenth(r, -50, 50), tenth(r, -50, 50), tenth(r, -50, 50)};
    d = V{tenth(r, -50, 50), tenth(r, -50, 50), tenth(r, -50, 50)};
    break;
  default: d = small_vector(r);
  }
  if (zero(d) || !clear(d)) return false;
  d = shorter(d);
  double t = 0;
  if (kind == Gap) {
    double gap = gaps.empty() ? 0 : gaps[(size_t)r.below((int)gaps.size())];
    for (auto &e : d) // directions of all bits
      if (e != 0 && r.chance(50)) e += pow2(-r.range(30, 51)) * Q(r.range(-3, 3));
    t = std::ldexp(gap * mantissa(r), 53 - r.range(2, 13)) / (1 + (double)r.below(3));
    if (!(t > 0x1p-60 && t < 0x1p60)) return false;
    p = p - Q(t) * d;
  } else if (kind == Far) {
    p = p - pow2(r.range(10, 40)) * d;
    if (r.chance(50)) p = p + pow2(-r.range(10, 60)) * small_vector(r);
  } else if (kind == Scaled) {
    d = pow2(r.range(-200, 200)) * d;
  } else if (r.chance(70)) {
    Q back = r.chance(50) ? Q(r.range(1, 50)) / Q(4) : pow2(r.range(-3, 6));
    p = p - back * d, t = CGAL::to_double(back);
  }
  out = {p, d, kind, kind == Far || kind == Random_ || kind == Parallel || kind == NearTangent ? NAN : t, &s};
  return is_decimal(p[0]) && is_decimal(p[1]) && is_decimal(p[2]);
}

// A ray of doubles.
struct Ray { double o[3], d[3], from, to; };
inline bool to_ray(const Line &l, Ray &r) {
  bool any = false;
  for (int i = 0; i < 3; i++) {
    r.o[i] = CGAL::to_double(l.o[i]), r.d[i] = CGAL::to_double(l.d[i]);
    if (!std::isfinite(r.o[i]) || !std::isfinite(r.d[i])) return false;
    any |= r.d[i] != 0;
  }
  r.from = -INFINITY, r.to = INFINITY;
  return any;
}
// Some numbers of the ray a few doubles further.
inline void nudge(Random &r, Ray &x) {
  for (int i = 0; i < 6; i++) {
    double &v = i < 3 ? x.o[i] : x.d[i - 3];
    for (int k = r.chance(40) ? r.below(4) : 0; k > 0; k--) v = std::nextafter(v, r.chance(50) ? INFINITY : -INFINITY);
  }
  for (double &v : x.o)
    if (std::fabs(v) < 0x1p-300) v = 0;
  for (double &v : x.d)
    if (std::fabs(v) < 0x1p-300) v = 0;
}
inline V origin(const Ray &r) { return {Q(r.o[0]), Q(r.o[1]), Q(r.o[2])}; }
inline V direction(const Ray &r) { return {Q(r.d[0]), Q(r.d[1]), Q(r.d[2])}; }

enum Bundle { Alone, Same, Sheet, Fan, Meet, Mixed, Grid, Near, Bundles };
static const char *const BUNDLES[Bundles] = {"alone", "same ray", "parallel", "from one place", "to one place", "mixed", "grid", "doubles beside"};

// Two ways across a ray, or any.
inline void across(Random &r, const Ray &first, double size, double u[3], double v[3]) {
  for (int i = 0; i < 3; i++) u[i] = r.range(-1, 1), v[i] = r.range(-1, 1);
  if (!r.chance(40)) return;
  double c[3] = {first.d[1], first.d[2], first.d[0]};
  for (int i = 0; i < 3; i++) {
    int a = (i + 1) % 3, b = (i + 2) % 3;
    u[i] = (first.d[a] * c[b] - first.d[b] * c[a]) / size / size;
  }
  for (int i = 0; i < 3; i++) {
    int a = (i + 1) % 3, b = (i + 2) % 3;
    v[i] = (first.d[a] * u[b] - first.d[b] * u[a]) / size;
  }
}
// A kind of range, and a ray's. at: where the ray meets its spot.
struct Range { int range, which, steps; };
inline Range a_cut(Random &r) {
  Range c;
  c.range = r.below(12), c.which = r.below(3), c.steps = r.range(0, 12);
  return c;
}
inline void cut(Random &r, const Range &c, double at, Ray &x) {
  x.from = -INFINITY, x.to = INFINITY;
  if (c.range < 3) x.from = 0;
  else if (c.range == 3) x.from = std::ldexp((double)r.range(-64, 64), -2);
  else if (c.range == 4) x.to = std::ldexp((double)r.range(-64, 64), -2);
  else if (c.range == 5) {
    x.from = std::ldexp((double)r.range(-64, 64), -2), x.to = x.from + std::ldexp((double)r.range(0, 64), -2);
  } else if (c.range > 9 && std::isfinite(at)) { // some spacings of doubles beside the spot
    double beside = at + at * (double)r.range(-(1 << c.steps), 1 << c.steps) * 0x1p-53;
    if (c.which != 1) x.from = beside;
    if (c.which) x.to = c.which == 1 ? beside : beside + std::fabs(at) * (double)r.below(2 << c.steps) * 0x1p-53;
  }
}

// The rays about a first one. n: how many; at: where that meets its spot.
inline void bundle(Random &r, const Ray &first, double at, int kind, size_t n, const std::vector<const Spot *> &spots, std::vector<Ray> &out) {
  out.clear();
  double size = std::max({std::fabs(first.d[0]), std::fabs(first.d[1]), std::fabs(first.d[2])});
  double step = std::ldexp(size, -r.range(0, r.chance(50) ? 8 : 52)), u[3], v[3];
  across(r, first, size, u, v);
  size_t special = (size_t)r.below((int)n);
  double t = std::ldexp((double)r.range(1, 64), -r.range(0, 4));
  for (size_t k = 0; k < n; k++) {
    Ray x = first;
    double a = (double)r.range(-4, 4) * step, b = (double)r.range(-4, 4) * step;
    if (kind == Grid) a = (double)((int)(k % 8) - 4) * step, b = (double)((int)(k / 8 % 8) - 4) * step;
    if (k != special) {
      switch (kind) {
      case Sheet: case Grid:
        for (int i = 0; i < 3; i++) x.o[i] += a * u[i] + b * v[i];
        break;
      case Fan:
        for (int i = 0; i < 3; i++) x.d[i] += (a * u[i] + b * v[i]) / 8;
        break;
      case Meet: // through first's place at t, up to rounding
        for (int i = 0; i < 3; i++) x.d[i] += (a * u[i] + b * v[i]) / 8, x.o[i] += t * (first.d[i] - x.d[i]);
        break;
      case Near: nudge(r, x); break;
      case Mixed: {
        Line l;
        Ray other;
        if (r.chance(30) && aim(r, spots, {}, l) && to_ray(l, other)) x = other;
        else if (!out.empty()) nudge(r, x = out.back());
        break;
      }
      default: break;
      }
    }
    if (x.d[0] == 0 && x.d[1] == 0 && x.d[2] == 0) x = first;
    out.push_back(x);
  }
  const Range range = a_cut(r);
  for (auto &x : out) cut(r, range, at, x);
}
} // namespace stress
