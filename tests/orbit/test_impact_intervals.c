/* Intervals of periods: what ends them, and that the verdicts of single periods agree. */
#include "support.h"

#include "witness/impact_study.h"

enum { MOST_INTERVALS = 512 };

static const double pi = 3.14159265358979323846;

typedef struct found {
  ric_impact_interval list[MOST_INTERVALS];
  size_t count, until; /* stop after so many */
} found;

static int keep(const ric_impact_interval *interval, void *user) {
  found *f = user;
  assert_in_range(f->count, 0, MOST_INTERVALS - 1);
  f->list[f->count++] = *interval;
  return f->count == f->until;
}

static const found *intervals_of(const impact_study *s, double low, double high, size_t samples) {
  static found f;
  ric_error error;
  f.count = 0;
  f.until = 0;
  if (ric_impact_modes_intervals(s->modes, low, high, samples, keep, &f, &error) != RIC_OK)
    fail_msg("%s", error.message);
  return &f;
}

static void check_end(const ric_impact_interval *i, ric_interval_end low, ric_interval_end high, ric_outcome outcome) {
  assert_int_equal(i->outcome, outcome);
  assert_int_equal(i->low_end, low);
  assert_int_equal(i->high_end, high);
}

/* --- the system of the source ------------------------------------------------------------------------------------- */

/* In order of the period, so backwards in the frequency: above the resonance w_2 / (2 w_1) the family is admissible;
 * from there down to the blow-up the impulse pulls, and on to the touch the wall is passed. */
static void gap_below_the_resonance_ends_at_a_touch_with_the_blow_up_inside(void **state) {
  (void)state;
  impact_study s = impact_study_two_masses();
  const double *w = ric_impact_modes_frequencies(s.modes);
  double longest = 2 * pi / w[0];
  const found *f = intervals_of(&s, longest / 1.3, longest / 1.05, 0);
  const ric_impact_interval *i = f->list;
  assert_int_equal(f->count, 4);
  check_end(&i[0], RIC_INTERVAL_BOUND, RIC_INTERVAL_RESONANCE, RIC_ADMISSIBLE);
  check_end(&i[1], RIC_INTERVAL_RESONANCE, RIC_INTERVAL_BLOW_UP, RIC_INADMISSIBLE);
  check_end(&i[2], RIC_INTERVAL_BLOW_UP, RIC_INTERVAL_GRAZING, RIC_INADMISSIBLE);
  check_end(&i[3], RIC_INTERVAL_GRAZING, RIC_INTERVAL_BOUND, RIC_ADMISSIBLE);
  assert_close(i[0].high, 4 * pi / w[1], 1e-14);
  assert_close(longest / i[0].high, 1.2421043, 5e-8);
  assert_close(longest / i[1].high, 1.2371118, 5e-8);
  assert_close(longest / i[2].high, 1.2335642, 5e-8);
  assert_non_null(strstr(i[0].high_reason, "mode 1 is at resonance (harmonic 2)"));
  assert_non_null(strstr(i[1].reason, "at t = 0 is -"));
  assert_non_null(strstr(i[1].high_reason, "energy grows"));
  assert_non_null(strstr(i[2].reason, "passes its wall"));
  assert_non_null(strstr(i[2].high_reason, "touches its wall at t = 1.05248"));
  assert_string_equal(i[3].reason, "");
  impact_study_clear(&s);
}

/* Below the first mode's frequency down to half of it there is nothing to be had but near the half. */
static void first_admissible_family_ends_at_the_first_mode(void **state) {
  (void)state;
  impact_study s = impact_study_two_masses();
  double longest = 2 * pi / ric_impact_modes_frequencies(s.modes)[0];
  const found *f = intervals_of(&s, longest / 1.1, longest / 0.9, 0);
  assert_int_equal(f->count, 2);
  check_end(&f->list[0], RIC_INTERVAL_BOUND, RIC_INTERVAL_RESONANCE, RIC_ADMISSIBLE);
  check_end(&f->list[1], RIC_INTERVAL_RESONANCE, RIC_INTERVAL_BOUND, RIC_INADMISSIBLE);
  assert_close(f->list[0].high, longest, 1e-14);
  impact_study_clear(&s);
}

/* Frequencies 1 and 2 (1 + 3e-12): the blow-up between both resonances is one with the first of them, and no interval
 * of a few roundings is put in its place. */
