/* Chatter (Zeno): impacts that accumulate in a finite time, after which the contact sticks. The total duration of the
 * series is estimated from the acceleration of the gap and its rate of change; a series that is short enough is summed
 * instead of being followed. */
#include <math.h>

#include "ricochet/elementary.h"
#include "trajectory.h"

/* Rates of the state after a short time along its current rates. */
static ric_status find_rates_after(ric_trajectory *tr, double dt, ric_error *error) {
  const ric_flow *f = tr->flow;
  size_t n = tr->system->coordinates, m = tr->system->speeds;
  double *q = tr->shifted, *u = tr->shifted + n;
  RIC_TRY(contact_rates(tr, f->time, f->q, f->u, error));
  for (size_t i = 0; i < n; i++)
    q[i] = f->q[i] + dt * tr->rates[i];
  for (size_t i = 0; i < m; i++)
    u[i] = f->u[i] + dt * tr->rates[n + i];
  return contact_rates(tr, f->time + dt, q, u, error);
}

/* Adds scale times the acceleration of the gap to the `accumulation` of every remaining candidate. */
static ric_status add_jerks(ric_trajectory *tr, double dt, double scale, ric_error *error) {
  size_t n = tr->system->coordinates;
  RIC_TRY(find_rates_after(tr, dt, error));
  for (size_t i = 0; i < tr->impact_count; i++) {
    double acceleration;
    if (isnan(tr->impacts[i].accumulation))
      continue;
    RIC_TRY(contact_acceleration(tr, tr->flow->time + dt, tr->shifted, tr->shifted + n, tr->impacts[i].obstacle,
                                 &acceleration, error));
    tr->impacts[i].accumulation += scale * acceleration;
  }
  return RIC_OK;
}

/* One impact coupled to persistent contacts, or impacts that do not couple. */
static bool may_chatter(const ric_trajectory *tr, const impact *c, size_t hits) {
  bool alone = hits == 1 || (!c->coupled && tr->system->model->direction);
  return alone && c->rate < -tr->rate_noise && c->rate_end > tr->rate_noise && tr->options.chatter_tol > 0 &&
         c->restitution < 1;
}

/* Duration of a series at the current acceleration. */
static double first_duration(const impact *c, double acceleration) {
  double e = c->restitution;
  return acceleration < 0 ? 2 * c->rate_end / (-acceleration * (1 - e)) : INFINITY;
}

/* Duration below which a series is summed. An error of the flow's tolerance in the gap causes an error tolerance / w of
 * the time of impact, where w grows with the duration; the error of summation is its third power. Both are equal at the
 * fourth root of the tolerance: following a series further would lose digits. */
static double chatter_limit(const ric_trajectory *tr) {
  double size = tr->locator.noise / tr->noise;
  return fmax(tr->options.chatter_tol, ric_pow(tr->flow->options.tolerance * size, 0.25));
}

/* Whether a bounce loses no more height than errors of the flow can restore: these would sustain the series for ever.
 */
static bool is_sustained_by_errors(const ric_trajectory *tr, const impact *c, double acceleration) {
  double e = c->restitution, size = tr->locator.noise / tr->noise;
  double error = 10 * tr->flow->options.tolerance * size;
  return acceleration < 0 && (1 - e * e) * c->rate_end * c->rate_end <= -2 * acceleration * error;
}

/* The total duration of flights of a gap with acceleration -A + J t, initial rate w and restitution e is, to the second
 * order, 2 w / (A (1 - e)) (1 + (2/3) (J / A^2) w / (1 - e)). */
static double estimate_series(const ric_trajectory *tr, const impact *c, double acceleration, double jerk) {
  double e = c->restitution, duration = first_duration(c, acceleration);
  double limit = is_sustained_by_errors(tr, c, acceleration) ? 1 : chatter_limit(tr);
  if (!(duration * fmax(1, fabs(jerk / acceleration)) <= limit))
    return NAN;
  return duration * (1 + 2 * jerk * c->rate_end / (3 * acceleration * acceleration * (1 - e)));
}

/* Contacts whose series is short at the current acceleration; their `accumulation` is set to 0 before the jerk is
 * added. */
static ric_status find_candidates(ric_trajectory *tr, size_t hits, bool *any, ric_error *error) {
  const ric_flow *f = tr->flow;
  bool asked = false;
  *any = false;
  for (size_t i = 0; i < tr->impact_count; i++) {
    impact *c = &tr->impacts[i];
    double acceleration;
    c->accumulation = NAN;
    if (i >= hits || !may_chatter(tr, c, hits))
      continue;
    if (!asked)
      RIC_TRY(contact_rates(tr, f->time, f->q, f->u, error));
    asked = true;
    RIC_TRY(contact_acceleration(tr, f->time, f->q, f->u, c->obstacle, &acceleration, error));
    if (first_duration(c, acceleration) <= chatter_limit(tr) || is_sustained_by_errors(tr, c, acceleration))
      c->accumulation = 0;
    *any |= !isnan(c->accumulation);
  }
  return RIC_OK;
}

/* Held contacts lifted by the impulse have no force afterwards. */
static void open_lifted(ric_trajectory *tr, size_t hits) {
  for (size_t i = hits; i < tr->impact_count; i++)
    if (tr->impacts[i].rate_end > tr->rate_noise)
      flow_set_contact(tr->flow, tr->impacts[i].obstacle, CONTACT_OPEN);
}

ric_status chatter_ahead(ric_trajectory *tr, size_t hits, ric_error *error) {
  const ric_flow *f = tr->flow;
  double dt = 1e-5;
  bool any;
  open_lifted(tr, hits);
  RIC_TRY(find_candidates(tr, hits, &any, error));
  if (!any)
    return RIC_OK;
  RIC_TRY(add_jerks(tr, dt, 1 / (2 * dt), error));
  RIC_TRY(add_jerks(tr, -dt, -1 / (2 * dt), error));
  RIC_TRY(contact_rates(tr, f->time, f->q, f->u, error));
  for (size_t i = 0; i < tr->impact_count; i++) {
    impact *c = &tr->impacts[i];
    double acceleration;
    if (isnan(c->accumulation))
      continue;
    RIC_TRY(contact_acceleration(tr, f->time, f->q, f->u, c->obstacle, &acceleration, error));
    c->accumulation = estimate_series(tr, c, acceleration, c->accumulation);
  }
  return RIC_OK;
}
