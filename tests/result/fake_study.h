/* A study that was never parsed: the few functions of study.h that the result room calls, so that its tests depend on
 * no other room. Two sweeps, gamma (one decimal per point) and a floor; the second varies fastest. */
#ifndef RICOCHET_TESTS_FAKE_STUDY_H
#define RICOCHET_TESTS_FAKE_STUDY_H

#include "study/study.h"

/** @param points  of the two sweeps; both 0 for a study without a sweep, which has one task
 *  @param text_bytes  length of the study's text
 *  @param list  numbers of its one long list, `model.force`
 *  @returns NULL when out of memory; study_destroy frees */
study *fake_study_create(size_t gammas, size_t floors, size_t text_bytes, size_t list);

#endif
