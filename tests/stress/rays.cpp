// Numerical stress: random hard models, bundles of hard rays asked in every way there is, every answer judged. Prints one line, with its
// seed, that tools/stress adds up; a wrong answer is made small and written to a file.
//
// Usage: stress_rays [--seed S] [--seconds T | --models N] [--leaves N] [--share PERMILLE] [--motif NUMBER] [--finds DIR] [--census] [--undecided] [--again MODELSEED]
#include "shrink.hpp"

using namespace stress;

struct Totals {
  unsigned long long models = 0, leaves = 0, rays = 0, quick = 0, exact = 0, unjudged = 0, ends = 0, points = 0, wrong = 0, refused = 0, middles = 0, hard_points = 0, undecided = 0;
  std::vector<Asked> asked; // of the present model
  Census census;
  double asking = 0, quickly = 0, exactly = 0, pointing = 0;
};
struct Options {
  uint64_t seed = 1;
  double seconds = 5;
  long models = 0;
  int leaves = 200, share = 5, motif = -1;
  std::string finds = ".";
  bool census = false, once = false, undecided = false;
};

static const char *const SPOTS[] = {"smooth place", "rim", "apex", "edge", "corner", "face", "generator"};
static const char *const SIDES[] = {"outside", "boundary", "inside"};

static void found(Totals &t, const Options &o, Case c, uint64_t model_seed, const char *what) {
  t.wrong++;
  std::string again = "stress_rays --leaves " + std::to_string(o.leaves) + (o.motif >= 0 ? " --motif " + std::to_string(o.motif) : "") + " --again " + std::to_string(model_seed);
  fprintf(stderr, "WRONG: %s, %s (%s)\n", what, WAYS[c.way], again.c_str());
  if (t.wrong <= 3) {
    if (first_wrong(c) < 0) c.before = t.asked; // right when asked alone: what the works have kept matters
    shrink(c, 40);
    std::string path = o.finds + "/rays_" + std::to_string(model_seed) + ".csg", text = report(c, what, again);
    FILE *f = fopen(path.c_str(), "w");
    if (f) fputs(text.c_str(), f), fclose(f);
    fprintf(stderr, "%s\n%s\n", path.c_str(), text.c_str());
  }
}

static void wrong_point(Points c, uint64_t seed, const Options &o, Totals &t) {
  std::string again = "stress_rays --leaves " + std::to_string(o.leaves) + (o.motif >= 0 ? " --motif " + std::to_string(o.motif) : "") + " --again " + std::to_string(seed);
  fprintf(stderr, "WRONG: the side of a point (%s)\n", again.c_str());
  t.wrong++;
  if (t.wrong > 3) return;
  shrink(c, 40);
  std::string path = o.finds + "/point_" + std::to_string(seed) + ".csg", text = report(c, again);
  FILE *f = fopen(path.c_str(), "w");
  if (f) fputs(text.c_str(), f), fclose(f);
  fprintf(stderr, "%s\n%s\n", path.c_str(), text.c_str());
}

// What a point must be said to be; -1: not judged. hard: where it lies, when only point.hpp judges it.
struct Sought {
  int side = -1;
  const char *hard = nullptr;
};
static Sought seek(const Bench &b, const V &p, Random &r, const Options &o, Totals &t) {
  const char *hard = nullptr, *why = "";
  double t0 = now();
  Sought s;
  s.side = b.side(p, r.below(1000) < 2 * o.share, &hard, &why), s.hard = hard;
  t.pointing += now() - t0;
  if (hard) t.census.count("hard_point", s.side < 0 ? std::string("not judged: ") + why : std::string(hard) + ", " + SIDES[s.side]);
  if (s.side < 0) t.unjudged++;
  t.hard_points += hard != nullptr;
  return s;
}
// False: the answer is wrong. Points that may be undecided are counted apart.
static bool right_side(const Sought &sought, quoin_side said, quoin_status status, const V &p, uint64_t seed, const Options &o, Totals &t) {
  t.points++, t.census.count("point", SIDES[sought.side]);
  if (status == QUOIN_OK && said == sought.side) return true;
  if (status == QUOIN_OK && Bench::may_be_undecided(sought.hard) && said == QUOIN_BOUNDARY) {
    t.undecided += !strstr(sought.hard, "apex");
    t.census.count("hard_point", std::string("undecided ") + sought.hard + ", said to be boundary, is " + SIDES[sought.side]);
    if (o.undecided) fprintf(stderr, "undecided, is %s: point %s %s %s, %s: --again %llu\n", SIDES[sought.side], decimal(p[0]).c_str(), decimal(p[1]).c_str(), decimal(p[2]).c_str(), sought.hard, (unsigned long long)seed);
    return true;
  }
  return false;
}

