// Planes and coplanar faces, judged by CGAL's exact predicates: the side of points on, next to and far from planes
// through three points; and whether two faces written differently are one surface.
#include "judge.hpp"

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>

using namespace oracle;
using K = CGAL::Exact_predicates_exact_constructions_kernel;

static K::FT ft(const Q &q) {
  std::ostringstream os;
  os << q.numerator() << "/" << q.denominator();
  return K::FT(K::FT::ET(os.str()));
}
static K::Point_3 point(const V &v) { return {ft(v[0]), ft(v[1]), ft(v[2])}; }
static V lattice(Random &r) { return {tenth(r, -50, 50), tenth(r, -50, 50), tenth(r, -50, 50)}; }

static quoin_side side_of(const Model &m, const V &p) {
  std::string s[3];
  const char *t[3];
  for (int i = 0; i < 3; i++) s[i] = decimal(p[i]), t[i] = s[i].c_str();
  quoin_side out;
  if (quoin_point_side_text(m.scene, m.work, t, &out) != QUOIN_OK) throw std::runtime_error("point refused");
  return out;
}

int main(int argc, char **argv) {
  long planes = argc > 1 ? atol(argv[1]) : 400;
  Random r(argc > 2 ? strtoull(argv[2], nullptr, 10) : 7);
  long wrong = 0, on = 0, in = 0, outside = 0, same = 0, different = 0;
  for (long i = 0; i < planes; i++) {
    V a = lattice(r), b = lattice(r), c = lattice(r), n = cross(b - a, c - a);
    if (zero(n)) continue;
    std::string half = "halfspace(n=" + text(n) + ",d=" + decimal(dot(n, a)) + ");\n";
    Model m(half);
    K::Plane_3 plane(point(a), point(b), point(c));
    for (int k = 0; k < 60; k++) {
      Q u = tenth(r, -30, 30), v = tenth(r, -30, 30);
      V p = a + u * (b - a) + v * (c - a);
      if (k % 3 == 1) p[r.below(3)] += (r.chance(50) ? Q(1) : Q(-1)) * pow2(-r.range(1, 120));
      if (k % 3 == 2) p = lattice(r);
      int s = (int)plane.oriented_side(point(p));
      quoin_side should = s == 0 ? QUOIN_BOUNDARY : s < 0 ? QUOIN_INSIDE : QUOIN_OUTSIDE;
      quoin_side said = side_of(m, p);
      (should == QUOIN_BOUNDARY ? on : should == QUOIN_INSIDE ? in : outside)++;
      if (said != should) {
        fprintf(stderr, "WRONG side %d, should be %d, of %s\n%s", said, should, text(p).c_str(), half.c_str());
        wrong++;
      }
    }
    // The same plane through three other points of it, and perhaps one of them moved a little off it.
    V p[3];
    for (V &x : p) x = a + tenth(r, -30, 30) * (b - a) + tenth(r, -30, 30) * (c - a);
    bool moved = r.chance(50);
    if (moved) p[0] = p[0] + pow2(-r.range(1, 80)) * V{Q(r.range(0, 1)), Q(r.range(0, 1)), Q(1)};
    V n2 = cross(p[1] - p[0], p[2] - p[0]);
    if (zero(n2)) continue;
    bool coplanar = CGAL::coplanar(point(a), point(b), point(c), point(p[0])) && CGAL::coplanar(point(a), point(b), point(c), point(p[1])) &&
                    CGAL::coplanar(point(a), point(b), point(c), point(p[2]));
    Model two("intersection() {\n" + half + "halfspace(n=" + text(n2) + ",d=" + decimal(dot(n2, p[0])) + ");\n}\n");
    quoin_scene_info info;
    quoin_scene_get_info(two.scene, &info);
    if (info.leaves == 2) {
      (coplanar ? same : different)++;
      if ((info.distinct_surfaces == 1) != coplanar) {
        fprintf(stderr, "WRONG: %zu surfaces, coplanar %d\n%s", info.distinct_surfaces, coplanar, half.c_str());
        wrong++;
      }
    }
  }
  printf("sides: %ld on, %ld inside, %ld outside; pairs: %ld coplanar, %ld not; %ld wrong\n", on, in, outside, same, different, wrong);
  if (!on || !in || !outside || !same || !different) {
    printf("a kind did not occur\n");
    wrong++;
  }
  return wrong != 0;
}
