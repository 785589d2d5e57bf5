/* First guesses of periodic motions of lattices. */
#include "ricochet/guess.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/constants.h"
#include "ricochet/elementary.h"
#include "ricochet/family.h"
#include "ricochet/normal_modes.h"
#include "numeric/required.h"
#include "shooting/shooting.h"

/* Most steps of a continuation run in the factor. A motion that continues to 1 takes a dozen, near other families a
 * hundred; more steps follow a motion that grows without bound and never reaches 1. */
enum { MOST_STEPS = 300 };

/* First and longest step in the factor: at a given period, and of motions that graze, whose period is free. */
static const double even_first_step = 0.25, even_longest_step = 1;
static const double grazing_first_step = 0.05, grazing_longest_step = 0.25;

/* Of motions that graze the derivatives are differences, which limits the size of the last correction. */
static const double grazing_newton_tol = 1e-11;

/* Components of a mode of unit length below it are rounding of zero. */
static const double moves_tol = 1e-12;

/* Step along the period that finds the sign of the change of energy: short, since near grazing the energy may have
 * an extreme. */
static const double side_step = 1e-4;

ric_status ric_guess_init(ric_guess *guess, size_t particles, ric_error *error) {
  REQUIRE(error, {"guess", guess});
  *guess = (ric_guess){0};
  if (particles == 0)
    return ric_fail(error, RIC_EINVAL, "particles = 0, expected at least 1");
  guess->q = calloc(particles, sizeof *guess->q);
  guess->v = calloc(particles, sizeof *guess->v);
  if (guess->q && guess->v)
    return RIC_OK;
  ric_guess_clear(guess);
  return ric_fail(error, RIC_ENOMEM, "no memory for a state of %zu particles", particles);
}

void ric_guess_clear(ric_guess *guess) {
  if (!guess)
    return;
  free(guess->q);
  free(guess->v);
  *guess = (ric_guess){0};
}

static void set_rest(ric_guess *guess, size_t particles, double period) {
  memset(guess->q, 0, particles * sizeof *guess->q);
  memset(guess->v, 0, particles * sizeof *guess->v);
  guess->period = period;
  guess->rise = 0;
}

/* --- particles without coupling ----------------------------------------------------------------------------------- */

static bool is_linear(ric_spring spring) {
  return spring.quadratic == 0 && spring.cubic == 0;
}

static ric_spring spring_alone(const ric_lattice *lattice, size_t particle) {
  const ric_spring own = ric_lattice_on_site(lattice, particle);
  return own.linear == 0 && is_linear(own) ? ric_lattice_link(lattice, particle) : own;
}

static ric_status find_amplitude(const ric_lattice *lattice, size_t particle, double period, double *amplitude,
                                 ric_error *error) {
  if (!(particle < lattice->particles))
    return ric_fail(error, RIC_EINVAL, "particle %zu is excited, expected one below %zu", particle, lattice->particles);
  const ric_spring spring = spring_alone(lattice, particle);
  const double mass = ric_lattice_mass(lattice, particle), stiffness = spring.linear / mass;
  const double w = stiffness > 0 ? sqrt(stiffness) : 1, cubic = spring.cubic / mass;
  const double square = 8.0 / 3 * (1 - w * period / (2 * pi)) * (w * w) / cubic;
  if (!(square > 0 && square < INFINITY))
    return ric_fail(error, RIC_EINVAL,
                    "an uncoupled particle has the period %.6g at no amplitude (cubic / mass = %g; linear: %.6g)",
                    period, cubic, 2 * pi / w);
  *amplitude = sqrt(square);
  return RIC_OK;
}

ric_status ric_guess_particles(const ric_lattice *lattice, const size_t *excited, size_t count, double period,
                               ric_guess *guess, ric_error *error) {
  REQUIRE(error, {"lattice", lattice}, {"excited", unless_empty(count, excited)}, {"guess", guess});
  double amplitude;
  RIC_TRY(ric_lattice_check(lattice, error));
  for (size_t k = 0; k < count; k++)
    RIC_TRY(find_amplitude(lattice, excited[k], period, &amplitude, error));
  set_rest(guess, lattice->particles, period);
  for (size_t k = 0; k < count; k++)
    RIC_TRY(find_amplitude(lattice, excited[k], period, &guess->q[excited[k]], error));
  return RIC_OK;
}

