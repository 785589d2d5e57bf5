/* The complementarity problem of contacts that act together: against enumeration of all sets, and its mechanics. */
#include "support.h"

#include "numeric/complementarity.h"
#include "scenario/random_source.h"

enum { MOST = 12 };

static double dot(const double *a, const double *x, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; i++)
    sum += a[i] * x[i];
  return sum;
}

/* A = G^T G with G [rank][n]. */
static void random_gram(random_source *source, size_t n, size_t rank, double *A) {
  double g[2 * MOST * MOST];
  for (size_t e = 0; e < rank * n; e++)
    g[e] = random_uniform(source, -1, 1);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      A[i * n + j] = 0;
      for (size_t r = 0; r < rank; r++)
        A[i * n + j] += g[r * n + i] * g[r * n + j];
    }
}

/* Gauss with partial pivoting on the set's equations. Returns 0 for a singular matrix. */
static int solve_set(const double *A, const double *b, size_t n, unsigned set, double *z) {
  double m[MOST][MOST + 1];
  size_t member[MOST], k = 0;
  for (size_t i = 0; i < n; i++) {
    z[i] = 0;
    if (set >> i & 1)
      member[k++] = i;
  }
  for (size_t i = 0; i < k; i++) {
    for (size_t j = 0; j < k; j++)
      m[i][j] = A[member[i] * n + member[j]];
    m[i][k] = -b[member[i]];
  }
  for (size_t c = 0; c < k; c++) {
    size_t best = c;
    for (size_t i = c + 1; i < k; i++)
      best = fabs(m[i][c]) > fabs(m[best][c]) ? i : best;
    if (!(fabs(m[best][c]) > 0))
      return 0;
    for (size_t j = c; j <= k; j++) {
      double swap = m[c][j];
      m[c][j] = m[best][j];
      m[best][j] = swap;
    }
    for (size_t i = c + 1; i < k; i++)
      for (size_t j = k + 1; j-- > c;)
        m[i][j] -= m[i][c] / m[c][c] * m[c][j];
  }
  for (size_t i = k; i-- > 0;) {
    for (size_t j = i + 1; j < k; j++)
      m[i][k] -= m[i][j] * z[member[j]];
    z[member[i]] = m[i][k] / m[i][i];
  }
  return 1;
}

/* Most that a condition is missed by. */
static double violation(const double *A, const double *b, size_t n, const double *z) {
  double most = 0;
  for (size_t i = 0; i < n; i++) {
    double w = dot(A + i * n, z, n) + b[i];
    most = fmax(most, fmax(-z[i], fmax(-w, fmin(fabs(z[i]), fabs(w)))));
  }
  return most;
}

/* The set whose solution misses the conditions least, of all 2^n: no thought goes into it. */
static double enumerate(const double *A, const double *b, size_t n, double *best) {
  double least = INFINITY, z[MOST];
  for (unsigned set = 0; set < 1u << n; set++) {
    if (!solve_set(A, b, n, set, z))
      continue;
    double off = violation(A, b, n, z);
    if (off < least) {
      least = off;
      memcpy(best, z, n * sizeof *best);
    }
  }
  return least;
}

static double norm(const double *x, size_t n) {
  double most = 0;
  for (size_t i = 0; i < n; i++)
    most = fmax(most, fabs(x[i]));
  return most;
}

/* Conditions hold up to rounding: relative to A z, whose rows have at most n entries of norm(A). */
static void assert_solves(const double *A, const double *b, size_t n, const double *z) {
  double scale = (double)n * norm(A, n * n) * norm(z, n) + norm(b, n);
  for (size_t i = 0; i < n; i++) {
    double w = dot(A + i * n, z, n) + b[i];
    assert_true(z[i] >= 0);
    assert_true(w >= -1e-12 * scale);
    if (z[i] > 0)
      assert_close(w, 0, 1e-12 * scale);
  }
}

