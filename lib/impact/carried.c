/* Tangent vectors of a trajectory where contacts meet. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "trajectory_state.h"

void carried_clear(carried *c) {
  tangent_jump_clear(&c->jump);
  free(c->before);
  free(c->contact);
  free(c->group.items);
  free(c->restitution);
  *c = (carried){0};
}

static ric_status make_room(ric_trajectory *tr, size_t columns, ric_error *error) {
  carried *c = &tr->carried;
  size_t size = tr->system->coordinates + tr->system->speeds, count = tr->system->obstacle_count;
  if (c->jump.columns >= columns)
    return RIC_OK;
  carried_clear(c);
  RIC_TRY(tangent_jump_init(&c->jump, tr->system, &tr->law, columns, error));
  c->before = malloc(size * (columns + 2) * sizeof *c->before);
  c->contact = malloc(3 * count + 1);
  if (!c->before || !c->contact) {
    carried_clear(c);
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors of %zu numbers", columns, size);
  }
  c->state = c->before + size;
  c->other = c->before + 2 * size;
  c->contact_before = c->contact + count;
  c->contact_after = c->contact + 2 * count;
  return RIC_OK;
}

ric_status ric_trajectory_carry(ric_trajectory *tr, size_t columns, const double *dq, const double *du,
                                ric_error *error) {
  if (!tr->started)
    return ric_fail(error, RIC_EINVAL, "the trajectory has no start");
  RIC_TRY(ric_flow_carry(tr->flow, columns, dq, du, error));
  tr->carried.kind = RIC_SALTATION_DIFFERENTIABLE;
  ric_status status = columns > 0 ? make_room(tr, columns, error) : RIC_OK;
  if (status != RIC_OK)
    (void)ric_flow_carry(tr->flow, 0, NULL, NULL, NULL);
  for (size_t i = 0; status == RIC_OK && tr->system->obstacles && i < tr->held.count; i++)
    carried_hold(tr, tr->held.items[i]);
  return status;
}

size_t ric_trajectory_columns(const ric_trajectory *trajectory) {
  return ric_flow_columns(trajectory->flow);
}

const double *ric_trajectory_dq(const ric_trajectory *trajectory) {
  return ric_flow_dq(trajectory->flow);
}

const double *ric_trajectory_du(const ric_trajectory *trajectory) {
  return ric_flow_du(trajectory->flow);
}

static bool carries(const ric_trajectory *tr) {
  return tr->flow->tangent.columns > 0;
}

void carried_mark(ric_trajectory *tr) {
  const ric_flow *f = tr->flow;
  size_t n = tr->system->coordinates, m = tr->system->speeds;
  if (!carries(tr))
    return;
  memcpy(tr->carried.before, f->q, n * sizeof *f->q);
  if (m > 0)
    memcpy(tr->carried.before + n, f->u, m * sizeof *f->u);
  memcpy(tr->carried.contact_before, f->contact, tr->system->obstacle_count);
}

void carried_lose(ric_trajectory *tr, size_t obstacle, double time, ric_saltation_kind kind) {
  if (!carries(tr) || tr->carried.kind != RIC_SALTATION_DIFFERENTIABLE)
    return;
  tr->carried.kind = kind;
  tr->carried.obstacle = obstacle;
  tr->carried.time = time;
}

void carried_hold(ric_trajectory *tr, size_t obstacle) {
  const ric_obstacle *o = tr->system->obstacles;
  const tangents *d = &tr->flow->tangent;
  if (!carries(tr))
    return;
  if (!o) { /* no way to tell the directions that it leaves from the one that it takes */
    carried_lose(tr, obstacle, tr->flow->time, RIC_SALTATION_NOT_DIFFERENTIABLE);
    return;
  }
  memset(d->q + o[obstacle].coordinate * d->columns, 0, d->columns * sizeof *d->q);
  memset(d->u + o[obstacle].coordinate * d->columns, 0, d->columns * sizeof *d->u);
}

/* The contacts of tr->impacts that push together: one that is hit, and the persistent ones that it has reached. */
static ric_status gather_group(ric_trajectory *tr, size_t which, size_t hits, jump_group *group, ric_error *error) {
  carried *c = &tr->carried;
  c->group.count = 0;
  if (c->restitution_capacity < tr->impact_count) {
    free(c->restitution);
    c->restitution = malloc(tr->impact_capacity * sizeof *c->restitution);
    c->restitution_capacity = c->restitution ? tr->impact_capacity : 0;
  }
  if (!c->restitution)
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu contacts", tr->impact_count);
  const impact *first = &tr->impacts[which];
  bool sticks = !isnan(first->accumulation) || flow_contact(tr->flow, first->obstacle) == CONTACT_HELD;
  for (size_t i = 0; i < tr->impact_count; i++) {
    const impact *contact = &tr->impacts[i];
    bool pushes = i == which || (hits == 1 && contact->impulse > 0);
    if (!pushes)
      continue;
    c->restitution[c->group.count] = sticks ? 0 : contact->restitution;
    RIC_TRY(index_list_add(&c->group, contact->obstacle, error));
  }
  *group = (jump_group){c->group.items, c->restitution, c->group.count, sticks};
  return RIC_OK;
}