/* --- normal modes ------------------------------------------------------------------------------------------------- */

/* Frequency of a mode, and its shape in the caller's array [n].
 * @returns RIC_EINVAL for a mode that does not exist; as ric_normal_modes */
static ric_status find_mode(const ric_system *system, size_t mode, double *frequency, double *shape, ric_error *error) {
  const size_t n = ric_system_coordinates(system);
  if (!(mode < n))
    return ric_fail(error, RIC_EINVAL, "mode = %zu, expected one below %zu", mode, n);
  double *block = calloc(n + n * n, sizeof *block);
  ric_status status = block ? ric_normal_modes(system, block, block + n, error)
                            : ric_fail(error, RIC_ENOMEM, "no memory for the modes of %zu particles", n);
  if (status == RIC_OK) {
    *frequency = block[mode];
    memcpy(shape, block + n + mode * n, n * sizeof *shape);
  }
  free(block);
  return status;
}

/* w^2 a^2 / 2 is the energy of a mode with the amplitude a in normal coordinates. */
static ric_status put_mode(const ric_system *system, size_t mode, double energy, double *shape, ric_guess *guess,
                           ric_error *error) {
  const size_t n = ric_system_coordinates(system);
  double w = 0;
  RIC_TRY(find_mode(system, mode, &w, shape, error));
  if (!(energy > 0 && energy < INFINITY && w > 0))
    return ric_fail(error, RIC_EINVAL, "no first guess: mode %zu has the frequency %g, and no motion of the energy %g",
                    mode, w, energy);
  set_rest(guess, n, 2 * pi / w);
  for (size_t i = 0; i < n; i++)
    guess->q[i] = sqrt(2 * energy) / w * shape[i];
  return RIC_OK;
}

ric_status ric_guess_mode(const ric_lattice *lattice, size_t mode, double energy, ric_guess *guess, ric_error *error) {
  REQUIRE(error, {"lattice", lattice}, {"guess", guess});
  ric_system *system = NULL;
  RIC_TRY(ric_system_create_lattice(lattice, NULL, 0, &system, error));
  double *shape = calloc(lattice->particles, sizeof *shape);
  const ric_status status =
      shape ? put_mode(system, mode, energy, shape, guess, error) : ric_fail(error, RIC_ENOMEM, "no memory for a mode");
  free(shape);
  ric_system_destroy(&system);
  return status;
}

/* --- the lattice with part of its nonlinear terms ----------------------------------------------------------------- */

typedef struct homotopy {
  const ric_guess_problem *problem;
  size_t particles;
  ric_spring *springs; /* [2 n + 1] on-site springs and links of the lattice with scaled nonlinear terms */
  ric_system *system;  /* that lattice; its obstacles are rigid */
  ric_family *family;
  double factor; /* of the nonlinear terms, at the last point */
  double period; /* at the same point */
  double *z;     /* [n] the motion at that point: displacements, but speeds of particles that are hit at t = 0 */
} homotopy;

static ric_spring scale_spring(ric_spring spring, double factor) {
  spring.quadratic *= factor;
  spring.cubic *= factor;
  return spring;
}

static ric_lattice scale_lattice(const homotopy *h, double factor) {
  const size_t n = h->particles;
  ric_lattice lattice = *h->problem->lattice;
  for (size_t i = 0; lattice.on_sites && i < n; i++)
    h->springs[i] = scale_spring(lattice.on_sites[i], factor);
  for (size_t i = 0; lattice.links && i <= n; i++)
    h->springs[n + i] = scale_spring(lattice.links[i], factor);
  lattice.on_site = scale_spring(lattice.on_site, factor);
  lattice.link = scale_spring(lattice.link, factor);
  lattice.on_sites = lattice.on_sites ? h->springs : NULL;
  lattice.links = lattice.links ? h->springs + n : NULL;
  return lattice;
}

static ric_status set_factor(const homotopy *h, double factor, ric_system *system, ric_error *error) {
  const ric_lattice lattice = scale_lattice(h, factor);
  return ric_system_set_lattice(system, &lattice, error);
}

static bool is_linear_lattice(const ric_lattice *lattice) {
  for (size_t i = 0; i < lattice->particles; i++)
    if (!is_linear(ric_lattice_on_site(lattice, i)) || !is_linear(ric_lattice_link(lattice, i)))
      return false;
  return is_linear(ric_lattice_link(lattice, lattice->particles));
}

