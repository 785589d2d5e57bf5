/* Scenarios of motions: patterns on chains with all that is asked of them, orbits by modes, matrices, Ritz's method,
 * explored families, users' systems. */
#include "rooms.h"

#include <math.h>

#include "scenario/scenario.h"

static const double period_of_table = 4.71238898038469; /* 3 pi / 2 */

/* --- a pattern on a ring, with the verdicts on it ----------------------------------------------------------------- */

enum { RING = 12 };

typedef struct chain_work {
  scenario s;
  ric_orbit_solver *solver;
  ric_orbit orbit;
  ric_pattern *image;
  ric_multipliers multipliers;
} chain_work;

static int add_parameter(const ric_special_point *point, void *user) {
  *(double *)user += point->parameter;
  return 0;
}

static ric_status judge(chain_work *w, double *value, ric_error *error) {
  const ric_special_range range = {&w->s.chain, w->s.pattern, RIC_ALONG_GAMMA, w->s.period, 0.01, 0.19, 8};
  const double times[2] = {0.3, 1.7};
  double states[2 * RING], M[4 * RING * RING];
  ric_verification verification;
  ric_monodromy monodromy;
  size_t resonances;
  RIC_TRY(ric_chain_resonances(&w->s.chain, RIC_ALONG_GAMMA, w->s.period, 0, 1, NULL, 0, &resonances, error));
  RIC_TRY(ric_orbit_states(w->solver, &w->s.chain, &w->orbit, times, 2, states, NULL, error));
  RIC_TRY(ric_orbit_verify(w->solver, &w->s.chain, &w->orbit, NULL, &verification, error));
  RIC_TRY(ric_orbit_monodromy(w->solver, &w->s.chain, &w->orbit, NULL, M, &monodromy, error));
  RIC_TRY(ric_multipliers_init(&w->multipliers, (size_t)2 * RING, error));
  RIC_TRY(ric_multipliers_of_matrix(M, (size_t)2 * RING, 2, NULL, &w->multipliers, error));
  *value = states[RING] + w->multipliers.largest + (double)resonances;
  RIC_TRY(ric_orbit_special_points(w->solver, &range, add_parameter, value, error));
  return verification.result == RIC_VERIFIED ? RIC_OK : ric_fail(error, RIC_ENUMERIC, "%s", verification.reason);
}

static ric_status solve_image(chain_work *w, ric_error *error) {
  ric_symmetry symmetry = {0};
  w->s = scenario_word("s...", RING / 4, RIC_ENDS_PERIODIC, 0.02, period_of_table);
  if (!w->s.pattern)
    return ric_fail(error, RIC_ENOMEM, "no memory for a pattern");
  RIC_TRY(ric_pattern_reduce(w->s.pattern, w->s.chain.ends, &symmetry, error));
  RIC_TRY(ric_pattern_image(w->s.pattern, w->s.chain.ends, symmetry, &w->image, error));
  RIC_TRY(ric_orbit_solver_create(NULL, &w->solver, error));
  return scenario_solve(&w->s, w->solver, &w->orbit, error);
}

static ric_status chain_pattern(double *value, ric_error *error) {
  chain_work w = {0};
  ric_status status = solve_image(&w, error);
  if (status == RIC_OK)
    status = judge(&w, value, error);
  ric_multipliers_clear(&w.multipliers);
  ric_pattern_destroy(&w.image);
  ric_orbit_clear(&w.orbit);
  ric_orbit_solver_destroy(&w.solver);
  scenario_clear(&w.s);
  return status;
}

/* --- the orbits of a linear system by its modes ------------------------------------------------------------------- */

static int add_ends(const ric_impact_interval *interval, void *user) {
  *(double *)user += interval->low + interval->high;
  return 0;
}

