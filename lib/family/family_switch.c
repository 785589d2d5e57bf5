/* Switching to other families: with one impact more or less, and with twice the period. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>

#include "family.h"
#include "numeric/gsl_quiet.h"
#include "numeric/required.h"

/* Families that meet: what all switches share. */

/* First step along the new family. Multipliers grow without bound towards a grazing point, and special points
 * accumulate there. */
static const double first_step = 1e-3;

/* Singular values below it, over the largest, are zero. */
static const double singular_tol = 1e-7;

void ric_family_junction_clear(ric_family_junction *junction) {
  if (!junction)
    return;
  ric_family_destroy(&junction->family);
  free(junction->z);
  free(junction->tangent);
  *junction = (ric_family_junction){0};
}

void family_evaluate_again(ric_family *f, const ric_family_point *point) {
  family_forget(f);
  if (family_set(f, point->parameter, f->problem.second, NULL) == RIC_OK)
    (void)family_complete(f, point->z, NULL);
  family_forget(f);
}

/* Creates a family with other impacts that begins at a point of a family: its first z from a guess. */
static ric_status family_branch(const ric_family_problem *problem, const ric_family *from,
                                const ric_family_point *point, const double *x, const double *times, double period,
                                ric_family_junction *junction, ric_error *error) {
  size_t n = from->shooting->arcs.coordinates;
  ric_family_options options = from->options;
  options.curve.step = fmin(options.curve.step, fmax(first_step, options.curve.step_least));
  RIC_TRY(ric_family_create(problem, &options, &junction->family, error));
  size_t unknowns = junction->family->unknowns;
  junction->z = calloc(unknowns, sizeof *junction->z);
  junction->tangent = calloc(unknowns + 1, sizeof *junction->tangent);
  junction->parameter = point->parameter;
  if (!junction->z || !junction->tangent)
    return ric_fail(error, RIC_ENOMEM, "no memory for a point of %zu unknowns", unknowns);
  RIC_TRY(family_set(junction->family, point->parameter, problem->second, error));
  return ric_shooting_guess(junction->family->shooting, x, x + n, times, period, junction->z, error);
}

/* Sets the first rows of a square matrix to (J, F_p). */
static ric_status fill_bordered_rows(ric_family *f, const double *z, gsl_matrix *A, ric_error *error) {
  size_t n = f->unknowns;
  double *J = malloc((n * n + 2 * n) * sizeof *J);
  if (!J)
    return ric_fail(error, RIC_ENOMEM, "no memory for a matrix of size %zu", n);
  double *F = J + n * n, *F_p = F + n;
  ric_status status = family_residual(f, z, 0, F, J, F_p, error);
  for (size_t i = 0; i < n && status == RIC_OK; i++) {
    memcpy(gsl_matrix_ptr(A, i, 0), J + i * n, n * sizeof *J);
    gsl_matrix_set(A, i, n, F_p[i]);
  }
  free(J);
  return status;
}

static ric_status decompose(gsl_matrix *A, gsl_matrix *V, gsl_vector *S, gsl_vector *work, size_t count,
                            double *vectors, ric_error *error) {
  size_t size = A->size1;
  if (gsl_linalg_SV_decomp(A, V, S, work) != GSL_SUCCESS)
    return ric_fail(error, RIC_ENUMERIC, "no singular values of the equations where two families meet");
  double last = gsl_vector_get(S, size - 1 - count), first = gsl_vector_get(S, 0);
  if (!(last > singular_tol * first))
    return ric_fail(error, RIC_ENUMERIC, "the families that meet are no simple ones: a singular value of %.3g of %.3g",
                    last, first);
  for (size_t k = 0; k < count; k++)
    for (size_t i = 0; i < size; i++)
      vectors[k * size + i] = gsl_matrix_get(V, i, size - 1 - k);
  return RIC_OK;
}

/* Null vectors of (J, F_p) [unknowns + 1] at z: the `count` last singular vectors. GSL's error handler must be off.
 * @returns RIC_ENUMERIC when the null space has more dimensions */
static ric_status family_null_vectors(ric_family *f, const double *z, size_t count, double *vectors, ric_error *error) {
  size_t size = f->unknowns + 1;
  gsl_matrix *A = gsl_matrix_calloc(size, size), *V = gsl_matrix_alloc(size, size);
  gsl_vector *S = gsl_vector_alloc(size), *work = gsl_vector_alloc(size);
  ric_status status = A && V && S && work ? fill_bordered_rows(f, z, A, error)
                                          : ric_fail(error, RIC_ENOMEM, "no memory for a matrix of size %zu", size);
  if (status == RIC_OK)
    status = decompose(A, V, S, work, count, vectors, error);
  if (A)
    gsl_matrix_free(A);
  if (V)
    gsl_matrix_free(V);
  if (S)
    gsl_vector_free(S);
  if (work)
    gsl_vector_free(work);
  return status;
}

