// Lines in surfaces, whatever these do beside the line: the solid is looked at on a small ring around it.
//
// Next to a point P of the line, off the zeros of all other surfaces, the solid is a union of sectors around the line: whatever lies next to P
// crosses every small quadrilateral around it in a plane across the line. The four sides are lines themselves, and the exact evaluator tells
// of each which stretches of it are inside. Sides all inside: the line is inside; all outside: outside; else it lies in the boundary.
// "Small" is 2^-1000 of the numbers there, which is no proof, but far below any feature that models of such numbers have.
//
// What is next to the line can change where two of the surfaces that hold it change their angle from 0, or where one has an apex. These parameters
// are added to the line's events, those where two that touch all along it have one curvature across it, and those where one touches a plane of a pair of
// planes whose edge is the line. Two points of each stretch are looked at all the same, and the ray is not judged if they differ.
#pragma once
#include "spec.hpp"
#include "../oracle/evaluate.hpp"

namespace stress {
using namespace oracle;

// What the solid is along from + t step, t in (0, 1), is added to in and out until both are seen. signs: by surface, of those not among `cut`; these are set here. false: one
// of these holds the line.
inline bool values_along(const Node &solid, const Surfaces &surfaces, const std::vector<size_t> &cut, std::vector<int> &signs, std::vector<Cursor> &cursors, const V &from, const V &step,
                         bool &in, bool &out) {
  const Line4 line = whole(from, step);
  const Root zero(Q(0)), one(Q(1));
  std::vector<std::pair<Root, size_t>> marks;
  for (size_t s : cut) {
    Line1 l = solve(along(surfaces.forms[s], line));
    if (l.zero) return false;
    signs[s] = l.first;
    for (auto &r : l.roots) {
      if (r <= zero) signs[s] = -signs[s];
      else if (r < one) marks.emplace_back(r, s);
    }
  }
  std::sort(marks.begin(), marks.end(), [](const auto &a, const auto &b) { return a.first < b.first; });
  for (size_t at = 0; !(in && out);) {
    for (size_t h = 0; h < cursors.size(); h++) cursors[h].sign = signs[surfaces.of[h]] * surfaces.side[h];
    size_t half = 0;
    (evaluate(solid, cursors, half, 0) ? in : out) = true;
    if (at == marks.size()) break;
    const Root here = marks[at].first;
    for (; at < marks.size() && marks[at].first == here; at++) signs[marks[at].second] *= -1;
  }
  return true;
}

// The surfaces that hold the line; signs: of the others at p (by surface; those that hold the line are set here).
inline Answer::What ring(const Node &solid, const Surfaces &surfaces, const std::vector<size_t> &held, std::vector<int> signs, const V &p, const V &d, const Q &size, bool &failed) {
  V e{Q(3) / 7, Q(-2) / 5, Q(5) / 11}, f{Q(-4) / 9, Q(6) / 13, Q(1) / 3};
  if (oracle::dot(d, cross(e, f)) == 0) e = V{Q(1), Q(2) / 7, Q(-3) / 5};
  if (oracle::dot(d, cross(e, f)) == 0) f = V{Q(5) / 9, Q(-1), Q(2) / 3};
  const Q small = size * pow2(-1000);
  V corner[4] = {p + small * (e + f), p + small * (f - e), p - small * (e + f), p + small * (e - f)};
  bool in = false, out = false;
  std::vector<Cursor> cursors(surfaces.of.size());
  for (int k = 0; k < 4 && !(in && out); k++) {
    if (!values_along(solid, surfaces, held, signs, cursors, corner[k], corner[(k + 1) % 4] - corner[k], in, out)) return failed = true, Answer::On;
  }
  return in ? out ? Answer::On : Answer::Inside : Answer::Outside;
}

// A rational near a root, closer with more bits.
inline Q near_root(const Root &r, int bits) {
  if (!r.is_extended()) return r.a0();
  Z n = r.root().numerator() * shifted_one(2 * bits), s;
  mpz_tdiv_q(n.mpz(), n.mpz(), r.root().denominator().mpz());
  mpz_sqrt(s.mpz(), n.mpz());
  return r.a0() + r.a1() * Q(s, shifted_one(bits));
}

// p0 + p1 t + p2 t2
inline std::vector<Root> all_roots(const Q &p0, const Q &p1, const Q &p2) {
  Z by = common(common(p0.denominator(), p1.denominator()), p2.denominator());
  Line1 l = solve(Quadratic{over(p2, by), over(p1, by), over(p0, by)});
  if (l.touches) l.roots.push_back(Root(-p1 / (Q(2) * p2)));
  return l.roots;
}

// Parameters where two surfaces that touch all along the line have one curvature across it: roots of
//     K(t) = (g_j.w) eᵗQ_i e - (g_i.w) eᵗQ_j e,   e = d x g_i,
// a cubic, from four values of it, without its factors g_i.w.
inline std::vector<Root> equal_bends(const Quadric &a, const Quadric &b, const V &o, const V &d) {
  const V w{Q(3) / 7, Q(-2) / 5, Q(5) / 11};
  auto bend = [](const Quadric &q, const V &e) {
    std::array<Q, 4> h{e[0], e[1], e[2], Q(0)};
    return q.bilinear(h, h);
  };
  auto value = [&](int t) {
    V p = o + Q(t) * d, g = a.gradient(p), e = cross(d, g);
    return Q(dot(b.gradient(p), w) * bend(a, e) - dot(g, w) * bend(b, e));
  };
  Q v0 = value(0), v1 = value(1), v2 = value(2), v3 = value(3);
  Q d1 = v1 - v0, d2 = v2 - Q(2) * v1 + v0, d3 = v3 - Q(3) * v2 + Q(3) * v1 - v0; // Newton's differences
  std::vector<Q> k{v0, d1 - d2 / 2 + d3 / 3, d2 / 2 - d3 / 2, d3 / 6};           // k0 + k1 t + k2 t2 + k3 t3
  Q c0 = dot(a.gradient(o), w), c1 = dot(a.gradient(o + d), w) - c0;
  while (c1 != 0) { // by c0 + c1 t, as long as it goes
    Q at = -c0 / c1;
    std::vector<Q> quotient(4, Q(0));
    Q rest = 0;
    for (size_t i = 4; i-- > 0;) {
      Q next = rest * at + k[i];
      if (i) quotient[i - 1] = next;
      rest = next;
    }
    if (rest != 0 || (k[1] == 0 && k[2] == 0 && k[3] == 0)) break;
    k = quotient;
  }
  return k[3] != 0 ? std::vector<Root>() : all_roots(k[0], k[1], k[2]);
}

// Parameters where a surface that holds the line touches a plane of a pair that is one quadric, singular all along the line: the pair is the same form on every section
// across the line, so it vanishes on the tangent e = d x g there: eᵗQe = 0, a quadratic. (Where it is 0 for all t the tangent plane turns nowhere, and the surface
// leaves it to the other side at an apex only.)
inline std::vector<Root> at_planes(const Quadric &pair, const V &g0, const V &g1, const V &d) {
  const V e0 = cross(d, g0), e1 = cross(d, g1);
  const std::array<Q, 4> a{e0[0], e0[1], e0[2], Q(0)}, b{e1[0], e1[1], e1[2], Q(0)};
  return all_roots(pair.bilinear(a, a), Q(2) * pair.bilinear(a, b), pair.bilinear(b, b));
}

inline Answer beside(const Node &solid, const Surfaces &surfaces, const V &o, const V &d) {
  Answer out;
  out.skipped = true;
  const Line4 line = whole(o, d);
  struct Event { Root t; long surface; }; // -1: of the surfaces that hold the line
  std::vector<Event> events;
  auto event = [&](const Root &t, long s) { events.push_back({t, s}); };
  std::vector<const Quadric *> zeros;
  std::vector<size_t> held;
  std::vector<int> signs;
  for (size_t s = 0; s < surfaces.forms.size(); s++) {
    Line1 l = solve(along(surfaces.forms[s], line));
    signs.push_back(l.first);
    if (l.zero) zeros.push_back(surfaces.quadrics[s]), held.push_back(s);
    for (auto &r : l.roots) event(r, (long)s);
  }
  out.zero_surfaces = (int)zeros.size();
  std::vector<V> g0, g1; // gradients along the line: g0 + t g1
  for (auto *q : zeros) g0.push_back(q->gradient(o)), g1.push_back(q->gradient(o + d) - g0.back());
  auto edge = [&](size_t i) { return zero(g0[i]) && zero(g1[i]); }; // of two planes
  for (size_t i = 0; i < zeros.size(); i++) {
    for (size_t k = 0; k < 3; k++)
      if (g1[i][k] != 0) {
        Q t = -g0[i][k] / g1[i][k];
        if (zero(g0[i] + t * g1[i])) event(Root(t), -1);
        break;
      }
    for (size_t j = 0; j < i; j++) { // d . (g_i x g_j): a quadratic
      Q a = dot(d, cross(g1[i], g1[j])), b = dot(d, cross(g0[i], g1[j]) + cross(g1[i], g0[j])), c = dot(d, cross(g0[i], g0[j]));
      std::vector<Root> turns;
      if (edge(i)) turns = at_planes(*zeros[i], g0[j], g1[j], d);
      else if (edge(j)) turns = at_planes(*zeros[j], g0[i], g1[i], d);
      else turns = a == 0 && b == 0 && c == 0 ? equal_bends(*zeros[i], *zeros[j], o, d) : all_roots(c, b, a);
      for (auto &r : turns) event(r, -1);
    }
  }
  std::sort(events.begin(), events.end(), [](const Event &a, const Event &b) { return a.t < b.t; });
  auto between = [](const Root &a, const Root &b, Q &t) { // a rational in (a, b)
    for (int bits = 60; bits < 4000; bits *= 3) {
      t = (near_root(a, bits) + near_root(b, bits)) / 2;
      if (a < Root(t) && Root(t) < b) return true;
    }
    return false;
  };
  std::vector<Root> cuts;
  std::vector<Answer::What> what;
  for (size_t i = 0;; ) { // events before i have been passed
    Q t[2];
    if (events.empty()) t[0] = Q(7919) / 104729, t[1] = Q(-31337) / 1013;
    else if (i == 0 || i == events.size()) {
      auto end = CGAL::to_interval(events[i ? i - 1 : 0].t);
      if (!std::isfinite(end.first) || !std::isfinite(end.second)) return out;
      Q far = Q(std::fabs(end.first)) + Q(std::fabs(end.second)) + 1;
      t[0] = i ? Q(end.second) + far / 3 : Q(end.first) - far / 3;
      t[1] = i ? Q(end.second) + Q(1000) * far : Q(end.first) - Q(1000) * far;
    } else if (!between(events[i - 1].t, events[i].t, t[0]) || !between(events[i - 1].t, Root(t[0]), t[1])) return out;
    Answer::What w[2];
    for (int k = 0; k < 2; k++) {
      V p = o + t[k] * d;
      Q size = 1;
      bool failed = false;
      for (auto &e : p)
        if (e != 0) size = CGAL::abs(e) < size ? CGAL::abs(e) : size;
      w[k] = ring(solid, surfaces, held, signs, p, d, size, failed);
      if (failed) return out;
    }
    if (w[0] != w[1]) return out;
    if (what.empty()) what.push_back(w[0]);
    else if (what.back() != w[0]) cuts.push_back(events[i - 1].t), what.push_back(w[0]);
    if (i == events.size()) break;
    const Root here = events[i].t;
    for (; i < events.size() && events[i].t == here; i++)
      if (events[i].surface >= 0) signs[(size_t)events[i].surface] *= -1;
  }
  out.cuts = cuts, out.what = what, out.skipped = false;
  return out;
}
} // namespace stress
