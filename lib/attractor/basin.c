/* Basins of attraction. */
#include "ricochet/basin.h"
#include "numeric/required.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct ric_basin {
  ric_basin_options options;
  size_t size, added, count, room;
  ric_basin_attractor *attractors; /* [room]; the basin owns their states */
};

ric_basin_options ric_basin_options_default(void) {
  return (ric_basin_options){.limit = 1000, .same_tol = 1e-4};
}

ric_status ric_basin_create(size_t size, const ric_basin_options *options, ric_basin **basin, ric_error *error) {
  REQUIRE(error, {"basin", basin});
  const ric_basin_options o = options ? *options : ric_basin_options_default();
  *basin = NULL;
  if (size == 0 || o.limit == 0 || !(o.same_tol >= 0))
    return ric_fail(error, RIC_EINVAL, "size = %zu, limit = %zu, same_tol = %g, expected at least 1, 1 and 0", size,
                    o.limit, o.same_tol);
  *basin = calloc(1, sizeof **basin);
  if (!*basin)
    return ric_fail(error, RIC_ENOMEM, "no memory for a basin");
  **basin = (ric_basin){.options = o, .size = size};
  return RIC_OK;
}

void ric_basin_destroy(ric_basin **basin) {
  if (!basin || !*basin)
    return;
  for (size_t i = 0; i < (*basin)->count; i++)
    free((double *)(*basin)->attractors[i].lowest);
  free((*basin)->attractors);
  free(*basin);
  *basin = NULL;
}

static bool is_same(const ric_basin *basin, const double *a, const double *b) {
  double apart = 0, largest = 0;
  for (size_t i = 0; i < basin->size; i++) {
    apart = fmax(apart, fabs(a[i] - b[i]));
    largest = fmax(largest, fmax(fabs(a[i]), fabs(b[i])));
  }
  return apart <= basin->options.same_tol * largest;
}

/* Index of the attractor of a run; the number of known ones if it is new. */
static size_t find_attractor(const ric_basin *basin, const ric_attractor *run, size_t period) {
  size_t i = 0;
  for (; i < basin->count; i++) {
    const ric_basin_attractor *known = &basin->attractors[i];
    if (known->period == period && (period == 0 || is_same(basin, run->lowest, known->lowest)))
      break;
  }
  return i;
}

static bool grow(ric_basin *basin) {
  const size_t room = basin->room ? 2 * basin->room : 8;
  if (basin->count < basin->room)
    return true;
  ric_basin_attractor *more = realloc(basin->attractors, room * sizeof *more);
  if (!more)
    return false;
  basin->attractors = more;
  basin->room = room;
  return true;
}

static ric_status add_attractor(ric_basin *basin, const ric_attractor *run, size_t period, ric_error *error) {
  double *lowest = malloc(basin->size * sizeof *lowest);
  if (!lowest || !grow(basin)) {
    free(lowest);
    return ric_fail(error, RIC_ENOMEM, "no memory for %zu attractors", basin->count + 1);
  }
  for (size_t i = 0; i < basin->size; i++)
    lowest[i] = run->lowest ? run->lowest[i] : NAN;
  basin->attractors[basin->count++] = (ric_basin_attractor){.period = period, .first = basin->added, .lowest = lowest};
  return RIC_OK;
}

static size_t period_of(const ric_attractor *run) {
  return run->kind == RIC_ATTRACTOR_PERIODIC ? run->period : 0;
}

int64_t ric_basin_label(const ric_basin *basin, const ric_attractor *run) {
  if (run->kind != RIC_ATTRACTOR_PERIODIC && run->kind != RIC_ATTRACTOR_APERIODIC)
    return RIC_BASIN_NONE;
  const size_t i = find_attractor(basin, run, period_of(run));
  return i < basin->count ? (int64_t)i : RIC_BASIN_OTHER;
}

ric_status ric_basin_add(ric_basin *basin, const ric_attractor *run, int64_t *label, ric_error *error) {
  REQUIRE(error, {"basin", basin}, {"run", run}, {"label", label});
  const size_t period = period_of(run);
  if (run->kind == RIC_ATTRACTOR_PERIODIC && !run->lowest)
    return ric_fail(error, RIC_EINVAL, "a run of period %zu without its lowest state", period);
  int64_t found = ric_basin_label(basin, run);
  if (found == RIC_BASIN_OTHER && basin->count < basin->options.limit) {
    found = (int64_t)basin->count;
    RIC_TRY(add_attractor(basin, run, period, error));
  }
  if (found >= 0)
    basin->attractors[found].starts++;
  basin->added++;
  *label = found;
  return RIC_OK;
}

size_t ric_basin_count(const ric_basin *basin) {
  return basin->count;
}

ric_basin_attractor ric_basin_at(const ric_basin *basin, size_t index) {
  return basin->attractors[index];
}
