/* The Taylor flow of the lattice against the exact modal motion. */
#include "support.h"

#include "modal_motion.h"
#include "scenario/random_source.h"

enum { MOST = 40, LONG = 1000 };

static const size_t sizes[] = {1, 2, 3, 4, 5, 8, 13, 40};

static ric_chain chain_of(size_t n, int ends, double gamma) {
  ric_chain chain = ric_chain_default(n, gamma);
  chain.ends = (ric_ends)ends;
  return chain;
}

static void random_state(random_source *source, size_t n, double *q, double *v) {
  for (size_t i = 0; i < n; i++) {
    q[i] = random_uniform(source, -1, 1);
    v[i] = random_uniform(source, -1, 1);
  }
}

static ric_lattice_flow *new_flow(void) {
  ric_lattice_flow *flow = NULL;
  assert_int_equal(ric_lattice_flow_create(&flow, NULL), RIC_OK);
  return flow;
}

/* A state with its exact motion. */
typedef struct start {
  double q[MOST], v[MOST];
  modal_motion motion;
} start;

static void for_all_chains(void (*holds)(const ric_chain *chain, ric_lattice_flow *flow, const start *from)) {
  const double couplings[] = {0, 0.1, 1.3};
  random_source source = {.state = 14};
  ric_lattice_flow *flow = new_flow();
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++)
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
      for (size_t g = 0; g < 3; g++) {
        ric_chain chain = chain_of(sizes[s], ends, couplings[g]);
        start from;
        random_state(&source, chain.particles, from.q, from.v);
        from.motion = modal_motion_create(&chain);
        modal_motion_set(&from.motion, from.q, from.v);
        holds(&chain, flow, &from);
        modal_motion_clear(&from.motion);
      }
  ric_lattice_flow_destroy(&flow);
}

/* Rounding of 25 terms of size (omega h)^j / j!, at most exp(2.2), and of the modal sum. */
static double rounding_of(const modal_motion *motion, int order) {
  return 1e-15 * 9 * 10 * modal_motion_bound(motion, order);
}

static void check_exact(const ric_chain *chain, ric_lattice_flow *flow, const start *from) {
  size_t n = chain->particles;
  for (int direction = -1; direction <= 1; direction += 2) {
    double length = direction * ric_lattice_step(chain), q[MOST], v[MOST], exact_q[MOST], exact_v[MOST];
    ric_segment segment = ric_lattice_flow_segment(flow, chain, from->q, from->v, 7, length, 0, n);
    assert_close(segment.start, 7, 0);
    assert_close(segment.length, length, 0);
    for (int k = 0; k <= 10; k++) {
      modal_motion motion = from->motion;
      modal_motion_state(&motion, length * k / 10, exact_q, exact_v);
      ric_segment_state(&segment, k / 10.0, q, v);
      for (size_t i = 0; i < n; i++) {
        assert_close(q[i], exact_q[i], rounding_of(&motion, 0));
        assert_close(v[i], exact_v[i], rounding_of(&motion, 1));
      }
    }
  }
}

static void segments_equal_the_modal_motion_to_rounding_in_both_directions(void **state) {
  (void)state;
  for_all_chains(check_exact);
}

static void check_energy(const ric_chain *chain, ric_lattice_flow *flow, const start *from) {
  double q[MOST], v[MOST], energy = ric_chain_energy(chain, from->q, from->v);
  ric_segment segment =
      ric_lattice_flow_segment(flow, chain, from->q, from->v, 0, ric_lattice_step(chain), 0, chain->particles);
  for (int k = 0; k <= 10; k++) {
    ric_segment_state(&segment, k / 10.0, q, v);
    assert_close(ric_chain_energy(chain, q, v), energy, 1e-13 * energy);
  }
}

static void energy_is_constant_along_a_segment(void **state) {
  (void)state;
  for_all_chains(check_energy);
}

static void check_return(const ric_chain *chain, ric_lattice_flow *flow, const start *from) {
  double q[MOST], v[MOST], back_q[MOST], back_v[MOST], step = ric_lattice_step(chain);
  size_t n = chain->particles;
  ric_segment there = ric_lattice_flow_segment(flow, chain, from->q, from->v, 0, step, 0, n);
  ric_segment_state(&there, 1, q, v);
  ric_segment back = ric_lattice_flow_segment(flow, chain, q, v, step, -step, 0, n);
  ric_segment_state(&back, 1, back_q, back_v);
  for (size_t i = 0; i < n; i++) {
    assert_close(back_q[i], from->q[i], rounding_of(&from->motion, 0));
    assert_close(back_v[i], from->v[i], rounding_of(&from->motion, 1));
  }
}

static void a_step_back_returns_to_the_start(void **state) {
  (void)state;
  for_all_chains(check_return);
}

/* The first coefficient left out is the 25th for initial velocities and the 26th for positions; far beyond the longest
 * step the error shows them. */
