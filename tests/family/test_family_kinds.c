/* Kinds of special points that need motions of their own, where closed forms say where they are: torus, order,
 * impulse_sign. */
#include "support.h"

#include "witness/recorded_run.h"
#include "reference.h"

enum { MOST = 16, NUMBERS = 12 };

static const double turn = 6.283185307179586;

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

/* What a walk has seen: its special points, and how many multipliers lie outside on either side of a place. */
typedef struct walk {
  double place; /* expected */
  ric_family_kind kind[MOST];
  double parameter[MOST], time[MOST], modulus[MOST];
  size_t obstacle[MOST], special;
  size_t before, beyond;         /* regular points on the sides of the place ... */
  size_t out_before, out_beyond; /* ... with a pair of complex multipliers outside */
  double z[NUMBERS];             /* of the last special point */
} walk;

static int look(const ric_family_point *point, void *user) {
  walk *w = user;
  bool beyond = point->parameter > w->place;
  if (point->kind == RIC_FAMILY_REGULAR) {
    size_t outside = point->multipliers && point->multipliers->complex_outside == 2;
    *(beyond ? &w->beyond : &w->before) += 1;
    *(beyond ? &w->out_beyond : &w->out_before) += outside;
    return 0;
  }
  assert_true(w->special < MOST && point->unknowns <= NUMBERS);
  w->kind[w->special] = point->kind;
  w->parameter[w->special] = point->parameter;
  w->time[w->special] = point->time;
  w->modulus[w->special] = point->multipliers ? point->multipliers->largest : NAN;
  w->obstacle[w->special++] = point->obstacle;
  memcpy(w->z, point->z, point->unknowns * sizeof(double));
  return 0;
}

static ric_family_options range(double low, double high) {
  ric_family_options o = ric_family_options_default();
  o.curve.p_low = low;
  o.curve.p_high = high;
  o.curve.step_most = 0.05;
  o.curve.direction = 1;
  return o;
}

/* Walks from the lower end of the range to the upper one. */
static void follow(ric_family *family, double *z, double low, walk *w) {
  ric_curve_run run;
  ric_error error;
  check(ric_family_follow(family, z, low, NULL, look, w, &run, &error), &error);
  assert_int_equal(run.end, RIC_CURVE_BOUND);
  assert_int_equal(run.missed, 0);
}

/* The one special point of a walk. */
static void assert_found(const walk *w, ric_family_kind kind, double tolerance) {
  for (size_t k = 0; k < w->special; k++)
    if (w->special != 1 || w->kind[k] != kind)
      print_message("%s at %.12g\n", ric_family_kind_name(w->kind[k]), w->parameter[k]);
  assert_int_equal(w->special, 1);
  assert_int_equal(w->kind[0], kind);
  assert_close(w->parameter[0], w->place, tolerance);
}

/* --- torus, in closed form ---------------------------------------------------------------------------------------- */

/* q'' + c q' + K q = F cos(w t), K = [1 p; -p 2]: damped, with a follower force p. Eigenvalues kappa = 1.5 +- i
 * sqrt(p^2
 * - 1/4) of K give mu^2 + c mu + kappa = 0, imaginary where p^2 = 1/4 + 1.5 c^2. */
static const double flutter_damping = 0.1;

typedef struct flutter {
  double mass[4], damping[4], stiffness[4], push[2];
  ric_mck model;
} flutter;

static void flutter_init(flutter *f) {
  *f = (flutter){.mass = {1, 0, 0, 1},
                 .damping = {flutter_damping, 0, 0, flutter_damping},
                 .stiffness = {1, 0, 0, 2},
                 .push = {1, 0.5}};
  f->model = (ric_mck){.coordinates = 2,
                       .mass.values = f->mass,
                       .damping.values = f->damping,
                       .stiffness.values = f->stiffness,
                       .frequency = 1.7,
                       .force_cos = f->push};
}

static ric_status set_follower(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  flutter *f = user;
  f->stiffness[1] = p[0];
  f->stiffness[2] = -p[0];
  *given = turn / f->model.frequency;
  return ric_system_set_mck(system, &f->model, error);
}

