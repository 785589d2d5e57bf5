/* The curves that a task follows in two parameters through its special points. */
#ifndef RICOCHET_APP_BRANCH_TRACE_H
#define RICOCHET_APP_BRANCH_TRACE_H

#include "walk.h"

/** Whether the study asks for the curves of such a point. */
bool branch_trace_wanted(const branch_family *b, ric_family_kind what);

/** Follows the curve through a special point both ways and adds its points and its ends to the tails.
 *  @param family  that the point belongs to; the walk along it goes on afterwards
 *  @param special  index of the point among those of the task
 *  @returns RIC_OK, also for a curve that does not begin; RIC_ESTOPPED; RIC_ENOMEM */
ric_status branch_trace(branch_family *b, ric_family *family, const ric_family_point *point, long long special,
                        const kind_plan *plan, records *tails, branch_result *result);

#endif
