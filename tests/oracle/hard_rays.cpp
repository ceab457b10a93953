// Random solids with shared faces and tangencies, and rays aimed where answers are hard: every stretch against the oracle.
// Usage: oracle_hard_rays [RAYS [SEED]]; a census of the kinds is printed, and a kind that did not occur is a failure.
#include "judge.hpp"

#include <map>

using namespace oracle;

struct Census { long asked = 0, judged = 0, events = 0, touches = 0, ties = 0, on = 0, empty = 0; };

static V small_vector(Random &r) {
  V v;
  do
    v = {Q(r.range(-4, 4)), Q(r.range(-4, 4)), Q(r.range(-4, 4))};
  while (zero(v));
  return v;
}
static bool decimals(const V &v) { return is_decimal(v[0]) && is_decimal(v[1]) && is_decimal(v[2]); }
// A positive multiple with small decimal entries, where there is one.
static bool clear(V &v) {
  for (int i = 0; i < 3; i++) {
    CGAL::Gmpz den = v[i].denominator();
    Q f{den};
    if (!is_decimal(v[i])) v = f * v;
  }
  return decimals(v) && !zero(v);
}

int main(int argc, char **argv) {
  long want = argc > 1 ? atol(argv[1]) : 200000;
  uint64_t seed = argc > 2 ? strtoull(argv[2], nullptr, 10) : 1;
  std::map<std::string, Census> census;
  long judged = 0, wrong = 0, solids = 0;
  Random r(seed);
  while (judged < want) {
    Node solid = make_solid(r, r.range(0, 3));
    solids++;
    Model m(solid.text);
    Surfaces surfaces(solid);
    std::vector<const Leaf *> leaves;
    collect(solid, leaves);
    std::vector<const Spot *> spots;
    for (auto *l : leaves)
      for (auto &s : l->spots) spots.push_back(&s);
    if (spots.empty()) continue;
    for (int k = 0; k < 60; k++) {
      const Spot &s = *spots[r.below((int)spots.size())];
      V p = s.point, d;
      const char *kind = "";
      int pick = r.below(9);
      if (pick == 0 && !zero(s.normal)) { // exactly tangent
        kind = "tangent", d = cross(s.normal, small_vector(r));
      } else if (pick == 1 && !zero(s.normal)) {
        kind = "near-tangent", d = cross(s.normal, small_vector(r));
        V n = s.normal;
        if (!clear(n)) continue;
        p = p + (r.chance(50) ? Q(1) : Q(-1)) * pow2(-r.range(20, 60)) * n;
      } else if (pick == 2 && !zero(s.along)) {
        kind = s.kind == Spot::Generator ? "generator" : s.kind == Spot::Face ? "coplanar" : s.kind == Spot::Edge || s.kind == Spot::Corner ? "edge" : "rim tangent";
        d = s.along;
      } else if (pick == 3 && !zero(s.along)) {
        kind = "parallel", d = s.along;
        p = p + pow2(-r.range(0, 50)) * small_vector(r);
      } else if (pick == 4) {
        kind = s.kind == Spot::Apex ? "apex" : s.kind == Spot::Rim ? "rim" : s.kind == Spot::Corner ? "corner" : s.kind == Spot::Edge ? "edge point" : "point";
        d = small_vector(r);
      } else if (pick == 5) {
        kind = "two spots", d = spots[r.below((int)spots.size())]->point - p;
      } else if (pick == 6) {
        kind = "far", d = small_vector(r);
        p = p - pow10(r.range(6, 12)) * d;
        if (r.chance(50)) p = p + pow2(-r.range(10, 60)) * small_vector(r);
      } else if (pick == 7) {
        kind = "axis";
        d = {0, 0, 0}, d[r.below(3)] = r.chance(50) ? 1 : -1;
      } else {
        kind = "scaled";
        d = pow2(r.range(-300, 300)) * small_vector(r);
      }
      if (zero(d) || !clear(d) || !decimals(p)) continue;
      if (pick != 6 && r.chance(70)) p = p - Q(r.range(1, 50)) / Q(4) * d;
      Census &c = census[kind];
      c.asked++;
      Answer a = intersect(solid, surfaces, p, d);
      int right = judge(solid, a, m, p, d, kind);
      if (right < 0) continue;
      c.judged++, judged++;
      wrong += !right;
      c.events += (long)a.cuts.size(), c.touches += a.touches, c.ties += a.ties, c.empty += a.cuts.empty();
      c.on += std::count(a.what.begin(), a.what.end(), Answer::On);
      if (wrong >= 10) {
        fprintf(stderr, "too many wrong answers; seed %llu\n", (unsigned long long)seed);
        return 1;
      }
    }
  }
  printf("%-14s %9s %9s %9s %9s %9s %9s %9s\n", "kind", "asked", "judged", "ends", "touches", "ties", "on", "empty");
  for (auto &k : census)
    printf("%-14s %9ld %9ld %9ld %9ld %9ld %9ld %9ld\n", k.first.c_str(), k.second.asked, k.second.judged, k.second.events, k.second.touches, k.second.ties, k.second.on, k.second.empty);
  printf("%ld solids, %ld rays judged, %ld wrong, seed %llu\n", solids, judged, wrong, (unsigned long long)seed);
  for (const char *kind : {"tangent", "near-tangent", "generator", "coplanar", "edge", "parallel", "apex", "rim", "corner", "two spots", "far", "axis", "scaled"})
    if (want >= 20000 && census[kind].judged == 0) {
      printf("the kind '%s' did not occur\n", kind);
      wrong++;
    }
  return wrong != 0;
}
