/* Cameras: the frustum, and the view that frames a solid.

   Legend: e the eye; f, r, u the unit vectors forward, right and up of the picture; s = tan(fov/2), the half height at
   distance 1; a = width/height, so a s is the half width; (x, y) a place in the picture in [-1, 1], y upwards.
   Perspective:  o = e,                 d = f + x (a s) r + y s u.
   Orthographic: o = e + x (a s D) r + y s D u,  d = f,  with D = |look - eye|: the size that perspective shows at `look`.
   d . f = 1 in both, so a ray's t is the depth.

   Framing. Let c be the box's centre and w = -f. A point c + v is in the picture of an eye at c + p r + q u + D w when
       |v.r - p| <= a s (D - v.w)   and   |v.u - q| <= s (D - v.w).
   With A = max(v.r + a s v.w) and B = max(-v.r + a s v.w) over the solid, the first holds for all of it when
   a s D >= A - p and a s D >= B + p; the smallest D is (A + B) / (2 a s), with p = (A - B)/2. The same for u. The larger D of the two
   is taken; in the direction that has room left, p may be anything in [A - a s D, a s D - B], and is chosen such that the picture
   is centred. In orthographic views the same holds with v.w left out: the size is the larger half extent, and the eye stands
   clear of the box. */
#include "image/camera.h"
#include "image/frame.h"
#include "image/vec.h"

#include <string.h>

#define DEFAULT_FOV 30.0                            /* degrees, vertical: little perspective distortion */
static const double view_from[3] = {1.0, -1.3, 0.8}; /* the default eye seen from the solid */
#define FRAME_FILL 0.92                             /* the part of the picture's half width and half height the box may take */
#define DEGREE 0.017453292519943295                 /* pi / 180 */