// Points: the places of interest, exactly and a little beside, as decimals one by one and as doubles in batches.
static void ask_points(Bench &b, uint64_t seed, uint64_t spots_seed, Random &r, const Options &o, Totals &t) {
  std::vector<quoin_side> said;
  for (int k = 0; k < 6 && !b.spots.empty(); k++) {
    V p = b.spots[(size_t)r.below((int)b.spots.size())]->point;
    if (!is_decimal(p[0]) || !is_decimal(p[1]) || !is_decimal(p[2])) continue;
    if (r.chance(40)) p[(size_t)r.below(3)] += (r.chance(50) ? Q(1) : Q(-1)) * pow2(-r.range(1, 120));
    Sought sought = seek(b, p, r, o, t);
    if (sought.side < 0) continue;
    Points one{b.spec, {p}, true, 2, spots_seed};
    quoin_status s = stress::ask_points(b, one, said);
    if (!right_side(sought, said[0], s, p, seed, o, t)) return wrong_point(one, seed, o, t);
  }
  for (int k = 0; k < 3 && !b.spots.empty(); k++) {
    size_t n = r.chance(50) ? 64 : (size_t)r.range(1, 150);
    int kind = r.below(4), step = r.range(0, 52);
    Points batch{b.spec, {}, false, r.below(3), spots_seed};
    V first = b.spots[(size_t)r.below((int)b.spots.size())]->point;
    for (size_t i = 0; i < n; i++) {
      V p = kind == 0 ? b.spots[(size_t)r.below((int)b.spots.size())]->point : first;
      for (size_t j = 0; j < 3; j++) {
        double v = CGAL::to_double(p[j]);
        if (kind == 1 && i) v += std::ldexp((double)r.range(-4, 4), -step);
        if (kind == 2) v += std::ldexp((double)(j == 0 ? i % 8 : j == 1 ? i / 8 : 0), -step);
        if (kind != 1)
          for (int m = r.chance(20) ? r.below(4) : 0; m > 0; m--) v = std::nextafter(v, r.chance(50) ? INFINITY : -INFINITY);
        if (std::fabs(v) < 0x1p-300) v = 0;
        p[j] = Q(v);
      }
      batch.at.push_back(p);
    }
    quoin_status s = stress::ask_points(b, batch, said);
    for (size_t i = 0; i < n; i++) {
      const V &p = batch.at[i];
      const double x[3] = {CGAL::to_double(p[0]), CGAL::to_double(p[1]), CGAL::to_double(p[2])};
      Sought sought;
      sought.side = b.quick.side(x);
      if (sought.side < 0 || (int)said[i] != sought.side || r.below(1000) < o.share) sought = seek(b, p, r, o, t);
      if (sought.side < 0) continue;
      if (!right_side(sought, said[i], s, p, seed, o, t)) return wrong_point(batch, seed, o, t);
    }
  }
}

