/* The roles of a pattern as one array: internal to the room. */
#ifndef RICOCHET_PATTERN_ROLES_H
#define RICOCHET_PATTERN_ROLES_H

#include "ricochet/pattern.h"

/** Roles [particles], values of ric_role. */
const unsigned char *pattern_roles(const ric_pattern *pattern);

#endif