static int finite3(const double v[3]) {
  return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

/* The picture's frame for a view along `forward`. An up that is parallel to the view is replaced by y, or by z where y is
   too. */
static int make_frame(const double look_along[3], const double wished_up[3], double right[3], double up[3], double forward[3]) {
  static const double others[2][3] = {{0, 1, 0}, {0, 0, 1}};
  memcpy(forward, look_along, sizeof(double[3]));
  memcpy(up, wished_up, sizeof(double[3]));
  if (!qn_unit3(forward) || !qn_unit3(up)) {
    return 0;
  }
  qn_cross3(forward, up, right);
  for (int i = 0; i < 2 && !qn_unit3(right); i++) {
    qn_cross3(forward, others[i], right);
  }
  if (!qn_unit3(right)) {
    return 0;
  }
  qn_cross3(right, forward, up);
  return qn_unit3(up);
}

/* The tangent of an angle in (0, 90) degrees, of plain operations, so that it has the same bits on every machine: by Taylor's series of sine and cosine up to
   45 degrees (cut after the 19th power: under 2^-53), by the complement's inverse above. */
/* NOLINTNEXTLINE(misc-no-recursion): once, by the complement */
static double tangent(double degrees) {
  if (degrees == 45) {
    return 1;
  }
  if (degrees > 45) {
    return 1 / tangent(90 - degrees);
  }
  const double x = degrees * DEGREE, z = x * x;
  double sine = 1, cosine = 1;
  for (int n = 18; n > 0; n -= 2) { /* from the last term inwards */
    sine = 1 - sine * z / (n * (n + 1));
    cosine = 1 - cosine * z / (n * (n - 1));
  }
  return x * sine / cosine;
}

quoin_status qn_frustum_make(const quoin_camera *camera, size_t width, size_t height, qn_frustum *out) {
  qn_frustum f = {.near = camera->near, .width = (double)width, .height = (double)height};
  double along[3];
  for (int i = 0; i < 3; i++) {
    f.eye[i] = camera->eye[i];
    along[i] = camera->look[i] - camera->eye[i];
  }
  if (!finite3(camera->eye) || !finite3(camera->look) || !finite3(camera->up) || !(camera->fov > 0) || !(camera->fov < 180) ||
      !(camera->near >= 0) || !isfinite(camera->near) || !make_frame(along, camera->up, f.right, f.up, f.forward)) {
    return QUOIN_E_ARGUMENT;
  }
  f.half_h = tangent(camera->fov / 2);
  f.orthographic = camera->projection == QUOIN_ORTHOGRAPHIC;
  if (f.orthographic) {
    f.half_h *= qn_length3(along);
  }
  f.half_w = f.half_h * (f.width / f.height);
  if (!(f.half_h > 0) || !(f.half_w > 0) || !isfinite(f.half_w) || !isfinite(f.half_h)) {
    return QUOIN_E_ARGUMENT;
  }
  *out = f;
  return QUOIN_OK;
}

/* Offsets in the picture's frame of the place (x, y), in pixels. */
static double across_of(const qn_frustum *f, double x) {
  return (2 * x / f->width - 1) * f->half_w;
}
static double upwards_of(const qn_frustum *f, double y) {
  return (1 - 2 * y / f->height) * f->half_h;
}

void qn_frustum_ray(const qn_frustum *f, double x, double y, quoin_ray *out) {
  const double across = across_of(f, x), upwards = upwards_of(f, y);
  for (int i = 0; i < 3; i++) {
    const double moved = ((f->orthographic ? f->eye[i] : f->forward[i]) + across * f->right[i]) + upwards * f->up[i];
    out->o[i] = f->orthographic ? moved : f->eye[i];
    out->d[i] = f->orthographic ? f->forward[i] : moved;
  }
  out->from = f->near;
  out->to = INFINITY;
}

void qn_frustum_rays(const qn_frustum *f, const double x[QN_LANES], const double y[QN_LANES], qn_packet *out) {
  double across[QN_LANES], upwards[QN_LANES];
  for (int lane = 0; lane < QN_LANES; lane++) {
    across[lane] = across_of(f, x[lane]), upwards[lane] = upwards_of(f, y[lane]);
  }
  for (int i = 0; i < 3; i++) {
    const double base = f->orthographic ? f->eye[i] : f->forward[i], right = f->right[i], up = f->up[i];
    double *to = f->orthographic ? out->o[i] : out->d[i];
    for (int lane = 0; lane < QN_LANES; lane++) {
      to[lane] = (base + across[lane] * right) + upwards[lane] * up;
    }
  }
}

void qn_frustum_share(const qn_frustum *f, int tiles, qn_packet *out) {
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    for (int i = 0; i < 3; i++) {
      out->o[i][lane] = f->eye[i], out->d[i][lane] = f->forward[i];
    }
    out->from[lane] = f->near, out->to[lane] = INFINITY;
    out->on[lane] = QUOIN_NO_SURFACE;
  }
  out->few = QN_MANY_LANES;
  out->any = out->kept_ranges = 0;
  out->new_origins = out->new_directions = 1;
  out->entry = NULL;
  out->tile = !tiles ? QN_TILE_NONE : f->orthographic ? QN_TILE_ORIGINS : QN_TILE_DIRECTIONS;
}

/* Columns and rows through the centres of these pixels. */
static void columns_and_rows(const qn_frustum *f, const size_t x[8], const size_t y[8], qn_packet *out) {
  const double *base = f->orthographic ? f->eye : f->forward;
  for (unsigned i = 0; i < 8; i++) {
    const double across = across_of(f, (double)x[i] + 0.5), upwards = upwards_of(f, (double)y[i] + 0.5);
    for (int k = 0; k < 3; k++) {
      out->across[k][i] = base[k] + across * f->right[k];
      out->up[k][i] = upwards * f->up[k];
    }
  }
}

