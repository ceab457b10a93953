/* Colours, materials, names; camera, lights, background; echo and assert. These numbers are doubles from here on: they
   change what a picture looks like, not where a solid is. */
#include "base/limits.h"
#include "model/words.h"

#include <stdio.h>
#include <string.h>

static int hex_digit(char c) {
  return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/* "#rgb", "#rgba", "#rrggbb", "#rrggbbaa". 1 when it is one. */
static int hex_color(const char *text, size_t length, double rgba[4], int *has_alpha) {
  size_t wide = length == 7 || length == 9 ? 2 : length == 4 || length == 5 ? 1 : 0;
  if (!wide || text[0] != '#') {
    return 0;
  }
  for (size_t i = 0; 1 + i * wide < length; i++) {
    int high = hex_digit(text[1 + i * wide]), low = hex_digit(text[1 + i * wide + wide - 1]);
    if (high < 0 || low < 0) {
      return 0;
    }
    rgba[i] = (high * 16 + low) / 255.0;
    *has_alpha |= i == 3;
  }
  return 1;
}

/* A colour argument into rgba. Returns 1 when it says a colour, 0 when it says none or is in error. */
static int color(qn_call *call, int parameter, double rgba[4]) {
  qn_value v = call->value[parameter];
  rgba[3] = 1;
  if (v.kind == QN_V_STRING) {
    int has_alpha = 0;
    if (qn_color_named(v.u.text, v.count, rgba) || hex_color(v.u.text, v.count, rgba, &has_alpha)) {
      return 1;
    }
    const char *near = qn_color_near(v.u.text);
    char way_out[80] = "write a CSS colour name, \"#rrggbb\" or [r, g, b]";
    if (near) {
      snprintf(way_out, sizeof way_out, "did you mean \"%s\"?", near);
    }
    qn_arg_tell(call, QN_Q0413, parameter, "the colour is left as it is", way_out, "unknown colour \"%.60s\"", v.u.text);
    return 0;
  }
  qn_num n[4] = {QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ZERO, QN_NUM_ONE};
  size_t count = qn_arg_vector(call, parameter, 3, 4, 0, n);
  if (count < 3 || call->not_finite) { /* 0, 3 or 4 */
    return 0;
  }
  for (size_t i = 0; i < count; i++) {
    rgba[i] = qn_arg_finite(call, parameter, n[i]);
  }
  return !(rgba[0] == -1 && rgba[1] == -1 && rgba[2] == -1); /* OpenSCAD's "unset" */
}

static uint32_t wrap(qn_call *call, const qn_material *material) {
  if (call->bad || call->not_finite || !material->has) {
    return qn_make_union(call); /* a colour does not change the solid */
  }
  uint32_t n = qn_solid_material(call->ev->model, material);
  if (n == UINT32_MAX) {
    call->ev->failed = QUOIN_E_MEMORY;
    return QN_NO_NODE;
  }
  return qn_call_node(call, QN_NODE_COLOR, n, NULL, 0);
}

uint32_t qn_make_color(qn_call *call) {
  enum { C, ALPHA };
  qn_material m = {0};
  if (color(call, C, m.color)) {
    m.has = QN_HAS_COLOR;
  }
  if (qn_arg_given(call, ALPHA)) {
    m.color[3] = qn_arg_double(call, ALPHA, 1);
  }
  for (int i = 0; m.has && i < 4; i++) {
    if (!(m.color[i] >= 0 && m.color[i] <= 1)) {
      qn_arg_tell(call, QN_Q0414, i == 3 && qn_arg_given(call, ALPHA) ? ALPHA : C, "red, green, blue and alpha are from 0 to 1", m.color[i] > 1 ? "divide what is from 0 to 255 by 255" : NULL,
                  "a colour's part is %.6g", m.color[i]);
      break;
    }
  }
  return wrap(call, &m);
}

uint32_t qn_make_material(qn_call *call) {
  enum { COLOR, AMBIENT, DIFFUSE, SPECULAR, SHININESS };
  qn_material m = {0};
  if (qn_arg_given(call, COLOR) && color(call, COLOR, m.color)) {
    m.has |= QN_HAS_COLOR;
  }
  double *const to[] = {&m.ambient, &m.diffuse, &m.specular, &m.shininess};
  for (int i = 0; i < 4; i++) {
    if (qn_arg_given(call, AMBIENT + i)) {
      *to[i] = qn_arg_double(call, AMBIENT + i, 0);
      m.has |= (unsigned)QN_HAS_AMBIENT << i;
      if (*to[i] < 0 && !call->bad) {
        qn_arg_tell(call, QN_Q0508, AMBIENT + i, NULL, NULL, "a share of light must not be negative");
      }
    }
  }
  return wrap(call, &m);
}

uint32_t qn_make_name(qn_call *call) {
  enum { NAME };
  size_t length;
  const char *text = qn_arg_string(call, NAME, &length);
  if (!text) {
    if (!call->bad) {
      qn_arg_tell(call, QN_Q0412, -1, NULL, "write name(\"...\")", "the name is missing");
    }
    return qn_make_union(call);
  }
  if (!qn_ctx_spend(&call->ev->ctx, length, QN_EFFORT_NAME)) {
    return QN_NO_NODE;
  }
  uint32_t n = qn_solid_name(call->ev->model, text, length);
  if (n == UINT32_MAX) {
    call->ev->failed = QUOIN_E_MEMORY;
    return QN_NO_NODE;
  }
  return qn_call_node(call, QN_NODE_NAME, n, NULL, 0);
}

/* Three numbers as doubles. 1 when given. */
static int point(qn_call *call, int parameter, double out[3]) {
  qn_num n[3];
  if (!qn_arg_given(call, parameter) || qn_arg_vector(call, parameter, 3, 3, 0, n) != 3 || call->not_finite) {
    return 0;
  }
  for (int i = 0; i < 3; i++) {
    out[i] = qn_arg_finite(call, parameter, n[i]);
  }
  return 1;
}

/* inf and nan have no meaning in a picture. */
static int refused(qn_call *call) {
  if (!call->bad && call->not_finite) {
    qn_arg_tell(call, QN_Q0508, call->not_finite - 1, NULL, NULL, "a number is not finite");
  }
  return call->bad;
}

uint32_t qn_make_camera(qn_call *call) {
  enum { EYE, LOOK, UP, FOV, NEAR, PROJECTION };
  qn_view *old = &call->ev->model->view, v = *old;
  if (!qn_arg_given(call, EYE)) {
    qn_arg_tell(call, QN_Q0412, -1, NULL, "write camera(eye = [x, y, z], look = [x, y, z])", "'eye' is missing");
  }
  v.has_camera = point(call, EYE, v.eye);
  v.has_look = point(call, LOOK, v.look);
  v.has_up = point(call, UP, v.up);
  v.has_fov = qn_arg_given(call, FOV);
  v.fov = qn_arg_double(call, FOV, 0);
  v.near = qn_arg_double(call, NEAR, 0);
  size_t length;
  const char *projection = qn_arg_string(call, PROJECTION, &length);
  v.has_projection = projection != NULL;
  v.orthographic = projection && (strcmp(projection, "ortho") == 0 || strcmp(projection, "orthographic") == 0);
  if (projection && !v.orthographic && strcmp(projection, "persp") != 0 && strcmp(projection, "perspective") != 0) {
    qn_arg_tell(call, QN_Q0508, PROJECTION, NULL, "write \"persp\" or \"ortho\"", "unknown projection \"%.60s\"", projection);
  }
  if (!refused(call) && v.has_fov && !(v.fov > 0 && v.fov < 180)) {
    qn_arg_tell(call, QN_Q0508, FOV, "it is the vertical angle of view, in degrees", NULL, "'fov' must be over 0 and under 180");
  }
  if (!call->bad && v.near < 0) {
    qn_arg_tell(call, QN_Q0508, NEAR, NULL, NULL, "'near' must not be negative");
  }
  if (!call->bad && v.has_look && v.eye[0] == v.look[0] && v.eye[1] == v.look[1] && v.eye[2] == v.look[2]) {
    qn_arg_tell(call, QN_Q0508, LOOK, NULL, NULL, "the camera looks at its own place");
  }
  if (call->bad) {
    return QN_NO_NODE;
  }
  if (old->has_camera && call->ev->camera_here) {
    qn_arg_tell(call, QN_Q0410, -1, "one picture has one camera", NULL, "this camera replaces the one before");
  }
  call->ev->camera_here = 1;
  *old = v;
  return QN_NO_NODE;
}

uint32_t qn_make_light(qn_call *call) {
  enum { AT, COLOR, DIRECTION };
  quoin_model *m = call->ev->model;
  qn_light light = {.color = {1, 1, 1}};
  int at = point(call, AT, light.at);
  light.directional = point(call, DIRECTION, light.direction);
  if (!call->bad && !call->not_finite && at == light.directional) {
    qn_arg_tell(call, QN_Q0412, -1, "a lamp has a place, the sun a direction", NULL,
                at ? "'at' and 'direction' are both given" : "'at' or 'direction' is missing");
  }
  if (!call->bad && light.directional && light.direction[0] == 0 && light.direction[1] == 0 && light.direction[2] == 0) {
    qn_arg_tell(call, QN_Q0508, DIRECTION, "the zero vector has no direction", NULL, "'direction' must not be zero");
  }
  double rgba[4];
  if (qn_arg_given(call, COLOR) && color(call, COLOR, rgba)) {
    memcpy(light.color, rgba, sizeof light.color);
  }
  if (refused(call)) {
    return QN_NO_NODE;
  }
  if (!qn_grow(&m->mem, &m->lights, &m->light_capacity, m->light_count + 1)) {
    call->ev->failed = QUOIN_E_MEMORY;
    return QN_NO_NODE;
  }
  m->lights[m->light_count++] = light;
  return QN_NO_NODE;
}

uint32_t qn_make_background(qn_call *call) {
  enum { COLOR };
  qn_view *v = &call->ev->model->view;
  double rgba[4];
  if (!qn_arg_given(call, COLOR)) {
    qn_arg_tell(call, QN_Q0412, -1, NULL, NULL, "the colour is missing");
  }
  int has = color(call, COLOR, rgba);
  if (refused(call) || !has) {
    return QN_NO_NODE;
  }
  if (v->has_background && call->ev->background_here) {
    qn_arg_tell(call, QN_Q0410, -1, "one picture has one background", NULL, "this background replaces the one before");
  }
  call->ev->background_here = 1;
  v->has_background = 1;
  memcpy(v->background, rgba, sizeof v->background);
  return QN_NO_NODE;
}

/* Children of echo and assert are a group; without any there is no node. */
static uint32_t group(qn_call *call) {
  return call->statement->first == QN_NO_STATEMENT ? QN_NO_NODE : qn_make_union(call);
}

uint32_t qn_make_echo(qn_call *call) {
  qn_evaluator *ev = call->ev;
  char text[600];
  size_t at = 0;
  int bad = 0;
  text[0] = '\0';
  for (uint32_t i = 0; i < call->statement->arguments && at + 1 < sizeof text; i++) {
    qn_argument a = ev->syntax->arguments[call->statement->argument0 + i];
    qn_value v = qn_evaluate_expression(ev, a.from, a.to);
    bad |= v.kind == QN_V_BAD;
    const char *comma = i ? ", " : "", *name = ev->syntax->names.items[a.name].text;
    int n = snprintf(text + at, sizeof text - at, a.name ? "%s%s = " : "%s%s", comma, name);
    at = n >= 0 && at + (size_t)n < sizeof text ? at + (size_t)n : sizeof text - 1;
    qn_value_text(&ev->ctx, v, text + at, sizeof text - at);
    at += strlen(text + at);
  }
  if (!bad) {
    qn_tell(ev->reporter, QN_Q0310, call->statement->offset, 4, NULL, NULL, "echo: %s", text);
  }
  return group(call);
}

uint32_t qn_make_assert(qn_call *call) {
  enum { CONDITION, MESSAGE };
  if (!call->bad && call->value[CONDITION].kind != QN_V_BAD && !qn_value_truth(call->value[CONDITION])) {
    char text[300];
    size_t length;
    const char *message = qn_arg_string(call, MESSAGE, &length);
    snprintf(text, sizeof text, "the assertion failed%s%.200s", message ? ": " : "", message ? message : "");
    qn_arg_tell(call, QN_Q0309, -1, NULL, NULL, "%s", text);
  }
  return group(call);
}
