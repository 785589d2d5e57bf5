/* Attributes of a result: scalars and fixed-length text, written and read back. */
#ifndef RICOCHET_APP_ATTRIBUTE_H
#define RICOCHET_APP_ATTRIBUTE_H

#include <stdint.h>

#include "hdf5_call.h"

/** So many attributes of an object stay in its header, which has a checksum; HDF5's dense form keeps values over 4 kB
 *  without one. */
enum { ATTRIBUTE_MOST_COMPACT = 64 };

/* Writing. @returns 0 or EXIT_FILES. */

/** Text of fixed length, which all readers support; ASCII, or UTF-8 if a byte needs it. NULL counts as "". */
int attribute_put_text(const file_place *at, hid_t object, const char *name, const char *text);
int attribute_put_integer(const file_place *at, hid_t object, const char *name, int64_t value);
int attribute_put_number(const file_place *at, hid_t object, const char *name, double value);
/** Text with a digest of its own beside it, "NAME_checksum": HDF5 keeps text of 64 kB or more without a checksum. */
int attribute_put_checked_text(const file_place *at, hid_t object, const char *name, const char *text);
/** A list of any type. @param count  at least 1 */
int attribute_put_list(const file_place *at, hid_t object, const char *name, hid_t file_type, hid_t memory_type,
                       size_t count, const void *values);

/** The file's type for text of `bytes` bytes, NUL padded, closed by the caller; negative on failure. */
hid_t attribute_text_type(size_t bytes, H5T_cset_t set);

/* Reading. @returns 0 or EXIT_FILES. */

/** @param text  set to malloc'd text with a terminating 0; the caller frees; NULL on failure */
int attribute_text(const file_place *at, hid_t object, const char *name, char **text);
/** Text written by attribute_put_checked_text, refused when it does not match its checksum. */
int attribute_checked_text(const file_place *at, hid_t object, const char *name, char **text);
/** Into a buffer of `size` bytes, cut to fit. */
int attribute_text_into(const file_place *at, hid_t object, const char *name, char *text, size_t size);
int attribute_integer(const file_place *at, hid_t object, const char *name, int64_t *value);
int attribute_number(const file_place *at, hid_t object, const char *name, double *value);

#endif
