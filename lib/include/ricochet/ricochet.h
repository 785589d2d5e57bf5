/* Ricochet: simulation, continuation and bifurcation analysis of impact oscillators.
 *
 * Source keys in the comments: [JAP] periodic motions of coupled impact oscillators, [VID] nonlinear modes of
 * vibro-impact Duffing oscillators, [FN97] grazing bifurcations in many-degree-of-freedom impact oscillators; full
 * references in docs/theory.md. Numbers in round brackets are equations there. docs/glossary.md maps their words to the
 * terms of the field.
 *
 * NULL: a function that returns a ric_status, with the ric_error last, refuses NULL by RIC_EINVAL and the name of the
 * parameter: for every object, struct, array and callback. What its docstring says may be NULL may be so, and arrays of
 * length 0, errors, and the `user` of callbacks. Destroying and clearing functions do nothing with NULL. All other
 * functions do not look: NULL is not for them, unless their docstring says so. No function can tell how long an array
 * is: it has the length that the docstring states.
 *
 * Threads: any number of them may use the library at a time, each with objects of its own. Structs of numbers,
 * patterns, orbits and maps may be read by several threads at once. All other objects are for one thread at a time,
 * also where a function takes them as const; a system and all that was made on it count as one. Errors are written to
 * the ric_error of the caller. Callbacks run in the thread that calls.
 *
 * The library switches GSL's error handler off, once, when it first needs that, and leaves one that is set later.
 * Within the library one thread at a time makes plans of FFTW; a program that makes plans of its own meanwhile calls
 * fftw_make_planner_thread_safe first. */
#ifndef RICOCHET_H
#define RICOCHET_H

#include "attractor.h"
#include "basin.h"
#include "bypass.h"
#include "chain.h"
#include "continuation.h"
#include "cycle_window.h"
#include "elementary.h"
#include "event.h"
#include "explore.h"
#include "family.h"
#include "flow.h"
#include "grazing.h"
#include "grazing_criterion.h"
#include "grazing_map.h"
#include "guess.h"
#include "impact_modes.h"
#include "lattice.h"
#include "lyapunov.h"
#include "mck.h"
#include "monodromy.h"
#include "motion_section.h"
#include "motion_window.h"
#include "multipliers.h"
#include "normal_modes.h"
#include "obstacle.h"
#include "orbit.h"
#include "orbit_multipliers.h"
#include "pattern.h"
#include "polynomial.h"
#include "resonance.h"
#include "ritz.h"
#include "saltation.h"
#include "segment.h"
#include "shooting.h"
#include "special_points.h"
#include "status.h"
#include "system.h"
#include "trajectory.h"
#include "user_system.h"
#include "verify.h"
#include "windows.h"
#include "ricochet/version.h"

#endif
