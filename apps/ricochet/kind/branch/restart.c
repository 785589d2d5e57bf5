/* A branch that restarts from a point of an earlier result: the motion is read from the result and replaces the first
 * guess of the study. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "branch.h"
#include "kind/family/family_check.h"
#include "result/child.h"
#include "result/reader.h"

/* --- a motion of a result --- */

typedef struct stored_impact {
  double time;
  long long particle;
  bool wall; /* or its floor */
} stored_impact;

/** A number that varies in the result, with its key. */
typedef struct stored_number {
  char name[96];
  double value;
} stored_number;

enum { MOST_NUMBERS = 9 /* the continuation parameter and the swept ones */ };

typedef struct stored_motion {
  size_t particles;
  double *q, *v; /* [particles] first state */
  double period, energy;
  stored_impact *impacts; /* [impact_count] as ric_orbit lists them */
  size_t impact_count;
  stored_number numbers[MOST_NUMBERS]; /* the continuation parameter first */
  size_t number_count;
} stored_motion;

/** Its place in the result. */
typedef struct stored_where {
  const char *path;
  uint64_t task, index;
  bool special; /* a special point of the task, or a point */
} stored_where;

/* A result being read. */
typedef struct stored_file {
  file_place at;
  reader_handle file;
  reader_group branch, sweep;
  const char *what; /* "special" or "point" */
} stored_file;

/* The data set "<what>_<name>". */
static const reader_set *find_of(const stored_file *f, const char *name) {
  char full[64];
  snprintf(full, sizeof full, "%s_%s", f->what, name);
  return reader_find(&f->branch, full);
}

static int refuse_set(const stored_file *f, const char *name) {
  return refuse(f->at.why, EXIT_FILES, "%s: data set %s is missing or of another shape or type", f->at.path, name);
}

/* Rows of a set with one number, or integer, per row. */
static int read_rows(const stored_file *f, const reader_set *s, const char *name, uint64_t first, uint64_t count,
                     void *values) {
  if (!s || s->rank != 1 || s->value_bytes != 8 || (s->type != READER_NUMBER && s->type != READER_INTEGER) ||
      first + count > s->shape[0])
    return refuse_set(f, name);
  return count > 0 ? reader_rows(&f->at, s, first, count, values) : 0;
}

/* The range of rows that a task owns. */
static int read_range(const stored_file *f, const char *what, uint64_t task, int64_t range[2]) {
  char name[64];
  snprintf(name, sizeof name, "%s_offset", what);
  const int code = read_rows(f, reader_find(&f->branch, name), name, task, 2, range);
  return code || (range[0] >= 0 && range[1] >= range[0]) ? code : refuse_set(f, name);
}

/* --- the point --- */

static int read_vector(const stored_file *f, const char *name, uint64_t row, double **values, size_t *count) {
  const reader_set *s = find_of(f, name);
  if (!s && strcmp(f->what, "point") == 0)
    return refuse(f->at.why, EXIT_USAGE, "%s: the points have no states, expected a result with branch.states: true",
                  f->at.path);
  if (!s || s->rank != 2 || s->type != READER_NUMBER || row >= s->shape[0] || s->shape[1] < 1)
    return refuse_set(f, name);
  *count = s->shape[1];
  *values = calloc(s->shape[1], sizeof **values);
  if (!*values)
    return refuse(f->at.why, EXIT_RUN, "%s: no memory for a state", f->at.path);
  return reader_rows(&f->at, s, row, 1, (unsigned char *)*values);
}

static int read_point(const stored_file *f, uint64_t row, stored_motion *m) {
  stored_number *followed = &m->numbers[m->number_count++];
  const reader_set *parameter = find_of(f, "parameter");
  size_t speeds = 0;
  int code = read_rows(f, parameter, "parameter", row, 1, &followed->value);
  if (!code)
    code = read_rows(f, find_of(f, "period"), "period", row, 1, &m->period);
  if (!code)
    code = read_rows(f, find_of(f, "energy"), "energy", row, 1, &m->energy);
  if (!code)
    code = read_vector(f, "q", row, &m->q, &m->particles);
  if (!code)
    code = read_vector(f, "v", row, &m->v, &speeds);
  if (!code && speeds != m->particles)
    code = refuse_set(f, "v");
  if (!code)
    snprintf(followed->name, sizeof followed->name, "%.95s", reader_parameter(parameter));
  return code;
}

