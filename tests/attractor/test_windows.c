/* Windows of diagrams: lines of the map beside grazing and of an oscillator before a wall, whose edges are known in
 * closed form, and lines of made-up attractors. */
#include "support.h"

#include <ricochet/ricochet.h>

#include "map_lines.h"
#include "section_attractor.h"
#include "witness/grazing_maps.h"

enum { MOST_POINTS = 400, SIZE = 3 };

static const ric_poll no_poll = {0};
static const double two_pi = 6.283185307179586;

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

/* --- the map beside grazing, along d ------------------------------------------------------------------------------ */

typedef struct map_diagram {
  ric_grazing_map map;
  ric_map_line maps;
  ric_map_runner *runner;
  ric_attractor_options options;
  double d[MOST_POINTS], ends[MOST_POINTS][SIZE];
  ric_attractor attractors[MOST_POINTS];
  ric_window_line line;
  size_t runs;
} map_diagram;

static ric_status run_map(double p, const double *start, ric_attractor *attractor, void *user, ric_error *error) {
  map_diagram *m = user;
  const ric_grazing_map *map = &m->map;
  m->runs++;
  for (size_t i = 0; i < SIZE; i++)
    attractor->z[i] = start ? start[i] : 0;
  return ric_map_runner_run(m->runner, 1, &map, &p, attractor, error);
}

static ric_status locate_map(const double *z, double low, double high, ric_window *window, void *user,
                             ric_error *error) {
  map_diagram *m = user;
  return ric_window_locate_cycle(&m->maps, m->d[window->point], z, low, high, no_poll, window, error);
}

static void run_line(map_diagram *m, size_t points, double from, double to, bool follow) {
  ric_error error;
  m->map = example_map(0.5, 0.3);
  m->maps = map_line_along_d(&m->map);
  m->options = ric_attractor_options_default();
  m->options.keep = 0;
  check(ric_map_runner_create(SIZE, &m->options, RIC_MAP_LANES_ONE, &m->runner, &error), &error);
  for (size_t i = 0; i < points; i++) {
    m->d[i] = from + (to - from) * (double)i / (double)(points - 1);
    m->attractors[i] = (ric_attractor){.z = m->ends[i]};
    check(run_map(m->d[i], follow && i > 0 ? m->ends[i - 1] : NULL, &m->attractors[i], m, &error), &error);
  }
  m->runs = 0;
  m->line = (ric_window_line){.points = points,
                              .p = m->d,
                              .attractors = m->attractors,
                              .size = SIZE,
                              .measured = m->options.measure,
                              .follow = follow,
                              .run = run_map,
                              .locate = locate_map,
                              .user = m};
}

static void clear_line(map_diagram *m) {
  ric_map_runner_destroy(&m->runner);
  ric_grazing_map_clear(&m->map);
  free(m);
}

/* Every cycle with one impact that the line comes to has the window of the closed form, and brackets lie about it. */
static void windows_of_maps_have_the_edges_of_the_closed_form(void **state) {
  (void)state;
  for (int k = 0; k < 4; k++) {
    map_diagram *m = calloc(1, sizeof *m);
    ric_windows found;
    ric_error error;
    size_t compared = 0;
    const bool falls = k & 1, follow = k & 2;
    run_line(m, 200, falls ? 0.02 : 5e-4, falls ? 5e-4 : 0.02, follow);
    check(ric_windows_find(&m->line, &found, &error), &error);
    for (size_t i = 0; i < found.count; i++) {
      const ric_window *w = &found.windows[i];
      ric_grazing_window exact;
      assert_true(w->first <= w->point && w->point <= w->last && w->period == m->attractors[w->point].period);
      if (!w->located || w->impacts != 1)
        continue;
      check(ric_grazing_window_find(&m->map, w->period, &exact, &error), &error);
      assert_true(exact.exists);
      assert_close(w->low / exact.low.d, 1, 1e-11);
      assert_close(w->high / exact.high.d, 1, 1e-11);
      assert_int_equal(w->low_kind, exact.low.kind);
      assert_int_equal(w->high_kind, exact.high.kind);
      assert_true(exact.low.d * (1 - 1e-2) < w->low_inside && w->high_inside < exact.high.d * (1 + 1e-2));
      if (!isnan(w->low_outside))
        assert_close(w->low_inside / w->low_outside, 1, 0.0102);
      if (!isnan(w->high_outside))
        assert_close(w->high_outside / w->high_inside, 1, 0.0102);
      compared++;
    }
    print_message("[ %zu windows, %zu of one impact, %zu runs ]\n", found.count, compared, m->runs);
    assert_true(compared >= 3 && m->runs > 0);
    ric_windows_clear(&found);
    clear_line(m);
  }
}

