/* The keys of studies that continue a family of periodic motions. */
#ifndef RICOCHET_APP_FAMILY_CHECK_H
#define RICOCHET_APP_FAMILY_CHECK_H

#include "study/check.h"

/* Hooks of these kinds (schema_choice). family_complete_study finds the continuation parameter and the second parameter
 * of curves, and sets the value of an omitted parameter or of an omitted start. */
int family_complete_study(study *s, const document *d, message *why);
bool family_wants(const study *s, const document *d, study_key key);
int family_check(const study *s, const document *d, message *why);

/** The continuation parameter; NULL if the study continues no family. */
const study_parameter *family_followed(const study *s);
/** The second parameter of curves through special points; NULL without curves. */
const study_parameter *family_traced(const study *s);

#endif
