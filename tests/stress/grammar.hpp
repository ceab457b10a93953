// Random models on purpose full of faces shared, tangencies, rims that meet, near misses by 2^-20 to 2^-120, extreme sizes and places.
#pragma once
#include "census.hpp"
#include "spec.hpp"

namespace stress {
// How a model's numbers are drawn. dyadic: integers times powers of two, so that hard rays are exactly doubles.
struct Style {
  bool dyadic = true;
  Census *census = nullptr;
  int motif = -1; // of all models; -1: any
  enum { Wide = 11 }; // the motif
  std::vector<double> *gaps = nullptr; // those that were made, in the model's own size
  void note(const char *group, const std::string &kind) const {
    if (census) census->count(group, kind);
  }
};

inline Spec leaf_spec(const Shape &s) {
  Spec r;
  r.shape = s;
  return r;
}
inline Spec gate(Node::Op op, std::vector<Spec> kids) {
  Spec r;
  r.op = op, r.kids = std::move(kids);
  return r;
}
inline Spec around(const Step &s, Spec k) {
  k.steps.insert(k.steps.begin(), s);
  return k;
}
inline Spec moved(const V &v, Spec k) {
  Step s;
  s.v = v;
  return around(s, std::move(k));
}
inline V along_axis(int i, const Q &q) {
  V v{0, 0, 0};
  v[i] = q;
  return v;
}
inline Q a_size(Random &r, const Style &s) {
  static const int round[] = {1, 2, 2, 3, 4, 5, 5, 5, 10, 15, 25, 50};
  return s.dyadic ? Q(round[r.below(12)]) : tenth(r, 1, 50);
}
inline Q a_place(Random &r, const Style &s) { return s.dyadic ? Q(r.range(-6, 6)) : r.chance(60) ? Q(r.range(-3, 3)) : tenth(r, -60, 60); }
// What is between two faces that nearly meet; mostly nothing. Gaps near the spacing of doubles are where filters are tried, and where
// parameters lie in the middle between two doubles.
inline Q a_gap(Random &r, const Style &st) {
  if (r.chance(55)) return st.note("gap", "none"), Q(0);
  int e = r.chance(60) ? r.range(44, 58) : r.range(20, 120);
  st.note("gap", e < 44 ? "2^-20 to 2^-43" : e < 59 ? "2^-44 to 2^-58" : e < 90 ? "2^-59 to 2^-89" : "2^-90 to 2^-120");
  Q g = pow2(-e);
  if (st.gaps) st.gaps->push_back(std::ldexp(1, -e));
  return (r.chance(50) ? Q(1) : Q(-1)) * (r.chance(80) ? g : Q(3) * g);
}
inline Node::Op an_op(Random &r) { return (Node::Op)r.below(3); }

inline Shape a_shape(Random &r, const Style &st) {
  Shape s;
  s.kind = (Shape::Kind)r.below(Shape::Kinds);
  auto size = [&] { return a_size(r, st); };
  switch (s.kind) {
  case Shape::Sphere: s.p = {size()}; break;
  case Shape::Cube: case Shape::Ellipsoid: case Shape::Wedge: case Shape::Elliptic: case Shape::Tetra: s.p = {size(), size(), size()}; break;
  case Shape::Cylinder: case Shape::Paraboloid: case Shape::Prism: s.p = {size(), size()}; break;
  case Shape::Frustum:
    s.p = {size(), size(), size()};
    if (r.chance(40)) s.p[1 + r.below(2)] = 0;
    if (s.p[1] == s.p[2]) s.p[1] = s.p[1] + 1;
    break;
  case Shape::OneSheet: {
    static const int t[][3] = {{5, 3, 4}, {5, 4, 3}, {13, 5, 12}, {25, 7, 24}, {10, 6, 8}};
    auto &p = t[r.below(5)];
    Q unit = st.dyadic ? Q(1) : Q(1) / 5;
    s.p = {size(), unit * p[0], unit * p[1]};
    if (r.chance(20)) s.p = {size(), s.p[2] + size(), s.p[2]};
    break;
  }
  case Shape::TwoSheets: {
    Q gap = size();
    s.p = {gap + size(), size(), gap};
    break;
  }
  case Shape::Saddle: s.p = {pow2(r.range(-2, 2)), pow2(r.range(-2, 2))}; break;
  case Shape::HalfSpace:
    s.p = {Q(r.range(-3, 3)), Q(r.range(-3, 3)), Q(r.range(-3, 3)), a_place(r, st)};
    if (s.p[0] == 0 && s.p[1] == 0 && s.p[2] == 0) s.p[r.below(3)] = 1;
    break;
  default: {
    bool any = false;
    do {
      s.p.clear();
      for (int i = 0; i < 10; i++) s.p.push_back(Q(r.chance(40) ? 0 : r.range(-2, 2)));
      any = false;
      for (int i = 0; i < 9; i++) any |= s.p[i] != 0;
    } while (!any);
    if (r.chance(50)) s.p[9] = 0;
  }
  }
  bool centred = s.kind == Shape::Cube || s.kind == Shape::Cylinder || s.kind == Shape::Frustum || s.kind == Shape::Wedge;
  s.center = centred && r.chance(40);
  bool round = s.kind == Shape::Sphere || s.kind == Shape::Cylinder || s.kind == Shape::Frustum || s.kind == Shape::Paraboloid || s.kind == Shape::OneSheet || s.kind == Shape::TwoSheets;
  if (round && !s.center && r.chance(15)) {
    s.placed = true;
    s.base = {a_place(r, st), a_place(r, st), a_place(r, st)};
    s.stretch = r.chance(50) ? Q(1) : Q(r.range(1, 25));
    if (r.chance(50)) s.unit = along_axis(r.below(3), r.chance(50) ? 1 : -1);
    else s.unit = on_sphere(r);
  }
  return s;
}

inline Step a_turn(Random &r) {
  Step s;
  if (r.chance(50)) {
    s.kind = Step::Quarters;
    s.v = along_axis(r.below(3), r.range(1, 3));
    if (r.chance(20)) s.v = {Q(r.below(4)), Q(r.below(4)), Q(r.below(4))};
    return s;
  }
  s.kind = Step::Matrix;
  auto c = circle(r);
  int i = r.below(3), j = (i + 1) % 3;
  s.map.m[i][i] = s.map.m[j][j] = c[0], s.map.m[i][j] = -c[1], s.map.m[j][i] = c[1];
  return s;
}
inline Step a_step(Random &r, const Style &st) {
  Step s;
  switch (r.below(6)) {
  case 0: case 1: case 2: s.v = {a_place(r, st), a_place(r, st), a_place(r, st)}; break;
  case 3: return a_turn(r);
  case 4:
    s.kind = Step::Scale;
    s.v = {Q(1), Q(1), Q(1)};
    for (auto &e : s.v) e = st.dyadic ? pow2(r.range(-2, 2)) : tenth(r, 1, 30);
    if (r.chance(30)) s.v = {s.v[0], s.v[0], s.v[0]};
    if (r.chance(20)) s.v[r.below(3)] *= -1;
    break;
  default: {
    s.kind = Step::Matrix;
    int i = r.below(3), j = (i + 1 + r.below(2)) % 3;
    s.map.m[i][j] = st.dyadic ? Q(r.range(-4, 4)) / 2 : tenth(r, -20, 20);
  }
  }
  return s;
}
inline Spec a_leaf(Random &r, const Style &st) {
  Spec s = leaf_spec(a_shape(r, st));
  if (r.chance(70)) s.steps.push_back(a_step(r, st));
  if (r.chance(15)) s.steps.push_back(a_step(r, st));
  return s;
}
inline Spec simple(Shape::Kind k, std::vector<Q> p, bool center = false) {
  Shape s;
  s.kind = k, s.p = std::move(p), s.center = center;
  return leaf_spec(s);
}

// Coincidences made on purpose, of about n leaves.
inline Spec a_motif(Random &r, const Style &st, int n) {
  Q a = a_size(r, st), b = a_size(r, st), c = a_size(r, st);
  static const char *const motifs[] = {"flush cuts", "stacked", "inscribed", "meeting in circles", "minus moved copies", "turned about an axis", "lattice", "thin shells", "touching balls", "tangent along lines", "sheets on one line", "gaps as wide as bounds"};
  int motif = st.motif >= 0 ? st.motif : r.below(12);
  st.note("motif", motifs[motif]);
  switch (motif) {
  case 0: { // flush cuts
    std::vector<Spec> k{simple(Shape::Cube, {a + b, b + c, c})};
    for (int i = 1; i < std::max(2, n); i++) {
      Spec cut = r.chance(50) ? simple(Shape::Cylinder, {c, a / 2}) : simple(Shape::Cube, {a, b, c});
      k.push_back(moved({a_place(r, st), a_place(r, st), a_gap(r, st)}, cut));
    }
    return gate(r.chance(70) ? Node::Difference : an_op(r), k);
  }
  case 1: { // stacked along z
    std::vector<Spec> k;
    Q z = 0;
    for (int i = 0; i < std::max(2, n); i++) {
      Q h = a_size(r, st), rad = r.chance(50) ? a : a_size(r, st);
      Spec s = r.chance(60) ? simple(Shape::Cylinder, {h, rad}) : r.chance(50) ? simple(Shape::Frustum, {h, rad, rad + 1}) : simple(Shape::Cube, {rad, rad, h});
      k.push_back(moved({0, 0, z}, s));
      z = z + h + a_gap(r, st);
    }
    return gate(an_op(r), k);
  }
  case 2: { // inscribed
    std::vector<Spec> k;
    Q two(2);
    Spec box = simple(Shape::Cube, {two * a, two * a, two * a}, true), ball = simple(Shape::Sphere, {a}), rod = simple(Shape::Cylinder, {two * a, a}, true);
    Spec all[3] = {box, ball, rod};
    k.push_back(all[r.below(3)]);
    for (int i = 1; i < std::min(std::max(2, n), 6); i++) k.push_back(moved(along_axis(r.below(3), a_gap(r, st)), all[r.below(3)]));
    return gate(an_op(r), k);
  }
  case 3: { // coaxial solids that meet in circles
    std::vector<Spec> k{simple(Shape::Frustum, {Q(3), Q(4), Q(1)})};
    k.push_back(simple(Shape::Sphere, {Q(5)}));
    k.back() = moved({0, 0, -3}, k.back()); // through the rim of radius 4 at z = 0
    k.push_back(moved({0, 0, 3 + a_gap(r, st)}, simple(Shape::Frustum, {a, Q(1), b + 1})));
    k.push_back(moved({0, 0, -3}, simple(Shape::Cylinder, {Q(3), Q(4)})));
    k.push_back(moved({0, 0, -5}, simple(Shape::Paraboloid, {Q(5), Q(4)})));
    for (int i = (int)k.size(); i > 2 && i > n; i--) k.erase(k.begin() + r.below((int)k.size()));
    if (r.chance(50)) std::reverse(k.begin(), k.end());
    Spec s = gate(an_op(r), k);
    if (!st.dyadic) {
      Step f;
      f.kind = Step::Scale, f.v = {Q(1) / 10, Q(1) / 10, Q(1) / 10};
      s = around(f, s);
    }
    return s;
  }
  case 4: { // minus its own copy, moved along an axis by an exact step
    Spec s = r.chance(30) ? moved(along_axis(r.below(3), a_gap(r, st)), a_leaf(r, st)) : a_leaf(r, st);
    std::vector<Spec> k{s};
    Q step = r.chance(20) ? Q(0) : a_size(r, st);
    int axis = r.below(3);
    for (int i = 1; i < std::min(std::max(2, n), 20); i++) k.push_back(moved(along_axis(axis, Q(i) * step + a_gap(r, st)), s));
    return gate(r.chance(60) ? Node::Difference : an_op(r), k);
  }
  case 5: { // turned about a common axis
    Spec s = a_leaf(r, st);
    std::vector<Spec> k{s};
    Step t = a_turn(r);
    Spec u = s;
    for (int i = 1; i < std::min(std::max(2, n), 5); i++) k.push_back(u = around(t, u));
    return gate(an_op(r), k);
  }
  case 6: { // a lattice of touching or overlapping solids
    std::vector<Spec> k;
    Spec s = r.chance(40) ? simple(Shape::Cube, {a, a, a}) : r.chance(50) ? simple(Shape::Sphere, {r.chance(50) ? a / 2 : a}) : simple(Shape::Cylinder, {a, a / 2});
    int side = std::max(2, (int)std::sqrt((double)n));
    for (int i = 0; i < side; i++)
      for (int j = 0; j < std::max(1, n / side); j++) k.push_back(moved({Q(i) * a, Q(j) * a, r.chance(90) ? Q(0) : a_gap(r, st)}, s));
    Spec all = gate(Node::Union, k);
    for (int i = 0; i < 3; i++) { // between neighbours, at half their height or that of their centres
      V at{Q(r.range(0, side - 2)) * a + a / 2, Q(r.range(0, side - 1)) * a, 0};
      if (s.shape.kind == Shape::Cube) at = at + V{a / 2, a / 2, a / 2};
      else if (s.shape.kind == Shape::Cylinder) at = at + V{0, 0, a / 2};
      all.contacts.push_back({Spot::Smooth, at, V{1, 0, 0}, V{0, 0, s.shape.kind == Shape::Sphere ? Q(0) : Q(1)}});
    }
    return r.chance(50) ? all : gate(Node::Difference, {moved({-a, -a, 0}, simple(Shape::Cube, {Q(side + 2) * a, Q(side + 2) * a, a})), all});
  }
  case 7: { // thin shells
    int thin = r.range(20, 120);
    st.note("shell", thin < 44 ? "2^-20 to 2^-43" : thin < 59 ? "2^-44 to 2^-58" : "2^-59 to 2^-120");
    Q g = pow2(-thin);
    if (st.gaps) st.gaps->push_back(std::ldexp(1, -thin));
    Shape::Kind kind = r.chance(50) ? Shape::Sphere : r.chance(50) ? Shape::Cylinder : Shape::Cube;
    auto make = [&](const Q &w) { return kind == Shape::Sphere ? simple(kind, {a + w}) : kind == Shape::Cylinder ? simple(kind, {b + 2 * w, a + w}, true) : simple(kind, {a + w, b + w, c + w}, true); };
    std::vector<Spec> k{make(g), make(0)};
    for (int i = 2; i < std::min(n, 5); i++) k.push_back(make(Q(-i) * g));
    return gate(r.chance(70) ? Node::Difference : an_op(r), k);
  }
  case 8: { // balls and rods that touch, in a rational direction
    V u = on_sphere(r);
    bool inner = r.chance(30);
    Q far = inner ? a - b : a + b;
    std::vector<Spec> k{simple(Shape::Sphere, {a}), moved((far + a_gap(r, st)) * u, simple(Shape::Sphere, {b}))};
    if (n > 2) k.push_back(moved(V{a + c, 0, -c}, simple(Shape::Cylinder, {2 * c, c})));
    if (n > 3) k.push_back(moved(V{-a - b, 0, 0}, simple(Shape::Sphere, {b})));
    Spec s = gate(an_op(r), k);
    s.contacts.push_back({Spot::Smooth, a * u, u, V{0, 0, 0}});
    if (n > 2) s.contacts.push_back({Spot::Generator, V{a, 0, 0}, V{1, 0, 0}, V{0, 0, 1}});
    if (n > 3) s.contacts.push_back({Spot::Smooth, V{-a, 0, 0}, V{1, 0, 0}, V{0, 0, 0}});
    return s;
  }
  case 10: { // sheets on one line: a double cone's generator, with planes and other surfaces that hold it, many of them tangent
    static const int g[][3] = {{1, 0, 1}, {0, 1, 1}, {3, 4, 5}, {-4, 3, 5}};
    auto &e = g[r.below(4)];
    Spec cone = simple(Shape::General, {1, 1, -1, 0, 0, 0, 0, 0, 0, 0});
    std::vector<Spec> k{cone};
    const V along{Q(e[0]), Q(e[1]), Q(e[2])}, normal{Q(e[0]), Q(e[1]), Q(-e[2])};
    for (int i = 1; i < std::max(2, std::min(n, 6)); i++) {
      Spec s;
      switch (r.below(7)) {
      case 0: case 1: { // the tangent plane
        Q side = r.chance(50) ? Q(1) : Q(-1);
        s = simple(Shape::HalfSpace, {side * normal[0], side * normal[1], side * normal[2], r.chance(80) ? Q(0) : a_gap(r, st)});
        break;
      }
      case 2: { // any plane on the line
        V m = cross(along, V{Q(r.range(-3, 3)), Q(r.range(1, 3)), Q(r.range(-3, 3))});
        if (zero(m)) m = normal;
        s = simple(Shape::HalfSpace, {m[0], m[1], m[2], Q(0)});
        break;
      }
      case 3: s = moved(Q(r.range(-3, 3)) * along, cone); break; // another cone, its apex on the line
      case 4: { // a pair of planes on the line, as one quadric
        auto plane = [&] {
          V m = r.chance(30) ? normal : cross(along, V{Q(r.range(-3, 3)), Q(r.range(1, 3)), Q(r.range(-3, 3))});
          return zero(m) ? normal : m;
        };
        const V m = plane(), n = plane();
        s = simple(Shape::General, {m[0] * n[0], m[1] * n[1], m[2] * n[2], m[0] * n[1] + m[1] * n[0], m[0] * n[2] + m[2] * n[0], m[1] * n[2] + m[2] * n[1], 0, 0, 0, 0});
        break;
      }
      case 5: // q + f (normal.x) (a plane): it holds the line, and touches the cone along it where f's plane does too
      default: {
        V m = r.chance(50) ? normal : cross(along, V{Q(r.range(-2, 2)), Q(r.range(-2, 2)), Q(r.range(1, 2))});
        if (zero(m)) m = normal;
        Q c = r.chance(50) ? Q(0) : Q(r.range(-4, 4)), f = Q(r.range(1, 3));
        if (r.chance(50)) m = V{Q(r.range(-2, 2)), Q(r.range(-2, 2)), Q(r.range(-2, 2))};
        std::vector<Q> p{1, 1, -1, 0, 0, 0, 0, 0, 0, 0};
        const V &t = normal;
        p[0] += f * t[0] * m[0], p[1] += f * t[1] * m[1], p[2] += f * t[2] * m[2];
        p[3] += f * (t[0] * m[1] + t[1] * m[0]), p[4] += f * (t[0] * m[2] + t[2] * m[0]), p[5] += f * (t[1] * m[2] + t[2] * m[1]);
        p[6] += f * c * t[0], p[7] += f * c * t[1], p[8] += f * c * t[2];
        s = simple(Shape::General, p);
        if (std::all_of(p.begin(), p.begin() + 9, [](const Q &q) { return q == 0; })) s = cone;
      }
      }
      k.push_back(s);
    }
    if (r.chance(30)) k.push_back(simple(Shape::Cube, {2 * a, 2 * a, 2 * a}, true));
    if (r.chance(50)) std::reverse(k.begin(), k.end());
    return k.size() > 3 && r.chance(50) ? gate(an_op(r), {gate(an_op(r), {k[0], k[1]}), gate(an_op(r), std::vector<Spec>(k.begin() + 2, k.end()))}) : gate(an_op(r), k);
  }
  case Style::Wide: { // one gate, thin walls and thin gaps, far from the origin or not: where a place and a bound on errors are compared
    int thin = r.chance(70) ? r.range(26, 44) : r.range(16, 56);
    Q g = pow2(-thin) * Q(r.range(16, 31)) / 16;
    if (st.gaps) st.gaps->push_back(CGAL::to_double(g));
    st.note("gap", thin < 44 ? "2^-20 to 2^-43" : "2^-44 to 2^-58");
    Shape::Kind kind = r.chance(60) ? Shape::Cube : r.chance(50) ? Shape::Sphere : Shape::Cylinder;
    auto make = [&](const Q &w) { return kind == Shape::Sphere ? simple(kind, {a + w}) : kind == Shape::Cylinder ? simple(kind, {b + 2 * w, a + w}, true) : simple(kind, {a + w, b + w, c + w}, true); };
    auto beside = [&](int i) { // gaps between bodies that stand in a row
      Q step = kind == Shape::Sphere ? 2 * a : kind == Shape::Cylinder ? b : a;
      return moved(along_axis(kind == Shape::Cube ? 0 : 2, Q(i) * (step + g)), make(0));
    };
    std::vector<Spec> k{make(g), make(0)};
    Node::Op op = Node::Difference;
    switch (r.below(4)) {
    case 0: break; // a shell
    case 1: // a row
      op = Node::Union, k.clear();
      for (int i = 0; i < std::max(2, std::min(n, 6)); i++) k.push_back(beside(i));
      break;
    case 2: // a row taken away: thin walls
      k = {simple(Shape::Cube, {Q(20) * a, Q(20) * (a + b), Q(20) * (a + b)}, true)};
      for (int i = 0; i < std::max(2, std::min(n, 6)); i++) k.push_back(beside(i));
      break;
    default: // a thin overlap
      op = Node::Intersection, k = {make(0), moved(along_axis(kind == Shape::Cube ? 0 : 2, (kind == Shape::Sphere ? 2 * a : kind == Shape::Cylinder ? b : a) - g), make(0))};
    }
    if (r.chance(50)) {
      V v{0, 0, 0};
      for (auto &e : v) e = r.chance(50) ? Q(r.range(-9, 9)) : pow2(r.range(4, 20)) * Q(r.range(-9, 9));
      for (auto &s : k) s = moved(v, s);
    }
    return gate(op, k);
  }
  default: { // a box and a round solid with a common generator or circle: all tangent along lines
    std::vector<Spec> k{moved({-a, -a, 0}, simple(Shape::Cube, {2 * a, 2 * a, b})), simple(Shape::Cylinder, {b, a})};
    if (n > 2) k.push_back(moved({2 * a + a_gap(r, st), 0, 0}, simple(Shape::Cylinder, {b, a})));
    if (n > 3) k.push_back(moved({0, 0, b}, simple(Shape::Sphere, {a})));
    return gate(an_op(r), k);
  }
  }
}

inline Spec a_solid(Random &r, const Style &st, int n, int depth) {
  if (n <= 1) return a_leaf(r, st);
  Spec s;
  if (r.chance(n <= 6 ? 50 : 25)) s = a_motif(r, st, std::min(n, 30));
  else if (depth <= 1) {
    std::vector<Spec> k;
    for (int i = 0; i < n; i++) k.push_back(a_leaf(r, st));
    s = gate(r.chance(70) ? Node::Union : an_op(r), k);
  } else if (n > 3 && r.chance(12)) { // a chain
    s = a_solid(r, st, n - 1, depth - 1);
    s = gate(an_op(r), r.chance(70) ? std::vector<Spec>{s, a_leaf(r, st)} : std::vector<Spec>{a_leaf(r, st), s});
  } else if (r.chance(15)) { // the same again, moved or turned or not
    Spec k = a_solid(r, st, n / 2, depth - 1), again = k;
    if (r.chance(80)) again = r.chance(60) ? moved(along_axis(r.below(3), a_size(r, st) + a_gap(r, st)), k) : around(a_turn(r), k);
    s = gate(an_op(r), r.chance(50) ? std::vector<Spec>{k, again} : std::vector<Spec>{again, k});
  } else {
    std::vector<Spec> k;
    int parts = r.range(2, std::min(4, n));
    for (int i = 0; i < parts; i++) k.push_back(a_solid(r, st, std::max(1, n / parts), depth - 1));
    s = gate(r.chance(45) ? Node::Union : r.chance(65) ? Node::Difference : Node::Intersection, k);
  }
  if (r.chance(25)) s = around(a_step(r, st), s);
  return s;
}

// What the whole stands in: sizes 1e-9 to 1e9, places to 1e12, aspect to 1e9. frame: its name.
inline Spec in_frame(Random &r, const Style &st, Spec s, std::string &frame) {
  auto scale = [&](const V &v) {
    Step f;
    f.kind = Step::Scale, f.v = v;
    s = around(f, s);
    for (size_t i = 0, n = st.gaps ? st.gaps->size() : 0; i < n; i++) { // along one of the axes
      double gap = (*st.gaps)[i];
      (*st.gaps)[i] = gap * CGAL::to_double(v[r.below(3)]);
    }
  };
  auto power = [&](int ten) { return st.dyadic ? pow2(ten * 10 / 3) : pow10(ten); };
  auto decades = [](int ten) { return ten < -6 ? "1e-9 to 1e-7" : ten < -3 ? "1e-6 to 1e-4" : ten < 0 ? "1e-3 to 1e-1" : ten < 4 ? "1 to 1e3" : ten < 7 ? "1e4 to 1e6" : ten < 10 ? "1e7 to 1e9" : "1e10 to 1e12"; };
  int ten;
  switch (r.below(13)) {
  case 0: { ten = r.range(-9, 9); Q f = power(ten); scale({f, f, f}); st.note("size", decades(ten)), frame = "scaled"; break; }
  case 1: { ten = r.range(1, 9); V v{1, 1, 1}; v[r.below(3)] = power(-ten); scale(v); st.note("aspect", decades(ten)), frame = "flat"; break; }
  case 2: { ten = r.range(1, 9); V v{1, 1, 1}; v[r.below(3)] = power(ten); scale(v); st.note("aspect", decades(ten)), frame = "long"; break; }
  case 3: { V v{Q(r.range(-1, 1)), Q(r.range(-1, 1)), Q(r.range(-1, 1))}; ten = r.range(2, 12); s = moved(power(ten) * v, s); st.note("distance", decades(ten)), frame = "far"; break; }
  case 4: {
    ten = r.range(-9, 3);
    Q f = power(ten);
    scale({f, f, f});
    st.note("size", decades(ten)), ten = r.range(0, 9);
    s = moved(along_axis(r.below(3), power(ten)), s), st.note("distance", decades(ten)), frame = "scaled and far";
    break;
  }
  case 5: s = around(a_turn(r), s), frame = "turned"; break;
  case 6: s = around(a_step(r, st), around(a_turn(r), s)), frame = "turned and mapped"; break;
  case 7: { // all at once
    ten = r.range(-9, 9);
    Q f = power(ten);
    int thin = r.range(-9, 9);
    V v{f, f, f};
    v[r.below(3)] = f * power(thin);
    scale(v);
    st.note("size", decades(ten)), st.note("aspect", decades(std::abs(thin)));
    s = around(a_turn(r), s), ten = r.range(0, 12);
    s = moved(along_axis(r.below(3), power(ten)), s), st.note("distance", decades(ten)), frame = "scaled, stretched, turned and far";
    break;
  }
  default: frame = "none"; break;
  }
  st.note("frame", frame);
  return s;
}
inline void note_shapes(const Style &st, const Spec &s) {
  static const char *const names[] = {"sphere", "cube", "cylinder", "frustum or cone", "ellipsoid", "paraboloid", "one sheet", "two sheets", "saddle", "halfspace", "wedge", "quadric", "elliptic cylinder", "prism", "polyhedron"};
  static const char *const steps[] = {"translate", "scale", "quarter turns", "matrix"};
  static const char *const ops[] = {"union", "difference", "intersection"};
  for (auto &k : s.steps) st.note("map", steps[k.kind]);
  if (s.op == Node::IsLeaf) st.note("shape", names[s.shape.kind]);
  else st.note("tree", ops[s.op]);
  for (auto &k : s.kids) note_shapes(st, k);
}
// As deep as depth: each gate holds the one below and a leaf.
inline Spec a_chain(Random &r, const Style &st, int depth) {
  Spec s = a_leaf(r, st);
  for (int i = 1; i < depth; i++) {
    std::vector<Spec> k{s, r.chance(30) ? moved(along_axis(r.below(3), a_gap(r, st)), a_leaf(r, st)) : a_leaf(r, st)};
    if (r.chance(30)) std::swap(k[0], k[1]);
    if (r.chance(20)) k.push_back(a_leaf(r, st));
    s = gate(an_op(r), k);
    if (r.chance(25)) s = around(a_step(r, st), s);
  }
  return s;
}
inline Spec a_model(Random &r, const Style &st, int most, std::string &frame) {
  int pick = r.below(100);
  int n = pick < 55 ? r.range(1, 5) : pick < 80 ? r.range(6, 16) : pick < 94 ? r.range(17, 50) : r.range(51, 200);
  Spec s = st.motif >= 0 ? a_motif(r, st, std::min(n, most)) : r.chance(8) && most > 8 ? a_chain(r, st, r.range(6, std::min(12, most / 2 + 1))) : a_solid(r, st, std::min(n, most), r.range(2, 12));
  s = in_frame(r, st, s, frame);
  if (st.census) {
    note_shapes(st, s);
    st.note("numbers", st.dyadic ? "dyadic" : "decimal");
    st.census->count_size("leaves", (long)leaves_of(s), {1, 5, 16, 50, 200});
    st.census->count_size("depth", depth_of(s) + 1, {1, 2, 4, 6, 8, 12});
  }
  return s;
}
} // namespace stress
