/* The built-in functions of numbers and vectors. Angles are degrees. Exact where the result is rational (number/num.h). */
#include "base/limits.h"
#include "model/evaluate.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct call {
  qn_evaluator *ev;
  qn_ctx *ctx;
  const struct row *row;
  uint32_t offset, length;
  const qn_value *a;
  size_t n;
} call;

typedef struct row {
  const char *name;
  int least, most; /* arguments; most < 0: any number */
  qn_value (*make)(const call *c);
  const char *takes;
} row;

static qn_value wrong(const call *c, const char *reason) {
  for (size_t i = 0; i < c->n; i++) {
    if (c->a[i].kind == QN_V_BAD) {
      return QN_BAD;
    }
  }
  char got[200] = "";
  size_t at = 0;
  for (size_t i = 0; i < c->n && at + 20 < sizeof got; i++) {
    at += (size_t)snprintf(got + at, sizeof got - at, "%s%s", i ? ", " : "", qn_value_what(c->a[i]));
  }
  char text[300];
  snprintf(text, sizeof text, "it takes %s", c->row->takes);
  qn_tell(c->ev->reporter, QN_Q0307, c->offset, c->length, reason ? reason : text, NULL, "%s(%s) is not defined", c->row->name, got);
  return QN_BAD;
}

static qn_value special(double d) {
  return (qn_value){.kind = QN_V_SPECIAL, .u.special = d};
}
static qn_value number(qn_num n) {
  return qn_value_number(n);
}

/* Functions of one number: exact on finite ones; `beyond` on inf, -inf, nan, through doubles, whose finite results (0, 90,
   -90, -1, 1) are exact. */
static qn_value of_one(const call *c, qn_value (*exact)(qn_ctx *, qn_num), double (*beyond)(double)) {
  if (c->a[0].kind == QN_V_NUMBER) {
    return exact(c->ctx, c->a[0].u.number);
  }
  return c->a[0].kind == QN_V_SPECIAL ? qn_value_double(c->ctx, beyond(c->a[0].u.special)) : wrong(c, NULL);
}

static double none(double x) {
  (void)x;
  return (double)NAN;
}
static double same(double x) {
  return x;
}
static double right_angle(double x) {
  return isnan(x) ? x : x > 0 ? 90.0 : -90.0;
}
static double unit(double x) {
  return isnan(x) ? x : x > 0 ? 1.0 : -1.0;
}

static qn_value x_sqrt(qn_ctx *ctx, qn_num a) {
  return qn_num_sign(a) < 0 ? special((double)NAN) : number(qn_num_sqrt(ctx, a));
}
static qn_value x_sin(qn_ctx *ctx, qn_num a) { return number(qn_num_sin(ctx, a)); }
static qn_value x_cos(qn_ctx *ctx, qn_num a) { return number(qn_num_cos(ctx, a)); }
static qn_value x_tan(qn_ctx *ctx, qn_num a) {
  qn_num out;
  if (qn_num_tan(ctx, a, &out)) {
    return number(out);
  }
  return special(qn_num_sign(qn_num_sin(ctx, a)) * (double)INFINITY); /* 90: inf, 270: -inf, as OpenSCAD */
}
static int within_one(qn_ctx *ctx, qn_num a) {
  return qn_num_cmp(ctx, qn_num_abs(ctx, a), QN_NUM_ONE) <= 0;
}
static qn_value x_asin(qn_ctx *ctx, qn_num a) {
  return within_one(ctx, a) ? number(qn_num_asin(ctx, a)) : special((double)NAN);
}
static qn_value x_acos(qn_ctx *ctx, qn_num a) {
  return within_one(ctx, a) ? number(qn_num_acos(ctx, a)) : special((double)NAN);
}
static qn_value x_atan(qn_ctx *ctx, qn_num a) { return number(qn_num_atan(ctx, a)); }
static qn_value x_exp(qn_ctx *ctx, qn_num a) { return number(qn_num_exp(ctx, a)); }
static qn_value x_ln(qn_ctx *ctx, qn_num a) {
  int sign = qn_num_sign(a);
  return sign > 0 ? number(qn_num_ln(ctx, a)) : special(sign ? (double)NAN : -(double)INFINITY);
}
static qn_value x_log(qn_ctx *ctx, qn_num a) {
  if (a.kind == QN_NUM_SMALL && a.u.m == 1 && a.a == a.b) { /* a power of ten */
    return number(qn_num_from_int(ctx, a.a));
  }
  qn_value ln = x_ln(ctx, a);
  return ln.kind == QN_V_NUMBER ? number(qn_num_div(ctx, ln.u.number, qn_num_ln(ctx, qn_num_from_int(ctx, 10)))) : ln;
}
static qn_value x_abs(qn_ctx *ctx, qn_num a) { return number(qn_num_abs(ctx, a)); }
static qn_value x_sign(qn_ctx *ctx, qn_num a) { return number(qn_num_from_int(ctx, qn_num_sign(a))); }
static qn_value x_floor(qn_ctx *ctx, qn_num a) { return number(qn_num_floor(ctx, a)); }
static qn_value x_ceil(qn_ctx *ctx, qn_num a) { return number(qn_num_ceil(ctx, a)); }
static qn_value x_round(qn_ctx *ctx, qn_num a) { return number(qn_num_round(ctx, a)); }
static qn_value x_rounded(qn_ctx *ctx, qn_num a) {
  qn_rat r = qn_num_rat(ctx, a);
  return number(qn_num_from_rat(ctx, r.num, r.den, 1));
}

