/* Rows of round pieces: evened out by powers of two alone, and nothing of the leaf is beyond their reach. Where the pieces of terms lie. */
#include "base/bounds.h"
#include "reading.h"
#include "scene/piece.h"
#include "share.h"

#include <math.h>

static uint64_t state = 0x243f6a8885a308d3u;
static double unit(void) {
  state ^= state << 13, state ^= state >> 7, state ^= state << 17;
  return (double)((state * 0x2545F4914F6CDD1Du) >> 11) * 0x1p-53;
}

static double value_of(const double row[4], const double x[3], const double pivot[3]) {
  return row[0] * (x[0] - pivot[0]) + row[1] * (x[1] - pivot[1]) + row[2] * (x[2] - pivot[2]) + row[3];
}

/* The power of two that b is a's product with. */
static int is_power(double a, double b, int *power) {
  *power = a != 0 && b != 0 ? ilogb(b) - ilogb(a) : *power;
  return ldexp(a, *power) == b;
}

enum { FORMS = 8 };
static void write(char *text, size_t room, int form, double size) {
  static const char *const FORM[FORMS] = {
    "cylinder(base=[%.17g,%.17g,%.17g],axis=[%.17g,%.17g,%.17g],r=%.17g,h=%.17g);",
    "translate([%.17g,%.17g,%.17g]) multmatrix([[1,%.17g,0,0],[0,1,%.17g,0],[%.17g,0,1,0]]) cylinder(r=%.17g,h=%.17g);",
    "translate([%.17g,%.17g,%.17g]) scale([%.17g,%.17g,%.17g]) cylinder(r=%.17g,h=%.17g);",
    "paraboloid(base=[%.17g,%.17g,%.17g],axis=[%.17g,%.17g,%.17g],r=%.17g,h=%.17g);",
    "translate([%.17g,%.17g,%.17g]) rotate([%.17g,%.17g,%.17g]) cylinder(r1=%.17g,r2=0.1,h=%.17g);",
    "translate([%.17g,%.17g,%.17g]) rotate([%.17g,%.17g,%.17g]) ellipsoid(r=[%.17g,%.17g,1]);",
    "translate([%.17g,%.17g,%.17g]) rotate([%.17g,%.17g,%.17g]) cylinder(r=[%.17g,%.17g],h=3);",
    "translate([%.17g,%.17g,%.17g]) rotate([%.17g,%.17g,%.17g]) hyperboloid(r=%.17g,rc=0.01,h=%.17g);"};
  snprintf(text, room, FORM[form], unit(), unit(), unit(), size * (0.1 + unit()), size * (0.1 + unit()), size * (0.1 + unit()), size * (0.1 + unit()), size * (0.1 + unit()));
}

