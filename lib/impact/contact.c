/* The state of a contact and its changes: rest (sticking) and release. */
#include <stdlib.h>
#include <string.h>

#include "numeric/vector.h"
#include "numeric/list.h"
#include "trajectory.h"

/* The states of a contact: the only place that changes them.
 *
 * A contact is open, pressed or held (stored in the flow, whose forces depend on it), or passed permanently: such a
 * contact has no events and is on no list. An open or pressed contact departs from zero, fast or slowly, until its
 * function is clearly positive. A held one sticks, or will stick at a later time after its series of impacts was
 * summed. Lists contain the contacts that are held, depart, or will stick, so that no step has to visit all contacts.
 */

ric_status index_list_add(index_list *list, size_t item, ric_error *error) {
  size_t *items = list_room(list->items, list->count, &list->capacity, sizeof *items);
  if (!items)
    return ric_fail(error, RIC_ENOMEM, "no memory for a list of more than %zu contacts", list->count);
  list->items = items;
  list->items[list->count++] = item;
  return RIC_OK;
}

void contacts_reset(ric_trajectory *tr) {
  size_t count = tr->system->obstacle_count;
  memset(tr->flow->contact, CONTACT_OPEN, count);
  for (size_t j = 0; tr->options.pass_rigid && j < count; j++)
    if (!system_complies(tr->system, j))
      flow_set_contact(tr->flow, j, CONTACT_PASSED);
  memset(tr->resting, RESTS_NOT, count);
  memset(tr->locator.departure, DEPARTED, count);
  tr->held.count = tr->departing.count = tr->coming_count = 0;
}

bool contact_is_passed(const ric_trajectory *tr, size_t obstacle) {
  return flow_contact(tr->flow, obstacle) == CONTACT_PASSED;
}

bool contact_persists(const ric_trajectory *tr, size_t obstacle) {
  return tr->resting[obstacle] != RESTS_NOT;
}

/* Current value of the function whose root is a contact's next event: its gap, minus its gap while it is pressed. */
static double departure_value(const ric_trajectory *tr, size_t obstacle) {
  double gap = ric_system_gap(tr->system, obstacle, tr->flow->time, tr->flow->q);
  return flow_contact(tr->flow, obstacle) == CONTACT_PRESSED ? -gap : gap;
}

static ric_status depart(ric_trajectory *tr, size_t obstacle, departure how, ric_error *error) {
  bool listed = tr->locator.departure[obstacle] != DEPARTED;
  tr->locator.departure[obstacle] = (unsigned char)how;
  tr->locator.base[obstacle] = departure_value(tr, obstacle);
  return listed ? RIC_OK : index_list_add(&tr->departing, obstacle, error);
}

ric_status contact_opens(ric_trajectory *tr, size_t obstacle, departure how, ric_error *error) {
  bool persisted = contact_persists(tr, obstacle);
  flow_set_contact(tr->flow, obstacle, CONTACT_OPEN);
  tr->resting[obstacle] = RESTS_NOT; /* is removed from tr->held when that list is next processed */
  RIC_TRY(depart(tr, obstacle, how, error));
  if (persisted)
    trajectory_show_kind(tr, RIC_EVENT_RELEASE, obstacle);
  return RIC_OK;
}

ric_status contact_presses(ric_trajectory *tr, size_t obstacle, departure how, ric_error *error) {
  flow_set_contact(tr->flow, obstacle, CONTACT_PRESSED);
  return how == DEPARTED ? RIC_OK : depart(tr, obstacle, how, error);
}

/* It is held from now on; if it did not stick before, with an event `rest`. */
static ric_status contact_rests(ric_trajectory *tr, size_t obstacle, ric_error *error) {
  flow_set_contact(tr->flow, obstacle, CONTACT_HELD);
  tr->locator.departure[obstacle] = DEPARTED;
  if (contact_persists(tr, obstacle))
    return RIC_OK;
  tr->resting[obstacle] = RESTS;
  trajectory_show_kind(tr, RIC_EVENT_REST, obstacle);
  return index_list_add(&tr->held, obstacle, error);
}

ric_status contact_will_rest(ric_trajectory *tr, size_t obstacle, double time, ric_error *error) {
  coming_rest *coming = list_room(tr->coming, tr->coming_count, &tr->coming_capacity, sizeof *coming);
  if (!coming)
    return ric_fail(error, RIC_ENOMEM, "no memory for more than %zu contacts that come to rest", tr->coming_count);
  tr->coming = coming;
  tr->coming[tr->coming_count++] = (coming_rest){.time = time, .obstacle = obstacle};
  tr->resting[obstacle] = COMES_TO_REST;
  return index_list_add(&tr->held, obstacle, error);
}

