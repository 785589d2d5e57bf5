/* How the verdict changes with the impact law ([FN97] section 7): an impact of the first of two masses that also drags
 * the second one along, by f times its change of speed, turns xi, and with it the signs of c_i = eta L^i xi. */
#include "support.h"

#include "witness/grazing_family.h"

enum { COEFFICIENTS = 12, TRANSIENT = 100, KEPT = 40 };

static const double two_pi = 6.283185307179586, frequency = 4, restitution = 0.6;

typedef struct dragged {
  double force, drag;
} dragged;

/* Two masses between walls with springs 1 and dampers 2.2, too much for oscillations, driven at the first; x = (q, u).
 */
static int rate(double t, const double *x, double *out, void *user) {
  const dragged *d = user;
  out[0] = x[2];
  out[1] = x[3];
  out[2] = -2 * x[0] + x[1] - 2.2 * (2 * x[2] - x[3]) + d->force * cos(frequency * t);
  out[3] = -2 * x[1] + x[0] - 2.2 * (2 * x[3] - x[2]);
  return 0;
}

static int gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = 1 - x[0];
  return 0;
}

static int impact(double t, const double *x, size_t obstacle, double *after, void *user) {
  const double change = -(1 + restitution) * x[2];
  (void)t, (void)obstacle;
  memcpy(after, x, 4 * sizeof *after);
  after[2] += change;
  after[3] += ((const dragged *)user)->drag * change;
  return 0;
}

static ric_status set(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  (void)system, (void)error;
  ((dragged *)user)->force = p[0];
  *given = two_pi / frequency;
  return RIC_OK;
}

typedef struct judged {
  ric_grazing_criterion criterion;
  double c[COEFFICIENTS], amplitude, smooth[4];
} judged;

static ric_system *make(dragged *d) {
  const ric_first_order model = {.states = 4, .obstacles = 1, .rate = rate, .gap = gap, .impact = impact, .user = d};
  ric_system *system = NULL;
  assert_int_equal(ric_system_create_first_order(&model, &system, NULL), RIC_OK);
  return system;
}

static judged judge(dragged *d) {
  judged j;
  const double rest[4] = {0};
  ric_family_problem problem = {.system = make(d),
                                .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                .set = set,
                                .user = d,
                                .parameters = 1};
  const ric_family_options options = grazing_family_options(0.5, 100, 5);
  grazing_family g = grazing_family_from(&problem, &options, 0.5, rest, NULL, NULL, two_pi / frequency);
  grazing_family_find(&g);
  ric_grazing_map map = grazing_family_map(&g, NULL);
  assert_int_equal(ric_grazing_criterion_find(&map, NULL, &j.criterion, j.c, COEFFICIENTS, NULL, NULL), RIC_OK);
  assert_close(g.grazing.local.xi[3], -d->drag * (1 + restitution), 1e-7);
  j.amplitude = g.grazing.parameter;
  memcpy(j.smooth, g.grazing.z, sizeof j.smooth);
  ric_grazing_map_clear(&map);
  grazing_family_clear(&g);
  ric_system_destroy(&problem.system);
  return j;
}

/* How far stroboscopic states of the settled motion are from the smooth one beyond grazing by mu. */
static double departure(dragged *d, const judged *j, double mu) {
  ric_system *system = make(d);
  ric_trajectory *t = NULL;
  ric_run run;
  double most = 0;
  d->force = j->amplitude * (1 + mu);
  assert_int_equal(ric_trajectory_create(system, NULL, &t, NULL), RIC_OK);
  assert_int_equal(ric_trajectory_start(t, 0, j->smooth, NULL, NULL), RIC_OK);
  for (int k = 1; k <= TRANSIENT + KEPT; k++) {
    assert_int_equal(ric_trajectory_run(t, k * two_pi / frequency, NULL, &run, NULL), RIC_OK);
    assert_int_equal(run.outcome, RIC_RUN_COMPLETED);
    for (size_t i = 0; i < 4 && k > TRANSIENT; i++)
      most = fmax(most, fabs(ric_trajectory_q(t)[i] - (1 + mu) * j->smooth[i]));
  }
  ric_trajectory_destroy(&t);
  ric_system_destroy(&system);
  return most;
}

/* At a drag of 1 both masses are thrown back alike, and the slow motion against each other is not excited. */
static void the_verdict_changes_with_the_impact_law(void **state) {
  (void)state;
  static const double drags[] = {-2, -1.75, -1, 0, 1};
  static const ric_grazing_verdict verdicts[] = {RIC_GRAZING_DISCONTINUOUS, RIC_GRAZING_DISCONTINUOUS,
                                                 RIC_GRAZING_CONTINUOUS, RIC_GRAZING_CONTINUOUS, RIC_GRAZING_UNDECIDED};
  dragged none = {0, 0}, unit = {0, 0.5};
  const judged a = judge(&none), b = judge(&unit);
  for (size_t k = 0; k < sizeof drags / sizeof *drags; k++) {
    dragged d = {0, drags[k]};
    const judged j = judge(&d);
    for (int i = 0; i < COEFFICIENTS; i++) /* xi is linear in the drag, and so are they */
      assert_close(j.c[i], a.c[i] + 2 * d.drag * (b.c[i] - a.c[i]), 1e-7);
    const double far = departure(&d, &j, 1e-4), near = departure(&d, &j, 1e-8);
    print_message("[ drag %g: %s, c %.3g %.3g %.3g, runs depart by %.2g and %.2g ]\n", d.drag,
                  ric_grazing_verdict_name(j.criterion.verdict), j.c[0], j.c[1], j.c[2], far, near);
    assert_int_equal(j.criterion.verdict, verdicts[k]);
    if (verdicts[k] == RIC_GRAZING_UNDECIDED)
      assert_non_null(strstr(j.criterion.reason, "xi does not excite"));
    else
      assert_int_equal(j.criterion.verdict, near > 0.1 * far ? RIC_GRAZING_DISCONTINUOUS : RIC_GRAZING_CONTINUOUS);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_verdict_changes_with_the_impact_law)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