static void rounds(void **s) {
  (void)s;
  size_t pieces = 0, evened = 0, inside = 0;
  double fullest = 0, unevened = 0;
  for (int n = 0; n < share_of(4000); n++) {
    char text[1000];
    const int form = n % FORMS;
    write(text, sizeof text, form, n % 3 == 0 ? 1 : n % 3 == 1 ? 100 : 0.01);
    quoin_scene *scene = scene_of(text);
    const qn_leaf *leaf = &scene->leaves[0];
    const qn_piece_head *head = (const qn_piece_head *)scene->lines;
    if (head->kind != QN_PIECE_ROUND) {
      quoin_scene_free(scene);
      continue;
    }
    const qn_piece_round *p = (const qn_piece_round *)(const void *)head;
    const qn_quadric_shadow *q = NULL;
    for (uint32_t h = leaf->half0; h < leaf->half0 + leaf->halves; h++) {
      q = scene->halves[h].kind == QN_QUADRIC_BODY ? &scene->quadrics[scene->halves[h].shadow] : q;
    }
    assert_non_null(q);
    pieces++;
    int changed = 0;
    for (int i = 0; i < 3; i++) { /* s X^2 and l X_2 are as they were */
      int power = 0, of_s = 0, of_l = 0;
      for (int j = 0; j < 4; j++) {
        assert_true(is_power(q->row[i][j], p->row[i][j], &power));
      }
      assert_true(is_power(q->s[i], p->s[i], &of_s) && (q->s[i] == 0 || of_s == -2 * power));
      assert_true(i != 2 || (is_power(q->l, p->l, &of_l) && (q->l == 0 || of_l == -power)));
      assert_true(p->s[i] == 0 || (fabs(p->s[i]) >= 0.5 && fabs(p->s[i]) < 2));
      changed |= power != 0;
      unevened = fmax(unevened, fabs(q->s[i]));
    }
    double length[3], shortest = INFINITY;
    for (int i = 0; i < 3; i++) {
      length[i] = sqrt(p->row[i][0] * p->row[i][0] + p->row[i][1] * p->row[i][1] + p->row[i][2] * p->row[i][2]);
      shortest = p->s[i] != 0 ? fmin(shortest, length[i]) : shortest;
    }
    for (int i = 0; i < 3; i++) { /* a row without a part in the form */
      assert_true(p->s[i] != 0 || (i == 2 && p->l != 0) || (length[i] > 0.2499 * shortest && length[i] < 0.5001 * shortest));
    }
    evened += (size_t)changed;
    assert_true(p->k == q->k);
    for (int i = 0; i < 400; i++) {
      double x[3], form_value = p->k, far = 0;
      for (int j = 0; j < 3; j++) {
        x[j] = leaf->min[j] + unit() * (leaf->max[j] - leaf->min[j]);
      }
      int in = 1;
      for (int c = 0; c < 2; c++) {
        in &= p->surface[1 + c] == UINT32_MAX || value_of(p->cap[c], x, p->pivot) <= 0;
      }
      for (int j = 0; j < 3; j++) {
        const double X = value_of(p->row[j], x, p->pivot);
        form_value += p->s[j] * X * X + (j == 2 ? 2 * p->l * X : 0);
        far += X * X;
      }
      if (in && form_value <= 0) {
        inside++;
        assert_true(sqrt(far) <= p->reach);
        fullest = fmax(fullest, sqrt(far) / p->reach);
      }
    }
    quoin_scene_free(scene);
  }
  print_message("%zu round pieces, %zu evened, largest |s| before %g; %zu points in them, the farthest at %.3f of the reach\n", pieces, evened, unevened, inside, fullest);
  assert_true(pieces > share_min(2500) && evened > share_min(1000) && unevened > share_min(1000) && inside > share_min(100000) && (!share_whole() || fullest > 0.9));
}

typedef struct row { const char *child; int many; } row;

/* Children in rows, one behind another along x. */
static void write_rows(char *text, size_t room, const char *head, const row *rows, size_t count, const char *tail) {
  size_t used = (size_t)snprintf(text, room, "%s", head);
  for (size_t r = 0; r < count; r++) {
    for (int i = 0; i < rows[r].many; i++) {
      used += (size_t)snprintf(text + used, room - used, "translate([%d,%zu,0]) %s", 5 * i, 9 * r, rows[r].child);
    }
  }
  assert_true(used + strlen(tail) < room);
  memcpy(text + used, tail, strlen(tail) + 1);
}

/* Terms in a run are found by counting, the others in the table: both as the normal form has them. */
static void lines_of_terms(void **s) {
  (void)s;
  static const char BALL[] = "sphere(1);", BOX[] = "cube(1);", ROUND[] = "cylinder(r=1,h=3);", CUT[] = "difference(){cube(2);sphere(1);}", BOTH[] = "intersection(){sphere(2);cube(3);}";
  static const struct { const char *head, *tail; row rows[3]; uint32_t run; } CASES[] = {
    {"", "", {{BALL, 1}}, 1},
    {"", "", {{BALL, 40}}, 40},
    {"", "", {{BOX, 40}}, 40},
    {"difference(){cube([200,10,1]);", "}", {{ROUND, 30}}, 30},
    {"", "", {{BALL, 20}, {ROUND, 40}, {CUT, 10}}, 2},
    {"", "", {{CUT, 10}, {BOTH, 3}}, 1},
    {"", "", {{BOTH, 1}}, 0}};
  size_t counted = 0, looked_up = 0;
  for (size_t c = 0; c < sizeof CASES / sizeof *CASES; c++) {
    char text[8000];
    write_rows(text, sizeof text, CASES[c].head, CASES[c].rows, 3, CASES[c].tail);
    quoin_scene *scene = scene_of(text);
    const qn_normal *n = &scene->normal;
    assert_true(scene->run.count >= CASES[c].run && scene->run.count <= n->term_count);
    for (uint32_t i = 0; i < n->term_count; i++) {
      const qn_nterm *t = &n->terms[i];
      const int plain = t->leaves == 1 && !t->minus && !t->plus, run = i - scene->run.first < scene->run.count;
      assert_int_equal(qn_plain_line(scene, i), plain ? scene->line_of[n->leaves[t->leaf0]] : UINT32_MAX);
      counted += (size_t)run, looked_up += (size_t)(plain && !run);
    }
    quoin_scene_free(scene);
  }
  assert_true(counted > 100 && looked_up > 10);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(rounds), cmocka_unit_test(lines_of_terms)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
