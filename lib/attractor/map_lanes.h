/* Iterates of maps beside grazing, with tangent vectors: internal to map_kernels.c, which includes this file once for
 * each variant.
 *
 *   LANE             numbers side by side, or one, with the operators of one
 *   LANES, GROUPS    how many in a vector; vectors that go together
 *   TARGET, NAMED(f) of functions of this variant
 *   NOT_BELOW(x, y)  a MASK: not x < y, true of NaN
 *   KEEP(mask, x)    x, or zero; ANY(mask); ROOT(x)
 *   BITS             the bits of a LANE, unsigned; AS_LANE(bits) is it again
 *
 * At its end none of them is defined any more. */

#define WIDTH      (LANES * GROUPS)
#define GROUP(p)   (((LANE *)(p))[g])
#define GIVEN(p)   (((const LANE *)(p))[g])
#define FOR_GROUPS FEW for (size_t g = 0; g < GROUPS; g++)

/* Row i of L times x; the coefficients that all maps have zero are left out where the size is small. */
TARGET RIC_INLINE void NAMED(multiply_row)(const map_block *b, size_t size, size_t i, const double *x, LANE *sum) {
  const double *row = b->L + i * size * WIDTH;
  FOR_GROUPS sum[g] = GIVEN(row + i * WIDTH) * GIVEN(x + i * WIDTH);
  FEW for (size_t j = 0; j < size; j++) if (j != i && (size > MAP_SMALL || b->pattern >> (i * size + j) & 1))
      FOR_GROUPS sum[g] += GIVEN(row + j * WIDTH) * GIVEN(x + j * WIDTH);
}

/* eta x. */
TARGET RIC_INLINE void NAMED(weigh)(const map_block *b, size_t size, const double *x, LANE *sum) {
  FOR_GROUPS sum[g] = GIVEN(b->eta) * GIVEN(x);
  FEW for (size_t j = 1; j < size; j++) if (size > MAP_SMALL || b->pattern >> (size * size + j) & 1)
      FOR_GROUPS sum[g] += GIVEN(b->eta + j * WIDTH) * GIVEN(x + j * WIDTH);
}

TARGET RIC_INLINE void NAMED(multiply_vectors)(const map_block *b, size_t size) {
  LANE sum[GROUPS];
  for (size_t k = 0; k < b->vectors; k++) {
    const double *v = b->v + k * size * WIDTH;
    NAMED(weigh)(b, size, v, sum);
    FOR_GROUPS GROUP(b->weight + k * WIDTH) = sum[g];
    FEW for (size_t i = 0; i < size; i++) {
      NAMED(multiply_row)(b, size, i, v, sum);
      FOR_GROUPS GROUP(b->next_v + (k * size + i) * WIDTH) = sum[g];
    }
  }
}

/* What an impact adds to the tangent vectors of a group: -((s / 2 root) xi + kappa) eta v. */
TARGET RIC_INLINE void NAMED(turn_vectors)(const map_block *b, size_t size, size_t g, MASK hit, const LANE *root) {
  const LANE slope = 0.5 / *root;
  FEW for (size_t i = 0; i < size; i++) {
    const LANE fall = slope * GIVEN(b->xi + i * WIDTH) + GIVEN(b->kappa + i * WIDTH);
    for (size_t k = 0; k < b->vectors; k++)
      GROUP(b->next_v + (k * size + i) * WIDTH) -= KEEP(hit, fall * GIVEN(b->weight + k * WIDTH));
  }
}

/* The iterate after z, [FN97] (5.11), which takes the tangent vectors with it. */
TARGET RIC_INLINE void NAMED(iterate)(const map_block *b, size_t size, const double *z, double *next, bool vectors) {
  const LANE nothing = {0}, once = nothing + 1;
  LANE depth[GROUPS], root[GROUPS], sum[GROUPS];
  MASK hit[GROUPS];
  NAMED(weigh)(b, size, z, depth);
  if (vectors)
    NAMED(multiply_vectors)(b, size);
  FOR_GROUPS {
    depth[g] = GIVEN(b->d) - depth[g];
    hit[g] = NOT_BELOW(depth[g], nothing);
    root[g] = nothing;
    if (!ANY(hit[g]))
      continue;
    root[g] = ROOT(KEEP(hit[g], depth[g]));
    GROUP(b->impacts) += KEEP(hit[g], once);
    if (vectors)
      NAMED(turn_vectors)(b, size, g, hit[g], &root[g]);
  }
  FEW for (size_t i = 0; i < size; i++) {
    NAMED(multiply_row)(b, size, i, z, sum);
    FOR_GROUPS {
      if (ANY(hit[g]))
        sum[g] += KEEP(hit[g], root[g] * GIVEN(b->xi + i * WIDTH) + depth[g] * GIVEN(b->kappa + i * WIDTH));
      GROUP(next + i * WIDTH) = sum[g];
    }
  }
}

TARGET RIC_INLINE void NAMED(product)(size_t size, const double *x, const double *y, LANE *sum) {
  FOR_GROUPS sum[g] = GIVEN(x) * GIVEN(y);
  for (size_t i = 1; i < size; i++)
    FOR_GROUPS sum[g] += GIVEN(x + i * WIDTH) * GIVEN(y + i * WIDTH);
}