static int read_impact(const stored_file *f, uint64_t row, stored_impact *impact) {
  const reader_set *side = reader_find(&f->branch, "impact_side");
  signed char wall = 0;
  int64_t particle = 0;
  int code = read_rows(f, reader_find(&f->branch, "impact_time"), "impact_time", row, 1, &impact->time);
  if (!code)
    code = read_rows(f, reader_find(&f->branch, "impact_particle"), "impact_particle", row, 1, &particle);
  if (!code)
    code = side && side->rank == 1 && side->value_bytes == 1 && row < side->shape[0]
               ? reader_rows(&f->at, side, row, 1, (unsigned char *)&wall)
               : refuse_set(f, "impact_side");
  impact->particle = particle;
  impact->wall = wall != 0;
  return code;
}

static int read_impacts(const stored_file *f, const stored_where *where, stored_motion *m) {
  char name[64];
  int64_t range[2], owner;
  snprintf(name, sizeof name, "impact_%s", f->what);
  int code = read_range(f, "impact", where->task, range);
  if (!code)
    m->impacts = calloc((size_t)(range[1] - range[0]) + 1, sizeof *m->impacts);
  if (!code && !m->impacts)
    code = refuse(f->at.why, EXIT_RUN, "%s: no memory for its impacts", f->at.path);
  for (int64_t row = range[0]; !code && row < range[1]; row++) {
    code = read_rows(f, reader_find(&f->branch, name), name, (uint64_t)row, 1, &owner);
    if (!code && owner == (int64_t)where->index)
      code = read_impact(f, (uint64_t)row, &m->impacts[m->impact_count++]);
  }
  return code;
}

/* The swept numbers of the result. */
static int read_swept(const stored_file *f, uint64_t task, stored_motion *m) {
  int code = 0;
  for (size_t i = 0; i < f->sweep.count && m->number_count < MOST_NUMBERS && !code; i++) {
    stored_number *n = &m->numbers[m->number_count++];
    snprintf(n->name, sizeof n->name, "%.95s", f->sweep.sets[i].name);
    code = read_rows(f, &f->sweep.sets[i], n->name, task, 1, &n->value);
  }
  return code;
}

static int read_motion(const stored_file *f, const stored_where *where, stored_motion *m) {
  const reader_set *outcome = reader_find(&f->branch, "outcome");
  int64_t range[2] = {0};
  if (!outcome)
    return refuse(f->at.why, EXIT_FILES, "%s: no /branch/outcome in it: not a result of kind branch", f->at.path);
  if (where->task >= outcome->shape[0])
    return refuse(f->at.why, EXIT_USAGE, "%s: restart.task = %llu, expected a task from 0 to %llu", f->at.path,
                  (unsigned long long)where->task, (unsigned long long)outcome->shape[0] - 1);
  int code = read_range(f, f->what, where->task, range);
  const uint64_t count = (uint64_t)(range[1] - range[0]);
  if (!code && where->index >= count)
    code = refuse(f->at.why, EXIT_USAGE, "%s: restart.%s = %llu, but task %llu has %llu of them, counted from 0",
                  f->at.path, f->what, (unsigned long long)where->index, (unsigned long long)where->task,
                  (unsigned long long)count);
  if (!code)
    code = read_point(f, (uint64_t)range[0] + where->index, m);
  if (!code)
    code = read_impacts(f, where, m);
  return code ? code : read_swept(f, where->task, m);
}

static int read_file(const stored_where *where, stored_motion *m, message *why) {
  stored_file f = {.at = {where->path, why}, .what = where->special ? "special" : "point"};
  int code = reader_open(&f.at, where->path, &f.file);
  if (code)
    return code;
  if (reader_has(f.file, "branch"))
    code = reader_group_open(&f.at, f.file, "branch", &f.branch);
  if (!code && reader_has(f.file, "sweep"))
    code = reader_group_open(&f.at, f.file, "sweep", &f.sweep);
  if (!code)
    code = read_motion(&f, where, m);
  reader_group_clear(&f.branch);
  reader_group_clear(&f.sweep);
  return reader_close(&f.at, f.file, code);
}

static void stored_motion_clear(stored_motion *m) {
  free(m->q);
  free(m->v);
  free(m->impacts);
  *m = (stored_motion){0};
}

/* --- a motion that a child reads: the file may be anybody's --- */

typedef struct reading {
  const stored_where *where;
  stored_motion *motion;
} reading;

