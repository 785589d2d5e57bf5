#include "map_model.h"

/* A list of the study; where it is empty, the zeros stay. */
static void read_list(double *to, const study_values *v, study_key key) {
  for (size_t i = 0; i < value_count(v, key); i++)
    to[i] = value_number(v, key, i);
}

static ric_status read_lists(ric_grazing_map *map, const study_values *v, ric_error *error) {
  RIC_TRY(ric_grazing_map_init(map, value_count(v, KEY_MODEL_ETA), error));
  read_list(map->L, v, KEY_MODEL_L);
  read_list(map->eta, v, KEY_MODEL_ETA);
  read_list(map->xi, v, KEY_MODEL_XI);
  read_list(map->kappa, v, KEY_MODEL_KAPPA);
  return RIC_OK;
}

ric_status map_model_read(ric_grazing_map *map, const study_values *v, ric_error *error) {
  ric_grazing_map_clear(map);
  if (value_count(v, KEY_MODEL_ETA) > 0)
    RIC_TRY(read_lists(map, v, error));
  else
    RIC_TRY(
        ric_grazing_map_example(map, value_number(v, KEY_MODEL_LAMBDA, 0), value_number(v, KEY_MODEL_OMEGA, 0), error));
  map->stretch = value_number(v, KEY_MODEL_STRETCH, 0);
  return ric_grazing_map_check(map, error);
}
