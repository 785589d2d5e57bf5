/* Events: onset of contacts, with the impact law, and the tangent vectors there. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "numeric/list.h"
#include "numeric/required.h"
#include "ricochet/event.h"
#include "trajectory.h"

const char *ric_event_name(ric_event_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_EVENT_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_EVENT_KINDS ? names[kind] : "unknown";
}

/* Tangent vectors of a trajectory at the onset of contacts. */

void impact_tangents_clear(impact_tangents *c) {
  tangent_jump_clear(&c->jump);
  free(c->before);
  free(c->contact);
  free(c->group.items);
  free(c->restitution);
  *c = (impact_tangents){0};
}

static ric_status reserve_tangents(ric_trajectory *tr, size_t columns, ric_error *error) {
  impact_tangents *c = &tr->tangents;
  size_t size = tr->system->coordinates + tr->system->speeds, count = tr->system->obstacle_count;
  if (c->jump.columns >= columns)
    return RIC_OK;
  impact_tangents_clear(c);
  RIC_TRY(tangent_jump_init(&c->jump, tr->system, &tr->law, columns, error));
  c->before = malloc(size * (columns + 2) * sizeof *c->before);
  c->contact = malloc(3 * count + 1);
  if (!c->before || !c->contact) {
    impact_tangents_clear(c);
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors of %zu numbers", columns, size);
  }
  c->state = c->before + size;
  c->other = c->before + 2 * size;
  c->contact_before = c->contact + count;
  c->contact_after = c->contact + 2 * count;
  return RIC_OK;
}

static bool carries(const ric_trajectory *tr) {
  return tr->flow->tangent.columns > 0;
}

void impact_tangents_lose(ric_trajectory *tr, size_t obstacle, double time, ric_saltation_kind kind) {
  if (!carries(tr) || tr->tangents.kind != RIC_SALTATION_DIFFERENTIABLE)
    return;
  tr->tangents.kind = kind;
  tr->tangents.obstacle = obstacle;
  tr->tangents.time = time;
}

/* A contact sticks from the start on, and constrains the tangent vectors. */
static void impact_tangents_hold(ric_trajectory *tr, size_t obstacle) {
  const ric_obstacle *o = tr->system->obstacles;
  const tangents *d = &tr->flow->tangent;
  if (!carries(tr))
    return;
  if (!o) { /* the held direction cannot be separated from the free ones */
    impact_tangents_lose(tr, obstacle, tr->flow->time, RIC_SALTATION_NOT_DIFFERENTIABLE);
    return;
  }
  memset(d->q + o[obstacle].coordinate * d->columns, 0, d->columns * sizeof *d->q);
  memset(d->u + o[obstacle].coordinate * d->columns, 0, d->columns * sizeof *d->u);
}

