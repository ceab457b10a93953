/* Cameras: the frustum, and the view that frames a solid.

   Legend: e the eye; f, r, u the unit vectors forward, right and up of the picture; s = tan(fov/2), the half height at
   distance 1; a = width/height, so a s is the half width; (x, y) a place in the picture in [-1, 1], y upwards.
   Perspective:  o = e,                 d = f + x (a s) r + y s u.
   Orthographic: o = e + x (a s D) r + y s D u,  d = f,  with D = |look - eye|: the size that perspective shows at `look`.
   d . f = 1 in both, so a ray's t is the depth.

   Framing. Let c be the box's centre and w = -f. A corner c + v is in the picture of an eye at c + p r + q u + D w when
       |v.r - p| <= a s (D - v.w)   and   |v.u - q| <= s (D - v.w).
   With A = max(v.r + a s v.w) and B = max(-v.r + a s v.w) over the corners, the first holds for all corners when
   a s D >= A - p and a s D >= B + p; the smallest D is (A + B) / (2 a s), with p = (A - B)/2. The same for u. The larger D of the two
   is taken; in the direction that has room left, p may be anything in [A - a s D, a s D - B], and is chosen such that the picture
   is centred. In orthographic views the same holds with v.w left out: the size is the larger half extent, and the eye stands
   clear of the box. */
#include "image/camera.h"
#include "image/vec.h"
#include "scene/scene.h"

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
  f.half_h = tan(camera->fov / 2 * DEGREE);
  f.orthographic = camera->projection == QUOIN_ORTHOGRAPHIC;
  if (f.orthographic) {
    f.half_h *= hypot(hypot(along[0], along[1]), along[2]);
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
  out->few = 0;
  out->new_origins = out->new_directions = 1;
  out->tile = !tiles ? QN_TILE_NONE : f->orthographic ? QN_TILE_ORIGINS : QN_TILE_DIRECTIONS;
}

