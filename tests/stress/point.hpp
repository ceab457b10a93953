// Points on any number of surfaces, whatever these do there: the solid is looked at on a small tetrahedron around the point.
//
// Near enough to a point P the solid is a cone over what a small closed surface around P meets of it: every cell of the surfaces through P that has P in
// its closure crosses the tetrahedron. A face of it is a plane, where each surface is a conic q(x, y) = a y^2 + b(x) y + c(x). Over an
// interval of x in which no conic turns (b^2 = 4 a c), meets another (the resultant), has a vertical asymptote (a = 0 = b) or meets the face's border, the cells are
// stacked in one order, so one line of constant x crosses all of them, and every cell lies over some such interval. So: the roots of all these polynomials as CGAL's
// algebraic numbers, a rational between each two neighbours, and there the exact evaluator on a line. All stretches inside: P is inside; all outside: outside; else P is on the
// boundary. "Small" is 2^-400 of the numbers there: features that models of such numbers have are above 2^-300.
//
// Two conics with a common line have no resultant: with both a not 0 their other lines meet where a1 b2 = a2 b1; and a line is among the other's own turns.
#pragma once
#include "ring.hpp"

#include <CGAL/Algebraic_kernel_d_1.h>

namespace stress {
struct Faces { // of one tetrahedron, asked for the surfaces through its middle
  using Kernel = CGAL::Algebraic_kernel_d_1<CGAL::Gmpz>;
  using Real = Kernel::Algebraic_real_1;
  using Poly = std::vector<Q>; // by powers of x
  struct Conic { Q a; Poly b, c; };
  const Node &solid;
  const Surfaces &surfaces;
  const std::vector<size_t> &through;
  std::vector<int> signs; // by surface, of those not through the point
  std::vector<Cursor> cursors;
  bool in = false, out = false, failed = false;
  unsigned lines = 0;

