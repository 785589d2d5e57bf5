/* Status codes, the error object and the poll callback.
 *
 * A function that can fail returns a ric_status and takes a `ric_error *` as its last parameter, which may be NULL.
 * Callers branch on the code; the sentence in the error object states the value received and what is allowed. The
 * library never prints, never exits and has no global state. An outcome is not an error: an orbit that is inadmissible
 * or singular is a result with a named reason (orbit.h). */
#ifndef RICOCHET_STATUS_H
#define RICOCHET_STATUS_H

#include <stddef.h>

#include "export.h"

RIC_BEGIN_DECLARATIONS

#define RIC_STATUS_LIST(X)                                                                                             \
  X(RIC_OK, "done")                                                                                                    \
  X(RIC_EINVAL, "invalid argument")                                                                                    \
  X(RIC_ENOMEM, "out of memory")                                                                                       \
  X(RIC_ELIMIT, "a size is beyond a limit of the method")                                                              \
  X(RIC_ENUMERIC, "a numerical kernel failed")                                                                         \
  X(RIC_ECALLBACK, "a callback of the user failed")                                                                    \
  X(RIC_ESTOPPED, "stopped by the poll callback")

typedef enum ric_status {
#define X(name, text) name,
  RIC_STATUS_LIST(X)
#undef X
} ric_status;

/** One sentence for a code, for example "out of memory". Never NULL. */
RIC_API const char *ric_status_text(ric_status status);

/** The caller's error object: what went wrong, with the value received. */
typedef struct ric_error {
  ric_status status;
  char message[256];
} ric_error;

/** Fills `error` (which may be NULL) and returns `status`: `return ric_fail(error, RIC_EINVAL, "gamma = %g, ...", g)`.
 */
RIC_API ric_status ric_fail(ric_error *error, ric_status status, const char *format, ...)
#if defined(__GNUC__) || defined(__clang__)
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/** How often calls of this thread have met RIC_ENOMEM so far, also where the result says it in another way: as an
 * outcome, a verdict, an edge that was not found. A caller whose results must not depend on the memory of the moment
 * compares the number before and after. */
RIC_API unsigned long ric_memory_refusals(void);

/** Returns the status of a failed call to the caller; for functions that own nothing. */
#define RIC_TRY(call)                                                                                                  \
  do {                                                                                                                 \
    ric_status ric_try_status = (call);                                                                                \
    if (ric_try_status != RIC_OK)                                                                                      \
      return ric_try_status;                                                                                           \
  } while (0)

/** Called at least once per flow step or matrix factorisation of a long computation, so that the caller can check
 *  signals, time limits and messages. Non-zero stops the computation with RIC_ESTOPPED. */
typedef struct ric_poll {
  int (*call)(void *user); /* NULL: never called */
  void *user;
} ric_poll;

/** Calls the poll callback; non-zero: stop. */
static inline int ric_poll_stops(ric_poll poll) {
  return poll.call != NULL && poll.call(poll.user) != 0;
}

RIC_END_DECLARATIONS

#endif
