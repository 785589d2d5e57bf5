#include "resonant.h"

#include <math.h>

#include "model/image_ring.h"
#include "numeric/constants.h"

/* Wave index (a real number) at which the image ring has a frequency, clamped to the band. */
static double wave_index(const ric_chain *chain, double frequency) {
  double s2 = (frequency * frequency - 1) / (4 * image_ring_gamma(chain));
  return asin(sqrt(fmin(fmax(s2, 0), 1))) / pi * (double)image_ring_sites(chain);
}

static size_t add_wave(const ric_chain *chain, size_t wave, unsigned harmonic, border_mode *modes, size_t count) {
  size_t pair[2], members = response_modes(chain, wave, pair);
  for (size_t i = 0; i < members && count < BORDER_MODES; i++)
    modes[count++] = (border_mode){.mode = pair[i], .harmonic = harmonic};
  return count;
}

size_t resonant_modes(const ric_chain *chain, double period, double tolerance, border_mode *modes) {
  double turns = period / (2 * pi), fastest = ric_chain_frequency_max(chain) * turns;
  double first_wave = chain->ends == RIC_ENDS_FIXED ? 1 : 0;
  double last_wave =
      chain->ends == RIC_ENDS_PERIODIC ? (double)(chain->particles / 2) : (double)(chain->particles - 1) + first_wave;
  size_t count = 0;
  for (double l = fmax(1, ceil(turns - tolerance)); l <= fastest + tolerance; l++) {
    double low = floor(wave_index(chain, (l - tolerance) / turns)) - 1;
    double high = ceil(wave_index(chain, (l + tolerance) / turns)) + 1;
    if (image_ring_gamma(chain) == 0) {
      low = first_wave;
      high = last_wave;
    }
    for (double j = fmax(low, first_wave); j <= fmin(high, last_wave) && count < BORDER_MODES; j++) {
      double p = 2 * pi * j / (double)image_ring_sites(chain);
      if (fabs(ric_dispersion(image_ring_gamma(chain), p) * turns - l) <= tolerance)
        count = add_wave(chain, (size_t)j, (unsigned)l, modes, count);
    }
  }
  return count;
}

ric_status resonant_free(const unit_cell *whole, const border_mode *modes, size_t count, bool *free_amplitude,
                         size_t *hidden, ric_error *error) {
  size_t visible, least_rank = 1;
  *free_amplitude = false;
  *hidden = 0;
  if (count == 0)
    return RIC_OK;
  RIC_TRY(contact_visible(whole, modes, count, NULL, &visible, error));
  *free_amplitude = visible < count;
  for (size_t i = 0; *free_amplitude && least_rank == 1 && i < count; i++) {
    RIC_TRY(contact_visible(whole, &modes[i], 1, NULL, &least_rank, error));
    if (least_rank == 0)
      *hidden = i;
  }
  return RIC_OK;
}

/* Combination v of the modes at a contact. */
static double combined(const unit_cell *whole, const border_mode *modes, size_t count, const double *rotation, size_t v,
                       const contact *k) {
  double u = 0;
  for (size_t a = 0; a < count; a++)
    u += rotation[a * count + v] * contact_shape(whole, &modes[a], k);
  return u;
}

/* The visible combinations are orthogonal at the contacts: the floors less their projections must vanish. */
ric_status resonant_carries(const unit_cell *whole, const border_mode *modes, size_t count, bool *carries,
                            ric_error *error) {
  double rotation[BORDER_MODES * BORDER_MODES], all = 0, reached = 0;
  size_t visible;
  RIC_TRY(contact_visible(whole, modes, count, rotation, &visible, error));
  for (size_t k = 0; k < whole->impacts; k++) {
    double b = ric_chain_floor(&whole->chain, whole->contacts[k].site);
    all += b * b;
  }
  for (size_t v = 0; v < visible; v++) {
    double along = 0, square = 0;
    for (size_t k = 0; k < whole->impacts; k++) {
      double u = combined(whole, modes, count, rotation, v, &whole->contacts[k]);
      along += u * ric_chain_floor(&whole->chain, whole->contacts[k].site);
      square += u * u;
    }
    reached += along * along / square;
  }
  *carries = all - reached <= 1e-12 * all; /* squares: a millionth of the floors, far above rounding */
  return RIC_OK;
}

size_t resonant_dominant(const ric_chain *chain, const border_mode *modes, size_t count, const double *q) {
  size_t dominant = 0;
  double largest = -1;
  for (size_t a = 0; a < count; a++) {
    double amplitude = 0;
    for (size_t i = 0; i < chain->particles; i++)
      amplitude += q[i] * ric_chain_mode_shape(chain, modes[a].mode, i);
    if (fabs(amplitude) > largest) {
      largest = fabs(amplitude);
      dominant = a;
    }
  }
  return dominant;
}
