#include <string.h>

#include "ricochet/trajectory.h"

/* Position of a time in a piece. */
static double position(const ric_segment *piece, double time) {
  double x = (time - piece->start) / piece->length;
  return x < 0 ? 0 : x > 1 ? 1 : x;
}

static void fill(const ric_sampler *s, const ric_segment *piece, size_t k) {
  size_t speeds = piece->speeds ? piece->speeds : piece->coordinates;
  double *u = s->u && s->speeds ? s->u + k * s->speeds + (speeds == piece->coordinates ? piece->first : 0) : NULL;
  ric_segment_state(piece, position(piece, s->times[k]), s->q + k * s->coordinates + piece->first, u);
}

/* Times in [start, end of the part): the end itself belongs to what comes after. */
int ric_sampler_segment(const ric_segment *piece, double end, void *sampler) {
  ric_sampler *s = sampler;
  double until = piece->start + end * piece->length;
  size_t k = s->next;
  for (; k < s->count && s->times[k] < until; k++)
    fill(s, piece, k);
  if (piece->first + piece->coordinates == s->coordinates) /* the last piece of the step */
    s->next = k;
  return 0;
}

void ric_sampler_finish(ric_sampler *sampler, const ric_trajectory *trajectory) {
  const double *q = ric_trajectory_q(trajectory), *u = ric_trajectory_u(trajectory);
  for (; sampler->next < sampler->count && sampler->times[sampler->next] <= ric_trajectory_time(trajectory);
       sampler->next++) {
    memcpy(sampler->q + sampler->next * sampler->coordinates, q, sampler->coordinates * sizeof *q);
    if (sampler->u && sampler->speeds)
      memcpy(sampler->u + sampler->next * sampler->speeds, u, sampler->speeds * sizeof *u);
  }
}
