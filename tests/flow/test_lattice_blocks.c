/* Pieces of long lattices against the recurrence written down particle by particle for the whole lattice. */
#include "support.h"

#include "witness/system_flow.h"
#include "witness/random_lattice.h"

enum { MOST = 1000, LEVELS = 31 };

typedef struct series {
  double c[LEVELS][MOST];
} series;

/* Coefficient j of a power of a series that a function gives. */
typedef struct extension {
  const series *s;
  const ric_lattice *lattice;
  size_t link; /* of this link, or of particle `link` when on_site */
  int on_site;
} extension;

static double extension_at(const extension *e, int j) {
  size_t n = e->lattice->particles, i = e->link;
  int ring = e->lattice->ends == RIC_ENDS_PERIODIC;
  if (e->on_site)
    return e->s->c[j][i];
  double left = i > 0 ? e->s->c[j][i - 1] : ring ? e->s->c[j][n - 1] : 0;
  return (i < n ? e->s->c[j][i] : ring ? e->s->c[j][0] : 0) - left;
}

static double spring_force(const extension *e, const ric_spring *s, int j, double length) {
  double x[LEVELS], square[LEVELS] = {0}, cube = 0;
  for (int k = 0; k <= j + 1; k++)
    x[k] = extension_at(e, k);
  for (int k = 0; k <= j; k++)
    for (int l = 0; l <= k; l++)
      square[k] += x[l] * x[k - l];
  for (int k = 0; k <= j; k++)
    cube += x[k] * square[j - k];
  return s->linear * x[j] + s->quadratic * square[j] + s->cubic * cube + s->damping * (j + 1) * x[j + 1] / length;
}

static double forcing(const ric_lattice *l, size_t i, int j, double start, double length) {
  double term = 1, w = l->frequency, quarter = 1.5707963267948966 * j;
  for (int k = 1; k <= j; k++)
    term *= w * length / k;
  if (!l->force_cos)
    return 0;
  return term * (l->force_cos[i] * cos(w * start + quarter) + l->force_sin[i] * sin(w * start + quarter));
}

static void whole_series(const ric_lattice *l, const double *q, const double *v, double start, double length, int order,
                         series *s) {
  memset(s, 0, sizeof *s);
  for (size_t i = 0; i < l->particles; i++) {
    s->c[0][i] = q[i];
    s->c[1][i] = length * v[i];
  }
  for (int j = 0; j + 2 <= order; j++)
    for (size_t i = 0; i < l->particles; i++) {
      ric_spring own = ric_lattice_on_site(l, i), left = ric_lattice_link(l, i), right = ric_lattice_link(l, i + 1);
      const extension at_own = {s, l, i, 1}, at_left = {s, l, i, 0}, at_right = {s, l, i + 1, 0};
      double force = forcing(l, i, j, start, length) - spring_force(&at_own, &own, j, length) -
                     spring_force(&at_left, &left, j, length) + spring_force(&at_right, &right, j, length);
      s->c[j + 2][i] = length * length * force / ric_lattice_mass(l, i) / ((j + 1) * (j + 2));
    }
}

/* Every coefficient of every piece; the pieces in turn cover the lattice. */
static void compare(const system_flow *m, const series *whole, size_t n) {
  size_t next = 0;
  for (size_t k = 0; k < ric_flow_pieces(m->flow); k++) {
    ric_segment s = ric_flow_piece(m->flow, k);
    assert_int_equal(s.first, next);
    next += s.coordinates;
    for (int j = 0; j <= s.degree; j++)
      for (size_t i = 0; i < s.coordinates; i++) /* coefficients are below 10, each of a hundred terms */
        assert_close(s.coef[(size_t)j * s.stride + i], whole->c[j][s.first + i], 1e-14);
  }
  assert_int_equal(next, n);
}

