#include "ricochet/saltation.h"

#include <stdlib.h>
#include <string.h>

#include "tangent_jump.h"

enum { MOST_ROUNDS = 1000 /* of coupled contacts that hit each other back */ };

const char *ric_saltation_name(ric_saltation_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_SALTATION_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_SALTATION_KINDS ? names[kind] : "unknown kind";
}

/* Impacts of one time, in an order. */
typedef struct sequence {
  const ric_system *system;
  double t, grazing_tol;
  const double *q, *u; /* before */
  const size_t *obstacles;
  size_t count;
  tangent_jump jump;
  impact_solver law;
  double *state;          /* [n + m] between impacts */
  unsigned char *contact; /* [obstacles] open, or pressed where they comply */
  ric_saltation_kind kind;
} sequence;

static ric_status begin(sequence *s, ric_error *error) {
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

/* One round through the obstacles. @param any  whether one of them was hit */
static ric_status go_round(sequence *s, bool backwards, bool first, const tangents *d, bool *any, ric_error *error) {
  size_t n = s->system->coordinates;
  *any = false;
  for (size_t i = 0; i < s->count && s->kind == RIC_SALTATION_DIFFERENTIABLE; i++) {
    size_t obstacle = s->obstacles[backwards ? s->count - 1 - i : i];
    double rate = ric_system_gap_rate(s->system, obstacle, s->t, s->state, s->state + n);
    if (isnan(rate))
      return ric_fail(error, RIC_ECALLBACK, "the gap rate of obstacle %zu could not be evaluated", obstacle);
    if (first ? i > 0 && rate >= 0 : rate >= -s->grazing_tol) /* another one has turned it around */
      continue;
    *any = true;
    RIC_TRY(hit(s, obstacle, d, error));
  }
  return RIC_OK;
}

/* S [n + m][n + m] of one order. */
static ric_status run(sequence *s, bool backwards, double *S, ric_error *error) {
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
    RIC_TRY(go_round(s, backwards, round == 0, &d, &any, error));
  }
  return RIC_OK;
}

static ric_status check(const sequence *s, ric_error *error) {
  if (s->count == 0)
    return ric_fail(error, RIC_EINVAL, "no obstacle is hit, expected one or more");
  if (!(s->grazing_tol > 0))
    return ric_fail(error, RIC_EINVAL, "grazing_tol = %g, expected > 0", s->grazing_tol);
  for (size_t i = 0; i < s->count; i++) {
    size_t obstacle = s->obstacles[i];
    if (obstacle >= s->system->obstacle_count)
      return ric_fail(error, RIC_EINVAL, "obstacle %zu, expected one of %zu", obstacle, s->system->obstacle_count);
    if (system_complies(s->system, obstacle))
      return ric_fail(error, RIC_EINVAL, "obstacle %zu is compliant: nothing jumps there", obstacle);
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
    RIC_TRY(run(s, k == 1, S + (size_t)k * size * size, error));
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
  size_t size = system->coordinates + system->speeds, square = size * size;
  sequence s = {
      .system = system, .t = t, .grazing_tol = grazing_tol, .q = q, .u = u, .obstacles = obstacles, .count = count};
  RIC_TRY(check(&s, error));
  double *found = malloc(2 * (square + size) * sizeof *found);
  ric_status status = found ? begin(&s, error) : ric_fail(error, RIC_ENOMEM, "no memory for %zu states", size);
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
