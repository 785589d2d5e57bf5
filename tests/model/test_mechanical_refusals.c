/* Mechanical systems of a user: what is refused, and which callback is named when one fails. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "model/system_model.h"

static ric_system *system_of(const ric_mechanical *model) {
  ric_system *s = NULL;
  assert_int_equal(ric_system_create_mechanical(model, &s, NULL), RIC_OK);
  return s;
}

static int mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)q, (void)user;
  M[0] = 2, M[1] = M[2] = 0.5, M[3] = 1;
  return 0;
}

static int force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  f[0] = f[1] = 0;
  return 0;
}

static int kinematics(double t, const double *q, double *B, double *b, void *user) {
  (void)t, (void)q, (void)user;
  memset(B, 0, 6 * sizeof *B);
  memset(b, 0, 3 * sizeof *b);
  B[0] = B[3] = 1;
  return 0;
}

static int gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = q[0];
  return 0;
}

static const ric_mechanical plain = {
    .coordinates = 2, .speeds = 2, .obstacles = 1, .mass = mass, .force = force, .gap = gap};

static void refuse(const ric_mechanical *model, const char *words) {
  ric_system *s = NULL;
  ric_error error = {0};
  assert_int_equal(ric_system_create_mechanical(model, &s, &error), RIC_EINVAL);
  assert_null(s);
  if (!strstr(error.message, words))
    fail_msg("\"%s\" does not say \"%s\"", error.message, words);
}

static void refusals_name_the_field(void **state) {
  (void)state;
  const double restitution[] = {0.5, 1.2}, undefined[] = {NAN};
  ric_mechanical m = plain;
  m.coordinates = 0, refuse(&m, "coordinates = 0");
  m = plain, m.coordinates = SIZE_MAX, refuse(&m, "coordinates = ");
  m = plain, m.speeds = 0, refuse(&m, "speeds = 0");
  m = plain, m.speeds = 3, refuse(&m, "speeds = 3");
  m = plain, m.speeds = 1, refuse(&m, "kinematics = NULL");
  m = plain, m.force = NULL, refuse(&m, "force = NULL");
  m = plain, m.gap = NULL, refuse(&m, "gap = NULL");
  m = plain, m.obstacles = 2, m.restitution = restitution, refuse(&m, "restitution[1] = 1.2");
  m = plain, m.restitution = undefined, refuse(&m, "restitution[0] = nan");
}

static void restitution_is_copied(void **state) {
  (void)state;
  double e[] = {0.25, 0.75};
  ric_mechanical m = plain;
  m.obstacles = 2;
  m.restitution = e;
  ric_system *s = system_of(&m);
  e[0] = e[1] = 9;
  assert_true(s->model->restitution(s, 0) == 0.25);
  assert_true(s->model->restitution(s, 1) == 0.75);
  ric_system_destroy(&s);
  m.restitution = NULL;
  s = system_of(&m);
  assert_true(s->model->restitution(s, 1) == 1);
  ric_system_destroy(&s);
}

/* Callbacks that fail, or give NaN, as `user` says. */
typedef struct trouble {
  const char *callback;
  int code;
} trouble;

static int answer(const void *user, const char *callback, double *value) {
  const trouble *t = user;
  if (strcmp(t->callback, callback) != 0)
    return 0;
  *value = NAN;
  return t->code;
}

static int bad_mass(double t, const double *q, double *M, void *user) {
  return mass(t, q, M, NULL) + answer(user, "mass", &M[2]);
}
static int bad_force(double t, const double *q, const double *u, double *f, void *user) {
  return force(t, q, u, f, NULL) + answer(user, "force", &f[1]);
}
static int bad_kinematics(double t, const double *q, double *B, double *b, void *user) {
  return kinematics(t, q, B, b, NULL) + answer(user, "kinematics", &b[2]);
}
static int bad_gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  return gap(t, q, obstacle, h, NULL) + answer(user, "gap", h);
}
static int bad_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)t, (void)q, (void)obstacle;
  gradient[0] = gradient[1] = gradient[2] = *in_time = 0;
  return answer(user, "gap_gradient", in_time);
}
static int bad_energy(double t, const double *q, const double *u, double *energy, void *user) {
  (void)t, (void)q, (void)u;
  *energy = 1;
  return answer(user, "energy", energy);
}

static void check_trouble(const char *said, const trouble *t) {
  char words[80];
  snprintf(words, sizeof words, "the %s callback %s", t->callback,
           t->code ? "failed" : "gave a value that is not finite");
  assert_non_null(said);
  assert_string_equal(said, words);
}

static void failing_callbacks_are_named(void **state) {
  (void)state;
  trouble t;
  ric_mechanical m = {3, 2, 1, NULL, bad_mass, bad_force, bad_kinematics, bad_gap, bad_gradient, bad_energy, &t};
  ric_system *s = system_of(&m);
  double q[] = {1, 2, 3}, u[] = {1, 2}, q_rate[3], u_rate[2], value;
  const char *in_rates[] = {"mass", "force", "kinematics"};
  for (int code = 0; code < 2; code++) {
    for (int k = 0; k < 3; k++) {
      t = (trouble){in_rates[k], code};
      check_trouble(s->model->rate(s, NULL, 0, q, u, q_rate, u_rate), &t);
      ric_error error;
      assert_int_equal(ric_system_rate(s, 0, q, u, q_rate, u_rate, &error), RIC_ECALLBACK);
      assert_non_null(strstr(error.message, in_rates[k]));
    }
    t = (trouble){"gap", code};
    check_trouble(s->model->gap(s, 0, 0, q, &value), &t);
    assert_true(isnan(ric_system_gap(s, 0, 0, q)));
    t = (trouble){"gap_gradient", code};
    check_trouble(s->model->gap_rate(s, 0, 0, q, u, &value), &t);
    assert_true(isnan(ric_system_gap_rate(s, 0, 0, q, u)));
    t = (trouble){"energy", code};
    assert_true(isnan(ric_system_energy(s, 0, q, u)));
  }
  t = (trouble){"none", 0};
  assert_true(ric_system_energy(s, 0, q, u) == 1);
  ric_system_destroy(&s);
}

static int indefinite_mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)q, (void)user;
  M[0] = M[3] = 1, M[1] = M[2] = 2;
  return 0;
}

static void indefinite_masses_are_refused(void **state) {
  (void)state;
  ric_mechanical m = plain;
  m.mass = indefinite_mass;
  ric_system *s = system_of(&m);
  double q[] = {0, 0}, u[] = {0, 0}, q_rate[2], u_rate[2];
  const char *said = s->model->rate(s, NULL, 0, q, u, q_rate, u_rate);
  assert_non_null(said);
  assert_non_null(strstr(said, "not positive definite"));
  assert_true(isnan(ric_system_energy(s, 0, q, u))); /* no callback */
  ric_system_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(refusals_name_the_field),
      cmocka_unit_test(restitution_is_copied),
      cmocka_unit_test(failing_callbacks_are_named),
      cmocka_unit_test(indefinite_masses_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