static void random_vector(random_source *source, size_t n, double *x) {
  for (size_t i = 0; i < n; i++)
    x[i] = random_uniform(source, -1, 0.5);
}

static void solution_is_that_of_enumeration(void **state) {
  (void)state;
  random_source source = {.state = 1};
  complementarity_work work = {0};
  for (size_t k = 0; k < 10000; k++) {
    size_t n = 1 + k % MOST; /* 2^n sets */
    double A[MOST * MOST], b[MOST], z[MOST], expected[MOST];
    random_gram(&source, n, 2 * n, A);
    random_vector(&source, n, b);
    assert_int_equal(complementarity_solve(&work, n, A, b, z, NULL), RIC_OK);
    assert_solves(A, b, n, z);
    double off = enumerate(A, b, n, expected);
    assert_true(off < 1e-10);
    /* Rounding errors times the condition number, some thousands for Gram matrices of 2n random vectors. */
    for (size_t i = 0; i < n; i++)
      assert_close(z[i], expected[i], 1e-9 * (1 + norm(expected, n)));
  }
  complementarity_clear(&work);
}

static void definite_problems_of_every_size_are_solved(void **state) {
  (void)state;
  random_source source = {.state = 2};
  complementarity_work work = {0};
  for (size_t k = 0; k < 10000; k++) {
    size_t n = 1 + k % MOST;
    double A[MOST * MOST], b[MOST], z[MOST];
    random_gram(&source, n, n + 1, A);
    random_vector(&source, n, b);
    assert_int_equal(complementarity_solve(&work, n, A, b, z, NULL), RIC_OK);
    assert_solves(A, b, n, z);
  }
  complementarity_clear(&work);
}

/* b = G^T v lies in the range of A, as it does for impacts: a solution exists whatever the rank. */
static void redundant_contacts_have_a_solution(void **state) {
  (void)state;
  random_source source = {.state = 3};
  complementarity_work work = {0};
  for (size_t k = 0; k < 10000; k++) {
    size_t n = 2 + k % (MOST - 1), rank = 1 + random_below(&source, n - 1);
    double A[MOST * MOST], b[MOST], z[MOST], x[MOST];
    random_gram(&source, n, rank, A);
    random_vector(&source, n, x);
    for (size_t i = 0; i < n; i++)
      b[i] = dot(A + i * n, x, n);
    assert_int_equal(complementarity_solve(&work, n, A, b, z, NULL), RIC_OK);
    assert_solves(A, b, n, z);
  }
  complementarity_clear(&work);
}

/* b = w - A z from a complementary pair, of any rank and outside the range of A: w is found again, as it is unique. */
static void semidefinite_problems_with_a_solution_are_solved(void **state) {
  (void)state;
  random_source source = {.state = 6};
  complementarity_work work = {0};
  for (size_t k = 0; k < 10000; k++) {
    size_t n = 1 + k % MOST, rank = 1 + random_below(&source, n);
    double A[MOST * MOST], b[MOST], z[MOST], x[MOST], w[MOST];
    random_gram(&source, n, rank, A);
    for (size_t i = 0; i < n; i++) {
      double value = random_uniform(&source, -1, 1);
      x[i] = fmax(value, 0);
      w[i] = fmax(-value, 0);
    }
    for (size_t i = 0; i < n; i++)
      b[i] = w[i] - dot(A + i * n, x, n);
    assert_int_equal(complementarity_solve(&work, n, A, b, z, NULL), RIC_OK);
    assert_solves(A, b, n, z);
    for (size_t i = 0; i < n; i++)
      assert_close(dot(A + i * n, z, n) + b[i], w[i], 1e-9);
  }
  complementarity_clear(&work);
}

