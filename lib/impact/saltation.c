/* Saltation matrices: the jump of tangent vectors at an impact. */
#include "saltation.h"

#include <stdlib.h>
#include <string.h>

#include "model/system_model.h"
#include "numeric/required.h"
#include "numeric/vector.h"
#include "numeric/path_derivative.h"
#include "ricochet/saltation.h"

ric_status tangent_jump_init(tangent_jump *j, const ric_system *system, impact_solver *law, size_t columns,
                             ric_error *error) {
  size_t size = system->coordinates + system->speeds;
  *j = (tangent_jump){0};
  double *store = malloc((8 * size + columns) * sizeof *store);
  if (!store)
    return ric_fail(error, RIC_ENOMEM, "no memory for impacts of %zu tangent vectors", columns);
  *j = (tangent_jump){.system = system, .law = law, .columns = columns};
  j->rates_before = store;
  j->rates_after = store + size;
  j->line = store + 2 * size;
  j->point = store + 3 * size;
  j->state = store + 4 * size;
  j->work = store + 5 * size;
  j->derivative = store + 7 * size;
  j->shift = store + 8 * size;
  return RIC_OK;
}

void tangent_jump_clear(tangent_jump *j) {
  free(j->rates_before);
  *j = (tangent_jump){0};
}

static ric_status callback_error(ric_error *error, double t, size_t obstacle, const char *trouble) {
  return ric_fail(error, RIC_ECALLBACK, "at t = %g, obstacle %zu: %s", t, obstacle, trouble);
}

/* One impact to be passed. */
typedef struct passage {
  tangent_jump *jump;
  double t;
  const jump_group *group;
  ric_error *error;
} passage;

/* --- impact map -------------------------------------------------------------------------------------------------- */

/* The map of a first-order system in place; if the contact sticks, up to a gap rate of zero. */
static const char *map_state(const passage *p, double t, double *x) {
  const ric_system *s = p->jump->system;
  size_t obstacle = p->group->obstacles[0];
  double *after = p->jump->law->after, rate, rate_end, part = 1;
  const char *trouble = s->model->impact(s, obstacle, t, x, after);
  if (!trouble && p->group->sticks) {
    trouble = s->model->gap_rate(s, obstacle, t, x, NULL, &rate);
    if (!trouble)
      trouble = s->model->gap_rate(s, obstacle, t, after, NULL, &rate_end);
    part = trouble ? 1 : rate / (rate - rate_end);
  }
  for (size_t i = 0; i < s->coordinates && !trouble; i++)
    x[i] += part * (after[i] - x[i]);
  return trouble;
}

/* The impact map at a time and a state that may be off the obstacle. */
static const char *map(const passage *p, double t, double *q, double *u) {
  const jump_group *g = p->group;
  if (!p->jump->system->model->direction)
    return map_state(p, t, q);
  ric_status status = impact_reflect(p->jump->law, t, q, u, g->obstacles, g->restitution, g->count, NULL, p->error);
  return status == RIC_OK ? NULL : "the impact law failed at a state near the impact";
}

static const char *map_on_line(void *user, double x, double *value) {
  const passage *p = user;
  const tangent_jump *j = p->jump;
  size_t n = j->system->coordinates, size = n + j->system->speeds;
  for (size_t i = 0; i < size; i++)
    j->point[i] = j->state[i] + x * j->line[i];
  const char *trouble = map(p, p->t + x * j->in_time, j->point, j->point + n);
  memcpy(value, j->point, size * sizeof *value);
  return trouble;
}

/* The map of a first-order system is defined for closing gaps only: shortens the step to stay there. */
static const char *keep_closing(const passage *p, double *step) {
  const tangent_jump *j = p->jump;
  const ric_system *s = j->system;
  size_t obstacle = p->group->obstacles[0];
  double here, there, rise = 0;
  const char *trouble = s->model->gap_rate(s, obstacle, p->t, j->state, NULL, &here);
  for (int sign = -1; sign <= 1 && !trouble; sign += 2) {
    for (size_t i = 0; i < s->coordinates; i++)
      j->point[i] = j->state[i] + sign * *step * j->line[i];
    trouble = s->model->gap_rate(s, obstacle, p->t + sign * *step * j->in_time, j->point, NULL, &there);
    rise = fmax(rise, trouble ? 0 : there - here);
  }
  if (here < 0 && rise > -here / 2)
    *step *= -here / 2 / rise;
  return trouble;
}

