// Embree 3 on a scene of spheres: the same grid, blocks and lists of rays as bench_scenes, first hits, single precision.
// usage: bench_embree SCENE.flat CAMERA [--size N] [--seconds S] [--rounds N] [--oracle N] [--csv FILE] [--name NAME]
// Packets of 16 and of 8 (rtcIntersect16 and 8; 4 x 4 and 4 x 2 pixels, coherent), and single rays; timed from camera to hit record. An answer is
// wrong when it says hit for miss or miss for hit, or when its t is off by more than a thousandth of the smallest sphere's radius.
#include "flat.h"
#include "grid.h"
#include "oracle.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <embree3/rtcore.h>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

namespace {

constexpr unsigned EDGE = 64;

struct Options {
  std::string flat, camera, csv, name = "scene";
  unsigned size = 0, rounds = 3;
  double seconds = 0.3;
  size_t oracle = 100;
};

struct Bench {
  Options options;
  bench_camera camera;
  RTCScene scene;
  float direction[3];
};

// The origin in single precision, as every program that uses Embree hands it over.
void origin(const bench_camera &c, unsigned i, unsigned j, float out[3]) {
  double o[3];
  bench_camera_ray(&c, i, j, o);
  for (int k = 0; k < 3; k++) {
    out[k] = (float)o[k];
  }
}

template <int N> struct Packet;
template <> struct Packet<16> {
  using Type = RTCRayHit16;
  static void go(const int *valid, RTCScene s, RTCIntersectContext *c, Type *p) { rtcIntersect16(valid, s, c, p); }
};
template <> struct Packet<8> {
  using Type = RTCRayHit8;
  static void go(const int *valid, RTCScene s, RTCIntersectContext *c, Type *p) { rtcIntersect8(valid, s, c, p); }
};

// One block of the grid; t of each pixel, row-major, into `out` when it is not null.
template <int N> double block_packets(const Bench &b, unsigned x0, unsigned y0, float *out) {
  constexpr unsigned W = 4, H = N / 4;
  alignas(64) typename Packet<N>::Type p;
  alignas(64) int valid[N];
  std::fill(valid, valid + N, -1);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  double sum = 0;
  for (unsigned y = 0; y < EDGE; y += H) {
    for (unsigned x = 0; x < EDGE; x += W) {
      for (unsigned k = 0; k < N; k++) {
        float o[3];
        origin(b.camera, x0 + x + k % W, y0 + y + k / W, o);
        p.ray.org_x[k] = o[0], p.ray.org_y[k] = o[1], p.ray.org_z[k] = o[2];
        p.ray.dir_x[k] = b.direction[0], p.ray.dir_y[k] = b.direction[1], p.ray.dir_z[k] = b.direction[2];
        p.ray.tnear[k] = 0;
        p.ray.tfar[k] = std::numeric_limits<float>::infinity();
        p.ray.time[k] = 0;
        p.ray.mask[k] = ~0u;
        p.ray.id[k] = k;
        p.ray.flags[k] = 0;
        p.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        p.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      }
      Packet<N>::go(valid, b.scene, &context, &p);
      sum += p.ray.tfar[0];
      for (unsigned k = 0; out && k < N; k++) {
        out[(y + k / W) * EDGE + x + k % W] = p.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID ? INFINITY : p.ray.tfar[k];
      }
    }
  }
  return sum;
}

double block_single(const Bench &b, unsigned x0, unsigned y0, float *out) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  double sum = 0;
  for (unsigned y = 0; y < EDGE; y++) {
    for (unsigned x = 0; x < EDGE; x++) {
      RTCRayHit r = {};
      float o[3];
      origin(b.camera, x0 + x, y0 + y, o);
      r.ray.org_x = o[0], r.ray.org_y = o[1], r.ray.org_z = o[2];
      r.ray.dir_x = b.direction[0], r.ray.dir_y = b.direction[1], r.ray.dir_z = b.direction[2];
      r.ray.tfar = INFINITY;
      r.ray.mask = ~0u;
      r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(b.scene, &context, &r);
      sum += r.hit.geomID;
      if (out) {
        out[y * EDGE + x] = r.hit.geomID != RTC_INVALID_GEOMETRY_ID ? r.ray.tfar : INFINITY;
      }
    }
  }
  return sum;
}

struct Path {
  const char *name;
  double (*block)(const Bench &, unsigned, unsigned, float *);
};
const Path PATHS[] = {{"packet16", block_packets<16>}, {"packet8", block_packets<8>}, {"single", block_single}};

struct Verdict { size_t judged = 0, wrong = 0; };

// What the oracle says of pixels here and there: t, or infinity.
struct Sample { unsigned x0, y0, place; double t; };

std::vector<Sample> draw_samples(const Bench &b, oracle *o, const std::vector<size_t> &order, unsigned across) {
  std::vector<Sample> samples;
  uint64_t state = 2;
  double begin = bench_now();
  for (size_t s = 0; s < b.options.oracle && bench_now() - begin < 5; s++) {
    size_t block = order[s / 4 % order.size()];
    Sample one = {(unsigned)(block % across) * EDGE, (unsigned)(block / across) * EDGE, (unsigned)(bench_u64(&state) % (EDGE * EDGE)), INFINITY};
    double from[3];
    bench_camera_ray(&b.camera, one.x0 + one.place % EDGE, one.y0 + one.place / EDGE, from);
    oracle_interval first;
    int zero;
    long found = oracle_ray(o, from, b.camera.d, 1, &first, &zero);
    if (found >= 0) {
      one.t = found ? first.enter : INFINITY;
      samples.push_back(one);
    }
  }
  return samples;
}