void contacts_come_to_rest(ric_trajectory *tr) {
  size_t kept = 0;
  for (size_t i = 0; i < tr->coming_count; i++) {
    coming_rest c = tr->coming[i];
    if (tr->resting[c.obstacle] != COMES_TO_REST)
      continue; /* released before */
    if (c.time > tr->flow->time) {
      tr->coming[kept++] = c;
      continue;
    }
    tr->resting[c.obstacle] = RESTS;
    trajectory_show_kind(tr, RIC_EVENT_REST, c.obstacle);
  }
  tr->coming_count = kept;
}

double contacts_next_rest(const ric_trajectory *tr, double end) {
  for (size_t i = 0; i < tr->coming_count; i++)
    if (tr->coming[i].time < end && tr->coming[i].time > tr->flow->time)
      end = tr->coming[i].time;
  return end;
}

ric_status contacts_depart(ric_trajectory *tr, ric_error *error) {
  size_t kept = 0;
  for (size_t i = 0; i < tr->departing.count; i++) {
    size_t obstacle = tr->departing.items[i];
    double value = departure_value(tr, obstacle);
    if (isnan(value))
      return ric_fail(error, RIC_ECALLBACK, "at t = %g: the gap of obstacle %zu could not be evaluated", tr->flow->time,
                      obstacle);
    if (tr->locator.departure[obstacle] == DEPARTED)
      continue;
    if (value > tr->locator.noise)
      tr->locator.departure[obstacle] = DEPARTED;
    else
      tr->departing.items[kept++] = obstacle;
  }
  tr->departing.count = kept;
  return RIC_OK;
}

void contacts_forget_released(ric_trajectory *tr) {
  size_t kept = 0;
  for (size_t i = 0; i < tr->held.count; i++)
    if (contact_persists(tr, tr->held.items[i]))
      tr->held.items[kept++] = tr->held.items[i];
  tr->held.count = kept;
}

/* Contacts with gap and gap rate zero: which stick, which open, and how impacts accumulate until sticking. */

static ric_status callback_error(const ric_trajectory *tr, size_t obstacle, const char *trouble, ric_error *error) {
  return ric_fail(error, RIC_ECALLBACK, "at t = %g, obstacle %zu: %s", tr->flow->time, obstacle, trouble);
}

void contacts_measure(ric_trajectory *tr) {
  size_t n = tr->system->coordinates, m = tr->system->speeds;
  double place = largest(tr->flow->q, n);
  tr->locator.noise = tr->noise * (1 + place);
  tr->rate_noise = tr->noise * (1 + (m ? largest(tr->flow->u, m) : place));
}

ric_status contact_rates(ric_trajectory *tr, double t, const double *q, const double *u, ric_error *error) {
  const ric_system *s = tr->system;
  const char *trouble = s->model->rate(s, tr->flow->contact, t, q, u, tr->rates, tr->rates + s->coordinates);
  return trouble ? ric_fail(error, RIC_ECALLBACK, "at t = %g: %s", t, trouble) : RIC_OK;
}

ric_status contact_acceleration(ric_trajectory *tr, double t, const double *q, const double *u, size_t obstacle,
                                double *acceleration, ric_error *error) {
  const ric_system *s = tr->system;
  const char *trouble =
      s->model->gap_acceleration(s, obstacle, t, q, u, tr->rates, tr->rates + s->coordinates, acceleration);
  return trouble ? callback_error(tr, obstacle, trouble, error) : RIC_OK;
}

ric_status gap_acceleration(ric_trajectory *tr, size_t obstacle, double *acceleration, ric_error *error) {
  ric_flow *f = tr->flow;
  contact_state now = flow_contact(f, obstacle);
  if (now == CONTACT_HELD)
    flow_set_contact(f, obstacle, CONTACT_OPEN);
  ric_status status = contact_rates(tr, f->time, f->q, f->u, error);
  flow_set_contact(f, obstacle, now);
  RIC_TRY(status);
  return contact_acceleration(tr, f->time, f->q, f->u, obstacle, acceleration, error);
}

