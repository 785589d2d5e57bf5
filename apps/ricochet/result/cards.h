/* Cards of grazing motions: what `show` says of the first tasks of kind `grazing` in sentences. */
#ifndef RICOCHET_APP_CARDS_H
#define RICOCHET_APP_CARDS_H

#include "hdf5_call.h"

/** Prints the cards; nothing for results of other kinds. @returns 0 or EXIT_FILES, EXIT_RUN */
int grazing_cards_show(const place *at, hid_t file);

/* Cards of diagrams and basins: what `show` says of their attractors in sentences. */

/** Prints the card; nothing for results of other kinds. @returns 0 or EXIT_FILES, EXIT_RUN */
int diagram_card_show(const place *at, hid_t file);

#endif