static void forced_motions_become_tori_where_a_follower_force_makes_their_system_flutter(void **state) {
  (void)state;
  flutter f;
  ric_system *system = NULL;
  ric_family *family = NULL;
  ric_error error;
  flutter_init(&f);
  check(ric_system_create_mck(&f.model, NULL, 0, &system, &error), &error);
  const ric_family_problem problem = {.system = system,
                                      .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                      .set = set_follower,
                                      .user = &f,
                                      .parameters = 1};
  const ric_family_options options = range(0.51, 0.54);
  const double q[2] = {0}, u[2] = {0};
  double z[4];
  walk w = {.place = sqrt(0.25 + 1.5 * flutter_damping * flutter_damping)};
  check(ric_family_create(&problem, &options, &family, &error), &error);
  check(ric_family_start(family, 0.51, q, u, NULL, 1, z, NULL, &error), &error);
  follow(family, z, 0.51, &w);
  assert_found(&w, RIC_FAMILY_TORUS, 1e-10);
  assert_close(w.modulus[0], 1, 1e-10);
  assert_true(w.before > 0 && w.out_before == 0);
  assert_true(w.beyond > 0 && w.out_beyond == w.beyond);
  ric_family_destroy(&family);
  ric_system_destroy(&system);
}

/* --- torus, of a motion with impacts ------------------------------------------------------------------------------ */

/* Two damped masses, pushed alike; the second one hits a wall where its springs are loose, once a period. */
typedef struct hammer {
  double masses[2], push[2];
  ric_spring on_sites[2], links[3];
  ric_lattice lattice;
  ric_system *system;
} hammer;

static const double hammer_restitution = 0.7;

static void hammer_init(hammer *h) {
  *h = (hammer){.masses = {1, 2}, .push = {1, 1}, .on_sites = {{1, 0, 0, 0.05}}, .links = {{0}, {2, 0, 0, 0.1}, {0}}};
  ric_obstacle wall = ric_obstacle_wall(1, 0);
  wall.restitution = hammer_restitution;
  h->lattice = ric_lattice_default(2, RIC_ENDS_FREE);
  h->lattice.masses = h->masses;
  h->lattice.on_sites = h->on_sites;
  h->lattice.links = h->links;
  h->lattice.force_cos = h->push;
  h->lattice.frequency = 1.32;
  h->system = lattice_system(&h->lattice, &wall, 1);
}

static ric_status set_frequency(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  hammer *h = user;
  h->lattice.frequency = p[0];
  *given = turn / p[0];
  return ric_system_set_lattice(system, &h->lattice, error);
}

/* Multipliers of the motion at a frequency by an event-driven run with tangent vectors, from half a period after the
 * impact. @param z  a motion nearby */
static ric_multipliers event_driven(hammer *h, ric_family *family, const double *z, double frequency) {
  const double *q = z, *u = z + 2, period = turn / frequency;
  double solved[5], M[16];
  ric_orbit orbit;
  ric_monodromy monodromy;
  ric_multipliers mu;
  ric_error error;
  check(ric_family_start(family, frequency, q, u, &z[4], period, solved, NULL, &error), &error);
  check(ric_orbit_init_for(&orbit, h->system, 1, &error), &error);
  check(ric_shooting_orbit(ric_family_shooting(family), solved, period, &orbit, &error), &error);
  assert_int_equal(orbit.outcome, RIC_ADMISSIBLE);
  check(ric_monodromy_find(h->system, solved[4] + period / 2, orbit.q_half, orbit.v_half, period, NULL, M, &monodromy,
                           &error),
        &error);
  assert_int_equal(monodromy.impacts, 1);
  assert_true(monodromy.closure_error < 1e-10);
  check(ric_multipliers_init(&mu, 4, &error), &error);
  check(ric_multipliers_of_matrix(M, 4, 0, NULL, &mu, &error), &error);
  ric_orbit_clear(&orbit);
  return mu;
}

/* Where the largest modulus is 1, by halving. */
static double bisect(hammer *h, ric_family *family, const double *z, double low, double high) {
  while (high - low > 1e-12) {
    double middle = (low + high) / 2;
    ric_multipliers mu = event_driven(h, family, z, middle);
    *(mu.largest > 1 ? &high : &low) = middle;
    ric_multipliers_clear(&mu);
  }
  return (low + high) / 2;
}