static ric_status find_intervals(const ric_system *system, ric_impact_modes **modes, ric_orbit *orbit, double *value,
                                 ric_error *error) {
  double q[3], frequency[3], shape[9];
  RIC_TRY(ric_normal_modes(system, frequency, shape, error));
  RIC_TRY(ric_impact_modes_create(system, 1, modes, error));
  RIC_TRY(ric_orbit_init(orbit, 3, 1, error));
  RIC_TRY(ric_impact_modes_orbit(*modes, 5.5, orbit, error));
  RIC_TRY(ric_impact_modes_state(*modes, 5.5, 1, q, NULL, error));
  *value = orbit->energy + q[0] + frequency[1];
  return ric_impact_modes_intervals(*modes, 2, 12, 0, add_ends, value, error);
}

static ric_status modes_of_a_chain(double *value, ric_error *error) {
  ric_chain chain = ric_chain_default(3, 0.1);
  ric_system *system = NULL;
  ric_impact_modes *modes = NULL;
  ric_orbit orbit = {0};
  chain.ends = RIC_ENDS_FREE;
  ric_status status = ric_system_create_chain(&chain, &system, error);
  if (status == RIC_OK)
    status = find_intervals(system, &modes, &orbit, value, error);
  ric_orbit_clear(&orbit);
  ric_impact_modes_destroy(&modes);
  ric_system_destroy(&system);
  return status;
}

/* --- matrices with a full mass matrix, two masses that hit at once ------------------------------------------------ */

static ric_status hit_at_once(const ric_system *system, ric_trajectory **trajectory, double *value, ric_error *error) {
  const double q[2] = {0.5, 0.5}, u[2] = {1, 1};
  double M[16];
  ric_monodromy monodromy;
  ric_run run;
  RIC_TRY(ric_trajectory_create(system, NULL, trajectory, error));
  RIC_TRY(ric_trajectory_start(*trajectory, 0, q, u, error));
  RIC_TRY(ric_trajectory_run(*trajectory, 20, NULL, &run, error));
  RIC_TRY(ric_monodromy_find(system, 0, q, u, 0.2, NULL, M, &monodromy, error));
  *value = *ric_trajectory_q(*trajectory) + M[1] + (double)run.events[RIC_EVENT_COUPLED];
  return run.events[RIC_EVENT_COUPLED] > 0 ? RIC_OK : ric_fail(error, RIC_ENUMERIC, "no coupled impacts");
}

static ric_status matrices_with_walls(double *value, ric_error *error) {
  static const double mass[4] = {2, 0.5, 0.5, 2}, damping[4] = {0.02, 0, 0, 0.02}, stiffness[4] = {2, -1, -1, 2};
  static const double force[2] = {1, 1};
  const ric_mck mck = {.coordinates = 2,
                       .mass.values = mass,
                       .damping.values = damping,
                       .stiffness.values = stiffness,
                       .frequency = 0.7,
                       .force_cos = force};
  const ric_obstacle walls[2] = {ric_obstacle_wall(0, 1), ric_obstacle_wall(1, 1)};
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  ric_status status = ric_system_create_mck(&mck, walls, 2, &system, error);
  if (status == RIC_OK)
    status = hit_at_once(system, &trajectory, value, error);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
  return status;
}

/* --- two masses before a wall: shooting, Ritz's method, an explored family ---------------------------------------- */

static const size_t wall_hit = 0;

static const ric_spring springs[3] = {{.linear = 3}, {.linear = 1, .cubic = 0.1}, {.linear = 0}};

static ric_lattice two_masses(void) {
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  lattice.on_site = (ric_spring){0};
  lattice.links = springs;
  return lattice;
}

static ric_status create_masses(ric_system **system, ric_error *error) {
  const ric_obstacle wall = ric_obstacle_wall(1, 2);
  const ric_lattice lattice = two_masses();
  return ric_system_create_lattice(&lattice, &wall, 1, system, error);
}

static ric_shooting_problem even_motion(size_t impacts) {
  return (ric_shooting_problem){
      .kind = RIC_MOTION_EVEN, .at_start = &wall_hit, .start_count = impacts, .flow = ric_flow_options_default()};
}

typedef struct ritz_work {
  ric_system *system;
  ric_shooting *shooting;
  ric_orbit orbit;
  ric_ritz *ritz;
} ritz_work;