/* Takes tangent vectors through one impact; the contacts that follow upon it are those of the flow, but for impacts
 * that are still to come. */
static ric_status pass(ric_trajectory *tr, size_t which, size_t hits, bool last, const tangents *d, ric_error *error) {
  carried *c = &tr->carried;
  size_t n = tr->system->coordinates, obstacle = tr->impacts[which].obstacle;
  jump_group group;
  ric_saltation_kind kind;
  RIC_TRY(gather_group(tr, which, hits, &group, error));
  memcpy(c->contact_after, last ? tr->flow->contact : c->contact, tr->system->obstacle_count);
  c->contact_after[obstacle] = tr->flow->contact[obstacle];
  RIC_TRY(tangent_jump_apply(&c->jump, tr->flow->time, &group, tr->options.grazing_tol, c->contact, c->contact_after,
                             c->state, c->state + n, d, &kind, error));
  if (kind != RIC_SALTATION_DIFFERENTIABLE)
    carried_lose(tr, obstacle, tr->flow->time, kind);
  return RIC_OK;
}

/* All impacts, one after the other, forwards or backwards. */
static ric_status pass_all(ric_trajectory *tr, size_t hits, bool backwards, const tangents *d, ric_error *error) {
  carried *c = &tr->carried;
  size_t size = tr->system->coordinates + tr->system->speeds;
  memcpy(c->state, c->before, size * sizeof *c->state);
  memcpy(c->contact, c->contact_before, tr->system->obstacle_count);
  for (size_t i = 0; i < hits && c->kind == RIC_SALTATION_DIFFERENTIABLE; i++)
    RIC_TRY(pass(tr, backwards ? hits - 1 - i : i, hits, i + 1 == hits, d, error));
  return RIC_OK;
}

static bool any_coupled(const ric_trajectory *tr, size_t hits) {
  bool coupled = false;
  for (size_t i = 0; i < hits && hits > 1; i++)
    coupled |= tr->impacts[i].coupled;
  return coupled;
}

ric_status carried_meet(ric_trajectory *tr, size_t hits, ric_error *error) {
  carried *c = &tr->carried;
  tangents *d = &tr->flow->tangent, other = {.columns = d->columns, .q = c->other};
  size_t n = tr->system->coordinates, size = (n + tr->system->speeds) * d->columns;
  if (!carries(tr) || hits == 0 || c->kind != RIC_SALTATION_DIFFERENTIABLE)
    return RIC_OK;
  if (any_coupled(tr, hits)) {
    carried_lose(tr, tr->impacts[0].obstacle, tr->flow->time, RIC_SALTATION_NOT_DIFFERENTIABLE);
    return RIC_OK;
  }
  other.u = other.q + n * d->columns;
  if (hits > 1) {
    memcpy(other.q, d->q, size * sizeof *d->q);
    RIC_TRY(pass_all(tr, hits, true, &other, error));
  }
  RIC_TRY(pass_all(tr, hits, false, d, error));
  if (hits > 1 && !tangent_jumps_agree(d->q, other.q, size))
    carried_lose(tr, tr->impacts[0].obstacle, tr->flow->time, RIC_SALTATION_NOT_DIFFERENTIABLE);
  /* Contacts that the impacts have closed leave no more of their directions than rounding, which is not to be kept. */
  for (size_t i = 0; tr->system->obstacles && i < tr->held.count; i++)
    carried_hold(tr, tr->held.items[i]);
  return RIC_OK;
}

ric_status carried_end(ric_trajectory *tr, char *reason, size_t room, ric_error *error) {
  bool grazes = tr->carried.kind == RIC_SALTATION_GRAZING;
  snprintf(reason, room, "at t = %g tangent vectors have no way through %s obstacle %zu", tr->carried.time,
           grazes ? "the grazing contact of" : "impacts at one time, one of them on", tr->carried.obstacle);
  tr->carried.kind = RIC_SALTATION_DIFFERENTIABLE;
  return ric_flow_carry(tr->flow, 0, NULL, NULL, error);
}