static qn_value f_sqrt(const call *c) { return of_one(c, x_sqrt, sqrt); }
static qn_value f_sin(const call *c) { return of_one(c, x_sin, none); }
static qn_value f_cos(const call *c) { return of_one(c, x_cos, none); }
static qn_value f_tan(const call *c) { return of_one(c, x_tan, none); }
static qn_value f_asin(const call *c) { return of_one(c, x_asin, none); }
static qn_value f_acos(const call *c) { return of_one(c, x_acos, none); }
static qn_value f_atan(const call *c) { return of_one(c, x_atan, right_angle); }
static qn_value f_exp(const call *c) { return of_one(c, x_exp, exp); }
static qn_value f_ln(const call *c) { return of_one(c, x_ln, log); }
static qn_value f_log(const call *c) { return of_one(c, x_log, log); }
static qn_value f_abs(const call *c) { return of_one(c, x_abs, fabs); }
static qn_value f_sign(const call *c) { return of_one(c, x_sign, unit); }
static qn_value f_floor(const call *c) { return of_one(c, x_floor, same); }
static qn_value f_ceil(const call *c) { return of_one(c, x_ceil, same); }
static qn_value f_round(const call *c) { return of_one(c, x_round, same); }
static qn_value f_rounded(const call *c) { return of_one(c, x_rounded, same); }

static qn_value f_pow(const call *c) {
  if (!qn_value_is_number(c->a[0]) || !qn_value_is_number(c->a[1])) {
    return wrong(c, NULL);
  }
  return qn_number_operate(c->ctx, QN_OP_POWER, c->a[0], c->a[1]);
}

static qn_value f_atan2(const call *c) {
  if (!qn_value_is_number(c->a[0]) || !qn_value_is_number(c->a[1])) {
    return wrong(c, NULL);
  }
  if (c->a[0].kind == QN_V_NUMBER && c->a[1].kind == QN_V_NUMBER) {
    return number(qn_num_atan2(c->ctx, c->a[0].u.number, c->a[1].u.number));
  }
  double v[2];
  for (int i = 0; i < 2; i++) {
    v[i] = c->a[i].kind == QN_V_SPECIAL ? c->a[i].u.special : qn_num_sign(c->a[i].u.number);
  }
  /* With an infinity the angle is a multiple of 45 degrees: eighths of a turn, counted. */
  double eighths = atan2(v[0], v[1]) / atan2(1.0, 1.0);
  return isnan(eighths) ? special((double)NAN) : number(qn_num_from_int(c->ctx, 45 * (int64_t)round(eighths)));
}

