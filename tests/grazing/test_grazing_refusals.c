/* Grazing points that the theory does not cover, and requests that make no sense: each refused by name. */
#include "support.h"

#include "witness/grazing_family.h"

static const double two_pi = 6.283185307179586;

/* --- x'' + x' + x = p_0 cos t with gaps of its own --- */

typedef struct shaped {
  double wall; /* 1 in all of them but where it moves */
  double (*gap)(double, double);
} shaped;

static double force_now;

static int force(double t, const double *q, const double *u, double *f, void *user) {
  (void)user;
  f[0] = force_now * cos(t) - u[0] - q[0];
  return 0;
}

static int gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  const shaped *s = user;
  (void)t;
  *h = s->gap(obstacle == 0 ? q[0] : -q[0], s->wall);
  return 0;
}

static double straight(double q, double wall) {
  return wall - q;
}

/* At q = 1, where the motion of amplitude 1 turns, its first and second derivatives along the motion vanish. */
static double flat(double q, double wall) {
  return (1 - q) * (1 - q) + wall;
}

static ric_status set_force(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  (void)system, (void)user, (void)error;
  force_now = p[0];
  *given = two_pi;
  return RIC_OK;
}

static ric_status set_wall(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  shaped *s = user;
  (void)system, (void)error;
  s->wall = p[0];
  *given = two_pi;
  return RIC_OK;
}

typedef struct sought {
  ric_system *system;
  grazing_family at;
} sought;

/* The motion sin t times the force, from the first parameter on. */
static sought seek(shaped *s, size_t obstacles, double from, double to,
                   ric_status (*set)(ric_system *, const double *, double *, void *, ric_error *)) {
  const ric_mechanical model = {
      .coordinates = 1, .speeds = 1, .obstacles = obstacles, .force = force, .gap = gap, .user = s};
  sought k = {.system = NULL};
  assert_int_equal(ric_system_create_mechanical(&model, &k.system, NULL), RIC_OK);
  const ric_family_problem problem = {.system = k.system,
                                      .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                      .set = set,
                                      .user = s,
                                      .parameters = 1};
  ric_family_options options = grazing_family_options(fmin(from, to), fmax(from, to), 0.2);
  options.curve.direction = to - from;
  const double q = 0, u = force_now;
  k.at = grazing_family_from(&problem, &options, from, &q, &u, NULL, two_pi);
  return k;
}

static void sought_clear(sought *k) {
  grazing_family_clear(&k->at);
  ric_system_destroy(&k->system);
}

static void assert_refused(sought *k, const char *word) {
  ric_error error;
  assert_int_equal(ric_grazing_find(k->at.family, k->at.z, k->at.from, NULL, &k->at.grazing, &error), RIC_ENUMERIC);
  print_message("[ %s ]\n", error.message);
  assert_non_null(strstr(error.message, word));
}

static void two_grazing_points_at_once(void **state) {
  (void)state;
  shaped s = {1, straight};
  force_now = 0.5;
  sought k = seek(&s, 2, 0.5, 2, set_force);
  assert_refused(&k, "two grazing points at once");
  sought_clear(&k);
}

