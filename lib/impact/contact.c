/* The life of a contact: the one place that changes its state.
 *
 * A contact is open, pressed or held (kept by the flow, which its forces depend on), or passed for good: such a one has
 * no events and is on no list. An open or pressed one departs from zero, fast or slowly, until it is clear of it; a
 * held one comes to rest, where a series of impacts was summed up, or rests. Lists name those that are held, that
 * depart, and that come to rest, so that no step looks at all contacts. */
#include <string.h>

#include "growing.h"
#include "trajectory_state.h"

ric_status index_list_add(index_list *list, size_t item, ric_error *error) {
  size_t *items = growing_room(list->items, list->count, &list->capacity, sizeof *items);
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

double departure_value(const ric_trajectory *tr, size_t obstacle) {
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
  tr->resting[obstacle] = RESTS_NOT; /* leaves tr->held with the next look at that list */
  RIC_TRY(depart(tr, obstacle, how, error));
  if (persisted)
    trajectory_show_kind(tr, RIC_EVENT_RELEASE, obstacle);
  return RIC_OK;
}

ric_status contact_presses(ric_trajectory *tr, size_t obstacle, departure how, ric_error *error) {
  flow_set_contact(tr->flow, obstacle, CONTACT_PRESSED);
  return how == DEPARTED ? RIC_OK : depart(tr, obstacle, how, error);
}

ric_status contact_rests(ric_trajectory *tr, size_t obstacle, ric_error *error) {
  flow_set_contact(tr->flow, obstacle, CONTACT_HELD);
  tr->locator.departure[obstacle] = DEPARTED;
  if (contact_persists(tr, obstacle))
    return RIC_OK;
  tr->resting[obstacle] = RESTS;
  trajectory_show_kind(tr, RIC_EVENT_REST, obstacle);
  return index_list_add(&tr->held, obstacle, error);
}

ric_status contact_will_rest(ric_trajectory *tr, size_t obstacle, double time, ric_error *error) {
  coming_rest *coming = growing_room(tr->coming, tr->coming_count, &tr->coming_capacity, sizeof *coming);
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