static void resonances_nearly_together_leave_no_splinters(void **state) {
  (void)state;
  const double unit[] = {1, 0, 0, 1}, fast = 4 * (1 + 6e-12), pull = (1 - fast) / 2;
  const double stiffness[] = {(1 + fast) / 2, pull, pull, (1 + fast) / 2};
  const ric_mck mck = {.coordinates = 2, .mass.values = unit, .stiffness.values = stiffness};
  const ric_obstacle wall = ric_obstacle_wall(0, 1.5);
  ric_system *system;
  assert_int_equal(ric_system_create_mck(&mck, &wall, 1, &system, NULL), RIC_OK);
  impact_study s = impact_study_of(system, &wall);
  const found *f = intervals_of(&s, 6, 6.6, 0);
  assert_int_equal(f->count, 4);
  for (size_t k = 0; k < f->count; k++)
    assert_true(f->list[k].high - f->list[k].low > 1e-12 * f->list[k].high);
  check_end(&f->list[1], RIC_INTERVAL_RESONANCE, RIC_INTERVAL_GRAZING, RIC_INADMISSIBLE);
  check_end(&f->list[2], RIC_INTERVAL_GRAZING, RIC_INTERVAL_RESONANCE, RIC_ADMISSIBLE);
  impact_study_clear(&s);
}

/* --- any system --------------------------------------------------------------------------------------------------- */

static void for_random_ranges(uint64_t seed, int trials, void (*holds)(impact_study *, const found *)) {
  random_source source = {.state = seed};
  for (int trial = 0; trial < trials; trial++) {
    impact_study s = impact_study_random(&source);
    double longest = 2 * pi / ric_impact_modes_frequencies(s.modes)[0];
    double low = longest * random_uniform(&source, 0.05, 0.6);
    holds(&s, intervals_of(&s, low, low + longest * random_uniform(&source, 0.5, 1.5), 0));
    impact_study_clear(&s);
  }
}

static void check_cover(impact_study *s, const found *f) {
  (void)s;
  for (size_t k = 0; k < f->count; k++) {
    const ric_impact_interval *i = &f->list[k];
    assert_true(i->low < i->high);
    assert_int_equal(i->low_end == RIC_INTERVAL_BOUND, k == 0);
    assert_int_equal(i->high_end == RIC_INTERVAL_BOUND, k + 1 == f->count);
    assert_int_equal(i->reason[0] == '\0', i->outcome == RIC_ADMISSIBLE);
    assert_int_equal(i->low_reason[0] == '\0', i->low_end == RIC_INTERVAL_BOUND);
    if (k == 0)
      continue;
    assert_true(i->low == i[-1].high);
    assert_int_equal(i->low_end, i[-1].high_end);
    assert_string_equal(i->low_reason, i[-1].high_reason);
    if (i->low_end == RIC_INTERVAL_GRAZING)
      assert_int_not_equal(i->outcome, i[-1].outcome);
  }
}

static void intervals_cover_the_range_in_order(void **state) {
  (void)state;
  for_random_ranges(91, 150, check_cover);
}

/* Blow-ups are too near to the resonance of a mode that hardly moves the coordinate to be told from it. */
static bool modes_move_it(const impact_study *s) {
  for (size_t j = 0; j < s->n; j++) {
    double phi = ric_impact_modes_shape(s->modes, j)[s->hit];
    if (phi * phi < 1e-8)
      return false;
  }
  return true;
}

static size_t alternating;

/* The resonances of modes that move the coordinate, and what lies between each two. */
static void check_alternation(impact_study *s, const found *f) {
  const double *w = ric_impact_modes_frequencies(s->modes);
  ric_interval_end last = RIC_INTERVAL_BOUND;
  size_t poles = 0, expected = 0;
  double low = f->list[0].low, high = f->list[f->count - 1].high;
  if (!modes_move_it(s))
    return;
  alternating++;
  for (size_t k = 0; k + 1 < f->count; k++) {
    ric_interval_end end = f->list[k].high_end;
    if (end != RIC_INTERVAL_RESONANCE && end != RIC_INTERVAL_BLOW_UP)
      continue;
    assert_int_not_equal(end, last);
    last = end;
    poles += end == RIC_INTERVAL_RESONANCE;
  }
  for (size_t j = 0; j < s->n; j++)
    expected += (size_t)(floor(w[j] * high / (2 * pi)) - floor(w[j] * low / (2 * pi)));
  assert_int_equal(poles, expected);
}

static void resonances_and_blow_ups_alternate_and_none_is_missing(void **state) {
  (void)state;
  for_random_ranges(92, 150, check_alternation);
  assert_in_range(alternating, 100, 150);
}

static size_t scanned, ends_at_grazing;

