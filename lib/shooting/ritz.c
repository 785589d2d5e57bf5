#include "ricochet/ritz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>

#include "model/lattice_system.h"
#include "numeric/number_block.h"
#include "ritz_parts.h"
#include "numeric/constants.h"

/* Numbers of points for which GSL has Gauss's rule to all digits; others it computes to 1e-10. */
static const size_t rules[] = {32, 64, 96, 100, 128, 256, 512, 1024};

enum { RULES = sizeof rules / sizeof *rules };

ric_ritz_options ric_ritz_options_default(void) {
  return (ric_ritz_options){.functions = 16, .constants = true};
}

/* --- what is refused ---------------------------------------------------------------------------------------------- */

static ric_status check_options(const ric_ritz_options *o, ric_error *error) {
  if (!(o->functions >= 1 && o->functions <= RIC_RITZ_MOST))
    return ric_fail(error, RIC_EINVAL, "functions = %zu, expected 1 to %d", o->functions, RIC_RITZ_MOST);
  if (o->points != 0 && !(o->points >= 2 * o->functions && o->points <= rules[RULES - 1]))
    return ric_fail(error, RIC_EINVAL, "points = %zu, expected 0 or %zu to %zu", o->points, 2 * o->functions,
                    rules[RULES - 1]);
  return RIC_OK;
}

/* What no change of numbers changes. */
static ric_status check_obstacle(const ric_system *s, size_t obstacle, ric_error *error) {
  if (s->taylor != SYSTEM_LATTICE)
    return ric_fail(error, RIC_EINVAL, "Ritz's method needs a lattice");
  if (!(obstacle < s->obstacle_count))
    return ric_fail(error, RIC_EINVAL, "obstacle = %zu, expected one of %zu", obstacle, s->obstacle_count);
  for (size_t j = 0; j < s->obstacle_count; j++)
    if (system_complies(s, j))
      return ric_fail(error, RIC_EINVAL, "obstacle %zu is compliant (stiffness %g), expected rigid ones", j,
                      s->obstacles[j].stiffness);
  return RIC_OK;
}

static ric_status check_losses(const ric_lattice *l, ric_error *error) {
  for (size_t i = 0; i < l->particles; i++)
    if (ric_lattice_on_site(l, i).damping != 0)
      return ric_fail(error, RIC_EINVAL, "on-site spring %zu: damping = %g, expected 0", i,
                      ric_lattice_on_site(l, i).damping);
  for (size_t i = 0; i <= l->particles; i++)
    if (ric_lattice_link(l, i).damping != 0)
      return ric_fail(error, RIC_EINVAL, "link %zu: damping = %g, expected 0", i, ric_lattice_link(l, i).damping);
  return RIC_OK;
}

static ric_status check_force(const double *force, size_t n, const char *name, ric_error *error) {
  for (size_t i = 0; force && i < n; i++)
    if (force[i] != 0)
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %g, expected 0", name, i, force[i]);
  return RIC_OK;
}

ric_status ritz_check_system(ric_ritz *r, ric_error *error) {
  if (r->revision == r->system->revision)
    return RIC_OK;
  const ric_lattice *l = lattice_system_lattice(r->system);
  double e = r->system->obstacles[r->obstacle].restitution;
  if (e != 1)
    return ric_fail(error, RIC_EINVAL, "restitution = %g of obstacle %zu, expected 1", e, r->obstacle);
  RIC_TRY(check_losses(l, error));
  RIC_TRY(check_force(l->force_cos, l->particles, "force_cos", error));
  RIC_TRY(check_force(l->force_sin, l->particles, "force_sin", error));
  r->revision = r->system->revision;
  return RIC_OK;
}

/* --- life cycle --------------------------------------------------------------------------------------------------- */

/* F and J have phases of at most i w T / 2 with i = 4 N (three functions of a cubic force, one to project on), below
 * 4 pi N over half a period, cos(k x) with k = 2 pi N on [-1, 1]. A rule of P points leaves Bessel functions J_2P(k),
 * below 1e-16 from 2 P = k + 12 k^(1/3) on. */
static size_t rule_for(size_t functions) {
  double most = 2 * pi * (double)functions;
  return (size_t)ceil(most / 2 + 6 * cbrt(most));
}

static size_t choose_points(const ric_ritz_options *o) {
  size_t wanted = o->points ? o->points : rule_for(o->functions), k = 0;
  while (k + 1 < RULES && rules[k] < wanted)
    k++;
  return rules[k];
}