/* Obstacles are rigid here, Hertz contacts too: the impacts determine the guess. */
static ric_status create_linear(homotopy *h, ric_error *error) {
  const size_t count = h->problem->obstacle_count;
  ric_obstacle *rigid = calloc(count + 1, sizeof *rigid);
  if (!rigid)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu obstacles", count);
  for (size_t j = 0; j < count; j++) {
    rigid[j] = h->problem->obstacles[j];
    rigid[j].stiffness = INFINITY;
  }
  const ric_lattice lattice = scale_lattice(h, 0);
  const ric_status status = ric_system_create_lattice(&lattice, rigid, count, &h->system, error);
  free(rigid);
  return status;
}

static ric_status check_problem(const ric_guess_problem *problem, ric_error *error) {
  const ric_shooting_problem *motion = problem->motion;
  REQUIRE(error, {"motion", motion}, {"lattice", problem->lattice},
          {"obstacles", unless_empty(problem->obstacle_count, problem->obstacles)});
  REQUIRE(error, {"at_start", unless_empty(motion->start_count, motion->at_start)});
  if (motion->kind != RIC_MOTION_EVEN || motion->energy_given)
    return ric_fail(error, RIC_EINVAL, "a first guess from the linear part is for even motions with the period given");
  for (size_t k = 0; k < motion->start_count; k++)
    if (!(motion->at_start[k] < problem->obstacle_count))
      return ric_fail(error, RIC_EINVAL, "at_start[%zu] = %zu, expected one of %zu obstacles", k, motion->at_start[k],
                      problem->obstacle_count);
  return ric_lattice_check(problem->lattice, error);
}

/* The linear part, and room for a motion. @param h  homotopy_clear also after a failure */
static ric_status homotopy_init(homotopy *h, const ric_guess_problem *problem, ric_error *error) {
  *h = (homotopy){.problem = problem};
  RIC_TRY(check_problem(problem, error));
  h->particles = problem->lattice->particles;
  h->springs = calloc(2 * h->particles + 1, sizeof *h->springs);
  h->z = calloc(h->particles, sizeof *h->z);
  if (!h->springs || !h->z)
    return ric_fail(error, RIC_ENOMEM, "no memory for a motion of %zu particles", h->particles);
  return create_linear(h, error);
}

static void homotopy_clear(homotopy *h) {
  ric_family_destroy(&h->family);
  ric_system_destroy(&h->system);
  free(h->springs);
  free(h->z);
}

/* The first state of the motion: positions, but speeds of particles that are hit at t = 0. */
static void put_motion(const homotopy *h, ric_guess *guess) {
  const ric_shooting_problem *motion = h->problem->motion;
  set_rest(guess, h->particles, h->period);
  memcpy(guess->q, h->z, h->particles * sizeof *h->z);
  for (size_t k = 0; k < motion->start_count; k++) {
    const ric_obstacle *o = &h->problem->obstacles[motion->at_start[k]];
    guess->q[o->coordinate] = o->position;
    guess->v[o->coordinate] = h->z[o->coordinate];
  }
}

/* --- even motions with impacts at t = 0 and T/2 ------------------------------------------------------------------- */

/* The parameter is the factor; the period is that of the problem. */
static ric_status set_at_period(ric_system *system, const double *p, double *given, void *user, ric_error *error) {
  (void)given;
  return set_factor(user, p[0], system, error);
}

static ric_status create_even_family(homotopy *h, const ric_shooting_problem *motion, ric_error *error) {
  const ric_family_problem problem = {
      .system = h->system, .motion = *motion, .set = set_at_period, .user = h, .parameters = 1, .given = h->period};
  ric_family_options options = ric_family_options_default();
  options.multipliers = false;
  options.curve.p_low = 0;
  options.curve.p_high = 1;
  options.curve.direction = 1;
  options.curve.step = even_first_step;
  options.curve.step_most = even_longest_step;
  options.curve.points = MOST_STEPS;
  options.curve.poll = motion->poll;
  return ric_family_create(&problem, &options, &h->family, error);
}

