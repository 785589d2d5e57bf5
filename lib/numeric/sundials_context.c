#include "sundials_context.h"

#include <stdint.h>
#include <stdlib.h>

enum { HEADS = 1 << 16 }; /* bytes of what SUNDIALS makes beside the numbers of its vectors */

bool sundials_has_room(size_t numbers) {
  void *room = numbers < (SIZE_MAX - HEADS) / sizeof(double) ? malloc(numbers * sizeof(double) + HEADS) : NULL;
  free(room);
  return room != NULL;
}

#if SUNDIALS_VERSION_MAJOR >= 7
int sundials_context_create(SUNContext *context) {
  return SUNContext_Create(SUN_COMM_NULL, context) || SUNContext_ClearErrHandlers(*context);
}
#else
int sundials_context_create(SUNContext *context) {
  return SUNContext_Create(NULL, context);
}

void sundials_say_nothing(int code, const char *module, const char *function, char *message, void *user) {
  (void)code, (void)module, (void)function, (void)message, (void)user;
}
#endif
