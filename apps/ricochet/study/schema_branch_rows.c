/* The schema table, sections `branch`, `restart` and `grazing`: how a family of periodic motions is followed along a
 * parameter, where in an earlier result it starts, and what is found where it grazes. */
#include "schema_rows.h"

#define OF_BRANCH  .kinds = "branch"
#define OF_FAMILY  .kinds = "branch|grazing|diagram" /* of all kinds that follow a family */
#define OF_TRACE   .kinds = "branch|grazing"         /* of those that follow curves in two parameters */
#define OF_GRAZING .kinds = "grazing"
#define NUMBER     .type = VALUE_NUMBER, .scalar = true, .no_sweep = "it says how the branch is followed"

static const schema_entry rows[KEY_ITERATE_TRANSIENT - KEY_BRANCH_PARAMETER] = {
    [KEY_BRANCH_PARAMETER - KEY_BRANCH_PARAMETER] =
        {.path = "branch.parameter",
         .type = VALUE_TEXT,
         .scalar = true,
         .required = true,
         OF_FAMILY,
         .no_sweep = "it is text, not a number",
         .doc = "What the branch is followed along: a number of `model`, or an element of a list there, `orbit.period` "
                "or `orbit.energy`. Where `branch.from` is given it may be left out of its section."},
    [KEY_BRANCH_FROM - KEY_BRANCH_PARAMETER] = {.path = "branch.from",
                                                NUMBER,
                                                .null = true,
                                                .fallback = "null",
                                                ANY,
                                                OF_FAMILY,
                                                .doc =
                                                    "Value of the parameter at which the branch starts; null: the "
                                                    "study's own value of it, of orbit.energy without one the energy "
                                                    "of the motion of the period `orbit.period`, or of that in which "
                                                    "`orbit.mode` touches the obstacle of `orbit.at_start`."},
    [KEY_BRANCH_TO - KEY_BRANCH_PARAMETER] =
        {.path = "branch.to",
         NUMBER,
         .required = true,
         ANY,
         OF_FAMILY,
         .doc = "The branch sets out towards this value; from where `orbit.mode` touches an obstacle, to the side on "
                "which the impact pushes. It ends where the parameter leaves its bounds."},
    [KEY_BRANCH_LOW - KEY_BRANCH_PARAMETER] = {.path = "branch.low",
                                               NUMBER,
                                               .null = true,
                                               .fallback = "null",
                                               ANY,
                                               OF_FAMILY,
                                               .doc = "Lower bound of the parameter; null: the smaller one of `from` "
                                                      "and `to`."},
    [KEY_BRANCH_HIGH - KEY_BRANCH_PARAMETER] = {.path = "branch.high",
                                                NUMBER,
                                                .null = true,
                                                .fallback = "null",
                                                ANY,
                                                OF_FAMILY,
                                                .doc = "Upper bound of the parameter; null: the larger one of `from` "
                                                       "and `to`."},
    [KEY_BRANCH_SCALE - KEY_BRANCH_PARAMETER] = {.path = "branch.scale",
                                                 WORD,
                                                 .fallback = "linear",
                                                 .words = "linear|log",
                                                 OF_FAMILY,
                                                 .doc = "`log`: steps are taken in the logarithm of the parameter, "
                                                        "whose bounds lie above 0."},
    [KEY_BRANCH_STEP - KEY_BRANCH_PARAMETER] =
        {.path = "branch.step",
         NUMBER,
         .null = true,
         .fallback = "null",
         .low = 0,
         .low_open = true,
         .high = INFINITY,
         OF_FAMILY,
         .doc =
             "First step along the branch, in its arclength: the root of p^2 plus the mean square of the unknowns of "
             "the motion, with the parameter, or its logarithm, p; null: a fiftieth of the way from `from` to `to`."},
    [KEY_BRANCH_STEP_LEAST - KEY_BRANCH_PARAMETER] = {.path = "branch.step_least",
                                                      NUMBER,
                                                      .null = true,
                                                      .fallback = "null",
                                                      .low = 0,
                                                      .low_open = true,
                                                      .high = INFINITY,
                                                      OF_FAMILY,
                                                      .doc = "Where steps would have to be shorter, the branch ends as "
                                                             "`not_converged`; null: a millionth of `step`."},
    [KEY_BRANCH_STEP_MOST - KEY_BRANCH_PARAMETER] =
        {.path = "branch.step_most",
         NUMBER,
         .null = true,
         .fallback = "null",
         .low = 0,
         .low_open = true,
         .high = INFINITY,
         OF_FAMILY,
         .doc = "Longest step; null: a tenth of that way. Special points that come in pairs within one step are not "
                "seen."},
    [KEY_BRANCH_NATURAL - KEY_BRANCH_PARAMETER] = {.path = "branch.natural",
                                                   FLAG,
                                                   .fallback = "false",
                                                   OF_FAMILY,
                                                   .doc =
                                                       "Steps in the parameter alone, which end at folds, instead of "
                                                       "by pseudo-arclength."},
    [KEY_BRANCH_POINTS - KEY_BRANCH_PARAMETER] = {.path = "branch.points",
                                                  .type = VALUE_INTEGER,
                                                  .scalar = true,
                                                  .fallback = "500",
                                                  .low = 1,
                                                  .high = 1e7,
                                                  .no_sweep = "it says how the branch is followed",
                                                  OF_FAMILY,
                                                  .doc = "Most steps of a segment of the branch."},
    [KEY_BRANCH_TOLERANCE -
        KEY_BRANCH_PARAMETER] = {.path = "branch.tolerance",
                                 NUMBER,
                                 .fallback = "1e-12",
                                 .low = 0,
                                 .low_open = true,
                                 .high = 0.01,
                                 OF_FAMILY,
                                 .doc = "Newton's method has converged when corrections are "
                                        "smaller than this, relative to 1 + the size of what is found."},
    [KEY_BRANCH_MULTIPLIERS - KEY_BRANCH_PARAMETER] =
        {.path = "branch.multipliers",
         WORD,
         .fallback = "true",
         .words = "true|false|all",
         OF_BRANCH,
         .doc = "Floquet multipliers of every point, and the special points that they tell; `all` stores them all, "
                "`true` the largest modulus. For states of up to 400 numbers."},
    [KEY_BRANCH_STATES - KEY_BRANCH_PARAMETER] = {.path = "branch.states",
                                                  FLAG,
                                                  .fallback = "false",
                                                  OF_BRANCH,
                                                  .doc = "Whether the result stores the state and the impacts of every "
                                                         "point; those of special points are stored in any case."},
    [KEY_BRANCH_SAMPLES - KEY_BRANCH_PARAMETER] =
        {.path = "branch.samples",
         .type = VALUE_INTEGER,
         .scalar = true,
         .null = true,
         .fallback = "null",
         .low = 2,
         .high = 100000,
         .no_sweep = "it changes the shape of the result",
         OF_BRANCH,
         .doc = "Number of states over the period, at equal distances in time from the first state, that the result "
                "stores of every point; null: none."},
    [KEY_BRANCH_CROSS - KEY_BRANCH_PARAMETER] =
        {.path = "branch.cross",
         FLAG,
         .fallback = "false",
         OF_BRANCH,
         .doc = "At grazing points and where impacts are lost, the family with an impact more or less is followed, "
                "too, as a further segment."},
    [KEY_BRANCH_SWITCH - KEY_BRANCH_PARAMETER] =
        {.path = "branch.switch",
         FLAG,
         .fallback = "false",
         OF_BRANCH,
         .doc = "The same for both halves of the other branch at branch points, and for the family of twice the period "
                "at period doublings of motions that are not even."},
    [KEY_BRANCH_SEGMENTS - KEY_BRANCH_PARAMETER] = {.path = "branch.segments",
                                                    .type = VALUE_INTEGER,
                                                    .scalar = true,
                                                    .fallback = "4",
                                                    .low = 1,
                                                    .high = 1000,
                                                    .no_sweep = "it says how the branch is followed",
                                                    OF_BRANCH,
                                                    .doc = "Most segments of a task, the first one included."},
    [KEY_BRANCH_TRACE_PARAMETER - KEY_BRANCH_PARAMETER] =
        {.path = "branch.trace.parameter",
         .type = VALUE_TEXT,
         .scalar = true,
         .required = true,
         OF_TRACE,
         .no_sweep = "it is text, not a number",
         .doc = "With the section `branch.trace`, the special points of the branch are followed in two parameters, as "
                "curves both ways; this is the second one, a number as `branch.parameter` names it. They begin at the "
                "study's own value of it."},
    [KEY_BRANCH_TRACE_LOW - KEY_BRANCH_PARAMETER] = {.path = "branch.trace.low",
                                                     NUMBER,
                                                     .required = true,
                                                     ANY,
                                                     OF_TRACE,
                                                     .doc = "Lower bound of the second parameter. Curves end there."},
    [KEY_BRANCH_TRACE_HIGH - KEY_BRANCH_PARAMETER] = {.path = "branch.trace.high",
                                                      NUMBER,
                                                      .required = true,
                                                      ANY,
                                                      OF_TRACE,
                                                      .doc = "Upper bound of the second parameter."},
    [KEY_BRANCH_TRACE_FIRST_LOW -
        KEY_BRANCH_PARAMETER] = {.path = "branch.trace.first_low",
                                 NUMBER,
                                 .null = true,
                                 .fallback = "null",
                                 ANY,
                                 OF_TRACE,
                                 .doc =
                                     "Curves end, too, where `branch.parameter` falls below this value; null: none."},
    [KEY_BRANCH_TRACE_FIRST_HIGH - KEY_BRANCH_PARAMETER] = {.path = "branch.trace.first_high",
                                                            NUMBER,
                                                            .null = true,
                                                            .fallback = "null",
                                                            ANY,
                                                            OF_TRACE,
                                                            .doc = "The same where it rises above this value."},
    [KEY_BRANCH_TRACE_STEP - KEY_BRANCH_PARAMETER] =
        {.path = "branch.trace.step",
         NUMBER,
         .null = true,
         .fallback = "null",
         .low = 0,
         .low_open = true,
         .high = INFINITY,
         OF_TRACE,
         .doc = "First step along a curve, in its arclength: the root of p^2 plus the mean square of the unknowns, "
                "which are those of the motion and the branch's parameter, with the second parameter p; null: a "
                "hundredth of the way from `low` to `high`."},
    [KEY_BRANCH_TRACE_STEP_MOST - KEY_BRANCH_PARAMETER] = {.path = "branch.trace.step_most",
                                                           NUMBER,
                                                           .null = true,
                                                           .fallback = "null",
                                                           .low = 0,
                                                           .low_open = true,
                                                           .high = INFINITY,
                                                           OF_TRACE,
                                                           .doc = "Longest step; null: a fiftieth of that way."},
    [KEY_BRANCH_TRACE_POINTS - KEY_BRANCH_PARAMETER] = {.path = "branch.trace.points",
                                                        .type = VALUE_INTEGER,
                                                        .scalar = true,
                                                        .fallback = "200",
                                                        .low = 1,
                                                        .high = 1e7,
                                                        .no_sweep = "it says how the branch is followed",
                                                        OF_TRACE,
                                                        .doc = "Most steps of a curve, each way."},
    [KEY_BRANCH_TRACE_KINDS - KEY_BRANCH_PARAMETER] = {.path = "branch.trace.kinds",
                                                       .type = VALUE_WORD,
                                                       .list = true,
                                                       .fallback = "[grazing, fold, period_doubling]",
                                                       .words = "grazing|fold|period_doubling|impact_lost|impulse_sign",
                                                       OF_BRANCH,
                                                       .no_sweep = "it holds words, not numbers",
                                                       .doc = "Which special points are followed."},
    [KEY_RESTART_FILE - KEY_BRANCH_PARAMETER] =
        {.path = "restart.file",
         .type = VALUE_TEXT,
         .scalar = true,
         .fallback = "",
         OF_BRANCH,
         .no_sweep = "it is text, not a number",
         .doc =
             "A result of kind branch, from the current folder: the branch starts at one of its points. State, impacts "
             "and parameters are taken from there, what varies there included, in place of what the study says."},
    [KEY_RESTART_TASK - KEY_BRANCH_PARAMETER] = {.path = "restart.task",
                                                 .type = VALUE_INTEGER,
                                                 .scalar = true,
                                                 .fallback = "0",
                                                 .low = 0,
                                                 .high = 1e12,
                                                 OF_BRANCH,
                                                 .no_sweep = "it says where the branch starts",
                                                 .doc = "Which task of that result."},
    [KEY_RESTART_SPECIAL - KEY_BRANCH_PARAMETER] = {.path = "restart.special",
                                                    .type = VALUE_INTEGER,
                                                    .scalar = true,
                                                    .null = true,
                                                    .fallback = "null",
                                                    .low = 0,
                                                    .high = 1e12,
                                                    OF_BRANCH,
                                                    .no_sweep = "it says where the branch starts",
                                                    .doc = "Which of its special points."},
    [KEY_RESTART_POINT - KEY_BRANCH_PARAMETER] = {.path = "restart.point",
                                                  .type = VALUE_INTEGER,
                                                  .scalar = true,
                                                  .null = true,
                                                  .fallback = "null",
                                                  .low = 0,
                                                  .high = 1e12,
                                                  OF_BRANCH,
                                                  .no_sweep = "it says where the branch starts",
                                                  .doc = "Which of its points, instead; they need `branch.states` "
                                                         "there."},
    [KEY_GRAZING_SECTION - KEY_BRANCH_PARAMETER] =
        {.path = "grazing.section",
         .type = VALUE_NUMBER,
         .scalar = true,
         .fallback = "0",
         .low = 0,
         .high = 1,
         .high_open = true,
         OF_GRAZING,
         .sweep = true,
         .doc =
             "Where on the motion the section of the return map lies, over the period: across time, stroboscopic, of "
             "forced motions, across the flow of all others."},
    [KEY_GRAZING_COEFFICIENTS - KEY_BRANCH_PARAMETER] =
        {.path = "grazing.coefficients",
         .type = VALUE_INTEGER,
         .scalar = true,
         .fallback = "24",
         .low = 1,
         .high = 64,
         OF_GRAZING,
         .no_sweep = "it changes the shape of the result",
         .doc = "How many of the coefficients c_i of the criterion the result stores, from c_0 on; on curves of "
                "`branch.trace`, whose changes of sign are located. The verdict looks at as many as it needs."},
    [KEY_GRAZING_WINDOWS - KEY_BRANCH_PARAMETER] =
        {.path = "grazing.windows",
         .type = VALUE_INTEGER,
         .scalar = true,
         .fallback = "16",
         .low = 0,
         .high = 64,
         OF_GRAZING,
         .no_sweep = "it changes the shape of the result",
         .doc =
             "Longest period of the one-impact orbits of the map beyond grazing whose windows are found, from period "
             "1 on; 0: none."},
    [KEY_GRAZING_BEYOND - KEY_BRANCH_PARAMETER] =
        {.path = "grazing.beyond",
         .type = VALUE_NUMBER,
         .scalar = true,
         .null = true,
         .fallback = "null",
         ANY,
         .kinds = "diagram",
         .models = LATTICES,
         .sweep = true,
         .doc =
             "How far beyond grazing the motion is iterated: `branch.parameter` is (1 + beyond) times its value where "
             "the family of the section `branch` first grazes, and what the return map of that grazing says of the "
             "attractor is stored beside it; null: the study says the parameter itself."},
};

const schema_entry *schema_branch_row(study_key key) {
  return &rows[key - KEY_BRANCH_PARAMETER];
}