/* --- an oscillator before a wall ---------------------------------------------------------------------------------- */

/* x'' + 3 x' + x = a cos w t, x <= 1. */
typedef struct oscillator {
  ric_lattice lattice;
  ric_system *system;
  ric_motion_section *section;
  ric_attractor_options options;
  ric_family_problem problem;
  double force, w, p[MOST_POINTS];
} oscillator;

static ric_status set_force(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  oscillator *o = user;
  o->force = p[0];
  *given = two_pi / o->w;
  return ric_system_set_lattice(system, &o->lattice, error);
}

static ric_status run_motion(double p, const double *start, ric_attractor *attractor, void *user, ric_error *error) {
  oscillator *o = user;
  double given;
  attractor->z[0] = start ? start[0] : 0;
  attractor->z[1] = start ? start[1] : 0;
  RIC_TRY(set_force(o->system, &p, &given, o, error));
  return ric_motion_section_run(o->section, &o->options, attractor, error);
}

static ric_status locate_motion(const double *z, double low, double high, ric_window *window, void *user,
                                ric_error *error) {
  oscillator *o = user;
  return ric_window_locate_motion(&o->problem, o->p[window->point], 0, z, low, high, window, error);
}

static void the_window_of_smooth_motions_ends_where_they_graze(void **state) {
  (void)state;
  enum { POINTS = 9 };
  oscillator o = {.lattice = ric_lattice_default(1, RIC_ENDS_FREE), .w = 1.7};
  ric_obstacle wall = ric_obstacle_wall(0, 1);
  double ends[POINTS][2];
  ric_attractor attractors[POINTS];
  ric_windows found;
  ric_error error;
  const double grazing = hypot(1 - o.w * o.w, 3 * o.w);
  wall.restitution = 0.8;
  o.lattice.on_site.damping = 3;
  o.lattice.force_cos = &o.force;
  o.lattice.frequency = o.w;
  check(ric_system_create_lattice(&o.lattice, &wall, 1, &o.system, &error), &error);
  const ric_motion_section_options section = ric_motion_section_options_default(two_pi / o.w);
  check(ric_motion_section_create(o.system, &section, &o.section, &error), &error);
  o.problem = (ric_family_problem){.system = o.system,
                                   .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                   .set = set_force,
                                   .user = &o,
                                   .parameters = 1};
  o.options = section_attractor_options(200, 200);
  o.options.keep = 0;
  for (size_t i = 0; i < POINTS; i++) {
    o.p[i] = grazing * (0.6 + 0.07 * (double)i);
    attractors[i] = (ric_attractor){.z = ends[i]};
    check(run_motion(o.p[i], NULL, &attractors[i], &o, &error), &error);
  }
  const ric_window_line line = {.points = POINTS,
                                .p = o.p,
                                .attractors = attractors,
                                .size = 2,
                                .measured = o.options.measure,
                                .run = run_motion,
                                .locate = locate_motion,
                                .user = &o};
  check(ric_windows_find(&line, &found, &error), &error);
  const ric_window *w = found.windows;
  assert_true(found.count >= 1 && w->first == 0 && w->period == 1 && w->located && w->impacts == 0);
  assert_int_equal(w->high_kind, RIC_FAMILY_GRAZING);
  assert_close(w->high, grazing, 1e-10);
  assert_close(w->low, 0.6 * grazing / 10, 1e-12); /* the end of the search */
  assert_int_equal(w->low_kind, RIC_FAMILY_REGULAR);
  assert_true(isnan(w->low_outside) && w->low_inside == o.p[0]);
  assert_true(w->high_inside <= grazing * (1 + 1e-9) && w->high_outside >= w->high_inside);
  ric_windows_clear(&found);
  ric_motion_section_destroy(&o.section);
  ric_system_destroy(&o.system);
}

/* --- made-up attractors ------------------------------------------------------------------------------------------- */

