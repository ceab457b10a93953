// The oracle's solid: a tree of Booleans over leaves, a leaf a meet of quadric half-spaces; its text for quoin, and its
// places of interest, where a ray is hard.
#pragma once
#include "exact.hpp"

#include <memory>
#include <sstream>

namespace oracle {
// A place of interest of a leaf: a point on its surface and a direction in which a line is special there.
struct Spot {
  enum Kind { Smooth, Rim, Apex, Edge, Corner, Face, Generator } kind;
  V point;
  V normal; // of the body or face at the point; zero at an apex
  V along;  // a line through the point that runs in the surface; zero when there is none
};
struct Leaf {
  std::string word; // quoin's text without transforms
  std::vector<Quadric> halves;
  std::vector<Spot> spots;
};
struct Node {
  enum Op { Union, Difference, Intersection, IsLeaf } op = IsLeaf;
  std::vector<Node> kids;
  Leaf leaf;      // in world coordinates
  std::string text; // the whole subtree as quoin reads it
};

// Rational points of the unit circle and sphere with decimal coordinates.
inline std::array<Q, 2> circle(Random &r) {
  static const int t[][3] = {{1, 0, 1}, {0, 1, 1}, {3, 4, 5}, {4, 3, 5}, {7, 24, 25}, {24, 7, 25}, {44, 117, 125}, {117, 44, 125}, {336, 527, 625}};
  auto &p = t[r.below(9)];
  Q c = Q(p[0]) / Q(p[2]), s = Q(p[1]) / Q(p[2]);
  if (r.chance(50)) c = -c;
  if (r.chance(50)) s = -s;
  return {c, s};
}
inline V on_sphere(Random &r) {
  auto a = circle(r), b = circle(r);
  return {a[0] * b[0], a[0] * b[1], a[1]};
}

inline Leaf make_leaf(Random &r, int kind = -1) {
  if (kind < 0) kind = r.below(12);
  Leaf l;
  std::ostringstream w;
  auto D = [](const Q &q) { return decimal(q); };
  auto rims = [&](const Q &h, const Q &rad, const Quadric &body) {
    for (int i = 0; i < 3; i++) {
      auto c = circle(r);
      V p{rad * c[0], rad * c[1], h};
      l.spots.push_back({Spot::Rim, p, body.gradient(p), V{-c[1], c[0], 0}});
    }
    l.spots.push_back({Spot::Face, V{rad / 2, 0, h}, V{0, 0, 1}, V{Q(r.range(-3, 3)), Q(r.range(1, 3)), 0}});
  };
  auto smooth = [&](const V &p, const Quadric &body, V along = V{0, 0, 0}) {
    l.spots.push_back({zero(along) ? Spot::Smooth : Spot::Generator, p, body.gradient(p), along});
  };
  switch (kind) {
  case 0: { // sphere
    Q rad = tenth(r, 1, 50);
    w << "sphere(r=" << D(rad) << ")";
    l.halves = {diagonal(1, 1, 1, -rad * rad)};
    for (int i = 0; i < 4; i++) smooth(rad * on_sphere(r), l.halves[0]);
    break;
  }
  case 1: { // cube
    V s{tenth(r, 1, 40), tenth(r, 1, 40), tenth(r, 1, 40)};
    bool c = r.chance(40);
    w << "cube(" << text(s) << ",center=" << (c ? "true" : "false") << ")";
    V lo = c ? Q(-1) / Q(2) * s : V{0, 0, 0}, hi = lo + s;
    for (int i = 0; i < 3; i++) {
      V n{0, 0, 0};
      n[i] = 1;
      l.halves.push_back(plane(n, hi[i]));
      l.halves.push_back(plane(Q(-1) * n, -lo[i]));
      V p = lo, q = hi, e{0, 0, 0};
      e[i] = 1;
      l.spots.push_back({Spot::Corner, p, V{0, 0, 0}, e});
      l.spots.push_back({Spot::Corner, q, V{0, 0, 0}, e});
      V m = r.chance(50) ? lo : hi;
      m[i] = (lo[i] + hi[i]) / 2;
      V en{0, 0, 0};
      en[(i + 1) % 3] = 1;
      l.spots.push_back({Spot::Edge, m, en, e});
      V f = Q(1) / Q(2) * (lo + hi);
      f[i] = r.chance(50) ? lo[i] : hi[i];
      V a{Q(r.range(-2, 2)), Q(r.range(-2, 2)), Q(r.range(-2, 2))};
      a[i] = 0;
      if (zero(a)) a[(i + 1) % 3] = 1;
      l.spots.push_back({Spot::Face, f, n, a});
    }
    break;
  }
  case 2: { // cylinder
    Q h = tenth(r, 1, 40), rad = tenth(r, 1, 30);
    w << "cylinder(h=" << D(h) << ",r=" << D(rad) << ")";
    Quadric b = diagonal(1, 1, 0, -rad * rad);
    l.halves = {b, plane({0, 0, -1}, 0), plane({0, 0, 1}, h)};
    rims(0, rad, b), rims(h, rad, b);
    for (int i = 0; i < 2; i++) {
      auto c = circle(r);
      smooth({rad * c[0], rad * c[1], h / 2}, b, {0, 0, 1});
      smooth({rad * c[0], rad * c[1], h / 4}, b);
    }
    break;
  }
  case 3: { // cone and frustum
    Q h = tenth(r, 1, 40), r1 = tenth(r, 0, 30), r2 = tenth(r, 0, 30);
    if (r1 == r2) r2 = r1 + 1;
    if (r.chance(40)) (r.chance(50) ? r1 : r2) = 0;
    w << "cylinder(h=" << D(h) << ",r1=" << D(r1) << ",r2=" << D(r2) << ")";
    Q m = (r2 - r1) / h;
    Quadric b;
    b.a[0][0] = b.a[1][1] = 1, b.a[2][2] = -m * m, b.a[2][3] = b.a[3][2] = -r1 * m, b.a[3][3] = -r1 * r1;
    l.halves = {b, plane({0, 0, -1}, 0), plane({0, 0, 1}, h)};
    if (r1 != 0) rims(0, r1, b);
    if (r2 != 0) rims(h, r2, b);
    if (r1 == 0) l.spots.push_back({Spot::Apex, V{0, 0, 0}, V{0, 0, 0}, V{r2, 0, h}});
    if (r2 == 0) l.spots.push_back({Spot::Apex, V{0, 0, h}, V{0, 0, 0}, V{-r1, 0, h}});
    for (int i = 0; i < 2; i++) {
      auto c = circle(r);
      Q mid = (r1 + r2) / 2;
      smooth({mid * c[0], mid * c[1], h / 2}, b, {(r2 - r1) * c[0], (r2 - r1) * c[1], h});
      smooth({mid * c[0], mid * c[1], h / 2}, b);
    }
    break;
  }
  case 4: { // ellipsoid
    V s{tenth(r, 1, 30), tenth(r, 1, 30), tenth(r, 1, 30)};
    if (r.chance(25)) s[2] = pow10(-r.range(3, 6));
    w << "ellipsoid(r=" << text(s) << ")";
    l.halves = {diagonal(1 / (s[0] * s[0]), 1 / (s[1] * s[1]), 1 / (s[2] * s[2]), -1)};
    for (int i = 0; i < 4; i++) {
      V u = on_sphere(r);
      smooth({s[0] * u[0], s[1] * u[1], s[2] * u[2]}, l.halves[0]);
    }
    break;
  }
  case 5: { // paraboloid
    Q h = tenth(r, 1, 40), rad = tenth(r, 1, 30);
    w << "paraboloid(h=" << D(h) << ",r=" << D(rad) << ")";
    Quadric b = diagonal(1, 1, 0, 0);
    b.a[2][3] = b.a[3][2] = -rad * rad / h / 2;
    l.halves = {b, plane({0, 0, 1}, h)};
    rims(h, rad, b);
    smooth({0, 0, 0}, b);
    auto c = circle(r);
    smooth({rad / 2 * c[0], rad / 2 * c[1], h / 4}, b);
    l.spots.push_back({Spot::Smooth, {rad / 2 * c[0], rad / 2 * c[1], h / 4}, V{0, 0, 0}, V{0, 0, 1}}); // parallel to the axis: degree drops
    break;
  }
  case 6: { // hyperboloid of one sheet; r^2 - rc^2 a square so that rulings and asymptotes are decimal
    static const int t[][3] = {{5, 3, 4}, {5, 4, 3}, {13, 5, 12}, {25, 7, 24}, {10, 6, 8}};
    auto &p = t[r.below(5)];
    Q rad = Q(p[0]) / 5, rc = Q(p[1]) / 5, s = Q(p[2]) / 5, h = tenth(r, 1, 30);
    w << "hyperboloid(h=" << D(h) << ",r=" << D(rad) << ",rc=" << D(rc) << ")";
    Q k = s * s / (h * h);
    Quadric b = diagonal(1, 1, -k, -rc * rc);
    l.halves = {b, plane({0, 0, -1}, h), plane({0, 0, 1}, h)};
    rims(h, rad, b), rims(-h, rad, b);
    auto c = circle(r);
    smooth({rc * c[0], rc * c[1], 0}, b, {-c[1] * s, c[0] * s, h}); // a ruling
    smooth({rc * c[0], rc * c[1], 0}, b);
    l.spots.push_back({Spot::Generator, {rc / 2, 0, 0}, V{0, 0, 0}, V{s * c[0], s * c[1], h}}); // an asymptote's direction
    break;
  }
  case 7: { // two sheets: x^2+y^2 = r^2 (z^2-g^2)/(h^2-g^2)
    Q g = tenth(r, 1, 20), h = g + tenth(r, 1, 30), rad = tenth(r, 1, 30);
    w << "hyperboloid(h=" << D(h) << ",r=" << D(rad) << ",gap=" << D(g) << ")";
    Q k = rad * rad / (h * h - g * g);
    Quadric b = diagonal(1, 1, -k, k * g * g);
    l.halves = {b, plane({0, 0, -1}, h), plane({0, 0, 1}, h)};
    rims(h, rad, b), rims(-h, rad, b);
    smooth({0, 0, g}, b), smooth({0, 0, -g}, b);
    break;
  }
  case 8: { // saddle: z <= x^2/a^2 - y^2/b^2, i.e. z - x^2/a^2 + y^2/b^2 <= 0
    static const int t[] = {1, 2, 4, 5, 8, 10, 16, 20, 25};
    Q a = Q(t[r.below(9)]) / 5, c = Q(t[r.below(9)]) / 5;
    w << "saddle(a=" << D(a) << ",b=" << D(c) << ")";
    Quadric b = diagonal(-1 / (a * a), 1 / (c * c), 0, 0);
    b.a[2][3] = b.a[3][2] = Q(1) / Q(2);
    l.halves = {b};
    smooth({0, 0, 0}, b, {a, c, 0});
    smooth({0, 0, 0}, b);
    V p{a * 2, c, 3};
    smooth(p, b), smooth(p, b, {a, c, 2}); // a ruling: (2+t)^2 - (1+t)^2 = 3 + 2t
    break;
  }
  case 9: { // half-space
    V n{Q(r.range(-3, 3)), Q(r.range(-3, 3)), Q(r.range(-3, 3))};
    if (zero(n)) n[2] = 1;
    Q d = tenth(r, -30, 30);
    w << "halfspace(n=" << text(n) << ",d=" << D(d) << ")";
    l.halves = {plane(n, d)};
    V p{0, 0, 0};
    for (int i = 0; i < 3; i++)
      if (n[i] == 1 || n[i] == -1 || n[i] == 2 || n[i] == -2) {
        p[i] = d / n[i];
        l.spots.push_back({Spot::Face, p, n, cross(n, V{Q(r.range(1, 3)), Q(r.range(-3, -1)), Q(r.range(1, 4))})});
        break;
      }
    break;
  }
  case 10: { // wedge: the cube's half with x/sx + z/sz <= 1
    V s{tenth(r, 1, 40), tenth(r, 1, 40), tenth(r, 1, 40)};
    w << "wedge(size=" << text(s) << ")";
    l.halves = {plane({-1, 0, 0}, 0), plane({0, -1, 0}, 0), plane({0, 0, -1}, 0), plane({0, 1, 0}, s[1]), plane({s[2], 0, s[0]}, s[0] * s[2])};
    l.spots.push_back({Spot::Edge, V{s[0], s[1] / 2, 0}, V{0, 0, 1}, V{0, 1, 0}});
    l.spots.push_back({Spot::Face, V{s[0] / 2, s[1] / 2, s[2] / 2}, V{s[2], 0, s[0]}, V{s[0], 0, -s[2]}});
    l.spots.push_back({Spot::Corner, V{0, s[1], s[2]}, V{0, 0, 0}, V{s[0], 0, -s[2]}});
    break;
  }
  default: { // a general quadric with small coefficients
    Quadric b;
    int c[10];
    for (int &e : c) e = r.range(-2, 2);
    if (r.chance(50)) c[9] = 0; // through the origin
    w << "quadric([";
    for (int i = 0; i < 10; i++) w << (i ? "," : "") << c[i];
    w << "])";
    bool any = false;
    for (int i = 0; i < 9; i++) any |= c[i] != 0;
    if (!any) return make_leaf(r, 0);
    auto set = [&](int i, int j, int v) { b.a[i][j] = b.a[j][i] = i == j ? Q(v) : Q(v) / 2; };
    set(0, 0, c[0]), set(1, 1, c[1]), set(2, 2, c[2]), set(0, 1, c[3]), set(0, 2, c[4]), set(1, 2, c[5]);
    set(0, 3, c[6]), set(1, 3, c[7]), set(2, 3, c[8]), set(3, 3, c[9]);
    l.halves = {b};
    if (c[9] == 0) smooth({0, 0, 0}, b);
  }
  }
  l.word = w.str();
  return l;
}

// A random exact transform, its text, made of decimals.
inline Map make_map(Random &r, std::string &out) {
  Map m;
  std::ostringstream w;
  auto by = [&](const Map &n) { m = compose(m, n); };
  if (r.chance(80)) {
    Map n;
    n.t = r.chance(15) ? V{pow10(r.range(2, 6)), 0, tenth(r, -9, 9)} : V{tenth(r, -40, 40), tenth(r, -40, 40), tenth(r, -40, 40)};
    if (r.chance(40))
      for (auto &c : n.t) c = Q(r.range(-3, 3));
    w << "translate(" << text(n.t) << ") ";
    by(n);
  }
  switch (r.below(6)) {
  case 0: { // a Pythagorean turn
    auto c = circle(r);
    Map n;
    int i = r.below(3), j = (i + 1) % 3;
    n.m[i][i] = n.m[j][j] = c[0], n.m[i][j] = -c[1], n.m[j][i] = c[1];
    w << "multmatrix([";
    for (int k = 0; k < 3; k++) w << "[" << decimal(n.m[k][0]) << "," << decimal(n.m[k][1]) << "," << decimal(n.m[k][2]) << ",0],";
    w << "[0,0,0,1]]) ";
    by(n);
    break;
  }
  case 1: { // a quarter turn
    Map n;
    int i = r.below(3), a = (i + 1) % 3, b = (i + 2) % 3;
    n.m[a][a] = n.m[b][b] = 0, n.m[a][b] = -1, n.m[b][a] = 1;
    V angle{0, 0, 0};
    angle[i] = 90;
    w << "rotate(" << text(angle) << ") ";
    by(n);
    break;
  }
  case 2: { // scale, perhaps thin, perhaps mirrored
    V s{tenth(r, 1, 30), tenth(r, 1, 30), tenth(r, 1, 30)};
    if (r.chance(20)) s[r.below(3)] = pow10(-r.range(2, 6));
    if (r.chance(20)) s[r.below(3)] *= -1;
    Map n;
    for (int i = 0; i < 3; i++) n.m[i][i] = s[i];
    w << "scale(" << text(s) << ") ";
    by(n);
    break;
  }
  case 3: { // shear
    Map n;
    int i = r.below(3), j = (i + 1 + r.below(2)) % 3;
    n.m[i][j] = tenth(r, -20, 20);
    w << "multmatrix([";
    for (int k = 0; k < 3; k++) w << "[" << decimal(n.m[k][0]) << "," << decimal(n.m[k][1]) << "," << decimal(n.m[k][2]) << ",0],";
    w << "[0,0,0,1]]) ";
    by(n);
    break;
  }
  default: break;
  }
  out = w.str();
  return m;
}

inline Node place(const Leaf &local, const Map &m, const std::string &prefix) {
  Node n;
  n.leaf = local;
  for (auto &h : n.leaf.halves) h = transformed(h, m);
  Map inv = inverse(m);
  for (auto &s : n.leaf.spots) {
    s.point = m(s.point);
    s.along = m.linear(s.along);
    s.normal = V{dot(V{inv.m[0][0], inv.m[1][0], inv.m[2][0]}, s.normal), dot(V{inv.m[0][1], inv.m[1][1], inv.m[2][1]}, s.normal),
                 dot(V{inv.m[0][2], inv.m[1][2], inv.m[2][2]}, s.normal)};
  }
  n.text = prefix + local.word + ";\n";
  return n;
}
inline void finish(Node &n) {
  static const char *const words[] = {"union", "difference", "intersection"};
  n.text = std::string(words[n.op]) + "() {\n";
  for (auto &k : n.kids) n.text += k.text;
  n.text += "}\n";
}
inline Node make_solid(Random &r, int depth) {
  if (depth == 0 || r.chance(20)) {
    std::string prefix;
    Map m = make_map(r, prefix);
    return place(make_leaf(r), m, prefix);
  }
  Node n;
  n.op = (Node::Op)r.below(3);
  int kids = r.range(2, 3);
  for (int i = 0; i < kids; i++) {
    if (i && r.chance(30)) { // the same leaf again, or shifted along an axis: shared surfaces and tangencies on purpose
      const Node &k = n.kids[r.below((int)n.kids.size())];
      if (k.op == Node::IsLeaf) {
        Map shift;
        int axis = r.below(3);
        shift.t[axis] = r.chance(30) ? Q(0) : Q(r.range(-2, 2));
        Node c = k;
        for (auto &h : c.leaf.halves) h = transformed(h, shift);
        for (auto &s : c.leaf.spots) s.point = shift(s.point);
        c.text = "translate(" + text(shift.t) + ") " + c.text;
        n.kids.push_back(c);
        continue;
      }
    }
    n.kids.push_back(make_solid(r, depth - 1));
  }
  finish(n);
  return n;
}
inline void collect(const Node &n, std::vector<const Leaf *> &out) {
  if (n.op == Node::IsLeaf) out.push_back(&n.leaf);
  for (auto &k : n.kids) collect(k, out);
}
} // namespace oracle
