/* Families of motions of the textbook impact oscillator against closed forms. */
#include "support.h"

#include "witness/forced_oscillator.h"
#include "reference.h"

enum { MOST_POINTS = 64 };

/* Special points of a walk, copied. */
typedef struct found {
  ric_family_kind kind;
  double parameter, time, speed;
  ric_stability stable;
  size_t obstacle;
} found;

typedef struct findings {
  found points[MOST_POINTS];
  size_t count, regular;
} findings;

static int keep(const ric_family_point *point, void *user) {
  findings *f = user;
  if (point->kind == RIC_FAMILY_REGULAR) {
    f->regular++;
    return 0;
  }
  assert_true(f->count < MOST_POINTS);
  bool impacts = point->orbit->impacts > 0;
  f->points[f->count++] = (found){.kind = point->kind,
                                  .parameter = point->parameter,
                                  .time = impacts ? point->orbit->impact_time[0] : point->time,
                                  .speed = impacts ? -point->orbit->gap_rate[0] : 0,
                                  .stable = point->multipliers->stable,
                                  .obstacle = point->obstacle};
  return 0;
}

static ric_family_options options_up_to(double low, double high) {
  ric_family_options o = ric_family_options_default();
  o.curve.p_low = low;
  o.curve.p_high = high;
  o.curve.step_most = 0.1;
  return o;
}

/* Walks the impacting family from the grazing point of the smooth one. */
typedef struct crossed {
  findings smooth, impacting;
  int side, other_side;
  ric_curve_run run;
} crossed;

typedef struct crossing_walk {
  ric_family *family;
  crossed *result;
} crossing_walk;

static int cross_over(const ric_family_point *point, void *user) {
  crossing_walk *w = user;
  ric_family_junction junction;
  ric_error error;
  (void)keep(point, &w->result->smooth);
  if (point->kind != RIC_FAMILY_GRAZING)
    return 0;
  if (ric_family_cross(w->family, point, &junction, &error) != RIC_OK)
    fail_msg("%s", error.message);
  w->result->side = junction.side;
  w->result->other_side = junction.other_side;
  if (ric_family_follow(junction.family, junction.z, junction.parameter, junction.tangent, keep, &w->result->impacting,
                        &w->result->run, &error) != RIC_OK)
    fail_msg("%s", error.message);
  ric_family_junction_clear(&junction);
  return 1;
}

static void cross_at(double frequency, double high, crossed *result) {
  forced_oscillator o;
  forced_oscillator_init(&o);
  ric_family_problem problem = forced_oscillator_problem(&o, 0, 1, frequency);
  ric_family_options options = options_up_to(0, high);
  double start = forced_oscillator_grazing(frequency) / 2, x = 0, v = 0, z[2];
  int iterations;
  ric_curve_run run;
  ric_error error;
  *result = (crossed){0};
  crossing_walk w = {.result = result};
  assert_int_equal(ric_family_create(&problem, &options, &w.family, NULL), RIC_OK);
  assert_int_equal(ric_family_start(w.family, start, &x, &v, NULL, 1, z, &iterations, NULL), RIC_OK);
  assert_int_equal(iterations, 1); /* linear */
  if (ric_family_follow(w.family, z, start, NULL, cross_over, &w, &run, &error) != RIC_OK)
    fail_msg("%s", error.message);
  ric_family_destroy(&w.family);
  forced_oscillator_clear(&o);
}

static ric_family_kind kind_of(const char *word) {
  return strcmp(word, "fold") == 0       ? RIC_FAMILY_FOLD
         : strcmp(word, "doubling") == 0 ? RIC_FAMILY_PERIOD_DOUBLING
         : strcmp(word, "contact") == 0  ? RIC_FAMILY_GRAZING
                                         : RIC_FAMILY_REGULAR;
}

/* Whether a reference row is among the points found, in 1e-8. */
static bool is_found(const findings *f, ric_family_kind kind, double A, double t, double V, double period) {
  for (size_t k = 0; k < f->count; k++) {
    const found *p = &f->points[k];
    if (p->kind == kind && fabs(p->parameter - A) < 1e-8 * (1 + A) && fabs(p->speed - V) < 1e-7 * (1 + V) &&
        fabs(remainder(p->time - t, period)) < 1e-7)
      return true;
  }
  return false;
}

