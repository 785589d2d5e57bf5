#include "recorded_run.h"

#include "support.h"

static int keep(const ric_event *event, void *user) {
  recorded_run *r = user;
  if (r->count == r->capacity) {
    r->capacity = r->capacity ? 2 * r->capacity : 64;
    r->events = realloc(r->events, r->capacity * sizeof *r->events);
    assert_non_null(r->events);
  }
  r->events[r->count++] = *event;
  return 0;
}

static double *copy(const double *x, size_t count) {
  double *y = calloc(count ? count : 1, sizeof *y);
  assert_non_null(y);
  if (count)
    memcpy(y, x, count * sizeof *y);
  return y;
}

static void require(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

recorded_run record_run(const ric_system *system, const ric_trajectory_options *options, const double *q,
                        const double *u, double end) {
  recorded_run r = {.coordinates = ric_system_coordinates(system), .speeds = ric_system_speeds(system)};
  ric_observer observer = {.event = keep, .user = &r};
  ric_trajectory *trajectory = NULL;
  ric_error error = {0};
  require(ric_trajectory_create(system, options, &trajectory, &error), &error);
  require(ric_trajectory_start(trajectory, 0, q, u, &error), &error);
  require(ric_trajectory_run(trajectory, end, &observer, &r.run, &error), &error);
  r.q = copy(ric_trajectory_q(trajectory), r.coordinates);
  r.u = copy(ric_trajectory_u(trajectory), r.speeds);
  ric_trajectory_destroy(&trajectory);
  return r;
}

void recorded_run_clear(recorded_run *r) {
  free(r->events);
  free(r->q);
  free(r->u);
  *r = (recorded_run){0};
}

size_t recorded_run_impacts(const recorded_run *r) {
  size_t impacts = 0;
  for (size_t i = 0; i < r->count; i++)
    impacts += ric_event_jumps(&r->events[i]) != 0;
  return impacts;
}

const ric_event *recorded_run_first(const recorded_run *r, ric_event_kind kind) {
  for (size_t i = 0; i < r->count; i++)
    if (r->events[i].kind == kind)
      return &r->events[i];
  return NULL;
}

static int is_rest(const ric_event *event) {
  return event->kind == RIC_EVENT_REST || event->kind == RIC_EVENT_RELEASE;
}

size_t recorded_runs_stick_alike(const recorded_run *r, const recorded_run *witness, double tolerance) {
  size_t next = 0, compared = 0;
  assert_true(witness->count > r->count);
  for (size_t i = 0; i < r->count; i++) {
    if (!is_rest(&r->events[i]))
      continue;
    while (next < witness->count && !is_rest(&witness->events[next]))
      next++;
    assert_true(next < witness->count);
    assert_int_equal(r->events[i].kind, witness->events[next].kind);
    assert_close(r->events[i].time, witness->events[next++].time, tolerance);
    compared++;
  }
  return compared;
}

static double difference(const double *a, const double *b, size_t count) {
  double largest = 0;
  for (size_t i = 0; i < count; i++)
    largest = fmax(largest, fabs(a[i] - b[i]));
  return largest;
}

double recorded_runs_difference(const recorded_run *a, const recorded_run *b) {
  return fmax(difference(a->q, b->q, a->coordinates), difference(a->u, b->u, a->speeds));
}

double growth_of(const ric_system *system, const double *q, const double *u, double end) {
  size_t n = ric_system_coordinates(system), m = ric_system_speeds(system);
  double shift = 1e-8, sum = 0, *moved = calloc(n + m, sizeof *moved);
  assert_non_null(moved);
  recorded_run there = record_run(system, NULL, q, u, end);
  for (size_t k = 0; k < n + m; k++) {
    memcpy(moved, q, n * sizeof *q);
    memcpy(moved + n, u, m * sizeof *u);
    moved[k] += shift;
    recorded_run near = record_run(system, NULL, moved, moved + n, end);
    sum += recorded_runs_difference(&near, &there) / shift;
    recorded_run_clear(&near);
  }
  recorded_run_clear(&there);
  free(moved);
  return fmax(sum, 1);
}

ric_system *lattice_system(const ric_lattice *lattice, const ric_obstacle *obstacles, size_t count) {
  ric_system *system = NULL;
  ric_error error = {0};
  require(ric_system_create_lattice(lattice, obstacles, count, &system, &error), &error);
  return system;
}

ric_system *falling_ball(double restitution) {
  static const double weight[] = {-1};
  ric_lattice ball = ric_lattice_default(1, RIC_ENDS_FREE);
  ric_obstacle floor = ric_obstacle_floor(0, 0);
  ball.on_site = (ric_spring){0};
  ball.force_cos = weight; /* of frequency 0 */
  floor.restitution = restitution;
  return lattice_system(&ball, &floor, 1);
}

ric_system *coupled_masses(const ric_obstacle *obstacles, size_t count) {
  static const double mass[] = {2, 0.5, 0.2, 0.5, 1.5, -0.3, 0.2, -0.3, 1}, push[] = {0.5, 0, -0.4};
  static const double damping[] = {0.02, 0, 0, 0, 0.03, 0, 0, 0, 0.01};
  static const double stiffness[] = {2, -1, 0, -1, 2.5, -0.7, 0, -0.7, 1.8};
  const ric_mck model = {.coordinates = 3,
                         .mass.values = mass,
                         .damping.values = damping,
                         .stiffness.values = stiffness,
                         .frequency = 0.9,
                         .force_sin = push};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_mck(&model, obstacles, count, &system, NULL), RIC_OK);
  return system;
}
