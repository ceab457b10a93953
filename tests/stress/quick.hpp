// The quick judge: a ray's stretches, with as little arithmetic as each place needs.
//
// Every surface is solved in doubles with a bound on each error (numbers.hpp); where two places cannot be told apart, or a discriminant has no
// sign, the surfaces concerned are solved again in quadruple precision, then with whole numbers, and at last two roots are compared as CGAL's
// square-root numbers. So every order is the true one. Lines in two surfaces at most, whose gradients are independent, are decided
// here; other lines in surfaces are left to the exact judge (ring.hpp).
#pragma once
#include "numbers.hpp"
#include "spec.hpp"

#include <map>
#include <optional>

namespace stress {
// A place on the ray where a surface's sign changes: the surface and which of its roots.
struct Cut { uint32_t surface; int which; };
template <class T> struct Roots { bool known = false; int first = 0, roots = 0; About<T> root[2]; }; // first: the sign before the first root
template <class T> struct Form { About<T> a[6], b[3], c; };             // about the pivot: y'Ay + 2 b.y + c

template <class T> Roots<T> solve_form(const Form<T> &f, bool plane, const About<T> y[3], const About<T> D[3]) {
  using N = About<T>;
  Roots<T> r;
  const N two{2, 0}, half{0.5, 0};
  N h{0, 0}, by{0, 0}, c = f.c, a{0, 0};
  for (int i = 0; i < 3; i++) h = h + f.b[i] * D[i], by = by + f.b[i] * y[i];
  c = c + two * by;
  static const int at[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
  for (int k = 0; !plane && k < 6; k++) {
    if (none(f.a[k])) continue;
    int i = at[k][0], j = at[k][1];
    a = a + f.a[k] * (D[i] * D[j]);
    c = c + f.a[k] * (y[i] * y[j]);
    h = h + f.a[k] * (i == j ? y[i] * D[i] : (y[i] * D[j] + y[j] * D[i]) * half);
  }
  int sa = sign_of(a), sh = sign_of(h);
  if (sa == 2) return r;
  if (sa == 0) {
    if (sh == 2) return r;
    int sc = sign_of(c);
    if (sh == 0) {
      if (sc == 2 || sc == 0) return r;
      r.known = true, r.first = sc;
    } else r.known = true, r.first = -sh, r.roots = 1, r.root[0] = -c / (two * h);
    return r;
  }
  N disc = h * h - a * c;
  int sd = sign_of(disc);
  if (sd == 2) return r;
  r.first = sa;
  if (sd <= 0) {
    r.known = true;
    return r;
  }
  N s1 = root_of(disc);
  if (sh == 2 && !(mag(h.v) + h.e < mag(s1.v) * 0.5)) return r;
  N q = h.v >= 0 ? -(h + s1) : s1 - h; // no cancellation
  if (sign_of(q) == 2) return r;
  N x1 = q / a, x2 = c / q;
  if (x1.v > x2.v) std::swap(x1, x2);
  r.root[0] = x1, r.root[1] = x2, r.roots = 2;
  r.known = std::isfinite(x1.e) && std::isfinite(x2.e) && mag(x1.v) < 0x1p1000 && mag(x2.v) < 0x1p1000;
  return r;
}

// One surface along the present ray.
struct OnRay {
  enum Level : int8_t { Doubles, Quadruple, Exact };
  Level level = Doubles;
  bool zero = false; // vanishes along the ray
  bool wide = false; // num is there
  int first = 0, roots = 0;
  double lo[2], hi[2]; // around each root; equal: the root is that double
  Num num[2];
  Quadratic p;
  std::optional<Root> root[2];
};

// The scene as the quick judge holds it.
struct Quick {
  struct Use { uint32_t leaf; int side; };
  struct Gate { Node::Op op; uint32_t parent; bool first; };
  struct Surface { Form<double> fast; Form<Wide> wide; double pivot[3]; bool plane; std::vector<Use> uses; };
  const Surfaces &exact; // the same surfaces, in the same order, with whole numbers
  std::vector<Surface> surfaces;
  std::vector<Ball> balls;
  std::vector<uint32_t> leaf_parent, leaf_halves;
  std::vector<uint8_t> leaf_first;
  std::vector<Gate> gates;

  // scratch of one ray
  std::vector<OnRay> on_ray;
  std::vector<uint32_t> failing;
  std::vector<int> leaf_on, gate_first, gate_others, sign;
  std::vector<uint8_t> touched;
  bool root_on = false;
  double o[3], d[3];
  bool whole_line = false;
  Line4 line;
  unsigned long long used[3] = {0, 0, 0}, compared = 0; // surfaces solved so, roots compared exactly

  Quick(const Node &solid, const Surfaces &s, const std::vector<Ball> &b) : exact(s), balls(b) {
    std::map<std::vector<Q>, uint32_t> known;
    add(solid, UINT32_MAX, false, known);
    if (surfaces.size() != exact.forms.size()) throw std::logic_error("surfaces are not the same");
    on_ray.resize(surfaces.size()), sign.resize(surfaces.size());
    failing.resize(leaf_halves.size()), leaf_on.resize(leaf_halves.size()), touched.resize(leaf_halves.size());
    gate_first.resize(gates.size()), gate_others.resize(gates.size());
  }
  static Fast narrow(const Num &n) {
    double v = (double)n.v;
    if (n.e == 0 && (Wide)v == n.v) return {v, 0};
    return made(v, n.e);
  }
  void add(const Node &n, uint32_t parent, bool first, std::map<std::vector<Q>, uint32_t> &known) {
    if (n.op != Node::IsLeaf) {
      uint32_t me = (uint32_t)gates.size();
      gates.push_back({n.op, parent, first});
      for (size_t i = 0; i < n.kids.size(); i++) add(n.kids[i], me, i == 0, known);
      return;
    }
    uint32_t leaf = (uint32_t)leaf_halves.size();
    leaf_parent.push_back(parent), leaf_first.push_back(first), leaf_halves.push_back((uint32_t)n.leaf.halves.size());
    for (auto &q : n.leaf.halves) {
      std::vector<Q> key;
      Q by = 0;
      for (int i = 0; i < 4; i++)
        for (int j = i; j < 4; j++) {
          if (by == 0) by = q.a[i][j];
          key.push_back(by == 0 ? Q(0) : q.a[i][j] / by);
        }
      int side = CGAL::sign(by);
      auto found = known.find(key);
      if (found == known.end()) {
        found = known.emplace(key, (uint32_t)surfaces.size()).first;
        Surface f;
        V p;
        const Ball &b = balls[leaf];
        for (int i = 0; i < 3; i++) f.pivot[i] = b.centre[i], p[i] = Q(f.pivot[i]);
        auto at = [&](int i, int j) { return q.a[i][j] / by; };
        int k = 0;
        f.plane = true;
        for (int i = 0; i < 3; i++)
          for (int j = i; j < 3; j++, k++) f.wide.a[k] = from_rational((i == j ? Q(1) : Q(2)) * at(i, j)), f.plane = f.plane && at(i, j) == 0;
        Q c = at(3, 3);
        for (int i = 0; i < 3; i++) {
          Q g = at(i, 3);
          for (int j = 0; j < 3; j++) g += at(i, j) * p[j];
          f.wide.b[i] = from_rational(g);
          c += (g + at(i, 3)) * p[i];
        }
        f.wide.c = from_rational(c);
        for (int i = 0; i < 6; i++) f.fast.a[i] = narrow(f.wide.a[i]);
        for (int i = 0; i < 3; i++) f.fast.b[i] = narrow(f.wide.b[i]);
        f.fast.c = narrow(f.wide.c);
        surfaces.push_back(f);
      }
      surfaces[found->second].uses.push_back({leaf, side});
    }
  }
  int gate_value(uint32_t g) const {
    switch (gates[g].op) {
    case Node::Union: return gate_first[g] + gate_others[g] > 0;
    case Node::Difference: return gate_first[g] > 0 && gate_others[g] == 0;
    default: return gate_first[g] == 0; // counts of children that do not hold
    }
  }
  void pass(uint32_t parent, bool first, int on) {
    for (uint32_t g = parent; g != UINT32_MAX; g = gates[g].parent) {
      int before = gate_value(g);
      if (gates[g].op == Node::Intersection) gate_first[g] += on ? -1 : 1;
      else (first ? gate_first[g] : gate_others[g]) += on ? 1 : -1;
      int after = gate_value(g);
      if (after == before) return;
      on = after, first = gates[g].first;
    }
    root_on = on;
  }
  void set_leaf(uint32_t l, int on) {
    if (leaf_on[l] != on) leaf_on[l] = on, pass(leaf_parent[l], leaf_first[l], on);
  }
  // Every leaf off. Intersections count children that do not hold: all of them.
  void rest() {
    root_on = false;
    std::fill(leaf_on.begin(), leaf_on.end(), 0);
    std::fill(failing.begin(), failing.end(), 0);
    std::fill(gate_first.begin(), gate_first.end(), 0);
    std::fill(gate_others.begin(), gate_others.end(), 0);
    auto off = [&](uint32_t parent) {
      if (parent != UINT32_MAX && gates[parent].op == Node::Intersection) gate_first[parent]++;
    };
    for (auto &g : gates) off(g.parent);
    for (uint32_t p : leaf_parent) off(p);
  }
  // The sign of a surface at a point; 2: not known.
  template <class T> static int sign_at(const Surface &s, const Form<T> &f, const About<T> p[3]) {
    About<T> y[3], by{0, 0}, c = f.c;
    for (int i = 0; i < 3; i++) y[i] = p[i] - About<T>{(T)s.pivot[i], 0}, by = by + f.b[i] * y[i];
    c = c + About<T>{2, 0} * by;
    static const int at[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
    for (int k = 0; !s.plane && k < 6; k++)
      if (!none(f.a[k])) c = c + f.a[k] * (y[at[k][0]] * y[at[k][1]]);
    return sign_of(c);
  }
  // The side of a point: 0 outside, 2 inside, -1 not known.
  int side(const double p[3]) {
    for (size_t l = 0; l < touched.size(); l++) {
      const Ball &b = balls[l];
      double far = 0, size = 0;
      for (int i = 0; i < 3; i++) far += (p[i] - b.centre[i]) * (p[i] - b.centre[i]), size += std::fabs(p[i]) + std::fabs(b.centre[i]);
      touched[l] = !(std::sqrt(far) > b.radius * 1.001 + size * 0x1p-40);
    }
    rest();
    const Fast x[3] = {{p[0], 0}, {p[1], 0}, {p[2], 0}};
    const Num w[3] = {{p[0], 0}, {p[1], 0}, {p[2], 0}};
    for (auto &s : surfaces) {
      bool any = false;
      for (auto &use : s.uses) any |= touched[use.leaf] != 0;
      if (!any) continue;
      int sc = sign_at(s, s.fast, x);
      if (sc == 2) sc = sign_at(s, s.wide, w);
      if (sc == 2 || sc == 0) return -1;
      for (auto &use : s.uses) failing[use.leaf] += sc * use.side > 0;
    }
    for (uint32_t l = 0; l < touched.size(); l++) set_leaf(l, touched[l] && failing[l] == 0);
    return root_on ? 2 : 0;
  }

  // --- a ray's surfaces -------------------------------------------------------------------------------------------------

  void around(OnRay &a) { // lo and hi from num
    for (int k = 0; k < a.roots; k++) {
      double v = (double)a.num[k].v;
      if (a.num[k].e == 0 && (Wide)v == a.num[k].v) a.lo[k] = a.hi[k] = v;
      else {
        double lo = (double)(a.num[k].v - (Wide)a.num[k].e), hi = (double)(a.num[k].v + (Wide)a.num[k].e);
        a.lo[k] = std::nextafter(lo, -INFINITY), a.hi[k] = std::nextafter(hi, INFINITY);
      }
    }
  }
  bool by_doubles(uint32_t s, OnRay &a) {
    const Surface &f = surfaces[s];
    Fast y[3], D[3];
    for (int i = 0; i < 3; i++) y[i] = Fast{o[i], 0} - Fast{f.pivot[i], 0}, D[i] = Fast{d[i], 0};
    auto r = solve_form(f.fast, f.plane, y, D);
    if (!r.known) return false;
    used[0]++;
    a.level = OnRay::Doubles, a.first = r.first, a.roots = r.roots;
    for (int k = 0; k < r.roots; k++) {
      double v = r.root[k].v, e = r.root[k].e;
      a.lo[k] = e == 0 ? v : std::nextafter(v - e, -INFINITY), a.hi[k] = e == 0 ? v : std::nextafter(v + e, INFINITY);
    }
    return r.roots < 2 || a.hi[0] < a.lo[1];
  }
  bool by_quadruple(uint32_t s, OnRay &a) {
    const Surface &f = surfaces[s];
    Num y[3], D[3];
    for (int i = 0; i < 3; i++) y[i] = Num{(Wide)o[i], 0} - Num{(Wide)f.pivot[i], 0}, D[i] = Num{(Wide)d[i], 0};
    auto r = solve_form(f.wide, f.plane, y, D);
    if (!r.known) return false;
    used[1]++;
    a.level = OnRay::Quadruple, a.first = r.first, a.roots = r.roots, a.wide = true;
    for (int k = 0; k < r.roots; k++) a.num[k] = r.root[k];
    around(a);
    return r.roots < 2 || before(a.num[0], a.num[1]);
  }
  void by_integers(uint32_t s, OnRay &a) {
    used[2]++;
    if (!whole_line) line = whole(V{Q(o[0]), Q(o[1]), Q(o[2])}, V{Q(d[0]), Q(d[1]), Q(d[2])}), whole_line = true;
    a.level = OnRay::Exact, a.wide = true, a.roots = 0, a.zero = false;
    a.p = along(exact.forms[s], line);
    const Quadratic &p = a.p;
    if (p.a == 0 && p.b == 0) {
      a.zero = p.c == 0, a.first = CGAL::sign(p.c);
      return;
    }
    long bits = 0;
    for (const Z *z : {&p.a, &p.b, &p.c}) bits = std::max(bits, (long)mpz_sizeinbase(z->mpz(), 2));
    Num na = from_integer(p.a, bits), nb = from_integer(p.b, bits), nc = from_integer(p.c, bits);
    if (p.a == 0) {
      a.first = -CGAL::sign(p.b), a.roots = 1, a.num[0] = -nc / nb;
    } else {
      a.first = CGAL::sign(p.a);
      Z disc = p.b * p.b - Z(4) * p.a * p.c;
      if (disc <= 0) return;
      Num s1 = root_of(from_integer(disc, 2 * bits)), q = nb.v >= 0 ? -(nb + s1) : s1 - nb, two{2, 0};
      a.roots = 2;
      Num x1 = q / (two * na), x2 = two * nc / q;
      bool swap = (p.b >= 0) == (p.a < 0); // x1 is the greater root when q and a have one sign ... q < 0 with b >= 0
      a.num[0] = swap ? x2 : x1, a.num[1] = swap ? x1 : x2;
    }
    around(a);
    for (int k = 0; k < a.roots; k++)
      if (!(a.lo[k] <= a.hi[k])) a.lo[k] = -INFINITY, a.hi[k] = INFINITY, a.num[k].e = INFINITY;
  }
  void start(uint32_t s) {
    OnRay &a = on_ray[s];
    a.level = OnRay::Doubles, a.zero = a.wide = false, a.root[0].reset(), a.root[1].reset();
    if (!by_doubles(s, a) && !by_quadruple(s, a)) by_integers(s, a);
  }
  void refine(uint32_t s) {
    OnRay &a = on_ray[s];
    if (a.level != OnRay::Doubles || !by_quadruple(s, a)) by_integers(s, a);
  }
  const Root &root(const Cut &c) {
    OnRay &a = on_ray[c.surface];
    if (!a.root[c.which]) {
      auto l = oracle::solve(a.p);
      for (size_t k = 0; k < l.roots.size(); k++) a.root[k] = l.roots[k];
    }
    return *a.root[c.which];
  }
  static bool before(const Num &a, const Num &b) { return b.v - a.v > ((Wide)a.e + (Wide)b.e) * (1 + 0x1p-40); }
  static bool same(const Num &a, const Num &b) { return a.e == 0 && b.e == 0 && a.v == b.v; }
  int order(const Cut &x, const Cut &y) {
    if (x.surface == y.surface) return x.which - y.which;
    OnRay &a = on_ray[x.surface], &b = on_ray[y.surface];
    for (;;) {
      if (a.hi[x.which] < b.lo[y.which]) return -1;
      if (b.hi[y.which] < a.lo[x.which]) return 1;
      if (a.lo[x.which] == a.hi[x.which] && b.lo[y.which] == b.hi[y.which]) return 0; // two doubles
      if (a.wide && b.wide) {
        const Num &m = a.num[x.which], &n = b.num[y.which];
        if (before(m, n)) return -1;
        if (before(n, m)) return 1;
        if (same(m, n)) return 0;
      }
      if (a.level == OnRay::Exact && b.level == OnRay::Exact) break;
      refine(a.level <= b.level ? x.surface : y.surface);
    }
    compared++;
    return (int)CGAL::compare(root(x), root(y));
  }
  int compare(const Cut &x, double t) {
    if (std::isinf(t)) return t > 0 ? -1 : 1;
    OnRay &a = on_ray[x.surface];
    for (;;) {
      if (a.hi[x.which] < t) return -1;
      if (a.lo[x.which] > t) return 1;
      if (a.lo[x.which] == a.hi[x.which]) return 0;
      if (a.wide) {
        const Num &m = a.num[x.which];
        Wide gap = m.v - (Wide)t;
        if (gap > (Wide)m.e * (1 + 0x1p-40)) return 1;
        if (-gap > (Wide)m.e * (1 + 0x1p-40)) return -1;
      }
      if (a.level == OnRay::Exact) break;
      refine(x.surface);
    }
    compared++;
    return (int)CGAL::compare(root(x), Root(Q(t)));
  }

  // --- stretches --------------------------------------------------------------------------------------------------------

  struct Found { std::vector<Cut> cuts; std::vector<Answer::What> what; bool any_on = false; }; // stretch i lies before cut i
  std::vector<Cut> cuts;
  std::vector<uint32_t> ends, zeros; // cuts of one place: up to ends[i]
  std::vector<uint32_t> met;
  // False: not decided here.
  bool shoot(const double origin[3], const double direction[3], Found &out) {
    out.cuts.clear(), out.what.clear(), cuts.clear(), ends.clear(), zeros.clear(), met.clear();
    out.any_on = whole_line = false;
    for (int i = 0; i < 3; i++) o[i] = origin[i], d[i] = direction[i];
    for (int i = 0; i < 3; i++) {
      if (o[i] != 0 && !(std::fabs(o[i]) > 0x1p-300 && std::fabs(o[i]) < 0x1p300)) return false;
      if (d[i] != 0 && !(std::fabs(d[i]) > 0x1p-300 && std::fabs(d[i]) < 0x1p300)) return false;
    }
    double big = std::max({std::fabs(d[0]), std::fabs(d[1]), std::fabs(d[2])}), u[3] = {d[0] / big, d[1] / big, d[2] / big};
    double uu = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    for (size_t l = 0; l < touched.size(); l++) { // leaves far from the line are off all along
      const Ball &b = balls[l];
      touched[l] = 1;
      if (std::isfinite(b.radius)) {
        double y[3], size = 0;
        for (int i = 0; i < 3; i++) y[i] = o[i] - b.centre[i], size += std::fabs(o[i]) + std::fabs(b.centre[i]);
        double c[3] = {y[1] * u[2] - y[2] * u[1], y[2] * u[0] - y[0] * u[2], y[0] * u[1] - y[1] * u[0]};
        double far = std::sqrt((c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) / uu);
        touched[l] = !(far > b.radius * 1.001 + size * 0x1p-40);
      }
    }
    for (uint32_t s = 0; s < surfaces.size(); s++) {
      bool any = false;
      for (auto &use : surfaces[s].uses) any |= touched[use.leaf] != 0;
      if (!any) continue;
      met.push_back(s);
      start(s);
      if (on_ray[s].zero) zeros.push_back(s);
      for (int k = 0; k < on_ray[s].roots; k++) cuts.push_back({s, k});
    }
    if (zeros.size() > 2 || !independent()) return false;
    std::sort(cuts.begin(), cuts.end(), [&](const Cut &a, const Cut &b) { return order(a, b) < 0; });
    for (size_t i = 0; i < cuts.size(); i++)
      if (i + 1 == cuts.size() || order(cuts[i], cuts[i + 1]) != 0) ends.push_back((uint32_t)i + 1);
    for (unsigned side = 0; side < 1u << zeros.size(); side++) sweep(side, out.what);
    // Stretches alike are merged.
    size_t kept = 0;
    for (size_t i = 0; i < ends.size(); i++)
      if (out.what[i + 1] != out.what[kept]) out.cuts.push_back(cuts[ends[i] - 1]), out.what[++kept] = out.what[i + 1];
    out.what.resize(kept + 1);
    for (auto w : out.what) out.any_on |= w == Answer::On;
    return true;
  }
  // Surfaces that vanish along the ray: whether all combinations of their sides are next to it.
  bool independent() {
    if (zeros.empty()) return true;
    V p{Q(o[0]), Q(o[1]), Q(o[2])}, g[2];
    for (int i = 0; i < 3; i++) p[(size_t)i] += Q(7919) / Q(104729) * Q(d[i]);
    for (size_t i = 0; i < zeros.size(); i++) {
      g[i] = exact.quadrics[zeros[i]]->gradient(p);
      if (oracle::zero(g[i])) return false;
    }
    return zeros.size() < 2 || !oracle::zero(cross(g[0], g[1]));
  }
  // The stretches with the surfaces that vanish on given sides; side 0 begins what, the others differ or agree.
  void sweep(unsigned side, std::vector<Answer::What> &what) {
    rest();
    for (uint32_t s : met) sign[s] = on_ray[s].first;
    for (size_t i = 0; i < zeros.size(); i++) sign[zeros[i]] = side >> i & 1 ? 1 : -1;
    for (uint32_t s : met)
      for (auto &use : surfaces[s].uses) failing[use.leaf] += sign[s] * use.side > 0;
    for (uint32_t l = 0; l < touched.size(); l++) set_leaf(l, touched[l] && failing[l] == 0);
    auto note = [&](size_t i) {
      Answer::What w = root_on ? Answer::Inside : Answer::Outside;
      if (side == 0) what.push_back(w);
      else if (what[i] != w) what[i] = Answer::On;
    };
    note(0);
    for (size_t i = 0, at = 0; i < ends.size(); i++) {
      for (; at < ends[i]; at++) {
        uint32_t s = cuts[at].surface;
        sign[s] = -sign[s];
        for (auto &use : surfaces[s].uses) {
          if (!touched[use.leaf]) continue;
          failing[use.leaf] += sign[s] * use.side > 0 ? 1 : -1;
          set_leaf(use.leaf, failing[use.leaf] == 0);
        }
      }
      note(i + 1);
    }
  }
  const Root &exact_root(const Cut &x) {
    while (on_ray[x.surface].level != OnRay::Exact) refine(x.surface);
    return root(x);
  }
  // The place with a relative error near 2^-100, for measuring.
  const Num &wide(const Cut &x) {
    OnRay &a = on_ray[x.surface];
    if (!a.wide) refine(x.surface);
    return on_ray[x.surface].num[x.which];
  }
  // Is t the double nearest to the place?
  bool nearest(double t, const Cut &x) {
    OnRay &a = on_ray[x.surface];
    for (;;) {
      if (a.lo[x.which] == a.hi[x.which]) return t == a.lo[x.which];
      if (a.wide) {
        int n = nearest_quick(t, a.num[x.which]);
        if (n != 2) return n;
      }
      if (a.level == OnRay::Exact) break;
      refine(x.surface);
    }
    compared++;
    return oracle::nearest(t, root(x));
  }
};
} // namespace stress