/* What a run comes to at p from a state, and what is said of the edges on the cycle. */
typedef struct fable {
  size_t (*period)(double p, double state, double *end);
  ric_status (*locate)(double p, ric_window *window, ric_error *error);
  double p[MOST_POINTS], ends[MOST_POINTS];
  ric_attractor attractors[MOST_POINTS];
  ric_status stops; /* of a run */
} fable;

static ric_status run_fable(double p, const double *start, ric_attractor *attractor, void *user, ric_error *error) {
  fable *f = user;
  if (f->stops != RIC_OK)
    return ric_fail(error, f->stops, "the run says no");
  attractor->period = f->period(p, start ? *start : 0, attractor->z);
  attractor->kind = attractor->period > 0 ? RIC_ATTRACTOR_PERIODIC : RIC_ATTRACTOR_APERIODIC;
  attractor->impacts = attractor->period > 0 ? 1 / (double)attractor->period : 0.5;
  return RIC_OK;
}

static ric_status locate_fable(const double *z, double low, double high, ric_window *window, void *user,
                               ric_error *error) {
  fable *f = user;
  assert_true(z == &f->ends[window->point] && low < f->p[window->point] && high > f->p[window->point]);
  window->impacts = 1;
  return f->locate(f->p[window->point], window, error);
}

static ric_window_line line_of(fable *f, size_t points, double from, double to, bool follow) {
  const ric_window_line line = {.points = points,
                                .p = f->p,
                                .attractors = f->attractors,
                                .size = 1,
                                .measured = 1200,
                                .follow = follow,
                                .run = run_fable,
                                .locate = locate_fable,
                                .user = f};
  for (size_t i = 0; i < points; i++) {
    f->p[i] = from + (to - from) * (double)i / (double)(points - 1);
    f->attractors[i] = (ric_attractor){.z = &f->ends[i]};
    assert_int_equal(run_fable(f->p[i], follow && i > 0 ? &f->ends[i - 1] : NULL, &f->attractors[i], f, NULL), RIC_OK);
  }
  return line;
}

static ric_status locate_nothing(double p, ric_window *window, ric_error *error) {
  window->low = 7; /* not to be kept */
  return ric_fail(error, RIC_ENUMERIC, "no cycle at %g", p);
}

static size_t two_and_three(double p, double from, double *end) {
  *end = from;
  return p > 0.3 && p < 0.5 ? 2 : p > 0.6 && p < 0.8 ? 3 : 0;
}

static void brackets_hold_the_edges_whichever_way_the_line_goes(void **state) {
  (void)state;
  static const double low[2] = {0.3, 0.6}, high[2] = {0.5, 0.8};
  for (int falls = 0; falls < 2; falls++) {
    fable f = {.period = two_and_three, .locate = locate_nothing};
    const ric_window_line line = line_of(&f, 12, falls ? 0.97 : 0.05, falls ? 0.05 : 0.97, false);
    ric_windows found;
    ric_error error;
    check(ric_windows_find(&line, &found, &error), &error);
    assert_int_equal(found.count, 2);
    for (size_t i = 0; i < 2; i++) {
      const ric_window *w = &found.windows[falls ? 1 - i : i];
      assert_int_equal(w->period, 2 + i);
      assert_true(w->low_outside <= low[i] && low[i] <= w->low_inside && w->low_inside - w->low_outside < 0.01);
      assert_true(w->high_inside <= high[i] && high[i] <= w->high_outside && w->high_outside - w->high_inside < 0.01);
      assert_true(!w->located && isnan(w->low) && isnan(w->high) && w->impacts == -1 && w->low_kind == -1);
      assert_non_null(strstr(w->reason, "no cycle at"));
    }
    ric_windows_clear(&found);
  }
}

/* A window at the end of a line is open there. */
static void windows_at_the_ends_of_a_line_have_no_bracket_there(void **state) {
  (void)state;
  fable f = {.period = two_and_three, .locate = locate_nothing};
  const ric_window_line line = line_of(&f, 5, 0.35, 0.45, false);
  ric_windows found;
  ric_error error;
  check(ric_windows_find(&line, &found, &error), &error);
  assert_int_equal(found.count, 1);
  const ric_window *w = found.windows;
  assert_true(isnan(w->low_outside) && isnan(w->high_outside) && w->low_inside == 0.35 && w->high_inside == 0.45);
  assert_true(w->first == 0 && w->last == 4 && w->point == 2);
  ric_windows_clear(&found);
}

