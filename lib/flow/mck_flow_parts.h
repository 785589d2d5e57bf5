/* The Taylor flow of M-C-K systems, for the files that share it: internal to the flow. */
#ifndef RICOCHET_MCK_FLOW_PARTS_H
#define RICOCHET_MCK_FLOW_PARTS_H

#include "flow_method.h"
#include "hertz_series.h"
#include "model/mck_hold.h"
#include "taylor_stepper.h"

typedef struct pressed_contact {
  const ric_obstacle *obstacle;
  bool acts; /* its force takes part in this step */
  hertz_series series;
  double root[HERTZ_LEVELS]; /* u^{1/2} over the accepted part of a step, for tangent vectors */
} pressed_contact;

typedef struct mck_flow {
  ric_flow base;
  taylor_stepper stepper;
  double expanded;      /* length of the series */
  double *coef;         /* [order + 1][n] */
  double *acceleration; /* [n] */
  double *reaction;     /* [held coordinates][order - 1] coefficients of mu */
  mck_hold hold;
  pressed_contact *pressed; /* [pressed_count] */
  size_t pressed_count;
  double *variation; /* [order + 2][n] a tangent vector along the step, and its acceleration; NULL: none is carried */
} mck_flow;

static inline const mck_system *mck_flow_system(const mck_flow *f) {
  return mck_of(f->base.system);
}

/** Coefficient j of the coordinates [n]. */
static inline double *mck_flow_level(const mck_flow *f, int j) {
  return f->coef + (size_t)j * f->base.system->coordinates;
}

/** Of a pressed contact at the start of the step. */
static inline double mck_flow_penetration(const mck_flow *f, const pressed_contact *c) {
  return -ric_obstacle_gap(c->obstacle, f->base.q[c->obstacle->coordinate]);
}

/** The method's functions for tangent vectors. */
ric_status mck_flow_carry(ric_flow *flow, ric_error *error);
void mck_flow_transport(ric_flow *flow, double x);

#endif
