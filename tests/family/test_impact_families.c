/* Families of vibro-impact Duffing oscillators, [VID]: against the closed form at eps = 0, and against event-driven
 * runs; impacts more at a grazing point. */
#include "support.h"

#include "witness/impact_study.h"

enum { MOST_POINTS = 400, PARTS = 7 };
static const double turn = 6.283185307179586;

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

/* Two masses in series on springs 3, from the ground, and 1 with the cubic part eps; a wall at 2 before the last. */
typedef struct modes {
  ric_spring links[3];
  ric_lattice lattice;
  ric_system *system;
  size_t hit;
  ric_family *family;
  double z[64];
} modes;

static void modes_init(modes *m, double eps) {
  static const ric_obstacle wall = {
      .coordinate = 1, .side = -1, .position = 2, .restitution = 1, .stiffness = INFINITY};
  ric_error error;
  *m =
      (modes){.links = {{3, 0, 0, 0}, {1, 0, eps, 0}, {0, 0, 0, 0}}, .lattice = ric_lattice_default(2, RIC_ENDS_FIXED)};
  m->lattice.on_site = (ric_spring){0};
  m->lattice.links = m->links;
  check(ric_system_create_lattice(&m->lattice, &wall, 1, &m->system, &error), &error);
}

static void modes_clear(modes *m) {
  ric_family_destroy(&m->family);
  ric_system_destroy(&m->system);
}

/* One impact per period, along the period from `longest` down to `shortest`, or up. */
static void modes_start(modes *m, double from, double to, double step) {
  ric_error error;
  const double q[2] = {0.65, 2}, u[2] = {0, -0.3};
  const ric_family_problem problem = {
      .system = m->system,
      .motion = {.kind = RIC_MOTION_EVEN, .at_start = &m->hit, .start_count = 1, .flow = ric_flow_options_default()},
      .parameters = 1};
  ric_family_options options = ric_family_options_default();
  options.curve.p_low = fmin(from, to);
  options.curve.p_high = fmax(from, to);
  options.curve.direction = to > from ? 1 : -1;
  options.curve.step = 0.01;
  options.curve.step_most = step;
  options.curve.points = MOST_POINTS;
  check(ric_family_create(&problem, &options, &m->family, &error), &error);
  check(ric_family_start(m->family, from, q, u, NULL, from, m->z, NULL, &error), &error);
}

/* --- the closed form ---------------------------------------------------------------------------------------------- */

typedef struct comparison {
  impact_study study;
  size_t points, grazing;
  double touches; /* where the verdict changes: the end of an interval */
} comparison;

static int compare(const ric_family_point *point, void *user) {
  comparison *c = user;
  const ric_orbit *o = point->orbit, *exact = &c->study.orbit;
  impact_study_solve(&c->study, o->period);
  double scale = impact_study_scale(&c->study);
  for (int i = 0; i < 2; i++) {
    assert_close(o->q[i], exact->q[i], 1e-9 * scale);
    assert_close(o->v[i], exact->v[i], 1e-9 * scale);
  }
  assert_close(o->energy, exact->energy, 1e-9 * scale * scale);
  assert_close(o->impulse[0], exact->impulse[0], 1e-9 * scale);
  if (point->kind == RIC_FAMILY_GRAZING) {
    c->touches = o->period;
    c->grazing++;
  } else
    assert_int_equal(o->outcome, exact->outcome);
  c->points++;
  return 0;
}

static int find_end(const ric_impact_interval *interval, void *user) {
  double *end = user;
  if (interval->outcome == RIC_ADMISSIBLE && interval->low_end == RIC_INTERVAL_GRAZING)
    *end = interval->low;
  return 0;
}

static void families_of_linear_springs_are_the_closed_form(void **state) {
  (void)state;
  modes m;
  ric_curve_run run;
  ric_error error;
  double end = NAN;
  comparison c = {.study = impact_study_two_masses()};
  modes_init(&m, 0);
  modes_start(&m, 7.4, 6.09, 0.03);
  check(ric_family_follow(m.family, m.z, 7.4, NULL, compare, &c, &run, &error), &error);
  assert_true(c.points > 50 && c.grazing == 1);
  check(ric_impact_modes_intervals(c.study.modes, 5.9, 7.4, 0, find_end, &end, &error), &error);
  assert_close(c.touches, end, 1e-9);
  impact_study_clear(&c.study);
  modes_clear(&m);
}

/* --- event-driven runs -------------------------------------------------------------------------------------------- */

/* What an event-driven run says that begins a part of the period after the impact at t = 0. */
static ric_verification_result verdict_of(modes *m, ric_family *family, const ric_family_point *point) {
  const ric_orbit *o = point->orbit;
  ric_verification found;
  ric_error error;
  double q[PARTS + 1][2], v[PARTS + 1][2];
  check(ric_shooting_states(ric_family_shooting(family), point->z, point->given, PARTS + 1, q[0], v[0], &error),
        &error);
  if (ric_verify(m->system, o, o->period / PARTS, q[1], v[1], NULL, &found, &error) != RIC_OK)
    return RIC_RUN_FAILED; /* an impact then */
  return found.result;
}

