/* Cards of diagrams and basins: what `show` says of their attractors in sentences. */
#ifndef RICOCHET_APP_DIAGRAM_CARD_H
#define RICOCHET_APP_DIAGRAM_CARD_H

#include "hdf5_call.h"

/** Prints the card; nothing for results of other kinds. @returns 0 or EXIT_FILES, EXIT_RUN */
int diagram_card_show(const place *at, hid_t file);

#endif
