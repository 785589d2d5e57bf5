/* Common part of all systems: creation, obstacles, tangent vectors by differences. Internal to the library. */
#ifndef RICOCHET_SYSTEM_MODEL_H
#define RICOCHET_SYSTEM_MODEL_H

#include <math.h>
#include <stdbool.h>

#include "numeric/constants.h"
#include "ricochet/system.h"

/* The functions that every model provides, and the data common to all systems.
 *
 * A model is a table of functions over a struct that begins with `ric_system`. Flows and the room impact/ use this
 * table only; they do not depend on the model. Functions of a model return NULL, or a static text that describes the
 * failure: a callback of the user failed, a value is not finite, a mass matrix is not positive definite. */

/** State of a contact, stored in the flow: one byte per obstacle. Models and flows treat the second and the third
 *  specially. */
typedef enum contact_state {
  CONTACT_OPEN,    /* no force */
  CONTACT_HELD,    /* rigid and sticking: a force lambda keeps the gap at zero */
  CONTACT_PRESSED, /* compliant: Hertz's force acts */
  CONTACT_PASSED   /* rigid, but ignored (pass_rigid): no force, no events */
} contact_state;

/** Effect of a unit impulse of a contact: speeds change by w, and the gap rate of a motion with speeds u is g . u +
 *  offset. g and w vanish outside the speeds [first, first + count). */
typedef struct contact_direction {
  size_t first, count;
  double *g, *w; /* [count], in the caller's storage of [speeds] each; w = M^-1 g */
  double offset;
} contact_direction;

/** The impact map at vanishing gap rate. */
typedef struct impact_slope {
  double turn;  /* rate of change of the gap rate along xi: 1 + the restitution */
  bool exists;  /* the change of state is a smooth function of the gap rate and vanishes with it */
  double moved; /* largest change of a number of the state at ... */
  double rate;  /* this gap rate, close to zero */
  double power; /* power of the gap rate with which it vanishes: 1 for smooth maps, 0 if they do not tend to the
                   identity */
} impact_slope;

/** Tangent vectors of a state, side by side: q [coordinates][columns], u [speeds][columns], row-major. */
typedef struct tangents {
  size_t columns;
  double *q, *u;
} tangents;

typedef struct system_model {
  /** Rates with the forces of contacts in the given states ([obstacles]; NULL: all open, Hertz by the sign of its gap).
   */
  const char *(*rate)(const ric_system *s, const unsigned char *contact, double t, const double *q, const double *u,
                      double *q_rate, double *u_rate);
  /** Derivatives of `rate` along tangent vectors, contacts in the given states. NULL: differences, as below. */
  const char *(*tangent)(const ric_system *s, const unsigned char *contact, double t, const double *q, const double *u,
                         const tangents *d, const tangents *d_rate);
  const char *(*gap)(const ric_system *s, size_t obstacle, double t, const double *q, double *gap);
  /** Derivatives [columns] of a gap at fixed time along tangent vectors. */
  const char *(*gap_derivative)(const ric_system *s, size_t obstacle, double t, const double *q, const tangents *d,
                                double *derivative);
  const char *(*gap_rate)(const ric_system *s, size_t obstacle, double t, const double *q, const double *u,
                          double *rate);
  /** Second derivative of the gap along a motion with these rates of change. */
  const char *(*gap_acceleration)(const ric_system *s, size_t obstacle, double t, const double *q, const double *u,
                                  const double *q_rate, const double *u_rate, double *acceleration);
  /** NULL for first-order systems, whose impacts are maps. */
  const char *(*direction)(const ric_system *s, size_t obstacle, double t, const double *q, contact_direction *d);
  /** State after an impact of first-order systems; NULL for all others. */
  const char *(*impact)(const ric_system *s, size_t obstacle, double t, const double *x, double *x_after);
  /** Minus the derivative xi [n] of the change of state by the gap rate at vanishing gap rate, at the state of zero gap
   *  rate near x. NULL for all but first-order systems. */
  const char *(*impact_slope)(const ric_system *s, size_t obstacle, double t, const double *x, double *xi,
                              impact_slope *found);
  /** Force lambda of one held contact, given which contacts are held. */
  const char *(*reaction)(const ric_system *s, const unsigned char *contact, size_t obstacle, double t, const double *q,
                          const double *u, double *lambda);
  const char *(*energy)(const ric_system *s, double t, const double *q, const double *u, double *energy);
  double (*restitution)(const ric_system *s, size_t obstacle);
  /** Mass of a coordinate of an uncoupled system; NULL for user systems. */
  double (*mass)(const ric_system *s, size_t coordinate);
  /** Whether its forces depend on time; NULL: unknown. */
  bool (*forced)(const ric_system *s);
  /** Whether its forces repeat after a time, to rounding; NULL: unknown. */
  bool (*repeats)(const ric_system *s, double time);
  /** Frees the data of the model and the struct itself; obstacles have been freed. */
  void (*destroy)(ric_system *s);
} system_model;