// Asks for a bundle or a grid and judges every answer. False: one is wrong.
static bool ask(Bench &b, const Asked &a, const Line &line, const std::string &frame, uint64_t seed, uint64_t spots_seed, Random &r, const Options &o, Totals &t) {
  const std::vector<Ray> &rays = a.rays;
  const int way = a.way, isa = a.isa;
  const GridPart &grid = a.grid;
  const size_t n = rays.size();
  double t0 = now();
  auto replies = ask_rays(b.model, b.work(isa), rays, way, grid);
  t.asking += now() - t0;
  t.census.count("way", WAYS[way], n), t.census.count("aim", AIMS[line.kind], n), t.census.count("isa", ISAS[isa], n);
  const bool contact = line.spot >= b.contacts.data() && line.spot < b.contacts.data() + b.contacts.size();
  t.census.count("spot", contact ? "contact" : SPOTS[line.spot->kind], n);
  Ulps *const ulps[2] = {&t.census.ends[std::string("aim ") + AIMS[line.kind]], &t.census.ends["frame " + frame]};
  bool aimed = false; // the exact judge, at the present ray
  for (size_t i = 0; i < n; i++) {
    size_t ends = 0;
    t.rays++;
    double t1 = now();
    bool again = i && memcmp(rays[i].o, rays[i - 1].o, sizeof rays[i].o + sizeof rays[i].d) == 0;
    if (!again) b.aim_quick(rays[i]), aimed = false;
    Verdict v = b.judge_quick(rays[i], replies[i], way, ends, ulps);
    if (!again && b.known) t.census.count("line", b.quick.zeros.empty() ? "in no surface" : b.quick.zeros.size() == 1 ? "in one surface" : "in two surfaces");
    t.quickly += now() - t1;
    if (v == Right) {
      t.quick++, t.ends += ends;
      if (r.below(1000) >= o.share) continue;
    }
    ends = 0;
    double t2 = now();
    if (!again || !aimed) b.aim_exact(rays[i]);
    aimed = true;
    Verdict e = b.judge_exact(rays[i], replies[i], way, ends);
    t.exactly += now() - t2;
    if (e == Unjudged || e == Unknown) {
      t.unjudged += v != Right;
      if (v == Wrong) {
        fprintf(stderr, "the judges disagree: quick says wrong, exact does not judge: --again %llu\n", (unsigned long long)seed);
        t.wrong++;
      }
      continue;
    }
    if ((v == Wrong) != (e == Wrong) && v != Unknown) fprintf(stderr, "the judges disagree: --again %llu\n", (unsigned long long)seed), t.wrong++;
    if (v != Right) {
      t.exact++, t.ends += ends;
      if (!again && b.exact_answer.zero_surfaces) t.census.count("line", b.exact_answer.zero_surfaces > 2 ? "in three surfaces or more" : "in two that touch");
    }
    if (e == Wrong) {
      Case c{b.spec, rays, way, isa, spots_seed, grid, {}};
      found(t, o, c, seed, "wrong ray");
      return false;
    }
  }
  t.asked.push_back(a);
  return true;
}

static void one_model(uint64_t seed, const Options &o, Totals &t) {
  Random r(seed);
  Style st;
  st.dyadic = r.chance(60);
  std::vector<double> gaps;
  st.census = &t.census, st.motif = o.motif, st.gaps = &gaps;
  std::string frame;
  Spec spec = a_model(r, st, o.leaves, frame);
  uint64_t spots_seed = r.next();
  std::unique_ptr<Bench> b;
  try {
    b.reset(new Bench(spec, spots_seed));
  } catch (const std::exception &e) {
    t.refused++;
    if (t.refused < 3) fprintf(stderr, "refused (%s): --again %llu\n", e.what(), (unsigned long long)seed);
    return;
  }
  t.models++, t.leaves += leaves_of(spec), t.asked.clear();
  if (!gaps.empty()) t.census.count("gaps_in_frame", frame);
  std::vector<Ray> rays;
  int bundles = r.range(16, 48); // a model costs as much as a thousand rays
  Random back(seed ^ 0x6b636162); // of rays asked the other way too, so that bundles are the same with them or without
  const bool wide = o.motif == Style::Wide; // bounds are a packet's: many packets of few rays
  if (wide) bundles = 400;
  for (int k = 0; k < bundles; k++) {
    Line line;
    Ray first;
    if (!aim(r, b->spots, gaps, line, wide && r.chance(90) ? Gap : -1) || !to_ray(line, first)) continue;
    int kind = r.below(Bundles), way = r.below(100);
    way = way < 15 ? One : way < 40 ? Many : way < 52 ? ManyBoundary : way < 64 ? Hits : way < 71 ? Hit : way < 74 ? Text : way < 84 ? Spots : way < 94 ? Blocked : ManyText;
    size_t n = kind == Alone ? 1 : way == Text ? 4 : (size_t)(r.chance(50) ? 64 : r.chance(50) ? r.range(1, 63) : r.range(65, 140));
    if (wide) n = (size_t)(r.chance(90) ? r.range(2, 4) : r.range(17, 20));
    bundle(r, first, line.t, kind, n, b->spots, rays);
    if (way == ManyText)
      for (auto &x : rays) x.from = rays[0].from, x.to = rays[0].to;
    t.census.count("bundle", BUNDLES[kind], n);
    const int isa = r.below(3);
    if (!ask(*b, {rays, way, isa, {}}, line, frame, seed, spots_seed, r, o, t)) return;
    if (back.chance(70)) continue; // the same rays the other way, at once: what was kept of the first must not show
    for (auto &x : rays) {
      for (double &d : x.d) d = -d;
      const double from = x.from;
      x.from = -x.to, x.to = -from;
    }
    t.census.count("bundle", "the other way", n);
    if (!ask(*b, {rays, way, isa, {}}, line, frame, seed, spots_seed, back, o, t)) return;
  }
  Random g(seed ^ 0x67726964); // of grids, so that bundles are the same with them or without
  for (int k = wide ? 100 : g.range(6, 16); k > 0; k--) {
    Line line;
    Ray first;
    const int view = wide ? (int)Lattice : g.below(Views);
    if (!aim(g, b->spots, gaps, line, view == Grazing ? g.below(Along + 1) : wide && g.chance(90) ? Gap : -1) || !to_ray(line, first)) continue;
    Asked a{{}, g.range(GridHits, GridBoundary), g.below(3), {}};
    if (!a_grid(g, first, line, b->balls, view, wide ? 1 : 10, a.grid)) continue;
    a.rays = rays_of(a.grid);
    t.census.count("grid", std::string(a.grid.of.converging ? "converging " : "parallel ") + VIEWS[view], a.rays.size());
    if (!ask(*b, a, line, frame, seed, spots_seed, g, o, t)) return;
  }
  t.middles += b->middles;
  t.census.count("solved", "in doubles", b->quick.used[0]), t.census.count("solved", "in quadruple precision", b->quick.used[1]);
  t.census.count("solved", "with whole numbers", b->quick.used[2]), t.census.count("solved", "pairs of roots compared exactly", b->quick.compared);
  ask_points(*b, seed, spots_seed, r, o, t);
}

