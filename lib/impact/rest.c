/* Contacts with gap and gap rate zero: which persist, which open, and how impacts accumulate towards rest. */
#include <stdlib.h>
#include <string.h>

#include "trajectory_state.h"

static ric_status blame(const ric_trajectory *tr, size_t obstacle, const char *trouble, ric_error *error) {
  return ric_fail(error, RIC_ECALLBACK, "at t = %g, obstacle %zu: %s", tr->flow->time, obstacle, trouble);
}

double rest_rate(const ric_trajectory *tr) {
  const double *speeds = tr->system->speeds ? tr->flow->u : tr->flow->q;
  size_t count = tr->system->speeds ? tr->system->speeds : tr->system->coordinates;
  double largest = 0;
  for (size_t i = 0; i < count; i++)
    largest = fmax(largest, fabs(speeds[i]));
  return tr->noise * (1 + largest);
}

/* Rates of the present state into tr->rates. */
static ric_status find_rates(ric_trajectory *tr, double t, const double *q, const double *u, ric_error *error) {
  const ric_system *s = tr->system;
  const char *trouble = s->model->rate(s, tr->flow->contact, t, q, u, tr->rates, tr->rates + s->coordinates);
  return trouble ? ric_fail(error, RIC_ECALLBACK, "at t = %g: %s", t, trouble) : RIC_OK;
}

static ric_status read_acceleration(ric_trajectory *tr, double t, const double *q, const double *u, size_t obstacle,
                                    double *acceleration, ric_error *error) {
  const ric_system *s = tr->system;
  const char *trouble =
      s->model->gap_acceleration(s, obstacle, t, q, u, tr->rates, tr->rates + s->coordinates, acceleration);
  return trouble ? blame(tr, obstacle, trouble, error) : RIC_OK;
}

ric_status gap_acceleration(ric_trajectory *tr, size_t obstacle, double *acceleration, ric_error *error) {
  const ric_flow *f = tr->flow;
  RIC_TRY(find_rates(tr, f->time, f->q, f->u, error));
  return read_acceleration(tr, f->time, f->q, f->u, obstacle, acceleration, error);
}

/* Acceleration of the gap a short time from now, the state moved along its rates; tr->rates are lost. */
static ric_status acceleration_after(ric_trajectory *tr, size_t obstacle, double dt, double *acceleration,
                                     ric_error *error) {
  const ric_flow *f = tr->flow;
  size_t n = tr->system->coordinates, m = tr->system->speeds;
  double *q = tr->shifted, *u = tr->shifted + n;
  RIC_TRY(find_rates(tr, f->time, f->q, f->u, error));
  for (size_t i = 0; i < n; i++)
    q[i] = f->q[i] + dt * tr->rates[i];
  for (size_t i = 0; i < m; i++)
    u[i] = f->u[i] + dt * tr->rates[n + i];
  RIC_TRY(find_rates(tr, f->time + dt, q, u, error));
  return read_acceleration(tr, f->time + dt, q, u, obstacle, acceleration, error);
}

/* Flights of a gap with acceleration -A + J t that begin at the rate w and shrink by e last, in all and to the order
 * after the first, 2 w / (A (1 - e)) (1 + (2/3) (J / A^2) w / (1 - e)). */
ric_status chatter_ahead(ric_trajectory *tr, size_t obstacle, double rate, bool *chatters, double *duration,
                         ric_error *error) {
  double e = tr->system->model->restitution(tr->system, obstacle), tol = tr->options.chatter_tol;
  double now, before, after, dt = 1e-5;
  *chatters = false;
  if (!(e < 1) || tol == 0)
    return RIC_OK;
  RIC_TRY(gap_acceleration(tr, obstacle, &now, error));
  *duration = 2 * rate / (-now * (1 - e));
  if (!(now < 0 && *duration <= tol))
    return RIC_OK;
  RIC_TRY(acceleration_after(tr, obstacle, dt, &after, error));
  RIC_TRY(acceleration_after(tr, obstacle, -dt, &before, error));
  double jerk = (after - before) / (2 * dt);
  *chatters = *duration * fmax(1, fabs(jerk) / -now) <= tol;
  *duration *= 1 + 2 * jerk * rate / (3 * now * now * (1 - e));
  return RIC_OK;
}

