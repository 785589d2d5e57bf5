/* Nonlinear normal modes of two masses before a wall: springs 3, from the ground, and 1 with the cubic part 0.1, wall
 * at 2 before the second mass. The first mode is followed from a small energy up to the wall, and from there on the
 * family with an impact per period; the grazing motion is found by itself, too.
 *
 *   cc modes.c $(pkg-config --cflags --libs ricochet) -lm && ./a.out */
#include <math.h>
#include <ricochet/ricochet.h>
#include <stdio.h>

static const double small = 0.1, large = 4; /* energies */

static const ric_spring springs[3] = {{.linear = 3}, {.linear = 1, .cubic = 0.1}, {.linear = 0}};
static const size_t wall_hit = 0;

static ric_shooting_problem even_motion(size_t impacts) {
  return (ric_shooting_problem){
      .kind = RIC_MOTION_EVEN, .at_start = &wall_hit, .start_count = impacts, .flow = ric_flow_options_default()};
}

static int print_point(const ric_explore_segment *segment, const ric_family_point *point, void *user) {
  (void)user;
  if (point->kind != RIC_FAMILY_REGULAR)
    printf("segment %zu: %s at the energy %.9f, period %.9f\n", segment->index, ric_family_kind_name(point->kind),
           point->parameter, point->orbit->period);
  return 0;
}

static int print_end(const ric_explore_segment *segment, void *user) {
  (void)user;
  printf("segment %zu: from %s, %zu impacts, %zu points, %s\n", segment->index,
         ric_explore_origin_name(segment->origin),
         segment->family ? ric_shooting_impacts(ric_family_shooting(segment->family)) : 0, segment->run.points,
         segment->status == RIC_OK ? ric_curve_end_name(segment->run.end) : segment->reason);
  return 0;
}

/* The first mode along the energy, and what begins on it. */
static ric_status explore(const ric_lattice *lattice, ric_family *family, ric_guess *guess, ric_error *error) {
  const ric_explore_visitor visitor = {.point = print_point, .end = print_end};
  ric_explore_options options = ric_explore_options_default();
  double z[3]; /* displacements, period */
  options.cross = true;
  options.segments = 2;
  RIC_TRY(ric_guess_mode(lattice, 0, small, guess, error));
  RIC_TRY(ric_family_start(family, small, guess->q, guess->v, NULL, guess->period, z, NULL, error));
  return ric_family_explore(family, z, small, &options, &visitor, error);
}

/* Where the mode grazes, without the way there. */
static ric_status find_grazing(const ric_lattice *lattice, const ric_obstacle *wall, ric_guess *guess,
                               ric_error *error) {
  const ric_shooting_problem motion = even_motion(1);
  const ric_guess_problem problem = {lattice, wall, 1, &motion};
  RIC_TRY(ric_guess_grazing_mode(&problem, 0, 1, guess, error));
  printf("mode 0 grazes at the energy %.9f, period %.9f\n", ric_lattice_energy(lattice, guess->q, guess->v),
         guess->period);
  return RIC_OK;
}

int main(void) {
  const ric_obstacle wall = ric_obstacle_wall(1, 2);
  ric_lattice lattice = ric_lattice_default(2, RIC_ENDS_FIXED);
  ric_family_options options = ric_family_options_default();
  ric_system *system = NULL;
  ric_family *family = NULL;
  ric_guess guess = {0};
  ric_error error;
  lattice.on_site = (ric_spring){0};
  lattice.links = springs;
  options.curve.p_low = 0;
  options.curve.p_high = large;
  ric_status status = ric_system_create_lattice(&lattice, &wall, 1, &system, &error);
  ric_family_problem problem = {.system = system, .motion = even_motion(0), .parameters = 1, .given = small};
  problem.motion.energy_given = true;
  if (status == RIC_OK)
    status = ric_family_create(&problem, &options, &family, &error);
  if (status == RIC_OK)
    status = ric_guess_init(&guess, 2, &error);
  if (status == RIC_OK)
    status = explore(&lattice, family, &guess, &error);
  if (status == RIC_OK)
    status = find_grazing(&lattice, &wall, &guess, &error);
  if (status != RIC_OK)
    fprintf(stderr, "%s\n", error.message);
  ric_guess_clear(&guess);
  ric_family_destroy(&family);
  ric_system_destroy(&system);
  return status != RIC_OK;
}
