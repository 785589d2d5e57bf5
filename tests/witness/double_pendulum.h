/* A double pendulum for tests: unit masses and lengths, gravity 1, angles from the vertical. */
#ifndef RICOCHET_TESTS_DOUBLE_PENDULUM_H
#define RICOCHET_TESTS_DOUBLE_PENDULUM_H

/** Mass matrix and force as callbacks of ric_mechanical; `user` is not read. */
int double_pendulum_mass(double t, const double *q, double *M, void *user);
int double_pendulum_force(double t, const double *q, const double *u, double *f, void *user);

/** Solves M(q) a = f by Cramer's rule. */
void double_pendulum_solve(const double *q, const double *f, double *a);

/** Speeds after the lower bob hit a vertical wall at this gap rate: [FN97] (2.9) with the gradient of
 *  -sin(q_0) - sin(q_1), by Cramer's rule. */
void double_pendulum_hit(const double *q, double restitution, double gap_rate, double *u);

#endif
