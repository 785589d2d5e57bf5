/* The studies that the program ships, compiled in from data/studies. */
#ifndef RICOCHET_APP_EXAMPLES_H
#define RICOCHET_APP_EXAMPLES_H

typedef struct example {
  const char *name; /* file name without .yaml */
  const char *text;
} example;

/** Ends with a NULL name. */
extern const example examples[];

#endif