/* Switching to the family with an impact more, or less. */

/* Distance along the tangent at which a family is evaluated to find the side on which it is admissible. */
static const double side_distance = 1e-4;

/* Times nearer to a turning point of an even motion than this, over the period, are at it. */
static const double at_turning = 1e-7;

/* A switch in progress: impacts of the new family, and the first state of its motion. */
typedef struct crossing {
  ric_family *from;
  const ric_family_point *point;
  ric_family_problem problem;
  size_t *start, *half, *sequence; /* of the new family */
  double *times;                   /* of its sequence */
  double *x;                       /* [n + m] first state */
  double begin, period;            /* time of the first state */
  ric_family_junction *junction;
  ric_error *error;
} crossing;

static ric_status reserve(crossing *c) {
  const ric_shooting_problem *m = &c->from->problem.motion;
  size_t most = m->start_count + m->half_count + m->count + 1, size = c->from->shooting->arcs.size;
  c->start = calloc(3 * most, sizeof *c->start);
  c->times = calloc(most + size, sizeof *c->times);
  if (!c->start || !c->times)
    return ric_fail(c->error, RIC_ENOMEM, "no memory for %zu impacts", most);
  c->half = c->start + most;
  c->sequence = c->half + most;
  c->x = c->times + most;
  return RIC_OK;
}

static void copy_impacts(crossing *c) {
  const ric_shooting_problem *m = &c->from->problem.motion;
  const arc_plan *plan = &c->from->shooting->arcs;
  memcpy(c->start, m->at_start, m->start_count * sizeof *c->start);
  memcpy(c->half, m->at_half, m->half_count * sizeof *c->half);
  for (size_t k = 0; k < m->count; k++) {
    c->sequence[k] = m->sequence[k];
    c->times[k] = arcs_time(plan->impacts[k], c->point->z, c->period);
  }
  c->problem.motion.at_start = c->start;
  c->problem.motion.at_half = c->half;
  c->problem.motion.sequence = c->sequence;
}

static bool is_even(const crossing *c) {
  return c->from->problem.motion.kind == RIC_MOTION_EVEN;
}

/* Inserts an impact into the sequence, in order of time. */
static void insert_impact(crossing *c, size_t obstacle, double time) {
  size_t *count = &c->problem.motion.count, k = *count;
  double first = *count > 0 ? c->times[0] : 0;
  if (!is_even(c))
    time = first + fmod(fmod(time - first, c->period) + c->period, c->period);
  for (; k > 0 && c->times[k - 1] > time; k--) {
    c->times[k] = c->times[k - 1];
    c->sequence[k] = c->sequence[k - 1];
  }
  c->times[k] = time;
  c->sequence[k] = obstacle;
  ++*count;
}

static void add_contact(crossing *c) {
  ric_shooting_problem *m = &c->problem.motion;
  double time = c->point->time;
  if (is_even(c) && time > c->period / 2)
    time = c->period - time;
  if (is_even(c) && time < at_turning * c->period)
    c->start[m->start_count++] = c->point->obstacle;
  else if (is_even(c) && c->period / 2 - time < at_turning * c->period)
    c->half[m->half_count++] = c->point->obstacle;
  else
    insert_impact(c, c->point->obstacle, time);
}

static bool remove_obstacle(size_t *list, size_t *count, size_t obstacle) {
  for (size_t k = 0; k < *count; k++)
    if (list[k] == obstacle) {
      memmove(list + k, list + k + 1, (*count - k - 1) * sizeof *list);
      --*count;
      return true;
    }
  return false;
}

static ric_status remove_contact(crossing *c) {
  ric_shooting_problem *m = &c->problem.motion;
  double time = c->point->time, nearest = INFINITY;
  size_t which = 0;
  bool at_start = is_even(c) && time < at_turning * c->period;
  bool at_half = is_even(c) && fabs(time - c->period / 2) < at_turning * c->period;
  if (at_start && remove_obstacle(c->start, &m->start_count, c->point->obstacle))
    return RIC_OK;
  if (at_half && remove_obstacle(c->half, &m->half_count, c->point->obstacle))
    return RIC_OK;
  for (size_t k = 0; k < m->count; k++) {
    double apart = fabs(remainder(c->times[k] - time, c->period));
    if (c->sequence[k] == c->point->obstacle && apart < nearest) {
      nearest = apart;
      which = k;
    }
  }
  if (!(nearest < INFINITY))
    return ric_fail(c->error, RIC_EINVAL, "point = impact_lost of obstacle %zu, which the family does not hit",
                    c->point->obstacle);
  memmove(c->sequence + which, c->sequence + which + 1, (m->count - which - 1) * sizeof *c->sequence);
  memmove(c->times + which, c->times + which + 1, (m->count - which - 1) * sizeof *c->times);
  m->count--;
  return RIC_OK;
}