static qn_value extreme(const call *c, int want) {
  const qn_value *v = c->a;
  size_t n = c->n;
  if (n == 1 && v[0].kind == QN_V_VECTOR) {
    n = v[0].count;
    v = v[0].u.items;
  }
  if (n == 0) {
    return wrong(c, "there is nothing to choose from");
  }
  if (!qn_ctx_spend(c->ctx, n, QN_EFFORT_ELEMENT / 4)) {
    return QN_BAD;
  }
  for (size_t i = 0; i < n; i++) {
    if (!qn_value_is_number(v[i])) {
      return wrong(c, NULL);
    }
  }
  qn_value best = v[0];
  for (size_t i = 1; i < n; i++) {
    int order = qn_number_compare(c->ctx, v[i], best);
    if (order == want) {
      best = v[i];
    }
  }
  return best;
}
static qn_value f_min(const call *c) { return extreme(c, -1); }
static qn_value f_max(const call *c) { return extreme(c, 1); }

static qn_value f_len(const call *c) {
  size_t n = c->a[0].count;
  if (c->a[0].kind == QN_V_STRING) {
    n = 0;
    qn_ctx_spend(c->ctx, c->a[0].count, QN_EFFORT_BYTE);
    for (size_t i = 0; i < c->a[0].count; i++) {
      n += ((unsigned char)c->a[0].u.text[i] & 0xC0) != 0x80;
    }
  } else if (c->a[0].kind != QN_V_VECTOR) {
    return wrong(c, NULL);
  }
  return number(qn_num_from_int(c->ctx, (int64_t)n));
}

static qn_value f_norm(const call *c) {
  qn_value v = c->a[0];
  if (v.kind != QN_V_VECTOR) {
    return wrong(c, NULL);
  }
  for (size_t i = 0; i < v.count; i++) {
    if (!qn_value_is_number(v.u.items[i])) {
      return wrong(c, NULL);
    }
  }
  if (v.count == 0) {
    return number(QN_NUM_ZERO);
  }
  qn_value square = qn_operate(c->ev, QN_OP_MULTIPLY, c->offset, v, v);
  return square.kind == QN_V_NUMBER ? x_sqrt(c->ctx, square.u.number) : square;
}

static qn_value f_cross(const call *c) {
  const qn_value *a = c->a[0].u.items, *b = c->a[1].u.items;
  size_t n = c->a[0].count;
  if (c->a[0].kind != QN_V_VECTOR || c->a[1].kind != QN_V_VECTOR || n != c->a[1].count || (n != 2 && n != 3)) {
    return wrong(c, NULL);
  }
  for (size_t i = 0; i < n; i++) {
    if (a[i].kind != QN_V_NUMBER || b[i].kind != QN_V_NUMBER) {
      return wrong(c, NULL);
    }
  }
  qn_value out[3];
  for (size_t i = 0; i < 3; i++) {
    size_t j = n == 2 ? 0 : (i + 1) % 3, k = n == 2 ? 1 : (i + 2) % 3;
    qn_num x[2] = {a[j].u.number, a[k].u.number}, y[2] = {b[k].u.number, qn_num_neg(c->ctx, b[j].u.number)};
    out[i] = number(qn_num_dot(c->ctx, 2, x, y));
  }
  return n == 2 ? out[0] : qn_value_vector(c->ctx, out, 3);
}

