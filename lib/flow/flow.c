#include "ricochet/flow.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "flow_method.h"
#include "numeric/required.h"

ric_flow_options ric_flow_options_default(void) {
  return (ric_flow_options){.longest_step = INFINITY};
}

static ric_status check_options(const ric_flow_options *o, double least_tolerance, ric_error *error) {
  if (!(o->tolerance == 0 || (o->tolerance >= least_tolerance && o->tolerance <= 1e-2)))
    return ric_fail(error, RIC_EINVAL, "tolerance = %g, expected %g to 1e-2 (or 0 for the default)", o->tolerance,
                    least_tolerance);
  if (!(o->order == 0 || (o->order >= 4 && o->order <= 30)))
    return ric_fail(error, RIC_EINVAL, "order = %d, expected 4 to 30 (or 0: from the tolerance)", o->order);
  if (!(o->step >= 0 && o->step < INFINITY))
    return ric_fail(error, RIC_EINVAL, "step = %g, expected a finite number > 0 (or 0: from the tolerance)", o->step);
  if (!(o->longest_step > 0))
    return ric_fail(error, RIC_EINVAL, "longest_step = %g, expected > 0", o->longest_step);
  return RIC_OK;
}

ric_status ric_flow_create(const ric_system *system, const ric_flow_options *options, ric_flow **flow,
                           ric_error *error) {
  REQUIRE(error, {"system", system}, {"flow", flow});
  ric_flow_options o = options ? *options : ric_flow_options_default();
  *flow = NULL;
  if (o.method != RIC_FLOW_AUTO && o.method != RIC_FLOW_TAYLOR && o.method != RIC_FLOW_CVODES)
    return ric_fail(error, RIC_EINVAL, "flow method = %d, expected auto, taylor or cvodes", (int)o.method);
  if (o.method == RIC_FLOW_TAYLOR && !system->taylor)
    return ric_fail(error, RIC_EINVAL, "flow method = taylor, expected cvodes: a user's system has no Taylor flow");
  if (o.method == RIC_FLOW_AUTO)
    o.method = system->taylor ? RIC_FLOW_TAYLOR : RIC_FLOW_CVODES;
  RIC_TRY(check_options(&o, o.method == RIC_FLOW_TAYLOR ? 1e-17 : 1e-14, error));
  if (o.tolerance == 0)
    o.tolerance = o.method == RIC_FLOW_TAYLOR ? 1e-16 : 1e-12;
  if (o.method == RIC_FLOW_CVODES)
    return cvodes_flow_create(system, &o, flow, error);
  return system->taylor == SYSTEM_LATTICE ? lattice_flow_create(system, &o, flow, error)
                                          : mck_flow_create(system, &o, flow, error);
}

ric_status flow_init(ric_flow *flow, const flow_method *method, const ric_system *system,
                     const ric_flow_options *options, ric_error *error) {
  size_t n = system->coordinates, m = system->speeds, count = system->obstacle_count;
  *flow =
      (ric_flow){.method = method, .system = system, .options = *options, .pieces = 1, .revision = system->revision};
  flow->q = calloc(n, sizeof *flow->q);
  flow->u = calloc(m ? m : 1, sizeof *flow->u);
  flow->contact = calloc(count ? count : 1, 1);
  if (flow->q && flow->u && flow->contact)
    return RIC_OK;
  flow_clear(flow);
  return ric_fail(error, RIC_ENOMEM, "no memory for a flow of %zu coordinates", n);
}

void flow_clear(ric_flow *flow) {
  free(flow->q);
  free(flow->u);
  free(flow->contact);
  free(flow->tangent.q);
  flow->q = flow->u = NULL;
  flow->contact = NULL;
  flow->tangent = (tangents){0};
}

void ric_flow_destroy(ric_flow **flow) {
  if (!flow || !*flow)
    return;
  (*flow)->method->destroy(*flow);
  *flow = NULL;
}

static ric_status check_finite(const char *name, const double *x, size_t count, ric_error *error) {
  for (size_t i = 0; i < count; i++)
    if (!isfinite(x[i]))
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %g, expected a finite number", name, i, x[i]);
  return RIC_OK;
}

static ric_status begin_flow(ric_flow *flow, ric_error *error) {
  unsigned long long revision = flow->system->revision;
  if (flow->method->begin)
    RIC_TRY(flow->method->begin(flow, flow->revision != revision, error));
  flow->revision = revision;
  return RIC_OK;
}

ric_status flow_check_revision(const ric_flow *flow, ric_error *error) {
  if (flow->revision == flow->system->revision)
    return RIC_OK;
  return ric_fail(error, RIC_EINVAL, "the numbers of the system have changed during a motion, expected a new start");
}