/* DG along j->line, in place. */
static const char *differentiate(passage *p) {
  tangent_jump *j = p->jump;
  size_t n = j->system->coordinates, size = n + j->system->speeds;
  if (j->system->obstacles) /* the law is linear in the speeds and depends on nothing else */
    return map(p, p->t, j->line, j->line + n);
  double place = fmax(largest(j->line, n), fabs(j->in_time));
  double step = system_tangent_step(place, largest(j->line + n, size - n), largest(j->state + n, size - n));
  const char *trouble = j->system->model->direction ? NULL : keep_closing(p, &step);
  if (!trouble)
    trouble = path_derivative(map_on_line, p, step, size, j->derivative, j->work);
  if (!trouble)
    memcpy(j->line, j->derivative, size * sizeof *j->line);
  return trouble;
}

/* --- passage ----------------------------------------------------------------------------------------------------- */

static ric_status read_rates(const passage *p, const unsigned char *contact, const double *q, const double *u,
                             double *rates) {
  const ric_system *s = p->jump->system;
  const char *trouble = s->model->rate(s, contact, p->t, q, u, rates, rates + s->coordinates);
  return trouble ? callback_error(p->error, p->t, p->group->obstacles[0], trouble) : RIC_OK;
}

/* Sets `shift` [columns], the delays of neighbouring motions. */
static ric_status find_shifts(const passage *p, const double *q, const double *u, const tangents *d, double grazing_tol,
                              ric_saltation_kind *kind) {
  const tangent_jump *j = p->jump;
  const ric_system *s = j->system;
  size_t obstacle = p->group->obstacles[0];
  double rate, acceleration;
  const char *trouble = s->model->gap_rate(s, obstacle, p->t, q, u, &rate);
  if (!trouble)
    trouble = s->model->gap_acceleration(s, obstacle, p->t, q, u, j->rates_before, j->rates_before + s->coordinates,
                                         &acceleration);
  if (!trouble)
    trouble = s->model->gap_derivative(s, obstacle, p->t, q, d, j->shift);
  if (trouble)
    return callback_error(p->error, p->t, obstacle, trouble);
  if (!(rate < 0))
    return ric_fail(p->error, RIC_EINVAL, "at t = %g: the gap rate of obstacle %zu is %g, expected below 0", p->t,
                    obstacle, rate);
  bool shallow = acceleration > 0 && rate * rate <= 2 * acceleration * grazing_tol;
  *kind = shallow || -rate < grazing_tol ? RIC_SALTATION_GRAZING : RIC_SALTATION_DIFFERENTIABLE;
  for (size_t k = 0; k < d->columns; k++)
    j->shift[k] /= -rate;
  return RIC_OK;
}

static double *row(const tangents *d, size_t i, size_t coordinates) {
  return i < coordinates ? d->q + i * d->columns : d->u + (i - coordinates) * d->columns;
}

/* Column k becomes DG along j->line, which it and j->in_time are. */
static ric_status map_column(passage *p, const tangents *d, size_t k) {
  tangent_jump *j = p->jump;
  size_t n = j->system->coordinates, size = n + j->system->speeds;
  const char *trouble = differentiate(p);
  if (trouble)
    return callback_error(p->error, p->t, p->group->obstacles[0], trouble);
  for (size_t i = 0; i < size; i++)
    row(d, i, n)[k] = j->line[i];
  return RIC_OK;
}

/* One tangent vector, moved to the obstacle; the rates after the impact are subtracted later. */
static ric_status pass_column(passage *p, const tangents *d, size_t k) {
  tangent_jump *j = p->jump;
  size_t n = j->system->coordinates, size = n + j->system->speeds;
  for (size_t i = 0; i < size; i++)
    j->line[i] = row(d, i, n)[k] + j->rates_before[i] * j->shift[k];
  j->in_time = j->shift[k];
  return map_column(p, d, k);
}

static void keep_state(tangent_jump *j, const double *q, const double *u) {
  size_t n = j->system->coordinates, m = j->system->speeds;
  memcpy(j->state, q, n * sizeof *q);
  if (m > 0)
    memcpy(j->state + n, u, m * sizeof *u);
}

ric_status tangent_jump_map(tangent_jump *j, double t, const jump_group *group, double *q, double *u, const tangents *d,
                            const double *in_time, ric_error *error) {
  passage p = {.jump = j, .t = t, .group = group, .error = error};
  size_t n = j->system->coordinates, size = n + j->system->speeds;
  keep_state(j, q, u);
  for (size_t k = 0; k < d->columns; k++) {
    for (size_t i = 0; i < size; i++)
      j->line[i] = row(d, i, n)[k];
    j->in_time = in_time[k];
    RIC_TRY(map_column(&p, d, k));
  }
  const char *trouble = map(&p, t, q, u);
  return trouble ? callback_error(error, t, group->obstacles[0], trouble) : RIC_OK;
}

