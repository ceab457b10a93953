// A model as it is written: a tree of Booleans, transforms and primitives with their numbers. From it come the text that quoin
// reads and, independently, the oracle's half-spaces in world coordinates. It can be taken apart, which shrinking needs.
#pragma once
#include "../oracle/solid.hpp"

#include <cmath>

namespace stress {
using namespace oracle;

// A primitive. p: its numbers, as each kind takes them below.
struct Shape {
  enum Kind { Sphere, Cube, Cylinder, Frustum, Ellipsoid, Paraboloid, OneSheet, TwoSheets, Saddle, HalfSpace, Wedge, General, Elliptic, Prism, Tetra, Kinds };
  Kind kind = Sphere;
  std::vector<Q> p;
  bool center = false; // Cube, Cylinder, Frustum, Wedge
  bool placed = false; // base and axis are given; axis = stretch * unit
  V base{0, 0, 0}, unit{0, 0, 1};
  Q stretch = 1;
};

// One transform around a subtree.
struct Step {
  enum Kind { Translate, Scale, Quarters, Matrix } kind = Translate;
  V v{0, 0, 0}; // Quarters: quarter turns about x, then y, then z
  Map map;      // Matrix
};

struct Spec {
  Node::Op op = Node::IsLeaf;
  Shape shape;
  std::vector<Step> steps; // the outermost first
  std::vector<Spec> kids;
  std::vector<Spot> contacts; // of a gate: where its parts touch
};

inline Map map_of(const Step &s) {
  Map m;
  if (s.kind == Step::Translate) m.t = s.v;
  else if (s.kind == Step::Scale)
    for (int i = 0; i < 3; i++) m.m[i][i] = s.v[i];
  else if (s.kind == Step::Matrix) m = s.map;
  else
    for (int i = 0; i < 3; i++)
      for (int k = (int)CGAL::to_double(s.v[i]); k > 0; k--) {
        Map q;
        int a = (i + 1) % 3, b = (i + 2) % 3;
        q.m[a][a] = q.m[b][b] = 0, q.m[a][b] = -1, q.m[b][a] = 1;
        m = compose(q, m);
      }
  return m;
}
inline std::string text_of(const Step &s) {
  std::ostringstream w;
  switch (s.kind) {
  case Step::Translate: w << "translate(" << text(s.v) << ") "; break;
  case Step::Scale: w << "scale(" << text(s.v) << ") "; break;
  case Step::Quarters: w << "rotate(" << text(Q(90) * s.v) << ") "; break;
  default:
    w << "multmatrix([";
    for (int k = 0; k < 3; k++) w << "[" << decimal(s.map.m[k][0]) << "," << decimal(s.map.m[k][1]) << "," << decimal(s.map.m[k][2]) << "," << decimal(s.map.t[k]) << "],";
    w << "[0,0,0,1]]) ";
  }
  return w.str();
}
inline std::string text_of(const Shape &s) {
  static const char *const words[] = {"sphere(r=", "cube([", "cylinder(h=", "cylinder(h=", "ellipsoid(r=[", "paraboloid(h=", "hyperboloid(h=", "hyperboloid(h=", "saddle(a=", "halfspace(n=[",
                                      "wedge(size=[", "quadric([", "cylinder(h=", "cylinder(h=", ""};
  static const char *const between[][4] = {{""}, {",", ",", "]"}, {",r="}, {",r1=", ",r2="}, {",", ",", "]"}, {",r="}, {",r=", ",rc="}, {",r=", ",gap="}, {",b="}, {",", ",", "],d="},
                                           {",", ",", "]"}, {""}, {",r=[", ",", "]"}, {",r="}, {""}};
  std::ostringstream w;
  auto D = [](const Q &q) { return decimal(q); };
  if (s.kind == Shape::Tetra) {
    w << "polyhedron(points=[[0,0,0],[" << D(s.p[0]) << ",0,0],[0," << D(s.p[1]) << ",0],[0,0," << D(s.p[2]) << "]],faces=[[0,1,2],[0,2,3],[0,3,1],[1,3,2]]";
  } else {
    w << words[s.kind];
    for (size_t i = 0; i < s.p.size(); i++) {
      w << D(s.p[i]);
      if (s.kind == Shape::General) w << (i < 9 ? "," : "]");
      else if (i < 4 && between[s.kind][i] && (i + 1 < s.p.size() || between[s.kind][i][0] == ']')) w << between[s.kind][i];
    }
  }
  if (s.kind == Shape::Prism) w << ",$fn=4";
  if (s.center) w << ",center=true";
  if (s.placed) w << ",base=" << text(s.base) << ",axis=" << text(s.stretch * s.unit);
  w << ")";
  return w.str();
}
inline std::string text_of(const Spec &s) {
  static const char *const words[] = {"union", "difference", "intersection"};
  std::string t;
  for (auto &k : s.steps) t += text_of(k);
  if (s.op == Node::IsLeaf) return t + text_of(s.shape) + ";\n";
  t += std::string(words[s.op]) + "() {\n";
  for (auto &k : s.kids) t += text_of(k);
  return t + "}\n";
}
inline size_t leaves_of(const Spec &s) {
  size_t n = s.op == Node::IsLeaf;
  for (auto &k : s.kids) n += leaves_of(k);
  return n;
}
inline int depth_of(const Spec &s) {
  int d = 0;
  for (auto &k : s.kids) d = std::max(d, 1 + depth_of(k));
  return d;
}

// --- the oracle's side ------------------------------------------------------------------------------------------------

struct Ball { double centre[3], radius; }; // holds the leaf; the radius may be infinite

// The primitive about the origin; reach: it lies within this of the origin (infinite where unbounded).
inline Leaf leaf_of(const Shape &s, Random &r, double &reach) {
  Leaf l;
  const auto &p = s.p;
  const Q two(2);
  auto size = [](const V &v) { return std::sqrt(CGAL::to_double(dot(v, v))) * (1 + 0x1p-20); };
  auto spot = [&](Spot::Kind k, const V &at, const V &n, const V &along) { l.spots.push_back({k, at, n, along}); };
  auto smooth = [&](const V &at, const Quadric &b, const V &along = V{0, 0, 0}) { spot(zero(along) ? Spot::Smooth : Spot::Generator, at, b.gradient(at), along); };
  auto rim = [&](const Q &z, const Q &a, const Q &b, const Quadric &body) {
    for (int i = 0; i < 2; i++) {
      auto c = circle(r);
      V at{a * c[0], b * c[1], z};
      spot(Spot::Rim, at, body.gradient(at), V{-a * c[1], b * c[0], 0});
    }
    spot(Spot::Face, V{a / 2, 0, z}, V{0, 0, 1}, V{Q(r.range(-3, 3)), Q(r.range(1, 3)), 0});
    spot(Spot::Face, V{0, 0, z}, V{0, 0, 1}, V{1, 0, 0});
  };
  auto caps = [&](const Q &lo, const Q &hi) { l.halves.push_back(plane({0, 0, -1}, -lo)), l.halves.push_back(plane({0, 0, 1}, hi)); };
  reach = INFINITY;
  switch (s.kind) {
  case Shape::Sphere:
    l.halves = {diagonal(1, 1, 1, -p[0] * p[0])};
    for (int i = 0; i < 3; i++) smooth(p[0] * on_sphere(r), l.halves[0]);
    smooth({p[0], 0, 0}, l.halves[0]), smooth({0, 0, -p[0]}, l.halves[0]);
    reach = size({p[0], 0, 0});
    break;
  case Shape::Cube: case Shape::Wedge: {
    V full{p[0], p[1], p[2]}, lo = s.center ? Q(-1) / two * full : V{0, 0, 0}, hi = lo + full;
    bool wedge = s.kind == Shape::Wedge;
    for (int i = 0; i < 3; i++) {
      V n{0, 0, 0};
      n[i] = 1;
      if (!wedge || i == 1) l.halves.push_back(plane(n, hi[i]));
      l.halves.push_back(plane(Q(-1) * n, -lo[i]));
      spot(Spot::Corner, lo, V{0, 0, 0}, n);
      V m = lo;
      m[i] += full[i] / 2;
      V other{0, 0, 0};
      other[(i + 1) % 3] = 1;
      spot(Spot::Edge, m, other, n);
      V f = lo + Q(1) / Q(4) * full, a{Q(r.range(-2, 2)), Q(r.range(-2, 2)), Q(r.range(-2, 2))};
      f[i] = lo[i], a[i] = 0;
      if (!zero(a)) spot(Spot::Face, f, n, a);
      if (!wedge) spot(Spot::Corner, hi, V{0, 0, 0}, n);
    }
    if (wedge) { // x/sx + z/sz <= 1 from the corner
      V n{full[2], 0, full[0]};
      l.halves.push_back(plane(n, full[0] * full[2] + dot(n, lo)));
      spot(Spot::Edge, lo + V{full[0], full[1] / 2, 0}, V{0, 0, 1}, V{0, 1, 0});
      spot(Spot::Face, lo + V{full[0] / 2, full[1] / 2, full[2] / 2}, n, V{full[0], 0, -full[2]});
      spot(Spot::Corner, lo + V{0, full[1], full[2]}, V{0, 0, 0}, V{full[0], 0, -full[2]});
    }
    reach = size(full);
    break;
  }
  case Shape::Cylinder: case Shape::Elliptic: case Shape::Prism: {
    Q a = p[1], b = s.kind == Shape::Elliptic ? p[2] : p[1], lo = s.center ? -p[0] / two : Q(0), hi = lo + p[0];
    if (s.kind == Shape::Prism) {
      for (int i = 0; i < 4; i++) l.halves.push_back(plane({Q(i & 1 ? -1 : 1), Q(i & 2 ? -1 : 1), 0}, a));
      spot(Spot::Edge, V{a, 0, (lo + hi) / 2}, V{1, 0, 0}, V{0, 0, 1});
      spot(Spot::Corner, V{0, a, hi}, V{0, 0, 0}, V{1, -1, 0});
      spot(Spot::Face, V{a / 2, a / 2, (lo + hi) / 2}, V{1, 1, 0}, V{1, -1, Q(r.range(-1, 1))});
    } else {
      Quadric q = diagonal(1 / (a * a), 1 / (b * b), 0, -1);
      l.halves.push_back(q);
      rim(lo, a, b, q), rim(hi, a, b, q);
      for (int i = 0; i < 2; i++) {
        auto c = circle(r);
        smooth({a * c[0], b * c[1], (lo + hi) / 2}, q, {0, 0, 1});
        smooth({a * c[0], b * c[1], lo + p[0] / 4}, q);
      }
      smooth({a, 0, (lo + hi) / 2}, q, {0, 0, 1});
    }
    caps(lo, hi);
    reach = size({a, b, p[0]});
    break;
  }
  case Shape::Frustum: {
    Q lo = s.center ? -p[0] / two : Q(0), hi = lo + p[0], m = (p[2] - p[1]) / p[0], w = p[1] - m * lo; // radius w + m z
    Quadric q = diagonal(1, 1, -m * m, -w * w);
    q.a[2][3] = q.a[3][2] = -w * m;
    l.halves = {q};
    caps(lo, hi);
    if (p[1] != 0) rim(lo, p[1], p[1], q);
    if (p[2] != 0) rim(hi, p[2], p[2], q);
    if (p[1] == 0) spot(Spot::Apex, V{0, 0, lo}, V{0, 0, 0}, V{p[2], 0, p[0]});
    if (p[2] == 0) spot(Spot::Apex, V{0, 0, hi}, V{0, 0, 0}, V{-p[1], 0, p[0]});
    for (int i = 0; i < 2; i++) {
      auto c = circle(r);
      Q mid = (p[1] + p[2]) / 2;
      V at{mid * c[0], mid * c[1], (lo + hi) / 2};
      smooth(at, q, {(p[2] - p[1]) * c[0], (p[2] - p[1]) * c[1], p[0]});
      smooth(at, q);
    }
    reach = size({p[1], p[2], p[0]});
    break;
  }
  case Shape::Ellipsoid: {
    l.halves = {diagonal(1 / (p[0] * p[0]), 1 / (p[1] * p[1]), 1 / (p[2] * p[2]), -1)};
    for (int i = 0; i < 4; i++) {
      V u = i ? on_sphere(r) : V{0, 0, 1};
      smooth({p[0] * u[0], p[1] * u[1], p[2] * u[2]}, l.halves[0]);
    }
    reach = size({p[0], p[1], p[2]});
    break;
  }
  case Shape::Paraboloid: {
    Quadric q = diagonal(1, 1, 0, 0);
    q.a[2][3] = q.a[3][2] = -p[1] * p[1] / p[0] / 2;
    l.halves = {q, plane({0, 0, 1}, p[0])};
    rim(p[0], p[1], p[1], q);
    smooth({0, 0, 0}, q);
    auto c = circle(r);
    V at{p[1] / 2 * c[0], p[1] / 2 * c[1], p[0] / 4};
    smooth(at, q);
    spot(Spot::Smooth, at, V{0, 0, 0}, V{0, 0, 1}); // parallel to the axis: the degree drops
    reach = size({p[1], 0, p[0]});
    break;
  }
  case Shape::OneSheet: {
    Q k = (p[1] * p[1] - p[2] * p[2]) / (p[0] * p[0]);
    Quadric q = diagonal(1, 1, -k, -p[2] * p[2]);
    l.halves = {q};
    caps(-p[0], p[0]);
    rim(p[0], p[1], p[1], q), rim(-p[0], p[1], p[1], q);
    auto c = circle(r);
    smooth({p[2] * c[0], p[2] * c[1], 0}, q);
    static const int t[][3] = {{5, 3, 4}, {5, 4, 3}, {13, 5, 12}, {25, 7, 24}, {10, 6, 8}};
    for (auto &e : t)
      if (p[1] * e[1] == p[2] * e[0]) { // rulings and asymptotes with rational directions
        Q w = p[1] * e[2] / e[0];
        smooth({p[2] * c[0], p[2] * c[1], 0}, q, {-c[1] * w, c[0] * w, p[0]});
        spot(Spot::Generator, {p[2] / 2, 0, 0}, V{0, 0, 0}, V{w * c[0], w * c[1], p[0]});
        break;
      }
    reach = size({p[1], 0, p[0]});
    break;
  }
  case Shape::TwoSheets: {
    Q k = p[1] * p[1] / (p[0] * p[0] - p[2] * p[2]);
    Quadric q = diagonal(1, 1, -k, k * p[2] * p[2]);
    l.halves = {q};
    caps(-p[0], p[0]);
    rim(p[0], p[1], p[1], q), rim(-p[0], p[1], p[1], q);
    smooth({0, 0, p[2]}, q), smooth({0, 0, -p[2]}, q);
    reach = size({p[1], 0, p[0]});
    break;
  }
  case Shape::Saddle: {
    Quadric q = diagonal(-1 / (p[0] * p[0]), 1 / (p[1] * p[1]), 0, 0);
    q.a[2][3] = q.a[3][2] = Q(1) / two;
    l.halves = {q};
    smooth({0, 0, 0}, q, {p[0], p[1], 0}), smooth({0, 0, 0}, q);
    V at{p[0] * 2, p[1], 3};
    smooth(at, q), smooth(at, q, {p[0], p[1], 2});
    break;
  }
  case Shape::HalfSpace: {
    V n{p[0], p[1], p[2]};
    l.halves = {plane(n, p[3])};
    for (int i = 0; i < 3; i++)
      if (n[i] == 1 || n[i] == -1 || n[i] == 2 || n[i] == -2) {
        V at{0, 0, 0};
        at[i] = p[3] / n[i];
        V along = cross(n, V{Q(r.range(1, 3)), Q(r.range(-3, -1)), Q(r.range(1, 4))});
        spot(Spot::Face, at, n, along);
        break;
      }
    break;
  }
  case Shape::Tetra: {
    V n{p[1] * p[2], p[0] * p[2], p[0] * p[1]};
    l.halves = {plane({-1, 0, 0}, 0), plane({0, -1, 0}, 0), plane({0, 0, -1}, 0), plane(n, p[0] * p[1] * p[2])};
    spot(Spot::Corner, V{0, 0, 0}, V{0, 0, 0}, V{1, 0, 0});
    spot(Spot::Corner, V{p[0], 0, 0}, V{0, 0, 0}, V{-p[0], p[1], 0});
    spot(Spot::Edge, V{p[0] / 2, p[1] / 2, 0}, V{0, 0, 1}, V{-p[0], p[1], 0});
    spot(Spot::Face, V{p[0] / 4, p[1] / 4, p[2] / 2}, n, V{-p[0], p[1], 0});
    reach = size({p[0], p[1], p[2]});
    break;
  }
  default: { // General
    Quadric q;
    auto set = [&](int i, int j, const Q &v) { q.a[i][j] = q.a[j][i] = i == j ? v : v / 2; };
    set(0, 0, p[0]), set(1, 1, p[1]), set(2, 2, p[2]), set(0, 1, p[3]), set(0, 2, p[4]), set(1, 2, p[5]);
    set(0, 3, p[6]), set(1, 3, p[7]), set(2, 3, p[8]), set(3, 3, p[9]);
    l.halves = {q};
    bool cone = true, unit = p[0] == 1 && p[1] == 1 && p[2] == -1; // x2 + y2 - z2: with its generators, through the apex
    for (int i = 3; i < 10; i++) cone = cone && p[(size_t)i] == 0;
    if (cone && unit) {
      static const int g[][3] = {{1, 0, 1}, {0, 1, 1}, {3, 4, 5}, {-4, 3, 5}, {5, 12, 13}};
      for (auto &e : g) {
        V along{Q(e[0]), Q(e[1]), Q(e[2])};
        spot(Spot::Generator, along, q.gradient(along), along);
        spot(Spot::Apex, {0, 0, 0}, V{0, 0, 0}, along);
      }
    } else if (p[9] == 0) smooth({0, 0, 0}, q);
    else spot(Spot::Smooth, {0, 0, 0}, V{0, 0, 1}, V{1, 0, 0});
  }
  }
  return l;
}

// Base and axis: any map that takes z to the unit vector will do for a round solid; the mirror between the two does.
inline Map placement(const Shape &s) {
  Map m;
  bool paraboloid = s.kind == Shape::Paraboloid; // its base is the cap's centre and its axis points to the vertex
  V u = paraboloid ? Q(-1) * s.unit : s.unit, v = V{0, 0, 1} - u;
  if (!zero(v)) {
    Q f = Q(2) / dot(v, v);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) m.m[i][j] = Q(i == j) - f * v[i] * v[j];
  }
  m.t = s.base;
  if (paraboloid) m.t = m.t + s.p[0] * s.unit;
  return m;
}

