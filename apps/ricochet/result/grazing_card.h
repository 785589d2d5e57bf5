/* Cards of grazing motions: what `show` says of the first tasks of kind `grazing` in sentences. */
#ifndef RICOCHET_APP_GRAZING_CARD_H
#define RICOCHET_APP_GRAZING_CARD_H

#include "hdf5_call.h"

/** Prints the cards; nothing for results of other kinds. @returns 0 or EXIT_FILES, EXIT_RUN */
int grazing_cards_show(const place *at, hid_t file);

#endif
