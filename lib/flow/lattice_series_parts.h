/* The workspace of lattice_series, for the files that share it: internal to the flow. */
#ifndef RICOCHET_LATTICE_SERIES_PARTS_H
#define RICOCHET_LATTICE_SERIES_PARTS_H

#include "lattice_few.h"
#include "lattice_series.h"

enum { SERIES_POWERS = (RIC_POLY_DEGREE / 4 + 1) * 4 };

struct lattice_series {
  lattice_block block;
  lattice_few *few; /* which makes the levels; NULL: the block does */
  double *store;    /* all arrays of the block */
  size_t halo;
  const ric_lattice *lattice;
  lattice_contacts contacts;
  bool ring;
  ric_segment segment; /* the last one */
  size_t loaded_count; /* particles of the stretch whose rows are loaded, from segment.first on; 0: none */
  size_t held_count;
  size_t *held_column; /* [stride] */
  double cosine[SERIES_POWERS], sine[SERIES_POWERS];
  double turn;                 /* frequency times length of the steps for which there are */
  double power[SERIES_POWERS]; /* turn^j / j! */
};

/** Columns of a block that are particles following each other. */
typedef struct series_run {
  size_t column, particle, count;
} series_run;

/** Next run of columns, from left to right; starts with a run of zeros, returns false behind the last. */
bool series_next_run(const lattice_series *series, series_run *run);

/** Loads the constants of the block's columns, and its contacts. */
void series_load_rows(lattice_series *series);

#endif
