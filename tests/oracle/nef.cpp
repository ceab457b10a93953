// Planar solids with every kind of coincidence, judged by Nef polyhedra: regularised Booleans of boxes and wedges on a
// small lattice, and the place of every lattice and half-lattice point (design S5, S6).
#include "judge.hpp"

#include <CGAL/Cartesian.h>
#include <CGAL/Nef_polyhedron_3.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/convex_hull_3.h>

using namespace oracle;
using K = CGAL::Cartesian<CGAL::Gmpq>;
using Nef = CGAL::Nef_polyhedron_3<K>;

struct Solid { Nef nef; std::string text; };

static Solid leaf(Random &r, int size) {
  int lo[3], hi[3];
  for (int i = 0; i < 3; i++) {
    lo[i] = r.below(size), hi[i] = r.range(lo[i] + 1, size);
  }
  std::vector<K::Point_3> p;
  bool wedge = r.chance(30);
  for (int i = 0; i < 8; i++) {
    if (wedge && (i & 1) && (i & 4)) continue; // the half with x/sx + z/sz <= 1
    p.emplace_back(i & 1 ? hi[0] : lo[0], i & 2 ? hi[1] : lo[1], i & 4 ? hi[2] : lo[2]);
  }
  CGAL::Polyhedron_3<K> hull;
  CGAL::convex_hull_3(p.begin(), p.end(), hull);
  char t[200];
  snprintf(t, sizeof t, "translate([%d,%d,%d]) %s([%d,%d,%d]);\n", lo[0], lo[1], lo[2], wedge ? "wedge" : "cube", hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]);
  return {Nef(hull), t};
}
static Solid solid(Random &r, int depth, int size) {
  if (depth == 0) return leaf(r, size);
  static const char *const words[] = {"union", "difference", "intersection"};
  int op = r.chance(40) ? 0 : r.chance(70) ? 1 : 2;
  Solid s = solid(r, depth - 1, size);
  std::string t = s.text;
  for (int i = r.range(1, 2); i > 0; i--) {
    Solid k = solid(r, depth - 1, size);
    s.nef = op == 0 ? s.nef + k.nef : op == 1 ? s.nef - k.nef : s.nef * k.nef;
    s.nef = s.nef.regularization();
    t += k.text;
  }
  s.text = std::string(words[op]) + "() {\n" + t + "}\n";
  return s;
}

int main(int argc, char **argv) {
  int solids = argc > 1 ? atoi(argv[1]) : 36;
  Random r(argc > 2 ? strtoull(argv[2], nullptr, 10) : 3);
  long wrong = 0, on = 0, in = 0, outside = 0;
  for (int i = 0; i < solids; i++) {
    const int size = 3;
    Solid s = solid(r, i < 8 ? 1 : 2, size);
    Model m(s.text);
    for (int x = -1; x <= 2 * size + 1; x++)
      for (int y = -1; y <= 2 * size + 1; y++)
        for (int z = -1; z <= 2 * size + 1; z++) {
          Nef::Volume_const_handle volume;
          quoin_side should = QUOIN_BOUNDARY, said;
          auto place = s.nef.locate(K::Point_3(CGAL::Gmpq(x, 2), CGAL::Gmpq(y, 2), CGAL::Gmpq(z, 2)));
          if (CGAL::assign(volume, place)) should = volume->mark() ? QUOIN_INSIDE : QUOIN_OUTSIDE;
          double p[3] = {x / 2.0, y / 2.0, z / 2.0};
          if (quoin_point_side(m.scene, m.work, p, &said) != QUOIN_OK) throw std::runtime_error("point refused");
          (should == QUOIN_BOUNDARY ? on : should == QUOIN_INSIDE ? in : outside)++;
          if (said != should) {
            if (wrong++ < 5) fprintf(stderr, "WRONG side %d, should be %d, of (%g, %g, %g) in\n%s", said, should, p[0], p[1], p[2], s.text.c_str());
          }
        }
  }
  printf("%d solids; points: %ld on, %ld inside, %ld outside; %ld wrong\n", solids, on, in, outside, wrong);
  return wrong != 0 || !on || !in || !outside;
}
