// The one-dimensional evaluator: every quadratic's roots as CGAL's exact square-root numbers, sorted by exact comparison,
// the tree evaluated on every stretch between them.
#pragma once
#include "solid.hpp"

#include <CGAL/Root_of_traits.h>
#include <CGAL/Sqrt_extension.h>
#include <CGAL/number_type_basic.h>

#include <algorithm>

namespace oracle {
using Root = CGAL::Root_of_traits<Q>::Root_of_2;

struct Quadratic { // a t^2 + b t + c
  Q a, b, c;
};
inline Quadratic along(const Quadric &q, const V &o, const V &d) {
  std::array<Q, 4> O{o[0], o[1], o[2], 1}, D{d[0], d[1], d[2], 0};
  return {q.bilinear(D, D), 2 * q.bilinear(O, D), q.bilinear(O, O)};
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
    l.roots.push_back(Root(-p.c / p.b));
    return l;
  }
  l.first = CGAL::sign(p.a);
  Q disc = p.b * p.b - 4 * p.a * p.c;
  if (disc == 0) l.touches = true;
  if (disc > 0) CGAL::compute_roots_of_2(p.a, p.b, p.c, std::back_inserter(l.roots));
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
  Line1 line;
  size_t next = 0;
  int sign = 0; // of q; 0 while the surface vanishes: then group tells which
  int group = -1;
};

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

inline Answer intersect(const Node &solid, const V &o, const V &d) {
  Answer out;
  std::vector<const Leaf *> leaves;
  collect(solid, leaves);
  std::vector<Cursor> cursors;
  std::vector<const Quadric *> zero_forms;
  for (const Leaf *l : leaves)
    for (const Quadric &q : l->halves) {
      Cursor c;
      c.line = solve(along(q, o, d));
      out.touches += c.line.touches;
      c.sign = c.line.first;
      if (c.line.zero) {
        // The point one unit along a vector no surface here was made for; its gradient decides the orientation.
        size_t g = 0;
        for (; g < zero_forms.size(); g++)
          if (proportional(*zero_forms[g], q)) break;
        if (g == zero_forms.size()) zero_forms.push_back(&q);
        c.group = (int)g;
        c.sign = 1;
        for (int i = 0; i < 16; i++)
          if (q.a[i / 4][i % 4] != 0) {
            c.sign = CGAL::sign(q.a[i / 4][i % 4]) * CGAL::sign(zero_forms[g]->a[i / 4][i % 4]);
            break;
          }
      }
      cursors.push_back(c);
      for (const Root &r : c.line.roots) out.cuts.push_back(r);
    }
  std::sort(out.cuts.begin(), out.cuts.end());
  size_t all = out.cuts.size();
  out.cuts.erase(std::unique(out.cuts.begin(), out.cuts.end()), out.cuts.end());
  out.ties = (int)(all - out.cuts.size());
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
  for (size_t i = 0; i <= out.cuts.size(); i++) {
    if (i > 0)
      for (Cursor &c : cursors)
        if (c.next < c.line.roots.size() && c.line.roots[c.next] == out.cuts[i - 1]) c.sign = -c.sign, c.next++;
    unsigned in = 0, n = 1u << zero_forms.size();
    for (unsigned k = 0; k < n; k++) {
      size_t at = 0;
      in += evaluate(solid, cursors, at, k);
    }
    out.what.push_back(in == 0 ? Answer::Outside : in == n ? Answer::Inside : Answer::On);
  }
  // Merge stretches alike.
  std::vector<Root> cuts;
  std::vector<Answer::What> what{out.what[0]};
  for (size_t i = 0; i < out.cuts.size(); i++)
    if (out.what[i + 1] != what.back()) cuts.push_back(out.cuts[i]), what.push_back(out.what[i + 1]);
  out.cuts = cuts, out.what = what;
  return out;
}

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
