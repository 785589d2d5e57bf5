/* Attractors: what iterates converge to in the long run.
 *
 * The iterates are those of a map (ric_map_runner below) or the crossings of a motion with a Poincare section
 * (motion_section.h). A run discards `transient` iterates and stores the `keep` iterates that follow. Exponents and
 * impacts are averaged over the `measure` iterates after the transient, which include the stored ones. Another 2
 * period_limit iterates then decide whether the attractor is periodic. If it is, exponents and impacts are those of one
 * period: the logarithm of the modulus of a multiplier over the period.
 *
 * The attractor has period p when, in all of these last iterates,
 *
 *   - each number of the state returns after p iterates to within period_tol times its extent in them, and
 *   - the deviation from period p is not growing from one period to the next at the same phase of the cycle.
 *
 * Both hold up to rounding, 1e-12 of the largest number for maps and 1e-9 for motions. The smallest p up to the limit
 * is reported. Half of it is reported if the deviation from period p / 2 shrinks to zero, too: a motion that
 * approaches a cycle slowly from alternating sides returns first after two of its periods.
 *
 * Near the edge of a window convergence to an attractor, and departure from a former one, are arbitrarily slow. There
 * a period that is found, or not found, on the attractor proves nothing. cycle_window.h and motion_window.h locate
 * edges exactly. */
#ifndef RICOCHET_ATTRACTOR_H
#define RICOCHET_ATTRACTOR_H

#include <stdbool.h>
#include <stddef.h>

#include "grazing_map.h"
#include "status.h"

RIC_BEGIN_DECLARATIONS

typedef struct ric_attractor_options {
  size_t transient;    /* iterates discarded, default 9000 */
  size_t keep;         /* iterates stored, default 1000; 0: none */
  size_t measure;      /* iterates over which exponents and impacts are averaged, >= 1 and >= keep; default 1000 */
  size_t observe;      /* which number of the state `values` are, default 0 */
  size_t exponents;    /* Lyapunov exponents wanted, at most the size of the state; default 0: none */
  size_t period_limit; /* longest period tested, 1 to 100000; default 64 */
  double period_tol;   /* default 1e-6 */
  double bound;        /* a state with a number beyond it has diverged; default 1e100 */
  ric_poll poll;       /* called at least once per millisecond of work */
} ric_attractor_options;

RIC_API ric_attractor_options ric_attractor_options_default(void);

/** @param size  of the state  @returns RIC_EINVAL naming the option that is out of range */
RIC_API ric_status ric_attractor_options_check(const ric_attractor_options *options, size_t size, ric_error *error);

#define RIC_ATTRACTOR_LIST(X)                                                                                          \
  X(RIC_ATTRACTOR_PERIODIC, "periodic")                                                                                \
  X(RIC_ATTRACTOR_APERIODIC, "aperiodic") /* no period up to the limit */                                              \
  X(RIC_ATTRACTOR_DIVERGED, "diverged")                                                                                \
  X(RIC_ATTRACTOR_FAILED, "failed") /* a motion could not be continued: the reason says why */

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
  double *z; /* [size] start; set to the last of the `measure` iterates, from which a run at a neighbouring parameter
                can start. If the run diverged or failed: the last valid state */
  double *values; /* [keep] set to the stored iterates of the observed number, NaN where missing; or NULL */
  double *states; /* [keep][size] the same of all numbers; or NULL */
  double *lowest; /* [size] set to the first of the last 2 period_limit + 1 iterates whose observed number is smallest:
                     on a periodic attractor always the same state; NaN when diverged or failed; or NULL */
  double *exponents; /* [exponents] set, natural logarithm per iterate, usually largest first; NaN where unknown; unused
                        if options.exponents is 0 */
  ric_attractor_kind kind;
  size_t period;    /* 0: none found */
  double impacts;   /* mean per iterate; NaN when diverged or failed before any was counted */
  size_t iterates;  /* computed when the run diverged or failed, up to the interval of the tests; else transient +
                       measure */
  char reason[128]; /* "" when periodic or aperiodic */
} ric_attractor;

/** Distance of two attractors from equal numbers of observed values: the Hausdorff distance of the two sets, divided by
 *  the extent of the second. It is the largest distance of a value from the other set.
 *  @param a, b  [count] values; sorted here
 *  @returns NaN if a value is not finite; NaN or infinity if b has no extent */
RIC_API double ric_attractor_distance(double *a, double *b, size_t count);

/* --- of maps ------------------------------------------------------------------------------------------------------ */

/* Many maps side by side in SIMD lanes. Every variant applies the same operations in the same order to a value,
 * whichever values share the register, so results are equal in every bit. An iterate may differ from that of
 * ric_grazing_map_step by rounding. */

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
/** Whether this processor supports the variant; RIC_MAP_LANES_ONE is always available. */
RIC_API bool ric_map_lanes_available(ric_map_lanes lanes);
/** The widest available variant. */
RIC_API ric_map_lanes ric_map_lanes_widest(void);
/** The variant that is fastest on this processor for maps of a size: wider is not always faster. Each variant runs a
 * few times on a trial map, a few milliseconds in total.
 *  @param exponents  number of Lyapunov exponents, at most the size
 *  @param now  the caller's clock in seconds, with any origin; NULL: the widest, without a trial
 *  @returns the narrowest without memory for a trial; the widest if a trial would take long */
RIC_API ric_map_lanes ric_map_lanes_fastest(size_t size, size_t exponents, double (*now)(void *user), void *user);

typedef struct ric_map_runner ric_map_runner;

/** @param size  of the maps, >= 1
 *  @param options  copied, NULL for the defaults
 *  @returns RIC_EINVAL for options out of range and variants that are not available; RIC_ENOMEM */
RIC_API ric_status ric_map_runner_create(size_t size, const ric_attractor_options *options, ric_map_lanes lanes,
                                         ric_map_runner **runner, ric_error *error);
RIC_API void ric_map_runner_destroy(ric_map_runner **runner);

/** Runs maps to their attractors; allocates nothing. Divergence is tested every 64 iterates, and where storing and
 *  measuring end. The rest of a transient is skipped once a value, and those in the same register, repeat bit for bit:
 *  that changes no result. Zeros of states are +0.
 *
 *  Exponents come from tangent vectors that are made orthogonal after every iterate; they align during the last 256
 *  iterates of the transient. Exponents are accurate to (growth ratio per iterate) x eps; ratios above 1e13 are not
 *  resolved. If less than 1e-13 of a vector lies outside the span of those before it, its direction is lost: its
 *  exponent is -INFINITY. If an iterate is exactly at the border, where the derivative is infinite, all exponents are
 *  NaN.
 *  @param maps  [count] of the runner's size; the same map may occur several times
 *  @param d  [count]
 *  @param attractors  [count] with their starts in z; set
 *  @returns RIC_EINVAL naming the map (ric_grazing_map_check), d or start that is not finite; RIC_ESTOPPED */
RIC_API ric_status ric_map_runner_run(ric_map_runner *runner, size_t count, const ric_grazing_map *const *maps,
                                      const double *d, ric_attractor *attractors, ric_error *error);

RIC_END_DECLARATIONS

#endif