static void one_of_them_is_found(void **state) {
  (void)state;
  shaped s = {1, straight};
  force_now = 0.5;
  sought k = seek(&s, 1, 0.5, 2, set_force);
  ric_error error;
  if (ric_grazing_find(k.at.family, k.at.z, 0.5, NULL, &k.at.grazing, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_close(k.at.grazing.parameter, 1, 1e-9);
  assert_close(k.at.grazing.phase, 0.25, 1e-8);
  sought_clear(&k);
}

static void acceleration_near_zero(void **state) {
  (void)state;
  shaped s = {0.5, flat};
  force_now = 1;
  sought k = seek(&s, 1, 0.5, -1, set_wall);
  assert_refused(&k, "A_g near zero");
  sought_clear(&k);
}

static void no_obstacle_on_the_way(void **state) {
  (void)state;
  shaped s = {1, straight};
  force_now = 0.2;
  sought k = seek(&s, 1, 0.2, 0.9, set_force);
  assert_refused(&k, "no obstacle is touched from 0.2 to 0.9");
  sought_clear(&k);
}

/* --- requests --- */

static void assert_invalid(ric_status status, const ric_error *error, const char *word) {
  assert_int_equal(status, RIC_EINVAL);
  if (!strstr(error->message, word))
    fail_msg("%s, expected to name %s", error->message, word);
}

static void requests_out_of_range_are_refused(void **state) {
  (void)state;
  shaped s = {1, straight};
  ric_error error;
  ric_grazing_map map;
  force_now = 0.5;
  sought k = seek(&s, 1, 0.5, 2, set_force);
  ric_grazing *g = &k.at.grazing;
  ric_grazing_options bad[3];
  static const char *const names[3] = {"touch_tol", "degenerate", "transversal"};
  for (int i = 0; i < 3; i++)
    bad[i] = ric_grazing_options_default();
  bad[0].touch_tol = 0;
  bad[1].degenerate = NAN;
  bad[2].transversal = 1;
  for (int i = 0; i < 3; i++)
    assert_invalid(ric_grazing_find(k.at.family, k.at.z, 0.5, &bad[i], g, &error), &error, names[i]);
  assert_invalid(ric_grazing_take(k.at.family, k.at.z, 1, 3, 1, NULL, g, &error), &error, "obstacle = 3");
  assert_int_equal(ric_grazing_take(k.at.family, k.at.z, 0.5, 0, 1.5, NULL, g, &error), RIC_ENUMERIC);
  assert_non_null(strstr(error.message, "no grazing point"));
  assert_int_equal(ric_grazing_find(k.at.family, k.at.z, 0.5, NULL, g, &error), RIC_OK);
  assert_int_equal(ric_grazing_map_init(&map, 2, NULL), RIC_OK);
  /* The speed is (cos t, -sin t, 1): a section that holds it. */
  const double along[3] = {1, 0, -1}, none[3] = {0}, nan[3] = {NAN, 1, 1};
  const ric_grazing_plane planes[] = {{0, along}, {0, none}, {0, nan}, {-1, NULL}, {7, NULL}, {NAN, NULL}};
  for (size_t i = 0; i < sizeof planes / sizeof *planes; i++)
    assert_invalid(ric_grazing_section(k.at.family, g, &planes[i], &map, NULL, &error), &error, "plane.");
  ric_grazing_map_clear(&map);
  assert_int_equal(ric_grazing_map_init(&map, 3, NULL), RIC_OK);
  assert_invalid(ric_grazing_section(k.at.family, g, NULL, &map, NULL, &error), &error, "map.size = 3");
  ric_grazing_map_clear(&map);
  ric_curve_run run;
  assert_invalid(ric_grazing_trace(k.at.family, g, NULL, 65, NULL, NULL, &run, &error), &error, "count = 65");
  sought_clear(&k);
}

static void even_motions_are_refused(void **state) {
  (void)state;
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  const ric_obstacle wall = ric_obstacle_wall(1, 1);
  ric_system *system = NULL;
  ric_error error;
  assert_int_equal(ric_system_create_lattice(&lattice, &wall, 1, &system, NULL), RIC_OK);
  const ric_family_problem problem = {
      .system = system, .motion = {.kind = RIC_MOTION_EVEN, .flow = ric_flow_options_default()}, .parameters = 1};
  ric_family *f = NULL;
  ric_grazing g;
  double z[2] = {0};
  assert_int_equal(ric_family_create(&problem, NULL, &f, NULL), RIC_OK);
  assert_int_equal(ric_grazing_init(&g, ric_family_shooting(f), NULL), RIC_OK);
  assert_invalid(ric_grazing_find(f, z, 5, NULL, &g, &error), &error, "even");
  ric_grazing_clear(&g);
  ric_family_destroy(&f);
  ric_system_destroy(&system);
}

/* --- a search, whose outcomes are no errors ----------------------------------------------------------------------- */

static ric_grazing_search search(sought *k) {
  ric_grazing_search found;
  ric_error error;
  if (ric_grazing_search_along(k->at.family, k->at.z, k->at.from, NULL, &found, &k->at.grazing, &error) != RIC_OK)
    fail_msg("%s", error.message);
  assert_true((found.outcome == RIC_GRAZING_SEARCH_FOUND) == (found.reason[0] == '\0'));
  return found;
}

/* The same search by both functions, to the bit. */
static void a_search_finds_what_is_found(void **state) {
  (void)state;
  shaped s = {1, straight};
  force_now = 0.5;
  sought by_find = seek(&s, 1, 0.5, 2, set_force);
  assert_int_equal(ric_grazing_find(by_find.at.family, by_find.at.z, 0.5, NULL, &by_find.at.grazing, NULL), RIC_OK);
  force_now = 0.5;
  sought by_search = seek(&s, 1, 0.5, 2, set_force);
  const ric_grazing_search found = search(&by_search);
  assert_int_equal(found.outcome, RIC_GRAZING_SEARCH_FOUND);
  assert_true(by_find.at.grazing.parameter == by_search.at.grazing.parameter);
  assert_true(by_find.at.grazing.time == by_search.at.grazing.time);
  assert_int_equal(found.obstacle, 0);
  assert_close(found.parameter, 1, 1e-9);
  assert_close(found.time, two_pi / 4, 1e-8);
  assert_close(found.period, two_pi, 1e-14);
  assert_true(!found.ended);
  sought_clear(&by_find);
  sought_clear(&by_search);
}

static void a_search_to_the_end_of_a_family_finds_none(void **state) {
  (void)state;
  shaped s = {1, straight};
  force_now = 0.5;
  sought k = seek(&s, 1, 0.5, 0.9, set_force);
  const ric_grazing_search found = search(&k);
  assert_int_equal(found.outcome, RIC_GRAZING_SEARCH_NONE);
  assert_true(found.ended && found.run.end == RIC_CURVE_BOUND && found.reached == 0.9);
  assert_true(found.obstacle == SIZE_MAX && isnan(found.parameter));
  sought_clear(&k);
}

static void a_search_tells_where_a_grazing_point_is_degenerate(void **state) {
  (void)state;
  shaped s = {0.5, flat};
  force_now = 1;
  sought k = seek(&s, 1, 0.5, -1, set_wall);
  const ric_grazing_search found = search(&k);
  assert_int_equal(found.outcome, RIC_GRAZING_SEARCH_DEGENERATE);
  assert_non_null(strstr(found.reason, "A_g near zero"));
  assert_int_equal(found.obstacle, 0);
  assert_close(found.parameter, 0, 1e-6);
  sought_clear(&k);
}

/* Two coupled particles before walls, the first of which hits its own once in a period. */
typedef struct coupled {
  ric_lattice lattice;
  ric_spring own[2];
  double force[2];
} coupled;

static ric_status set_coupled_force(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  coupled *c = user;
  c->force[0] = p[0];
  *given = two_pi / c->lattice.frequency;
  return ric_system_set_lattice(system, &c->lattice, error);
}

/* The impact of this family would push the particle through its wall: where the other one comes to its own is no
 * grazing motion. */
static void a_search_leaves_out_motions_that_pass_an_obstacle(void **state) {
  (void)state;
  static const size_t hit = 0;
  coupled c = {.lattice = ric_lattice_default(2, RIC_ENDS_FREE),
               .own = {{.linear = 1, .damping = 0.3}, {.linear = 1, .damping = 0.3}},
               .force = {1, 0}};
  ric_obstacle walls[2] = {ric_obstacle_wall(0, 0.5), ric_obstacle_wall(1, 1.2)};
  ric_system *system = NULL;
  ric_error error;
  walls[0].restitution = walls[1].restitution = 0.8;
  c.lattice.on_sites = c.own;
  c.lattice.link.linear = 0.3;
  c.lattice.frequency = 1.3;
  c.lattice.force_cos = c.force;
  assert_int_equal(ric_system_create_lattice(&c.lattice, walls, 2, &system, NULL), RIC_OK);
  const ric_family_problem problem = {
      .system = system,
      .motion = {.kind = RIC_MOTION_FORCED, .sequence = &hit, .count = 1, .flow = ric_flow_options_default()},
      .set = set_coupled_force,
      .user = &c,
      .parameters = 1};
  const ric_family_options options = grazing_family_options(1, 10, 0.2);
  const double q[2] = {0.5, 0}, u[2] = {-0.5, 0}, time = 1.5, period = two_pi / 1.3;
  sought by_search = {.at = grazing_family_from(&problem, &options, 1, q, u, &time, period)};
  assert_int_equal(search(&by_search).outcome, RIC_GRAZING_SEARCH_NONE);
  sought by_find = {.at = grazing_family_from(&problem, &options, 1, q, u, &time, period)};
  /* at such a point, which the family does come to, nothing can be started */
  assert_int_equal(ric_grazing_find(by_find.at.family, by_find.at.z, 1, NULL, &by_find.at.grazing, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "the gap of obstacle 0"));
  grazing_family_clear(&by_search.at);
  grazing_family_clear(&by_find.at);
  ric_system_destroy(&system);
}

static void a_search_that_does_not_begin_says_so(void **state) {
  (void)state;
  shaped s = {1, straight};
  force_now = 0.5;
  sought k = seek(&s, 1, 0.5, 2, set_force);
  k.at.from = 3; /* out of the family's range */
  assert_int_equal(search(&k).outcome, RIC_GRAZING_SEARCH_FAILED_START);
  sought_clear(&k);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(two_grazing_points_at_once),
                                     cmocka_unit_test(one_of_them_is_found),
                                     cmocka_unit_test(acceleration_near_zero),
                                     cmocka_unit_test(no_obstacle_on_the_way),
                                     cmocka_unit_test(requests_out_of_range_are_refused),
                                     cmocka_unit_test(even_motions_are_refused),
                                     cmocka_unit_test(a_search_finds_what_is_found),
                                     cmocka_unit_test(a_search_to_the_end_of_a_family_finds_none),
                                     cmocka_unit_test(a_search_tells_where_a_grazing_point_is_degenerate),
                                     cmocka_unit_test(a_search_leaves_out_motions_that_pass_an_obstacle),
                                     cmocka_unit_test(a_search_that_does_not_begin_says_so)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