static ric_status solve_linear_part(homotopy *h, ric_error *error) {
  ric_error why = {0};
  double *rest = calloc(h->particles, sizeof *rest);
  const ric_status status = rest ? ric_family_start(h->family, 0, rest, rest, NULL, h->period, h->z, NULL, &why)
                                 : ric_fail(&why, RIC_ENOMEM, "no memory for a state");
  free(rest);
  if (status == RIC_ENUMERIC)
    return ric_fail(error, RIC_EINVAL, "no first guess: the linear part has no such motion: %.150s", why.message);
  return status == RIC_OK ? RIC_OK : ric_fail(error, status, "%s", why.message);
}

/* A fold ends the run: beyond it energies grow without bound as the factor returns to zero. */
static int record_even_point(const ric_family_point *point, void *user) {
  homotopy *h = user;
  memcpy(h->z, point->z, point->unknowns * sizeof *h->z);
  h->factor = point->parameter;
  return point->kind == RIC_FAMILY_FOLD;
}

/* Reports why the run did not reach all nonlinear terms. */
static ric_status fail_before_all_terms(const homotopy *h, const ric_curve_run *run, ric_error *error) {
  char begin[RIC_REASON_BYTES];
  snprintf(begin, sizeof begin,
           "the motion of the linear part with the period %.6g does not continue to all nonlinear terms: ", h->period);
  if (run->end == RIC_CURVE_ENDED)
    return ric_fail(error, RIC_ENUMERIC, "%sits family has a fold at %.4g of them", begin, h->factor);
  return ric_fail(error, RIC_ENUMERIC, "%sits family reaches %.4g of them: %.80s", begin, h->factor,
                  run->reason[0] ? run->reason : "no more steps are allowed");
}

static ric_status continue_even(homotopy *h, ric_error *error) {
  ric_curve_run run = {0};
  ric_error why = {0};
  const ric_status status = ric_family_follow(h->family, h->z, 0, NULL, record_even_point, h, &run, &why);
  if (status != RIC_OK)
    return ric_fail(error, status, "the motion of the linear part cannot be continued: %.150s", why.message);
  return run.end == RIC_CURVE_BOUND && h->factor == 1 ? RIC_OK : fail_before_all_terms(h, &run, error);
}

static ric_status find_even(homotopy *h, ric_error *error) {
  ric_shooting_problem motion = *h->problem->motion;
  const bool all = motion.count == 0 && !is_linear_lattice(h->problem->lattice);
  motion.count = 0;
  RIC_TRY(create_even_family(h, &motion, error));
  RIC_TRY(solve_linear_part(h, error));
  return all ? continue_even(h, error) : RIC_OK;
}

/* Depth at which the work against Hertz's force on a unit mass, 2/5 k d^(5/2), equals the kinetic energy v^2 / 2. */
static double find_depth(double speed, double stiffness) {
  return ric_pow(5 * speed * speed / (4 * stiffness), 0.4);
}

/* At a Hertz contact t = 0 is the turning point, at the largest depth. */
static void press_contacts(const ric_guess_problem *problem, ric_guess *guess) {
  for (size_t k = 0; k < problem->motion->start_count; k++) {
    const ric_obstacle *o = &problem->obstacles[problem->motion->at_start[k]];
    const size_t i = o->coordinate;
    if (!(o->stiffness < INFINITY))
      continue;
    guess->q[i] = o->position - o->side * find_depth(guess->v[i], o->stiffness / ric_lattice_mass(problem->lattice, i));
    guess->v[i] = 0;
  }
}

ric_status ric_guess_even(const ric_guess_problem *problem, double period, ric_guess *guess, ric_error *error) {
  REQUIRE(error, {"problem", problem}, {"guess", guess});
  homotopy h;
  ric_status status = homotopy_init(&h, problem, error);
  h.period = period;
  if (status == RIC_OK)
    status = find_even(&h, error);
  if (status == RIC_OK) {
    put_motion(&h, guess);
    press_contacts(problem, guess);
  }
  homotopy_clear(&h);
  return status;
}

/* --- a mode that grazes an obstacle ------------------------------------------------------------------------------- */

static ric_status check_grazing(const ric_guess_problem *problem, size_t swings, ric_error *error) {
  const ric_shooting_problem *motion = problem->motion;
  if (motion->start_count != 1 || motion->half_count > 0 || motion->count > 0 || swings == 0)
    return ric_fail(error, RIC_EINVAL,
                    "%zu impacts at t = 0, %zu others, %zu swings; a mode grazes in one impact at t = 0 after one "
                    "swing or more",
                    motion->start_count, motion->half_count + motion->count, swings);
  if (problem->obstacles[motion->at_start[0]].stiffness < INFINITY)
    return ric_fail(error, RIC_EINVAL, "obstacle %zu is compliant, expected a rigid one for a mode to graze",
                    motion->at_start[0]);
  return RIC_OK;
}

