/* The keys of all kinds of study. */
#ifndef RICOCHET_APP_KIND_KEYS_H
#define RICOCHET_APP_KIND_KEYS_H

#include "model/model.h"

#define KEY(name, ...) extern const schema_entry name[1];
#include "top.inc"
#include "keys.inc"
#undef KEY

#endif