  static Poly times(const Poly &f, const Poly &g) {
    Poly r(f.size() + g.size() - 1, Q(0));
    for (size_t i = 0; i < f.size(); i++)
      for (size_t j = 0; j < g.size(); j++) r[i + j] += f[i] * g[j];
    return r;
  }
  static Poly less(Poly f, const Poly &g, const Q &by = Q(1)) { // f - by g
    if (f.size() < g.size()) f.resize(g.size(), Q(0));
    for (size_t i = 0; i < g.size(); i++) f[i] -= by * g[i];
    return f;
  }
  static bool nothing(const Poly &f) {
    return std::all_of(f.begin(), f.end(), [](const Q &q) { return q == 0; });
  }
  // Roots in (0, 1).
  void roots(const Kernel &kernel, const Poly &f, std::vector<Real> &to) {
    Z by(1), g(0);
    for (auto &q : f) by = common(by, q.denominator());
    std::vector<Z> z;
    for (auto &q : f) z.push_back(over(q, by)), g = CGAL::gcd(g, z.back());
    while (!z.empty() && z.back() == 0) z.pop_back();
    if (z.size() < 2) return;
    for (auto &e : z) e = CGAL::integral_division(e, g);
    Kernel::Polynomial_1 p(z.begin(), z.end());
    kernel.solve_1_object()(CGAL::make_square_free(p), true, Q(0), Q(1), std::back_inserter(to));
  }
  // The stretches of from + t step, t in (0, 1).
  void look(const V &from, const V &step) {
    lines++;
    failed |= !values_along(solid, surfaces, through, signs, cursors, from, step, in, out);
  }
  // All cells of the face with corners o, o + u, o + w.
  void face(const Kernel &kernel, const V &o, const V &u, const V &w) {
    std::vector<Conic> conics;
    const std::array<Q, 4> O{o[0], o[1], o[2], Q(1)}, U{u[0], u[1], u[2], Q(0)}, W{w[0], w[1], w[2], Q(0)};
    std::vector<Real> cuts;
    for (size_t s : through) {
      const Quadric &q = *surfaces.quadrics[s];
      const Q two(2);
      Conic k{q.bilinear(W, W), {two * q.bilinear(O, W), two * q.bilinear(U, W)}, {q.bilinear(O, O), two * q.bilinear(O, U), q.bilinear(U, U)}};
      if (k.a != 0) roots(kernel, less(times(k.b, k.b), k.c, 4 * k.a), cuts);
      else if (!nothing(k.b)) roots(kernel, k.b, cuts);
      roots(kernel, k.c, cuts); // the side y = 0; and all of it, where that is a vertical line or two
      const Poly rest{Q(1), Q(-1)}; // the side y = 1 - x
      roots(kernel, less(less(times(times(rest, rest), Poly{k.a}), times(k.b, rest), -1), k.c, -1), cuts);
      for (auto &other : conics) {
        const Conic &x = other, &y = k;
        if (x.a == 0 && y.a == 0) {
          roots(kernel, less(times(x.b, y.c), times(y.b, x.c)), cuts);
          continue;
        }
        Poly ac = less(times({x.a}, y.c), x.c, y.a), ab = less(times({x.a}, y.b), x.b, y.a), bc = less(times(x.b, y.c), times(y.b, x.c));
        Poly resultant = less(times(ac, ac), times(ab, bc));
        roots(kernel, nothing(resultant) ? ab : resultant, cuts);
      }
      conics.push_back(k);
    }
    auto compare = kernel.compare_1_object();
    std::sort(cuts.begin(), cuts.end(), [&](const Real &a, const Real &b) { return compare(a, b) == CGAL::SMALLER; });
    cuts.erase(std::unique(cuts.begin(), cuts.end(), [&](const Real &a, const Real &b) { return compare(a, b) == CGAL::EQUAL; }), cuts.end());
    const Real first = kernel.construct_algebraic_real_1_object()(Q(0)), last = kernel.construct_algebraic_real_1_object()(Q(1));
    cuts.insert(cuts.begin(), first), cuts.push_back(last);
    for (size_t i = 0; i + 1 < cuts.size() && !(in && out) && !failed; i++) {
      if (compare(cuts[i], cuts[i + 1]) != CGAL::SMALLER) continue; // the face's own corners
      Q x = cuts[i].rational_between(cuts[i + 1]);
      look(o + x * u, (Q(1) - x) * w);
    }
  }
};

// What the tree says with the surfaces `open` on either side: 1, 0, or 2 where that is not known. mark: the half-spaces it may depend on.
inline int known_value(const Node &n, const Surfaces &surfaces, const std::vector<int> &signs, const std::vector<char> &open, size_t &at, std::vector<char> &mark) {
  if (n.op == Node::IsLeaf) {
    const size_t first = at;
    int value = 1;
    for (size_t i = 0; i < n.leaf.halves.size(); i++, at++) {
      size_t s = surfaces.of[at];
      if (open[s]) value = value == 0 ? 0 : 2;
      else if (signs[s] * surfaces.side[at] > 0) value = 0;
    }
    for (size_t h = first; value == 2 && h < at; h++) mark[surfaces.of[h]] = open[surfaces.of[h]];
    return value;
  }
  std::vector<char> below(mark.size(), 0);
  int value = n.op == Node::Intersection;
  for (size_t i = 0; i < n.kids.size(); i++) {
    int k = known_value(n.kids[i], surfaces, signs, open, at, below);
    if (n.op == Node::Difference && i) k = k == 2 ? 2 : !k;
    if (n.op == Node::Difference && i == 0) value = k;
    else if (n.op == Node::Union) value = value == 1 || k == 1 ? 1 : std::max(value, k);
    else value = value == 0 || k == 0 ? 0 : std::max(value, k);
  }
  for (size_t s = 0; value == 2 && s < mark.size(); s++) mark[s] |= below[s];
  return value;
}

// Outside 0, on the boundary 1, inside 2; -1 not judged, `why` then. at: the surfaces through p; signs: of the others. most: surfaces for which all
// cells are looked at; with more only those that some lines cross, which can show "boundary" alone.
inline int around(const Node &solid, const Surfaces &surfaces, const std::vector<size_t> &at, const std::vector<int> &signs, const V &p, const char **why, size_t most = 24) {
  std::vector<char> open(surfaces.forms.size(), 0), mark(surfaces.forms.size(), 0);
  for (size_t s : at) open[s] = 1;
  size_t half = 0;
  int value = known_value(solid, surfaces, signs, open, half, mark);
  if (value != 2) return 2 * value;
  std::vector<size_t> through; // those that matter
  for (size_t s : at)
    if (mark[s]) through.push_back(s);
  Q size = 1;
  for (auto &e : p)
    if (e != 0) size = CGAL::abs(e) < size ? CGAL::abs(e) : size;
  const Q small = size * pow2(-400);
  const V corner[4] = {p + small * V{Q(7) / 8, Q(-3) / 5, Q(9) / 11}, p + small * V{Q(-6) / 7, Q(-5) / 9, Q(-8) / 13}, p + small * V{Q(2) / 9, Q(1), Q(-4) / 5}, p + small * V{Q(-3) / 11, Q(4) / 7, Q(10) / 13}};
  Faces f{solid, surfaces, through, signs, std::vector<Cursor>(surfaces.of.size())};
  for (int k = 0; k < 4; k++)
    for (int n = 1; n < 4 && !(f.in && f.out); n++) { // mostly these show both
      const V &o = corner[k], u = corner[(k + 1) % 4] - o, w = corner[(k + 2) % 4] - o;
      f.look(o + (Q(n) / 4 + Q(1) / 101) * u, (Q(1) - Q(n) / 4 - Q(1) / 101) * w);
    }
  if (f.in && f.out) return 1;
  if (through.size() > most) return *why = "too many surfaces", -1;
  f.failed = false;
  const Faces::Kernel kernel;
  for (int k = 0; k < 4 && !(f.in && f.out); k++) f.face(kernel, corner[k], corner[(k + 1) % 4] - corner[k], corner[(k + 2) % 4] - corner[k]);
  if (f.in && f.out) return 1;
  if (f.failed) return *why = "a surface along a line that is looked at", -1;
  return f.in ? 2 : 0;
}
} // namespace stress