/* Columns: kind, w, n, A, t1, V, ... */
static void grazing_folds_doublings_and_second_contacts_are_those_of_the_closed_form(void **state) {
  (void)state;
  static const double frequencies[] = {0.6, 0.8, 1, 1.5, 2, 2.2, 2.5};
  reference table = reference_read("impact_oscillator");
  size_t compared = 0;
  for (size_t i = 0; i < sizeof frequencies / sizeof *frequencies; i++) {
    double w = frequencies[i], period = 6.283185307179586 / w, grazing = forced_oscillator_grazing(w);
    crossed c;
    cross_at(w, 14, &c);
    assert_int_equal(c.smooth.count, 1);
    assert_close(c.smooth.points[0].parameter, grazing, 1e-12 * grazing);
    assert_int_equal(c.other_side, -1); /* smooth motions exist below */
    for (size_t k = 0; k < table.count; k++) {
      const reference_row *r = &table.rows[k];
      ric_family_kind kind = kind_of(r->word);
      if (r->value[1] != w || r->value[2] != 1)
        continue;
      if (strcmp(r->word, "grazing") == 0)
        assert_close(remainder(c.smooth.points[0].time - r->value[4], period), 0, 1e-7);
      if (kind == RIC_FAMILY_REGULAR || r->value[3] > 14)
        continue;
      if (!is_found(&c.impacting, kind, r->value[3], r->value[4], r->value[5], period))
        fail_msg("w = %g: %s at A = %.12g is not found", w, r->word, r->value[3]);
      compared++;
    }
  }
  print_message("[ %zu special points ]\n", compared);
  assert_true(compared >= 9);
  reference_clear(&table);
}

/* Columns: regular, w, n, A, t1, V, re1, im1, re2, im2, admissible. */
static void regular_points_have_the_speeds_and_multipliers_of_the_closed_form(void **state) {
  (void)state;
  reference table = reference_read("impact_oscillator");
  forced_oscillator o;
  size_t compared = 0;
  forced_oscillator_init(&o);
  for (size_t k = 0; k < table.count; k++) {
    const reference_row *r = &table.rows[k];
    const double *x = r->value;
    if (strcmp(r->word, "regular") != 0)
      continue;
    ric_family_problem problem = forced_oscillator_problem(&o, 1, (size_t)x[2], x[1]);
    ric_family *family = NULL;
    double q = 1, v = -0.8 * x[5], z[3], period = 6.283185307179586 / x[1] * x[2];
    ric_orbit orbit;
    ric_multipliers m;
    assert_int_equal(ric_family_create(&problem, NULL, &family, NULL), RIC_OK);
    assert_int_equal(ric_family_start(family, x[3], &q, &v, &x[4], period, z, NULL, NULL), RIC_OK);
    assert_int_equal(ric_orbit_init_for(&orbit, o.system, 1, NULL), RIC_OK);
    assert_int_equal(ric_multipliers_init(&m, 2, NULL), RIC_OK);
    ric_shooting *shooting = ric_family_shooting(family);
    assert_int_equal(ric_shooting_orbit(shooting, z, period, &orbit, NULL), RIC_OK);
    assert_int_equal(ric_shooting_multipliers(shooting, z, period, NULL, &m, NULL), RIC_OK);
    assert_close(-orbit.gap_rate[0], x[5], 1e-11 * (1 + x[5]));
    assert_close(remainder(orbit.impact_time[0] - x[4], period), 0, 1e-11);
    assert_int_equal(orbit.outcome == RIC_ADMISSIBLE, x[10] == 1);
    for (int i = 0; i < 2; i++) {
      double nearest = fmin(hypot(m.mu[i].re - x[6], m.mu[i].im - x[7]), hypot(m.mu[i].re - x[8], m.mu[i].im - x[9]));
      assert_true(nearest < 1e-7 * (1 + fabs(x[6]))); /* where two meet: the root of rounding */
    }
    compared++;
    ric_multipliers_clear(&m);
    ric_orbit_clear(&orbit);
    ric_family_destroy(&family);
  }
  print_message("[ %zu points ]\n", compared);
  assert_true(compared > 50);
  forced_oscillator_clear(&o);
  reference_clear(&table);
}

/* --- curves in two parameters ------------------------------------------------------------------------------------- */

typedef struct trace {
  ric_family *family;
  ric_family_kind kind;
  double low, high; /* of w */
  double worst;     /* of A against the closed form, for grazing */
  double last, last_second;
  double zero; /* second parameter at the zero of a test function */
  size_t count, zeros;
} trace;

static const double period_sought = 5;

static ric_status period_test(const ric_family_curve_point *point, double *values, void *user, ric_error *error) {
  (void)user, (void)error;
  values[0] = point->orbit->period - period_sought;
  return RIC_OK;
}

static int measure(const ric_family_curve_point *point, void *user) {
  trace *t = user;
  t->worst = fmax(t->worst, fabs(point->parameter - forced_oscillator_grazing(point->second)));
  t->last = point->parameter;
  t->last_second = point->second;
  t->count++;
  if (point->zero != SIZE_MAX) {
    t->zero = point->second;
    t->zeros++;
  }
  return 0;
}