typedef struct run_along {
  modes *m;
  ric_family *family;
  size_t admissible, inadmissible;
  ric_family_junction junction; /* at the first grazing point */
  double energy[MOST_POINTS], frequency[MOST_POINTS];
} run_along;

/* Time runs backwards over an even motion as it runs forwards. */
static void assert_reversible(const ric_orbit *o, ric_family *family, const ric_family_point *point) {
  double q[9][2], v[9][2];
  check(ric_shooting_states(ric_family_shooting(family), point->z, point->given, 9, q[0], v[0], NULL),
        &(ric_error){.message = "no states"});
  assert_close(v[8][1], -o->v[1], 1e-12);
  assert_close(q[8][0], o->q[0], 1e-12);
  assert_close(o->v[0], 0, 1e-15);
}

static int verify(const ric_family_point *point, void *user) {
  run_along *r = user;
  if (point->kind == RIC_FAMILY_GRAZING && !r->junction.family)
    check(ric_family_cross(r->family, point, &r->junction, NULL), &(ric_error){.message = "no family across"});
  if (point->kind != RIC_FAMILY_REGULAR)
    return 0;
  const ric_orbit *o = point->orbit;
  if (o->outcome == RIC_ADMISSIBLE) {
    if (point->multipliers->largest < 1e4) /* else the run's own errors grow too much in a period */
      assert_int_equal(verdict_of(r->m, r->family, point), RIC_VERIFIED);
    assert_reversible(o, r->family, point);
    assert_true(r->admissible < MOST_POINTS);
    r->energy[r->admissible] = o->energy;
    r->frequency[r->admissible++] = turn / o->period;
  } else if (o->outcome == RIC_INADMISSIBLE) {
    assert_int_not_equal(verdict_of(r->m, r->family, point), RIC_VERIFIED);
    r->inadmissible++;
  }
  return 0;
}

/* Frequency at an energy, between the points of a family whose energy rises. */
static double frequency_at(const run_along *r, double energy) {
  for (size_t k = 1; k < r->admissible; k++)
    if (r->energy[k - 1] <= energy && energy <= r->energy[k]) {
      double part = (energy - r->energy[k - 1]) / (r->energy[k] - r->energy[k - 1]);
      return r->frequency[k - 1] + part * (r->frequency[k] - r->frequency[k - 1]);
    }
  return NAN;
}

static void every_admissible_motion_is_confirmed_and_cubic_springs_stiffen_it(void **state) {
  (void)state;
  double before = 0;
  size_t total = 0;
  for (double eps = 0; eps < 0.21; eps += 0.05) {
    modes m;
    ric_curve_run run;
    ric_error error;
    run_along r = {.m = &m};
    modes_init(&m, eps);
    modes_start(&m, eps > 0 ? 6.5 : 7, 5.5, 0.05);
    r.family = m.family;
    check(ric_family_follow(m.family, m.z, eps > 0 ? 6.5 : 7, NULL, verify, &r, &run, &error), &error);
    assert_true(r.admissible > 10);
    double frequency = frequency_at(&r, 3);
    assert_true(frequency > before + 0.005);
    before = frequency;
    total += r.admissible;
    ric_family_junction_clear(&r.junction);
    modes_clear(&m);
  }
  print_message("[ %zu admissible motions of 5 families, all confirmed ]\n", total);
}

/* --- more impacts per period -------------------------------------------------------------------------------------- */

static void motions_with_three_impacts_begin_where_one_impact_grazes(void **state) {
  (void)state;
  modes m;
  ric_curve_run run;
  ric_error error;
  run_along one = {.m = &m}, three = {.m = &m};
  modes_init(&m, 0);
  modes_start(&m, 6.2, 6.09, 0.05);
  one.family = m.family;
  check(ric_family_follow(m.family, m.z, 6.2, NULL, verify, &one, &run, &error), &error);
  assert_non_null(one.junction.family);
  assert_true(one.inadmissible > 0);
  ric_family_junction *j = &one.junction;
  three.family = j->family;
  assert_int_equal(ric_shooting_impacts(ric_family_shooting(j->family)), 3);
  assert_int_equal(j->side, -1);
  assert_int_equal(j->other_side, 1);
  check(ric_family_follow(j->family, j->z, j->parameter, j->tangent, verify, &three, &run, &error), &error);
  assert_true(three.admissible > 20);
  ric_family_junction_clear(&three.junction);
  ric_family_junction_clear(j);
  modes_clear(&m);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(families_of_linear_springs_are_the_closed_form),
      cmocka_unit_test(every_admissible_motion_is_confirmed_and_cubic_springs_stiffen_it),
      cmocka_unit_test(motions_with_three_impacts_begin_where_one_impact_grazes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