void qn_frustum_tile(const qn_frustum *f, size_t x, size_t y, size_t x1, size_t y1, qn_packet *out) {
  const unsigned columns = x1 - x < 8 ? (unsigned)(x1 - x) : 8, rows = y1 - y < 8 ? (unsigned)(y1 - y) : 8;
  size_t xs[8], ys[8];
  for (unsigned i = 0; i < 8; i++) {
    xs[i] = x + (i < columns ? i : columns - 1), ys[i] = y + (i < rows ? i : rows - 1);
  }
  columns_and_rows(f, xs, ys, out);
  out->live = ~(uint64_t)0;
  if (columns < 8 || rows < 8) {
    out->live = 0;
    for (unsigned lane = 0; lane < QN_LANES; lane++) {
      out->live |= (uint64_t)(qn_lane_column(lane) < columns && qn_lane_row(lane) < rows) << lane;
    }
  }
}

void qn_frustum_block(const qn_frustum *f, size_t x, size_t y, size_t x1, size_t y1, qn_packet *out) {
  size_t xs[8], ys[8];
  for (unsigned i = 0; i < 8; i++) {
    xs[i] = i < 4 ? x : x1 - 1, ys[i] = i < 4 ? y : y1 - 1;
  }
  columns_and_rows(f, xs, ys, out);
  out->live = ~(uint64_t)0;
}

/* The box to be framed: the solid's, an open side put at the size of the largest closed one from the side that is there. */
static void box_to_frame(const quoin_scene *scene, double min[3], double max[3]) {
  double size = 0;
  for (int i = 0; i < 3; i++) {
    const double extent = scene->max[i] - scene->min[i];
    size = !scene->empty && isfinite(extent) && extent > size ? extent : size;
  }
  size = size > 0 ? size : 1;
  for (int i = 0; i < 3; i++) {
    const int low = isfinite(scene->min[i]) && !scene->empty, high = isfinite(scene->max[i]) && !scene->empty;
    min[i] = low ? scene->min[i] : high ? scene->max[i] - size : -size / 2;
    max[i] = high ? scene->max[i] : low ? scene->min[i] + size : size / 2;
  }
}

enum { CENTRING_STEPS = 4, SLOPE_STEPS = 4 };

/* What is framed, seen from an eye that is `off` along one direction of the picture. */
typedef struct extent {
  const qn_framed *framed;
  const double *centre, *axis, *w;
  double off, distance; /* distance infinite: orthographic, slopes are offsets */
  double near, deep;    /* from the eye's plane to what is nearest to it and farthest from it */
} extent;

/* The largest slope, to one side (way 1 or -1), at which something is seen from there: the k with reach(way axis + k w) = way off + k D. By secants; the left
   side less the right falls no faster than `deep`, which makes the first step. For looks only: a few steps come near enough. */
static double slope(const extent *e, double way, double from) {
  double k = from, last_k = from, last = 0;
  for (int step = 0; step < SLOPE_STEPS; step++) {
    double v[3];
    for (int i = 0; i < 3; i++) {
      v[i] = way * e->axis[i] + (isinf(e->distance) ? 0 : k * e->w[i]);
    }
    const double reach = qn_framed_reach(e->framed, e->centre, v) - way * e->off;
    if (isinf(e->distance)) {
      return reach;
    }
    const double excess = reach - k * e->distance, fall = step ? (excess - last) / (last_k - k) : e->deep;
    if (excess == 0 || !(fall > 0)) {
      break;
    }
    last = excess, last_k = k;
    k += excess / fall;
  }
  return k;
}

/* Moves the eye along one direction of the picture until what it sees is as far from one edge as from the other, within the
   range [low, high] that keeps all of it in the picture: by secants too. A move by d changes a slope by d / depth. */
static double centred(extent e, double low, double high) {
  double more = 0, less = 0, last_off = e.off, last = 0;
  for (int step = 0; step < CENTRING_STEPS && low < high; step++) {
    more = slope(&e, 1, more), less = slope(&e, -1, less);
    const double uneven = more - less, fall = step ? (uneven - last) / (last_off - e.off) : isinf(e.distance) ? 2 : 2 / e.near;
    if (uneven == 0 || !(fall > 0)) {
      break;
    }
    last = uneven, last_off = e.off;
    e.off = fmin(high, fmax(low, e.off + uneven / fall));
  }
  return e.off;
}

