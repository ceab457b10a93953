/* Rays that go each by itself, several at a time (wide/packet.h, QN_EACH_LANE): every lane's answer must be, number by number, that of its ray alone in a packet of one lane, whatever the
   other lanes are and which of them live, with and without a budget. And arrays of rays that have nothing in common must say what their rays say one by one. */
#include "ask.h"
#include "query/look.h"

#include "packet_cases.h"

static const qn_wide *bodies[3];
static size_t body_count;

static void put_ray(qn_packet *p, unsigned lane, const quoin_ray *r, uint32_t on) {
  for (int i = 0; i < 3; i++) {
    p->o[i][lane] = r->o[i], p->d[i][lane] = r->d[i];
  }
  p->from[lane] = r->from, p->to[lane] = r->to, p->on[lane] = on;
}

static void begin(qn_packet *p, int few, int any) {
  p->tile = QN_TILE_NONE, p->few = few, p->any = any;
  p->new_origins = p->new_directions = 1, p->kept_ranges = 0;
}

static struct { uint64_t found, leaving, far_end, tied, unsure, lost; } met;

/* The same lane of both: of `each` lane `lane`, of `one` lane 0. */
static void same(const qn_packet_hits *each, unsigned lane, const qn_packet_hits *one, int any) {
  assert_int_equal(each->found >> lane & 1, one->found & 1);
  assert_int_equal(each->unsure >> lane & 1, one->unsure & 1);
  assert_int_equal(each->leaving >> lane & 1, one->leaving & 1);
  assert_int_equal(each->far_end >> lane & 1, one->far_end & 1);
  assert_int_equal(each->tied >> lane & 1, one->tied & 1);
  if (one->found & 1 && !any) {
    assert_memory_equal(&each->t[lane], &one->t[0], sizeof one->t[0]);
    assert_memory_equal(&each->error[lane], &one->error[0], sizeof one->error[0]);
    assert_int_equal(each->surface[lane], one->surface[0]);
    assert_int_equal(each->leaf[lane], one->leaf[0]);
  }
  met.found += one->found & 1, met.leaving += one->leaving & 1, met.far_end += one->far_end & 1, met.tied += one->tied & 1, met.unsure += one->unsure & 1;
}

static void compare(dice *d, const ask *a, const qn_wide *body, const quoin_ray rays[64]) {
  static qn_packet p, q;
  const int any = roll(d, 3) == 0;
  const uint64_t live = roll(d, 3) ? ~(uint64_t)0 : ((uint64_t)roll(d, 1 << 20) * 0x9e3779b97f4a7c15u) | 1;
  const uint64_t budget = roll(d, 4) ? 0 : 1 + (uint64_t)roll(d, 4);
  qn_packet_hits each, one;
  qn_wide_counts counts = {.budget = budget}, sum = {0};
  begin(&p, QN_EACH_LANE, any);
  for (unsigned lane = 0; lane < QN_LANES; lane++) {
    put_ray(&p, lane, &rays[lane], roll(d, 4) || a->scene->surface_count == 0 ? QN_NO_SURFACE : (uint32_t)roll(d, (int)a->scene->surface_count));
  }
  p.live = live;
  body->each(a->scene, &p, &each, &counts);
  assert_true(((each.found | each.unsure | each.leaving | each.far_end | each.tied) & ~live) == 0);
  for (uint64_t m = live; m; m &= m - 1) {
    const unsigned lane = qn_trailing_zeros(m);
    qn_wide_counts own = {.budget = budget};
    begin(&q, QN_ONE_LANE, any);
    put_ray(&q, 0, &rays[lane], p.on[lane]);
    q.live = 1;
    body->one(a->scene, &q, &one, &own);
    same(&each, lane, &one, any);
    sum.nodes += own.nodes, sum.leaves += own.leaves, sum.lost += budget && own.leaves > budget;
  }
  assert_int_equal(sum.nodes, counts.nodes);
  assert_int_equal(sum.leaves, counts.leaves);
  assert_int_equal(sum.lost, counts.lost);
  met.lost += sum.lost;
}

