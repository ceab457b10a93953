// The one-dimensional evaluator: every quadratic's roots as CGAL's exact square-root numbers, sorted by exact comparison,
// the tree evaluated on every stretch between them.
#pragma once
#include "solid.hpp"

#include <CGAL/Root_of_traits.h>
#include <CGAL/Sqrt_extension.h>
#include <CGAL/number_type_basic.h>

#include <algorithm>
#include <map>

namespace oracle {
using Root = CGAL::Root_of_traits<Q>::Root_of_2;

using Z = CGAL::Gmpz;

struct Quadratic { // a t^2 + b t + c
  Z a, b, c;
};
// A positive multiple of a quadric with integers: its ten numbers, mixed ones doubled.
using Whole = std::array<Z, 10>;
inline Z over(const Q &q, const Z &by) { return CGAL::integral_division(q.numerator() * by, q.denominator()); }
inline Z common(const Z &a, const Z &b) { return CGAL::integral_division(a, CGAL::gcd(a, b)) * b; }
inline Whole whole(const Quadric &q) {
  Z by(1);
  for (int i = 0; i < 4; i++)
    for (int j = i; j < 4; j++) by = common(by, q.a[i][j].denominator());
  Whole w;
  for (int i = 0, k = 0; i < 4; i++)
    for (int j = i; j < 4; j++, k++) w[k] = over(q.a[i][j], by) * Z(i == j ? 1 : 2);
  return w;
}
// The line with integers: (o + t d) / w.
struct Line4 { std::array<Z, 4> o, d; };
inline Line4 whole(const V &o, const V &d) {
  Z w(1);
  for (int i = 0; i < 3; i++) w = common(common(w, o[i].denominator()), d[i].denominator());
  Line4 l;
  for (int i = 0; i < 3; i++) l.o[i] = over(o[i], w), l.d[i] = over(d[i], w);
  l.o[3] = w, l.d[3] = Z(0);
  return l;
}
inline Quadratic along(const Whole &q, const Line4 &l) {
  Quadratic p{0, 0, 0};
  for (int i = 0, k = 0; i < 4; i++)
    for (int j = i; j < 4; j++, k++) {
      if (q[k] == 0) continue;
      p.c += q[k] * l.o[i] * l.o[j];
      if (j < 3) p.a += q[k] * l.d[i] * l.d[j];
      if (i < 3) p.b += q[k] * (l.d[i] * l.o[j] + l.o[i] * l.d[j]);
    }
  return p;
}
// Roots where the sign changes, in order; touches (double roots) apart.
struct Line1 {
  bool zero = false;      // identically zero
  int first = 0;          // the sign before the first root
  std::vector<Root> roots;
  bool touches = false;
};
inline Line1 solve(const Quadratic &p) {
  Line1 l;
  if (p.a == 0 && p.b == 0) {
    l.zero = p.c == 0;
    l.first = CGAL::sign(p.c);
    return l;
  }
  if (p.a == 0) {
    l.first = -CGAL::sign(p.b);
    l.roots.push_back(Root(Q(-p.c, p.b)));
    return l;
  }
  l.first = CGAL::sign(p.a);
  Z disc = p.b * p.b - Z(4) * p.a * p.c;
  if (disc == 0) l.touches = true;
  if (disc > 0) CGAL::compute_roots_of_2(Q(p.a), Q(p.b), Q(p.c), std::back_inserter(l.roots));
  return l;
}

struct Answer {
  enum What { Outside, Inside, On };
  std::vector<Root> cuts;   // increasing, distinct; stretch i lies before cut i, the last after all
  std::vector<What> what;   // cuts.size() + 1
  bool skipped = false;     // more surfaces vanish along the line than this evaluator decides
  int zero_surfaces = 0, touches = 0, ties = 0;
};

struct Cursor { // one half-space's state on the current stretch
  int sign = 0;   // of q; for a surface that vanishes: its orientation in its group
  int group = -1; // of surfaces that vanish
};

// A solid's half-spaces, in the order of its leaves, as distinct surfaces with a side each.
struct Surfaces {
  std::vector<Whole> forms;
  std::vector<const Quadric *> quadrics; // in the solid, which must live as long
  std::vector<size_t> of;                // by half-space
  std::vector<int> side;                 // 1: it is that multiple of the form, -1: of its negative
  explicit Surfaces(const Node &solid) {
    std::vector<const Leaf *> leaves;
    collect(solid, leaves);
    std::map<Whole, size_t> known;
    for (const Leaf *l : leaves)
      for (const Quadric &q : l->halves) {
        Whole w = whole(q);
        Z g(0);
        for (auto &e : w) g = CGAL::gcd(g, e);
        int sign = 0;
        for (auto &e : w) {
          if (sign == 0) sign = CGAL::sign(e);
          if (g != 0) e = CGAL::integral_division(e, g) * Z(sign == 0 ? 1 : sign);
        }
        auto found = known.emplace(w, forms.size());
        if (found.second) forms.push_back(w), quadrics.push_back(&q);
        of.push_back(found.first->second), side.push_back(sign);
      }
  }
};

// A root with an interval of doubles around it, which decides most orders; the rest is exact.
struct Mark {
  const Root *root;
  double lo, hi;
  size_t surface;
};
inline int order(const Mark &a, const Mark &b) {
  if (a.hi < b.lo) return -1;
  if (b.hi < a.lo) return 1;
  return a.root == b.root ? 0 : (int)CGAL::compare(*a.root, *b.root);
}

inline bool evaluate(const Node &n, const std::vector<Cursor> &cursors, size_t &at, unsigned combination) {
  if (n.op == Node::IsLeaf) {
    bool in = true;
    for (size_t i = 0; i < n.leaf.halves.size(); i++, at++) {
      const Cursor &c = cursors[at];
      int s = c.sign;
      if (c.group >= 0) s *= (combination >> c.group & 1) ? 1 : -1; // sign: how the half-space is oriented in its group
      in = in && s < 0;
    }
    return in;
  }
  bool value = n.op == Node::Intersection;
  for (size_t i = 0; i < n.kids.size(); i++) {
    bool k = evaluate(n.kids[i], cursors, at, combination);
    if (n.op == Node::Union) value = value || k;
    else if (n.op == Node::Intersection) value = value && k;
    else value = i == 0 ? k : (value && !k);
  }
  return value;
}

inline Answer intersect(const Node &solid, const Surfaces &surfaces, const V &o, const V &d) {
  Answer out;
  const Line4 line = whole(o, d);
  const size_t n = surfaces.forms.size();
  std::vector<Line1> lines(n);
  std::vector<int> sign(n), group(n, -1);
  std::vector<const Quadric *> zero_forms;
  std::vector<Mark> marks;
  for (size_t s = 0; s < n; s++) {
    Line1 &l = lines[s];
    l = solve(along(surfaces.forms[s], line));
    out.touches += l.touches;
    sign[s] = l.first;
    if (l.zero) group[s] = (int)zero_forms.size(), sign[s] = 1, zero_forms.push_back(surfaces.quadrics[s]);
    for (const Root &r : l.roots) {
      auto i = CGAL::to_interval(r);
      marks.push_back({&r, i.first, i.second, s});
    }
  }
  std::sort(marks.begin(), marks.end(), [](const Mark &a, const Mark &b) { return order(a, b) < 0; });
  // Surfaces that vanish: every combination of sides must be realisable next to the line, or the ray is not judged here.
  out.zero_surfaces = (int)zero_forms.size();
  if (zero_forms.size() > 2) out.skipped = true;
  V p = o + Q(7919) / Q(104729) * d;
  for (size_t i = 0; i < zero_forms.size() && !out.skipped; i++) {
    V g = zero_forms[i]->gradient(p);
    if (zero(g)) out.skipped = true;
    for (size_t j = 0; j < i; j++)
      if (zero(cross(g, zero_forms[j]->gradient(p)))) out.skipped = true;
  }
  if (out.skipped) return out;
  std::vector<Cursor> cursors(surfaces.of.size());
  for (size_t at = 0;;) {
    for (size_t h = 0; h < cursors.size(); h++) {
      size_t s = surfaces.of[h];
      cursors[h].sign = sign[s] * surfaces.side[h], cursors[h].group = group[s];
    }
    unsigned in = 0, combinations = 1u << zero_forms.size();
    for (unsigned k = 0; k < combinations; k++) {
      size_t half = 0;
      in += evaluate(solid, cursors, half, k);
    }
    out.what.push_back(in == 0 ? Answer::Outside : in == combinations ? Answer::Inside : Answer::On);
    if (at == marks.size()) break;
    const Mark &here = marks[at];
    out.cuts.push_back(*here.root);
    size_t first = at;
    for (; at < marks.size() && order(here, marks[at]) == 0; at++) sign[marks[at].surface] = -sign[marks[at].surface];
    out.ties += (int)(at - first - 1);
  }
  // Merge stretches alike.
  std::vector<Root> cuts;
  std::vector<Answer::What> what{out.what[0]};
  for (size_t i = 0; i < out.cuts.size(); i++)
    if (out.what[i + 1] != what.back()) cuts.push_back(out.cuts[i]), what.push_back(out.what[i + 1]);
  out.cuts = cuts, out.what = what;
  return out;
}
inline Answer intersect(const Node &solid, const V &o, const V &d) { return intersect(solid, Surfaces(solid), o, d); }

// Is t the double nearest to r (ties to even)? Exact.
inline bool nearest(double t, const Root &r) {
  if (!std::isfinite(t)) return false;
  double below = std::nextafter(t, -INFINITY), above = std::nextafter(t, INFINITY);
  if (!std::isfinite(below) || !std::isfinite(above)) return false;
  Root lo((Q(t) + Q(below)) / 2), hi((Q(t) + Q(above)) / 2);
  uint64_t bits;
  memcpy(&bits, &t, 8);
  bool even = !(bits & 1);
  return even ? lo <= r && r <= hi : lo < r && r < hi;
}
} // namespace oracle