/* det M = e^2 exp(-trace(M^-1 C) T): with a pair of modulus 1, that is the square of the others' modulus. */
static void assert_pair_on_circle(const ric_multipliers *mu, double frequency) {
  double loss = 0.05 + 0.1 + 0.1 / 2, rest = hammer_restitution * exp(-loss * turn / frequency / 2);
  for (int k = 0; k < 4; k++)
    assert_close(hypot(mu->mu[k].re, mu->mu[k].im), k < 2 ? 1 : rest, 1e-9);
  assert_true(mu->mu[0].im > 0.1); /* and no real ones */
}

static void impacting_motions_become_tori_where_event_driven_runs_say_so(void **state) {
  (void)state;
  hammer h;
  ric_family *family = NULL;
  ric_error error;
  static const size_t wall = 0;
  hammer_init(&h);
  const ric_family_problem problem = {
      .system = h.system,
      .motion = {.kind = RIC_MOTION_FORCED, .sequence = &wall, .count = 1, .flow = ric_flow_options_default()},
      .set = set_frequency,
      .user = &h,
      .parameters = 1};
  const ric_family_options options = range(1.32, 1.42);
  const double q[2] = {-0.25, 0}, u[2] = {0.1, -0.8}, time = 2.15;
  double z[5];
  walk w = {.place = 1.374};
  check(ric_family_create(&problem, &options, &family, &error), &error);
  check(ric_family_start(family, 1.32, q, u, &time, turn / 1.32, z, NULL, &error), &error);
  follow(family, z, 1.32, &w);
  w.place = bisect(&h, family, w.z, 1.37, 1.38);
  assert_found(&w, RIC_FAMILY_TORUS, 1e-9);
  ric_multipliers mu = event_driven(&h, family, w.z, w.parameter[0]);
  assert_pair_on_circle(&mu, w.parameter[0]);
  assert_true(w.before > 0 && w.out_before == 0);
  assert_true(w.beyond > 0 && w.out_beyond == w.beyond);
  ric_multipliers_clear(&mu);
  ric_family_destroy(&family);
  ric_system_destroy(&h.system);
}

/* --- two oscillators that know nothing of each other -------------------------------------------------------------- */

/* x'' + c x' + x = A cos(w t), each before a wall of its own; the force on the second one is the parameter. */
typedef struct two {
  double push[2];
  ric_lattice lattice;
  ric_obstacle walls[2];
  ric_system *system;
} two;

static void two_init(two *o, double damping, double restitution, double frequency, double force, double second_wall) {
  *o = (two){.push = {force, force},
             .lattice = ric_lattice_default(2, RIC_ENDS_FREE),
             .walls = {ric_obstacle_wall(0, 1), ric_obstacle_wall(1, second_wall)}};
  o->walls[0].restitution = o->walls[1].restitution = restitution;
  o->lattice.on_site.damping = damping;
  o->lattice.force_cos = o->push;
  o->lattice.frequency = frequency;
  o->system = lattice_system(&o->lattice, o->walls, 2);
}

static ric_status set_second_force(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  two *o = user;
  o->push[1] = p[0];
  *given = turn / o->lattice.frequency;
  return ric_system_set_lattice(system, &o->lattice, error);
}

static ric_family *family_of_two(two *o, ric_motion_kind kind, const size_t *sequence, double low, double high) {
  const ric_family_problem problem = {
      .system = o->system,
      .motion = {.kind = kind, .sequence = sequence, .count = 2, .flow = ric_flow_options_default()},
      .set = set_second_force,
      .user = o,
      .parameters = 1};
  const ric_family_options options = range(low, high);
  ric_family *family = NULL;
  ric_error error;
  check(ric_family_create(&problem, &options, &family, &error), &error);
  return family;
}

/* A row of the closed form: x'' + 0.1 x' + x = A cos(1.5 t), x <= 1, restitution 0.8, one impact a period. */
typedef struct known {
  double force, time, speed;
} known;

static known known_motion(void) {
  reference table = reference_read("impact_oscillator");
  known found = {0};
  for (size_t k = 0; k < table.count && found.speed == 0; k++) {
    const double *x = table.rows[k].value; /* columns: kind, w, n, A, t1, V */
    if (strcmp(table.rows[k].word, "regular") == 0 && x[1] == 1.5 && x[2] == 1 && x[5] == 3)
      found = (known){x[3], x[4], x[5]};
  }
  assert_true(found.speed == 3);
  reference_clear(&table);
  return found;
}

