/* A context of SUNDIALS that prints nothing, for its versions 6 and 7: internal to the library. */
#ifndef RICOCHET_SUNDIALS_CONTEXT_H
#define RICOCHET_SUNDIALS_CONTEXT_H

#include <stdbool.h>
#include <stddef.h>

#include <sundials/sundials_config.h>
#include <sundials/sundials_context.h>

#ifndef SUNDIALS_DOUBLE_PRECISION
#error "SUNDIALS must be built for double precision"
#endif

/** @returns 0, or non-zero on failure. Free it with SUNContext_Free. */
int sundials_context_create(SUNContext *context);

/** Whether there is room for so many numbers, in vectors that SUNDIALS is about to make: it does not survive that one
 * of them fails. */
bool sundials_has_room(size_t numbers);

#if SUNDIALS_VERSION_MAJOR < 7
/** The error handler of solvers of version 6; in version 7 the context has it. */
void sundials_say_nothing(int code, const char *module, const char *function, char *message, void *user);
#endif

#endif