static void work_arrays_grow_and_stay(void **state) {
  (void)state;
  complementarity_work work = {0};
  double A[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, b[3] = {-1, -2, 3}, z[3];
  assert_int_equal(complementarity_solve(&work, 0, NULL, NULL, NULL, NULL), RIC_OK);
  assert_int_equal(complementarity_solve(&work, 3, A, b, z, NULL), RIC_OK);
  const double *values = work.values;
  assert_int_equal(complementarity_solve(&work, 1, A, b, z, NULL), RIC_OK);
  assert_int_equal(complementarity_solve(&work, 3, A, b, z, NULL), RIC_OK);
  assert_ptr_equal(work.values, values);
  assert_int_equal(work.capacity, 3);
  complementarity_clear(&work);
  assert_null(work.values);
  complementarity_clear(&work);
}

static void parallel_obstacles_share_their_impulse(void **state) {
  (void)state;
  complementarity_work work = {0};
  double A[9] = {2, 2, 1, 2, 2, 1, 1, 1, 2}, b[3] = {-2, -2, 0.5}, z[3];
  assert_int_equal(complementarity_solve(&work, 3, A, b, z, NULL), RIC_OK);
  assert_solves(A, b, 3, z);
  assert_close(z[0] + z[1], 1, 1e-15);
  complementarity_clear(&work);
}

/* Two contacts that press against each other: pushed together by both, nothing helps. */
static void unsolvable_problems_are_said_to_be(void **state) {
  (void)state;
  complementarity_work work = {0};
  ric_error error;
  double z[2] = {7, 7};
  assert_int_equal(complementarity_solve(&work, 2, (double[]){1, -1, -1, 1}, (double[]){-1, -1}, z, &error),
                   RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "no solution"));
  assert_int_equal(complementarity_solve(&work, 2, (double[]){1, 0, 0, 0}, (double[]){1, -1}, z, NULL), RIC_ENUMERIC);
  assert_int_equal(complementarity_solve(&work, 2, (double[]){1, 2, 2, 1}, (double[]){-1, -1}, z, NULL), RIC_ENUMERIC);
  assert_int_equal(complementarity_solve(&work, 2, (double[]){1, 0, 0, -1}, (double[]){1, 1}, z, NULL), RIC_ENUMERIC);
  assert_int_equal(complementarity_solve(&work, 2, (double[]){1, NAN, NAN, 1}, (double[]){1, 1}, z, NULL),
                   RIC_ENUMERIC);
  assert_int_equal(complementarity_solve(&work, 2, (double[]){1, 0, 0, 1}, (double[]){1, NAN}, z, NULL), RIC_ENUMERIC);
  assert_true(z[0] == 7 && z[1] == 7);
  complementarity_clear(&work);
}

static void diagonal_problems_are_solved_one_by_one(void **state) {
  (void)state;
  complementarity_work work = {0};
  double A[9] = {2, 0, 0, 0, 4, 0, 0, 0, 0}, b[3] = {-1, 3, 0}, z[3];
  assert_int_equal(complementarity_solve(&work, 3, A, b, z, NULL), RIC_OK);
  assert_close(z[0], 0.5, 5e-16); /* the scaling rounds four times */
  assert_true(z[1] == 0 && z[2] == 0);
  complementarity_clear(&work);
}

/* Contact i in units of its own: A -> S A S, b -> S b gives z -> S^-1 z, exactly for powers of two. */
static void units_of_contacts_do_not_matter(void **state) {
  (void)state;
  random_source source = {.state = 4};
  complementarity_work work = {0};
  for (size_t k = 0; k < 1000; k++) {
    size_t n = 1 + k % MOST;
    double A[MOST * MOST], b[MOST], z[MOST], s[MOST], scaled[MOST];
    random_gram(&source, n, n + 2, A);
    random_vector(&source, n, b);
    assert_int_equal(complementarity_solve(&work, n, A, b, z, NULL), RIC_OK);
    for (size_t i = 0; i < n; i++)
      s[i] = ldexp(1, (int)random_below(&source, 80) - 40);
    for (size_t i = 0; i < n; i++) {
      b[i] *= s[i];
      for (size_t j = 0; j < n; j++)
        A[i * n + j] *= s[i] * s[j];
    }
    assert_int_equal(complementarity_solve(&work, n, A, b, scaled, NULL), RIC_OK);
    for (size_t i = 0; i < n; i++)
      assert_close(scaled[i] * s[i], z[i], 0);
  }
  complementarity_clear(&work);
}