static int trace_from(const ric_family_point *point, void *user) {
  trace *t = user;
  ric_curve_options options = ric_curve_options_default();
  ric_curve_run run;
  ric_error error;
  if (point->kind != t->kind)
    return 0;
  options.p_low = t->low;
  options.p_high = t->high;
  options.direction = t->high > 1.45 ? 1 : -1;
  options.newton_tol = 1e-11;
  const ric_family_curve_tests tests = {1, period_test, NULL};
  if (ric_family_trace(t->family, point, &options, &tests, measure, t, &run, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_int_equal(run.end, RIC_CURVE_BOUND);
  return 1;
}

static void grazing_curve_is_the_closed_form(void **state) {
  (void)state;
  forced_oscillator o;
  forced_oscillator_init(&o);
  for (int up = 0; up < 2; up++) {
    ric_family_problem problem = forced_oscillator_problem(&o, 0, 1, 1);
    ric_family_options options = options_up_to(0, 1);
    trace t = {.kind = RIC_FAMILY_GRAZING, .low = 0.3, .high = up ? 3 : 1.2};
    double x = 0, v = 0, z[2];
    ric_curve_run run;
    assert_int_equal(ric_family_create(&problem, &options, &t.family, NULL), RIC_OK);
    assert_int_equal(ric_family_start(t.family, 0.05, &x, &v, NULL, 1, z, NULL, NULL), RIC_OK);
    assert_int_equal(ric_family_follow(t.family, z, 0.05, NULL, trace_from, &t, &run, NULL), RIC_OK);
    print_message("[ %zu points, worst %.3g ]\n", t.count, t.worst);
    assert_int_equal(t.zeros, up);
    if (up)
      assert_close(t.zero, 6.283185307179586 / period_sought, 1e-9);
    assert_true(t.count > 10);
    assert_true(t.worst < 1e-8);
    assert_true(t.last_second == (up ? 3 : 0.3));
    ric_family_destroy(&t.family);
  }
  forced_oscillator_clear(&o);
}

/* Columns: kind, n, w, A, t1, V. From each row of a curve to the next: the curve ends at its frequency. */
static void curves_of_folds_and_doublings_are_those_of_the_closed_form(void **state) {
  (void)state;
  reference table = reference_read("impact_oscillator_curves");
  forced_oscillator o;
  double worst = 0;
  size_t compared = 0;
  forced_oscillator_init(&o);
  for (size_t k = 0; k + 1 < table.count; k += 3) {
    const reference_row *a = &table.rows[k], *b = &table.rows[k + 1];
    const double *from = a->value, *to = b->value;
    ric_family_kind kind = kind_of(a->word);
    if (strcmp(a->word, b->word) != 0 || from[1] != to[1] || kind == RIC_FAMILY_REGULAR || fabs(to[2] - from[2]) > 0.5)
      continue;
    ric_family_problem problem = forced_oscillator_problem(&o, 1, (size_t)from[1], from[2]);
    ric_family *family = NULL;
    double q = 1, v = -0.8 * from[5], z[3], period = 6.283185307179586 / from[2] * from[1];
    ric_orbit orbit;
    ric_error error;
    ric_curve_run run;
    trace t = {.kind = kind};
    ric_curve_options options = ric_curve_options_default();
    assert_int_equal(ric_family_create(&problem, NULL, &family, NULL), RIC_OK);
    ric_shooting *shooting = ric_family_shooting(family);
    /* at a fold the Jacobian is singular: the row itself is the start */
    assert_int_equal(ric_family_start(family, from[3], &q, &v, &from[4], period, z, NULL, &error), RIC_OK);
    assert_int_equal(ric_shooting_guess(shooting, &q, &v, &from[4], period, z, NULL), RIC_OK);
    assert_int_equal(ric_orbit_init_for(&orbit, o.system, 1, NULL), RIC_OK);
    assert_int_equal(ric_shooting_orbit(shooting, z, period, &orbit, NULL), RIC_OK);
    const ric_family_point point = {.kind = kind,
                                    .parameter = from[3],
                                    .unknowns = 3,
                                    .z = z,
                                    .given = period,
                                    .orbit = &orbit,
                                    .obstacle = 0,
                                    .time = from[4]};
    options.p_low = fmin(from[2], to[2]);
    options.p_high = fmax(from[2], to[2]);
    options.direction = to[2] - from[2];
    options.newton_tol = 1e-11;
    if (ric_family_trace(family, &point, &options, NULL, measure, &t, &run, &error) != RIC_OK)
      fail_msg("%s at w = %g: %s", a->word, from[2], error.message);
    assert_int_equal(run.end, RIC_CURVE_BOUND);
    assert_true(t.last_second == to[2]);
    worst = fmax(worst, fabs(t.last - to[3]) / (1 + to[3]));
    compared++;
    ric_orbit_clear(&orbit);
    ric_family_destroy(&family);
  }
  print_message("[ %zu pieces of curves, worst %.3g ]\n", compared, worst);
  assert_true(compared > 10);
  assert_true(worst < 1e-8);
  forced_oscillator_clear(&o);
  reference_clear(&table);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(grazing_folds_doublings_and_second_contacts_are_those_of_the_closed_form),
      cmocka_unit_test(regular_points_have_the_speeds_and_multipliers_of_the_closed_form),
      cmocka_unit_test(grazing_curve_is_the_closed_form),
      cmocka_unit_test(curves_of_folds_and_doublings_are_those_of_the_closed_form),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
