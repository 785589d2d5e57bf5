/* Attractors: what iterates do in the long run.
 *
 * The iterates are those of a map (map_runner below) or the crossings of a motion with a section (motion_section.h).
 * From a start, `transient` of them are left out; `keep` that follow are stored; over `measure` that follow the
 * transient, the stored ones among them, exponents and impacts are averaged; then come 2 period_limit more that decide
 * whether the attractor is periodic.
 *
 * It has the period p when in all of those last ones each number returns after p iterates to where it was, within
 * period_tol of its extent in them, and does not part: what it is off does not grow from one time to the next at the
 * same place of the cycle; both but for rounding, of maps 1e-12 and of motions 1e-9 of the largest number. The smallest
 * p up to the limit counts; or half of it, where what the iterates are off after p / 2 shrinks to nothing as well:
 * motions that come to a cycle slowly, from alternating sides, return after two of its periods first. Near the edge of
 * a window motions come to their attractor, or leave what was one, arbitrarily slowly: there a period found on the
 * attractor is not proof, and none found neither; edges are exact by cycle_window.h and motion_window.h. */
#ifndef RICOCHET_ATTRACTOR_H
#define RICOCHET_ATTRACTOR_H

#include <stdbool.h>
#include <stddef.h>

#include "grazing_map.h"
#include "status.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_attractor_options {
  size_t transient;    /* iterates left out, default 9000 */
  size_t keep;         /* iterates stored, default 1000; 0: none */
  size_t measure;      /* iterates over which exponents and impacts are averaged, >= 1 and >= keep; default 1000 */
  size_t observe;      /* which number of the state `values` are, default 0 */
  size_t exponents;    /* Lyapunov exponents wanted, at most the size of the state; default 0: none */
  size_t period_limit; /* longest period looked for, 1 to 100000; default 64 */
  double period_tol;   /* default 1e-6 */
  double bound;        /* a state with a number beyond it has diverged; default 1e100 */
  ric_poll poll;       /* asked at least each millisecond of work */
} ric_attractor_options;

RIC_API ric_attractor_options ric_attractor_options_default(void);

/** @param size  of the state  @returns RIC_EINVAL naming the option that is out of range */
RIC_API ric_status ric_attractor_options_check(const ric_attractor_options *options, size_t size, ric_error *error);

#define RIC_ATTRACTOR_LIST(X)                                                                                          \
  X(RIC_ATTRACTOR_PERIODIC, "periodic")                                                                                \
  X(RIC_ATTRACTOR_APERIODIC, "aperiodic") /* no period up to the limit */                                              \
  X(RIC_ATTRACTOR_DIVERGED, "diverged")                                                                                \
  X(RIC_ATTRACTOR_FAILED, "failed") /* a motion could not go on: the reason says why */

typedef enum ric_attractor_kind {
#define X(name, text) name,
  RIC_ATTRACTOR_LIST(X)
#undef X
      RIC_ATTRACTOR_KINDS
} ric_attractor_kind;

/** Name of a kind, "periodic". Never NULL. */
RIC_API const char *ric_attractor_kind_name(ric_attractor_kind kind);

/** One run to an attractor. The arrays are the caller's. */
typedef struct ric_attractor {
  double *z;      /* [size] start; set to the last of the `measure` iterates, from which a run at a neighbouring
                     parameter may go on. Of a run that diverged or failed: the last state that was in order */
  double *values; /* [keep] set to the stored iterates of the observed number, NaN where there are none; or NULL */
  double *states; /* [keep][size] the same of all numbers; or NULL */
  double *lowest; /* [size] set to that of the last 2 period_limit + 1 iterates whose observed number is smallest, the
                     first of them: of a periodic attractor always the same state; NaN when diverged or failed; or
                     NULL */
  double *exponents; /* [exponents] set, natural logarithm per iterate, largest first as a rule; NaN where they are not
                        known; without meaning where options.exponents is 0 */
  ric_attractor_kind kind;
  size_t period;  /* 0: none found */
  double impacts; /* per iterate, on the average; NaN when diverged or failed before any was counted */
  size_t
      iterates; /* done when the run diverged or failed, to the nearest stride of looking; else transient + measure */
  char reason[128]; /* "" when periodic or aperiodic */
} ric_attractor;

