// Every model that is a little smaller than a failing one: a part of the tree less, a transform less, a plainer number.
#pragma once
#include "spec.hpp"

#include <chrono>
#include <functional>

namespace stress {
inline double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

inline Spec *node_at(Spec &s, int &i) {
  if (i-- == 0) return &s;
  for (auto &k : s.kids)
    if (Spec *f = node_at(k, i)) return f;
  return nullptr;
}
inline int nodes_of(const Spec &s) {
  int n = 1;
  for (auto &k : s.kids) n += nodes_of(k);
  return n;
}
inline Q whole(const Q &q) { return Q(std::nearbyint(CGAL::to_double(q))); }

// Whether the numbers make such a solid.
inline bool sound(const Spec &s) {
  for (auto &k : s.kids)
    if (!sound(k)) return false;
  const auto &p = s.shape.p;
  if (s.op != Node::IsLeaf) return true;
  switch (s.shape.kind) {
  case Shape::OneSheet: return p[1] > p[2];
  case Shape::TwoSheets: return p[0] > p[2];
  case Shape::HalfSpace: return p[0] != 0 || p[1] != 0 || p[2] != 0;
  case Shape::General: return std::any_of(p.begin(), p.begin() + 9, [](const Q &q) { return q != 0; });
  case Shape::Frustum: return p[1] != p[2];
  default: return true;
  }
}

// Calls attempt(spec) for every smaller tree until one returns true.
inline bool smaller(const Spec &from, const std::function<bool(const Spec &)> &attempt) {
  int n = nodes_of(from);
  auto edit = [&](int i, const std::function<bool(Spec &)> &f) {
    Spec s = from;
    int at = i;
    Spec *x = node_at(s, at);
    return x && f(*x) && sound(s) && attempt(s);
  };
  for (int i = 0; i < n; i++) {
    Spec copy = from;
    int at = i;
    Spec x = *node_at(copy, at);
    for (size_t k = 0; k < x.kids.size(); k++)
      if (edit(i, [&](Spec &s) {
            Spec kid = s.kids[k];
            kid.steps.insert(kid.steps.begin(), s.steps.begin(), s.steps.end());
            s = kid;
            return true;
          }))
        return true;
    for (size_t k = 0; x.kids.size() > 1 && k < x.kids.size(); k++)
      if (edit(i, [&](Spec &s) { return s.kids.erase(s.kids.begin() + (long)k), true; })) return true;
  }
  for (int i = 0; i < n; i++) {
    Spec copy = from;
    int at = i;
    Spec x = *node_at(copy, at);
    for (size_t k = 0; k < x.steps.size(); k++) {
      if (edit(i, [&](Spec &s) { return s.steps.erase(s.steps.begin() + (long)k), true; })) return true;
      for (int j = 0; j < 3 && x.steps[k].kind != Step::Matrix; j++) {
        Q plain = x.steps[k].kind == Step::Scale ? Q(1) : Q(0);
        if (x.steps[k].v[(size_t)j] != plain && edit(i, [&](Spec &s) { return s.steps[k].v[(size_t)j] = plain, true; })) return true;
        Q w = whole(x.steps[k].v[(size_t)j]);
        if (x.steps[k].v[(size_t)j] != w && w != 0 && edit(i, [&](Spec &s) { return s.steps[k].v[(size_t)j] = w, true; })) return true;
      }
    }
    if (x.op != Node::IsLeaf) continue;
    if (x.shape.placed && edit(i, [](Spec &s) { return s.shape.placed = false, true; })) return true;
    if (x.shape.center && edit(i, [](Spec &s) { return s.shape.center = false, true; })) return true;
    for (size_t j = 0; j < x.shape.p.size(); j++)
      for (int to : {0, 1, 2}) {
        if (x.shape.p[j] == to || (to == 0 && x.shape.kind != Shape::General && x.shape.kind != Shape::HalfSpace) || (to == 2 && whole(x.shape.p[j]) == x.shape.p[j])) continue;
        if (edit(i, [&](Spec &s) { return s.shape.p[j] = to, true; })) return true;
      }
  }
  return false;
}
} // namespace stress