/* Slow attractors beside a flip: no period, the double one, and one whose cycle cannot be found. */
static size_t slow_at_the_end(double p, double from, double *end) {
  *end = from;
  return p > 0.2 && p < 0.3 ? 4 : p >= 0.3 && p < 0.5 ? 2 : p >= 0.5 && p < 0.6 ? 4 : 0;
}

static ric_status locate_two(double p, ric_window *window, ric_error *error) {
  if (window->period != 2)
    return ric_fail(error, RIC_ENUMERIC, "no cycle at %g", p);
  window->low = 0.2;
  window->high = 0.6;
  window->low_kind = window->high_kind = (int)RIC_EDGE_FLIP;
  return RIC_OK;
}

static void points_in_a_window_that_is_located_are_no_windows_of_their_own(void **state) {
  (void)state;
  fable f = {.period = slow_at_the_end, .locate = locate_two};
  const ric_window_line line = line_of(&f, 20, 0.05, 0.95, false);
  ric_windows found;
  ric_error error;
  check(ric_windows_find(&line, &found, &error), &error);
  assert_int_equal(found.count, 1);
  assert_true(found.windows[0].period == 2 && found.windows[0].low == 0.2 && found.windows[0].high == 0.6);
  ric_windows_clear(&found);
}

/* Of two attractors each run stays on its own: up to 0.7, down to 0.4. */
static size_t two_at_once(double p, double from, double *end) {
  *end = p > 0.7 ? 1 : p < 0.4 ? 0 : from;
  return *end > 0 ? 5 : 2;
}

static void lines_that_are_followed_are_bracketed_as_they_were_run(void **state) {
  (void)state;
  for (int falls = 0; falls < 2; falls++) {
    fable f = {.period = two_at_once, .locate = locate_nothing};
    const ric_window_line line = line_of(&f, 11, falls, 1 - falls, true);
    const double edge = falls ? 0.4 : 0.7;
    ric_windows found;
    ric_error error;
    check(ric_windows_find(&line, &found, &error), &error);
    assert_int_equal(found.count, 2);
    for (size_t i = 0; i < 2; i++) {
      const ric_window *w = &found.windows[i];
      const bool upper = w->period == 5;
      const double inside = upper ? w->low_inside : w->high_inside, outside = upper ? w->low_outside : w->high_outside;
      assert_true(fabs(inside - outside) < 0.011 && (inside - edge) * (outside - edge) <= 0);
    }
    ric_windows_clear(&found);
  }
}

/* --- how a search ends -------------------------------------------------------------------------------------------- */

static ric_status locate_stopped(double p, ric_window *window, ric_error *error) {
  (void)window;
  return ric_fail(error, RIC_ESTOPPED, "stopped at %g", p);
}

static void a_search_ends_with_what_its_functions_return(void **state) {
  (void)state;
  fable f = {.period = two_and_three, .locate = locate_stopped};
  ric_window_line line = line_of(&f, 12, 0.05, 0.97, false);
  ric_windows found;
  ric_error error;
  assert_int_equal(ric_windows_find(&line, &found, &error), RIC_ESTOPPED);
  assert_true(found.count == 0 && found.windows == NULL);
  f.stops = RIC_ECALLBACK;
  assert_int_equal(ric_windows_find(&line, &found, &error), RIC_ECALLBACK);
  assert_string_equal(error.message, "the run says no");
  line.points = 0;
  assert_int_equal(ric_windows_find(&line, &found, &error), RIC_EINVAL);
  ric_windows_clear(&found);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(windows_of_maps_have_the_edges_of_the_closed_form),
      cmocka_unit_test(the_window_of_smooth_motions_ends_where_they_graze),
      cmocka_unit_test(brackets_hold_the_edges_whichever_way_the_line_goes),
      cmocka_unit_test(windows_at_the_ends_of_a_line_have_no_bracket_there),
      cmocka_unit_test(points_in_a_window_that_is_located_are_no_windows_of_their_own),
      cmocka_unit_test(lines_that_are_followed_are_bracketed_as_they_were_run),
      cmocka_unit_test(a_search_ends_with_what_its_functions_return),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