int main(int argc, char **argv) {
  Options o;
  uint64_t again = 0;
  for (int i = 1; i < argc; i++) {
    std::string a = argv[i];
    auto value = [&]() -> const char * {
      if (i + 1 >= argc) fprintf(stderr, "a value is missing after %s\n", a.c_str()), exit(2);
      return argv[++i];
    };
    if (a == "--seed") o.seed = strtoull(value(), nullptr, 10);
    else if (a == "--seconds") o.seconds = atof(value());
    else if (a == "--models") o.models = atol(value());
    else if (a == "--leaves") o.leaves = atoi(value());
    else if (a == "--share") o.share = atoi(value());
    else if (a == "--motif") o.motif = atoi(value());
    else if (a == "--finds") o.finds = value();
    else if (a == "--census") o.census = true;
    else if (a == "--undecided") o.undecided = true;
    else if (a == "--again") again = strtoull(value(), nullptr, 10), o.once = true;
    else return fprintf(stderr, "unknown option %s\n", a.c_str()), 2;
  }
  Totals t;
  if (o.once) {
    one_model(again, o, t);
    fprintf(stderr, "%llu rays, %llu wrong\n", t.rays, t.wrong);
    return t.wrong != 0;
  }
  Random seeds(Random(o.seed).next()); // far apart in one sequence: neighbours must not share models
  double begin = now();
  for (long k = 0; o.models ? k < o.models : now() - begin < o.seconds; k++) {
    one_model(seeds.next(), o, t);
    if (t.wrong >= 10) break;
  }
  for (auto &e : t.census.ends)
    if (e.second.most > 1 || e.second.misread) {
      fprintf(stderr, "WRONG text of parameters, %s: up to %.4f units of the last place off, %llu read back as other doubles\n", e.first.c_str(), e.second.most, e.second.misread);
      t.wrong++;
    }
  if (t.undecided > 50 + t.hard_points / 100) { // what is called rare is counted
    fprintf(stderr, "WRONG: too many points are undecided that are at no apex: %llu of %llu\n", t.undecided, t.hard_points);
    t.wrong++;
  }
  double all = now() - begin;
  printf("rays seed=%llu seconds=%.1f models=%llu leaves=%llu rays=%llu quick=%llu exact=%llu unjudged=%llu ends=%llu points=%llu refused=%llu wrong=%llu", (unsigned long long)o.seed, all,
         t.models, t.leaves, t.rays, t.quick, t.exact, t.unjudged, t.ends, t.points, t.refused, t.wrong);
  t.census.print(stdout);
  putchar('\n');
  if (o.census) {
    printf("ends in the middle between two doubles: %llu\n", t.middles);
    printf("time: asking %.1f s, quick judge %.1f s, exact judge %.1f s, exact judge of points %.1f s; %.0f models and %.0f rays a second\n", t.asking, t.quickly, t.exactly, t.pointing, t.models / all, t.rays / all);
  }
  return t.wrong != 0;
}