/** The Taylor flow of a system. */
typedef enum system_taylor { SYSTEM_USER = 0, SYSTEM_LATTICE, SYSTEM_MCK } system_taylor;

/** A model's struct begins with this. */
struct ric_system {
  const system_model *model;
  system_taylor taylor;
  size_t coordinates, speeds, obstacle_count;
  /** Incremented whenever numbers of the system change: data derived from them before are stale. */
  unsigned long long revision;
  /** Obstacles at coordinates, in the order given; NULL for user systems, whose gaps are callbacks. */
  ric_obstacle *obstacles;
  /** Indices of `obstacles` in order of coordinate [obstacle_count]; NULL for user systems. */
  size_t *by_coordinate;
  /** Contacts on different coordinates do not change each other's gap rates: impulses and forces are computed contact
   *  by contact. True for diagonal mass matrices with obstacles at coordinates. */
  bool uncoupled;
};

/** Copies, checks and sorts the obstacles at coordinates of a system. */
ric_status system_take_obstacles(ric_system *s, const ric_obstacle *obstacles, size_t count, ric_error *error);

/** @returns RIC_EINVAL naming a coordinate whose rigid floor and wall leave no room between them. */
ric_status system_check_room(const ric_system *s, ric_error *error);

/** Functions of the table for obstacles at coordinates: shared by lattices and M-C-K systems. */
const char *obstacle_gap(const ric_system *s, size_t obstacle, double t, const double *q, double *gap);
const char *obstacle_gap_derivative(const ric_system *s, size_t obstacle, double t, const double *q, const tangents *d,
                                    double *derivative);
const char *obstacle_gap_rate(const ric_system *s, size_t obstacle, double t, const double *q, const double *u,
                              double *rate);
const char *obstacle_gap_acceleration(const ric_system *s, size_t obstacle, double t, const double *q, const double *u,
                                      const double *q_rate, const double *u_rate, double *acceleration);
double obstacle_restitution(const ric_system *s, size_t obstacle);

static inline bool system_complies(const ric_system *s, size_t obstacle) {
  return s->obstacles && s->obstacles[obstacle].stiffness < INFINITY;
}

/** Number of compliant obstacles. */
size_t system_compliant_obstacles(const ric_system *s);

/** A lower bound of an obstacle's gap from bounds of its coordinate. */
static inline double obstacle_least_gap(const ric_obstacle *o, double lower, double upper) {
  return o->side > 0 ? lower - o->position : o->position - upper;
}

/** Whether cosines of a frequency repeat after a time: whole turns, to rounding. */
static inline bool frequency_repeats(double frequency, double time) {
  double turns = frequency * time / two_pi;
  return fabs(turns - round(turns)) <= 1e-14 * fabs(turns);
}

/** First position in by_coordinate whose obstacle has a coordinate >= `coordinate`. */
size_t system_first_obstacle(const ric_system *s, size_t coordinate);

/** Lists the contacts that are CONTACT_HELD, at most `most` of them, in held. `contact` may be NULL: none.
 *  @returns NULL, or a text that describes the failure. */
const char *system_list_held(const ric_system *s, const unsigned char *contact, size_t most, size_t *held,
                             size_t *count);

/** Hertz's force k max(0, -gap)^{3/2}, minus its derivative in the gap, and its potential. */
double hertz_force(double stiffness, double gap);
double hertz_stiffness(double stiffness, double gap);
double hertz_energy(double stiffness, double gap);

/* Derivatives of the rates of any system along tangent vectors.
 *
 * Models provide them or leave them to differences along each vector (path_derivative.h). Steps are 2e-3 in
 * coordinates, whose scales are assumed to be one, so that truncation and rounding errors are both about 1e-13. */

/** Doubles of work for a system of any model. */
size_t system_tangent_work(const ric_system *s);

/** @param work  [system_tangent_work] */
const char *system_tangent(const ric_system *s, const unsigned char *contact, double t, const double *q,
                           const double *u, const tangents *d, const tangents *d_rate, double *work);

/** Step of differences along a direction: coordinates and time change by 2e-3, speeds by that fraction of the largest
 * of them.
 *  @param place  largest entry of the direction in coordinates and time; @param pace  the same in speeds
 *  @param speed  largest speed at the point */
double system_tangent_step(double place, double pace, double speed);

#endif
