#include "example1.h"

double example1_period(void) {
  return 1.5 * 3.14159265358979323846;
}

double example1_gamma(size_t row) {
  return 0.187 * (double)row / (EXAMPLE1_TABLE - 1);
}

scenario example1_at(double gamma) {
  return scenario_single(EXAMPLE1_PARTICLES, RIC_ENDS_PERIODIC, gamma, example1_period(), EXAMPLE1_IMPACT);
}