ric_status ric_trajectory_carry(ric_trajectory *tr, size_t columns, const double *dq, const double *du,
                                ric_error *error) {
  REQUIRE(error, {"trajectory", tr}, {"dq", unless_empty(columns, dq)});
  if (!tr->started)
    return ric_fail(error, RIC_EINVAL, "the trajectory has not been started");
  RIC_TRY(ric_flow_carry(tr->flow, columns, dq, du, error));
  tr->tangents.kind = RIC_SALTATION_DIFFERENTIABLE;
  ric_status status = columns > 0 ? reserve_tangents(tr, columns, error) : RIC_OK;
  if (status != RIC_OK)
    (void)ric_flow_carry(tr->flow, 0, NULL, NULL, NULL);
  for (size_t i = 0; status == RIC_OK && tr->system->obstacles && i < tr->held.count; i++)
    impact_tangents_hold(tr, tr->held.items[i]);
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

/* Before the onset of contacts: stores what tangent vectors need. Does nothing without tangent vectors. */
static void impact_tangents_mark(ric_trajectory *tr) {
  const ric_flow *f = tr->flow;
  size_t n = tr->system->coordinates, m = tr->system->speeds;
  if (!carries(tr))
    return;
  memcpy(tr->tangents.before, f->q, n * sizeof *f->q);
  if (m > 0)
    memcpy(tr->tangents.before + n, f->u, m * sizeof *f->u);
  memcpy(tr->tangents.contact_before, f->contact, tr->system->obstacle_count);
}

/* The contacts of tr->impacts that act together: one impact, and the persistent contacts coupled to it. */
static ric_status gather_group(ric_trajectory *tr, size_t which, size_t hits, jump_group *group, ric_error *error) {
  impact_tangents *c = &tr->tangents;
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

/* Propagates tangent vectors through one impact; the contact states after it are those of the flow, except for impacts
 * still to come. */
static ric_status pass(ric_trajectory *tr, size_t which, size_t hits, bool last, const tangents *d, ric_error *error) {
  impact_tangents *c = &tr->tangents;
  size_t n = tr->system->coordinates, obstacle = tr->impacts[which].obstacle;
  jump_group group;
  ric_saltation_kind kind;
  RIC_TRY(gather_group(tr, which, hits, &group, error));
  memcpy(c->contact_after, last ? tr->flow->contact : c->contact, tr->system->obstacle_count);
  c->contact_after[obstacle] = tr->flow->contact[obstacle];
  RIC_TRY(tangent_jump_apply(&c->jump, tr->flow->time, &group, tr->options.grazing_tol, c->contact, c->contact_after,
                             c->state, c->state + n, d, &kind, error));
  if (kind != RIC_SALTATION_DIFFERENTIABLE)
    impact_tangents_lose(tr, obstacle, tr->flow->time, kind);
  return RIC_OK;
}

/* All impacts, one after the other, forwards or backwards. */
static ric_status pass_all(ric_trajectory *tr, size_t hits, bool backwards, const tangents *d, ric_error *error) {
  impact_tangents *c = &tr->tangents;
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

/* After the onset of contacts: propagates tangent vectors through the first `hits` of tr->impacts. */
static ric_status impact_tangents_jump(ric_trajectory *tr, size_t hits, ric_error *error) {
  impact_tangents *c = &tr->tangents;
  tangents *d = &tr->flow->tangent, other = {.columns = d->columns, .q = c->other};
  size_t n = tr->system->coordinates, size = (n + tr->system->speeds) * d->columns;
  if (!carries(tr) || hits == 0 || c->kind != RIC_SALTATION_DIFFERENTIABLE)
    return RIC_OK;
  if (any_coupled(tr, hits)) {
    impact_tangents_lose(tr, tr->impacts[0].obstacle, tr->flow->time, RIC_SALTATION_NOT_DIFFERENTIABLE);
    return RIC_OK;
  }
  other.u = other.q + n * d->columns;
  if (hits > 1) {
    memcpy(other.q, d->q, size * sizeof *d->q);
    RIC_TRY(pass_all(tr, hits, true, &other, error));
  }
  RIC_TRY(pass_all(tr, hits, false, d, error));
  if (hits > 1 && !tangent_jumps_agree(d->q, other.q, size))
    impact_tangents_lose(tr, tr->impacts[0].obstacle, tr->flow->time, RIC_SALTATION_NOT_DIFFERENTIABLE);
  /* Components along contacts closed by the impacts are rounding; they are set to zero. */
  for (size_t i = 0; tr->system->obstacles && i < tr->held.count; i++)
    impact_tangents_hold(tr, tr->held.items[i]);
  return RIC_OK;
}

ric_status impact_tangents_end(ric_trajectory *tr, char *reason, size_t room, ric_error *error) {
  bool grazes = tr->tangents.kind == RIC_SALTATION_GRAZING;
  snprintf(reason, room, "at t = %g tangent vectors are undefined at %s obstacle %zu", tr->tangents.time,
           grazes ? "the grazing contact of" : "simultaneous impacts, one of them on", tr->tangents.obstacle);
  tr->tangents.kind = RIC_SALTATION_DIFFERENTIABLE;
  return ric_flow_carry(tr->flow, 0, NULL, NULL, error);
}

/* Onset of contacts: at the start of a run, and at the first roots of a step. */

static ric_status add_impact(ric_trajectory *tr, size_t obstacle, double restitution, ric_error *error) {
  impact *impacts = list_room(tr->impacts, tr->impact_count, &tr->impact_capacity, sizeof *impacts);
  if (!impacts)
    return ric_fail(error, RIC_ENOMEM, "no memory for more than %zu impacts at one time", tr->impact_count);
  tr->impacts = impacts;
  tr->impacts[tr->impact_count++] = (impact){.obstacle = obstacle, .restitution = restitution};
  return RIC_OK;
}

static double restitution_of(const ric_trajectory *tr, size_t obstacle) {
  return tr->system->model->restitution(tr->system, obstacle);
}

/* Whether impulses and forces of contacts couple. */
static bool contacts_couple(const ric_trajectory *tr) {
  return !tr->system->uncoupled && tr->system->model->direction;
}

static double gap_now(const ric_trajectory *tr, size_t obstacle) {
  return ric_system_gap(tr->system, obstacle, tr->flow->time, tr->flow->q);
}

static double rate_now(const ric_trajectory *tr, size_t obstacle) {
  return ric_system_gap_rate(tr->system, obstacle, tr->flow->time, tr->flow->q, tr->flow->u);
}

/* Whether a contact at zero closes: by its rate, or by its acceleration if the rate is zero. */
static ric_status is_closing(ric_trajectory *tr, size_t obstacle, bool *in, bool *fast, ric_error *error) {
  double rate = rate_now(tr, obstacle), acceleration;
  *fast = fabs(rate) > tr->rate_noise;
  *in = rate < 0;
  if (*fast)
    return RIC_OK;
  RIC_TRY(gap_acceleration(tr, obstacle, &acceleration, error));
  *in = acceleration < 0;
  return RIC_OK;
}

/* Sets a compliant contact at zero pressed or open. */
static ric_status set_compliant(ric_trajectory *tr, size_t obstacle, ric_error *error) {
  bool in, fast;
  RIC_TRY(is_closing(tr, obstacle, &in, &fast, error));
  departure how = fast ? DEPARTS_FAST : DEPARTS_SLOWLY;
  return in ? contact_presses(tr, obstacle, how, error) : contact_opens(tr, obstacle, how, error);
}

/* Onset or end of a compliant contact. */
static ric_status switch_contact(ric_trajectory *tr, size_t obstacle, ric_error *error) {
  contact_state before = flow_contact(tr->flow, obstacle);
  RIC_TRY(set_compliant(tr, obstacle, error));
  if (flow_contact(tr->flow, obstacle) == before) /* it only grazed */
    return RIC_OK;
  ric_event event = event_of(tr, before == CONTACT_PRESSED ? RIC_EVENT_PARTING : RIC_EVENT_CONTACT, obstacle);
  event.gap_rate = event.gap_rate_end = rate_now(tr, obstacle);
  trajectory_show(tr, &event);
  return RIC_OK;
}

/* Penetration depth of a slowly closing contact by its acceleration; -INFINITY if it does not turn around or closes too
 * fast. */
static ric_status depth_of(ric_trajectory *tr, size_t obstacle, double rate, double *depth, ric_error *error) {
  double acceleration, tol = tr->options.grazing_tol;
  *depth = -INFINITY;
  if (rate * rate > 1e6 * tol) /* deeper than tol for every acceleration below 5e5 */
    return RIC_OK;
  RIC_TRY(gap_acceleration(tr, obstacle, &acceleration, error));
  if (acceleration > 0)
    *depth = -rate * rate / (2 * acceleration);
  return RIC_OK;
}

/* Removes from the impulses the restitution of the series of impacts that is summed. */
static ric_status sum_series(ric_trajectory *tr, size_t hits, ric_error *error) {
  bool all = hits == 1 && !isnan(tr->impacts[0].accumulation); /* with the persistent contacts coupled to it */
  for (size_t i = 0; i < tr->impact_count; i++) {
    impact *c = &tr->impacts[i];
    double e = all ? tr->impacts[0].restitution : c->restitution;
    if (all || !isnan(c->accumulation))
      RIC_TRY(impact_stick(&tr->law, tr->flow->time, tr->flow->q, tr->flow->u, c, e, error));
  }
  return RIC_OK;
}

/* Whether the gap rate of a contact is no larger than after a fall through the noise of its gap: such a closing contact
 * counts as pressed already. */
static ric_status falls_through_noise(ric_trajectory *tr, size_t obstacle, double rate, bool *pressed,
                                      ric_error *error) {
  double acceleration, noise = tr->locator.noise;
  *pressed = false;
  if (rate * rate > 1e4 * noise) /* for every acceleration below 5e3 */
    return RIC_OK;
  RIC_TRY(gap_acceleration(tr, obstacle, &acceleration, error));
  *pressed = rate * rate <= -2 * acceleration * noise;
  return RIC_OK;
}

/* Which contacts leave their obstacles. Flights within the noise of the gap do not count: the noise would sustain them.
 */
static ric_status find_leaving(ric_trajectory *tr, ric_error *error) {
  for (size_t i = 0; i < tr->impact_count; i++) {
    impact *c = &tr->impacts[i];
    bool low = false;
    c->leaves = c->rate_end > tr->rate_noise;
    if (c->leaves && c->restitution < 1 && (c->rate < -tr->rate_noise || contacts_couple(tr)))
      RIC_TRY(falls_through_noise(tr, c->obstacle, c->rate_end, &low, error));
    c->leaves &= !low;
  }
  return RIC_OK;
}

/* After an impact: the contact leaves, sticks, or is undecided. */
static ric_status aftermath(ric_trajectory *tr, const impact *c, ric_error *error) {
  if (c->leaves)
    return contact_opens(tr, c->obstacle, DEPARTS_FAST, error);
  RIC_TRY(index_list_add(&tr->settling, c->obstacle, error));
  return isnan(c->accumulation) ? RIC_OK : contact_will_rest(tr, c->obstacle, tr->flow->time + c->accumulation, error);
}

static ric_event_kind kind_of(const ric_trajectory *tr, const impact *c, size_t hits, double depth) {
  if (!isnan(c->accumulation))
    return RIC_EVENT_CHATTER;
  if (c->coupled)
    return RIC_EVENT_COUPLED;
  if (depth >= -tr->options.grazing_tol)
    return RIC_EVENT_GRAZING;
  return hits > 1 ? RIC_EVENT_SIMULTANEOUS : RIC_EVENT_TRANSVERSAL;
}

static void show_impact(ric_trajectory *tr, const impact *c, size_t hits, double depth) {
  ric_event event = event_of(tr, kind_of(tr, c, hits, depth), c->obstacle);
  event.gap_rate = c->rate;
  event.gap_rate_end = c->rate_end;
  event.impulse = c->impulse;
  event.energy_loss = c->loss;
  event.depth = event.kind == RIC_EVENT_GRAZING ? depth : NAN;
  event.accumulation = tr->flow->time + c->accumulation;
  trajectory_show(tr, &event);
}

/* Whether its gap exceeds rounding. */
static bool is_off(const ric_trajectory *tr, size_t obstacle) {
  return fabs(gap_now(tr, obstacle)) > tr->noise / 100;
}

/* Projects closing contacts onto their obstacles; coupled ones all together: one alone would lift the others, whose
 * fall would keep them moving. */
static ric_status project_onto_obstacles(ric_trajectory *tr, ric_error *error) {
  bool couple = contacts_couple(tr), any = false;
  tr->closed.count = 0;
  for (size_t i = 0; i < tr->impact_count; i++)
    any |= is_off(tr, tr->impacts[i].obstacle);
  for (size_t i = 0; any && i < tr->impact_count; i++) {
    const impact *c = &tr->impacts[i];
    if (couple || (c->rate < -tr->rate_noise && is_off(tr, c->obstacle)))
      RIC_TRY(index_list_add(&tr->closed, c->obstacle, error));
  }
  return contacts_put_on(tr, tr->closed.items, tr->closed.count, error);
}

/* A contact of the list: an impact, or a closed contact coupled to one. */
static ric_status conclude_impact(ric_trajectory *tr, impact *c, size_t hits, double depth, ric_error *error) {
  if (hits > 0 && (c->rate < -tr->rate_noise || c->impulse > 0))
    show_impact(tr, c, hits, depth);
  if (!isnan(c->loss))
    tr->run->impact_loss += c->loss;
  return aftermath(tr, c, error);
}

/* Applies the law to tr->impacts, the first `hits` of which are new. */
static ric_status collide(ric_trajectory *tr, size_t hits, ric_error *error) {
  ric_flow *f = tr->flow;
  double depth = -INFINITY;
  if (hits == 1)
    RIC_TRY(depth_of(tr, tr->impacts[0].obstacle, rate_now(tr, tr->impacts[0].obstacle), &depth, error));
  RIC_TRY(impact_apply(&tr->law, f->time, f->q, f->u, tr->impacts, tr->impact_count, error));
  RIC_TRY(chatter_ahead(tr, hits, error));
  RIC_TRY(sum_series(tr, hits, error));
  RIC_TRY(project_onto_obstacles(tr, error));
  RIC_TRY(find_leaving(tr, error));
  for (size_t i = 0; i < tr->impact_count; i++)
    RIC_TRY(conclude_impact(tr, &tr->impacts[i], hits, i < hits ? depth : -INFINITY, error));
  return RIC_OK;
}

/* Classifies a root of an open rigid contact: an impact, a grazing contact with rate zero, or noise of an opening
 * contact. */
static ric_status classify_root(ric_trajectory *tr, size_t obstacle, ric_error *error) {
  double rate = rate_now(tr, obstacle);
  bool pressed;
  if (rate < -tr->rate_noise) {
    RIC_TRY(falls_through_noise(tr, obstacle, rate, &pressed, error));
    if (!pressed)
      return add_impact(tr, obstacle, restitution_of(tr, obstacle), error);
    impact_tangents_lose(tr, obstacle, tr->flow->time, RIC_SALTATION_GRAZING);
    return index_list_add(&tr->settling, obstacle, error);
  }
  impact_tangents_lose(tr, obstacle, tr->flow->time, RIC_SALTATION_GRAZING);
  ric_event event = event_of(tr, RIC_EVENT_GRAZING, obstacle);
  event.gap_rate = event.gap_rate_end = rate;
  event.depth = gap_now(tr, obstacle);
  trajectory_show(tr, &event);
  /* opening: its next root must lie below the current value, so that time advances */
  return rate > tr->rate_noise ? contact_opens(tr, obstacle, DEPARTS_SLOWLY, error)
                               : index_list_add(&tr->settling, obstacle, error);
}

static bool takes_part(const ric_trajectory *tr, size_t obstacle) {
  bool listed = false;
  for (size_t i = 0; i < tr->impact_count; i++)
    listed |= tr->impacts[i].obstacle == obstacle;
  return listed;
}

/* Contacts that departed from zero without a rate and are still at zero. */
static ric_status add_touching(ric_trajectory *tr, ric_error *error) {
  for (size_t i = 0; i < tr->departing.count; i++) {
    size_t obstacle = tr->departing.items[i];
    double rate = rate_now(tr, obstacle);
    bool open = tr->locator.departure[obstacle] != DEPARTED && !system_complies(tr->system, obstacle);
    bool pressed = fabs(rate) <= tr->rate_noise;
    if (open && rate < -tr->rate_noise)
      RIC_TRY(falls_through_noise(tr, obstacle, rate, &pressed, error));
    if (open && pressed && !takes_part(tr, obstacle))
      RIC_TRY(add_impact(tr, obstacle, 0, error));
  }
  return RIC_OK;
}

/* If contacts couple, all closed contacts take part, with restitution 0. */
static ric_status add_closed(ric_trajectory *tr, ric_error *error) {
  for (size_t i = 0; i < tr->settling.count; i++)
    RIC_TRY(add_impact(tr, tr->settling.items[i], 0, error));
  tr->settling.count = 0;
  for (size_t i = 0; i < tr->held.count; i++)
    if (contact_persists(tr, tr->held.items[i]))
      RIC_TRY(add_impact(tr, tr->held.items[i], 0, error));
  return add_touching(tr, error);
}

/* If they do not couple, impacts change the forces of persistent contacts. */
static ric_status add_held(ric_trajectory *tr, ric_error *error) {
  for (size_t i = 0; i < tr->held.count; i++)
    if (contact_persists(tr, tr->held.items[i]))
      RIC_TRY(index_list_add(&tr->settling, tr->held.items[i], error));
  return RIC_OK;
}

/* Impacts are collected in tr->impacts; sticking and grazing contacts in tr->settling. */
static ric_status resolve(ric_trajectory *tr, ric_error *error) {
  size_t hits = tr->impact_count;
  if (contacts_couple(tr) && hits + tr->settling.count > 0)
    RIC_TRY(add_closed(tr, error));
  else if (hits > 0)
    RIC_TRY(add_held(tr, error));
  if (tr->impact_count > 0)
    RIC_TRY(collide(tr, hits, error));
  contacts_forget_released(tr);
  RIC_TRY(contacts_settle(tr, error));
  RIC_TRY(impact_tangents_jump(tr, hits, error));
  return flow_restart(tr->flow, error);
}

ric_status contacts_onset(ric_trajectory *tr, ric_error *error) {
  impact_tangents_mark(tr);
  contacts_measure(tr);
  tr->impact_count = tr->settling.count = 0;
  for (size_t i = 0; i < tr->locator.roots.count; i++) {
    size_t obstacle = tr->locator.roots.hits[i].obstacle;
    if (system_complies(tr->system, obstacle))
      RIC_TRY(switch_contact(tr, obstacle, error));
    else if (flow_contact(tr->flow, obstacle) == CONTACT_HELD)
      RIC_TRY(contact_opens(tr, obstacle, DEPARTS_SLOWLY, error));
    else
      RIC_TRY(classify_root(tr, obstacle, error));
  }
  return resolve(tr, error);
}

static ric_status begin_one(ric_trajectory *tr, size_t obstacle, ric_error *error) {
  double gap = gap_now(tr, obstacle), rate = rate_now(tr, obstacle), noise = tr->locator.noise;
  if (system_complies(tr->system, obstacle)) {
    if (gap < -noise)
      return contact_presses(tr, obstacle, DEPARTED, error);
    return gap <= noise ? set_compliant(tr, obstacle, error) : RIC_OK;
  }
  if (gap > noise)
    return RIC_OK;
  if (rate < -tr->rate_noise)
    return add_impact(tr, obstacle, restitution_of(tr, obstacle), error);
  return rate > tr->rate_noise ? contact_opens(tr, obstacle, DEPARTS_FAST, error)
                               : index_list_add(&tr->settling, obstacle, error);
}

ric_status contacts_begin(ric_trajectory *tr, ric_error *error) {
  impact_tangents_mark(tr);
  contacts_measure(tr);
  tr->impact_count = tr->settling.count = 0;
  for (size_t j = 0; j < tr->system->obstacle_count; j++)
    if (!contact_is_passed(tr, j))
      RIC_TRY(begin_one(tr, j, error));
  RIC_TRY(resolve(tr, error));
  for (size_t i = 0; i < tr->held.count; i++)
    impact_tangents_hold(tr, tr->held.items[i]);
  for (size_t i = 0; i < tr->departing.count; i++)
    if (tr->locator.departure[tr->departing.items[i]] == DEPARTS_SLOWLY)
      impact_tangents_lose(tr, tr->departing.items[i], tr->flow->time, RIC_SALTATION_GRAZING);
  return RIC_OK;
}
