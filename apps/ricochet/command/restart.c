#include "restart.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../result/motion.h"
#include "../kind/branch/branch.h"
#include "../kind/family/family_check.h"

/* Impacts closer than this part of the period to t = 0 or T/2 are there. */
static const double at_once = 1e-9;

enum { MOST_ADDED = 16 + RESULT_MOST_NUMBERS };

/* What a study takes from the motion: the numbers that its assignments point to stand beside them. */
typedef struct taken {
  study_assignment all[MOST_ADDED];
  double numbers[MOST_ADDED];
  size_t count;
} taken;

static void assign_number(taken *t, const char *path, double value) {
  t->numbers[t->count] = value;
  t->all[t->count] =
      (study_assignment){.path = path, .numbers = &t->numbers[t->count], .count = 1, .what = ASSIGN_NUMBER};
  t->count++;
}

static void assign_list(taken *t, const char *path, const double *numbers, size_t count) {
  t->all[t->count++] = (study_assignment){.path = path, .numbers = numbers, .count = count, .what = ASSIGN_LIST};
}

/* --- what a study takes --- */

static bool is_swept(const study *s, const char *name) {
  for (size_t i = 0; i < study_sweeps(s); i++)
    if (strcmp(study_sweep_at(s, i)->name, name) == 0)
      return true;
  return false;
}

/* Where the branch starts, of a parameter that did not vary in the result: at the motion's own period or energy, at
 * what the study says, or else at the number of its model. */
static void assign_from(taken *a, const study *s, const study_values *v, const result_motion *m) {
  const study_parameter *followed = family_followed(s);
  if (!followed)
    return;
  if (followed->key == KEY_ORBIT_PERIOD)
    assign_number(a, "branch.from", m->period);
  else if (followed->key == KEY_ORBIT_ENERGY)
    assign_number(a, "branch.from", m->energy);
  else if (!study_gives(s, KEY_BRANCH_FROM) && value_present(v, followed->key))
    assign_number(a, "branch.from", value_number(v, followed->key, followed->item < 0 ? 0 : (size_t)followed->item));
}

/* Whether a number that varies in the result is of no use here: it belongs to the first guess there, in the place of
 * which the state and its impacts have come, or it is the energy of a motion whose period is to be followed. */
static bool is_done_with(const study *s, const char *name) {
  static const char *const guesses[] = {"start.",         "orbit.excited", "orbit.mode",     "orbit.swings",
                                        "orbit.at_start", "orbit.at_half", "orbit.sequence", "orbit.times"};
  for (size_t i = 0; i < sizeof guesses / sizeof *guesses; i++)
    if (strncmp(name, guesses[i], strlen(guesses[i])) == 0)
      return true;
  const study_parameter *followed = family_followed(s);
  return followed && followed->key == KEY_ORBIT_PERIOD && strcmp(name, "orbit.energy") == 0;
}

/* The numbers that vary in the result, but those that vary in the study. */
static void assign_numbers(taken *a, const study *s, const study_values *v, const result_motion *m) {
  const char *followed = family_followed(s) ? family_followed(s)->name : "";
  bool known = false;
  for (size_t i = 0; i < m->number_count; i++) {
    const result_number *n = &m->numbers[i];
    if (strcmp(n->name, followed) == 0) {
      assign_number(a, "branch.from", n->value);
      known = true;
    } else if (!is_swept(s, n->name) && !is_done_with(s, n->name))
      assign_number(a, n->name, n->value);
  }
  if (!known)
    assign_from(a, s, v, m);
}

/* Whether a key of the motion is neither followed nor swept, here or in the result. */
static bool is_fixed(const study *s, study_key key, const char *name, const result_motion *m) {
  for (size_t i = 0; i < m->number_count; i++)
    if (strcmp(m->numbers[i].name, name) == 0)
      return false;
  return !(family_followed(s) && family_followed(s)->key == key) && !is_swept(s, name);
}

/* The numbers of the motion that the model does not give: its period, and its energy where the study has one. */
static void assign_period(taken *a, const study *s, const study_values *v, const result_motion *m) {
  const bool forced = strcmp(value_word(v, KEY_ORBIT_MOTION), "forced") == 0;
  const bool multiple = value_number(v, KEY_ORBIT_FORCING_PERIODS, 0) > 0;
  if (!forced && !multiple && is_fixed(s, KEY_ORBIT_PERIOD, "orbit.period", m))
    assign_number(a, "orbit.period", m->period);
  if (value_number(v, KEY_ORBIT_ENERGY, 0) > -INFINITY && is_fixed(s, KEY_ORBIT_ENERGY, "orbit.energy", m))
    assign_number(a, "orbit.energy", m->energy);
}

/* Particles that hit, and when, in the order of a list of the study. */
typedef struct hits {
  double *particles, *times; /* [count] */
  size_t count;
} hits;

static void add_hit(hits *h, const result_impact *impact) {
  h->particles[h->count] = (double)impact->particle;
  h->times[h->count++] = impact->time;
}

/* Of even motions: those at t = 0, at T/2 and between; the second half mirrors the first. */
static void sort_even(const result_motion *m, hits *start, hits *half, hits *between) {
  const double T = m->period;
  for (size_t k = 0; k < m->impact_count; k++) {
    const double t = m->impacts[k].time;
    if (fmin(t, T - t) <= at_once * T)
      add_hit(start, &m->impacts[k]);
    else if (fabs(t - T / 2) <= at_once * T)
      add_hit(half, &m->impacts[k]);
    else if (t < T / 2)
      add_hit(between, &m->impacts[k]);
  }
}

