/* The keys of studies that follow a family of periodic motions. */
#ifndef RICOCHET_APP_FAMILY_CHECK_H
#define RICOCHET_APP_FAMILY_CHECK_H

#include "study/check.h"

/* Hooks of the kinds that do (schema_choice). The first one finds the numbers that the family is followed along and
 * that curves are followed in, and gives an omitted one, or the start of the branch, its value. */
int family_complete(study *s, const document *d, message *why);
bool family_wants(const study *s, const document *d, study_key key);
int family_check(const study *s, const document *d, message *why);

/** What the family is followed along; NULL where the study follows none. */
const study_parameter *family_followed(const study *s);
/** The second parameter of curves through its special points; NULL without them. */
const study_parameter *family_traced(const study *s);

#endif
