/* model.type: grazing_map, the return map near a grazing motion: given by its lists, or the example (6.1)-(6.5) of
 * [FN97]. */
#include "grazing_map.h"

/* Copies a list of the study; an empty one leaves zeros. */
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

ric_status grazing_map_read(ric_grazing_map *map, const study_values *v, ric_error *error) {
  ric_grazing_map_clear(map);
  if (value_count(v, KEY_MODEL_ETA) > 0)
    RIC_TRY(read_lists(map, v, error));
  else
    RIC_TRY(
        ric_grazing_map_example(map, value_number(v, KEY_MODEL_LAMBDA, 0), value_number(v, KEY_MODEL_OMEGA, 0), error));
  map->stretch = value_number(v, KEY_MODEL_STRETCH, 0);
  return ric_grazing_map_check(map, error);
}

/* --- its keys --- */

static bool is_listed(const study *s) {
  return study_value(s, KEY_MODEL_ETA)->count > 0 || study_value(s, KEY_MODEL_L)->count > 0;
}

size_t grazing_map_size(const study *s) {
  return is_listed(s) ? study_value(s, KEY_MODEL_ETA)->count : 3;
}

static int check_length(const study *s, const document *d, study_key key, size_t length, message *why) {
  const typed_value *list = study_value(s, key);
  if (list->count == length)
    return 0;
  const int node = list->node                            ? list->node
                   : study_value(s, KEY_MODEL_ETA)->node ? study_value(s, KEY_MODEL_ETA)->node
                                                         : study_value(s, KEY_MODEL_L)->node;
  return document_refuse(d, node, why, "%s has %zu elements, expected %zu: model.eta has %zu", key->path, list->count,
                         length, study_value(s, KEY_MODEL_ETA)->count);
}

static int check_lists(const study *s, const document *d, message *why) {
  static const study_key alone[] = {KEY_MODEL_LAMBDA, KEY_MODEL_OMEGA};
  const size_t n = study_value(s, KEY_MODEL_ETA)->count;
  for (size_t i = 0; i < 2; i++)
    if (study_has(s, alone[i]))
      return document_refuse(d, check_node_of_key(s, alone[i]), why,
                             "%s and model.L both give the map, expected one of the two", alone[i]->path);
  if (n == 0)
    return document_refuse(d, study_value(s, KEY_MODEL_L)->node, why,
                           "model.eta is empty, expected the vector of the map");
  int code = check_length(s, d, KEY_MODEL_L, n * n, why);
  if (!code)
    code = check_length(s, d, KEY_MODEL_XI, n, why);
  if (!code && study_value(s, KEY_MODEL_KAPPA)->count > 0)
    code = check_length(s, d, KEY_MODEL_KAPPA, n, why);
  return code;
}

static int check(const study *s, const document *d, message *why) {
  if (is_listed(s))
    return check_lists(s, d, why);
  if (study_has(s, KEY_MODEL_LAMBDA) && study_has(s, KEY_MODEL_OMEGA))
    return 0;
  return check_refuse(s, why, "missing key %s: a map is given by lambda and omega, or by L, eta and xi",
                      study_has(s, KEY_MODEL_LAMBDA) ? "model.omega" : "model.lambda");
}

const model_type model_grazing_map = {.choice = {.name = "grazing_map",
                                                 .summary = "the return map beside a grazing motion",
                                                 .groups = "grazing_map",
                                                 .features = MODEL_MAP,
                                                 .check = check}};