/* Of others the last one listed comes first; times go on rising beyond the period. */
static void sort_sequence(const result_motion *m, hits *sequence) {
  for (size_t k = 0; k < m->impact_count; k++) {
    result_impact impact = m->impacts[(k + m->impact_count - 1) % m->impact_count];
    while (k > 0 && impact.time < sequence->times[k - 1])
      impact.time += m->period;
    add_hit(sequence, &impact);
  }
}

static void assign_impacts(taken *a, const study_values *v, const result_motion *m, double *store) {
  const size_t n = m->impact_count + 1;
  hits lists[3];
  for (size_t i = 0; i < 3; i++)
    lists[i] = (hits){.particles = store + 2 * i * n, .times = store + (2 * i + 1) * n};
  if (strcmp(value_word(v, KEY_ORBIT_MOTION), "even") == 0)
    sort_even(m, &lists[0], &lists[1], &lists[2]);
  else
    sort_sequence(m, &lists[2]);
  assign_list(a, "orbit.at_start", lists[0].particles, lists[0].count);
  assign_list(a, "orbit.at_half", lists[1].particles, lists[1].count);
  assign_list(a, "orbit.sequence", lists[2].particles, lists[2].count);
  assign_list(a, "orbit.times", lists[2].times, lists[2].count);
}

/* The state takes the place of every other first guess. */
static void assign_state(taken *a, const result_motion *m) {
  a->all[a->count++] = (study_assignment){.path = "start", .what = ASSIGN_EMPTY};
  assign_list(a, "start.q", m->q, m->particles);
  assign_list(a, "start.v", m->v, m->particles);
  a->all[a->count++] = (study_assignment){.path = "restart", .what = ASSIGN_EMPTY};
  assign_list(a, "orbit.excited", NULL, 0);
  a->all[a->count++] = (study_assignment){.path = "orbit.mode", .what = ASSIGN_NULL};
}

/* A study names particles: of one between a floor and a wall it means the floor. */
static int check_sides(const study *s, const study_values *v, const result_motion *m, message *why) {
  for (size_t k = 0; k < m->impact_count; k++) {
    const size_t i = (size_t)m->impacts[k].particle;
    if (i >= (size_t)value_number(v, KEY_MODEL_PARTICLES, 0))
      return refuse(why, EXIT_USAGE, "%s: the restart has an impact of particle %zu, which the model has not",
                    study_name(s), i);
    if (m->impacts[k].wall && value_number(v, KEY_MODEL_FLOOR, value_is_list(v, KEY_MODEL_FLOOR) ? i : 0) > -INFINITY)
      return refuse(why, EXIT_USAGE,
                    "%s: the restart has an impact at the wall of particle %zu, which has a floor, too", study_name(s),
                    i);
  }
  return 0;
}

/* --- resolving --- */

static int read_motion(const study *s, const study_values *v, result_motion *m, message *why) {
  const double special = value_number(v, KEY_RESTART_SPECIAL, 0), point = value_number(v, KEY_RESTART_POINT, 0);
  const result_where where = {.path = value_word(v, KEY_RESTART_FILE),
                              .task = (uint64_t)value_number(v, KEY_RESTART_TASK, 0),
                              .index = (uint64_t)(special >= 0 ? special : point),
                              .special = special >= 0};
  const int code = result_read_motion(&where, m, why);
  return code ? code : check_sides(s, v, m, why);
}

/* Reads the study once more, with what it takes added to its assignments. */
static int parse_again(const study *s, const study_values *v, const result_motion *m, study_source from, study **out,
                       message *why) {
  taken t = {.count = 0};
  char place[224];
  double *store = calloc(6 * (m->impact_count + 1), sizeof *store);
  if (!store)
    return refuse(why, EXIT_RUN, "%s: no memory for its start", study_name(s));
  assign_state(&t, m);
  assign_numbers(&t, s, v, m);
  assign_period(&t, s, v, m);
  assign_impacts(&t, v, m, store);
  snprintf(place, sizeof place, "restart from %.200s", value_word(v, KEY_RESTART_FILE));
  from.assigned_by = place;
  from.assignments = t.all;
  from.assignment_count = t.count;
  const int code = study_parse(&from, out, why);
  free(store);
  return code;
}

/* Exchanges a study that restarts for the complete one. */
static int complete(study **s, const study_source *from, message *why) {
  study *resolved = NULL;
  result_motion m = {0};
  study_values *v = study_values_create(*s);
  int code = v ? read_motion(*s, v, &m, why) : refuse(why, EXIT_RUN, "%s: no memory for its values", study_name(*s));
  if (!code)
    code = parse_again(*s, v, &m, *from, &resolved, why);
  study_values_destroy(&v);
  result_motion_clear(&m);
  study_destroy(s);
  *s = resolved;
  return code;
}

int restart_read_study(const char *path, const char *const *sets, size_t set_count, study **out, message *why) {
  char *text = NULL;
  study_source from = {.schema = &studies, .name = path, .sets = sets, .set_count = set_count};
  *out = NULL;
  int code = study_read_file(path, &text, &from.length, why);
  from.text = text;
  if (!code)
    code = study_parse(&from, out, why);
  if (!code && branch_restarts(*out))
    code = complete(out, &from, why);
  free(text);
  return code;
}