/* --- the motion at the crossing ----------------------------------------------------------------------------------- */

/* State of the old motion at a time, after an impact there; a grazing contact does not change the state. */
static ric_status state_at(crossing *c, double time, double *x) {
  ric_shooting *s = c->from->shooting;
  const arc_plan *plan = &s->arcs;
  const double *z = c->point->z;
  double begin = piece_begin(plan->pieces, z, c->period);
  while (time < begin - at_turning * c->period)
    time += c->period;
  for (size_t k = 0; k < plan->count; k++) {
    piece_run run = shooting_begin(s, k, z, c->period, OUTPUT_STATE);
    if (time >= run.end - at_turning * c->period && k + 1 < plan->count)
      continue;
    RIC_TRY(arc_runner_move(&s->runner, run.begin, fmax(time, run.begin), s->x, 0, NULL, NULL, c->error));
    memcpy(x, s->x, plan->size * sizeof *x);
    break;
  }
  return RIC_OK;
}

/* The first state of the new family, and its time. */
static ric_status find_start(crossing *c) {
  const ric_shooting_problem *m = &c->problem.motion;
  size_t size = c->from->shooting->arcs.size;
  c->begin = !is_even(c) && m->count > 0 ? c->times[0] : 0;
  if (is_even(c)) { /* the motion is the same: only its unknowns have other meanings */
    (void)shooting_begin(c->from->shooting, 0, c->point->z, c->period, OUTPUT_STATE);
    memcpy(c->x, c->from->shooting->x, size * sizeof *c->x);
    return RIC_OK;
  }
  return state_at(c, c->begin, c->x);
}

/* Smallest gap and smallest impact speed (minus the gap rate) of a motion: positive where it is admissible. */
static ric_status admissible_margin(ric_family *f, const double *z, double parameter, double second, double *value,
                                    ric_error *error) {
  RIC_TRY(family_set(f, parameter, second, error));
  RIC_TRY(family_complete(f, z, error));
  const gap_watch *g = &f->shooting->gaps.watch;
  *value = fmin(g->free.value, g->own.value);
  for (size_t k = 0; k < f->impacts; k++)
    *value = fmin(*value, -f->orbit.gap_rate[k]);
  return RIC_OK;
}

/* The direction along a tangent [n + 1] in which a family becomes admissible, or less inadmissible. */
typedef struct side {
  int sign;    /* 0: both directions are equal */
  bool exists; /* it is admissible there */
} side;

static ric_status find_admissible_side(ric_family *f, const double *z, const double *t, double parameter, double second,
                                       side *found, ric_error *error) {
  double value[2] = {0, 0};
  size_t n = f->unknowns;
  ric_status status = RIC_OK;
  double *beside = malloc(n * sizeof *beside);
  if (!beside)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu unknowns", n);
  for (int k = 0; k < 2 && status == RIC_OK; k++) {
    double step = k ? side_distance : -side_distance;
    for (size_t i = 0; i < n; i++)
      beside[i] = z[i] + step * t[i];
    status = admissible_margin(f, beside, parameter + step * t[n], second, &value[k], error);
  }
  *found = (side){value[1] > value[0] ? 1 : value[1] < value[0] ? -1 : 0, fmax(value[0], value[1]) > 0};
  free(beside);
  return status;
}

static int sign_of(double x) {
  return (x > 0) - (x < 0);
}

static ric_status find_sides(crossing *c) {
  ric_family_junction *j = c->junction;
  ric_family *f = j->family;
  const ric_family_point *point = c->point;
  size_t n = f->unknowns;
  double p = point->parameter, second = c->problem.second;
  side found;
  RIC_TRY(family_null_vectors(f, j->z, 1, j->tangent, c->error));
  RIC_TRY(find_admissible_side(f, j->z, j->tangent, p, second, &found, c->error));
  for (size_t i = 0; i <= n && found.sign < 0; i++)
    j->tangent[i] = -j->tangent[i];
  j->side = found.exists && fabs(j->tangent[n]) > 1e-12 ? sign_of(j->tangent[n]) : 0;
  family_forget(c->from); /* the new family has changed the system */
  RIC_TRY(find_admissible_side(c->from, point->z, point->tangent, p, second, &found, c->error));
  j->other_side = (found.exists ? found.sign : 0) * sign_of(point->tangent[c->from->unknowns]);
  family_forget(f);
  return RIC_OK;
}

