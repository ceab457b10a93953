/* Laws of sets (design S5): what is one solid is written in two ways, and every ray and point must be answered alike. */
#include "laws.h"

/* Something large to take away from; it need not hold the operands. */
static const char *world(const trial *t) {
  static const char *const worlds[] = {"cube(4000, center=true);\n", "sphere(3000);\n", "union() { halfspace(n=[1,0,0],d=0); halfspace(n=[-1,0,0],d=0); }\n",
                                       "union() { halfspace(n=[0,1,1],d=1); halfspace(n=[0,-1,-1],d=-1); }\n"};
  return worlds[t->seed % 4];
}
static const char SPACE[] = "union() { halfspace(n=[1,0,0],d=0); halfspace(n=[-1,0,0],d=0); }\n";

/* The two texts of the trial are one solid. */
static void compare(trial *t, const char *what) {
  scene a, b;
  if (!scene_open(t, t->first.at, 1, &a)) {
    return;
  }
  if (scene_open(t, t->second.at, 1, &b)) {
    for (size_t i = 0; i < t->n && !t->wrong; i++) {
      const quoin_ray *r = &t->rays[i];
      said x, y;
      ask_one(&a, r, &x);
      ask_one(&b, r, &y);
      alike(t, &x, &y, SAME_T, what, r);
      for (size_t e = 0; e <= 2 * x.n && e < ENDS && e < 5 && !t->wrong; e++) { /* the origin, and places of ends, which on the lattice are often exact */
        double p[3], at = e == 0 ? 0 : x.end[e - 1].t;
        quoin_side s1 = QUOIN_OUTSIDE, s2 = QUOIN_OUTSIDE;
        if (!isfinite(at)) {
          continue;
        }
        for (int k = 0; k < 3; k++) {
          p[k] = r->o[k] + at * r->d[k];
        }
        t->checks++;
        if (!isfinite(p[0] + p[1] + p[2])) {
          continue;
        }
        if (quoin_point_side(a.scene, a.work, p, &s1) != QUOIN_OK || quoin_point_side(b.scene, b.work, p, &s2) != QUOIN_OK || s1 != s2) {
          blame(t, "%s: the side of %.17g %.17g %.17g: %d, %d", what, p[0], p[1], p[2], (int)s1, (int)s2);
        }
      }
    }
    t->asked += 2 * t->n;
    scene_close(&b);
  }
  scene_close(&a);
}

/* Writes a text: 'A', 'B', 'C' are the operands, 'W' something large, 'S' all of space, '+' '-' '*' open a union, difference, intersection, ')' closes. */
static void write_as(text *out, const trial *t, const char *form) {
  clear_text(out);
  for (const char *c = form; *c; c++) {
    switch (*c) {
    case 'A': case 'B': case 'C': put_operand(out, t, *c - 'A'); break;
    case 'W': put(out, "%s", world(t)); break;
    case 'S': put(out, "%s", SPACE); break;
    case '+': put(out, "union() {\n"); break;
    case '-': put(out, "difference() {\n"); break;
    case '*': put(out, "intersection() {\n"); break;
    default: put(out, "}\n");
    }
  }
}
static void both(trial *t, const char *what, const char *first, const char *second) {
  write_as(&t->first, t, first);
  write_as(&t->second, t, second);
  compare(t, what);
}
static void pick(trial *t, const char *what, const char *const (*pairs)[2], size_t n) {
  size_t k = (t->seed >> 8) % n;
  both(t, what, pairs[k][0], pairs[k][1]);
}

static void de_morgan(trial *t) {
  static const char *const pairs[][2] = {{"-W+AB))", "*-WA)-WB))"}, {"-W*AB))", "+-WA)-WB))"}, {"-W+ABC))", "*-WA)-WB)-WC))"}, {"-W-AB))", "+-WA)*WB))"}};
  pick(t, "De Morgan", pairs, sizeof pairs / sizeof *pairs);
}
static void distribution(trial *t) {
  static const char *const pairs[][2] = {{"*A+BC))", "+*AB)*AC))"}, {"+A*BC))", "*+AB)+AC))"}, {"-A+BC))", "--AB)C)"}, {"-A+BC))", "*-AB)-AC))"},
                                         {"-A*BC))", "+-AB)-AC))"}, {"-+AB)C)", "+-AC)-BC))"}, {"-*AB)C)", "*-AC)B)"}, {"-A-BC))", "+-AB)*AC))"}};
  pick(t, "distribution", pairs, sizeof pairs / sizeof *pairs);
}
static void absorption(trial *t) {
  static const char *const pairs[][2] = {{"+A*AB))", "A"}, {"*A+AB))", "A"}, {"+AA)", "A"}, {"*AA)", "A"}, {"+-AB)*AB))", "A"}, {"+-AB)B)", "+AB)"}, {"--AB)B)", "-AB)"}, {"*-AB)B)", "-AA)"},
                                         {"-A-AB))", "*AB)"}, {"-+AB)*AB))", "+-AB)-BA))"}, {"*A-SB))", "-AB)"}, {"-S-SA))", "A"}, {"-W-WA))", "*WA)"}};
  pick(t, "absorption", pairs, sizeof pairs / sizeof *pairs);
}
static void commuting(trial *t) {
  static const char *const pairs[][2] = {{"+A+BC))", "+C+BA))"}, {"*A*BC))", "*C*BA))"}, {"+ABC)", "+B+CA))"}, {"*ABC)", "*B*CA))"}, {"--AB)C)", "--AC)B)"}, {"-ABC)", "-ACB)"}};
  pick(t, "association", pairs, sizeof pairs / sizeof *pairs);
}

