// Grids of rays, aimed as bundles are: one of the rays is, up to rounding and mostly exactly, one that was aimed at a hard place. The rays judged are the
// doubles that include/quoin/scene.h says a grid's rays are.
#pragma once
#include "aim.hpp"

#include "quoin/quoin.h"

namespace stress {
struct GridPart { // a part of one
  quoin_grid of{};
  size_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
};
// Row after row.
inline std::vector<Ray> rays_of(const GridPart &g) {
  std::vector<Ray> out;
  for (size_t y = g.y0; y < g.y1; y++)
    for (size_t x = g.x0; x < g.x1; x++) {
      const double s = ((double)x + 0.5) / (double)g.of.width, r = ((double)y + 0.5) / (double)g.of.height;
      Ray ray;
      for (int i = 0; i < 3; i++) {
        const double across = (g.of.converging ? g.of.d : g.of.o)[i] + s * g.of.u[i], both = across + r * g.of.v[i];
        ray.o[i] = g.of.converging ? g.of.o[i] : both, ray.d[i] = g.of.converging ? both : g.of.d[i];
      }
      ray.from = g.of.from, ray.to = g.of.to;
      out.push_back(ray);
    }
  return out;
}

// lattice: steps as those of a bundle; grazing: rows one above the other next to the face or body that the spot is on, columns side by side over all of a leaf;
// small solid: some few rays meet a leaf.
enum View { Lattice, Grazing, Small, Views };
static const char *const VIEWS[Views] = {"lattice", "grazing", "small solid"};

// v with a greatest entry of `size`, and few bits.
inline void sized(double v[3], double size, int bits) {
  const double most = std::max({std::fabs(v[0]), std::fabs(v[1]), std::fabs(v[2])});
  if (!(most > 0) || !(size > 0) || !std::isfinite(size)) return;
  const double unit = std::ldexp(1, std::ilogb(size) - bits);
  for (int i = 0; i < 3; i++) v[i] = std::nearbyint(v[i] / most * size / unit) * unit;
}
// A grid about a first ray and a part of it that has that ray, with up to `reach` columns and rows beside it. False: that makes no grid.
inline bool a_grid(Random &r, const Ray &first, const Line &line, const std::vector<Ball> &balls, int view, size_t reach, GridPart &g) {
  const double length = std::max({std::fabs(first.d[0]), std::fabs(first.d[1]), std::fabs(first.d[2])});
  quoin_grid &of = g.of;
  of = {};
  of.converging = r.chance(50);
  auto side = [&] { return (size_t)(r.chance(60) ? 1 << r.range(0, 4) : r.chance(80) ? r.range(1, 16) : r.range(17, 400)); };
  of.width = side(), of.height = side();
  double far = 1; // a step in the directions of rays from one place is that many times as long where the spot is
  if (of.converging) {
    far = std::fabs(line.t);
    if (!(far > 0)) { // about where the spot is along the ray
      double t = 0, dd = 0;
      for (int i = 0; i < 3; i++) t += (CGAL::to_double(line.spot->point[(size_t)i]) - first.o[i]) * (first.d[i] / length), dd += first.d[i] / length * (first.d[i] / length);
      far = std::fabs(t) / dd / length;
    }
    if (!(far > 0x1p-300 && far < 0x1p300)) far = 1;
  }
  double solid = balls[(size_t)r.below((int)balls.size())].radius; // of some leaf
  if (!(solid > 0x1p-300 && solid < 0x1p300)) solid = std::ldexp(1, r.range(-3, 6));
  across(r, first, length, of.u, of.v);
  const int bits = r.range(2, 24);
  if (view == Lattice) {
    const double step = std::ldexp(length, -r.range(0, r.chance(50) ? 8 : 52));
    for (int i = 0; i < 3; i++) of.u[i] *= (double)of.width * step, of.v[i] *= (double)of.height * step;
  } else if (view == Grazing) {
    V n = shorter(line.spot->normal), d = shorter(direction(first)), u = shorter(cross(n, d));
    if (zero(n) || zero(u)) return false;
    for (int i = 0; i < 3; i++) of.u[i] = CGAL::to_double(u[(size_t)i]), of.v[i] = CGAL::to_double(n[(size_t)i]);
    sized(of.u, std::ldexp(solid, r.range(-6, 2)) / far, bits);
    sized(of.v, std::ldexp(solid, -r.range(0, r.chance(50) ? 12 : 50)) / far, bits);
  } else {
    const double pitch = std::ldexp(solid, r.range(-4, 2)) / far;
    sized(of.u, pitch * (double)of.width, bits), sized(of.v, pitch * (double)of.height, bits);
  }
  if (r.chance(50)) std::swap(of.u, of.v);
  // The first ray's place in it, and a part around that.
  const size_t x = (size_t)r.below((int)of.width), y = (size_t)r.below((int)of.height);
  const double s = ((double)x + 0.5) / (double)of.width, t = ((double)y + 0.5) / (double)of.height;
  for (int i = 0; i < 3; i++) {
    of.o[i] = first.o[i], of.d[i] = first.d[i];
    double &base = of.converging ? of.d[i] : of.o[i];
    base -= s * of.u[i] + t * of.v[i];
  }
  auto part = [&](size_t at, size_t n, size_t &from, size_t &to) {
    from = at - (size_t)r.below((int)std::min(at, reach) + 1);
    to = at + 1 + (size_t)r.below((int)std::min(n - at, reach));
  };
  if (reach > 1 && of.width <= 16 && of.height <= 16 && r.chance(40)) g.x0 = g.y0 = 0, g.x1 = of.width, g.y1 = of.height;
  else part(x, of.width, g.x0, g.x1), part(y, of.height, g.y0, g.y1);
  Ray range;
  cut(r, a_cut(r), line.t, range);
  of.from = range.from, of.to = range.to;
  for (auto &ray : rays_of(g)) {
    bool any = false;
    for (int i = 0; i < 3; i++) {
      if (!std::isfinite(ray.o[i]) || !std::isfinite(ray.d[i])) return false;
      any |= ray.d[i] != 0;
    }
    if (!any) return false;
  }
  return true;
}
} // namespace stress