ric_status ric_family_cross(ric_family *family, const ric_family_point *point, ric_family_junction *junction,
                            ric_error *error) {
  REQUIRE(error, {"family", family}, {"point", point}, {"junction", junction});
  crossing c = {.from = family, .point = point, .problem = family->problem, .junction = junction, .error = error};
  *junction = (ric_family_junction){0};
  family_forget(family);
  if (point->kind != RIC_FAMILY_GRAZING && point->kind != RIC_FAMILY_IMPACT_LOST)
    return ric_fail(error, RIC_EINVAL, "point = %s, expected grazing or impact_lost",
                    ric_family_kind_name(point->kind));
  c.period = arcs_period(&family->shooting->arcs, point->z, point->given);
  ric_status status = family_set(family, point->parameter, family->problem.second, error);
  if (status == RIC_OK)
    status = reserve(&c);
  keep_gsl_quiet();
  if (status == RIC_OK) {
    copy_impacts(&c);
    if (point->kind == RIC_FAMILY_GRAZING)
      add_contact(&c);
    else
      status = remove_contact(&c);
  }
  if (status == RIC_OK)
    status = find_start(&c);
  if (status == RIC_OK)
    status = family_branch(&c.problem, family, point, c.x, c.times, c.period, junction, error);
  if (status == RIC_OK)
    status = find_sides(&c);
  family_evaluate_again(family, point);
  if (status != RIC_OK)
    ric_family_junction_clear(junction);
  free(c.start);
  free(c.times);
  return status;
}

/* Switching to the family of twice the period. */

/* The motion traversed twice, with the times of its impacts. */
typedef struct doubling {
  const ric_family *from;
  const ric_family_point *point;
  ric_family_problem problem;
  size_t *sequence;
  double *times, period;
} doubling;

static ric_status traverse_twice(doubling *d, ric_error *error) {
  ric_shooting_problem *m = &d->problem.motion;
  const arc_plan *plan = &d->from->shooting->arcs;
  size_t count = m->count;
  d->sequence = calloc(2 * count + 1, sizeof *d->sequence);
  d->times = calloc(2 * count + 1, sizeof *d->times);
  if (!d->sequence || !d->times)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu impacts", 2 * count);
  for (size_t k = 0; k < 2 * count; k++) {
    d->sequence[k] = m->sequence[k % count];
    d->times[k] = arcs_time(plan->impacts[k % count], d->point->z, d->period) + (k < count ? 0 : d->period);
  }
  m->sequence = d->sequence;
  m->count = 2 * count;
  d->problem.periods = 2 * (d->problem.periods ? d->problem.periods : 1);
  return RIC_OK;
}

/* Of the two null vectors the combination along which the parameter is constant; the other is the tangent of the
 * motion traversed twice. */
static void combine_at_constant_parameter(const double *vectors, size_t size, double *tangent) {
  const double *a = vectors, *b = vectors + size;
  for (size_t i = 0; i < size; i++)
    tangent[i] = b[size - 1] * a[i] - a[size - 1] * b[i];
  tangent[size - 1] = 0;
}

static ric_status find_tangent(ric_family_junction *j, ric_error *error) {
  size_t size = j->family->unknowns + 1;
  double *vectors = malloc(2 * size * sizeof *vectors);
  if (!vectors)
    return ric_fail(error, RIC_ENOMEM, "no memory for vectors of %zu numbers", size);
  ric_status status = family_null_vectors(j->family, j->z, 2, vectors, error);
  if (status == RIC_OK)
    combine_at_constant_parameter(vectors, size, j->tangent);
  free(vectors);
  return status;
}

ric_status ric_family_double(ric_family *family, const ric_family_point *point, ric_family_junction *junction,
                             ric_error *error) {
  REQUIRE(error, {"family", family}, {"point", point}, {"junction", junction});
  doubling d = {.from = family,
                .point = point,
                .problem = family->problem,
                .period = arcs_period(&family->shooting->arcs, point->z, point->given)};
  *junction = (ric_family_junction){0};
  if (point->kind != RIC_FAMILY_PERIOD_DOUBLING || family->problem.motion.kind == RIC_MOTION_EVEN)
    return ric_fail(error, RIC_EINVAL, "point = %s of %s motion, expected period_doubling of one that is not even",
                    ric_family_kind_name(point->kind),
                    family->problem.motion.kind == RIC_MOTION_EVEN ? "an even" : "a");
  if (!family->problem.set && family->problem.motion.kind != RIC_MOTION_AUTONOMOUS)
    return ric_fail(error, RIC_EINVAL, "a family along its period, expected one along a number of the system");
  family_forget(family);
  keep_gsl_quiet();
  ric_status status = family_set(family, point->parameter, family->problem.second, error);
  if (status == RIC_OK)
    status = traverse_twice(&d, error);
  if (status == RIC_OK)
    status = family_branch(&d.problem, family, point, point->z, d.times, 2 * d.period, junction, error);
  if (status == RIC_OK)
    status = find_tangent(junction, error);
  family_forget(family);
  if (status != RIC_OK)
    ric_family_junction_clear(junction);
  free(d.sequence);
  free(d.times);
  return status;
}