/* --- order -------------------------------------------------------------------------------------------------------- */

/* The second wall and its force are 1.3 times the first: all is, and both impacts come at the same time. A sequence
 * names either one first, and the second in the same period or, `late`, when the next one begins.
 * @param late  the arc that vanishes closes the period */
static void meet_in_order(const known *m, size_t first, bool late) {
  const size_t sequence[2] = {first, 1 - first};
  const double scale = 1.3, period = turn / 1.5, times[2] = {m->time, m->time + (late ? period : 0)};
  const double low = 0.95 * scale * m->force, high = 1.05 * scale * m->force;
  double q[2] = {1, scale}, u[2] = {-0.8 * m->speed, -0.8 * m->speed * scale}, z[NUMBERS];
  two o;
  ric_error error;
  walk w = {.place = scale * m->force};
  two_init(&o, 0.1, 0.8, 1.5, m->force, scale);
  if (!late) /* still to be hit */
    u[1 - first] /= -0.8;
  ric_family *family = family_of_two(&o, RIC_MOTION_FORCED, sequence, low, high);
  check(ric_family_start(family, low, q, u, times, period, z, NULL, &error), &error);
  follow(family, z, low, &w);
  assert_found(&w, RIC_FAMILY_ORDER, 1e-8);
  assert_close(remainder(w.time[0] - m->time, period), 0, 1e-8);
  assert_int_equal(w.obstacle[0], late ? first : 1 - first); /* the one that ends the arc */
  ric_family_destroy(&family);
  ric_system_destroy(&o.system);
}

static void impacts_of_forced_motions_change_their_order_where_two_oscillators_scale(void **state) {
  (void)state;
  known m = known_motion();
  for (size_t first = 0; first < 2; first++) {
    meet_in_order(&m, first, false);
    meet_in_order(&m, first, true);
  }
}

/* Without damping, an even motion hits its wall 1 at t1 and at T - t1: P cos(w t) with c cos t added before t1, and d
 * cos(t - T/2) after it. @returns the force; sets where the motion begins */
static double even_force(double w, double t1, double *begin) {
  double half = turn / w / 2, s = tan(t1) + tan(t1 - half), P = s / (cos(w * t1) * s - 2 * w * sin(w * t1));
  *begin = P + (1 - P * cos(w * t1)) / cos(t1);
  return P * (1 - w * w);
}

static void impacts_of_even_motions_change_their_order_where_two_oscillators_scale(void **state) {
  (void)state;
  const double w = 0.7, t1 = 1.4, scale = 1.3, times[2] = {t1, t1}, u[2] = {0};
  double begin, force = even_force(w, t1, &begin), low = 0.95 * scale * force, high = 1.05 * scale * force, z[NUMBERS];
  const double q[2] = {begin, scale * begin};
  for (size_t first = 0; first < 2; first++) {
    const size_t sequence[2] = {first, 1 - first};
    two o;
    ric_error error;
    walk found = {.place = scale * force};
    two_init(&o, 0, 1, w, force, scale);
    ric_family *family = family_of_two(&o, RIC_MOTION_EVEN, sequence, low, high);
    check(ric_family_start(family, low, q, u, times, turn / w, z, NULL, &error), &error);
    follow(family, z, low, &found);
    assert_found(&found, RIC_FAMILY_ORDER, 1e-8);
    assert_close(found.time[0], t1, 1e-8);
    assert_int_equal(found.obstacle[0], 1 - first);
    ric_family_destroy(&family);
    ric_system_destroy(&o.system);
  }
}

/* --- impulse_sign ------------------------------------------------------------------------------------------------- */

/* A floor at b, hit once a period by the even motion b cos(t - T/2) / cos(T/2): it is left with the speed b tan(T/2),
 * zero at T = 2 pi, where the particle is pulled to 0: away from a floor below, into one above. */
