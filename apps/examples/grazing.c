/* A grazing bifurcation of a driven double pendulum with a wall: unit masses and lengths, gravity 1, angles from the
 * vertical, torque F cos(1.2 t) at the upper joint, overdamped. As F increases the lower bob, at x = sin q0 + sin q1,
 * reaches the wall at x = 0.5; the coefficients of the return map there decide whether the bifurcation is continuous.
 *
 *   cc grazing.c $(pkg-config --cflags --libs ricochet) -lm && ./a.out */
#include <math.h>
#include <ricochet/ricochet.h>
#include <stdio.h>

enum { STATE = 4, COEFFICIENTS = 6 };

static const double frequency = 1.2, damping = 5, two_pi = 6.283185307179586;

static int mass(double t, const double *q, double *M, void *user) {
  (void)t, (void)user;
  M[0] = 2;
  M[1] = M[2] = cos(q[0] - q[1]);
  M[3] = 1;
  return 0;
}

/* `user` is the amplitude of the torque. */
static int force(double t, const double *q, const double *u, double *f, void *user) {
  const double *amplitude = user, s = sin(q[0] - q[1]);
  f[0] = -s * u[1] * u[1] - 2 * sin(q[0]) - damping * u[0] + *amplitude * cos(frequency * t);
  f[1] = s * u[0] * u[0] - sin(q[1]) - damping * u[1];
  return 0;
}

static int gap(double t, const double *q, size_t obstacle, double *h, void *user) {
  (void)t, (void)obstacle, (void)user;
  *h = 0.5 - sin(q[0]) - sin(q[1]);
  return 0;
}

static ric_status set_amplitude(ric_system *system, const double *p, double *period, void *user, ric_error *error) {
  (void)system, (void)error;
  *(double *)user = p[0];
  *period = two_pi / frequency;
  return RIC_OK;
}

/* Objects to be destroyed at the end. */
typedef struct work {
  ric_system *system;
  ric_family *family;
  ric_grazing grazing;
  ric_grazing_map map;
  ric_grazing_criterion criterion;
  double c[COEFFICIENTS];
} work;

static ric_status find(work *w, double *amplitude, ric_error *error) {
  static const double restitution = 0.8, rest[STATE] = {0};
  const ric_mechanical pendulum = {.coordinates = 2,
                                   .speeds = 2,
                                   .obstacles = 1,
                                   .restitution = &restitution,
                                   .mass = mass,
                                   .force = force,
                                   .gap = gap,
                                   .user = amplitude};
  ric_family_options options = ric_family_options_default();
  double z[STATE];
  options.curve.newton_tol = 1e-10;
  options.curve.p_high = 20;
  options.curve.step_most = 1;
  RIC_TRY(ric_system_create_mechanical(&pendulum, &w->system, error));
  const ric_family_problem problem = {.system = w->system,
                                      .motion = {.kind = RIC_MOTION_FORCED, .flow = ric_flow_options_default()},
                                      .set = set_amplitude,
                                      .user = amplitude,
                                      .parameters = 1};
  RIC_TRY(ric_family_create(&problem, &options, &w->family, error));
  RIC_TRY(ric_family_start(w->family, 0.1, rest, rest + 2, NULL, two_pi / frequency, z, NULL, error));
  RIC_TRY(ric_grazing_init(&w->grazing, ric_family_shooting(w->family), error));
  RIC_TRY(ric_grazing_find(w->family, z, 0.1, NULL, &w->grazing, error));
  RIC_TRY(ric_grazing_map_init(&w->map, STATE, error));
  RIC_TRY(ric_grazing_section(w->family, &w->grazing, NULL, &w->map, NULL, error));
  return ric_grazing_criterion_find(&w->map, NULL, &w->criterion, w->c, COEFFICIENTS, NULL, error);
}

static void print(const work *w) {
  const ric_grazing *g = &w->grazing;
  const ric_grazing_criterion *k = &w->criterion;
  printf("grazes at F = %.9f, phase %.6f, A_g = %.6f\n", g->parameter, g->phase, g->local.acceleration);
  printf("%s, %s: dominant multiplier %.6f, alpha %.6f\n", ric_grazing_verdict_name(k->verdict),
         ric_grazing_regime_name(k->regime), k->dominant.re, k->alpha);
  for (int i = 0; i < COEFFICIENTS; i++)
    printf("c_%d = %.6g\n", i, w->c[i]);
}

int main(void) {
  double amplitude = 0;
  work w = {.system = NULL};
  ric_error error = {0};
  ric_status status = find(&w, &amplitude, &error);
  if (status == RIC_OK)
    print(&w);
  else
    fprintf(stderr, "%s\n", error.message);
  ric_grazing_map_clear(&w.map);
  ric_grazing_clear(&w.grazing);
  ric_family_destroy(&w.family);
  ric_system_destroy(&w.system);
  return status != RIC_OK;
}
