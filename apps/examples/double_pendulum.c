/* A double pendulum that swings against a wall, in generalised coordinates: unit masses and lengths, gravity 1, angles
 * from the vertical; the wall stands at x = 0.6 and the lower bob, at x = sin q0 + sin q1, may not pass it. The mass
 * matrix depends on the position and the gap is not linear, so an impact on the lower bob changes both speeds.
 *
 *   cc double_pendulum.c $(pkg-config --cflags --libs ricochet) -lm && ./a.out */
#include <math.h>
#include <ricochet/ricochet.h>
#include <stdio.h>

static int mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)user;
  M[0] = 2;
  M[1] = M[2] = cos(q[0] - q[1]);
  M[3] = 1;
  return 0;
}

static int force(double t, const double *q, const double *u, double *f, void *user) {
  (void)t, (void)user;
  double s = sin(q[0] - q[1]);
  f[0] = -s * u[1] * u[1] - 2 * sin(q[0]);
  f[1] = s * u[0] * u[0] - sin(q[1]);
  return 0;
}

static int gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = 0.6 - sin(q[0]) - sin(q[1]);
  return 0;
}

static int gap_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)t, (void)obstacle, (void)user;
  gradient[0] = -cos(q[0]);
  gradient[1] = -cos(q[1]);
  *in_time = 0;
  return 0;
}

static int energy(double t, const double *q, const double *u, double *e, void *user) {
  (void)t, (void)user;
  *e = u[0] * u[0] + u[1] * u[1] / 2 + cos(q[0] - q[1]) * u[0] * u[1] - 2 * cos(q[0]) - cos(q[1]);
  return 0;
}

static int print_event(const ric_event *event, void *user) {
  (void)user;
  return printf("%-12s t = %.10f  gap rate %9.6f  impulse %.6f\n", ric_event_name(event->kind), event->time,
                event->gap_rate, event->impulse) < 0;
}

int main(void) {
  ric_mechanical pendulum = {.coordinates = 2,
                             .speeds = 2,
                             .obstacles = 1,
                             .mass = mass,
                             .force = force,
                             .gap = gap,
                             .gap_gradient = gap_gradient,
                             .energy = energy};
  ric_observer observer = {.event = print_event};
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  ric_error error = {0};
  ric_run run = {0};
  int done = ric_system_create_mechanical(&pendulum, &system, &error) == RIC_OK &&
             ric_trajectory_create(system, NULL, &trajectory, &error) == RIC_OK &&
             ric_trajectory_start(trajectory, 0, (double[]){-0.9, -0.4}, (double[]){0, 0}, &error) == RIC_OK &&
             ric_trajectory_run(trajectory, 20, &observer, &run, &error) == RIC_OK;
  if (done)
    printf("%s at t = %g, energy changed by %.1e\n", ric_run_outcome_name(run.outcome), run.time,
           run.energy_end - run.energy_start);
  else
    fprintf(stderr, "%s\n", error.message);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
  return !done;
}