static void check(size_t n, ric_ends ends, unsigned with, int order) {
  static random_lattice r;
  static series whole;
  static double q[MOST], v[MOST];
  random_source source = {.state = 61 + n};
  ric_flow_options options = ric_flow_options_default();
  options.order = order;
  options.longest_step = 0.5;
  random_lattice_set(&r, &source, n, ends, with);
  random_lattice_state(&source, n, q, v);
  system_flow m = system_flow_of_lattice(&r.lattice, NULL, 0, &options);
  system_flow_start(&m, 0.7, q, v);
  assert_int_equal(ric_flow_step(m.flow, 5, NULL), RIC_OK);
  double length = ric_flow_piece(m.flow, 0).length;
  whole_series(&r.lattice, q, v, 0.7, length, order, &whole);
  compare(&m, &whole, n);
  system_flow_clear(&m);
}

static void for_all_sizes_and_ends(unsigned with, int order) {
  const size_t sizes[] = {1, 2, 3, 4, 5, 8, 9, 30, 255, 256, 257, 512, 600, 1000};
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++)
      check(sizes[k], (ric_ends)ends, with, order);
}

static void linear_pieces_are_those_of_the_whole(void **state) {
  (void)state;
  for_all_sizes_and_ends(0, 25);
}

static void damped_pieces_are_those_of_the_whole(void **state) {
  (void)state;
  for_all_sizes_and_ends(WITH_SITE_DAMPING, 9);
  for_all_sizes_and_ends(WITH_SITE_DAMPING | WITH_LINK_DAMPING, 10);
}

static void nonlinear_pieces_are_those_of_the_whole(void **state) {
  (void)state;
  for_all_sizes_and_ends(WITH_SITES, 12);
  for_all_sizes_and_ends(WITH_LINKS, 13);
}

static void pieces_with_everything_are_those_of_the_whole(void **state) {
  (void)state;
  for_all_sizes_and_ends(WITH_ALL, 4);
  for_all_sizes_and_ends(WITH_ALL, 14);
}

static void the_highest_order_has_its_halo(void **state) {
  (void)state;
  check(300, RIC_ENDS_PERIODIC, WITH_ALL, 30);
  check(300, RIC_ENDS_FIXED, WITH_ALL, 30);
}

/* Constants of a lattice without arrays are filled in another way than those of arrays. */
static void one_value_for_all_is_the_same_as_arrays_of_it(void **state) {
  (void)state;
  static ric_spring on_sites[MOST], links[MOST + 1];
  static double masses[MOST], q[MOST], v[MOST];
  const size_t sizes[] = {1, 2, 3, 4, 256, 257, 700};
  random_source source = {.state = 62};
  random_lattice_state(&source, MOST, q, v);
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
      ric_lattice one = ric_lattice_default(sizes[k], (ric_ends)ends), many = one;
      many.mass = one.mass = 1.5;
      one.on_site = (ric_spring){.linear = 0.8, .cubic = 0.1};
      one.link = (ric_spring){.linear = 0.4, .quadratic = 0.1, .cubic = 0.2, .damping = 0.05};
      for (size_t i = 0; i <= sizes[k]; i++)
        links[i] = one.link;
      for (size_t i = 0; i < sizes[k]; i++) {
        on_sites[i] = one.on_site;
        masses[i] = one.mass;
      }
      many.links = links;
      many.on_sites = on_sites;
      many.masses = masses;
      system_flow a = system_flow_of_lattice(&one, NULL, 0, NULL), b = system_flow_of_lattice(&many, NULL, 0, NULL);
      system_flow_start(&a, 0, q, v);
      system_flow_start(&b, 0, q, v);
      system_flow_run(&a, 2, 0);
      system_flow_run(&b, 2, 1);
      assert_memory_equal(ric_flow_q(a.flow), ric_flow_q(b.flow), sizes[k] * sizeof *q);
      assert_memory_equal(ric_flow_u(a.flow), ric_flow_u(b.flow), sizes[k] * sizeof *v);
      system_flow_clear(&a);
      system_flow_clear(&b);
    }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(linear_pieces_are_those_of_the_whole),
      cmocka_unit_test(damped_pieces_are_those_of_the_whole),
      cmocka_unit_test(nonlinear_pieces_are_those_of_the_whole),
      cmocka_unit_test(pieces_with_everything_are_those_of_the_whole),
      cmocka_unit_test(the_highest_order_has_its_halo),
      cmocka_unit_test(one_value_for_all_is_the_same_as_arrays_of_it),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
