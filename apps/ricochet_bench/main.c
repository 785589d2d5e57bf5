/* ricochet_bench: times scenarios, one JSON line each: seconds (median), least and most, repeats, tasks, n, and the
 * peak memory of the scenario's process per particle. Every scenario runs in a process of its own. */
#define _DEFAULT_SOURCE /* getrusage */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "bench.h"

double bench_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int by_value(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

static double peak_bytes(void) {
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  return 1024 * (double)usage.ru_maxrss;
}

static int time_scenario(const benchmark *b) {
  double seconds[128], before = peak_bytes();
  work_done done = {0};
  for (size_t i = 0; i < b->repeats && !done.failed; i++) {
    double began = bench_seconds();
    done = b->run(b->argument, b->variant);
    seconds[i] = done.seconds > 0 ? done.seconds : bench_seconds() - began;
  }
  if (done.failed) {
    fprintf(stderr, "ricochet_bench: %s: not the result that the scenario promises\n", b->name);
    return 1;
  }
  qsort(seconds, b->repeats, sizeof *seconds, by_value);
  printf("{\"scenario\": \"%s\", \"seconds\": %.6g, \"least\": %.6g, \"most\": %.6g, \"repeats\": %zu, \"tasks\": %zu, "
         "\"n\": %zu",
         b->name, seconds[b->repeats / 2], seconds[0], seconds[b->repeats - 1], b->repeats, done.tasks, done.n);
  if (done.n >= 100000) /* smaller ones are lost in the memory of any process */
    printf(", \"bytes_per_particle\": %.0f", (peak_bytes() - before) / (double)done.n);
  if (done.measure)
    printf(", \"%s\": %.6g", done.measure, done.value);
  puts("}");
  return fflush(stdout) != 0;
}

/* In a child, so that its peak memory is its own. */
static int in_child(int (*run)(const benchmark *), const benchmark *b) {
  pid_t child = fork();
  if (child == 0)
    _exit(run(b));
  int status = 1;
  return child < 0 || waitpid(child, &status, 0) < 0 || status != 0;
}

static int scaling(const benchmark *b) {
  (void)b;
  return bench_scaling() || fflush(stdout) != 0;
}

enum { LISTS = 8 };
static const benchmark *const lists[LISTS] = {
    benchmarks,        trajectory_benchmarks, multiplier_benchmarks, continuation_benchmarks,
    family_benchmarks, flow_benchmarks,       diagram_benchmarks,    section_benchmarks};

static void list(void) {
  for (size_t l = 0; l < LISTS; l++)
    for (const benchmark *b = lists[l]; b->name; b++)
      printf("  %-24s %s\n", b->name, b->what);
  printf("  %-24s %s\n", "scaling", "growth of time with n from 1e3 to 1e6");
}

static int wanted(const char *name, int argc, char **argv) {
  for (int i = 1; i < argc; i++)
    if (strcmp(name, argv[i]) == 0)
      return 1;
  return argc == 1;
}

int main(int argc, char **argv) {
  int failed = 0, known = argc == 1;
  if (argc > 1 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
    puts("usage: ricochet_bench [SCENARIO ...]\n\nPrints a JSON line per scenario; all of them by default:");
    list();
    return 0;
  }
  for (size_t l = 0; l < LISTS; l++)
    for (const benchmark *b = lists[l]; b->name; b++)
      if (wanted(b->name, argc, argv)) {
        known = 1;
        failed |= in_child(time_scenario, b);
      }
  if (wanted("scaling", argc, argv)) {
    known = 1;
    failed |= in_child(scaling, NULL);
  }
  if (!known)
    fprintf(stderr, "ricochet_bench: no such scenario (see ricochet_bench --help)\n");
  return known ? failed : 2;
}
