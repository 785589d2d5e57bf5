#include "convergence.h"

#include <math.h>

/* Tangent vectors of n numbers are n x n doubles: those of the trajectory and of the exponents' work, each with a copy,
 * and what the flow keeps. CVODES keeps all that its highest order, 12, needs of them. Measured up to 600 numbers. */
enum { COPIES = 5, CVODES_COPIES = 28, STATE_BYTES = 4096 /* the series of a step, per number of the state */ };

static const double spacing = 1.05; /* times from one record to the next: even on the logarithmic axis it is drawn on */

double convergence_bytes(double exponents, bool by_cvodes) {
  const double most_records = log(1e15) / log(spacing); /* durations over intervals */
  return 8 * exponents * exponents * (by_cvodes ? CVODES_COPIES : COPIES) + STATE_BYTES * exponents +
         2 * 8 * (1 + exponents) * most_records; /* twice, as records grow by doubling */
}

static int keep(convergence *c, double time, const double *exponents) {
  unsigned char *record = records_add(c->to);
  if (!record) {
    c->no_memory = 1;
    return 1;
  }
  row_store(c->layout, record, &(lyapunov_record){.time = time, .history = exponents});
  c->kept = time;
  return 0;
}

static int see(double time, const double *exponents, size_t count, void *user) {
  convergence *c = user;
  (void)count;
  return time >= spacing * c->kept ? keep(c, time, exponents) : 0;
}

ric_status convergence_run(convergence *c, ric_trajectory *trajectory, double end, double interval,
                           const ric_observer *observer, double *exponents, ric_run *did, ric_error *error) {
  ric_lyapunov_options options = ric_lyapunov_options_default();
  ric_lyapunov found;
  options.interval = interval;
  options.history = see;
  options.observer = observer;
  options.user = c;
  ric_status status = ric_lyapunov_run(trajectory, end, &options, exponents, &found, error);
  *did = found.run;
  if (status == RIC_OK && found.time > c->kept)
    keep(c, found.time, exponents);
  return status;
}