static void lay_out(ric_ritz *r, size_t *used) {
  size_t n = r->coordinates, row = r->stride;
  *used = 0;
  r->tau = number_block_take(r->block, used, r->points);
  r->weight = number_block_take(r->block, used, r->points);
  r->psi = number_block_take(r->block, used, r->points * row);
  r->cosine = number_block_take(r->block, used, row);
  r->sine = number_block_take(r->block, used, row);
  r->q = number_block_take(r->block, used, n);
  r->v = number_block_take(r->block, used, n);
  r->bend = number_block_take(r->block, used, n);
  r->rate = number_block_take(r->block, used, n);
  r->stiffness = number_block_take(r->block, used, n * n);
  r->unit = number_block_take(r->block, used, n * n);
  r->nothing = number_block_take(r->block, used, n * n);
  r->spare = number_block_take(r->block, used, n * row + 1);
}

static ric_status allocate(ric_ritz *r, ric_error *error) {
  size_t used;
  lay_out(r, &used);
  if (r->coordinates < SIZE_MAX / 64 / r->coordinates)
    r->block = calloc(used, sizeof *r->block);
  if (!r->block)
    return ric_fail(error, RIC_ENOMEM, "no memory for Ritz's method with %zu coordinates", r->coordinates);
  lay_out(r, &used);
  for (size_t i = 0; i < r->coordinates; i++)
    r->unit[i * r->coordinates + i] = 1;
  return RIC_OK;
}

static ric_status tabulate(ric_ritz *r, ric_error *error) {
  gsl_error_handler_t *handler = gsl_set_error_handler_off(); /* which would abort when there is no memory */
  gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(r->points);
  gsl_set_error_handler(handler);
  if (!table)
    return ric_fail(error, RIC_ENOMEM, "no memory for a rule of %zu points", r->points);
  for (size_t p = 0; p < r->points; p++) {
    gsl_integration_glfixed_point(0, 0.5, p, &r->tau[p], &r->weight[p], table);
    r->weight[p] *= 2;
    for (size_t m = 0; m < r->stride; m++)
      r->psi[p * r->stride + m] = cos(2 * pi * ritz_number(r, m) * r->tau[p]);
  }
  gsl_integration_glfixed_table_free(table);
  return RIC_OK;
}

static ric_status build(ric_ritz *r, ric_error *error) {
  RIC_TRY(ritz_check_system(r, error));
  RIC_TRY(allocate(r, error));
  return tabulate(r, error);
}

ric_status ric_ritz_create(const ric_system *system, size_t obstacle, const ric_ritz_options *options, ric_ritz **ritz,
                           ric_error *error) {
  ric_ritz_options o = options ? *options : ric_ritz_options_default();
  *ritz = NULL;
  RIC_TRY(check_options(&o, error));
  RIC_TRY(check_obstacle(system, obstacle, error));
  ric_ritz *r = calloc(1, sizeof *r);
  if (!r)
    return ric_fail(error, RIC_ENOMEM, "no memory for Ritz's method");
  *r = (ric_ritz){.system = system,
                  .revision = system->revision - 1, /* not yet checked */
                  .obstacle = obstacle,
                  .hit = system->obstacles[obstacle].coordinate,
                  .coordinates = system->coordinates,
                  .first = o.constants ? 0 : 1,
                  .most = o.functions,
                  .functions = o.functions,
                  .stride = o.constants ? o.functions + 1 : o.functions,
                  .points = choose_points(&o)};
  ric_status status = build(r, error);
  if (status == RIC_OK)
    *ritz = r;
  else
    ric_ritz_destroy(&r);
  return status;
}

void ric_ritz_destroy(ric_ritz **ritz) {
  if (!ritz || !*ritz)
    return;
  free((*ritz)->block);
  free(*ritz);
  *ritz = NULL;
}

/* --- numbers of functions ----------------------------------------------------------------------------------------- */

size_t ric_ritz_functions(const ric_ritz *ritz) {
  return ritz->functions;
}

size_t ric_ritz_unknowns(const ric_ritz *ritz) {
  return ritz->coordinates * ritz_width(ritz) + 1;
}

size_t ric_ritz_points(const ric_ritz *ritz) {
  return ritz->points;
}

ric_status ric_ritz_use(ric_ritz *r, size_t functions, double *c, ric_error *error) {
  if (!(functions >= 1 && functions <= r->most))
    return ric_fail(error, RIC_EINVAL, "functions = %zu, expected 1 to %zu", functions, r->most);
  size_t n = r->coordinates, before = ritz_width(r), after = functions + 1 - r->first;
  size_t kept = before < after ? before : after;
  r->functions = functions;
  if (!c)
    return RIC_OK;
  double w = c[n * before];
  for (size_t k = 0; k < n; k++) { /* rows move apart from the last one on, together from the first one on */
    size_t i = after > before ? n - 1 - k : k;
    memmove(c + i * after, c + i * before, kept * sizeof *c);
    memset(c + i * after + kept, 0, (after - kept) * sizeof *c);
  }
  c[n * after] = w;
  return RIC_OK;
}
