/* First-order systems of a user: gap rates, impact maps and the forces of contacts that persist. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "model/system_model.h"
#include "scenario/random_source.h"

static const double gravity = 9.81;

static ric_system *system_of(const ric_first_order *model) {
  ric_system *s = NULL;
  ric_error error = {0};
  if (ric_system_create_first_order(model, &s, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return s;
}

/* A ball (y, v) on a table that moves: y >= amplitude sin(3 t). */
typedef struct ball {
  double restitution, amplitude;
} ball;

static int ball_rate(double t, const double *x, double *rate, void *user) {
  (void)t, (void)user;
  rate[0] = x[1];
  rate[1] = -gravity;
  return 0;
}

static int ball_gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  const ball *b = user;
  (void)obstacle;
  *h = x[0] - b->amplitude * sin(3 * t);
  return 0;
}

static int ball_impact(double t, const double *x, size_t obstacle, double *after, void *user) {
  const ball *b = user;
  double table = 3 * b->amplitude * cos(3 * t);
  (void)obstacle;
  after[0] = x[0];
  after[1] = table - b->restitution * (x[1] - table);
  return 0;
}

static ric_first_order ball_model(ball *b) {
  return (ric_first_order){
      .states = 2, .obstacles = 1, .rate = ball_rate, .gap = ball_gap, .impact = ball_impact, .user = b};
}

static void ball_at_rest_is_held_by_its_weight(void **state) {
  (void)state;
  for (double e = 0; e <= 1; e += 0.25) {
    ball b = {.restitution = e};
    ric_first_order model = ball_model(&b);
    ric_system *s = system_of(&model);
    const unsigned char held = CONTACT_HELD;
    double x[] = {0, 0}, rate[2], lambda;
    assert_null(s->model->rate(s, &held, 0, x, NULL, rate, NULL));
    assert_close(rate[0], 0, 1e-12); /* lambda D with D = (0, 1) */
    assert_close(rate[1], 0, 1e-9);
    assert_null(s->model->reaction(s, &held, 0, 0, x, NULL, &lambda));
    assert_close(lambda, gravity, 1e-9);
    ric_system_destroy(&s);
  }
}

static void ball_follows_the_table_that_carries_it(void **state) {
  (void)state;
  ball b = {.restitution = 0.5, .amplitude = 0.3};
  ric_first_order model = ball_model(&b);
  ric_system *s = system_of(&model);
  const unsigned char held = CONTACT_HELD;
  for (double t = 0; t < 3; t += 0.1) {
    double x[] = {0.3 * sin(3 * t), 0.9 * cos(3 * t)}, rate[2], lambda;
    assert_null(s->model->rate(s, &held, t, x, NULL, rate, NULL));
    assert_close(rate[0], x[1], 1e-9);
    assert_close(rate[1], -2.7 * sin(3 * t), 1e-8);
    assert_null(s->model->reaction(s, &held, 0, t, x, NULL, &lambda));
    assert_close(lambda, gravity - 2.7 * sin(3 * t), 1e-8);
    assert_close(ric_system_gap_rate(s, 0, t, x, NULL), 0, 1e-11);
  }
  ric_system_destroy(&s);
}

/* A block (y, v, z) with friction at impacts whose coefficient depends on the impact: the limit is what counts. */
static int block_rate(double t, const double *x, double *rate, void *user) {
  (void)t, (void)user;
  rate[0] = x[1];
  rate[1] = -gravity + 0.2 * x[2];
  rate[2] = 0.4;
  return 0;
}

static int block_gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = x[0];
  return 0;
}

static int block_gradient(double t, const double *x, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)t, (void)x, (void)obstacle, (void)user;
  gradient[0] = 1, gradient[1] = gradient[2] = *in_time = 0;
  return 0;
}

static int block_impact(double t, const double *x, size_t obstacle, double *after, void *user) {
  double e = 0.6 * exp(x[1]), impulse = x[1] < 0 ? -(1 + e) * x[1] : 0;
  (void)t, (void)obstacle, (void)user;
  after[0] = x[0];
  after[1] = x[1] + impulse;
  after[2] = x[2] - 0.3 * impulse / (1 + impulse);
  return 0;
}

static void contact_pushes_where_slow_impacts_do(void **state) {
  (void)state;
  ric_first_order model = {.states = 3,
                           .obstacles = 1,
                           .rate = block_rate,
                           .gap = block_gap,
                           .gap_gradient = block_gradient,
                           .impact = block_impact};
  ric_system *s = system_of(&model);
  const unsigned char held = CONTACT_HELD;
  double x[] = {0, 0, 2}, rate[3], lambda;
  assert_null(s->model->reaction(s, &held, 0, 0, x, NULL, &lambda));
  assert_close(lambda, gravity - 0.4, 1e-11);
  assert_null(s->model->rate(s, &held, 0, x, NULL, rate, NULL));
  assert_close(rate[1], 0, 1e-10);
  /* The extrapolated push errs by 1e-8, the fourth power of the largest trial, over 64, times a derivative. */
  assert_close(rate[2], 0.4 - 0.3 * (gravity - 0.4), 1e-8);
  ric_system_destroy(&s);
}

/* A particle (x, y, v, w) in a corner of two planes. */
static int corner_rate(double t, const double *x, double *rate, void *user) {
  (void)t, (void)user;
  rate[0] = x[2], rate[1] = x[3], rate[2] = -1.2, rate[3] = -3;
  return 0;
}