void quoin_camera_default(const quoin_scene *scene, double aspect, quoin_projection projection, quoin_camera *out) {
  quoin_camera_fit(scene, aspect, projection, 0, out);
}

void quoin_camera_fit(const quoin_scene *scene, double aspect, quoin_projection projection, double fov, quoin_camera *out) {
  const qn_view *said = &scene->model->view;
  quoin_camera c = {.up = {0, 0, 1}, .fov = fov > 0 && fov < 180 ? fov : said->has_fov ? said->fov : DEFAULT_FOV, .projection = projection};
  if (!(aspect > 0) || !isfinite(aspect)) {
    aspect = 1;
  }
  double min[3], max[3], along[3], centre[3], r[3], u[3], f[3], w[3];
  box_to_frame(scene, min, max);
  for (int i = 0; i < 3; i++) {
    centre[i] = max[i] / 2 + min[i] / 2;
    along[i] = -view_from[i];
  }
  qn_framed framed;
  qn_framed_make(scene, min, max, &framed);
  (void)make_frame(along, c.up, r, u, f); /* it is one: neither is zero */
  const int flat = projection == QUOIN_ORTHOGRAPHIC;
  const double s = FRAME_FILL * tangent(c.fov / 2), as = aspect * s;
  double axes[6][3], m[6]; /* A and B to the right, A and B upwards, and how far it reaches towards the eye and away from it */
  for (int i = 0; i < 3; i++) {
    w[i] = -f[i];
    /* NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult): make_frame wrote them */
    axes[0][i] = r[i] + (flat ? 0 : as * w[i]);
    axes[1][i] = -r[i] + (flat ? 0 : as * w[i]);
    axes[2][i] = u[i] + (flat ? 0 : s * w[i]);
    axes[3][i] = -u[i] + (flat ? 0 : s * w[i]);
    axes[4][i] = w[i];
    axes[5][i] = f[i];
  }
  for (int k = 0; k < 6; k++) {
    m[k] = qn_framed_reach(&framed, centre, axes[k]);
  }
  double distance = fmax((m[0] + m[1]) / (2 * as), (m[2] + m[3]) / (2 * s));
  distance = distance > 0 ? distance : 1;
  const extent across = {&framed, centre, r, w, (m[0] - m[1]) / 2, flat ? INFINITY : distance, distance - m[4], distance + m[5]};
  const extent upwards = {&framed, centre, u, w, (m[2] - m[3]) / 2, flat ? INFINITY : distance, distance - m[4], distance + m[5]};
  const double p = centred(across, m[0] - as * distance, as * distance - m[1]);
  const double q = centred(upwards, m[2] - s * distance, s * distance - m[3]);
  /* Orthographic: the distance from eye to look gives the size; the eye stands clear of the box whatever that is. */
  const double clear = flat ? m[4] + distance : distance;
  for (int i = 0; i < 3; i++) {
    c.eye[i] = centre[i] + p * r[i] + q * u[i] - clear * f[i];
    c.look[i] = c.eye[i] + distance * f[i];
  }
  *out = c;
}

void qn_camera_of_scene(const quoin_scene *scene, double aspect, quoin_camera *out) {
  const qn_view *said = &scene->model->view;
  quoin_camera_default(scene, aspect, said->has_projection && said->orthographic ? QUOIN_ORTHOGRAPHIC : QUOIN_PERSPECTIVE, out);
  if (!said->has_camera) {
    return;
  }
  double min[3], max[3];
  box_to_frame(scene, min, max);
  for (int i = 0; i < 3; i++) {
    out->eye[i] = said->eye[i];
    out->look[i] = said->has_look ? said->look[i] : max[i] / 2 + min[i] / 2;
    if (said->has_up) {
      out->up[i] = said->up[i];
    }
  }
  out->near = said->near;
}
