/* Exploring families: Duffing's oscillator, of which reference values tell where families meet, and a forced oscillator
 * before a wall, in closed form. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "reference.h"

static const double turn = 6.283185307179586;

enum { MOST = 64, LISTED = 4000 };

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

/* One forced particle, with a wall at 1 or without, along the frequency or the force. */
typedef struct oscillator {
  ric_lattice lattice;
  double force;
  bool along_force;
  ric_system *system;
  ric_family *family;
  double z[2], start;
} oscillator;

static ric_status set(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  oscillator *o = user;
  if (o->along_force)
    o->force = p[0];
  else
    o->lattice.frequency = p[0];
  o->lattice.force_cos = &o->force;
  *given = turn / o->lattice.frequency;
  return ric_system_set_lattice(system, &o->lattice, error);
}

/* Solves from the guess o->z at the start. */
static void begin(oscillator *o, const ric_obstacle *wall, double from, double to, double step_most, ric_poll poll) {
  ric_error error;
  ric_family_options options = ric_family_options_default();
  options.curve.p_low = fmin(from, to);
  options.curve.p_high = fmax(from, to);
  options.curve.direction = to > from ? 1 : -1;
  options.curve.step_most = step_most;
  options.curve.step = fmin(options.curve.step, step_most);
  options.curve.points = LISTED;
  options.curve.poll = poll;
  o->lattice.force_cos = &o->force;
  check(ric_system_create_lattice(&o->lattice, wall, wall ? 1 : 0, &o->system, &error), &error);
  const ric_family_problem problem = {.system = o->system,
                                      .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                      .set = set,
                                      .user = o,
                                      .parameters = 1};
  check(ric_family_create(&problem, &options, &o->family, &error), &error);
  o->start = from;
  const double q = o->z[0], v = o->z[1];
  check(ric_family_start(o->family, from, &q, &v, NULL, turn, o->z, NULL, &error), &error);
}

static void end(oscillator *o) {
  ric_family_destroy(&o->family);
  ric_system_destroy(&o->system);
}

static oscillator duffing(double force) {
  oscillator o = {.lattice = ric_lattice_default(1, RIC_ENDS_FREE), .force = force};
  o.lattice.on_site = (ric_spring){.linear = 1, .cubic = 1, .damping = 0.1};
  o.lattice.frequency = 1;
  return o;
}

/* Linear, at resonance: it swings with the amplitude force / damping. */
static oscillator resonant(void) {
  oscillator o = {.lattice = ric_lattice_default(1, RIC_ENDS_FREE), .force = 0.05, .along_force = true};
  o.lattice.on_site = (ric_spring){.linear = 1, .damping = 0.1};
  o.lattice.frequency = 1;
  return o;
}

/* What an exploration has told. */
typedef struct told {
  size_t points, listed, after_the_end, stop_at;
  double parameter[LISTED];
  size_t segments, special;
  ric_explore_origin origin[MOST];
  size_t begins_at[MOST], impacts[MOST], points_of[MOST];
  double first_period[MOST], first_parameter[MOST];
  ric_status status[MOST];
  char reason[MOST][256];
  ric_family_kind kind[MOST];
  double place[MOST], period[MOST];
} told;

static int keep_point(const ric_explore_segment *segment, const ric_family_point *point, void *user) {
  told *t = user;
  assert_int_equal(segment->index, t->segments);
  t->after_the_end += t->stop_at > 0 && t->points >= t->stop_at;
  if (point->kind != RIC_FAMILY_REGULAR) {
    assert_true(t->special < MOST);
    t->kind[t->special] = point->kind;
    t->place[t->special] = point->parameter;
    t->period[t->special++] = point->orbit->period;
    return 0;
  }
  if (t->points_of[segment->index]++ == 0) {
    t->first_period[segment->index] = point->orbit->period;
    t->first_parameter[segment->index] = point->parameter;
  }
  if (t->listed < LISTED)
    t->parameter[t->listed++] = point->parameter;
  return ++t->points == t->stop_at;
}

static int keep_end(const ric_explore_segment *segment, void *user) {
  told *t = user;
  assert_true(t->segments < MOST && segment->index == t->segments);
  assert_true(segment->status == RIC_OK || segment->reason[0]);
  t->origin[t->segments] = segment->origin;
  t->begins_at[t->segments] = segment->special;
  t->status[t->segments] = segment->status;
  snprintf(t->reason[t->segments], sizeof *t->reason, "%s", segment->reason);
  t->impacts[t->segments] = segment->family ? ric_shooting_impacts(ric_family_shooting(segment->family)) : 0;
  t->segments++;
  return 0;
}

static ric_status explore(oscillator *o, const ric_explore_options *options, told *t, ric_error *error) {
  const ric_explore_visitor visitor = {.point = keep_point, .end = keep_end, .user = t};
  return ric_family_explore(o->family, o->z, o->start, options, &visitor, error);
}

static const ric_poll no_poll = {0};

/* --- where families begin ----------------------------------------------------------------------------------------- */