static void impulses_of_a_floor_above_change_sign_where_those_of_one_below_are_lost(void **state) {
  (void)state;
  static const size_t hit = 0;
  for (int above = 0; above < 2; above++) {
    const ric_obstacle floor = ric_obstacle_floor(0, above ? 1 : -1);
    const ric_lattice lattice = ric_lattice_default(1, RIC_ENDS_FREE);
    const double q = 0, u = above ? -0.3 : 0.3;
    ric_family *family = NULL;
    ric_system *system = lattice_system(&lattice, &floor, 1);
    ric_error error;
    walk w = {.place = turn};
    double z[1];
    const ric_family_problem problem = {
        .system = system,
        .motion = {.kind = RIC_MOTION_EVEN, .at_start = &hit, .start_count = 1, .flow = ric_flow_options_default()},
        .parameters = 1};
    ric_family_options options = range(6, 6.6);
    options.multipliers = false; /* they go through infinity there */
    check(ric_family_create(&problem, &options, &family, &error), &error);
    check(ric_family_start(family, 6, &q, &u, NULL, 6, z, NULL, &error), &error);
    assert_close(z[0], floor.position * tan(3.), 1e-11);
    follow(family, z, 6, &w);
    assert_found(&w, above ? RIC_FAMILY_IMPULSE_SIGN : RIC_FAMILY_IMPACT_LOST, 1e-8);
    assert_int_equal(w.obstacle[0], 0);
    assert_close(remainder(w.time[0], turn), 0, 1e-8);
    ric_family_destroy(&family);
    ric_system_destroy(&system);
  }
}

/* Beyond a wall at -1 the smooth motion a cos(w t - phi) has gone all the time but at a = 1, when its trough touches
 * the wall from behind: the impulse is zero there, and the springs push into the wall. The other oscillator goes on
 * with its impacts. A sequence names either one first. */
static void impulses_change_sign_where_a_smooth_motion_touches_the_wall_from_behind(void **state) {
  (void)state;
  const double w = 1.5, period = turn / w, force = hypot(1 - w * w, 0.1 * w);
  const double trough = (atan2(0.1 * w, 1 - w * w) + turn / 2) / w, low = 0.97 * force, high = 1.03 * force;
  known m = known_motion();
  double since = trough - m.time - floor((trough - m.time) / period) * period, z[NUMBERS], turned[NUMBERS];
  const double times[2] = {m.time, m.time + since};
  const double q[2] = {1, -cos(w * since)}, u[2] = {-0.8 * m.speed, -w * sin(w * since)};
  for (size_t first = 0; first < 2; first++) {
    const size_t sequence[3] = {0, 1, 0};
    two o;
    ric_error error;
    walk found = {.place = force};
    two_init(&o, 0.1, 0.8, w, m.force, -1);
    ric_family *family = family_of_two(&o, RIC_MOTION_FORCED, sequence, low, high);
    check(ric_family_start(family, low, q, u, times, period, z, NULL, &error), &error);
    if (first == 1) { /* the same motion, begun at its second impact */
      ric_family_destroy(&family);
      family = family_of_two(&o, RIC_MOTION_FORCED, sequence + 1, low, high);
      memcpy(turned, z + 4, 4 * sizeof *z);
      memcpy(turned + 4, z, 4 * sizeof *z);
      turned[8] = z[9];
      turned[9] = z[8] + period;
    }
    follow(family, first == 1 ? turned : z, low, &found);
    assert_found(&found, RIC_FAMILY_IMPULSE_SIGN, 1e-8);
    assert_int_equal(found.obstacle[0], 1);
    assert_close(remainder(found.time[0] - trough, period), 0, 1e-8);
    ric_family_destroy(&family);
    ric_system_destroy(&o.system);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forced_motions_become_tori_where_a_follower_force_makes_their_system_flutter),
      cmocka_unit_test(impacting_motions_become_tori_where_event_driven_runs_say_so),
      cmocka_unit_test(impacts_of_forced_motions_change_their_order_where_two_oscillators_scale),
      cmocka_unit_test(impacts_of_even_motions_change_their_order_where_two_oscillators_scale),
      cmocka_unit_test(impulses_of_a_floor_above_change_sign_where_those_of_one_below_are_lost),
      cmocka_unit_test(impulses_change_sign_where_a_smooth_motion_touches_the_wall_from_behind),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