static ric_status approximate(ritz_work *w, double *value, ric_error *error) {
  const ric_shooting_problem motion = even_motion(1);
  const ric_ritz_options options = {.functions = 12, .constants = true};
  const double q[2] = {0.65, 2}, u[2] = {0, -0.4}, period = 6.735630;
  double z[4], c[64], error_q, error_v;
  ric_verification verification;
  RIC_TRY(create_masses(&w->system, error));
  RIC_TRY(ric_shooting_create(w->system, &motion, &w->shooting, error));
  RIC_TRY(ric_shooting_guess(w->shooting, q, u, NULL, period, z, error));
  RIC_TRY(ric_shooting_solve(w->shooting, z, period, 0, NULL, error));
  RIC_TRY(ric_orbit_init_for(&w->orbit, w->system, 1, error));
  RIC_TRY(ric_shooting_orbit(w->shooting, z, period, &w->orbit, error));
  RIC_TRY(ric_shooting_verify(w->shooting, z, period, &w->orbit, NULL, &verification, error));
  RIC_TRY(ric_ritz_create(w->system, 0, &options, &w->ritz, error));
  RIC_TRY(ric_ritz_refine(w->ritz, w->shooting, z, period, 0, c, NULL, error));
  RIC_TRY(ric_ritz_error(w->ritz, c, period, w->shooting, z, &error_q, &error_v, error));
  *value = error_q + error_v + ric_ritz_defect(w->ritz, c, period);
  return verification.result == RIC_VERIFIED ? RIC_OK : ric_fail(error, RIC_ENUMERIC, "%s", verification.reason);
}

static ric_status ritz_of_two_masses(double *value, ric_error *error) {
  ritz_work w = {0};
  const ric_status status = approximate(&w, value, error);
  ric_ritz_destroy(&w.ritz);
  ric_orbit_clear(&w.orbit);
  ric_shooting_destroy(&w.shooting);
  ric_system_destroy(&w.system);
  return status;
}

static int add_special(const ric_explore_segment *segment, const ric_family_point *point, void *user) {
  (void)segment;
  if (point->kind != RIC_FAMILY_REGULAR)
    *(double *)user += point->parameter + point->orbit->period;
  return 0;
}

typedef struct explore_work {
  ric_system *system;
  ric_family *family;
  ric_guess guess;
} explore_work;

static ric_status explore(explore_work *w, double *value, ric_error *error) {
  const double small = 0.1;
  const ric_lattice lattice = two_masses();
  const ric_explore_visitor visitor = {.point = add_special, .user = value};
  ric_explore_options options = ric_explore_options_default();
  ric_family_options family = ric_family_options_default();
  ric_family_problem problem = {.motion = even_motion(0), .parameters = 1, .given = small};
  double z[3];
  RIC_TRY(create_masses(&w->system, error));
  problem.system = w->system;
  problem.motion.energy_given = true;
  family.curve.p_low = 0;
  family.curve.p_high = 3.5;
  options.cross = true;
  options.segments = 2;
  RIC_TRY(ric_family_create(&problem, &family, &w->family, error));
  RIC_TRY(ric_guess_init(&w->guess, 2, error));
  RIC_TRY(ric_guess_mode(&lattice, 0, small, &w->guess, error));
  RIC_TRY(ric_family_start(w->family, small, w->guess.q, w->guess.v, NULL, w->guess.period, z, NULL, error));
  *value = 0;
  RIC_TRY(ric_family_explore(w->family, z, small, &options, &visitor, error));
  const ric_obstacle wall = ric_obstacle_wall(1, 2);
  const ric_shooting_problem hit = even_motion(1);
  const ric_guess_problem grazing = {&lattice, &wall, 1, &hit};
  RIC_TRY(ric_guess_grazing_mode(&grazing, 0, 1, &w->guess, error));
  *value += w->guess.period;
  return RIC_OK;
}

static ric_status explored_modes(double *value, ric_error *error) {
  explore_work w = {0};
  const ric_status status = explore(&w, value, error);
  ric_guess_clear(&w.guess);
  ric_family_destroy(&w.family);
  ric_system_destroy(&w.system);
  return status;
}

/* --- systems of users --------------------------------------------------------------------------------------------- */