static void assert_branch_points_are_those_of_the_reference(const told *t, double force) {
  reference table = reference_read("duffing");
  size_t compared = 0;
  for (size_t k = 0; k < table.count; k++) {
    const reference_row *r = &table.rows[k];
    bool found = false;
    if (strcmp(r->word, "branch") != 0 || r->value[1] != force || r->value[2] != 1 || r->value[3] != 1)
      continue;
    for (size_t i = 0; i < t->special; i++)
      found = found || (t->kind[i] == RIC_FAMILY_BRANCH_POINT && fabs(t->place[i] - r->value[4]) < 1e-8);
    assert_true(found);
    compared++;
  }
  assert_true(compared > 0);
  reference_clear(&table);
}

/* Special points at which families begin, each counted once however often it is found. */
static size_t count_meetings(const told *t, ric_family_kind kind) {
  size_t count = 0;
  for (size_t i = 0; i < t->special; i++) {
    bool again = false;
    for (size_t k = 0; k < i; k++)
      again = again || (t->kind[k] == kind && fabs(t->place[k] - t->place[i]) < 1e-7 &&
                        fabs(t->period[k] - t->period[i]) < 1e-5);
    count += t->kind[i] == kind && !again;
  }
  return count;
}

/* The branch of motions that are not symmetric joins two branch points, and finds the second one from its side. */
static void each_meeting_is_gone_over_once_from_whichever_side(void **state) {
  (void)state;
  oscillator o = duffing(1.5);
  told *t = calloc(1, sizeof *t);
  ric_error error;
  ric_explore_options options = ric_explore_options_default();
  options.branches = true;
  options.segments = MOST;
  begin(&o, NULL, 4, 0.5, 0.02, no_poll);
  check(explore(&o, &options, t, &error), &error);
  const size_t points = count_meetings(t, RIC_FAMILY_BRANCH_POINT),
               doublings = count_meetings(t, RIC_FAMILY_PERIOD_DOUBLING);
  size_t halves = 0, doubled = 0, found = 0;
  for (size_t i = 0; i < t->segments; i++) {
    halves += t->origin[i] == RIC_EXPLORE_BRANCH_POINT;
    doubled += t->origin[i] == RIC_EXPLORE_PERIOD_DOUBLING;
    assert_true((t->begins_at[i] == SIZE_MAX) == (i == 0));
  }
  for (size_t i = 0; i < t->special; i++)
    found += t->kind[i] == RIC_FAMILY_BRANCH_POINT;
  print_message("[ %zu segments, %zu branch points found %zu times, %zu doublings ]\n", t->segments, points, found,
                doublings);
  assert_true(points >= 2 && found > points);
  assert_int_equal(halves, 2 * points);
  assert_int_equal(doubled, doublings);
  assert_int_equal(t->segments, 1 + halves + doubled);
  assert_branch_points_are_those_of_the_reference(t, 1.5);
  for (size_t i = 1; i < t->segments; i++)
    assert_close(t->first_parameter[i], t->place[t->begins_at[i]], 1e-9);
  free(t);
  end(&o);
}

static void families_of_doubled_period_have_it(void **state) {
  (void)state;
  oscillator o = duffing(14);
  told *t = calloc(1, sizeof *t);
  ric_error error;
  size_t doubled = 0;
  ric_explore_options options = ric_explore_options_default();
  options.branches = true;
  o.z[0] = 1.9493139955098952663; /* of the reference, on the branch of motions that are not symmetric */
  o.z[1] = 0.431673117067;
  begin(&o, NULL, 0.7106, 0.73, 0.002, no_poll);
  check(explore(&o, &options, t, &error), &error);
  for (size_t i = 0; i < t->segments; i++)
    if (t->origin[i] == RIC_EXPLORE_PERIOD_DOUBLING && t->points_of[i] > 0) {
      assert_close(t->first_period[i], 2 * t->period[t->begins_at[i]], 1e-6);
      doubled++;
    }
  print_message("[ %zu families of doubled period ]\n", doubled);
  assert_true(doubled > 0);
  free(t);
  end(&o);
}

static void a_family_with_an_impact_begins_where_the_amplitude_reaches_the_wall(void **state) {
  (void)state;
  const ric_obstacle wall = {.coordinate = 0, .side = -1, .position = 1, .restitution = 0.8, .stiffness = INFINITY};
  oscillator o = resonant();
  told *t = calloc(1, sizeof *t);
  ric_error error;
  ric_explore_options options = ric_explore_options_default();
  options.cross = true;
  begin(&o, &wall, 0.05, 0.2, 0.01, no_poll);
  check(explore(&o, &options, t, &error), &error);
  assert_true(t->segments >= 2 && t->origin[1] == RIC_EXPLORE_GRAZING);
  const size_t at = t->begins_at[1];
  assert_int_equal(t->kind[at], RIC_FAMILY_GRAZING);
  assert_close(t->place[at], 0.1, 1e-9);
  assert_int_equal(t->impacts[0], 0);
  assert_int_equal(t->impacts[1], 1);
  assert_true(t->points_of[1] > 5);
  free(t);
  end(&o);
}

/* --- how an exploration ends -------------------------------------------------------------------------------------- */