ric_status ric_flow_start(ric_flow *flow, double t, const double *q, const double *u, ric_error *error) {
  REQUIRE(error, {"flow", flow}, {"q", q});
  size_t n = flow->system->coordinates, m = flow->system->speeds;
  REQUIRE(error, {"u", unless_empty(m, u)});
  if (!isfinite(t))
    return ric_fail(error, RIC_EINVAL, "t = %g, expected a finite time", t);
  RIC_TRY(check_finite("q", q, n, error));
  RIC_TRY(check_finite("u", u, m, error));
  RIC_TRY(begin_flow(flow, error));
  flow->time = flow->end = t;
  flow->length = 0;
  flow->tangent.columns = 0;
  memmove(flow->q, q, n * sizeof *q); /* a caller may start from the flow's own state */
  if (m)
    memmove(flow->u, u, m * sizeof *u);
  return flow_restart(flow, error);
}

/* Makes room for tangents in one block, which is kept if there are fewer. */
static ric_status reserve_tangents(ric_flow *flow, size_t columns, ric_error *error) {
  size_t n = flow->system->coordinates, m = flow->system->speeds;
  tangents *d = &flow->tangent;
  if (columns > flow->tangent_room) {
    free(d->q);
    *d = (tangents){0};
    flow->tangent_room = 0;
    d->q = columns <= SIZE_MAX / sizeof *d->q / (n + m) ? malloc((n + m) * columns * sizeof *d->q) : NULL;
    if (!d->q)
      return ric_fail(error, RIC_ENOMEM, "no memory for %zu tangent vectors of %zu numbers", columns, n + m);
    flow->tangent_room = columns;
  }
  if (columns > 0)
    d->u = d->q + n * columns;
  d->columns = columns;
  return RIC_OK;
}

ric_status ric_flow_carry(ric_flow *flow, size_t columns, const double *dq, const double *du, ric_error *error) {
  REQUIRE(error, {"flow", flow}, {"dq", unless_empty(columns, dq)});
  size_t n = flow->system->coordinates, m = flow->system->speeds;
  REQUIRE(error, {"du", unless_empty(m * columns, du)});
  RIC_TRY(flow_check_revision(flow, error));
  RIC_TRY(check_finite("dq", dq, n * columns, error));
  RIC_TRY(check_finite("du", du, m * columns, error));
  RIC_TRY(reserve_tangents(flow, columns, error));
  if (columns > 0)
    memcpy(flow->tangent.q, dq, n * columns * sizeof *dq);
  if (columns > 0 && m > 0)
    memcpy(flow->tangent.u, du, m * columns * sizeof *du);
  ric_status status = flow->method->carry(flow, error);
  if (status != RIC_OK) {
    flow->tangent.columns = 0; /* there are none */
    return status;
  }
  return flow_restart(flow, error);
}

size_t ric_flow_columns(const ric_flow *flow) {
  return flow->tangent.columns;
}

const double *ric_flow_dq(const ric_flow *flow) {
  return flow->tangent.q;
}

const double *ric_flow_du(const ric_flow *flow) {
  return flow->tangent.u;
}

ric_status flow_restart(ric_flow *flow, ric_error *error) {
  flow->counts.starts++;
  return flow->method->start(flow, error);
}

ric_status ric_flow_step(ric_flow *flow, double stop, ric_error *error) {
  REQUIRE(error, {"flow", flow});
  flow->length = 0;
  RIC_TRY(flow_check_revision(flow, error));
  if (!isfinite(stop))
    return ric_fail(error, RIC_EINVAL, "stop = %g, expected a finite time", stop);
  if (stop == flow->time)
    return ric_fail(error, RIC_EINVAL, "stop = %.17g, expected another time than that of the flow", stop);
  flow->counts.steps++;
  return flow->method->step(flow, stop, error);
}

size_t ric_flow_pieces(const ric_flow *flow) {
  return flow->pieces;
}

ric_segment ric_flow_piece(ric_flow *flow, size_t index) {
  return flow->method->piece(flow, index);
}

void ric_flow_accept(ric_flow *flow, double x) {
  if (flow->tangent.columns > 0 && x > 0)
    flow->method->transport(flow, x);
  flow->method->accept(flow, x);
  flow->time = x == 1 ? flow->end : flow->time + x * flow->length;
  flow->length = 0;
}

double ric_flow_time(const ric_flow *flow) {
  return flow->time;
}

double ric_flow_step_end(const ric_flow *flow) {
  return flow->end;
}

const double *ric_flow_q(const ric_flow *flow) {
  return flow->q;
}

const double *ric_flow_u(const ric_flow *flow) {
  return flow->u;
}

ric_flow_counts ric_flow_counted(const ric_flow *flow) {
  return flow->counts;
}

void flow_set_contact(ric_flow *flow, size_t obstacle, contact_state state) {
  flow->contact[obstacle] = (unsigned char)state;
}

contact_state flow_contact(const ric_flow *flow, size_t obstacle) {
  return (contact_state)flow->contact[obstacle];
}