/* Single periods are judged with a band of tolerance about an end. */
static void check_scan(impact_study *s, const found *f) {
  double low = f->list[0].low, high = f->list[f->count - 1].high;
  size_t k = 0;
  for (int step = 1; step < 2000; step++) {
    double period = low + (high - low) * step / 2000;
    while (period > f->list[k].high)
      k++;
    impact_study_solve(s, period);
    const ric_impact_interval *i = &f->list[k];
    double away = fmin(period - i->low, i->high - period) / period;
    if (away < 1e-7)
      continue;
    if (s->orbit.outcome != i->outcome)
      fail_msg("n = %zu: period %.17g is %s (%s), in [%.17g, %.17g] that is %s (%s)", s->n, period,
               ric_outcome_name(s->orbit.outcome), s->orbit.reason, i->low, i->high, ric_outcome_name(i->outcome),
               i->reason);
    scanned++;
  }
  for (k = 0; k < f->count; k++)
    ends_at_grazing += f->list[k].high_end == RIC_INTERVAL_GRAZING;
}

static void every_verdict_of_a_scan_agrees_with_the_intervals(void **state) {
  (void)state;
  for_random_ranges(93, 60, check_scan);
  assert_in_range(scanned, 60 * 1900, 60 * 2000);
  assert_in_range(ends_at_grazing, 20, 10000);
}

/* The number after "gap " in a reason. */
static double gap_in(const char *reason) {
  return strtod(strstr(reason, "gap ") + 4, NULL);
}

static double worst_end;

/* How far from a zero of the gap an end is: the gap there over its slope, which a period next to it shows, on the side
 * where the obstacle is passed. */
static void check_touch(impact_study *s, const found *f) {
  for (size_t k = 0; k + 1 < f->count; k++) {
    const ric_impact_interval *i = &f->list[k], *passed = i->outcome == RIC_INADMISSIBLE ? i : i + 1;
    if (i->high_end != RIC_INTERVAL_GRAZING)
      continue;
    double step = copysign(fmin(1e-5 * i->high, (passed->high - passed->low) / 2), passed == i ? -1 : 1);
    if (fabs(step) < 1e-8 * i->high) /* beside a mode that hardly moves it: all of that counts as its resonance */
      continue;
    impact_study_solve(s, i->high + step);
    assert_int_equal(s->orbit.outcome, RIC_INADMISSIBLE);
    double slope = gap_in(s->orbit.reason) / step;
    worst_end = fmax(worst_end, fabs(gap_in(i->high_reason) / slope) / i->high);
  }
}

static void ends_at_grazing_are_located_to_rounding(void **state) {
  (void)state;
  for_random_ranges(94, 150, check_touch);
  assert_true(worst_end > 0);
  assert_close(worst_end, 0, 1e-12);
}

static void more_samples_find_the_same_ends(void **state) {
  (void)state;
  random_source source = {.state = 95};
  for (int trial = 0; trial < 15; trial++) {
    static found coarse;
    impact_study s = impact_study_random(&source);
    double longest = 2 * pi / ric_impact_modes_frequencies(s.modes)[0];
    coarse = *intervals_of(&s, 0.3 * longest, 1.4 * longest, 0);
    const found *fine = intervals_of(&s, 0.3 * longest, 1.4 * longest, 500);
    assert_int_equal(coarse.count, fine->count);
    for (size_t k = 0; k < fine->count; k++)
      assert_close(fine->list[k].high, coarse.list[k].high, 1e-12 * longest);
    impact_study_clear(&s);
  }
}

static void caller_ends_the_search(void **state) {
  (void)state;
  impact_study s = impact_study_two_masses();
  for (size_t until = 1; until < 8; until++) {
    found f = {.until = until};
    assert_int_equal(ric_impact_modes_intervals(s.modes, 2, 30, 0, keep, &f, NULL), RIC_OK);
    assert_int_equal(f.count, until);
  }
  impact_study_clear(&s);
}

static void ends_have_names(void **state) {
  (void)state;
  assert_string_equal(ric_interval_end_name(RIC_INTERVAL_BLOW_UP), "blow_up");
  assert_string_equal(ric_interval_end_name(RIC_INTERVAL_ENDS), "unknown end");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(gap_below_the_resonance_ends_at_a_touch_with_the_blow_up_inside),
      cmocka_unit_test(first_admissible_family_ends_at_the_first_mode),
      cmocka_unit_test(resonances_nearly_together_leave_no_splinters),
      cmocka_unit_test(intervals_cover_the_range_in_order),
      cmocka_unit_test(resonances_and_blow_ups_alternate_and_none_is_missing),
      cmocka_unit_test(every_verdict_of_a_scan_agrees_with_the_intervals),
      cmocka_unit_test(ends_at_grazing_are_located_to_rounding),
      cmocka_unit_test(more_samples_find_the_same_ends),
      cmocka_unit_test(caller_ends_the_search),
      cmocka_unit_test(ends_have_names),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