ric_status tangent_jump_apply(tangent_jump *j, double t, const jump_group *group, double grazing_tol,
                              unsigned char *contact, const unsigned char *after, double *q, double *u,
                              const tangents *d, ric_saltation_kind *kind, ric_error *error) {
  passage p = {.jump = j, .t = t, .group = group, .error = error};
  size_t n = j->system->coordinates, m = j->system->speeds;
  RIC_TRY(read_rates(&p, contact, q, u, j->rates_before));
  RIC_TRY(find_shifts(&p, q, u, d, grazing_tol, kind));
  if (*kind == RIC_SALTATION_GRAZING)
    return RIC_OK;
  keep_state(j, q, u);
  for (size_t k = 0; k < d->columns; k++)
    RIC_TRY(pass_column(&p, d, k));
  const char *trouble = map(&p, t, q, u); /* last, because maps store their restitution */
  if (trouble)
    return callback_error(error, t, group->obstacles[0], trouble);
  memmove(contact, after, j->system->obstacle_count); /* they may be the same */
  RIC_TRY(read_rates(&p, contact, q, u, j->rates_after));
  for (size_t i = 0; i < n + m; i++)
    for (size_t k = 0; k < d->columns; k++)
      row(d, i, n)[k] -= j->rates_after[i] * j->shift[k];
  return RIC_OK;
}

bool tangent_jumps_agree(const double *a, const double *b, size_t size) {
  double scale = fmax(largest(a, size), largest(b, size)), most = 0;
  for (size_t i = 0; i < size; i++)
    most = fmax(most, fabs(a[i] - b[i]));
  return most <= 1e-9 * scale;
}

enum { MOST_ROUNDS = 1000 /* of coupled contacts that cause each other's impacts */ };

const char *ric_saltation_name(ric_saltation_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_SALTATION_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_SALTATION_KINDS ? names[kind] : "unknown kind";
}

/* Simultaneous impacts in a given order. */
typedef struct sequence {
  const ric_system *system;
  double t, grazing_tol;
  const double *q, *u; /* before */
  const size_t *obstacles;
  size_t count;
  tangent_jump jump;
  impact_solver law;
  double *state;          /* [n + m] between impacts */
  unsigned char *contact; /* [obstacles] open, or pressed if compliant */
  ric_saltation_kind kind;
} sequence;

static ric_status begin_sequence(sequence *s, ric_error *error) {
  size_t size = s->system->coordinates + s->system->speeds;
  RIC_TRY(impact_solver_init(&s->law, s->system, error));
  RIC_TRY(tangent_jump_init(&s->jump, s->system, &s->law, size, error));
  s->state = malloc(size * sizeof *s->state);
  s->contact = calloc(s->system->obstacle_count + 1, 1);
  if (!s->state || !s->contact)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors", size);
  for (size_t j = 0; j < s->system->obstacle_count; j++)
    if (system_complies(s->system, j) && ric_system_gap(s->system, j, s->t, s->q) < 0)
      s->contact[j] = CONTACT_PRESSED;
  return RIC_OK;
}

static void end(sequence *s) {
  tangent_jump_clear(&s->jump);
  impact_solver_clear(&s->law);
  free(s->state);
  free(s->contact);
}

static ric_status hit(sequence *s, size_t obstacle, const tangents *d, ric_error *error) {
  size_t n = s->system->coordinates;
  double e = s->system->model->restitution(s->system, obstacle);
  jump_group group = {&obstacle, &e, 1, false};
  return tangent_jump_apply(&s->jump, s->t, &group, s->grazing_tol, s->contact, s->contact, s->state, s->state + n, d,
                            &s->kind, error);
}

/* One round through the obstacles. @param any  whether there was an impact */
static ric_status apply_round(sequence *s, bool backwards, bool first, const tangents *d, bool *any, ric_error *error) {
  size_t n = s->system->coordinates;
  *any = false;
  for (size_t i = 0; i < s->count && s->kind == RIC_SALTATION_DIFFERENTIABLE; i++) {
    size_t obstacle = s->obstacles[backwards ? s->count - 1 - i : i];
    double rate = ric_system_gap_rate(s->system, obstacle, s->t, s->state, s->state + n);
    if (isnan(rate))
      return ric_fail(error, RIC_ECALLBACK, "the gap rate of obstacle %zu could not be evaluated", obstacle);
    if (first ? i > 0 && rate >= 0 : rate >= -s->grazing_tol) /* another impact has reversed it */
      continue;
    *any = true;
    RIC_TRY(hit(s, obstacle, d, error));
  }
  return RIC_OK;
}

