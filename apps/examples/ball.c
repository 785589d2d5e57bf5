/* A ball on a shaken table: gravity 1, restitution 0.8, table at 0.12 sin(3 t). Its bounces accumulate (chatter), it
 * sticks to the table, and is released when the table accelerates downwards faster than gravity.
 *
 *   cc ball.c $(pkg-config --cflags --libs ricochet) -lm && ./a.out */
#include <math.h>
#include <ricochet/ricochet.h>
#include <stdio.h>

static const double amplitude = 0.12, frequency = 3;

static int gravity(double t, const double *q, const double *u, double *force, void *user) {
  (void)t, (void)q, (void)u, (void)user;
  force[0] = -1;
  return 0;
}

/* Height over the table. */
static int height(double t, const double *q, size_t obstacle, double *gap, void *user) {
  (void)obstacle, (void)user;
  *gap = q[0] - amplitude * sin(frequency * t);
  return 0;
}

static int height_gradient(double t, const double *q, size_t obstacle, double *gradient, double *in_time, void *user) {
  (void)q, (void)obstacle, (void)user;
  gradient[0] = 1;
  *in_time = -amplitude * frequency * cos(frequency * t);
  return 0;
}

static int print_event(const ric_event *event, void *user) {
  (void)user;
  if (event->kind == RIC_EVENT_CHATTER)
    printf("impacts accumulate at t = %.10f\n", event->accumulation);
  if (event->kind == RIC_EVENT_REST || event->kind == RIC_EVENT_RELEASE)
    printf("%-8s             at t = %.10f\n", ric_event_name(event->kind), event->time);
  return 0;
}

int main(void) {
  ric_mechanical ball = {.coordinates = 1,
                         .speeds = 1,
                         .obstacles = 1,
                         .restitution = (double[]){0.8},
                         .force = gravity,
                         .gap = height,
                         .gap_gradient = height_gradient};
  ric_observer observer = {.event = print_event};
  ric_system *system = NULL;
  ric_trajectory *trajectory = NULL;
  ric_error error = {0};
  ric_run run = {0};
  int done = ric_system_create_mechanical(&ball, &system, &error) == RIC_OK &&
             ric_trajectory_create(system, NULL, &trajectory, &error) == RIC_OK &&
             ric_trajectory_start(trajectory, 0, (double[]){0.5}, (double[]){0}, &error) == RIC_OK &&
             ric_trajectory_run(trajectory, 20, &observer, &run, &error) == RIC_OK;
  if (done)
    printf("%llu impacts until t = %g, height %.10f\n", run.events[RIC_EVENT_TRANSVERSAL], run.time,
           ric_trajectory_q(trajectory)[0]);
  else
    fprintf(stderr, "%s\n", error.message);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
  return !done;
}