/* Takes vector l out of x. Vectors that have been put out are zero. */
TARGET RIC_INLINE void NAMED(take_out)(const map_block *b, size_t size, size_t l, double *x) {
  const LANE least = (LANE){0} + DBL_MIN;
  const double *v = b->v + l * size * WIDTH, *norm = b->norm + l * WIDTH;
  LANE part[GROUPS];
  NAMED(product)(size, v, x, part);
  FOR_GROUPS part[g] = KEEP(NOT_BELOW(GIVEN(norm), least), part[g] / GIVEN(norm));
  for (size_t i = 0; i < size; i++)
    FOR_GROUPS GROUP(x + i * WIDTH) -= part[g] * GIVEN(v + i * WIDTH);
}

/* Takes the vectors before it out of vector k, and the squares of its length. */
TARGET RIC_INLINE void NAMED(straighten)(const map_block *b, size_t size, size_t k) {
  double *x = b->v + k * size * WIDTH;
  LANE before[GROUPS], after[GROUPS];
  NAMED(product)(size, x, x, before);
  for (size_t l = 0; l < k; l++)
    NAMED(take_out)(b, size, l, x);
  NAMED(product)(size, x, x, after);
  FOR_GROUPS {
    const MASK left = NOT_BELOW(after[g], put_out * before[g]);
    GROUP(b->norm + k * WIDTH) = KEEP(left, after[g]);
    for (size_t i = 0; i < size; i++)
      GROUP(x + i * WIDTH) = KEEP(left, GIVEN(x + i * WIDTH));
  }
}

/* Makes the vectors orthogonal again, in their order: modified Gram-Schmidt. As they were before the last iterate, once
 * is enough. Their lengths stay those of the triangular factor: so they grow by its diagonal, and that alone. */
TARGET RIC_INLINE void NAMED(part)(const map_block *b, size_t size) {
  LANE norm[GROUPS];
  NAMED(product)(size, b->v, b->v, norm);
  FOR_GROUPS GROUP(b->norm) = norm[g];
  for (size_t k = 1; k < b->vectors; k++)
    NAMED(straighten)(b, size, k);
}

/* Takes powers of two out of the lengths: exact. */
TARGET RIC_INLINE void NAMED(shorten)(map_block *b, size_t size) {
  for (size_t k = 0; k < b->vectors; k++)
    FOR_GROUPS {
      const BITS half = ((((const BITS *)(b->norm + k * WIDTH))[g] << 1 >> 53) + 1) >> 1; /* of its exponent + 512 */
      const BITS scale = (1535 - half) << 52;
      ((BITS *)(b->power + k * WIDTH))[g] += half - 512;
      for (size_t i = 0; i < size; i++)
        GROUP(b->v + (k * size + i) * WIDTH) *= AS_LANE(scale);
      GROUP(b->norm + k * WIDTH) *= AS_LANE(scale); /* twice: the square of the scale may overflow */
      GROUP(b->norm + k * WIDTH) *= AS_LANE(scale);
    }
}

/* Without vectors. The block is a copy, of which the compiler knows that no lane is part of it. */
TARGET RIC_INLINE void NAMED(go)(map_block b, size_t size, double *trace, size_t count) {
  const size_t state = size * WIDTH;
  for (size_t k = 0; k < count; k++, trace += state)
    NAMED(iterate)(&b, size, trace, trace + state, false);
}

TARGET RIC_INLINE void NAMED(carry)(map_block *block, size_t size, double *trace, size_t count) {
  map_block b = *block;
  const size_t state = size * WIDTH;
  for (size_t k = 0; k < count; k++, trace += state) {
    NAMED(iterate)(&b, size, trace, trace + state, true);
    double *v = b.v;
    b.v = b.next_v;
    b.next_v = v;
    if (b.vectors > 1 || k % SHORTEN == SHORTEN - 1 || k + 1 == count)
      NAMED(part)(&b, size);
    if (k % SHORTEN == SHORTEN - 1 || k + 1 == count)
      NAMED(shorten)(&b, size);
  }
  *block = b;
}

TARGET static void NAMED(advance)(map_block *b, double *trace, size_t count) {
  if (b->vectors > 0)
    switch (b->size) {
    case 3:
      NAMED(carry)(b, 3, trace, count);
      break;
    default:
      NAMED(carry)(b, b->size, trace, count);
    }
  else
    switch (b->size) {
    case 1:
      NAMED(go)(*b, 1, trace, count);
      break;
    case 2:
      NAMED(go)(*b, 2, trace, count);
      break;
    case 3:
      NAMED(go)(*b, 3, trace, count);
      break;
    case 4:
      NAMED(go)(*b, 4, trace, count);
      break;
    default:
      NAMED(go)(*b, b->size, trace, count);
    }
}

#undef WIDTH
#undef GROUP
#undef GIVEN
#undef FOR_GROUPS
#undef LANE
#undef LANES
#undef GROUPS
#undef TARGET
#undef NAMED
#undef MASK
#undef BITS
#undef NOT_BELOW
#undef KEEP
#undef ANY
#undef ROOT
#undef AS_LANE
