#include "linear_part.h"

#include <math.h>
#include <string.h>

#include "lattice_system.h"
#include "mck_system.h"

/* Entries of K that differ by less, relative to the largest, differ by rounding. */
static const double symmetry_tol = 1e-12;

static ric_status refuse_user_system(const ric_system *system, ric_error *error) {
  if (system->taylor == SYSTEM_USER)
    return ric_fail(error, RIC_EINVAL, "a user system, expected a lattice or an M-C-K system");
  return RIC_OK;
}

/* A link without one of its ends joins the other to a wall. */
static void add_link(double *K, size_t n, double stiffness, size_t left, size_t right) {
  if (left < n)
    K[left * n + left] += stiffness;
  if (right < n)
    K[right * n + right] += stiffness;
  if (left < n && right < n) {
    K[left * n + right] -= stiffness;
    K[right * n + left] -= stiffness;
  }
}

static void assemble_lattice(const ric_lattice *lattice, double *K) {
  size_t n = lattice->particles;
  bool ring = lattice->ends == RIC_ENDS_PERIODIC && n >= 3;
  for (size_t i = 0; i < n; i++)
    K[i * n + i] += ric_lattice_on_site(lattice, i).linear;
  for (size_t i = 0; i < (ring ? n : n + 1); i++)
    add_link(K, n, ric_lattice_link(lattice, i).linear, i > 0 ? i - 1 : ring ? n - 1 : n, i);
}

/* Dense rows stand in panels (mck_rows.h); entries of sparse ones may be given in parts. */
static void read_mck(const mck_system *s, double *K) {
  size_t n = s->base.coordinates;
  for (size_t i = 0; i < n; i++) {
    const mck_rows *rows = &s->springs;
    if (!rows->values)
      return;
    if (rows->row_start)
      for (size_t k = rows->row_start[i]; k < rows->row_start[i + 1]; k++)
        K[i * n + rows->column[k]] += rows->values[k];
    for (size_t j = 0; !rows->row_start && j < n; j++)
      K[i * n + j] = rows->values[(i / MCK_PANEL * n + j) * MCK_PANEL + i % MCK_PANEL];
  }
}

static ric_status make_symmetric(double *K, size_t n, ric_error *error) {
  double most = 0;
  for (size_t e = 0; e < n * n; e++)
    most = fmax(most, fabs(K[e]));
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < i; j++) {
      double below = K[i * n + j], above = K[j * n + i];
      if (!(fabs(below - above) <= symmetry_tol * most))
        return ric_fail(error, RIC_EINVAL, "stiffness[%zu][%zu] = %g and stiffness[%zu][%zu] = %g, expected equal ones",
                        i, j, below, j, i, above);
      K[i * n + j] = K[j * n + i] = below / 2 + above / 2;
    }
  return RIC_OK;
}

ric_status linear_part_stiffness(const ric_system *system, double *stiffness, ric_error *error) {
  size_t n = system->coordinates;
  RIC_TRY(refuse_user_system(system, error));
  memset(stiffness, 0, n * n * sizeof *stiffness);
  if (system->taylor == SYSTEM_LATTICE)
    assemble_lattice(lattice_system_lattice(system), stiffness);
  else
    read_mck(mck_of(system), stiffness);
  return make_symmetric(stiffness, n, error);
}

void linear_part_mass(const ric_system *system, double *mass) {
  size_t n = system->coordinates;
  if (!system->uncoupled)
    memcpy(mass, mck_of(system)->mass, n * n * sizeof *mass);
  for (size_t i = 0; system->uncoupled && i < n; i++)
    mass[i] = system->model->mass(system, i);
}

/* --- what else there may be --------------------------------------------------------------------------------------- */

static ric_status refuse_spring(const ric_spring *s, const char *what, size_t i, ric_error *error) {
  const double value[] = {s->quadratic, s->cubic, s->damping};
  static const char *const name[] = {"quadratic", "cubic", "damping"};
  for (size_t k = 0; k < 3; k++)
    if (value[k] != 0)
      return ric_fail(error, RIC_EINVAL, "%s %zu: %s = %g, expected 0: a linear system without damping", what, i,
                      name[k], value[k]);
  return RIC_OK;
}

static ric_status refuse_force(const double *force, size_t n, const char *what, ric_error *error) {
  for (size_t i = 0; force && i < n; i++)
    if (force[i] != 0)
      return ric_fail(error, RIC_EINVAL, "%s[%zu] = %g, expected 0: a system without forcing", what, i, force[i]);
  return RIC_OK;
}

static ric_status lattice_is_linear(const ric_lattice *lattice, ric_error *error) {
  size_t n = lattice->particles;
  for (size_t i = 0; i < n; i++) {
    ric_spring own = ric_lattice_on_site(lattice, i);
    RIC_TRY(refuse_spring(&own, "on-site spring", i, error));
  }
  for (size_t i = 0; i <= n; i++) {
    ric_spring link = ric_lattice_link(lattice, i);
    RIC_TRY(refuse_spring(&link, "link", i, error));
  }
  RIC_TRY(refuse_force(lattice->force_cos, n, "force_cos", error));
  return refuse_force(lattice->force_sin, n, "force_sin", error);
}

static ric_status mck_is_linear(const mck_system *s, ric_error *error) {
  size_t n = s->base.coordinates;
  double damping = mck_rows_norm(&s->damping);
  if (damping > 0)
    return ric_fail(error, RIC_EINVAL, "damping matrix with a row sum of %g (over the mass), expected none", damping);
  RIC_TRY(refuse_force(s->force_cos, n, "force_cos (over the mass)", error));
  return refuse_force(s->force_sin, n, "force_sin (over the mass)", error);
}

ric_status linear_part_is_all(const ric_system *system, ric_error *error) {
  RIC_TRY(refuse_user_system(system, error));
  return system->taylor == SYSTEM_LATTICE ? lattice_is_linear(lattice_system_lattice(system), error)
                                          : mck_is_linear(mck_of(system), error);
}
