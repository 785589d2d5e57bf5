/* What stands under a name, without following links: a run replaces and removes regular files and folders of its own,
 * nothing else. */
#ifndef RICOCHET_APP_FILE_KIND_H
#define RICOCHET_APP_FILE_KIND_H

#include "message.h"

typedef enum file_kind { FILE_ABSENT, FILE_REGULAR, FILE_FOLDER, FILE_LINK, FILE_OTHER } file_kind;

/** What it is; FILE_ABSENT also where the system does not say. */
file_kind file_kind_of(const char *path);

/** Refuses everything but an absent name and one of the wanted kind. @returns 0 or EXIT_USAGE */
int file_kind_expect(const char *path, file_kind wanted, message *why);

#endif