// The oracle's tree; balls: one for each leaf, in order; contacts: where parts touch, is added to. r draws the spots.
inline Node node_of(const Spec &s, const Map &around, Random &r, std::vector<Ball> &balls, std::vector<Spot> *contacts = nullptr) {
  Map m = around;
  for (auto &k : s.steps) m = compose(m, map_of(k));
  Node n;
  n.op = s.op;
  if (s.op != Node::IsLeaf) {
    for (auto &k : s.kids) n.kids.push_back(node_of(k, m, r, balls, contacts));
    if (contacts && !s.contacts.empty()) {
      Leaf places;
      places.spots = s.contacts;
      for (auto &p : place(places, m, "").leaf.spots) contacts->push_back(p);
    }
    return n;
  }
  double reach;
  Leaf local = leaf_of(s.shape, r, reach);
  if (s.shape.placed) m = compose(m, placement(s.shape));
  n = place(local, m, "");
  double f = 0;
  for (auto &row : m.m)
    for (auto &e : row) f += CGAL::to_double(e) * CGAL::to_double(e);
  Ball b;
  for (int i = 0; i < 3; i++) b.centre[i] = CGAL::to_double(m.t[i]);
  b.radius = reach * std::sqrt(f);
  balls.push_back(b);
  return n;
}
} // namespace stress