static const ric_obstacle *grazed_obstacle(const homotopy *h) {
  return &h->problem->obstacles[h->problem->motion->at_start[0]];
}

/* The motion of the linear part, where the impact is lost at resonance. */
static ric_status find_linear_mode(homotopy *h, size_t mode, size_t swings, ric_error *error) {
  const ric_obstacle *obstacle = grazed_obstacle(h);
  const size_t particle = obstacle->coordinate;
  double w = 0;
  RIC_TRY(find_mode(h->system, mode, &w, h->z, error));
  const double own = h->z[particle];
  if (!(w > 0 && fabs(own) > moves_tol))
    return ric_fail(error, RIC_EINVAL, "mode %zu, of the frequency %g, moves particle %zu by %.3g: it cannot graze",
                    mode, w, particle, own);
  for (size_t i = 0; i < h->particles; i++)
    h->z[i] = i == particle ? 0 : obstacle->position * h->z[i] / own;
  h->period = (double)swings * 2 * pi / w;
  return RIC_OK;
}

/* The parameters are the period and the factor. */
static ric_status set_period_and_factor(ric_system *system, const double *p, double *given, void *user,
                                        ric_error *error) {
  *given = p[0];
  return set_factor(user, p[1], system, error);
}

static ric_status create_grazing_family(homotopy *h, ric_error *error) {
  const ric_shooting_problem *motion = h->problem->motion;
  const ric_family_problem problem = {.system = h->system,
                                      .motion = *motion,
                                      .set = set_period_and_factor,
                                      .user = h,
                                      .parameters = 2,
                                      .given = h->period};
  ric_family_options options = ric_family_options_default();
  options.multipliers = false;
  options.curve.poll = motion->poll;
  return ric_family_create(&problem, &options, &h->family, error);
}

/* A factor that decreases has passed a fold. */
static int record_grazing_point(const ric_family_curve_point *point, void *user) {
  homotopy *h = user;
  if (point->second < h->factor)
    return 1;
  h->factor = point->second;
  h->period = point->parameter;
  memcpy(h->z, point->z, h->particles * sizeof *h->z);
  return 0;
}

/* @param z  [n] the motion of the linear part; it stays constant while h->z changes */
static ric_status continue_grazing(homotopy *h, size_t mode, const double *z, ric_error *error) {
  const ric_family_point grazing = {.kind = RIC_FAMILY_IMPACT_LOST,
                                    .parameter = h->period,
                                    .unknowns = h->particles,
                                    .z = z,
                                    .given = h->period,
                                    .obstacle = h->problem->motion->at_start[0]};
  ric_curve_options options = ric_curve_options_default();
  ric_curve_run run = {0};
  options.p_low = 0;
  options.p_high = 1;
  options.step = grazing_first_step;
  options.step_most = grazing_longest_step;
  options.points = MOST_STEPS;
  options.newton_tol = grazing_newton_tol;
  options.poll = h->problem->motion->poll;
  RIC_TRY(create_grazing_family(h, error));
  RIC_TRY(ric_family_trace(h->family, &grazing, &options, NULL, record_grazing_point, h, &run, error));
  if (run.end == RIC_CURVE_BOUND && h->factor == 1)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC,
                  "mode %zu grazes its obstacle up to %.4g of the nonlinear terms, not with all of them%s%.80s", mode,
                  h->factor, run.reason[0] ? ": " : "", run.reason);
}

static ric_status add_nonlinear_terms(homotopy *h, size_t mode, ric_error *error) {
  if (is_linear_lattice(h->problem->lattice))
    return RIC_OK;
  double *z = malloc(h->particles * sizeof *z);
  if (!z)
    return ric_fail(error, RIC_ENOMEM, "no memory for a motion of %zu particles", h->particles);
  memcpy(z, h->z, h->particles * sizeof *z);
  const ric_status status = continue_grazing(h, mode, z, error);
  free(z);
  return status;
}

/* Two points of the family with the impact: at grazing and next to it. */
typedef struct grazing_slope {
  size_t particle, count;
  double energy[2], speed[2];
} grazing_slope;