/** Distance of two attractors by as many observed values of each: the Hausdorff distance of the two sets, over the
 *  extent of the second. It is how far the value is off that is farthest from all of the other set.
 *  @param a, b  [count] values; sorted here
 *  @returns NaN where a value is not finite; where b has no extent NaN or infinity */
RIC_API double ric_attractor_distance(double *a, double *b, size_t count);

/* --- of maps ------------------------------------------------------------------------------------------------------ */

/* Many maps side by side in vector lanes. A value's iterates are the same operations in the same order in every variant
 * and whichever values are beside it, so results are the same bits. An iterate that is not exactly the one of
 * ric_grazing_map_step differs from it by rounding only. */

#define RIC_MAP_LANES_LIST(X)                                                                                          \
  X(RIC_MAP_LANES_ONE, "one")     /* plain C, one value after another */                                               \
  X(RIC_MAP_LANES_FOUR, "four")   /* AVX2 */                                                                           \
  X(RIC_MAP_LANES_EIGHT, "eight") /* AVX-512 */

typedef enum ric_map_lanes {
#define X(name, text) name,
  RIC_MAP_LANES_LIST(X)
#undef X
      RIC_MAP_LANES_KINDS
} ric_map_lanes;

/** Name of a variant, "four". Never NULL. */
RIC_API const char *ric_map_lanes_name(ric_map_lanes lanes);
/** Whether this processor has it; RIC_MAP_LANES_ONE is always there. */
RIC_API bool ric_map_lanes_available(ric_map_lanes lanes);
/** The widest one that is available. */
RIC_API ric_map_lanes ric_map_lanes_widest(void);
/** The one that is fastest on this processor for maps of a size: wider is not always faster. Each is run a few times on
 * a trial map, a few milliseconds in all.
 *  @param exponents  Lyapunov exponents that are wanted, at most the size
 *  @param now  the caller's clock, in seconds from any time; NULL: the widest, untried
 *  @returns the narrowest where there is no memory for a trial */
RIC_API ric_map_lanes ric_map_lanes_fastest(size_t size, size_t exponents, double (*now)(void *user), void *user);

typedef struct ric_map_runner ric_map_runner;

/** @param size  of the maps, >= 1
 *  @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL for options out of range and variants that are not available; RIC_ENOMEM */
RIC_API ric_status ric_map_runner_create(size_t size, const ric_attractor_options *options, ric_map_lanes lanes,
                                         ric_map_runner **runner, ric_error *error);
RIC_API void ric_map_runner_destroy(ric_map_runner **runner);

/** Runs maps to their attractors; allocates nothing. Whether one has diverged is looked at every 64 iterates, and where
 * storing and measuring end. What is left of a transient is not computed once a value and those beside it have come to
 * cycles that are exact to the bit: that changes no result. Zeros of states are +0.
 *
 * Exponents come from tangent vectors made orthogonal after every iterate, which find their places in the last 256
 * iterates of the transient: directions that one iterate parts by less than 1e13 are told apart, to that ratio times
 * the rounding. One of which less than 1e-13 is left outside the span of those before it has been put out, and has
 * -INFINITY. Of a motion that comes exactly to the border, where the derivative is infinite, all are NaN.
 *  @param maps  [count] of the runner's size; may be the same one several times
 *  @param d  [count]
 *  @param attractors  [count] with their starts; set
 *  @returns RIC_EINVAL naming the map or d that is not finite (ric_grazing_map_check), and starts that are not;
 *           RIC_ESTOPPED */
RIC_API ric_status ric_map_runner_run(ric_map_runner *runner, size_t count, const ric_grazing_map *const *maps,
                                      const double *d, ric_attractor *attractors, ric_error *error);

RIC_END_DECLARATIONS

#endif
