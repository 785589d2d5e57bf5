/* A poll that says stop from its `limit`-th call on, and counts its calls. */
#ifndef RICOCHET_WITNESS_COUNTDOWN_H
#define RICOCHET_WITNESS_COUNTDOWN_H

typedef struct countdown {
  int calls, limit;
} countdown;

/** As the call of a ric_poll whose user is a countdown. */
static inline int count(void *user) {
  countdown *c = user;
  return ++c->calls >= c->limit;
}

#endif