static int send_motion(void *user, FILE *reply, message *why) {
  const reading *r = user;
  stored_motion m = {0};
  int code = read_file(r->where, &m, why);
  if (!code) { /* a failed write shows when the reply is closed */
    fwrite(&m, sizeof m, 1, reply);
    fwrite(m.q, sizeof *m.q, m.particles, reply);
    fwrite(m.v, sizeof *m.v, m.particles, reply);
    fwrite(m.impacts, sizeof *m.impacts, m.impact_count, reply);
  }
  stored_motion_clear(&m);
  return code;
}

/* A list of the reply; NULL where it is cut short. */
static void *take_list(FILE *reply, size_t count, size_t bytes) {
  void *list = count < SIZE_MAX ? calloc(count + 1, bytes) : NULL;
  if (list && fread(list, bytes, count, reply) == count)
    return list;
  free(list);
  return NULL;
}

static int take_motion(void *user, FILE *reply, message *why) {
  const reading *r = user;
  stored_motion *m = r->motion;
  const bool whole = fread(m, sizeof *m, 1, reply) == 1;
  if (!whole)
    *m = (stored_motion){0};
  m->q = m->v = NULL; /* those were addresses of the child */
  m->impacts = NULL;
  for (size_t i = 0; i < MOST_NUMBERS; i++)
    m->numbers[i].name[sizeof m->numbers[i].name - 1] = '\0';
  if (whole && m->number_count <= MOST_NUMBERS && (m->q = take_list(reply, m->particles, sizeof *m->q)) &&
      (m->v = take_list(reply, m->particles, sizeof *m->v)) &&
      (m->impacts = take_list(reply, m->impact_count, sizeof *m->impacts)))
    return 0;
  return refuse(why, EXIT_RUN, "%s: no memory for its motion, or only a part of it arrived", r->where->path);
}

static int read_stored_motion(const stored_where *where, stored_motion *m, message *why) {
  reading r = {where, m};
  *m = (stored_motion){0};
  return child_read(where->path, &(child_task){.read = send_motion, .take = take_motion, .user = &r}, why);
}

/* --- assignments to the study --- */

/* Impacts within this fraction of the period from t = 0 or T/2 are at these times. */
static const double at_once = 1e-9;

enum { MOST_ADDED = 16 + MOST_NUMBERS };

/* The assignments that the motion gives, and the numbers to which they point. */
typedef struct assignments {
  study_assignment all[MOST_ADDED];
  double numbers[MOST_ADDED];
  size_t count;
} assignments;

static void assign_number(assignments *t, const char *path, double value) {
  t->numbers[t->count] = value;
  t->all[t->count] =
      (study_assignment){.path = path, .numbers = &t->numbers[t->count], .count = 1, .what = ASSIGN_NUMBER};
  t->count++;
}

static void assign_list(assignments *t, const char *path, const double *numbers, size_t count) {
  t->all[t->count++] = (study_assignment){.path = path, .numbers = numbers, .count = count, .what = ASSIGN_LIST};
}

static bool is_swept(const study *s, const char *name) {
  for (size_t i = 0; i < study_sweeps(s); i++)
    if (strcmp(study_sweep_at(s, i)->name, name) == 0)
      return true;
  return false;
}

/* Start of the branch along a parameter that did not vary in the result: the period or energy of the motion, the value
 * of the study, or else that of its model. */
