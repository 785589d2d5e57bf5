// A C++ program outside the project: a ball dropped from 1/2 under gravity 1 on an elastic floor, which it hits at 1, 3, 5, ...
#include <cstdio>
#include <ricochet/ricochet.h>

extern "C" {
static int gravity(double, const double *, const double *, double *force, void *) {
  force[0] = -1;
  return 0;
}

static int height(double, const double *q, size_t, double *gap, void *) {
  *gap = q[0];
  return 0;
}
}

int main() {
  const double elastic = 1, q = 0.5, v = 0;
  ric_mechanical ball{};
  ball.coordinates = ball.speeds = ball.obstacles = 1;
  ball.restitution = &elastic;
  ball.force = gravity;
  ball.gap = height;
  ric_error error{};
  ric_run run{};
  ric_system *system = nullptr;
  ric_trajectory *trajectory = nullptr;
  const bool done = ric_system_create_mechanical(&ball, &system, &error) == RIC_OK &&
                    ric_trajectory_create(system, nullptr, &trajectory, &error) == RIC_OK &&
                    ric_trajectory_start(trajectory, 0, &q, &v, &error) == RIC_OK &&
                    ric_trajectory_run(trajectory, 20, nullptr, &run, &error) == RIC_OK;
  if (done)
    std::printf("%llu impacts, height %.6f\n", run.events[RIC_EVENT_TRANSVERSAL], *ric_trajectory_q(trajectory));
  else
    std::fprintf(stderr, "%s\n", error.message);
  ric_trajectory_destroy(&trajectory);
  ric_system_destroy(&system);
  return !done;
}