static int keep_parameter(const ric_family_point *point, void *user) {
  told *t = user;
  if (point->kind == RIC_FAMILY_REGULAR)
    t->parameter[t->listed++] = point->parameter;
  return 0;
}

static void one_segment_is_the_family_that_is_followed(void **state) {
  (void)state;
  oscillator o = duffing(0.5);
  told *alone = calloc(1, sizeof *alone), *followed = calloc(1, sizeof *followed);
  ric_explore_options options = {.cross = true, .branches = true, .segments = 1, .same_point_tol = 1e-6};
  ric_curve_run run;
  ric_error error;
  double z[2];
  begin(&o, NULL, 3, 0.5, 0.1, no_poll);
  memcpy(z, o.z, sizeof z);
  check(explore(&o, &options, alone, &error), &error);
  check(ric_family_follow(o.family, z, o.start, NULL, keep_parameter, followed, &run, &error), &error);
  assert_int_equal(alone->segments, 1);
  assert_int_equal(alone->listed, followed->listed);
  assert_memory_equal(alone->parameter, followed->parameter, followed->listed * sizeof(double));
  free(alone);
  free(followed);
  end(&o);
}

static void no_more_segments_than_allowed_are_followed(void **state) {
  (void)state;
  for (size_t most = 2; most < 5; most++) {
    oscillator o = duffing(1.5);
    told *t = calloc(1, sizeof *t);
    ric_explore_options options = ric_explore_options_default();
    ric_error error;
    options.branches = true;
    options.segments = most;
    begin(&o, NULL, 4, 0.5, 0.02, no_poll);
    check(explore(&o, &options, t, &error), &error);
    assert_int_equal(t->segments, most);
    free(t);
    end(&o);
  }
}

static void the_visitor_ends_it_and_is_told_no_more(void **state) {
  (void)state;
  oscillator o = duffing(0.5);
  told *t = calloc(1, sizeof *t);
  ric_error error;
  t->stop_at = 7;
  begin(&o, NULL, 3, 0.5, 0.1, no_poll);
  check(explore(&o, NULL, t, &error), &error);
  assert_int_equal(t->points, 7);
  assert_int_equal(t->segments, 0);
  assert_int_equal(t->after_the_end, 0);
  free(t);
  end(&o);
}

static void a_start_that_is_no_solution_is_a_segment_with_its_reason(void **state) {
  (void)state;
  oscillator o = duffing(0.5);
  told *t = calloc(1, sizeof *t);
  ric_error error;
  begin(&o, NULL, 3, 0.5, 0.1, no_poll);
  o.start = 4; /* out of its range */
  check(explore(&o, NULL, t, &error), &error);
  assert_int_equal(t->segments, 1);
  assert_int_equal(t->status[0], RIC_EINVAL);
  assert_true(t->points == 0 && t->reason[0][0] != '\0');
  free(t);
  end(&o);
}

static int stop_later(void *user) {
  size_t *left = user;
  return *left > 0 ? --*left == 0 : 0;
}

static void the_poll_stops_it(void **state) {
  (void)state;
  oscillator o = duffing(0.5);
  told *t = calloc(1, sizeof *t);
  size_t left = 0;
  ric_error error;
  begin(&o, NULL, 3, 0.5, 0.1, (ric_poll){stop_later, &left});
  left = 20;
  assert_int_equal(explore(&o, NULL, t, &error), RIC_ESTOPPED);
  assert_int_equal(t->segments, 0);
  free(t);
  end(&o);
}

static void options_out_of_range_are_refused(void **state) {
  (void)state;
  oscillator o = duffing(0.5);
  told *t = calloc(1, sizeof *t);
  ric_explore_options options = ric_explore_options_default();
  ric_error error;
  begin(&o, NULL, 3, 0.5, 0.1, no_poll);
  options.segments = 0;
  assert_int_equal(explore(&o, &options, t, &error), RIC_EINVAL);
  assert_non_null(strstr(error.message, "segments = 0"));
  options = ric_explore_options_default();
  options.same_point_tol = NAN;
  assert_int_equal(explore(&o, &options, t, &error), RIC_EINVAL);
  assert_string_equal(ric_explore_origin_name(RIC_EXPLORE_PERIOD_DOUBLING), "period_doubling");
  assert_non_null(ric_explore_origin_name(RIC_EXPLORE_ORIGINS));
  free(t);
  end(&o);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_meeting_is_gone_over_once_from_whichever_side),
      cmocka_unit_test(families_of_doubled_period_have_it),
      cmocka_unit_test(a_family_with_an_impact_begins_where_the_amplitude_reaches_the_wall),
      cmocka_unit_test(one_segment_is_the_family_that_is_followed),
      cmocka_unit_test(no_more_segments_than_allowed_are_followed),
      cmocka_unit_test(the_visitor_ends_it_and_is_told_no_more),
      cmocka_unit_test(a_start_that_is_no_solution_is_a_segment_with_its_reason),
      cmocka_unit_test(the_poll_stops_it),
      cmocka_unit_test(options_out_of_range_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
