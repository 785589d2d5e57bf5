/* Special points of families of chains against what is known of them otherwise. */
#include "support.h"

#include "witness/recorded_run.h"
#include "witness/solved_orbit.h"

enum { CHAINS = 120, MOST = 64 };

static void check(ric_status status, const ric_error *error) {
  if (status != RIC_OK)
    fail_msg("%s", error->message);
}

/* A chain along its coupling. */
typedef struct chain_family {
  ric_chain chain;
  ric_system *system;
  ric_family *family;
  size_t hits[2][64], count[2];
} chain_family;

static ric_status set_coupling(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  chain_family *c = user;
  (void)given;
  c->chain.gamma = p[0];
  ric_lattice lattice = ric_lattice_of_chain(&c->chain);
  return ric_system_set_lattice(system, &lattice, error);
}

static void chain_family_init(chain_family *c, const scenario *s, const ric_family_options *options) {
  ric_error error;
  *c = (chain_family){.chain = s->chain};
  for (size_t k = 0; k < ric_pattern_impacts(s->pattern); k++) {
    size_t particle = ric_pattern_impact(s->pattern, k);
    int half = ric_pattern_role(s->pattern, particle) == RIC_ROLE_HALF;
    c->hits[half][c->count[half]++] = particle;
  }
  check(ric_system_create_chain(&s->chain, &c->system, &error), &error);
  const ric_family_problem problem = {.system = c->system,
                                      .motion = {.kind = RIC_MOTION_EVEN,
                                                 .at_start = c->hits[0],
                                                 .start_count = c->count[0],
                                                 .at_half = c->hits[1],
                                                 .half_count = c->count[1],
                                                 .flow = ric_flow_options_default()},
                                      .set = set_coupling,
                                      .user = c,
                                      .parameters = 1,
                                      .given = s->period};
  check(ric_family_create(&problem, options, &c->family, &error), &error);
}

static void chain_family_clear(chain_family *c) {
  ric_family_destroy(&c->family);
  ric_system_destroy(&c->system);
}

/* What a walk has found. */
typedef struct findings {
  ric_family_kind kind[MOST];
  double parameter[MOST];
  size_t obstacle[MOST];
  size_t count;
} findings;

static int keep(const ric_family_point *point, void *user) {
  findings *f = user;
  if (point->kind == RIC_FAMILY_REGULAR || f->count == MOST)
    return 0;
  f->kind[f->count] = point->kind;
  f->obstacle[f->count] = point->obstacle;
  f->parameter[f->count++] = point->parameter;
  return 0;
}

/* At resonance impulses vanish, multipliers grow without bound, and rounding decides where others pass 1. */
static bool is_rounding(const findings *f, const ric_critical *c) {
  for (size_t k = 0; k < f->count; k++)
    if (f->kind[k] == RIC_FAMILY_IMPACT_LOST && fabs(f->parameter[k] - c->parameter) < 1e-4)
      return true;
  return c->uncertainty > 1e-6;
}

/* Whether a change of stability is among the points. */
static bool is_told(const findings *f, const ric_critical *c) {
  for (size_t k = 0; k < f->count; k++) {
    ric_family_kind kind = f->kind[k];
    bool same = c->kind == RIC_CRITICAL_MINUS_ONE ? kind == RIC_FAMILY_PERIOD_DOUBLING
                : c->kind == RIC_CRITICAL_COLLISION
                    ? kind == RIC_FAMILY_TORUS
                    : kind == RIC_FAMILY_FOLD || kind == RIC_FAMILY_BRANCH_POINT ||
                          kind == RIC_FAMILY_SYMMETRY_BREAKING || kind == RIC_FAMILY_ENERGY_EXTREME;
    if (same && fabs(f->parameter[k] - c->parameter) < 1e-7 + c->uncertainty)
      return true;
  }
  return false;
}

/* Follows a random chain from no coupling on, and returns up to where. */
static double follow(const scenario *s, double high, findings *found) {
  chain_family c;
  ric_family_options options = ric_family_options_default();
  double z[64], u[64] = {0}, q[64] = {0};
  ric_curve_run run;
  ric_error error;
  *found = (findings){0};
  options.curve.p_low = s->chain.gamma;
  options.curve.p_high = high;
  options.curve.step = 1e-3;
  options.curve.step_most = 2e-3;
  chain_family_init(&c, s, &options);
  check(ric_family_start(c.family, s->chain.gamma, q, u, NULL, s->period, z, NULL, &error), &error);
  ric_status status = ric_family_follow(c.family, z, s->chain.gamma, NULL, keep, found, &run, &error);
  double end = status == RIC_OK && run.end == RIC_CURVE_BOUND ? high : s->chain.gamma;
  chain_family_clear(&c);
  return end;
}

static void changes_of_stability_of_chains_are_told_by_their_kinds(void **state) {
  (void)state;
  random_source source = {.state = 17};
  const scenario_ranges ranges = {
      .most_particles = 8, .highest_gamma = 1e-2, .shortest_period = 3.3, .longest_period = 6};
  size_t told = 0, missed = 0, chains = 0;
  for (int i = 0; i < CHAINS; i++) {
    scenario s = scenario_few(&source, &ranges, 2);
    findings found;
    double low = s.chain.gamma, high = follow(&s, low + 0.15, &found);
    ric_critical critical[MOST];
    size_t count = 0;
    ric_orbit_solver *solver = NULL;
    ric_error error;
    check(ric_orbit_solver_create(NULL, &solver, &error), &error);
    if (high > low)
      check(ric_orbit_critical_points(solver, &s.chain, s.pattern, RIC_ALONG_GAMMA, s.period, low, high, 300, critical,
                                      MOST, &count, &error),
            &error);
    chains += high > low;
    for (size_t k = 0; k < count && k < MOST; k++) {
      if (is_rounding(&found, &critical[k]))
        continue;
      bool is = is_told(&found, &critical[k]);
      told += is;
      missed += !is;
      char text[128];
      if (!is)
        print_message("%s at gamma = %.12g (T = %.15g, %s, ends %d) +- %.3g is not told\n",
                      ric_critical_name(critical[k].kind), critical[k].parameter, s.period,
                      ric_pattern_text(s.pattern, text, sizeof text), (int)s.chain.ends, critical[k].uncertainty);
    }
    ric_orbit_solver_destroy(&solver);
    scenario_clear(&s);
  }
  print_message("[ %zu chains, %zu changes of stability told, %zu not ]\n", chains, told, missed);
  assert_true(chains > CHAINS / 2);
  assert_true(told > 20);
  assert_int_equal(missed, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(changes_of_stability_of_chains_are_told_by_their_kinds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
