#include "harness/course/predictable.h"

// The mistakes of chapters 1 and 2, some of which spoil later ones as well.
namespace plumb::course {
namespace {

// Causes that several mistakes share.
constexpr const char* kSlowIsStopped =
    "What is slow is stopped, and so never begins to move: gravity and forces act on a body at rest as well. "
    "Leave out what sets small velocities to 0.";
constexpr const char* kMassFromSize =
    "The mass is computed from the size of the body: take \"mass\" from the scene.";
constexpr const char* kMassOfAnother =
    "All forces are divided by the mass of one body: each body's sum of forces is divided by its own mass.";
constexpr const char* kTimeForStep =
    "A step multiplies by the time since the start, which grows: it multiplies by dt, the length of a step.";
constexpr const char* kClampIncomplete =
    "The centre's x and y are not limited to the box on all four sides: the nearest point of a box has "
    "min(max(x, low), "
    "high), and the same for y.";
constexpr const char* kClampExchanged =
    "The nearest point of a box is always the same corner: min and max are exchanged where the centre's x "
    "and y are "
    "limited to the box, min(max(x, low), high).";
constexpr const char* kSomeNotCleared =
    "The forces on some bodies pile up from step to step: set the sum of every body to zero at the start of "
    "each step.";
constexpr const char* kWallMissing =
    "The ball leaves through one wall, which never acts on it: every static box is a wall.";
constexpr const char* kSpringAtOneEnd =
    "The spring pulls one of its ends only: it pulls both, with opposite forces.";
constexpr const char* kDampingOfOneEnd =
    "The spring's damping follows the velocity of one end: it acts against the speed at which the ends part, "
    "(vb - va) along the spring.";

}  // namespace

std::vector<Predictable> mistakes_of_motion() {
  return {
      {"gravity*0", "no_gravity", "1",
       "Gravity does nothing: add gravity times dt to the velocity in each step."},
      {"gravity*-1", "gravity_upwards", "1",
       "The ball falls upwards: y points up, and the scene's gravity is negative already; add it."},
      {"gravity*2", "gravity_twice", "12",
       "Gravity acts twice a step: is it added as a force and as an acceleration?"},
      {"gravity*0.5", "gravity_halved", "12",
       "Half of gravity acts: v grows by g dt. The half belongs to the distance, g t^2/2."},
      {"gravity_hard_coded", "gravity_hard_coded", "1",
       "Gravity is 9.81 m/s^2 downwards whatever the scene says: take \"gravity\" from the scene."},
      {"gravity_of_9_8", "gravity_hard_coded", "1",
       "Gravity is 9.8 m/s^2 downwards whatever the scene says: take \"gravity\" from the scene."},
      {"gravity_of_10", "gravity_hard_coded", "1",
       "Gravity is 10 m/s^2 downwards whatever the scene says: take \"gravity\" from the scene."},
      {"gravity_of_9_80665", "gravity_hard_coded", "1",
       "Gravity is 9.80665 m/s^2 downwards whatever the scene says: take \"gravity\" from the scene."},
      {"gravity_only_down", "gravity_only_down", "1", "Gravity is a vector: its x counts as well."},
      {"gravity_components_swapped", "gravity_mixed", "1",
       "The components of gravity are mixed up: gravity[0] changes vx alone, and gravity[1] changes vy "
       "alone."},
      {"gravity_x_into_y", "gravity_mixed", "1",
       "The components of gravity are mixed up: gravity[0] changes vx alone, and gravity[1] changes vy "
       "alone."},
      {"gravity_y_into_x", "gravity_mixed", "1",
       "The components of gravity are mixed up: gravity[0] changes vx alone, and gravity[1] changes vy "
       "alone."},
      {"gravity_lost_on_contact", "gravity_lost_on_contact", "1",
       "After the first contact gravity does nothing: it acts in each step, also on a body that touches "
       "something; the contact's impulse holds it up."},
      {"starts_at_rest", "starts_at_rest", "12",
       "The ball starts at rest: take \"velocity\" from the scene."},
      {"dt_twice", "dt_twice", "1", "dt enters twice: the velocity grows by g dt each step, not by g dt dt."},
      {"dt_missing", "dt_missing", "1",
       "dt is missing: each step adds all of g to the velocity, and should add g dt."},
      {"milliseconds", "milliseconds", "1", "A thousand times too fast: dt is in seconds, not milliseconds."},
      {"per_frame", "per_frame", "1",
       "Something is added once a step and does not depend on dt. Multiply it by dt."},
      {"time_for_dt", "time_for_dt", "12", kTimeForStep},
      {"next_time_for_dt", "time_for_dt", "12", kTimeForStep},
      {"time_for_dt_in_moves", "time_for_dt", "1", kTimeForStep},
      {"next_time_in_moves", "time_for_dt", "1", kTimeForStep},
      {"move_per_frame", "per_frame", "1",
       "A position changes by v/60 a step, whatever dt is: by v dt, with the dt of the settings."},
      {"explicit_euler", "explicit_euler", "12",
       "The motion is that of explicit Euler (position first, with the old velocity), and \"hello\" declares "
       "another scheme. It adds energy every step: update the velocity first, then move with the new one."},
      {"half_a_step_twice", "half_a_step_twice", "1",
       "Each step moves g dt^2/2 too far: the new velocity already includes g dt, so move by v dt alone."},
      {"velocity_without_dt", "velocity_without_dt", "1", "Each step moves the ball by v, not by v dt."},
      {"velocity_with_dt_twice", "velocity_with_dt_twice", "1",
       "Each step moves the ball by v dt dt, not by v dt."},
      {"constant_speed", "constant_speed", "1",
       "The ball keeps its first speed: keep the velocity from step to step."},
      {"moves_by_first_velocity", "constant_speed", "1",
       "The position changes by the first velocity in all steps: move by the velocity of now."},
      {"velocity in the position's change*0", "does_not_move", "1",
       "The position never changes: add v dt to it in each step."},
      {"velocity in the position's change*0.5", "moves_half", "1",
       "The ball moves half as far as its velocity says: add v dt to the position, not v dt/2."},
      {"velocity in the position's change*2", "moves_twice", "1",
       "The ball moves twice as far as its velocity says: is the position changed twice a step?"},
      {"velocity in the position's change*-1", "moves_backwards", "1",
       "The ball moves against its velocity: add v dt to the position."},
      {"answers_before_the_step", "a_step_late", "124",
       "All motion comes a step late: answer with the states after the step; the start is not a sample."},
      {"first_step_twice", "a_step_ahead", "124",
       "All motion is a step ahead: the first sample comes after \"every\" steps, and not after one more."},
      {"speed below which bodies stop*0.01", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies stop*0.05", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies stop*0.1", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies stop*0.2", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies stop*0.3", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies stop*0.5", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies stop*1", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies do not move*0.05", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies do not move*0.1", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies do not move*0.5", "slow_is_stopped", "1", kSlowIsStopped},
      {"gravity_off_while_touching", "gravity_off_while_touching", "1",
       "Gravity does nothing in the step after a contact: it acts in each step, also on a body that touches "
       "something; the contact's impulse holds it up."},
      {"damping", "damping", "1",
       "Each step multiplies the velocity by 0.99: nothing here slows the ball, so leave that out."},
      {"size of a box*2", "whole_sizes", "1",
       "The walls are twice their size: a box reaches half of its width and half of its height from its "
       "centre."},
      {"width of a box*2", "whole_sizes", "1",
       "Boxes reach their whole width from their centre along x: it is half of the width."},
      {"height of a box*2", "whole_sizes", "1",
       "Boxes reach their whole height from their centre along y: it is half of the height."},
      {"size of a box*0.5", "quarter_sizes", "1",
       "The walls have half their size: a box reaches half of its width and half of its height from its "
       "centre, not a quarter."},
      {"width_and_height_swapped", "sides_swapped", "14",
       "The width and the height of a box are swapped: \"width\" is along x, at angle 0."},
      {"width_for_both", "one_side_for_both", "14",
       "Boxes are taken for squares of their width: half of the width is along x, half of the height along "
       "y."},
      {"height_for_both", "one_side_for_both", "14",
       "Boxes are taken for squares of their height: half of the width is along x, half of the height along "
       "y."},
      {"corner_for_centre", "corner_for_centre", "14",
       "Boxes stand half a width and half a height from their place: \"position\" is a body's centre, not "
       "its lower left corner."},
      {"upper_corner_for_centre", "corner_for_centre", "14",
       "Boxes stand half a width and half a height from their place: \"position\" is a body's centre, not "
       "its upper left corner."},
      {"radius*2", "diameters", "1",
       "The ball has twice its radius: compare the distance with the radius, not with the diameter."},
      {"radius*0.5", "radius_halved", "13",
       "Circles touch at half of their radius: \"radius\" is the radius already, not the diameter."},
      {"circle_as_square_at_box", "circles_as_squares", "134",
       "A ball touches a box as a square would: at a corner of the box it touches when its centre is a "
       "radius "
       "away "
       "from the nearest point, in any direction."},
      {"square_for_distance_at_box", "square_of_distance", "1",
       "The square of the distance from the wall stands for the distance: take the root."},
      {"wall_normal_flipped", "normal_flipped", "1",
       "The ball is pulled into the floor: the normal points into the wall, and should point out of it, "
       "towards the ball."},
      {"wall_normal_not_unit", "normal_not_unit", "1",
       "The bounce depends on the normal's length: divide the normal by its length."},
      {"wall_normal_from_centre", "normal_from_centre", "1",
       "The bounce is along the line from the wall's centre: the normal runs from the wall's nearest point "
       "to "
       "the ball's centre."},
      {"wall_normal_longer_axis", "normal_from_centre", "1",
       "The normal is the axis along which the ball is farther from the wall's centre: it runs from the "
       "wall's nearest point to the ball's centre."},
      {"wall_normal_up", "normal_up", "1",
       "Each wall answers as a floor does: the normal runs from the wall's nearest point to the ball's "
       "centre, and is up for the floor alone."},
      {"wall_normal_along_velocity", "normal_along_velocity", "1",
       "The bounce is against the velocity: the normal runs from the wall's nearest point to the ball's "
       "centre, whatever the velocity is."},
      {"bounce_of_whole_speed", "bounce_of_whole_speed", "13",
       "The speed along the normal after a bounce is e times the whole speed before it: it is e times the "
       "part along the normal, -e vn."},
      {"wall_missing", "wall_missing", "1", kWallMissing},
      {"left_wall_missing", "wall_missing", "1", kWallMissing},
      {"upper_wall_missing", "wall_missing", "1", kWallMissing},
      {"lower_wall_missing", "wall_missing", "1", kWallMissing},
      {"falls_through", "falls_through", "1",
       "The ball goes through the floor: no contact is found, or the velocity is not changed."},
      {"both_turned", "both_turned", "1",
       "The whole velocity is reversed: reverse only its part along the wall's normal."},
      {"whole_velocity_scaled", "both_turned", "1",
       "The whole velocity is multiplied by -e: only its part along the wall's normal is."},
      {"wrong_axis", "wrong_axis", "1",
       "The wall reverses the wrong component: the floor's normal points up, so it reverses vy."},
      {"only_vy_turned", "only_one_axis", "1",
       "Every wall turns vy alone: a wall turns the velocity's part along its own normal, which is vx at a "
       "wall on "
       "the left or right."},
      {"only_vx_turned", "only_one_axis", "1",
       "Every wall turns vx alone: a wall turns the velocity's part along its own normal, which is vy at the "
       "floor."},
      {"never_rests", "restless", "1",
       "The speed that gravity adds in a step bounces as well: take the restitution as 0 below about 2 g "
       "dt."},
      {"stops_dead", "stops_dead", "1",
       "The ball stops dead: only the normal part of the velocity changes, by -e."},
      {"velocity_sign_lost", "velocity_sign_lost", "1",
       "Every bounce sends the ball up or to the right: a bounce reverses the part of the velocity along the "
       "normal, -e v, and does not take its magnitude."},
      {"bounce_sign", "bounce_sign", "13",
       "The contact leaves e of the closing speed in place of turning it: the speed after a bounce is -e "
       "times the one before. The impulse is -(1 + e) vn, not -(1 - e) vn."},
      {"bounce_each_sweep", "bounce_each_sweep", "134",
       "Each sweep over the contacts turns the velocity again: compute the bounce -e vn once, before the "
       "first "
       "sweep."},
      {"bounce_without_speed", "bounce_without_speed", "134",
       "Every bounce gives back e in m/s, however fast the bodies came: it is e times the closing speed, -e "
       "vn."},
      {"one_plus_twice", "one_plus_twice", "13",
       "The speed that a bounce gives back has 1 + e where it should have e: the change is (1 + e) times the "
       "speed, and 1 of it only stops the ball."},
      {"one_plus_forgotten", "one_plus_forgotten", "13",
       "The contact takes away e of the speed: the change is (1 + e) times it, 1 to stop the ball and e to "
       "send it back."},
      {"along_wall_changed", "along_wall_changed", "1",
       "The bounce changes the speed along the wall as well: only the part along the normal changes."},
      {"threshold_reversed", "threshold_reversed", "13",
       "Slow impacts bounce and fast ones do not: restitution is 0 below the threshold, and acts above it."},
      {"clamp_above_only", "clamp_incomplete", "134", kClampIncomplete},
      {"clamp_below_only", "clamp_incomplete", "134", kClampIncomplete},
      {"clamp_of_x_only", "clamp_incomplete", "134", kClampIncomplete},
      {"clamp_of_y_only", "clamp_incomplete", "134", kClampIncomplete},
      {"clamp_of_x_above_only", "clamp_incomplete", "134", kClampIncomplete},
      {"clamp_of_x_below_only", "clamp_incomplete", "134", kClampIncomplete},
      {"clamp_of_y_above_only", "clamp_incomplete", "134", kClampIncomplete},
      {"clamp_of_y_below_only", "clamp_incomplete", "134", kClampIncomplete},
      {"clamp_exchanged", "clamp_exchanged", "134", kClampExchanged},
      {"clamp_exchanged_below", "clamp_exchanged", "134", kClampExchanged},
      {"threshold_too_high", "threshold_too_high", "13",
       "The ball stops at 2 m/s and bounces when it is faster: the speed below which restitution is 0 is too "
       "high. It is 2 g dt, or the scene's \"restitution_threshold\"."},
      {"turned_every_step", "turned_every_step", "1",
       "The ball sticks in the wall: its velocity is reversed in each step that it overlaps the wall. "
       "Reverse it only if it moves towards the wall, v . n < 0, and push the ball out."},
      {"impulse of a contact*2", "impulse_twice", "134",
       "Each contact acts twice a step: apply its impulse once. Is each pair found twice, as a with b and b "
       "with a?"},
      {"restitution_squared", "restitution_squared", "13",
       "Restitution is applied twice: multiply the speed by e once."},
      {"restitution_root", "restitution_root", "13",
       "The energy is multiplied by e: restitution multiplies the speed."},
      {"always_elastic", "restitution_ignored", "1",
       "All of the speed comes back: multiply it by the restitution."},
      {"restitution*0", "restitution_zero", "1",
       "None of the speed comes back: restitution is not used, or what it gives is taken back in the same "
       "step. If you go over contacts several times, compute the bounce -e vn once, before the first time."},
      {"restitution*0.5", "restitution_halved", "13",
       "Half of the restitution acts: is the sum of the two bodies' divided, or the impulse applied in two "
       "halves?"},
      {"restitution_of_one_less", "restitution_of_one_less", "13",
       "The speed is multiplied by 1 - e: it should be e."},
      {"restitution_average", "restitution_average", "1",
       "The two restitutions are averaged: \"contact_rules\" says maximum."},
      {"restitution_product", "restitution_product", "1",
       "The two restitutions are multiplied: \"contact_rules\" says maximum."},
      {"restitution_mean", "restitution_mean", "1",
       "The geometric mean of the two restitutions is taken: \"contact_rules\" says maximum."},
      {"restitution_minimum", "restitution_minimum", "1",
       "The smaller of the two restitutions counts, here the wall's: \"contact_rules\" says maximum."},
      {"restitution_of_the_first", "restitution_of_one", "13",
       "The restitution of the body that comes first counts: \"contact_rules\" says maximum, of both."},
      {"restitution_of_the_second", "restitution_of_one", "13",
       "The restitution of the body that comes second counts: \"contact_rules\" says maximum, of both."},
      {"restitution_of_the_moving", "restitution_of_one", "1",
       "The ball's restitution counts: \"contact_rules\" says maximum, of both."},
      {"restitution_of_the_static", "restitution_of_wall", "1",
       "The wall's restitution counts: \"contact_rules\" says maximum, of both."},
      {"restitution_sum", "restitution_sum", "13",
       "The two restitutions are added: \"contact_rules\" says maximum."},
      {"sinks", "sinks", "1",
       "The ball sinks into the floor little by little: correct its position as well as its velocity."},
      {"ignores_slow", "sinks", "1",
       "The ball sinks into the floor: stop it in each step in which it moves towards the floor, however "
       "slowly."},
      {"correction_adds_energy", "correction_adds_energy", "13",
       "Correcting an overlap adds speed: correct positions, and leave velocities as they are."},
      {"mass_not_divided", "mass_not_divided", "2",
       "The force is not divided by the mass: a = F/m; a ball of 1 kg hides it."},
      {"mass_multiplied", "mass_multiplied", "2", "The force is multiplied by the mass: a = F/m."},
      {"mass_divided_twice", "mass_divided_twice", "2", "The force is divided by the mass twice."},
      {"mass_from_area", "mass_from_size", "234", kMassFromSize},
      {"mass_from_density", "mass_from_size", "234", kMassFromSize},
      {"mass_from_radius", "mass_from_size", "23", kMassFromSize},
      {"mass_from_square", "mass_from_size", "23", kMassFromSize},
      {"mass_of_one", "mass_ignored", "2", "Every body has a mass of 1 kg: take \"mass\" from the scene."},
      {"root_of_mass", "mass_root", "2", "The force is divided by the root of the mass: a = F/m."},
      {"gravity_divided_by_mass", "gravity_divided_by_mass", "2",
       "Gravity is divided by the mass: it is an acceleration already. As a force it is m g, and m g/m = g."},
      {"weight_not_divided", "weight_not_divided", "2",
       "Gravity is multiplied by the mass: the weight m g is a force, to be divided by the mass."},
      {"force*0", "force_ignored", "24", "The force does nothing: add F dt/m to the velocity each step."},
      {"force*0.5", "force_halved", "24", "Half of the force acts: a step adds F dt/m to the velocity."},
      {"force*2", "force_twice", "24",
       "The force acts twice a step: add it once, and go through forces once."},
      {"force*-1", "force_backwards", "24", "The force pushes backwards: add it, do not subtract it."},
      {"weight_with_every_force", "weight_with_every_force", "2",
       "Each force brings the body's weight along: gravity acts once a step and body, whatever the number of "
       "forces."},
      {"force*9.81", "force_in_kilograms", "2",
       "9.81 times too fast: the force is in newtons already, F/m is the acceleration."},
      {"force*0.1019367991845056", "force_in_kilograms", "2",
       "9.81 times too slow: the force is in newtons already, F/m is the acceleration."},
      {"force_without_dt", "force_without_dt", "2",
       "dt is missing: a step adds F dt/m to the velocity, not F/m."},
      {"force_dt_twice", "force_dt_twice", "2", "dt enters twice: a step adds F dt/m to the velocity, once."},
      {"force_per_frame", "per_frame", "2",
       "A force adds the same in each step, however long it is: it adds F dt/m."},
      {"drag_along_x_only", "drag_along_one_axis", "2", "Drag acts along x alone: it is -c v, a vector."},
      {"force_once", "force_once", "2",
       "The force acts for one step only: it lasts until its duration is over."},
      {"force_of_the_first_not_cleared", "force_not_cleared", "2", kSomeNotCleared},
      {"force_of_others_not_cleared", "force_not_cleared", "2", kSomeNotCleared},
      {"force_not_cleared", "force_not_cleared", "2",
       "The force piles up from step to step: set the sum of forces to zero at the start of each step."},
      {"mass in F/m#the first", "mass_of_another", "2", kMassOfAnother},
      {"mass in F/m#the last", "mass_of_another", "2", kMassOfAnother},
      {"last_force_only", "last_force_only", "2",
       "Only the last force counts: add forces up (+=), do not set (=)."},
      {"first_force_only", "first_force_only", "2", "Only the first force counts: go through all of them."},
      {"first_force_lost", "first_force_lost", "2", "The first force is not added."},
      {"last_force_lost", "last_force_lost", "2", "The last force is not added."},
      {"push_never_ends", "push_never_ends", "2", "The push goes on: it ends at start + duration."},
      {"push_always", "push_always", "2",
       "The push acts all the time: \"start\" and \"duration\" are not used."},
      {"push_starts_at_once", "push_starts_at_once", "2",
       "The push acts from the beginning: it starts at \"start\"."},
      {"push_ends_at_duration", "push_missed", "2",
       "The push is missed: compare the time, in s, with \"start\" and \"start\" + \"duration\"."},
      {"push_in_steps", "push_missed", "2",
       "The push is missed: compare the time, in s, with \"start\" and \"start\" + \"duration\"."},
      {"push_for_one_step", "force_once", "2",
       "The force acts for one step only: it acts in all steps that begin from start to start + duration."},
      {"push_a_step_late", "push_a_step_late", "2",
       "The force begins a step late: it acts in the step that begins at \"start\" as well."},
      {"endless_never_acts", "endless_force_ends", "2",
       "A force without \"duration\" never acts, as if its duration were 0: it never ends."},
      {"untimed_never_acts", "endless_force_ends", "2",
       "What has no \"duration\" never acts, neither pushes nor drag and springs: it never ends."},
      {"endless_for_one_step", "endless_force_ends", "2",
       "A force without \"duration\" acts for one step only: it never ends."},
      {"endless_for_one_second", "endless_force_ends", "2",
       "A force without \"duration\" acts for a second only: it never ends."},
      {"push_outside_its_time", "push_outside_its_time", "2",
       "The push acts before \"start\" and after its end, and not between: its test is reversed."},
      {"push_from_zero", "push_from_zero", "2",
       "The push acts from 0 to \"duration\": it acts from \"start\" to \"start\" + \"duration\"."},
      {"drag*0", "drag_ignored", "2", "Drag does nothing."},
      {"drag*0.5", "drag_halved", "2",
       "Half of the drag acts: linear_drag is -c v, the half belongs to the quadratic law."},
      {"drag*2", "drag_twice", "2", "Drag acts twice a step."},
      {"drag_pushes", "drag_pushes", "2", "Drag speeds the ball up: it is -c v, against the velocity."},
      {"drag_not_divided", "drag_not_divided", "2", "Drag is a force: divide it by the mass."},
      {"drag_divided_twice", "drag_divided_twice", "2", "Drag is divided by the mass twice."},
      {"drag_on_the_first_body", "force_on_wrong_body", "2",
       "Drag acts on the first body of the scene, whichever it is for: it acts on its \"body\"."},
      {"drag_on_the_last_body", "force_on_wrong_body", "2",
       "Drag acts on the last body of the scene, whichever it is for: it acts on its \"body\"."},
      {"force_on_the_first_body", "force_on_wrong_body", "24",
       "A force acts on the first body of the scene, whichever it is for: it acts on its \"body\"."},
      {"force_on_the_last_body", "force_on_wrong_body", "24",
       "A force acts on the last body of the scene, whichever it is for: it acts on its \"body\"."},
      {"drag_quadratic_by_component", "drag_quadratic", "2",
       "Drag grows with the square of each component, as -c |vx| vx along x: it is -c v."},
      {"drag_constant_by_component", "drag_constant", "2",
       "Drag along x and y has the size c at any speed: it is -c v."},
      {"drag_constant", "drag_constant", "2", "Drag does not grow with speed: it is c v, not c."},
      {"drag_by_position", "drag_of_another_vector", "2",
       "Drag acts against the position: it is -c v, against the velocity."},
      {"drag_by_first_velocity", "drag_of_another_vector", "2",
       "Drag acts against the first velocity in all steps: it is -c v, with the velocity of now."},
      {"drag_along_x_always", "drag_direction", "2",
       "Drag acts along x whatever the direction of the motion: it is -c v, a vector against the velocity."},
      {"drag_along_y_always", "drag_direction", "2",
       "Drag acts along y whatever the direction of the motion: it is -c v, a vector against the velocity."},
      {"drag_quadratic", "drag_quadratic", "2",
       "Drag grows with the square of the speed: linear_drag is c v."},
      {"rest length of a spring*0", "rest_length_ignored", "2",
       "The spring pulls to its anchor: take \"rest_length\" off the length."},
      {"rest length of a spring*0.5", "rest_length_halved", "2",
       "The spring is at rest at half of its rest length: its force is stiffness (length - rest_length)."},
      {"rest length of a spring*2", "rest_length_twice", "2",
       "The spring is at rest at twice its rest length: its force is stiffness (length - rest_length)."},
      {"rest length of a spring*-1", "rest_length_added", "2",
       "The rest length is added to the length: take it off."},
      {"stiffness of a spring*0", "spring_ignored", "2", "The spring does nothing."},
      {"stiffness of a spring*-1", "spring_pushes", "2",
       "The spring pushes where it should pull: the force on the ball points back to its rest length."},
      {"stiffness of a spring*0.5", "stiffness_wrong", "2",
       "Half of the stiffness acts: the force is stiffness (length - rest_length), on both ends."},
      {"stiffness of a spring*2", "stiffness_wrong", "2",
       "Twice the stiffness acts: the force is stiffness (length - rest_length), once."},
      {"spring_only_pulls", "spring_only_pulls", "2",
       "The spring only pulls: shorter than at rest it pushes, with the same stiffness."},
      {"spring_always_pulls", "spring_sign_lost", "2",
       "The spring pulls when it is short as well: keep the sign of length - rest_length."},
      {"spring_always_pushes", "spring_sign_lost", "2",
       "The spring pushes when it is long as well: keep the sign of length - rest_length."},
      {"spring_dt_twice", "force_dt_twice", "2",
       "dt enters twice: the spring's force adds F dt/m to the velocity, once."},
      {"spring_only_pushes", "spring_only_pushes", "2",
       "The spring only pushes: longer than at rest it pulls, with the same stiffness."},
      {"spring_by_sign", "spring_constant", "2",
       "The spring's force does not grow with its stretch: it is stiffness (length - rest_length)."},
      {"spring_by_component", "spring_by_component", "2",
       "The rest length is taken off the x and the y of the way from end to end: it is taken off the length "
       "alone, and "
       "the force is along the way."},
      {"spring_by_square", "spring_by_square", "2",
       "The spring's force grows with the square of its stretch: it is stiffness (length - rest_length)."},
      {"spring_not_unit", "spring_not_unit", "2",
       "The spring's force is multiplied by its length: divide the way from end to end by its length to get "
       "the direction."},
      {"spring_way_for_direction", "spring_not_unit", "2",
       "The way from end to end stands for the spring's direction: divide it by its length."},
      {"spring_over_square", "spring_not_unit", "2",
       "The way from end to end is divided by the square of its length: divide it by its length to get the "
       "direction."},
      {"spring_over_rest_length", "spring_not_unit", "2",
       "The way from end to end is divided by the spring's rest length: divide it by its length of now to "
       "get the "
       "direction."},
      {"spring_by_strain", "spring_by_strain", "2",
       "The spring's force is stiffness times the strain, (length - rest_length)/rest_length: it is "
       "stiffness "
       "(length - rest_length), as the stiffness is in N/m."},
      {"spring_by_strain_of_now", "spring_by_strain", "2",
       "The spring's stretch is divided by its length: the force is stiffness (length - rest_length), as the "
       "stiffness is in N/m."},
      {"spring_times_rest_length", "spring_by_strain", "2",
       "The spring's force is multiplied by its rest length: it is stiffness (length - rest_length), as the "
       "stiffness is in N/m."},
      {"spring_mass_not_divided", "mass_not_divided", "2", "The spring's force is not divided by the mass."},
      {"spring_divided_by_mass_twice", "mass_divided_twice", "2",
       "The spring's force is divided by the mass twice."},
      {"spring_anchor_of_world_ignored", "spring_anchor_ignored", "2",
       "A spring's end that is a point of the world pulls to the origin: \"world\" is a body at the origin, "
       "and the "
       "anchor is a point of it."},
      {"spring_anchors_ignored", "spring_anchor_ignored", "24",
       "A spring holds the centres of its bodies: it holds the anchors."},
      {"spring_anchors_not_turned", "anchor_not_turned", "4",
       "The anchors of a spring do not turn with their bodies: turn each by its body's angle."},
      {"inverse_mass_floored", "integer_division", "1234",
       "1/m is rounded down to an integer, so that heavy bodies do not feel forces and impulses: divide as "
       "real "
       "numbers."},
      {"half_sizes_floored", "integer_division", "14",
       "Half of a box's width and height is rounded down to an integer: divide as real numbers."},
      {"inertia_floored", "integer_division", "45",
       "The inertia is rounded down to an integer: divide as real numbers."},
      {"spring_pulls_the_first_only", "spring_at_one_end", "2", kSpringAtOneEnd},
      {"spring_pulls_the_second_only", "spring_at_one_end", "2", kSpringAtOneEnd},
      {"spring_same_direction", "same_direction_for_both", "2",
       "Both ends of the spring are pulled in the same direction: a is pulled towards b, and b towards a."},
      {"spring_pulls_both_as_the_first", "same_direction_for_both", "2",
       "Both ends of the spring are pulled in the same direction: a is pulled towards b, and b towards a."},
      {"rest_length_of_start", "rest_length_of_start", "2",
       "A spring is at rest at the length that it has at the start: take \"rest_length\" from the scene."},
      {"length_squared", "length_squared", "2",
       "The spring takes the square of the distance for its length: take the root."},
      {"drag_dt_twice", "drag_dt_twice", "2",
       "Drag is multiplied by dt twice: it is a force, -c v, and the step multiplies it by dt/m."},
      {"damping_by_speed", "damping_by_speed", "2",
       "The damping of a spring follows the speed of its ends, which has no sign: it acts against the rate "
       "at "
       "which the length changes, (vb - va) . n, and that has one."},
      {"damping of a spring*0", "damping_ignored", "2",
       "The spring's damping is left out: its force is stiffness (length - rest_length) + damping (speed at "
       "which the ends part)."},
      {"damping of a spring*-1", "damping_backwards", "2",
       "The spring's damping drives it: it acts against the speed at which the ends part."},
      {"damping of a spring*0.5", "damping_wrong", "2",
       "Half of the spring's damping acts: it is damping times the speed at which the ends part."},
      {"damping of a spring*2", "damping_wrong", "2",
       "Twice the spring's damping acts: it is damping times the speed at which the ends part, once."},
      {"spring_damps_the_sum", "damping_by_sum", "2",
       "The spring's damping follows the sum of the ends' velocities: it acts against the speed at which the "
       "ends "
       "part, (vb - va) . n."},
      {"spring_damps_the_first_only", "damping_of_one_end", "2", kDampingOfOneEnd},
      {"spring_damps_the_second_only", "damping_of_one_end", "2", kDampingOfOneEnd},
      {"restitution*2", "restitution_twice", "13",
       "The motion is that of an engine in which the restitution is used twice."},
  };
}

}  // namespace plumb::course