/* Nothing is left of a solid minus itself, however it is written. */
static void nothing(trial *t) {
  static const char *const forms[] = {"-AA)", "-A+AB))", "-*AB)A)", "*-AB)-BA))", "*A-WA))"};
  write_as(&t->first, t, forms[(t->seed >> 8) % 5]);
  scene s;
  if (!scene_open(t, t->first.at, 1, &s)) {
    return;
  }
  for (size_t i = 0; i < t->n && !t->wrong; i++) {
    said x, none = {0};
    quoin_side side;
    ask_one(&s, &t->rays[i], &x);
    alike(t, &x, &none, SAME_T, "a solid minus itself", &t->rays[i]);
    if (quoin_point_side(s.scene, s.work, t->rays[i].o, &side) != QUOIN_OK || side != QUOIN_OUTSIDE) {
      blame(t, "a solid minus itself: the side of %.17g %.17g %.17g", t->rays[i].o[0], t->rays[i].o[1], t->rays[i].o[2]);
    }
  }
  t->asked += t->n;
  scene_close(&s);
}

/* Inside, boundary and the complement's inside tile the range. */
static void complement(trial *t) {
  write_as(&t->first, t, "A");
  write_as(&t->second, t, "-SA)");
  scene a, b;
  if (!scene_open(t, t->first.at, 1, &a)) {
    return;
  }
  if (scene_open(t, t->second.at, 1, &b)) {
    for (size_t i = 0; i < t->n && !t->wrong; i++) {
      const quoin_ray *r = &t->rays[i];
      said x, y;
      ask_one(&a, r, &x);
      ask_one(&b, r, &y);
      t->checks++;
      size_t at[4] = {0}, total = 2 * (x.n + y.n + x.boundary), used = 0;
      const quoin_end *of[3] = {x.end, y.end, x.side};
      size_t n[3] = {2 * x.n, 2 * y.n, 2 * x.boundary};
      double place = r->from;
      int bad = x.status != QUOIN_OK || y.status != QUOIN_OK || x.boundary != y.boundary;
      if (total > ENDS || r->from == r->to) {
        continue;
      }
      for (size_t e = 0; e < 2 * x.boundary && !bad; e++) {
        bad = memcmp(&x.side[e].t, &y.side[e].t, sizeof x.side[e].t) != 0;
      }
      while (!bad && used < total) { /* some list goes on where the last stretch ended; several may, with stretches that round to nothing */
        int next = -1;
        for (int k = 0; k < 3; k++) {
          if (at[k] < n[k] && of[k][at[k]].t == place && (next < 0 || of[k][at[k] + 1].t < of[next][at[next] + 1].t)) {
            next = k;
          }
        }
        bad = next < 0;
        if (!bad) {
          place = of[next][at[next] + 1].t, at[next] += 2, used += 2;
        }
      }
      if (bad || place != r->to) {
        alike(t, &x, &y, SAME_T, "inside, boundary and complement do not tile the ray", r);
        blame(t, "inside, boundary and complement do not tile the ray");
      }
      quoin_side s1 = QUOIN_OUTSIDE, s2 = QUOIN_OUTSIDE;
      if (quoin_point_side(a.scene, a.work, r->o, &s1) != QUOIN_OK || quoin_point_side(b.scene, b.work, r->o, &s2) != QUOIN_OK || s1 + s2 != 2) {
        blame(t, "complement: the side of %.17g %.17g %.17g: %d, %d", r->o[0], r->o[1], r->o[2], (int)s1, (int)s2);
      }
    }
    t->asked += 2 * t->n;
    scene_close(&b);
  }
  scene_close(&a);
}

const law SET_LAWS[] = {{"De Morgan", de_morgan, 0}, {"distribution", distribution, 0}, {"absorption", absorption, 0},
                        {"association", commuting, 0}, {"nothing", nothing, 0}, {"complement", complement, 0}};
const size_t SET_COUNT = sizeof SET_LAWS / sizeof *SET_LAWS;
