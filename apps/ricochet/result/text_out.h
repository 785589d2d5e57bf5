/* The end of what is printed on standard output. */
#ifndef RICOCHET_APP_TEXT_OUT_H
#define RICOCHET_APP_TEXT_OUT_H

#include "../base/message.h"

/** Flushes standard output. @returns `code`, or EXIT_FILES when that is 0 and something could not be printed. */
int text_out_finish(int code, message *why);

#endif
