/* Attributes of a result: scalars and fixed-length text, written and read back. */
#ifndef RICOCHET_APP_ATTRIBUTE_H
#define RICOCHET_APP_ATTRIBUTE_H

#include <stdint.h>

#include "hdf5_call.h"

/** So many attributes of an object stay in its header, which has a checksum; HDF5's dense form keeps values over 4 kB
 *  without one. */
enum { ATTRIBUTE_MOST_COMPACT = 512 };

/* Writing. @returns 0 or EXIT_FILES. */

/** Text of fixed length, which all readers support; ASCII, or UTF-8 if a byte needs it. NULL counts as "". */
int attribute_put_text(const file_place *at, hid_t object, const char *name, const char *text);
int attribute_put_integer(const file_place *at, hid_t object, const char *name, int64_t value);
int attribute_put_number(const file_place *at, hid_t object, const char *name, double value);
/** Text with a digest of its own beside it, "NAME_checksum": HDF5 keeps text of 64 kB or more without a checksum. */
int attribute_put_checked_text(const file_place *at, hid_t object, const char *name, const char *text);
/** A value of any type. */
int attribute_put_scalar(const file_place *at, hid_t object, const char *name, hid_t file_type, hid_t memory_type,
                         const void *value);
/** A list of any type. @param count  may be 0 */
int attribute_put_list(const file_place *at, hid_t object, const char *name, hid_t file_type, hid_t memory_type,
                       size_t count, const void *values);

/** A list of texts of fixed length. @param count  may be 0 */
int attribute_put_texts(const file_place *at, hid_t object, const char *name, size_t count, const char *const *texts);

/** The file's type for text of `bytes` bytes, NUL padded, closed by the caller; negative on failure. */
hid_t attribute_text_type(size_t bytes, H5T_cset_t set);

/* Reading. @returns 0 or EXIT_FILES. */

/** @param text  set to malloc'd text with a terminating 0; the caller frees; NULL on failure */
int attribute_text(const file_place *at, hid_t object, const char *name, char **text);
/** Text written by attribute_put_checked_text, refused when it does not match its checksum. */
int attribute_checked_text(const file_place *at, hid_t object, const char *name, char **text);
/** Into a buffer of `size` bytes, cut to fit. */
int attribute_text_into(const file_place *at, hid_t object, const char *name, char *text, size_t size);
/** The same; without such an attribute the text stays as it is. */
int attribute_text_if_there(const file_place *at, hid_t object, const char *name, char *text, size_t size);
int attribute_integer(const file_place *at, hid_t object, const char *name, int64_t *value);
int attribute_number(const file_place *at, hid_t object, const char *name, double *value);

/** Digest of all attributes of an object, their names, types, shapes and values: HDF5 keeps values of 64 kB or more
 *  without a checksum. None of them may be of variable length or a reference. */
int attribute_digest(const file_place *at, hid_t object, uint64_t *digest);

#endif
