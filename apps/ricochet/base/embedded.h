/* Texts of files that are compiled in (cmake/embed_texts.cmake): studies, and chapters of the reference pages. */
#ifndef RICOCHET_APP_EMBEDDED_H
#define RICOCHET_APP_EMBEDDED_H

typedef struct embedded_text {
  const char *name; /* of the file, without its ending; NULL ends a list */
  const char *text;
} embedded_text;

/** The text of a name, NULL when the list has none. */
const char *embedded_find(const embedded_text *list, const char *name);

#endif