static int record_slope(const ric_family_point *point, void *user) {
  grazing_slope *b = user;
  if (point->kind != RIC_FAMILY_REGULAR)
    return 0;
  b->energy[b->count] = point->orbit->energy;
  b->speed[b->count] = point->z[b->particle];
  return ++b->count == 2;
}

/* Along the period, with all nonlinear terms. */
static ric_status find_grazing_slope(homotopy *h, size_t mode, grazing_slope *b, ric_error *error) {
  const ric_family_problem problem = {.system = h->system, .motion = *h->problem->motion, .parameters = 1};
  ric_family_options options = ric_family_options_default();
  ric_curve_run run = {0};
  options.multipliers = false;
  options.curve.step = side_step;
  options.curve.poll = problem.motion.poll;
  ric_family_destroy(&h->family);
  RIC_TRY(set_factor(h, 1, h->system, error));
  RIC_TRY(ric_family_create(&problem, &options, &h->family, error));
  RIC_TRY(ric_family_follow(h->family, h->z, h->period, NULL, record_slope, b, &run, error));
  if (b->count == 2)
    return RIC_OK;
  return ric_fail(error, RIC_ENUMERIC, "no motion with an impact next to that in which mode %zu grazes: %.100s", mode,
                  run.reason);
}

/* A particle that leaves a floor has a positive speed, one that leaves a wall a negative one. */
static ric_status find_energy_sign(homotopy *h, size_t mode, int *rise, ric_error *error) {
  const ric_obstacle *obstacle = grazed_obstacle(h);
  grazing_slope b = {.particle = obstacle->coordinate};
  RIC_TRY(find_grazing_slope(h, mode, &b, error));
  const double slope = (b.energy[1] - b.energy[0]) * (b.speed[1] - b.speed[0]) * obstacle->side;
  *rise = (slope > 0) - (slope < 0);
  return RIC_OK;
}

ric_status ric_guess_grazing_mode(const ric_guess_problem *problem, size_t mode, size_t swings, ric_guess *guess,
                                  ric_error *error) {
  REQUIRE(error, {"problem", problem}, {"guess", guess});
  homotopy h;
  int rise = 0;
  ric_status status = homotopy_init(&h, problem, error);
  if (status == RIC_OK)
    status = check_grazing(problem, swings, error);
  if (status == RIC_OK)
    status = find_linear_mode(&h, mode, swings, error);
  if (status == RIC_OK)
    status = add_nonlinear_terms(&h, mode, error);
  if (status == RIC_OK)
    status = find_energy_sign(&h, mode, &rise, error);
  if (status == RIC_OK) {
    put_motion(&h, guess);
    guess->rise = rise;
  }
  homotopy_clear(&h);
  return status;
}

/* --- the motion of a guess ---------------------------------------------------------------------------------------- */

static ric_status put_orbit(ric_shooting *shooting, const double *z, ric_guess *guess, double *energy,
                            ric_error *error) {
  const ric_system *system = shooting->system;
  ric_orbit orbit = {0};
  ric_status status = ric_orbit_init_for(&orbit, system, ric_shooting_impacts(shooting), error);
  if (status == RIC_OK)
    status = ric_shooting_orbit(shooting, z, guess->period, &orbit, error);
  if (status == RIC_OK) {
    memcpy(guess->q, orbit.q, ric_system_coordinates(system) * sizeof *guess->q);
    memcpy(guess->v, orbit.v, ric_system_speeds(system) * sizeof *guess->v);
    *energy = orbit.energy;
  }
  ric_orbit_clear(&orbit);
  return status;
}

ric_status ric_guess_solve(ric_shooting *shooting, const double *times, ric_guess *guess, double *energy,
                           ric_error *error) {
  REQUIRE(error, {"shooting", shooting}, {"guess", guess}, {"energy", energy});
  double *z = calloc(ric_shooting_unknowns(shooting), sizeof *z);
  ric_status status = z ? ric_shooting_guess(shooting, guess->q, guess->v, times, guess->period, z, error)
                        : ric_fail(error, RIC_ENOMEM, "no memory for the motion of a guess");
  if (status == RIC_OK)
    status = ric_shooting_solve(shooting, z, guess->period, 0, NULL, error);
  if (status == RIC_OK)
    status = put_orbit(shooting, z, guess, energy, error);
  free(z);
  return status;
}
