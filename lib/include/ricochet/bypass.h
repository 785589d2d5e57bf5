/* The discontinuity mapping of [FN97], section 4, there the bypass map: what an impact of low speed adds to a motion,
 * as a map at one time (zero-time discontinuity mapping, ZDM).
 *
 * Let Phi be the free motion, which passes through the obstacle, and H(x, t) = h(Phi_t x) its gap. Let psi(x) be the
 * minimum of H near a grazing point and tau(x) the time of that minimum. Then
 *
 *   C(x) = Phi_{-t_C} G Phi_{t_C} x  where psi(x) <= 0,   C(x) = x elsewhere, (4.2)
 *
 * with the impact law G and the time t_C <= tau at which the motion reaches the obstacle on its way in. The motion
 * with impacts is the free motion with C inserted where it passes the grazing point: Phi_{t2} C Phi_{t1}. To leading
 * order
 *
 *   C(x) = x + sqrt(-psi) sqrt(2 A_g) xi + O(-psi),                                                              (4.19)
 *
 * with the second time derivative A_g of the gap at grazing and xi = -dG/dh', the change of state per gap rate: (0,
 * (1 + e) M^-1 g / (g^T M^-1 g)) for mechanical systems. The error is of first order in -psi and lies along kappa:
 *
 *   C(x) = x + y s xi + y^2 kappa + O(y^3, y |x - x*|),    y = sqrt(-psi),  s = sqrt(2 A_g).
 *
 * With t_C = tau - y sqrt(2 / A_g) + O(y^2) and the gap rate -y s + y^2 (2 h''' / 3 A_g) + O(y^3) at the impact,
 * (4.2) gives kappa = 2 DF xi - 2 xi' - (2 h''' / 3 A_g) xi for impacts that are linear in the gap rate, with xi' and
 * h''' along the free motion at x*. An error d of the gap, from the flow or from rounding, is an error d / 2y of y.
 *
 * C describes one impact. Far from grazing the gap may close again soon after it, or the contact may stick when
 * restitution is 0 and h'' < 0 at t_C. The motion then has more events than C contains.
 *
 * Time is part of the state of a forced system and does not change at impacts; "Phi_t x" is the motion from (x, t_0).
 */
#ifndef RICOCHET_BYPASS_H
#define RICOCHET_BYPASS_H

#include "trajectory.h"

RIC_BEGIN_DECLARATIONS

/** Coefficients of the discontinuity mapping at a state near grazing. */
typedef struct ric_grazing_local {
  size_t numbers; /* n + m */
  size_t obstacle;
  double gap;          /* h */
  double rate;         /* h' */
  double acceleration; /* A_g: h'' of the free motion */
  double *eta;         /* [n + m] gradient of the gap with respect to the state at fixed time */
  double *xi;          /* [n + m] */
  double restitution;  /* at vanishing gap rate: grad h' . xi - 1 */
} ric_grazing_local;

/** Allocates the arrays for states of n + m numbers. @returns RIC_ENOMEM. */
RIC_API ric_status ric_grazing_local_init(ric_grazing_local *local, size_t numbers, ric_error *error);
RIC_API void ric_grazing_local_clear(ric_grazing_local *local);

/** The coefficients at a state, preferably at a grazing point: h and h' need not be zero. For a first-order system xi
 *  is the one-sided derivative of the impact map at vanishing gap rate, by extrapolation, at the state of zero gap
 *  rate near x: about nine digits.
 *  @param x  [n + m] state (q, u)
 *  @param local  initialised for as many numbers; unchanged on failure
 *  @returns RIC_EINVAL for an unknown or compliant obstacle, for a state that is not finite, and for an impact map
 *           that does not tend to the identity as the gap rate vanishes, has no derivative there, or leaves the gap
 *           rate negative: the message gives the obstacle and the change of state; RIC_ECALLBACK, RIC_ENOMEM. */
RIC_API ric_status ric_grazing_local_find(const ric_system *system, size_t obstacle, double t, const double *x,
                                          ric_grazing_local *local, ric_error *error);

typedef struct ric_bypass ric_bypass;

typedef struct ric_bypass_options {
  ric_flow_options flow;
  double reach; /* > 0, default 1: search interval. The minimum of the gap is searched within this time before and after
                   that of the state, the impact within this time before the minimum */
} ric_bypass_options;

RIC_API ric_bypass_options ric_bypass_options_default(void);

/** @param system  borrowed, must outlive it; its numbers may change between calls
 *  @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL for an unknown obstacle, options out of range, and a system with any compliant obstacle: the map
 *           integrates backwards in time, and pressed Hertz contacts cannot; RIC_ENOMEM. */
RIC_API ric_status ric_bypass_create(ric_system *system, size_t obstacle, const ric_bypass_options *options,
                                     ric_bypass **bypass, ric_error *error);
RIC_API void ric_bypass_destroy(ric_bypass **bypass);

/** What an evaluation of the map found. */
typedef struct ric_bypass_seen {
  double psi;       /* minimum of the gap of the free motion */
  double tau;       /* its time minus that of the state */
  double curvature; /* h'' there */
  double t_C;       /* time of the impact minus that of the state; NaN without an impact */
  double gap_rate;  /* there, <= 0; 0 without an impact */
} ric_bypass_seen;

/** psi and tau of a state, and h'' at the minimum. Of several minima, the nearest in time, before or after.
 *  @param seen  set; t_C and gap_rate are NaN and 0
 *  @returns RIC_ENUMERIC if the gap has no minimum within the reach, or h'' vanishes at it; RIC_EINVAL for a state that
 *           is not finite; RIC_ECALLBACK. */
RIC_API ric_status ric_bypass_look(ric_bypass *bypass, double t, const double *x, ric_bypass_seen *seen,
                                   ric_error *error);

/** C(x) to the tolerance of the flow. For systems that CVODES integrates, short intervals are integrated by Gragg's
 *  method instead, to rounding. Allocates nothing but what CVODES does.
 *  @param x  [n + m]  @param image  [n + m], set; may be x; unchanged on failure
 *  @param seen  may be NULL
 *  @returns as ric_bypass_look; RIC_ENUMERIC if the gap is negative throughout the reach before its minimum; RIC_EINVAL
 *           if the impact law does not reverse the gap rate. */
RIC_API ric_status ric_bypass_map(ric_bypass *bypass, double t, const double *x, double *image, ric_bypass_seen *seen,
                                  ric_error *error);

/** C(x) to leading order, (4.19), with the exact psi(x) and the coefficients of the grazing point. Parameters as above.
 *  @param seen  may be NULL */
RIC_API ric_status ric_bypass_leading(ric_bypass *bypass, const ric_grazing_local *at_grazing, double t,
                                      const double *x, double *image, ric_bypass_seen *seen, ric_error *error);

/** kappa [n + m] at a grazing point, extrapolated from C at neighbouring states; seven to nine digits.
 *  @param at_grazing  its coefficients  @param x  the grazing state  @returns as ric_bypass_map. */
RIC_API ric_status ric_bypass_second(ric_bypass *bypass, const ric_grazing_local *at_grazing, double t, const double *x,
                                     double *kappa, ric_error *error);

RIC_END_DECLARATIONS

#endif