Verdict judge(const Bench &b, const Path &p, const std::vector<Sample> &samples, double least) {
  Verdict v;
  std::vector<float> t(EDGE * EDGE);
  for (const Sample &s : samples) {
    p.block(b, s.x0, s.y0, t.data());
    v.judged++;
    v.wrong += std::isfinite(s.t) ? !(std::fabs(t[s.place] - s.t) <= 1e-3 * least) : t[s.place] < INFINITY;
  }
  return v;
}

bool parse(int argc, char **argv, Options &o) {
  for (int i = 1; i < argc; i++) {
    std::string a = argv[i];
    if (a.rfind("--", 0) != 0) {
      (o.flat.empty() ? o.flat : o.camera) = a;
      continue;
    }
    if (++i == argc) {
      return false;
    }
    if (a == "--size") o.size = (unsigned)std::stoul(argv[i]);
    else if (a == "--seconds") o.seconds = std::stod(argv[i]);
    else if (a == "--rounds") o.rounds = (unsigned)std::stoul(argv[i]);
    else if (a == "--oracle") o.oracle = std::stoul(argv[i]);
    else if (a == "--csv") o.csv = argv[i];
    else if (a == "--name") o.name = argv[i];
    else return false;
  }
  return !o.camera.empty() && o.rounds > 0;
}

} // namespace

int main(int argc, char **argv) {
  Bench b;
  flat_scene flat;
  if (!parse(argc, argv, b.options)) {
    std::fputs("usage: bench_embree SCENE.flat CAMERA [--size N] [--seconds S] [--rounds N] [--oracle N] [--csv FILE] [--name NAME]\n", stderr);
    return 2;
  }
  if (!bench_camera_read(b.options.camera.c_str(), &b.camera) || !flat_read(b.options.flat.c_str(), &flat)) {
    return 3;
  }
  if (b.options.size) {
    b.camera.width = b.camera.height = b.options.size;
  }
  if (b.camera.width % EDGE || b.camera.height % EDGE) {
    std::fputs("the grid must be a multiple of 64\n", stderr);
    return 2;
  }
  for (int k = 0; k < 3; k++) {
    b.direction[k] = (float)b.camera.d[k];
  }
  RTCDevice device = rtcNewDevice("threads=1,set_affinity=0");
  b.scene = rtcNewScene(device);
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  float *v = (float *)rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), flat.leaf_count);
  for (size_t i = 0; i < flat.leaf_count; i++) {
    if (flat.leaves[i].kind != 'S') {
      std::fputs("spheres only\n", stderr);
      return 3;
    }
    for (int k = 0; k < 4; k++) {
      v[4 * i + (size_t)k] = (float)flat.leaves[i].v[k];
    }
  }
  double begin = bench_now();
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(b.scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcSetSceneBuildQuality(b.scene, RTC_BUILD_QUALITY_HIGH);
  rtcCommitScene(b.scene);
  double build = bench_now() - begin;
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) {
    std::fputs("Embree failed\n", stderr);
    return 1;
  }
  std::printf("%s, Embree %s: %zu spheres, built %.3f s\n", b.options.name.c_str(), RTC_VERSION_STRING, flat.leaf_count, build);
  unsigned across = b.camera.width / EDGE, down = b.camera.height / EDGE;
  std::vector<size_t> order((size_t)across * down);
  std::iota(order.begin(), order.end(), 0);
  uint64_t seed = 1;
  for (size_t i = 0; i < order.size(); i++) {
    std::swap(order[i], order[bench_u64(&seed) % (i + 1)]);
  }
  oracle *o = oracle_new(&flat);
  std::vector<Sample> samples = draw_samples(b, o, order, across);
  double sum = 0, least = INFINITY;
  for (size_t i = 0; i < flat.leaf_count; i++) {
    least = std::min(least, flat.leaves[i].v[3]);
  }
  for (const Path &p : PATHS) {
    Verdict verdict = judge(b, p, samples, least);
    std::vector<double> rates;
    double rays = 0, seconds = 0;
    for (unsigned r = 0; r < b.options.rounds; r++) {
      size_t blocks = 0;
      double from = bench_now(), until = from + b.options.seconds;
      for (; bench_now() < until; blocks++) {
        size_t block = order[blocks % order.size()];
        sum += p.block(b, (unsigned)(block % across) * EDGE, (unsigned)(block / across) * EDGE, nullptr);
      }
      double spent = bench_now() - from, done = (double)blocks * EDGE * EDGE;
      rates.push_back(done / spent / 1e6);
      rays += done;
      seconds += spent;
    }
    std::sort(rates.begin(), rates.end());
    double rate = rates[rates.size() / 2];
    std::printf("%-17s %9.3f  %zu/%zu\n", p.name, rate, verdict.wrong, verdict.judged);
    if (!b.options.csv.empty()) {
      if (FILE *f = std::fopen(b.options.csv.c_str(), "a")) {
        std::fprintf(f, "%s,embree-%s,1,best,%.0f,%.4f,%.5g,0,0,%zu,%zu,,,,,,,,,%.4f,%zu,\n", b.options.name.c_str(), p.name, rays, seconds, rate, verdict.judged,
                     verdict.wrong, build, flat.leaf_count);
        std::fclose(f);
      }
    }
  }
  oracle_free(o);
  flat_free(&flat);
  rtcReleaseScene(b.scene);
  rtcReleaseDevice(device);
  return std::isnan(sum) ? 1 : 0;
}