/* Impulses of contacts between balls i and i + 1 in a row of unit masses; gap rates u_{i+1} - u_i; e = 1.
 * b = (1 + e) h'-; u+ = u- + G z. */
static void balls_in_contact(size_t balls, double *u) {
  complementarity_work work = {0};
  double A[MOST * MOST] = {0}, b[MOST] = {0}, z[MOST] = {0};
  size_t n = balls - 1;
  for (size_t i = 0; i < n; i++) {
    A[i * n + i] = 2;
    if (i + 1 < n)
      A[i * n + i + 1] = A[(i + 1) * n + i] = -1;
    b[i] = 2 * (u[i + 1] - u[i]);
  }
  assert_int_equal(complementarity_solve(&work, n, A, b, z, NULL), RIC_OK);
  for (size_t i = 0; i < n; i++) {
    u[i] -= z[i];
    u[i + 1] += z[i];
  }
  complementarity_clear(&work);
}

/* Moreau's law: all gap rates that carry an impulse are reversed, so that three balls share the momentum as
 * (-1/3, 2/3, 2/3); impacts in sequence would give (0, 0, 1). Energy and momentum are kept by both. */
static void newtons_cradle_follows_moreau(void **state) {
  (void)state;
  double u[3] = {1, 0, 0};
  balls_in_contact(3, u);
  assert_close(u[0], -1.0 / 3, 1e-15);
  assert_close(u[1], 2.0 / 3, 1e-15);
  assert_close(u[2], 2.0 / 3, 1e-15);
  double two[2] = {1, 0};
  balls_in_contact(2, two);
  assert_close(two[0], 0, 1e-15);
  assert_close(two[1], 1, 1e-15);
}

static void gram_problems_of_many_contacts_are_solved(void **state) {
  (void)state;
  enum { MANY = 40 };
  static double g[MANY * MANY], A[MANY * MANY];
  random_source source = {.state = 5};
  complementarity_work work = {0};
  for (int k = 0; k < 200; k++) {
    size_t rank = 1 + random_below(&source, MANY);
    double b[MANY], z[MANY], v[MANY];
    for (size_t r = 0; r < rank; r++)
      v[r] = random_uniform(&source, -1, 1);
    for (size_t e = 0; e < rank * MANY; e++)
      g[e] = random_uniform(&source, -1, 1);
    for (size_t i = 0; i < MANY; i++) {
      b[i] = dot(g + i * rank, v, rank);
      for (size_t j = 0; j < MANY; j++)
        A[i * MANY + j] = dot(g + i * rank, g + j * rank, rank);
    }
    assert_int_equal(complementarity_solve(&work, MANY, A, b, z, NULL), RIC_OK);
    assert_solves(A, b, MANY, z);
  }
  complementarity_clear(&work);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solution_is_that_of_enumeration),
      cmocka_unit_test(definite_problems_of_every_size_are_solved),
      cmocka_unit_test(redundant_contacts_have_a_solution),
      cmocka_unit_test(semidefinite_problems_with_a_solution_are_solved),
      cmocka_unit_test(work_arrays_grow_and_stay),
      cmocka_unit_test(parallel_obstacles_share_their_impulse),
      cmocka_unit_test(unsolvable_problems_are_said_to_be),
      cmocka_unit_test(diagonal_problems_are_solved_one_by_one),
      cmocka_unit_test(units_of_contacts_do_not_matter),
      cmocka_unit_test(newtons_cradle_follows_moreau),
      cmocka_unit_test(gram_problems_of_many_contacts_are_solved),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
