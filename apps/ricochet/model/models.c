/* The list of types of model, and their keys. */
#include "model.h"

#include "study/keys.h"

/* A type of model is a file and a word here; its keys, if it has any of its own, a line in models.inc. */
#define MODELS(MODEL) MODEL(chain) MODEL(duffing_chain) MODEL(grazing_map)

#define DECLARE(name) extern const model_type model_##name;
MODELS(DECLARE)

#define CHOICE(name) &model_##name.choice,
const schema_choice *const models[] = {MODELS(CHOICE) NULL};

#define NAME(name)  "|" #name
#define MODEL_NAMES (&(MODELS(NAME))[1])

#define KEY KEY_DEFINE
#include "models.inc"
#undef KEY

const model_type *model_of(const study *s) {
  return (const model_type *)study_model_choice(s);
}

bool model_has(const study *s, unsigned feature) {
  const schema_choice *model = study_model_choice(s);
  return model && (model->features & feature) != 0;
}