void qn_frustum_tile(const qn_frustum *f, size_t x, size_t y, size_t x1, size_t y1, qn_packet *out) {
  const unsigned columns = x1 - x < 8 ? (unsigned)(x1 - x) : 8, rows = y1 - y < 8 ? (unsigned)(y1 - y) : 8;
  const double *base = f->orthographic ? f->eye : f->forward;
  for (unsigned i = 0; i < 8; i++) {
    const double across = across_of(f, (double)(x + (i < columns ? i : columns - 1)) + 0.5);
    const double upwards = upwards_of(f, (double)(y + (i < rows ? i : rows - 1)) + 0.5);
    for (int k = 0; k < 3; k++) {
      out->across[k][i] = base[k] + across * f->right[k];
      out->up[k][i] = upwards * f->up[k];
    }
  }
  out->live = ~(uint64_t)0;
  if (columns < 8 || rows < 8) {
    out->live = 0;
    for (unsigned lane = 0; lane < QN_LANES; lane++) {
      out->live |= (uint64_t)(qn_lane_column(lane) < columns && qn_lane_row(lane) < rows) << lane;
    }
  }
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

/* The boxes that hold a solid more closely than its own: those of its leaves, clipped to it. A leaf whose outside is meant holds
   nothing: a bounded solid lies in its other leaves. Calls visit with each; with the whole box when there are none. */
static void each_box(const quoin_scene *scene, const double min[3], const double max[3],
                     void (*visit)(void *user, const double min[3], const double max[3]), void *user) {
  size_t boxes = 0;
  for (size_t l = 0; l < scene->leaf_count && !scene->empty; l++) {
    double low[3], high[3];
    int some = !scene->leaves[l].negated;
    for (int i = 0; i < 3; i++) {
      low[i] = fmax(min[i], scene->leaves[l].min[i]);
      high[i] = fmin(max[i], scene->leaves[l].max[i]);
      some = some && low[i] <= high[i];
    }
    if (some) {
      visit(user, low, high);
      boxes++;
    }
  }
  if (boxes == 0) {
    visit(user, min, max);
  }
}

/* The maxima of the derivation over all corners: A and B to the right, A and B upwards, and how far the boxes reach towards the eye. */
typedef struct reach {
  double centre[3], axes[5][3], most[5];
} reach;

static void reach_box(void *user, const double min[3], const double max[3]) {
  reach *r = user;
  for (int k = 0; k < 5; k++) {
    double sum = 0;
    for (int i = 0; i < 3; i++) {
      sum += fmax(r->axes[k][i] * (min[i] - r->centre[i]), r->axes[k][i] * (max[i] - r->centre[i]));
    }
    r->most[k] = fmax(r->most[k], sum);
  }
}

/* The picture's extent in one direction as seen from an eye that is `off` along it: the largest slopes to either side. */
typedef struct extent {
  const double *centre, *axis, *w;
  double off, distance; /* distance infinite: orthographic, slopes are offsets */
  double more, less;
} extent;

static void extent_box(void *user, const double min[3], const double max[3]) {
  extent *e = user;
  for (int k = 0; k < 8; k++) {
    double along = 0, towards = 0;
    for (int i = 0; i < 3; i++) {
      const double v = (k >> i & 1 ? max[i] : min[i]) - e->centre[i];
      along += v * e->axis[i];
      towards += v * e->w[i];
    }
    const double slope = (along - e->off) / (isinf(e->distance) ? 1 : e->distance - towards);
    e->more = fmax(e->more, slope);
    e->less = fmax(e->less, -slope);
  }
}

enum { CENTRING_STEPS = 4 };
/* Moves the eye along one direction of the picture until what it sees is as far from one edge as from the other, within the
   range [low, high] that keeps all of it in the picture: a fixed-point iteration that needs no more than a few steps, for looks only. */
static double centred(const quoin_scene *scene, const double min[3], const double max[3], extent e, double low, double high) {
  for (int step = 0; step < CENTRING_STEPS && low < high; step++) {
    e.more = e.less = -INFINITY;
    each_box(scene, min, max, extent_box, &e);
    e.off = fmin(high, fmax(low, e.off + (e.more - e.less) / 2 * (isinf(e.distance) ? 1 : e.distance)));
  }
  return e.off;
}

void quoin_camera_default(const quoin_scene *scene, double aspect, quoin_projection projection, quoin_camera *out) {
  const qn_view *said = &scene->model->view;
  quoin_camera c = {.up = {0, 0, 1}, .fov = said->has_fov ? said->fov : DEFAULT_FOV, .projection = projection};
  if (!(aspect > 0) || !isfinite(aspect)) {
    aspect = 1;
  }
  double min[3], max[3], along[3], r[3], u[3], f[3], w[3];
  reach fit = {.most = {-INFINITY, -INFINITY, -INFINITY, -INFINITY, -INFINITY}};
  box_to_frame(scene, min, max);
  for (int i = 0; i < 3; i++) {
    fit.centre[i] = max[i] / 2 + min[i] / 2;
    along[i] = -view_from[i];
  }
  make_frame(along, c.up, r, u, f);
  const int flat = projection == QUOIN_ORTHOGRAPHIC;
  const double s = FRAME_FILL * tan(c.fov / 2 * DEGREE), as = aspect * s;
  for (int i = 0; i < 3; i++) {
    w[i] = -f[i];
    fit.axes[0][i] = r[i] + (flat ? 0 : as * w[i]);
    fit.axes[1][i] = -r[i] + (flat ? 0 : as * w[i]);
    fit.axes[2][i] = u[i] + (flat ? 0 : s * w[i]);
    fit.axes[3][i] = -u[i] + (flat ? 0 : s * w[i]);
    fit.axes[4][i] = w[i];
  }
  each_box(scene, min, max, reach_box, &fit);
  const double *m = fit.most;
  double distance = fmax((m[0] + m[1]) / (2 * as), (m[2] + m[3]) / (2 * s));
  distance = distance > 0 ? distance : 1;
  const extent across = {fit.centre, r, w, (m[0] - m[1]) / 2, flat ? INFINITY : distance, 0, 0};
  const extent upwards = {fit.centre, u, w, (m[2] - m[3]) / 2, flat ? INFINITY : distance, 0, 0};
  const double p = centred(scene, min, max, across, m[0] - as * distance, as * distance - m[1]);
  const double q = centred(scene, min, max, upwards, m[2] - s * distance, s * distance - m[3]);
  /* Orthographic: the distance from eye to look gives the size; the eye stands clear of the box whatever that is. */
  const double clear = flat ? m[4] + distance : distance;
  for (int i = 0; i < 3; i++) {
    c.eye[i] = fit.centre[i] + p * r[i] + q * u[i] - clear * f[i];
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
