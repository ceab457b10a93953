#include "cli/stats.h"

#include <inttypes.h>
#include <stdio.h>
#include <sys/resource.h>

/* The counters by name, for printing and for summing. */
#define COUNTERS(each) \
  each(rays) each(points) each(packets) each(nodes) each(leaves) each(filter_sure) each(exact_signs) each(exact_orders) each(exact_rays) \
    each(exact_points) each(exact_roundings) each(exact_forms)

static void name(cli_stats *stats, const char *word) {
  if (!stats->json) {
    cli_putf(&stats->text, "%s ", word);
  } else {
    cli_putf(&stats->text, "%s\"%s\":", stats->text.length ? "," : "", word);
  }
}

static void end(cli_stats *stats) {
  cli_puts(&stats->text, stats->json ? "" : "\n");
}

void cli_stats_seconds(cli_stats *stats, const char *word, double seconds) {
  name(stats, word);
  cli_putf(&stats->text, "%.6f", seconds);
  end(stats);
}

void cli_stats_count(cli_stats *stats, const char *word, uint64_t count) {
  name(stats, word);
  cli_putf(&stats->text, "%" PRIu64, count);
  end(stats);
}

void cli_stats_load(cli_stats *stats, const cli_loaded *loaded) {
  cli_stats_seconds(stats, "read_seconds", loaded->read_seconds);
  if (loaded->scene) {
    quoin_scene_info info;
    quoin_scene_get_info(loaded->scene, &info);
    cli_stats_seconds(stats, "compile_seconds", loaded->compile_seconds);
    cli_stats_count(stats, "scene_leaves", info.leaves);
    cli_stats_count(stats, "scene_dropped", info.dropped);
    cli_stats_count(stats, "scene_surfaces", info.surfaces);
    cli_stats_count(stats, "scene_distinct_surfaces", info.distinct_surfaces);
    cli_stats_count(stats, "scene_gates", info.gates);
    cli_stats_count(stats, "scene_terms", info.terms);
    cli_stats_count(stats, "scene_copies", info.copies);
    cli_stats_count(stats, "scene_shared", info.shared);
    cli_stats_count(stats, "scene_bytes", info.memory);
  }
}

void cli_stats_work(cli_stats *stats, const quoin_stats *work) {
#define SAY(counter) cli_stats_count(stats, #counter, work->counter);
  COUNTERS(SAY)
#undef SAY
  uint64_t asked = work->rays + work->points;
  name(stats, "leaves_each");
  cli_putf(&stats->text, "%.3f", asked ? (double)work->leaves / (double)asked : 0.0);
  end(stats);
}

void cli_stats_say(cli_stats *stats) {
  struct rusage usage;
  if (getrusage(RUSAGE_SELF, &usage) == 0) {
    cli_stats_count(stats, "peak_bytes", (uint64_t)usage.ru_maxrss * 1024);
  }
  if (stats->json) {
    fputs("{\"stats\":{", stderr);
  }
  (void)fwrite(stats->text.data, 1, stats->text.length, stderr);
  if (stats->json) {
    fputs("}}\n", stderr);
  }
  cli_text_free(&stats->text);
}

void cli_add_work_stats(const quoin_work *work, quoin_stats *sum) {
  if (!work) {
    return;
  }
  quoin_stats stats;
  quoin_work_stats(work, &stats);
#define ADD(counter) sum->counter += stats.counter;
  COUNTERS(ADD)
#undef ADD
}
