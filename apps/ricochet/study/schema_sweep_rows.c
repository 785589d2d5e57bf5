/* The schema table: keys of an entry of the section `sweep`. */
#include "schema_rows.h"
#include "study.h"

static const schema_entry sweep_rows[SWEEP_KEY_COUNT] = {
    [SWEEP_PARAMETER] = {.path = "sweep.parameter",
                         .type = VALUE_TEXT,
                         .scalar = true,
                         .required = true,
                         .doc = "The key that is swept, or an element of its list: `model.gamma`, `model.floor[3]`."},
    [SWEEP_VALUES] = {.path = "sweep.values",
                      .type = VALUE_NUMBER,
                      .list = true,
                      ANY,
                      .doc = "The values, in the order of the tasks."},
    [SWEEP_FROM] = {.path = "sweep.from",
                    .type = VALUE_NUMBER,
                    .scalar = true,
                    ANY,
                    .doc = "Instead of `values`: the first value."},
    [SWEEP_TO] = {.path = "sweep.to",
                  .type = VALUE_NUMBER,
                  .scalar = true,
                  ANY,
                  .doc = "The last value, larger than `from`, met exactly."},
    [SWEEP_POINTS] = {.path = "sweep.points",
                      .type = VALUE_INTEGER,
                      .scalar = true,
                      .low = 1,
                      .high = STUDY_MAX_POINTS,
                      .doc = "Number of values, both ends included; 1 only where `from` equals `to`."},
    [SWEEP_SCALE] = {.path = "sweep.scale",
                     .type = VALUE_WORD,
                     .scalar = true,
                     .fallback = "linear",
                     .words = "linear|log",
                     .doc = "`linear`: equal steps; `log`: equal ratios, `from` above 0."},
    [SWEEP_BACK] = {.path = "sweep.back",
                    .type = VALUE_FLAG,
                    .scalar = true,
                    .fallback = "false",
                    .doc = "The values once more in the reverse order, after the others: with `iterate.follow`, there "
                           "and back."},
};

const schema_entry *schema_sweep_row(sweep_key key) {
  return &sweep_rows[key];
}