static ric_status make_room(ric_trajectory *tr, ric_error *error) {
  size_t count = tr->settling.count;
  if (count <= tr->settling_capacity)
    return RIC_OK;
  free(tr->accelerations);
  free(tr->forces);
  tr->accelerations = malloc(count * sizeof *tr->accelerations);
  tr->forces = malloc(count * sizeof *tr->forces);
  tr->settling_capacity = tr->accelerations && tr->forces ? count : 0;
  return tr->settling_capacity ? RIC_OK : ric_fail(error, RIC_ENOMEM, "no memory for %zu persistent contacts", count);
}

/* Gap and gap rate of a held contact at a coordinate are zero exactly. */
static void hold(ric_trajectory *tr, size_t obstacle) {
  flow_set_contact(tr->flow, obstacle, CONTACT_HELD);
  tr->locator.departure[obstacle] = DEPARTED;
  if (tr->system->obstacles) {
    const ric_obstacle *o = &tr->system->obstacles[obstacle];
    tr->flow->q[o->coordinate] = o->position;
    tr->flow->u[o->coordinate] = 0;
  }
}

static ric_status open_slowly(ric_trajectory *tr, size_t obstacle, ric_error *error) {
  flow_set_contact(tr->flow, obstacle, CONTACT_OPEN);
  tr->locator.departure[obstacle] = DEPARTS_SLOWLY;
  return index_list_add(&tr->departing, obstacle, error);
}

static ric_status conclude(ric_trajectory *tr, size_t obstacle, bool persists, ric_error *error) {
  bool rested = tr->resting[obstacle] != RESTS_NOT;
  if (persists)
    hold(tr, obstacle);
  else
    RIC_TRY(open_slowly(tr, obstacle, error));
  if (persists && !rested) {
    tr->resting[obstacle] = RESTS;
    RIC_TRY(index_list_add(&tr->held, obstacle, error));
    trajectory_show_kind(tr, RIC_EVENT_REST, obstacle);
  } else if (!persists && rested)
    contact_release(tr, obstacle);
  return RIC_OK;
}

void contact_release(ric_trajectory *tr, size_t obstacle) {
  tr->resting[obstacle] = RESTS_NOT; /* leaves tr->held with the next look at that list */
  trajectory_show_kind(tr, RIC_EVENT_RELEASE, obstacle);
}

void contacts_forget_released(ric_trajectory *tr) {
  size_t kept = 0;
  for (size_t i = 0; i < tr->held.count; i++)
    if (tr->resting[tr->held.items[i]] != RESTS_NOT)
      tr->held.items[kept++] = tr->held.items[i];
  tr->held.count = kept;
}

ric_status contacts_settle(ric_trajectory *tr, ric_error *error) {
  ric_flow *f = tr->flow;
  index_list *list = &tr->settling;
  if (list->count == 0)
    return RIC_OK;
  RIC_TRY(make_room(tr, error));
  for (size_t i = 0; i < list->count; i++)
    flow_set_contact(f, list->items[i], CONTACT_OPEN);
  RIC_TRY(find_rates(tr, f->time, f->q, f->u, error));
  for (size_t i = 0; i < list->count; i++)
    RIC_TRY(read_acceleration(tr, f->time, f->q, f->u, list->items[i], &tr->accelerations[i], error));
  RIC_TRY(contact_forces(&tr->law, f->time, f->q, list->items, tr->accelerations, list->count, tr->forces, error));
  for (size_t i = 0; i < list->count; i++) {
    bool neutral = list->count == 1 && tr->accelerations[i] <= 0;
    RIC_TRY(conclude(tr, list->items[i], tr->forces[i] > 0 || neutral, error));
  }
  list->count = 0;
  contacts_forget_released(tr);
  return RIC_OK;
}
