/* The inside of a study, for the files of this room: how one is read is spread over them.
 *
 * study_parse reads the tree (document.h), applies `--set` (assignment.h), reads each key against its row (typed.h),
 * then the sweeps (sweep.c), then checks what concerns several keys at once (check.c), and keeps the values; the tree
 * goes when the study is complete. */
#ifndef RICOCHET_APP_PARTS_H
#define RICOCHET_APP_PARTS_H

#include "document.h"
#include "study.h"
#include "typed.h"

typedef struct sweep_entry {
  study_sweep view;           /* what study_sweep_at shows; its values are the array below */
  double *values;             /* [view.points], owned */
  uint64_t stride;            /* tasks between two values: the product of the points of all later sweeps */
  int nodes[SWEEP_KEY_COUNT]; /* values of its keys in the document while there is one; 0 where not given */
} sweep_entry;

struct study {
  char *name, *text;
  typed_value values[KEY_COUNT];
  sweep_entry sweeps[STUDY_MAX_SWEEPS];
  size_t sweep_count;
  study_parameter followed; /* by a branch; KEY_COUNT for other kinds */
  study_parameter traced;   /* second one of curves; KEY_COUNT without them */
  uint64_t tasks, digest;
};

/** Refuses a key that the section does not know, naming the nearest or all. @param section  "" for the top level. */
int refuse_unknown_key(const document *d, int key, const char *section, message *why);

/** Reads `sweep`, one entry or a list of them, and gives omitted swept keys their first value. @param node  0: none. */
int sweep_read(study *s, const document *d, int node, message *why);
/** The sweep over an element of a key (item -1: over a scalar), NULL when there is none. */
const sweep_entry *sweep_over(const study *s, study_key key, long item);
/** Node that says value `i` of a sweep. */
int sweep_value_node(const document *d, const sweep_entry *e, size_t i);

/** Whether the study is of a kind. */
bool study_is_kind(const study *s, const char *kind);

/** Finds what a family is followed along, where the study does and says so, and gives an omitted key its first value;
 *  and the second parameter of curves, where there are any. */
int branch_read(study *s, const document *d, message *why);
/** Checks the keys of a branch, and what they make of those of the orbit. */
int branch_check(const study *s, const document *d, message *why);
/** Whether a normal mode is its first guess. */
bool branch_from_mode(const study *s);
/** Whether curves through its special points are wanted. */
bool branch_traces(const study *s);
/** Checks the section `restart`, in place of these. */
int branch_check_restart(const study *s, const document *d, message *why);

/** Names what is observed, where a study that iterates leaves it to its model. */
int iterate_read(study *s, message *why);
/** Checks that a study that iterates has the sections of a family beyond grazing only, and one whose map is that of its
 * section. */
int iterate_check_family(const study *s, const document *d, message *why);
/** Checks the other keys of studies that iterate. */
int iterate_check(const study *s, const document *d, message *why);

/** Node that gives a key or sweeps it, 0 when it has its default. */
int check_node_of_key(const study *s, study_key key);
/** Node of a section, or of a sweep that stands for it; 0 when nothing of it is given. */
int check_node_of_section(const study *s, const document *d, const char *section);
/** Refuses a key, or a swept value of it, that does not have its default, for what needs it. */
int check_key_default(const study *s, const document *d, study_key key, message *why);
/** Refuses element `i` of a list that is no particle of the chain, as "orbit.at_start[2]". */
int check_particle(const study *s, const document *d, study_key key, size_t i, message *why);

/** Whether a particle has a floor or a wall, at some point of a sweep at least. */
bool check_has_obstacle(const study *s, size_t particle);

/** Checks what concerns several keys at once: missing keys, lengths of lists, the pattern, swept values. */
int study_check(const study *s, const document *d, message *why);

uint64_t study_compute_digest(const study *s);

#endif