static int gravity(double t, const double *q, const double *u, double *force, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  force[0] = -1;
  return 0;
}

/* Over a table that is shaken, the number of the user. */
static int height(double t, const double *q, size_t obstacle, double *gap, void *user) {
  (void)obstacle;
  *gap = q[0] - *(const double *)user * sin(3 * t);
  return 0;
}

/* Chatter and sticking. */
static ric_status bounce(const ric_system *system, ric_trajectory **trajectory, double *value, ric_error *error) {
  const double q = 0.5, u = 0;
  ric_run run;
  RIC_TRY(ric_trajectory_create(system, NULL, trajectory, error));
  RIC_TRY(ric_trajectory_start(*trajectory, 0, &q, &u, error));
  RIC_TRY(ric_trajectory_run(*trajectory, 20, NULL, &run, error));
  *value = *ric_trajectory_q(*trajectory);
  return run.events[RIC_EVENT_REST] > 0 ? RIC_OK : ric_fail(error, RIC_ENUMERIC, "the ball does not come to rest");
}

static ric_status ball_on_a_table(double *value, ric_error *error) {
  double amplitude = 0.12, restitution = 0.8;
  const ric_mechanical ball = {.coordinates = 1,
                               .speeds = 1,
                               .obstacles = 1,
                               .restitution = &restitution,
                               .force = gravity,
                               .gap = height,
                               .user = &amplitude};
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  ric_status status = ric_system_create_mechanical(&ball, &system, error);
  if (status == RIC_OK)
    status = bounce(system, &trajectory, value, error);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
  return status;
}

static int driven_rate(double t, const double *x, double *rate, void *user) {
  (void)user;
  rate[0] = x[1];
  rate[1] = 2 * cos(1.4 * t) - 0.1 * x[1] - x[0];
  return 0;
}

static int driven_gap(double t, const double *x, size_t obstacle, double *gap, void *user) {
  (void)t, (void)obstacle, (void)user;
  *gap = 1 - x[0];
  return 0;
}

static int driven_impact(double t, const double *x, size_t obstacle, double *after, void *user) {
  (void)t, (void)obstacle, (void)user;
  after[0] = x[0];
  after[1] = -0.8 * x[1];
  return 0;
}

static ric_status find_exponents(const ric_system *system, ric_trajectory **trajectory, double *value,
                                 ric_error *error) {
  const double x[2] = {0, 0}, hit[2] = {1, 0.5};
  const size_t obstacle = 0;
  double exponents[2], S[4], M[4];
  ric_lyapunov lyapunov;
  ric_monodromy monodromy;
  ric_saltation_kind kind;
  RIC_TRY(ric_saltation_find(system, 0, hit, NULL, &obstacle, 1, 1e-10, S, NULL, &kind, error));
  RIC_TRY(ric_monodromy_find(system, 0, x, NULL, 4.5, NULL, M, &monodromy, error));
  RIC_TRY(ric_trajectory_create(system, NULL, trajectory, error));
  RIC_TRY(ric_trajectory_start(*trajectory, 0, x, NULL, error));
  RIC_TRY(ric_lyapunov_run(*trajectory, 40, NULL, exponents, &lyapunov, error));
  *value = exponents[0] + S[3] + M[0];
  return RIC_OK;
}

static ric_status impact_map_of_a_user(double *value, ric_error *error) {
  const ric_first_order model = {
      .states = 2, .obstacles = 1, .rate = driven_rate, .gap = driven_gap, .impact = driven_impact};
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  ric_status status = ric_system_create_first_order(&model, &system, error);
  if (status == RIC_OK)
    status = find_exponents(system, &trajectory, value, error);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
  return status;
}

const room_scenario motion_scenarios[] = {{"chain_pattern", chain_pattern},
                                          {"modes_of_a_chain", modes_of_a_chain},
                                          {"matrices_with_walls", matrices_with_walls},
                                          {"ritz_of_two_masses", ritz_of_two_masses},
                                          {"explored_modes", explored_modes},
                                          {"ball_on_a_table", ball_on_a_table},
                                          {"impact_map_of_a_user", impact_map_of_a_user},
                                          {0}};