/* S [n + m][n + m] of one order. */
static ric_status run_sequence(sequence *s, bool backwards, double *S, ric_error *error) {
  size_t n = s->system->coordinates, size = n + s->system->speeds;
  tangents d = {.columns = size, .q = S, .u = S + n * size};
  bool any = true;
  memset(S, 0, size * size * sizeof *S);
  for (size_t i = 0; i < size; i++)
    S[i * size + i] = 1;
  memcpy(s->state, s->q, n * sizeof *s->q);
  if (size > n)
    memcpy(s->state + n, s->u, (size - n) * sizeof *s->u);
  for (int round = 0; any && s->kind == RIC_SALTATION_DIFFERENTIABLE; round++) {
    if (round == MOST_ROUNDS)
      return ric_fail(error, RIC_ELIMIT, "contacts hit each other more than %d times at t = %g", MOST_ROUNDS, s->t);
    RIC_TRY(apply_round(s, backwards, round == 0, &d, &any, error));
  }
  return RIC_OK;
}

static ric_status check_sequence(const sequence *s, ric_error *error) {
  if (s->count == 0)
    return ric_fail(error, RIC_EINVAL, "no obstacle is hit, expected one or more");
  if (!(s->grazing_tol > 0))
    return ric_fail(error, RIC_EINVAL, "grazing_tol = %g, expected > 0", s->grazing_tol);
  for (size_t i = 0; i < s->count; i++) {
    size_t obstacle = s->obstacles[i];
    if (obstacle >= s->system->obstacle_count)
      return ric_fail(error, RIC_EINVAL, "obstacle %zu, expected one of %zu", obstacle, s->system->obstacle_count);
    if (system_complies(s->system, obstacle))
      return ric_fail(error, RIC_EINVAL, "obstacle %zu is compliant, expected a rigid one: it has no impacts",
                      obstacle);
    double rate = ric_system_gap_rate(s->system, obstacle, s->t, s->q, s->u);
    if (!(rate < 0))
      return ric_fail(error, RIC_EINVAL, "the gap rate of obstacle %zu is %g, expected below 0", obstacle, rate);
  }
  return RIC_OK;
}

/* Both orders into S [2][n + m][n + m], with the states that they lead to. */
static ric_status run_both(sequence *s, double *S, double *states, ric_error *error) {
  size_t size = s->system->coordinates + s->system->speeds;
  for (int k = 0; k < 2; k++) {
    RIC_TRY(run_sequence(s, k == 1, S + (size_t)k * size * size, error));
    memcpy(states + (size_t)k * size, s->state, size * sizeof *states);
  }
  bool agree = tangent_jumps_agree(S, S + size * size, size * size) && tangent_jumps_agree(states, states + size, size);
  if (s->kind == RIC_SALTATION_DIFFERENTIABLE && !agree)
    s->kind = RIC_SALTATION_NOT_DIFFERENTIABLE;
  return RIC_OK;
}

ric_status ric_saltation_find(const ric_system *system, double t, const double *q, const double *u,
                              const size_t *obstacles, size_t count, double grazing_tol, double *S, double *S_reverse,
                              ric_saltation_kind *kind, ric_error *error) {
  REQUIRE(error, {"system", system}, {"q", q}, {"obstacles", unless_empty(count, obstacles)}, {"S", S}, {"kind", kind});
  REQUIRE(error, {"u", unless_empty(system->speeds, u)});
  size_t size = system->coordinates + system->speeds, square = size * size;
  sequence s = {
      .system = system, .t = t, .grazing_tol = grazing_tol, .q = q, .u = u, .obstacles = obstacles, .count = count};
  RIC_TRY(check_sequence(&s, error));
  double *found = malloc(2 * (square + size) * sizeof *found);
  ric_status status = found ? begin_sequence(&s, error) : ric_fail(error, RIC_ENOMEM, "no memory for %zu states", size);
  if (status == RIC_OK)
    status = run_both(&s, found, found + 2 * square, error);
  if (status == RIC_OK && s.kind != RIC_SALTATION_GRAZING) {
    memcpy(S, found, square * sizeof *S);
    if (S_reverse)
      memcpy(S_reverse, found + square, square * sizeof *S_reverse);
  }
  if (status == RIC_OK)
    *kind = s.kind;
  end(&s);
  free(found);
  return status;
}