static ric_status reserve_work(ric_trajectory *tr, ric_error *error) {
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

/* Moves the coordinates with speeds that close the gaps in a unit of time: q' is linear in the speeds. */
static ric_status close_gaps(ric_trajectory *tr, const size_t *obstacles, size_t count, ric_error *error) {
  ric_flow *f = tr->flow;
  size_t n = tr->system->coordinates, m = tr->system->speeds;
  double *u = tr->shifted + n;
  RIC_TRY(contact_rates(tr, f->time, f->q, f->u, error));
  memcpy(tr->shifted, tr->rates, n * sizeof *tr->rates);
  memcpy(u, f->u, m * sizeof *u);
  RIC_TRY(impact_close_in(&tr->law, f->time, f->q, u, obstacles, count, error));
  RIC_TRY(contact_rates(tr, f->time, f->q, u, error));
  for (size_t i = 0; i < n; i++)
    f->q[i] += tr->rates[i] - tr->shifted[i];
  return RIC_OK;
}

ric_status contacts_put_on(ric_trajectory *tr, const size_t *obstacles, size_t count, ric_error *error) {
  const ric_obstacle *o = tr->system->obstacles;
  for (size_t i = 0; o && i < count; i++)
    tr->flow->q[o[obstacles[i]].coordinate] = o[obstacles[i]].position;
  return o || !tr->system->model->direction || count == 0 ? RIC_OK : close_gaps(tr, obstacles, count, error);
}

/* Sets gap rates of contacts to zero: to rounding; for obstacles at coordinates exactly. */
static ric_status halt(ric_trajectory *tr, const index_list *list, ric_error *error) {
  const ric_system *s = tr->system;
  ric_flow *f = tr->flow;
  double loss;
  if (list->count == 0 || !s->model->direction)
    return RIC_OK;
  RIC_TRY(impact_reflect(&tr->law, f->time, f->q, f->u, list->items, NULL, list->count, &loss, error));
  tr->run->impact_loss += loss;
  for (size_t i = 0; s->obstacles && i < list->count; i++)
    f->u[s->obstacles[list->items[i]].coordinate] = 0;
  return RIC_OK;
}

ric_status contacts_keep_on(ric_trajectory *tr, bool *moved, ric_error *error) {
  *moved = false;
  for (size_t i = 0; i < tr->held.count && !tr->system->obstacles && tr->system->model->direction; i++) {
    double gap = ric_system_gap(tr->system, tr->held.items[i], tr->flow->time, tr->flow->q);
    *moved |= fabs(gap) > tr->locator.noise;
  }
  if (!*moved)
    return RIC_OK;
  RIC_TRY(contacts_put_on(tr, tr->held.items, tr->held.count, error));
  return halt(tr, &tr->held, error);
}

/* Whether sticking contacts leave the motion a free direction. If not, they already hold a further contact of a user
 * system. */
static bool is_free(const ric_trajectory *tr) {
  const ric_system *s = tr->system;
  size_t held = 0;
  if (s->obstacles)
    return true;
  for (size_t i = 0; i < tr->held.count; i++)
    held += contact_persists(tr, tr->held.items[i]);
  return held < (s->speeds ? s->speeds : s->coordinates);
}

static ric_status conclude(ric_trajectory *tr, size_t obstacle, bool persists, ric_error *error) {
  if (persists && (contact_persists(tr, obstacle) || is_free(tr)))
    return contact_rests(tr, obstacle, error);
  return contact_opens(tr, obstacle, DEPARTS_SLOWLY, error);
}

/* Accelerations of the undecided contacts with all of them open, then with their forces. */
static ric_status find_forces(ric_trajectory *tr, ric_error *error) {
  ric_flow *f = tr->flow;
  const index_list *list = &tr->settling;
  RIC_TRY(reserve_work(tr, error));
  for (size_t i = 0; i < list->count; i++)
    flow_set_contact(f, list->items[i], CONTACT_OPEN);
  RIC_TRY(contact_rates(tr, f->time, f->q, f->u, error));
  for (size_t i = 0; i < list->count; i++)
    RIC_TRY(contact_acceleration(tr, f->time, f->q, f->u, list->items[i], &tr->accelerations[i], error));
  return contact_forces(&tr->law, f->time, f->q, list->items, tr->accelerations, list->count, tr->forces, error);
}

/* Contacts with a positive force get zero gap and gap rate, as do closed contacts without force and acceleration:
 * remaining errors would make the body rock between its redundant contacts. */
static ric_status begin_sticking(ric_trajectory *tr, ric_error *error) {
  tr->closed.count = 0;
  for (size_t i = 0; i < tr->settling.count; i++)
    if (!(tr->accelerations[i] > 0))
      RIC_TRY(index_list_add(&tr->closed, tr->settling.items[i], error));
  RIC_TRY(contacts_put_on(tr, tr->closed.items, tr->closed.count, error));
  return halt(tr, &tr->closed, error);
}

ric_status contacts_settle(ric_trajectory *tr, ric_error *error) {
  index_list *list = &tr->settling;
  if (list->count == 0)
    return RIC_OK;
  RIC_TRY(find_forces(tr, error));
  RIC_TRY(begin_sticking(tr, error));
  for (size_t i = 0; i < list->count; i++) {
    bool neutral = list->count == 1 && !(tr->accelerations[i] > 0);
    RIC_TRY(conclude(tr, list->items[i], tr->forces[i] > 0 || neutral, error));
  }
  list->count = 0;
  contacts_forget_released(tr);
  return RIC_OK;
}