static const char one_number[] = "one number", two_numbers[] = "two numbers";
static const row rows[] = {
  {"sqrt", 1, 1, f_sqrt, one_number},
  {"sin", 1, 1, f_sin, one_number},
  {"cos", 1, 1, f_cos, one_number},
  {"tan", 1, 1, f_tan, one_number},
  {"asin", 1, 1, f_asin, one_number},
  {"acos", 1, 1, f_acos, one_number},
  {"atan", 1, 1, f_atan, one_number},
  {"atan2", 2, 2, f_atan2, two_numbers},
  {"abs", 1, 1, f_abs, one_number},
  {"min", 1, -1, f_min, "numbers, or a vector of numbers"},
  {"max", 1, -1, f_max, "numbers, or a vector of numbers"},
  {"floor", 1, 1, f_floor, one_number},
  {"ceil", 1, 1, f_ceil, one_number},
  {"round", 1, 1, f_round, one_number},
  {"sign", 1, 1, f_sign, one_number},
  {"pow", 2, 2, f_pow, two_numbers},
  {"exp", 1, 1, f_exp, one_number},
  {"ln", 1, 1, f_ln, one_number},
  {"log", 1, 1, f_log, one_number},
  {"len", 1, 1, f_len, "a vector or a string"},
  {"norm", 1, 1, f_norm, "a vector of numbers"},
  {"cross", 2, 2, f_cross, "two vectors of three numbers, or of two"},
  {"rounded", 1, 1, f_rounded, one_number},
};
const size_t qn_function_count = sizeof rows / sizeof rows[0];

static const char *const later[] = {"str",       "chr",       "ord",     "concat",  "lookup",    "rands",  "search",
                                    "version",   "version_num", "is_undef", "is_num", "is_bool", "is_string", "is_list",
                                    "is_function", "parent_module", "dxf_cross", "dxf_dim", "textmetrics", "fontmetrics", "import"};
enum { LATER = sizeof later / sizeof later[0] };

int qn_functions_init(qn_evaluator *ev) {
  for (size_t i = 0; i < qn_function_count; i++) {
    uint32_t name = qn_names_find(&ev->syntax->names, rows[i].name, strlen(rows[i].name));
    if (name == QN_NO_NAME) {
      return 0;
    }
    ev->functions[name] = (uint16_t)(i + 1);
  }
  return 1;
}

const char *qn_functions_near(const char *name) {
  const char *best = NULL;
  unsigned most = strlen(name) <= 3 ? 1 : 2, least = most + 1;
  for (size_t i = 0; i < qn_function_count; i++) {
    unsigned d = qn_names_distance(name, rows[i].name, most);
    if (d < least) {
      least = d;
      best = rows[i].name;
    }
  }
  return best;
}

qn_value qn_call_function(qn_evaluator *ev, uint32_t name, uint32_t offset, const qn_value *arguments, size_t count) {
  const qn_name *text = &ev->syntax->names.items[name];
  if (!ev->functions[name]) {
    if (text->declared || ev->syntax->includes) {
      return QN_BAD; /* told where it was declared */
    }
    for (size_t i = 0; i < LATER; i++) {
      if (strcmp(later[i], text->text) == 0) {
        qn_tell(ev->reporter, QN_Q0304, offset, text->length, NULL, QN_FLATTEN, "the function '%.60s' is not supported yet", text->text);
        return QN_BAD;
      }
    }
    const char *near = ev->words[name] ? NULL : qn_functions_near(text->text);
    char way_out[128] = "docs/language.md lists the functions";
    if (ev->words[name]) {
      snprintf(way_out, sizeof way_out, "solids are not values");
    } else if (near) {
      snprintf(way_out, sizeof way_out, "did you mean '%.60s'?", near);
    }
    qn_tell(ev->reporter, QN_Q0303, offset, text->length, NULL, way_out, "unknown function '%.60s'", text->text);
    return QN_BAD;
  }
  const row *r = &rows[ev->functions[name] - 1];
  call c = {ev, &ev->ctx, r, offset, text->length, arguments, count};
  for (size_t i = 0; i < count; i++) {
    if (arguments[i].kind == QN_V_BAD) {
      return QN_BAD;
    }
  }
  if (count < (size_t)r->least || (r->most >= 0 && count > (size_t)r->most)) {
    return wrong(&c, NULL);
  }
  /* cppcheck-suppress returnDanglingLifetime ; values point into the arena, not into the call */
  return r->make(&c);
}
