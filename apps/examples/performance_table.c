/* The performance table of [JAP]: 15 couplings from 0 to 0.187, the orbit of 30 particles with one impact, found by
 * shooting from the previous orbit; under the impact law and under Hertz's law with k = 100, by two flows. */
#include <ricochet/ricochet.h>

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { N = 30, COUPLINGS = 15, HIT = 15 };

static const double period = 4.71238898038469; /* 3 pi / 2 */
static const double last_coupling = 0.187;

typedef struct counted {
  unsigned long long steps, evaluations;
  int newton;
  double seconds, energy; /* energy of the last orbit */
} counted;

static int fail(const ric_error *error) {
  fprintf(stderr, "performance_table: %s\n", error->message);
  return 1;
}

/* Solves for all couplings. Without coupling the orbit is that of a single oscillator; under Hertz's law its
 * penetration follows from its energy. */
static ric_status solve_all(ric_system *system, ric_lattice *lattice, ric_shooting *shooting, bool hertz, counted *c,
                            ric_error *error) {
  double q[N] = {0}, u[N] = {0}, z[N], speed = fabs(tan(period / 2));
  q[HIT] = hertz ? -1 - pow(5 * speed * speed / 400, 0.4) : -1;
  u[HIT] = hertz ? 0 : speed / 2; /* any guess suffices under the impact law */
  RIC_TRY(ric_shooting_guess(shooting, q, u, NULL, period, z, error));
  for (int k = 0; k < COUPLINGS; k++) {
    int iterations;
    lattice->link.linear = last_coupling * k / (COUPLINGS - 1);
    RIC_TRY(ric_system_set_lattice(system, lattice, error));
    RIC_TRY(ric_shooting_solve(shooting, z, period, 1e-10, &iterations, error));
    c->newton += iterations;
  }
  for (int i = 0; i < N; i++) {
    q[i] = i == HIT && !hertz ? -1 : z[i];
    u[i] = i == HIT && !hertz ? z[i] : 0;
  }
  c->energy = ric_system_energy(system, 0, q, u);
  return RIC_OK;
}

static ric_status measure(ric_flow_method method, bool hertz, counted *c, ric_error *error) {
  ric_lattice lattice = ric_lattice_default(N, RIC_ENDS_PERIODIC);
  ric_obstacle floors[N];
  size_t hit = HIT;
  ric_system *system = NULL;
  ric_shooting *shooting = NULL;
  ric_shooting_problem problem = {.kind = RIC_MOTION_EVEN, .flow = ric_flow_options_default()};
  problem.flow.method = method;
  problem.at_start = &hit;
  problem.start_count = hertz ? 0 : 1;
  for (size_t i = 0; i < N; i++) {
    floors[i] = ric_obstacle_floor(i, -1);
    floors[i].stiffness = hertz ? 100 : INFINITY;
  }
  *c = (counted){0};
  RIC_TRY(ric_system_create_lattice(&lattice, floors, N, &system, error));
  ric_status status = ric_shooting_create(system, &problem, &shooting, error);
  clock_t began = clock();
  if (status == RIC_OK)
    status = solve_all(system, &lattice, shooting, hertz, c, error);
  c->seconds = (double)(clock() - began) / CLOCKS_PER_SEC;
  if (status == RIC_OK) {
    ric_flow_counts flow = ric_shooting_counted(shooting);
    c->steps = flow.steps;
    c->evaluations = flow.force_evaluations;
  }
  ric_shooting_destroy(&shooting);
  ric_system_destroy(&system);
  return status;
}

int main(void) {
  static const struct {
    const char *name;
    ric_flow_method method;
    bool hertz;
  } rows[] = {{"impact law, Taylor series", RIC_FLOW_TAYLOR, false},
              {"impact law, CVODES", RIC_FLOW_CVODES, false},
              {"Hertz k = 100, Taylor series", RIC_FLOW_TAYLOR, true},
              {"Hertz k = 100, CVODES", RIC_FLOW_CVODES, true}};
  ric_error error;
  printf("%-30s %10s %14s %8s %10s %16s\n", "", "steps", "evaluations", "Newton", "CPU s", "last energy");
  printf("%-30s %10d %14d %8d %10.1f\n", "[JAP] impact law, LSODAR", 46194, 83435, 15, 2.5);
  printf("%-30s %10d %14d %8d %10.1f\n", "[JAP] Hertz k = 100, LSODAR", 1788158, 10915173, 53, 401.4);
  for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
    counted c;
    if (measure(rows[k].method, rows[k].hertz, &c, &error) != RIC_OK)
      return fail(&error);
    printf("%-30s %10llu %14llu %8d %10.4f %16.12f\n", rows[k].name, c.steps, c.evaluations, c.newton, c.seconds,
           c.energy);
  }
  puts("\nEvaluations of [JAP] include those of a Jacobian by finite differences, one motion per unknown for each step "
       "of\n"
       "Newton's method; here tangent vectors go along with the motion, and are not counted. A Taylor step is one "
       "evaluation\n"
       "of the series, some 24 coefficients. The first coupling starts from a guess: its steps of Newton's method are "
       "counted.");
  return 0;
}