/* Arrays through the public calls, in any order and with directions of any lengths. */
static void arrays(dice *d, const ask *a, quoin_ray rays[64]) {
  const size_t n = 2 + (size_t)roll(d, 63);
  for (size_t i = 0; i < n; i++) {
    const quoin_ray other = rays[i];
    const size_t k = i + (size_t)roll(d, (int)(n - i));
    rays[i] = rays[k], rays[k] = other;
    const double scale = ldexp(1, roll(d, 2) ? 0 : roll(d, 60) - 30);
    for (int j = 0; j < 3; j++) {
      rays[i].d[j] *= scale * (roll(d, 2) ? 1 : -1);
    }
    if (!is_line(&rays[i])) {
      return;
    }
  }
  quoin_work *work;
  setenv("QUOIN_ISA", bodies[(size_t)roll(d, (int)body_count)]->name, 1);
  assert_int_equal(quoin_work_new(a->scene, &work), QUOIN_OK);
  unsetenv("QUOIN_ISA");
  work->takes_turns = roll(d, 4) > 0; /* as for scenes of megabytes */
  static quoin_spot spots[64], spot;
  static quoin_hit hits[64], hit;
  static uint8_t blocked[64], one;
  if (quoin_first_hits(a->scene, work, n, rays, hits) == QUOIN_OK && quoin_first_spots(a->scene, work, n, rays, QUOIN_WANT_T, spots) == QUOIN_OK &&
      quoin_rays_blocked(a->scene, work, n, rays, NULL, blocked) == QUOIN_OK) {
    for (size_t i = 0; i < n; i++) {
      assert_int_equal(quoin_first_hit(a->scene, work, &rays[i], &hit), QUOIN_OK);
      assert_true(hit.found == hits[i].found && hit.part == hits[i].part && hit.role == hits[i].role && hit.leaving == hits[i].leaving && !memcmp(&hit.t, &hits[i].t, sizeof hit.t));
      assert_int_equal(quoin_first_spots(a->scene, work, 1, &rays[i], QUOIN_WANT_T, &spot), QUOIN_OK);
      assert_memory_equal(&spot, &spots[i], sizeof spot);
      assert_int_equal(quoin_rays_blocked(a->scene, work, 1, &rays[i], NULL, &one), QUOIN_OK);
      assert_int_equal(one, blocked[i]);
    }
  }
  quoin_work_free(work);
}

static size_t model_count = 600;

static void each_is_one(void **state) {
  (void)state;
  dice d = {77};
  static char text[20000];
  for (size_t i = 0; i < model_count; i++) {
    frame f;
    make_frame(&d, roll(&d, FRAMES), &f);
    write_model(&d, (int)(i % MODELS), &f, text, sizeof text);
    ask a;
    ask_open(&a, text);
    if (a.scene->normal.made) {
      for (int turn = 0; turn < 4; turn++) {
        quoin_ray rays[64];
        fill_bundle(&d, roll(&d, BUNDLES), &f, rays);
        int lines = 1;
        for (int k = 0; k < 64; k++) {
          lines &= is_line(&rays[k]);
        }
        for (size_t body = 0; lines && body < body_count; body++) {
          compare(&d, &a, bodies[body], rays);
        }
        if (lines) {
          arrays(&d, &a, rays);
        }
      }
    }
    ask_close(&a);
  }
  print_message("found %llu, leaving %llu, far %llu, tied %llu, unsure %llu, lost %llu\n", (unsigned long long)met.found, (unsigned long long)met.leaving, (unsigned long long)met.far_end,
                (unsigned long long)met.tied, (unsigned long long)met.unsure, (unsigned long long)met.lost);
  assert_true(met.found > 10000 && met.leaving > 1000 && met.far_end > 500 && met.tied > 100 && met.unsure > 100 && met.lost > 100); /* every kind occurred */
}

int main(int words, char **word) {
  model_count = words > 1 ? (size_t)strtoull(word[1], NULL, 0) : model_count;
  body_count = find_bodies(bodies);
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_is_one)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
