#include "ricochet/event.h"

#include <stddef.h>

const char *ric_event_name(ric_event_kind kind) {
  static const char *const names[] = {
#define X(name, text) text,
      RIC_EVENT_LIST(X)
#undef X
  };
  return (unsigned)kind < RIC_EVENT_KINDS ? names[kind] : "unknown";
}