static int corner_gap(double t, const double *x, size_t obstacle, double *h, void *user) {
  (void)t, (void)user;
  *h = obstacle ? x[1] : 0.6 * x[0] + 0.8 * x[1];
  return 0;
}

static int corner_impact(double t, const double *x, size_t obstacle, double *after, void *user) {
  double normal[] = {obstacle ? 0 : 0.6, obstacle ? 1 : 0.8}, rate = normal[0] * x[2] + normal[1] * x[3];
  (void)t, (void)user;
  memcpy(after, x, 4 * sizeof *x);
  for (int i = 0; i < 2; i++)
    after[2 + i] -= 1.5 * normal[i] * rate;
  return 0;
}

static void particle_in_a_corner_is_held_by_both_planes(void **state) {
  (void)state;
  ric_first_order model = {
      .states = 4, .obstacles = 2, .rate = corner_rate, .gap = corner_gap, .impact = corner_impact};
  ric_system *s = system_of(&model);
  const unsigned char both[] = {CONTACT_HELD, CONTACT_HELD};
  double x[] = {0, 0, 0, 0}, rate[4], first, second;
  assert_null(s->model->rate(s, both, 0, x, NULL, rate, NULL));
  for (int i = 0; i < 4; i++)
    assert_close(rate[i], 0, 1e-8);
  assert_null(s->model->reaction(s, both, 0, 0, x, NULL, &first));
  assert_null(s->model->reaction(s, both, 1, 0, x, NULL, &second));
  assert_close(first, 2, 1e-8);
  assert_close(second, 1.4, 1e-8);
  ric_system_destroy(&s);
}

static void restitution_is_the_ratio_of_the_last_impact(void **state) {
  (void)state;
  ball b = {.restitution = 0.8, .amplitude = 0.1};
  ric_first_order model = ball_model(&b);
  ric_system *s = system_of(&model);
  double x[] = {0.1, -2}, after[2], still[] = {0.1, 3};
  assert_true(s->model->restitution(s, 0) == 1);
  assert_null(s->model->impact(s, 0, 0.7, x, after));
  assert_close(s->model->restitution(s, 0), 0.8, 1e-10);
  assert_null(s->model->impact(s, 0, 0.7, still, after)); /* says nothing: the gap does not close */
  assert_close(s->model->restitution(s, 0), 0.8, 1e-10);
  assert_null(s->model->direction);
  ric_system_destroy(&s);
}

static void refuse(const ric_first_order *model, const char *words) {
  ric_system *s = NULL;
  ric_error error = {0};
  assert_int_equal(ric_system_create_first_order(model, &s, &error), RIC_EINVAL);
  assert_null(s);
  if (!strstr(error.message, words))
    fail_msg("\"%s\" does not say \"%s\"", error.message, words);
}

static void refusals_name_the_field(void **state) {
  (void)state;
  ball b = {.restitution = 1};
  ric_first_order m = ball_model(&b);
  m.states = 0, refuse(&m, "states = 0");
  m = ball_model(&b), m.states = SIZE_MAX, refuse(&m, "states = ");
  m = ball_model(&b), m.rate = NULL, refuse(&m, "rate = NULL");
  m = ball_model(&b), m.gap = NULL, refuse(&m, "gap = NULL");
  m = ball_model(&b), m.impact = NULL, refuse(&m, "impact = NULL");
}

static int rate_without_numbers(double t, const double *x, double *rate, void *user) {
  (void)t, (void)x, (void)user;
  rate[0] = 0, rate[1] = INFINITY;
  return 0;
}

static int impact_that_fails(double t, const double *x, size_t obstacle, double *after, void *user) {
  (void)t, (void)x, (void)obstacle, (void)user;
  after[0] = after[1] = 0;
  return 7;
}

static int impact_that_does_nothing(double t, const double *x, size_t obstacle, double *after, void *user) {
  (void)t, (void)obstacle, (void)user;
  memcpy(after, x, 2 * sizeof *x);
  return 0;
}

static void failing_callbacks_are_named(void **state) {
  (void)state;
  ball b = {.restitution = 1};
  const unsigned char held = CONTACT_HELD;
  double x[] = {0, 0}, found[2];
  ric_first_order model = ball_model(&b);
  model.rate = rate_without_numbers;
  ric_system *s = system_of(&model);
  assert_string_equal(s->model->rate(s, NULL, 0, x, NULL, found, NULL),
                      "the rate callback gave a value that is not finite");
  ric_system_destroy(&s);
  model = ball_model(&b);
  model.impact = impact_that_fails;
  s = system_of(&model);
  assert_string_equal(s->model->impact(s, 0, 0, x, found), "the impact callback failed");
  assert_string_equal(s->model->rate(s, &held, 0, x, NULL, found, NULL), "the impact callback failed");
  ric_system_destroy(&s);
  model.impact = impact_that_does_nothing;
  s = system_of(&model);
  assert_non_null(s->model->rate(s, &held, 0, x, NULL, found, NULL));
  assert_true(isnan(ric_system_energy(s, 0, x, NULL)));
  ric_system_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ball_at_rest_is_held_by_its_weight),
      cmocka_unit_test(ball_follows_the_table_that_carries_it),
      cmocka_unit_test(contact_pushes_where_slow_impacts_do),
      cmocka_unit_test(particle_in_a_corner_is_held_by_both_planes),
      cmocka_unit_test(restitution_is_the_ratio_of_the_last_impact),
      cmocka_unit_test(refusals_name_the_field),
      cmocka_unit_test(failing_callbacks_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
