/* The equations of shooting, for the files that share them: internal to the room. */
#ifndef RICOCHET_SHOOTING_PARTS_H
#define RICOCHET_SHOOTING_PARTS_H

#include "arc_runner.h"
#include "arcs.h"
#include "impact/tangent_jump.h"

struct ric_shooting {
  ric_system *system; /* borrowed */
  arc_plan arcs;
  arc_runner runner;
  impact_solver law;
  tangent_jump jump;
  bool forced; /* time enters the motion */
  double grazing_tol;
  bool out_of_order; /* impacts of the motion looked at last */
  ric_poll poll;
  size_t columns;   /* most numbers of a first state, c */
  double *x;        /* [n + m] state along a piece */
  double *rates;    /* [n + m] */
  double *contact;  /* [2][m] direction of a contact and what it moves */
  double *carried;  /* [n + m][c + 1] tangent vectors along a piece; shooting_spectrum.h has room for more */
  double *ends;     /* [n + m][c + 2] derivatives of the end of a piece: by the numbers of its first state, and by the
                       times at which its arc begins and ends */
  double *gap_row;  /* [c + 2] the same of a gap */
  double *in_time;  /* [c + 2] by how much the end of the piece moves in time */
  double *gradient; /* [n + m] of the energy at the first state */
  double *phase_at; /* [n + m] the phase condition: <phase_along, x - phase_at> = 0 */
  double *phase_along;
  double *residual;                   /* [unknowns] of a solution that is looked at */
  double *block;                      /* behind all of them */
  struct shooting_gaps *gaps;         /* NULL until an orbit is asked for */
  struct shooting_spectrum *spectrum; /* NULL until multipliers are asked for */
};

/** What is wanted of the end of a piece: its state; derivatives by the numbers of the equations, too; those by the
 *  whole first state, too. */
typedef enum piece_wish { WISH_STATE, WISH_DERIVATIVES, WISH_WHOLE } piece_wish;

/** A piece of a motion that is moved along. */
typedef struct piece_run {
  const arc_piece *piece;
  double begin, end;    /* times */
  size_t first_numbers; /* of its first state */
  piece_wish wish;
  double *carried; /* [n + m][columns] tangent vectors: of the first numbers, of time where it moves, of the others */
  size_t columns;
} piece_run;

/** Derivatives of the end of a piece, s->ends, in the form of tangent vectors. */
static inline tangents shooting_ends(const ric_shooting *s, const piece_run *run) {
  size_t columns = run->first_numbers + 2;
  return (tangents){.columns = columns, .q = s->ends, .u = s->ends + s->arcs.coordinates * columns};
}

/** Sets s->x to the first state of a piece and says how it will run. @param wish  WISH_WHOLE with a spectrum only */
piece_run shooting_begin(ric_shooting *s, size_t piece, const double *z, double period, piece_wish wish);

/** Moves s->x to the end of the piece, and sets s->ends and what is carried.
 *  @param watcher  may be NULL */
ric_status shooting_move(ric_shooting *s, const piece_run *run, const arc_watch *watcher, ric_error *error);

/** Column of what is carried that belongs to a row of the first state; NO_UNKNOWN where there is none. */
size_t shooting_column(const ric_shooting *s, const piece_run *run, size_t row);

/** The gap of the obstacle that is hit at the end of the piece, and its derivative in s->gap_row. */
ric_status shooting_gap(ric_shooting *s, const piece_run *run, size_t obstacle, double *gap, ric_error *error);

/** Takes s->x and s->ends through the impact at the end of the piece. */
ric_status shooting_hit(ric_shooting *s, const piece_run *run, ric_error *error);

/** Energy of a first state x [n + m], and its gradient in s->gradient; x is moved, and put back. */
ric_status shooting_energy(ric_shooting *s, double *x, double *energy, ric_error *error);

/** Sees the pieces of a motion while the equations are evaluated; functions may be NULL. */
typedef struct shooting_observer {
  ric_status (*begins)(const piece_run *run, void *user, ric_error *error);
  void (*segment)(const ric_segment *piece, double end, void *user);
  ric_status (*ends)(const piece_run *run, void *user, ric_error *error); /* at s->x, before the impact there */
  bool whole; /* it looks at tangent vectors of the whole state */
  void *user;
} shooting_observer;

/** As ric_shooting_residual. @param observer  may be NULL */
ric_status shooting_evaluate(ric_shooting *shooting, const double *z, double given, double *F, double *J,
                             double *F_given, const shooting_observer *observer, ric_error *error);

/** @returns RIC_ENUMERIC unless z are numbers and the period is positive, which is set. */
ric_status shooting_period(const ric_shooting *s, const double *z, double given, double *period, ric_error *error);

#endif
