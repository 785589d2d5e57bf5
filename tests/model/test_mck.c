/* M-C-K systems: what is refused, rates, energies, directions of impulses and reactions. */
#include "support.h"

#include "model/system_model.h"
#include "witness/random_mck.h"

enum { MOST = RANDOM_MCK_MOST };

static ric_system *make(const ric_mck *model, const ric_obstacle *obstacles, size_t count) {
  ric_system *system;
  ric_error error = {0};
  if (ric_system_create_mck(model, obstacles, count, &system, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return system;
}

static double dot(const double *a, const double *b, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    sum += a[i] * b[i];
  return sum;
}

/* M u' + C u + K q - F cos - G sin: the forces of contacts, for any rates. */
static void contact_forces(const random_mck *m, double t, const double *q, const double *u, const double *u_rate,
                           double *force) {
  size_t n = m->n;
  double w = m->model.frequency;
  for (size_t i = 0; i < n; i++)
    force[i] = dot(m->mass + i * n, u_rate, n) + dot(m->damping + i * n, u, n) + dot(m->stiffness + i * n, q, n) -
               m->force_cos[i] * cos(w * t) - m->force_sin[i] * sin(w * t);
}

static double energy(const random_mck *m, const double *q, const double *u) {
  double twice = 0;
  for (size_t e = 0; e < m->n * m->n; e++)
    twice += m->mass[e] * u[e / m->n] * u[e % m->n] + m->stiffness[e] * q[e / m->n] * q[e % m->n];
  return twice / 2;
}

static const double rounding = 1e-13; /* sums of up to 100 terms of order 1, and a solve with a condition below 10 */

static void rates_satisfy_the_equations_of_motion(void **state) {
  (void)state;
  random_source source = {.state = 1};
  static random_mck m;
  for (size_t n = 1; n <= 20; n++)
    for (int diagonal = 0; diagonal < 2; diagonal++) {
      double q[MOST], u[MOST], q_rate[MOST], u_rate[MOST], force[MOST], t = random_uniform(&source, -3, 3);
      random_mck_make(&m, n, diagonal, &source);
      random_state(&source, n, q, u);
      ric_system *s = make(&m.model, NULL, 0);
      assert_int_equal(s->uncoupled, diagonal || n == 1);
      assert_int_equal(ric_system_rate(s, t, q, u, q_rate, u_rate, NULL), RIC_OK);
      contact_forces(&m, t, q, u, u_rate, force);
      for (size_t i = 0; i < n; i++) {
        assert_true(q_rate[i] == u[i]);
        assert_close(force[i], 0, rounding);
      }
      assert_close(ric_system_energy(s, t, q, u), energy(&m, q, u), rounding * (double)n);
      ric_system_destroy(&s);
    }
}

/* Sparse forms of the same matrices, for a dense and a diagonal mass. */
static void forms_of_matrices_agree(void **state) {
  (void)state;
  random_source source = {.state = 2};
  static random_mck m;
  static random_sparse mass, damping, stiffness;
  for (size_t k = 0; k < 40; k++) {
    size_t n = 1 + k % 20;
    int diagonal = k % 2 == 0;
    double q[MOST], u[MOST], q_rate[MOST], dense[MOST], sparse[MOST];
    random_mck_make(&m, n, diagonal, &source);
    random_state(&source, n, q, u);
    ric_mck other = m.model;
    if (diagonal)
      other.mass = random_sparse_of(&mass, m.mass, n);
    other.damping = random_sparse_of(&damping, m.damping, n);
    other.stiffness = random_sparse_of(&stiffness, m.stiffness, n);
    ric_system *a = make(&m.model, NULL, 0), *b = make(&other, NULL, 0);
    assert_int_equal(ric_system_rate(a, 0.7, q, u, q_rate, dense, NULL), RIC_OK);
    assert_int_equal(ric_system_rate(b, 0.7, q, u, q_rate, sparse, NULL), RIC_OK);
    for (size_t i = 0; i < n; i++)
      assert_close(sparse[i], dense[i], rounding);
    assert_close(ric_system_energy(b, 0, q, u), ric_system_energy(a, 0, q, u), rounding * (double)n);
    ric_system_destroy(&a);
    ric_system_destroy(&b);
  }
}

static void missing_matrices_and_forces_are_zero(void **state) {
  (void)state;
  const double mass[] = {2, 0, 0, 4};
  ric_mck model = {.coordinates = 2, .mass.values = mass};
  double q[] = {1, 2}, u[] = {3, 4}, q_rate[2], u_rate[2];
  ric_system *s = make(&model, NULL, 0);
  assert_int_equal(ric_system_rate(s, 0, q, u, q_rate, u_rate, NULL), RIC_OK);
  assert_true(u_rate[0] == 0 && u_rate[1] == 0);
  assert_close(ric_system_energy(s, 0, q, u), 41, 0);
  ric_system_destroy(&s);
}

static void impulses_follow_the_inverse_mass(void **state) {
  (void)state;
  random_source source = {.state = 3};
  static random_mck m;
  for (size_t k = 0; k < 40; k++) {
    size_t n = 1 + k % 20, at = random_below(&source, n);
    random_mck_make(&m, n, k % 2 == 0, &source);
    ric_obstacle wall = ric_obstacle_wall(at, 0.3);
    ric_system *s = make(&m.model, &wall, 1);
    double g[MOST], w[MOST], full[MOST] = {0}, q[MOST] = {0};
    contact_direction d = {.g = g, .w = w};
    assert_null(s->model->direction(s, 0, 0, q, &d));
    assert_int_equal(d.count, s->uncoupled ? 1 : n);
    assert_true(d.offset == 0 && d.first <= at && at < d.first + d.count);
    for (size_t i = 0; i < d.count; i++) {
      full[d.first + i] = w[i];
      assert_true(g[i] == (d.first + i == at ? -1 : 0));
    }
    for (size_t i = 0; i < n; i++) /* M w = g */
      assert_close(dot(m.mass + i * n, full, n), i == at ? -1 : 0, rounding);
    ric_system_destroy(&s);
  }
}

/* Floors and walls at random coordinates, some of them at the same, in random states. */
static void held_contacts_stop_and_only_they_push(void **state) {
  (void)state;
  random_source source = {.state = 4};
  static random_mck m;
  enum { COUNT = 8 };
  for (size_t k = 0; k < 200; k++) {
    size_t n = 1 + k % 12;
    double q[MOST], u[MOST], q_rate[MOST], u_rate[MOST], force[MOST], expected[MOST] = {0};
    unsigned char contact[COUNT];
    ric_obstacle obstacles[COUNT];
    random_mck_make(&m, n, k % 3 == 0, &source);
    random_state(&source, n, q, u);
    for (size_t j = 0; j < COUNT; j++) {
      size_t at = random_below(&source, n);
      obstacles[j] =
          random_below(&source, 2) ? ric_obstacle_floor(at, q[at] + 0.1) : ric_obstacle_wall(at, q[at] - 0.1);
      obstacles[j].stiffness = j % 2 ? 10 : INFINITY;
      contact[j] = (unsigned char)random_below(&source, 2) ? (j % 2 ? CONTACT_PRESSED : CONTACT_HELD) : CONTACT_OPEN;
    }
    ric_system *s = make(&m.model, obstacles, COUNT);
    assert_null(s->model->rate(s, contact, 0.4, q, u, q_rate, u_rate));
    for (size_t j = 0; j < COUNT; j++) {
      const ric_obstacle *o = &obstacles[j];
      double lambda;
      assert_null(s->model->reaction(s, contact, j, 0.4, q, u, &lambda));
      assert_true(contact[j] == CONTACT_HELD || lambda == 0);
      if (contact[j] == CONTACT_HELD)
        assert_close(u_rate[o->coordinate], 0, rounding);
      if (contact[j] == CONTACT_PRESSED)
        lambda = 10 * pow(0.1, 1.5);
      expected[o->coordinate] += o->side * lambda;
    }
    contact_forces(&m, 0.4, q, u, u_rate, force);
    for (size_t i = 0; i < n; i++)
      assert_close(force[i], expected[i], 10 * rounding);
    ric_system_destroy(&s);
  }
}

static void contacts_of_one_coordinate_share_its_force(void **state) {
  (void)state;
  const double mass[] = {2, 0.5, 0.5, 1}, stiffness[] = {1, 0, 0, 1}, diagonal[] = {2, 0, 0, 1};
  ric_mck model = {.coordinates = 2, .mass.values = mass, .stiffness.values = stiffness};
  ric_obstacle floors[] = {ric_obstacle_floor(0, -1), ric_obstacle_floor(0, -1), ric_obstacle_wall(1, 5)};
  double q[] = {-1, 0.5}, u[] = {0, 0}, first, second, alone;
  for (int k = 0; k < 2; k++) {
    model.mass.values = k ? diagonal : mass;
    ric_system *s = make(&model, floors, 3);
    assert_null(s->model->reaction(s, (unsigned char[]){CONTACT_HELD, 0, 0}, 0, 0, q, u, &alone));
    assert_null(s->model->reaction(s, (unsigned char[]){CONTACT_HELD, CONTACT_HELD, 0}, 0, 0, q, u, &first));
    assert_null(s->model->reaction(s, (unsigned char[]){CONTACT_HELD, CONTACT_HELD, 0}, 1, 0, q, u, &second));
    assert_close(first, alone / 2, 1e-15);
    assert_close(second, first, 0);
    ric_system_destroy(&s);
  }
}

/* -dE/dq of a state at rest is the force, Hertz's included: central differences with error h^2. */
static void energy_is_the_potential_of_the_forces(void **state) {
  (void)state;
  const double mass[] = {1, 0, 0, 1}, stiffness[] = {2, -1, -1, 3};
  ric_mck model = {.coordinates = 2, .mass.values = mass, .stiffness.values = stiffness};
  ric_obstacle obstacles[] = {ric_obstacle_floor(0, 0.5), ric_obstacle_wall(1, 0.2), ric_obstacle_wall(1, 3)};
  obstacles[0].stiffness = 7;
  obstacles[1].stiffness = obstacles[2].stiffness = 11;
  double q[] = {0.1, 0.6}, u[] = {0, 0}, q_rate[2], u_rate[2], h = 1e-5;
  ric_system *s = make(&model, obstacles, 3);
  assert_int_equal(ric_system_rate(s, 0, q, u, q_rate, u_rate, NULL), RIC_OK);
  for (size_t i = 0; i < 2; i++) {
    double low[] = {q[0], q[1]}, high[] = {q[0], q[1]};
    low[i] -= h;
    high[i] += h;
    assert_close(-(ric_system_energy(s, 0, high, u) - ric_system_energy(s, 0, low, u)) / (2 * h), u_rate[i], 1e-8);
  }
  ric_system_destroy(&s);
}

static void assert_refused(const ric_mck *model, const char *words) {
  ric_system *system;
  ric_error error = {0};
  assert_int_equal(ric_system_create_mck(model, NULL, 0, &system, &error), RIC_EINVAL);
  assert_null(system);
  if (!strstr(error.message, words))
    fail_msg("\"%s\" lacks \"%s\"", error.message, words);
}

static void nonsense_is_refused_by_name(void **state) {
  (void)state;
  const double one[] = {1, 0, 0, 1}, skew[] = {1, 0.5, 0.4, 1}, hole[] = {1, NAN, 0, 1}, bad[] = {0, INFINITY};
  const double diagonal[] = {1, -1};
  const size_t start[] = {0, 1, 2}, back[] = {0, 2, 1}, own[] = {0, 1}, off[] = {1, 0}, far[] = {0, 2};
  ric_mck m = {.coordinates = 2, .mass.values = one};
  assert_refused(&(ric_mck){.mass.values = one}, "coordinates = 0");
  assert_refused(&(ric_mck){.coordinates = 2}, "mass");
  m.mass.values = skew;
  assert_refused(&m, "symmetric");
  m.mass.values = hole;
  assert_refused(&m, "mass[0][1] = nan");
  m.mass = (ric_matrix){one, start, off};
  assert_refused(&m, "diagonal");
  m.mass = (ric_matrix){diagonal, start, own};
  assert_refused(&m, "mass[1][1] = -1");
  m.mass = (ric_matrix){.values = one};
  m.damping.values = hole;
  assert_refused(&m, "damping[0][1] = nan");
  m.damping.values = NULL;
  m.stiffness = (ric_matrix){one, start, far};
  assert_refused(&m, "stiffness: column[1] = 2");
  m.stiffness = (ric_matrix){one, back, own};
  assert_refused(&m, "stiffness: row_start[2]");
  m.stiffness = (ric_matrix){.values = one, .row_start = start};
  assert_refused(&m, "stiffness: column");
  m.stiffness.values = NULL;
  m.frequency = NAN;
  assert_refused(&m, "frequency");
  m.frequency = 1;
  m.force_sin = bad;
  assert_refused(&m, "force_sin[1] = inf");
}

static void indefinite_masses_are_refused(void **state) {
  (void)state;
  const double masses[][4] = {{1, 2, 2, 1}, {1, 1, 1, 1}, {0, 1, 1, 0}, {-1, 0.1, 0.1, 2}, {1, 0, 0, -2}, {1, 0, 0, 0}};
  for (size_t k = 0; k < sizeof masses / sizeof *masses; k++)
    assert_refused(&(ric_mck){.coordinates = 2, .mass.values = masses[k]}, "not positive definite");
  const double scales[] = {1e-12, 3e-7, 3e-7, 1}; /* definite, in units far apart */
  ric_system *s = make(&(ric_mck){.coordinates = 2, .mass.values = scales}, NULL, 0);
  ric_system_destroy(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rates_satisfy_the_equations_of_motion),
      cmocka_unit_test(forms_of_matrices_agree),
      cmocka_unit_test(missing_matrices_and_forces_are_zero),
      cmocka_unit_test(impulses_follow_the_inverse_mass),
      cmocka_unit_test(held_contacts_stop_and_only_they_push),
      cmocka_unit_test(contacts_of_one_coordinate_share_its_force),
      cmocka_unit_test(energy_is_the_potential_of_the_forces),
      cmocka_unit_test(nonsense_is_refused_by_name),
      cmocka_unit_test(indefinite_masses_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