static void assign_from(assignments *a, const study *s, const study_values *v, const stored_motion *m) {
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

/* Whether a number that varies in the result is not assigned: it belongs to the first guess, which the state and the
 * impacts replace, or it is the energy of a motion whose period is the parameter. */
static bool is_superseded(const study *s, const char *name) {
  static const char *const guesses[] = {"start.",         "orbit.excited", "orbit.mode",     "orbit.swings",
                                        "orbit.at_start", "orbit.at_half", "orbit.sequence", "orbit.times"};
  for (size_t i = 0; i < sizeof guesses / sizeof *guesses; i++)
    if (strncmp(name, guesses[i], strlen(guesses[i])) == 0)
      return true;
  const study_parameter *followed = family_followed(s);
  return followed && followed->key == KEY_ORBIT_PERIOD && strcmp(name, "orbit.energy") == 0;
}

/* The numbers that vary in the result but not in the study. */
static void assign_numbers(assignments *a, const study *s, const study_values *v, const stored_motion *m) {
  const char *followed = family_followed(s) ? family_followed(s)->name : "";
  bool known = false;
  for (size_t i = 0; i < m->number_count; i++) {
    const stored_number *n = &m->numbers[i];
    if (strcmp(n->name, followed) == 0) {
      assign_number(a, "branch.from", n->value);
      known = true;
    } else if (!is_swept(s, n->name) && !is_superseded(s, n->name))
      assign_number(a, n->name, n->value);
  }
  if (!known)
    assign_from(a, s, v, m);
}

/* Whether a key of the motion varies neither in the study nor in the result. */
static bool is_fixed(const study *s, study_key key, const char *name, const stored_motion *m) {
  for (size_t i = 0; i < m->number_count; i++)
    if (strcmp(m->numbers[i].name, name) == 0)
      return false;
  return !(family_followed(s) && family_followed(s)->key == key) && !is_swept(s, name);
}

/* The period of the motion, and its energy if the study gives one. */
static void assign_period(assignments *a, const study *s, const study_values *v, const stored_motion *m) {
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

static void add_hit(hits *h, const stored_impact *impact) {
  h->particles[h->count] = (double)impact->particle;
  h->times[h->count++] = impact->time;
}

/* Even motions: impacts at t = 0, at T/2 and between; those of the second half follow by symmetry. */
static void sort_even(const stored_motion *m, hits *start, hits *half, hits *between) {
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

/* Other motions: the last impact of the list comes first; later times continue beyond the period. */
static void sort_sequence(const stored_motion *m, hits *sequence) {
  for (size_t k = 0; k < m->impact_count; k++) {
    stored_impact impact = m->impacts[(k + m->impact_count - 1) % m->impact_count];
    while (k > 0 && impact.time < sequence->times[k - 1])
      impact.time += m->period;
    add_hit(sequence, &impact);
  }
}

static void assign_impacts(assignments *a, const study_values *v, const stored_motion *m, double *store) {
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

/* The state replaces every other first guess. */
static void assign_state(assignments *a, const stored_motion *m) {
  a->all[a->count++] = (study_assignment){.path = "start", .what = ASSIGN_EMPTY};
  assign_list(a, "start.q", m->q, m->particles);
  assign_list(a, "start.v", m->v, m->particles);
  a->all[a->count++] = (study_assignment){.path = "restart", .what = ASSIGN_EMPTY};
  assign_list(a, "orbit.excited", NULL, 0);
  a->all[a->count++] = (study_assignment){.path = "orbit.mode", .what = ASSIGN_NULL};
}

/* A study gives particles only: of a particle with floor and wall it means the floor. Refuses impacts that this
 * excludes. */
static int check_sides(const study *s, const study_values *v, const stored_motion *m, message *why) {
  for (size_t k = 0; k < m->impact_count; k++) {
    const size_t i = (size_t)m->impacts[k].particle;
    if (i >= (size_t)value_number(v, KEY_MODEL_PARTICLES, 0))
      return refuse(why, EXIT_USAGE, "%s: the restart has an impact of particle %zu, which does not exist in the model",
                    study_name(s), i);
    if (m->impacts[k].wall && value_number(v, KEY_MODEL_FLOOR, value_is_list(v, KEY_MODEL_FLOOR) ? i : 0) > -INFINITY)
      return refuse(why, EXIT_USAGE,
                    "%s: the restart has an impact at the wall of particle %zu, which also has a floor", study_name(s),
                    i);
  }
  return 0;
}

/* --- resolving --- */

static int find_motion(const study *s, const study_values *v, stored_motion *m, message *why) {
  const double special = value_number(v, KEY_RESTART_SPECIAL, 0), point = value_number(v, KEY_RESTART_POINT, 0);
  const stored_where where = {.path = value_word(v, KEY_RESTART_FILE),
                              .task = (uint64_t)value_number(v, KEY_RESTART_TASK, 0),
                              .index = (uint64_t)(special >= 0 ? special : point),
                              .special = special >= 0};
  const int code = read_stored_motion(&where, m, why);
  return code ? code : check_sides(s, v, m, why);
}

/* Parses the study again, with the assignments from the motion. */
static int parse_again(const study *s, const study_values *v, const stored_motion *m, study_source from, study **out,
                       message *why) {
  assignments t = {.count = 0};
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

int branch_resolve(study **s, const study_source *from, message *why) {
  if (!branch_restarts(*s))
    return 0;
  study *resolved = NULL;
  stored_motion m = {0};
  study_values *v = study_values_create(*s);
  int code = v ? find_motion(*s, v, &m, why) : refuse(why, EXIT_RUN, "%s: no memory for its values", study_name(*s));
  if (!code)
    code = parse_again(*s, v, &m, *from, &resolved, why);
  study_values_destroy(&v);
  stored_motion_clear(&m);
  study_destroy(s);
  *s = resolved;
  return code;
}
