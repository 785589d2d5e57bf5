/* Parameters at which multipliers leave the unit circle or return to it. */
#include <math.h>
#include <stdlib.h>

#include "orbit_multipliers.h"
#include "ricochet/orbit_multipliers.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* Rounding of alpha, relative to the largest entry of the reduced matrix: ten times the observed value; its root for
 * the imaginary part of two that collide. */
static const double rounding = 1e-13;

/* If an alpha is outside by more than the rounding and less than this multiple of it, the census is uncertain. */
static const double uncertain = 10;

/* Brackets are bisected to this length, relative to parameters above 1. */
static const double bracket = 1e-11;

const char *ric_critical_name(ric_critical_kind kind) {
  switch (kind) {
#define X(name, text)                                                                                                  \
  case name:                                                                                                           \
    return text;
    RIC_CRITICAL_LIST(X)
#undef X
  case RIC_CRITICAL_KINDS:
    break;
  }
  return "unknown kind";
}

/* Number of multipliers outside at a parameter. */
typedef struct census {
  double parameter;
  bool known;                         /* there is an orbit, with impacts that do not graze */
  bool certain;                       /* no alpha is so close to the edge of the unit circle that rounding decides */
  size_t outside[RIC_CRITICAL_KINDS]; /* real above 1, real below -1, complex */
  ric_complex nearest;                /* the complex alpha nearest to the real axis, im > 0 */
  double error;                       /* rounding of alpha */
} census;

typedef struct family {
  ric_orbit_solver *solver;
  orbit_spectrum *spectrum; /* its workspace */
  ric_chain chain;
  const ric_pattern *pattern;
  ric_along along;
  double period;
  ric_orbit orbit;
  ric_critical *found;
  size_t capacity, count;
  ric_error *error;
} family;

static size_t total(const census *c) {
  size_t sum = 0;
  for (int kind = 0; kind < RIC_CRITICAL_KINDS; kind++)
    sum += c->outside[kind];
  return sum;
}

/* Whether alpha is outside by a distance that grows from 0 as it leaves; rounding is that of the distance. */
static bool leaves(census *c, double distance, double error) {
  if (distance > error && distance <= uncertain * error)
    c->certain = false;
  return distance > error;
}

static void sort_alpha(census *c, const ric_complex *alpha, size_t count, double error) {
  c->certain = true;
  c->error = error;
  c->nearest.im = INFINITY;
  for (size_t i = 0; i < count; i++)
    if (leaves(c, fabs(alpha[i].im), sqrt(error))) {
      c->outside[RIC_CRITICAL_COLLISION]++;
      if (fabs(alpha[i].im) < c->nearest.im)
        c->nearest = (ric_complex){alpha[i].re, fabs(alpha[i].im)};
    } else if (leaves(c, alpha[i].re - 1, error)) {
      c->outside[RIC_CRITICAL_PLUS_ONE]++;
    } else if (leaves(c, -1 - alpha[i].re, error)) {
      c->outside[RIC_CRITICAL_MINUS_ONE]++;
    }
}

static ric_status take_census(family *f, double parameter, census *c) {
  size_t grazing;
  double period = f->along == RIC_ALONG_GAMMA ? f->period : parameter;
  *c = (census){.parameter = parameter};
  if (f->along == RIC_ALONG_GAMMA)
    f->chain.gamma = parameter;
  if (ric_poll_stops(f->solver->options.poll))
    return ric_fail(f->error, RIC_ESTOPPED, "stopped at parameter %g", parameter);
  RIC_TRY(ric_orbit_solve(f->solver, &f->chain, f->pattern, period, &f->orbit, f->error));
  /* At a symmetry breaking (a pair at +1) the contact equations are singular but solvable: resonant. */
  c->known =
      f->orbit.outcome == RIC_ADMISSIBLE || f->orbit.outcome == RIC_INADMISSIBLE || f->orbit.outcome == RIC_RESONANT;
  if (!c->known)
    return RIC_OK;
  RIC_TRY(orbit_impacts_find(&f->spectrum->impacts, &f->chain, f->pattern, &f->orbit, f->solver->options.grazing_tol,
                             &grazing, f->error));
  c->known = grazing == f->orbit.impacts;
  if (!c->known)
    return RIC_OK;
  RIC_TRY(reduced_compute(&f->spectrum->reduced, &f->chain, &f->spectrum->impacts, &f->orbit, f->error));
  const even_spectrum *spectrum = &f->spectrum->reduced.spectrum;
  sort_alpha(c, spectrum->alpha, spectrum->count, rounding * fmax(1, spectrum->largest));
  return RIC_OK;
}

static bool differ(const census *a, const census *b) {
  bool differs = false;
  for (int kind = 0; kind < RIC_CRITICAL_KINDS; kind++)
    differs = differs || a->outside[kind] != b->outside[kind];
  return differs;
}

/* Two collided alpha are alpha +- i r with r^2 linear in the parameter: the collision is the zero of the line through
 * two censuses outside, or the middle of the bracket if that zero lies outside the bracket. */