static double truncation_error(int of_positions, double length) {
  ric_chain chain = chain_of(2, RIC_ENDS_FREE, 0);
  ric_lattice_flow *flow = new_flow();
  double q[2] = {of_positions, 0}, v[2] = {!of_positions, 0}, end[2];
  ric_segment segment = ric_lattice_flow_segment(flow, &chain, q, v, 0, length, 0, 2);
  ric_segment_state(&segment, 1, end, NULL);
  ric_lattice_flow_destroy(&flow);
  return fabs(end[0] - (of_positions ? cos(length) : sin(length)));
}

static void truncation_is_of_the_order_of_the_first_term_left_out(void **state) {
  (void)state;
  for (int of_positions = 0; of_positions < 2; of_positions++)
    for (double length = 4; length <= 5; length += 0.25) {
      double order =
          log(truncation_error(of_positions, 1.1 * length) / truncation_error(of_positions, length)) / log(1.1);
      assert_close(order, 25 + of_positions, 0.1); /* the next term is length^2 / (27 * 28) of it */
    }
}

static void longest_step_is_long_enough_and_not_too_long(void **state) {
  (void)state;
  ric_chain chain = chain_of(30, RIC_ENDS_PERIODIC, 0.4);
  double x = ric_lattice_step(&chain) * ric_chain_frequency_max(&chain), term = 1;
  for (int j = 1; j <= RIC_LATTICE_ORDER + 1; j++)
    term *= x / j;
  assert_true(term < 1e-16);
  assert_close(x, 2.2, 1e-14);
}

/* Positions and velocities of a long chain at the end of a step that is worked through in blocks of `cut`. */
static void step_in_blocks(ric_lattice_flow *flow, const ric_chain *chain, const double *q, const double *v, size_t cut,
                           double *q_end, double *v_end) {
  for (size_t first = 0; first < LONG; first += cut) {
    size_t count = LONG - first < cut ? LONG - first : cut;
    ric_segment s = ric_lattice_flow_segment(flow, chain, q, v, 0, ric_lattice_step(chain), first, count);
    assert_true(s.first == first && s.coordinates == count);
    ric_segment_state(&s, 1, q_end + first, v_end + first);
  }
}

static void blocks_of_any_size_give_the_same_step(void **state) {
  (void)state;
  static double q[LONG], v[LONG], q_end[LONG], v_end[LONG], q_other[LONG], v_other[LONG];
  const size_t cuts[] = {1, 2, 7, 12, 13, 100, 255};
  random_source source = {.state = 15};
  ric_lattice_flow *flow = new_flow();
  random_state(&source, LONG, q, v);
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    ric_chain chain = chain_of(LONG, ends, 0.6);
    step_in_blocks(flow, &chain, q, v, RIC_LATTICE_BLOCK, q_end, v_end);
    for (size_t c = 0; c < sizeof cuts / sizeof *cuts; c++) {
      step_in_blocks(flow, &chain, q, v, cuts[c], q_other, v_other);
      assert_memory_equal(q_end, q_other, sizeof q_end);
      assert_memory_equal(v_end, v_other, sizeof v_end);
    }
  }
  ric_lattice_flow_destroy(&flow);
}

static void blocks_of_a_long_chain_follow_the_modal_motion(void **state) {
  (void)state;
  static double q[LONG], v[LONG], q_end[LONG], v_end[LONG], exact_q[LONG], exact_v[LONG];
  random_source source = {.state = 16};
  ric_lattice_flow *flow = new_flow();
  random_state(&source, LONG, q, v);
  for (int ends = RIC_ENDS_PERIODIC; ends <= RIC_ENDS_FREE; ends++) {
    ric_chain chain = chain_of(LONG, ends, 0.6);
    modal_motion motion = modal_motion_create(&chain);
    modal_motion_set(&motion, q, v);
    modal_motion_state(&motion, ric_lattice_step(&chain), exact_q, exact_v);
    step_in_blocks(flow, &chain, q, v, RIC_LATTICE_BLOCK, q_end, v_end);
    for (size_t i = 0; i < LONG; i++) {
      assert_close(q_end[i], exact_q[i], 1e-13); /* the modal sum has a thousand terms */
      assert_close(v_end[i], exact_v[i], 1e-13 * ric_chain_frequency_max(&chain));
    }
    modal_motion_clear(&motion);
  }
  ric_lattice_flow_destroy(&flow);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(segments_equal_the_modal_motion_to_rounding_in_both_directions),
      cmocka_unit_test(energy_is_constant_along_a_segment),
      cmocka_unit_test(a_step_back_returns_to_the_start),
      cmocka_unit_test(truncation_is_of_the_order_of_the_first_term_left_out),
      cmocka_unit_test(longest_step_is_long_enough_and_not_too_long),
      cmocka_unit_test(blocks_of_any_size_give_the_same_step),
      cmocka_unit_test(blocks_of_a_long_chain_follow_the_modal_motion),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
