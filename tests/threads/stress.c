/* Objects of the library in several threads, one of each per thread: the scenarios of the benchmarks and those of
 * rooms.h, which build all they use, run side by side, each thread in another order. A scenario that does not give what
 * it promises, or another value than in another thread, a crash and, with ThreadSanitizer, a race is a failure.
 *
 * usage: stress THREADS [SCENARIO ...]   by default those below and all of rooms.h, which take some two seconds */
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench.h"
#include "rooms.h"

enum { MOST_THREADS = 64, MOST_SCENARIOS = 128, LISTS = 8, MOST_ROOMS = 32 };

#ifdef __SANITIZE_THREAD__ /* which finds a race without a collision */
enum { SOLVERS = 300 };
#else
enum { SOLVERS = 3000 };
#endif

static const benchmark *const lists[LISTS] = {
    benchmarks,        trajectory_benchmarks, multiplier_benchmarks, continuation_benchmarks,
    family_benchmarks, flow_benchmarks,       diagram_benchmarks,    section_benchmarks};

double bench_seconds(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* --- which scenarios --- */

static const char *const usual[] = {"table",
                                    "table_dense",
                                    "fixed_prime",
                                    "motion_30",
                                    "motion_3000",
                                    "driven_taylor",
                                    "driven_cvodes",
                                    "variational_30",
                                    "multipliers_table",
                                    "verdict_10000",
                                    "verdict_unstable",
                                    "continuation_small",
                                    "family_hertz",
                                    "family_hertz_multipliers",
                                    "family_cubic",
                                    "family_cubic_multipliers",
                                    "orbit_small",
                                    "diagram_one",
                                    "diagram_eight",
                                    "diagram_exponents",
                                    "period_map_at_rest",
                                    "section_strobe"};

static const benchmark *chosen[MOST_SCENARIOS];
static size_t count;

static const benchmark *scenario_named(const char *name) {
  for (size_t l = 0; l < LISTS; l++)
    for (const benchmark *b = lists[l]; b->name; b++)
      if (strcmp(b->name, name) == 0)
        return b;
  return NULL;
}

/* What the benchmarks leave out. */
static const room_scenario *rooms[MOST_ROOMS];
static size_t room_count;
static double values[MOST_THREADS][MOST_ROOMS];

/* Those of a list with the name, all without one. */
static void choose_rooms(const room_scenario *list, const char *name) {
  for (; list->name && room_count < MOST_ROOMS; list++)
    if (!name || strcmp(list->name, name) == 0)
      rooms[room_count++] = list;
}

static int choose(const char *name) {
  const benchmark *b = scenario_named(name);
  const size_t before = room_count;
  choose_rooms(motion_scenarios, name);
  choose_rooms(grazing_scenarios, name);
  if (b && count < MOST_SCENARIOS)
    chosen[count++] = b;
  if (b || room_count > before)
    return 0;
  fprintf(stderr, "stress: there is no scenario %s\n", name);
  return 1;
}

static int choose_usual(void) {
  choose_rooms(motion_scenarios, NULL);
  choose_rooms(grazing_scenarios, NULL);
  for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
    if (choose(usual[i]) != 0)
      return 1;
  return 0;
}

/* --- threads --- */

static atomic_int failures;

static void run_room(size_t i, size_t thread) {
  ric_error error = {0};
  if (rooms[i]->run(&values[thread][i], &error) == RIC_OK)
    return;
  fprintf(stderr, "stress: %s in thread %zu: %s\n", rooms[i]->name, thread, error.message);
  atomic_fetch_add(&failures, 1);
}

static void compare_values(size_t threads) {
  for (size_t t = 1; t < threads; t++)
    for (size_t i = 0; i < room_count; i++)
      if (memcmp(&values[t][i], &values[0][i], sizeof values[t][i]) != 0) {
        fprintf(stderr, "stress: %s: %.17g in thread %zu, expected %.17g\n", rooms[i]->name, values[t][i], t,
                values[0][i]);
        atomic_fetch_add(&failures, 1);
      }
}

static void run_one(const benchmark *b, size_t thread) {
  const work_done done = b->run(b->argument, b->variant);
  if (!done.failed)
    return;
  fprintf(stderr, "stress: %s in thread %zu: not the result that the scenario promises\n", b->name, thread);
  atomic_fetch_add(&failures, 1);
}

/* @param user  number of the thread, which says where it begins */
static void *run_all(void *user) {
  const size_t begin = (size_t)(uintptr_t)user;
  for (size_t i = 0; i < count; i++) {
    const benchmark *b = chosen[(i + begin * 7) % count];
    run_one(b, begin);
  }
  for (size_t i = 0; i < room_count; i++)
    run_room((i + begin * 5) % room_count, begin);
  for (size_t i = 0; i < SOLVERS; i++) /* solvers come and go: their plans are made and destroyed side by side */
    run_one(&benchmarks[0], begin);
  return NULL;
}

int main(int argc, char **argv) {
  const long threads = argc > 1 ? strtol(argv[1], NULL, 10) : 4;
  pthread_t running[MOST_THREADS];
  if (threads < 1 || threads > MOST_THREADS) {
    fprintf(stderr, "stress: %s threads, expected 1 to %d\n", argv[1], MOST_THREADS);
    return 2;
  }
  if (argc <= 2 && choose_usual() != 0)
    return 2;
  for (int i = 2; i < argc; i++)
    if (choose(argv[i]) != 0)
      return 2;
  for (long i = 0; i < threads; i++)
    if (pthread_create(&running[i], NULL, run_all, (void *)(uintptr_t)i) != 0)
      return 1;
  for (long i = 0; i < threads; i++)
    pthread_join(running[i], NULL);
  compare_values((size_t)threads);
  printf("%ld threads, %zu scenarios each: %d failures\n", threads, count + room_count, failures);
  return failures != 0;
}