static ric_status sharpen(family *f, const census *a, const census *b, ric_critical *critical) {
  census beyond;
  const census *outside = critical->outwards ? b : a;
  double width = b->parameter - a->parameter, step = critical->outwards ? 2 * width : -2 * width;
  critical->mu = (ric_complex){outside->nearest.re, sqrt(fmax(0, 1 - outside->nearest.re * outside->nearest.re))};
  if (!(outside->parameter + step > 0))
    return RIC_OK;
  RIC_TRY(take_census(f, outside->parameter + step, &beyond));
  double here = outside->nearest.im * outside->nearest.im,
         slope = (beyond.nearest.im * beyond.nearest.im - here) / step;
  double zero = outside->parameter - here / slope;
  if (!beyond.known || differ(outside, &beyond) || !(zero >= a->parameter && zero <= b->parameter))
    return RIC_OK;
  critical->parameter = zero;
  critical->uncertainty = fmin(critical->uncertainty, fmax(bracket, fabs(outside->error / slope)));
  return RIC_OK;
}

/* Reports the changes across the last bracket. Changes that do not affect the number outside happen off the unit
 * circle. */
static ric_status report(family *f, const census *a, const census *b) {
  bool outwards = total(b) > total(a);
  for (int kind = 0; kind < RIC_CRITICAL_KINDS && total(a) != total(b); kind++) {
    if (a->outside[kind] == b->outside[kind] || (b->outside[kind] > a->outside[kind]) != outwards)
      continue;
    ric_critical critical = {.kind = (ric_critical_kind)kind,
                             .parameter = (a->parameter + b->parameter) / 2,
                             .mu = {kind == RIC_CRITICAL_MINUS_ONE ? -1 : 1, 0},
                             .outwards = outwards,
                             .uncertainty = (b->parameter - a->parameter) / 2};
    if (kind == RIC_CRITICAL_COLLISION)
      RIC_TRY(sharpen(f, a, b, &critical));
    if (f->count < f->capacity)
      f->found[f->count] = critical;
    f->count++;
  }
  return RIC_OK;
}

/* A certain census between two others. If there is none, `middle` is uncertain, or unknown without an orbit. At the
 * edge of a singular window rounding decides whether there is an orbit. */
static ric_status between(family *f, const census *a, const census *b, census *middle) {
  static const double places[] = {0.5, 0.34, 0.66, 0.1, 0.9, 0.02, 0.98};
  census here;
  *middle = (census){0};
  for (size_t i = 0; i < sizeof places / sizeof *places && !middle->certain; i++) {
    RIC_TRY(take_census(f, a->parameter + places[i] * (b->parameter - a->parameter), &here));
    if (here.known)
      *middle = here;
  }
  return RIC_OK;
}

static ric_status refine(family *f, const census *a, const census *b) {
  census middle = {.known = true};
  if (!a->known || !b->known || !differ(a, b))
    return RIC_OK;
  if (b->parameter - a->parameter > bracket * fmax(1, b->parameter))
    RIC_TRY(between(f, a, b, &middle));
  if (middle.known && !middle.certain)
    return report(f, a, b);
  RIC_TRY(refine(f, a, &middle));
  return refine(f, &middle, b);
}

static ric_status search(family *f, double low, double high, size_t points) {
  census before = {.known = false}, here;
  for (size_t i = 0; i < points; i++) {
    RIC_TRY(take_census(f, low + (high - low) * ((double)i / (double)(points - 1)), &here));
    if (here.known && !here.certain)
      continue;
    RIC_TRY(refine(f, &before, &here));
    before = here;
  }
  return RIC_OK;
}

static ric_status check_family(const ric_chain *chain, const ric_pattern *pattern, double low, double high,
                               size_t points, ric_error *error) {
  RIC_TRY(ric_chain_check(chain, error));
  if (ric_pattern_particles(pattern) != chain->particles)
    return ric_fail(error, RIC_EINVAL, "pattern of %zu particles, expected %zu", ric_pattern_particles(pattern),
                    chain->particles);
  if (chain->particles > RIC_REDUCED_PARTICLES)
    return ric_fail(error, RIC_ELIMIT, "matrix of %zu particles, expected at most %d", chain->particles,
                    RIC_REDUCED_PARTICLES);
  if (!(low >= 0 && low < high && high < INFINITY))
    return ric_fail(error, RIC_EINVAL, "range [%g, %g], expected 0 <= low < high < infinity", low, high);
  if (points < 2)
    return ric_fail(error, RIC_EINVAL, "points = %zu, expected at least 2", points);
  return RIC_OK;
}

ric_status ric_orbit_critical_points(ric_orbit_solver *solver, const ric_chain *chain, const ric_pattern *pattern,
                                     ric_along along, double period, double low, double high, size_t points,
                                     ric_critical *found, size_t capacity, size_t *count, ric_error *error) {
  REQUIRE(error, {"solver", solver}, {"chain", chain}, {"pattern", pattern}, {"found", unless_empty(capacity, found)},
          {"count", count});
  family f = {.solver = solver,
              .chain = *chain,
              .pattern = pattern,
              .along = along,
              .period = period,
              .found = found,
              .capacity = capacity,
              .error = error};
  *count = 0;
  RIC_TRY(check_family(chain, pattern, low, high, points, error));
  RIC_TRY(orbit_spectrum_of(solver, &f.spectrum, error));
  RIC_TRY(ric_orbit_init(&f.orbit, chain->particles, ric_pattern_impacts(pattern), error));
  keep_gsl_quiet();
  ric_status status = search(&f, low, high, points);
  ric_orbit_clear(&f.orbit);
  *count = f.count;
  return status;
}
