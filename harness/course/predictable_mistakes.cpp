#include "harness/course/prediction.h"

// The mistakes whose motion can be computed: those that the learner's engine makes on request.
namespace plumb::course {
namespace {

// Causes that several mistakes share.
constexpr const char* kSlowIsStopped =
    "What is slow is stopped, and so never begins to move: gravity and forces act on a body at rest as well. "
    "Leave out what sets small velocities to 0.";
constexpr const char* kSecondMoment =
    "A second moment of area stands where the inertia of a mass should: a box has m (w^2 + h^2)/12.";
constexpr const char* kArmOfTheOther =
    "An impulse acts at the other body's arm: each body has its own r, from its centre to the point.";
constexpr const char* kNotOpposite =
    "The two impulses are not opposite: compute j once, from the velocities before either changes, and apply "
    "it to both.";
constexpr const char* kOneNeverSpins =
    "Only one of the two bodies gets spin from the joint: each changes its w by r x j/I, with its own r and "
    "I, and a gets the opposite impulse.";
constexpr const char* kNotTurned =
    "The normal is right in one order of the two bodies and points the wrong way in the other: it points "
    "from a "
    "to b. Where n . (xb - xa) is below 0, take -n.";
constexpr const char* kTooFar =
    "What overlaps is moved too far: it is moved by the overlap, radius - distance, and not by the radius or "
    "the "
    "distance.";
constexpr const char* kOneSweep =
    "Each contact is solved once a step, so that what one of them changes spoils the others: go over all "
    "contacts "
    "10 to 30 times a step.";
constexpr const char* kOneSign =
    "A joint's impulse has one sign only, as that of a contact: a joint pulls and pushes. Do not clamp its "
    "impulse, "
    "nor the sum of its impulses.";
constexpr const char* kJointPoint =
    "A joint does not see the speed of its anchors: it is v + w x r, which is (vx - w ry, vy + w rx), with "
    "each "
    "body's own r.";
constexpr const char* kJointSpin =
    "The joint's impulse spins a body the wrong way: w changes by (rx jy - ry jx)/I, and a gets the opposite "
    "impulse.";
constexpr const char* kOneEnd =
    "Correcting a joint's positions moves one end only: both move, each by its share of the inverse masses.";

}  // namespace

std::vector<Predictable> predictable_mistakes() {
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
      {"speed below which bodies stop*0.2", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies stop*0.3", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies stop*0.5", "slow_is_stopped", "1", kSlowIsStopped},
      {"speed below which bodies stop*1", "slow_is_stopped", "1", kSlowIsStopped},
      {"gravity_off_while_touching", "gravity_off_while_touching", "1",
       "Gravity does nothing in the step after a contact: it acts in each step, also on a body that touches "
       "something; the contact's impulse holds it up."},
      {"damping", "damping", "1",
       "Each step multiplies the velocity by 0.99: nothing here slows the ball, so leave that out."},
      {"size of a box*2", "whole_sizes", "1",
       "The walls are twice their size: a box reaches half of its width and half of its height from its "
       "centre."},
      {"size of a box*0.5", "quarter_sizes", "1",
       "The walls have half their size: a box reaches half of its width and half of its height from its "
       "centre, not a quarter."},
      {"width_and_height_swapped", "sides_swapped", "14",
       "The width and the height of a box are swapped: \"width\" is along x, at angle 0."},
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
      {"falls_through", "falls_through", "1",
       "The ball goes through the floor: no contact is found, or the velocity is not changed."},
      {"both_turned", "both_turned", "1",
       "The whole velocity is reversed: reverse only its part along the wall's normal."},
      {"whole_velocity_scaled", "both_turned", "1",
       "The whole velocity is multiplied by -e: only its part along the wall's normal is."},
      {"wrong_axis", "wrong_axis", "1",
       "The wall reverses the wrong component: the floor's normal points up, so it reverses vy."},
      {"stops_dead", "stops_dead", "1",
       "The ball stops dead: only the normal part of the velocity changes, by -e."},
      {"velocity_sign_lost", "velocity_sign_lost", "1",
       "Every bounce sends the ball up or to the right: a bounce reverses the part of the velocity along the "
       "normal, -e v, and does not take its magnitude."},
      {"bounce_sign", "bounce_sign", "13",
       "The contact leaves e of the closing speed in place of turning it: the speed after a bounce is -e "
       "times the one before. The impulse is -(1 + e) vn, not -(1 - e) vn."},
      {"one_plus_forgotten", "one_plus_forgotten", "13",
       "The contact takes away e of the speed: the change is (1 + e) times it, 1 to stop the ball and e to "
       "send it back."},
      {"along_wall_changed", "along_wall_changed", "1",
       "The bounce changes the speed along the wall as well: only the part along the normal changes."},
      {"threshold_too_high", "threshold_too_high", "13",
       "The ball stops at 2 m/s and bounces when it is faster: the speed below which restitution is 0 is too "
       "high. It is 2 g dt, or the scene's \"restitution_threshold\"."},
      {"turned_every_step", "turned_every_step", "1",
       "The ball sticks in the wall: its velocity is reversed in each step that it overlaps the wall. "
       "Reverse it only if it moves towards the wall, v . n < 0, and push the ball out."},
      {"impulse of a contact*0.5", "impulse_halved", "3",
       "The impulse is half of what it should be: it is -(1 + e) vn/(1/m1 + 1/m2)."},
      {"impulse of a contact*2", "impulse_twice", "134",
       "Each contact acts twice a step: apply its impulse once. Is each pair found twice, as a with b and b "
       "with a?"},
      {"impulse of a contact*-1", "impulse_backwards", "3",
       "They speed up into each other: the impulse has the wrong sign. The normal points from a to b, and a "
       "gets -j n, b +j n."},
      {"restitution_squared", "restitution_squared", "13",
       "Restitution is applied twice: multiply the speed by e once."},
      {"restitution_root", "restitution_root", "13",
       "The energy is multiplied by e: restitution multiplies the speed."},
      {"always_elastic", "restitution_ignored", "1",
       "All of the speed comes back: multiply it by the restitution."},
      {"always_elastic", "always_elastic", "3", "Every collision is elastic: restitution is not used."},
      {"restitution*0", "restitution_zero", "1",
       "None of the speed comes back: restitution is not used, or what it gives is taken back in the same "
       "step. If you go over contacts several times, compute the bounce -e vn once, before the first time."},
      {"restitution*0", "restitution_ignored", "3",
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
      {"force_not_cleared", "force_not_cleared", "2",
       "The force piles up from step to step: set the sum of forces to zero at the start of each step."},
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
      {"push_from_zero", "push_from_zero", "2",
       "The push acts from 0 to \"duration\": it acts from \"start\" to \"start\" + \"duration\"."},
      {"drag*0", "drag_ignored", "2", "Drag does nothing."},
      {"drag*0.5", "drag_halved", "2",
       "Half of the drag acts: linear_drag is -c v, the half belongs to the quadratic law."},
      {"drag*2", "drag_twice", "2", "Drag acts twice a step."},
      {"drag_pushes", "drag_pushes", "2", "Drag speeds the ball up: it is -c v, against the velocity."},
      {"drag_not_divided", "drag_not_divided", "2", "Drag is a force: divide it by the mass."},
      {"drag_divided_twice", "drag_divided_twice", "2", "Drag is divided by the mass twice."},
      {"drag_constant", "drag_constant", "2", "Drag does not grow with speed: it is c v, not c."},
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
      {"spring_only_pushes", "spring_only_pushes", "2",
       "The spring only pushes: longer than at rest it pulls, with the same stiffness."},
      {"spring_by_sign", "spring_constant", "2",
       "The spring's force does not grow with its stretch: it is stiffness (length - rest_length)."},
      {"spring_by_square", "spring_by_square", "2",
       "The spring's force grows with the square of its stretch: it is stiffness (length - rest_length)."},
      {"spring_not_unit", "spring_not_unit", "2",
       "The spring's force is multiplied by its length: divide the way from end to end by its length to get "
       "the direction."},
      {"spring_mass_not_divided", "mass_not_divided", "2", "The spring's force is not divided by the mass."},
      {"spring_divided_by_mass_twice", "mass_divided_twice", "2",
       "The spring's force is divided by the mass twice."},
      {"no_detection", "no_detection", "3",
       "The circles go through each other: they touch when their centres are nearer than r1 + r2. Is the "
       "contact found, and are the velocities changed?"},
      {"impulse of a contact*0", "no_collision", "34",
       "The velocities do not change: no contact is found, or no impulse is applied."},
      {"diameters", "diameters", "3", "They turn back too early: add the radii, not the diameters."},
      {"one_radius", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with one radius."},
      {"other_radius", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with one radius."},
      {"larger_radius", "larger_radius", "3",
       "They touch at twice the larger radius: they touch at r1 + r2."},
      {"smaller_radius", "smaller_radius", "3",
       "They touch at twice the smaller radius: they touch at r1 + r2."},
      {"sum_of_squared_radii", "sum_of_squared_radii", "3",
       "They touch at the root of r1^2 + r2^2: they touch at r1 + r2, whose square is (r1 + r2)^2."},
      {"mean_of_radii", "mean_of_radii", "3", "They touch at (r1 + r2)/2: they touch at r1 + r2."},
      {"square_of_distance", "square_of_distance", "3",
       "The square of the distance is compared with r1 + r2: compare it with (r1 + r2)^2."},
      {"normal_flipped", "normal_flipped", "3",
       "The two are caught inside each other: they are pushed together when they part and let go when they "
       "close. The normal is flipped: it points from a to b, and they close when (vb - va) . n < 0."},
      {"normal_not_unit", "normal_not_unit", "3",
       "The impulse depends on the distance of the centres: divide the line of centres by its length to get "
       "the normal."},
      {"normal_over_square", "normal_not_unit", "3",
       "The impulse depends on the distance of the centres: divide the line of centres by its length to get "
       "the normal."},
      {"normal_along_x", "normal_along_axis", "3",
       "The normal of two circles is taken along an axis: it points along the line of centres, (b - a)/|b - "
       "a|."},
      {"normal_along_y", "normal_along_axis", "3",
       "The normal of two circles is taken along an axis: it points along the line of centres, (b - a)/|b - "
       "a|."},
      {"normal_along_longer_axis", "normal_along_axis", "3",
       "The normal of two circles is taken along an axis: it points along the line of centres, (b - a)/|b - "
       "a|."},
      {"normal_along_velocity", "normal_along_velocity", "3",
       "The impulse follows the velocity: it follows the line of centres."},
      {"normal_along_approach", "normal_along_velocity", "3",
       "The impulse follows the velocity: it follows the line of centres."},
      {"tangent", "tangent", "3", "The parts along and across the line of centres are mixed up."},
      {"y_of_normal_flipped", "y_of_normal_flipped", "3", "The y of the normal has the wrong sign."},
      {"whole_velocity", "whole_velocity", "3",
       "The whole velocities are exchanged: only the parts along the line of centres are."},
      {"each_turned", "each_turned", "3",
       "Each velocity is reversed by itself: reverse the relative velocity along the normal."},
      {"velocity_of_the_first_only", "relative_velocity", "3",
       "The velocity of the first ball alone is used: the impulse depends on the relative velocity, (vb - "
       "va) . n."},
      {"velocity_of_the_second_only", "relative_velocity", "3",
       "The velocity of the second ball alone is used: the impulse depends on the relative velocity, (vb - "
       "va) . n."},
      {"velocities_added", "relative_velocity", "3",
       "The two velocities are added: the impulse depends on the relative velocity, (vb - va) . n."},
      {"one_body_only", "one_body_only", "3",
       "Only the first ball gets an impulse: the second gets the opposite one."},
      {"other_body_only", "one_body_only", "3",
       "Only the second ball gets an impulse: the first gets the opposite one."},
      {"same_direction_for_both", "same_direction_for_both", "3",
       "Both balls get the impulse in the same direction: a gets -j n, b +j n."},
      {"masses_ignored", "masses_ignored", "3",
       "They swap velocities as equal masses do: the masses are not used."},
      {"inverse_mass_forgotten", "inverse_mass_forgotten", "3",
       "Both velocities change by j: each should change by j times its own inverse mass, so that the heavy "
       "ball barely slows."},
      {"inverse_mass_of_the_first", "one_inverse_mass", "3",
       "Both velocities change by j times the first ball's inverse mass: each has its own."},
      {"inverse_mass_of_the_second", "one_inverse_mass", "3",
       "Both velocities change by j times the second ball's inverse mass: each has its own."},
      {"masses_in_place_of_inverses", "masses_in_place_of_inverses", "3",
       "The impulse is too weak: it is divided by m1 + m2, which is right only for two masses of 1. It is "
       "-(1 + e) vn/(1/m1 + 1/m2)."},
      {"masses_swapped", "masses_swapped", "3", "Each ball gets the other's inverse mass."},
      {"effective_mass_forgotten", "effective_mass_forgotten", "3",
       "The impulse is not divided by 1/m1 + 1/m2."},
      {"multiplied_by_mass", "multiplied_by_mass", "3", "The impulse is multiplied by the masses: divide."},
      {"first_inverse_mass_only", "masses_wrong", "3",
       "The impulse is divided by the wrong sum: it is -(1 + e) vn/(1/ma + 1/mb)."},
      {"second_inverse_mass_only", "masses_wrong", "3",
       "The impulse is divided by the wrong sum: it is -(1 + e) vn/(1/ma + 1/mb)."},
      {"first_inverse_mass_for_both", "masses_wrong", "3",
       "The impulse is divided by the wrong sum: it is -(1 + e) vn/(1/ma + 1/mb)."},
      {"second_inverse_mass_for_both", "masses_wrong", "3",
       "The impulse is divided by the wrong sum: it is -(1 + e) vn/(1/ma + 1/mb)."},
      {"first_inverse_mass_twice", "masses_wrong", "3",
       "The impulse is divided by the wrong sum: it is -(1 + e) vn/(1/ma + 1/mb)."},
      {"second_inverse_mass_twice", "masses_wrong", "3",
       "The impulse is divided by the wrong sum: it is -(1 + e) vn/(1/ma + 1/mb)."},
      {"no_test_of_parting", "no_test_of_parting", "3",
       "Two balls that already part get another impulse, and are held together or sent back: answer a "
       "contact only if (vb - va) . n < 0, and keep the sum of a contact's impulses from becoming negative."},
      {"static_has_mass", "static_has_mass", "3",
       "The static post has a mass: its inverse mass is 0, so that no impulse changes its velocity."},
      {"correction_split_evenly", "correction_split_evenly", "3",
       "10 kg and 1 kg are moved equally far: each moves by its inverse mass over the sum of both, here 1 "
       "and 10 parts of 11."},
      {"correction_shares_swapped", "correction_shares_swapped", "3",
       "The heavy ball is moved ten times as far as the light one: the shares are swapped. Each moves by its "
       "inverse mass over the sum of both."},
      {"correction_of_the_first_only", "correction_of_one_only", "3",
       "Only the first ball is moved: both move, each by its share of the inverse masses."},
      {"correction_of_the_second_only", "correction_of_one_only", "3",
       "Only the second ball is moved: both move, each by its share of the inverse masses."},
      {"correction_without_masses", "correction_split_evenly", "3",
       "Both balls are moved by the whole overlap: each moves by its inverse mass over the sum of both."},
      {"correction of an overlap*-1", "pushed_together", "3",
       "The overlap grows: the correction pushes the two into each other. a moves against the normal, b "
       "along it."},
      {"inertia_sixth", "inertia_sixth", "45",
       "Twice too slow: is the inertia 1/6 where it should be 1/12? A box has m (w^2 + h^2)/12."},
      {"inertia of a box*0.5", "inertia_half", "45",
       "Twice too fast: is the inertia 1/24? A box has m (w^2 + h^2)/12."},
      {"inertia of a box*4", "inertia_third", "45",
       "Four times too slow: 1/3 is a rod about its end; about its centre it is 1/12."},
      {"inertia of a box*0.25", "half_sides", "45",
       "Four times too fast: m (w^2 + h^2)/12 takes the whole sides, not half of them."},
      {"inertia of a box*12", "inertia_twelfth_forgotten", "45",
       "Twelve times too slow: a box has m (w^2 + h^2)/12."},
      {"one_side_only", "one_side", "45", "The box's height is left out: a box has m (w^2 + h^2)/12."},
      {"other_side_only", "one_side", "45", "The box's width is left out: a box has m (w^2 + h^2)/12."},
      {"thin_box_as_square", "thin_box_as_square", "45",
       "The box spins as a square of its width does: w^2 + h^2, not 2 w^2."},
      {"square_of_its_height", "thin_box_as_square", "45",
       "The box spins as a square of its height does: w^2 + h^2, not 2 h^2."},
      {"square_of_sum", "square_of_sum", "45", "(w + h)^2 stands where w^2 + h^2 should."},
      {"box_by_area", "box_by_area", "45", "w h stands where w^2 + h^2 should."},
      {"mass_for_inertia", "mass_for_inertia", "45",
       "The torque is divided by the mass: divide it by the inertia."},
      {"inertia_of_one", "inertia_of_one", "45", "The inertia is 1, or forgotten: w grows by torque dt/I."},
      {"inertia_without_mass", "inertia_without_mass", "45",
       "The mass is left out of the inertia: a box has m (w^2 + h^2)/12, a disc m r^2/2."},
      {"second_moment_of_area", "second_moment_of_area", "45", kSecondMoment},
      {"second_moment_about_height", "second_moment_of_area", "45", kSecondMoment},
      {"second_moment_without_mass", "second_moment_of_area", "45", kSecondMoment},
      {"polar_moment_of_area", "second_moment_of_area", "45", kSecondMoment},
      {"disc_as_ring", "disc_as_ring", "4", "The disc spins as a ring does: m r^2/2, not m r^2."},
      {"disc_as_sphere", "disc_as_sphere", "4", "The disc spins as a sphere does: m r^2/2, not 2/5 m r^2."},
      {"disc_as_box", "disc_as_box", "4", "The disc spins as the box around it does: m r^2/2."},
      {"disc_by_diameter", "disc_by_diameter", "4",
       "The disc's inertia has its diameter in place of its radius: m r^2/2."},
      {"inertia of a disc*0.5", "disc_halved", "4",
       "The disc spins twice too fast: its inertia is m r^2/2, not m r^2/4."},
      {"torque*0", "torque_ignored", "4", "The torque does nothing: add torque dt/I to the spin."},
      {"torque*-1", "torque_backwards", "4",
       "It spins the wrong way: a positive torque turns counter-clockwise, y up."},
      {"torque_without_dt", "torque_without_dt", "4",
       "dt is missing: a step adds torque dt/I to the spin, not torque/I."},
      {"torque_dt_twice", "torque_dt_twice", "4", "dt enters twice: a step adds torque dt/I to the spin."},
      {"spin_damping", "spin_damped", "4",
       "Each step multiplies the spin by 0.99: nothing here slows it, so leave that out."},
      {"wrapped", "wrapped", "4", "The angle is wrapped at half a turn: it should count whole turns."},
      {"angle_in_degrees", "degrees", "4", "The angle is in degrees: it should be in radians."},
      {"spin_in_degrees", "degrees", "4", "The angle grows by degrees: it should grow by w dt, in radians."},
      {"spin_read_as_degrees", "degrees", "4",
       "The spin is read as degrees a second: it is radians a second."},
      {"spin in the angle's change*0", "does_not_turn", "4", "The angle never changes: add w dt to it."},
      {"spin in the angle's change*-1", "turns_backwards", "4",
       "It turns the wrong way: angles grow counter-clockwise, y up."},
      {"spin in the angle's change*0.5", "turns_half", "4",
       "The angle grows by half of w dt: add w dt to it."},
      {"spin in the angle's change*2", "turns_twice", "4",
       "The angle grows by twice w dt: is it changed twice a step?"},
      {"first_angle_ignored", "first_angle_ignored", "4",
       "The initial angle is ignored: take \"angle\" from the scene."},
      {"lever_from_origin", "lever_from_origin", "4",
       "The arm r is measured from the world's origin: measure it from the body's centre to the point."},
      {"contact_arm_from_origin", "lever_from_origin", "4",
       "The arm r of a contact is measured from the world's origin: measure it from the body's centre to the "
       "point."},
      {"torque_backwards", "torque_backwards", "4",
       "It spins the wrong way: the torque is rx Fy - ry Fx; r x F, not F x r."},
      {"point_ignored", "point_ignored", "4",
       "A push off the centre does not spin the box: add the torque r x F."},
      {"point_not_turned", "point_not_turned", "4",
       "The point does not turn with the box: turn \"point\" by the body's angle, then take r x F."},
      {"point_turned_backwards", "turned_backwards", "4",
       "The point turns against the box: turned by the angle a, (x, y) becomes (x cos a - y sin a, x sin a + "
       "y cos a)."},
      {"dot_for_cross", "dot_for_cross", "4",
       "The torque is computed as r . F: it is r x F = rx Fy - ry Fx."},
      {"sum_for_cross", "sum_for_cross", "4",
       "The torque is computed as rx Fy + ry Fx: it is r x F = rx Fy - ry Fx."},
      {"length_for_cross", "length_for_cross", "4",
       "The torque is computed as |r| |F|: it is r x F = rx Fy - ry Fx, which depends on the angle between "
       "them."},
      {"only_rx_fy", "half_of_cross", "4",
       "One of the two terms of the torque is left out: it is r x F = rx Fy - ry Fx."},
      {"only_ry_fx", "half_of_cross", "4",
       "One of the two terms of the torque is left out: it is r x F = rx Fy - ry Fx."},
      {"arm of a force*2", "arm_twice", "4",
       "The torque is that of an arm twice as long: \"point\" is measured from the centre, in m."},
      {"arm of a force*0.5", "arm_halved", "4",
       "The torque is that of an arm half as long: \"point\" is measured from the centre, in m."},
      {"falls_through_boxes", "no_collision", "4",
       "The boxes go through each other: they overlap if they do so along x and along y."},
      {"fixed_rotation_ignored", "fixed_rotation_ignored", "4",
       "A box turns, and the scene says \"fixed_rotation\": its inverse inertia is 0."},
      {"normal_between_centres", "normal_between_centres", "4",
       "The boxes push each other along the line of their centres: the normal is the axis of least overlap."},
      {"largest_overlap", "largest_overlap", "4",
       "The box goes through, or is moved out at the side: the normal is the axis with the least overlap, "
       "not the one with the most."},
      {"first_arm_for_both", "arm_of_the_other", "4", kArmOfTheOther},
      {"second_arm_for_both", "arm_of_the_other", "4", kArmOfTheOther},
      {"arms_swapped", "arm_of_the_other", "4", kArmOfTheOther},
      {"second_sees_new_velocity", "impulses_not_opposite", "34", kNotOpposite},
      {"first_sees_new_velocity", "impulses_not_opposite", "34", kNotOpposite},
      {"each_push_clamped", "sum_not_kept", "34",
       "An impulse that was too strong is never taken back: keep the sum of each contact's impulses from "
       "becoming negative, not each impulse by itself."},
      {"one_body_only", "one_body_only", "4",
       "Only the first body gets an impulse: the second gets the opposite one."},
      {"other_body_only", "one_body_only", "4",
       "Only the second body gets an impulse: the first gets the opposite one."},
      {"masses_ignored", "masses_ignored", "4",
       "They swap velocities as equal masses do: the masses are not used."},
      {"r_cross_n_flipped", "r_cross_n_flipped", "4",
       "The rod spins the wrong way: r x n is flipped. w changes by (rx jy - ry jx)/I, r from the centre to "
       "the contact."},
      {"no_rotation", "no_rotation", "4",
       "The rod does not spin: an impulse off the centre changes w by r x j/I, and the effective mass has (r "
       "x n)^2/I."},
      {"effective_mass_without_rotation", "effective_mass_without_rotation", "4",
       "The impulse is too strong and energy grows: the effective mass lacks (r x n)^2/I."},
      {"lever_not_squared", "lever_not_squared", "4", "The effective mass has (r x n)/I: square r x n."},
      {"effective_mass_with_lever_only", "inertia_not_in_effective_mass", "4",
       "The effective mass has (r x n)^2: divide it by I."},
      {"spin_not_changed", "spin_not_changed", "4", "The impulse never changes the spin: add r x j/I to w."},
      {"first_never_spins", "one_body_never_spins", "4",
       "Only one of the two bodies gets spin: each changes its w by r x j/I, with its own r and I."},
      {"second_never_spins", "one_body_never_spins", "4",
       "Only one of the two bodies gets spin: each changes its w by r x j/I, with its own r and I."},
      {"spin_by_impulse_alone", "inertia_forgotten", "4",
       "The impulse changes the spin by r x j: divide it by I."},
      {"spin_not_in_velocity", "point_velocity", "4",
       "The speed at which two close is that of their centres: it is that of their points, v + w x r, which "
       "is (vx - w ry, vy + w rx)."},
      {"point_velocity_flipped", "point_velocity", "4",
       "The velocity of a point has its spin with the wrong sign: it is v + w x r, which is (vx - w ry, vy + "
       "w rx)."},
      {"restitution*0", "restitution_ignored", "4",
       "The box does not bounce: restitution is not used for boxes."},
      {"always_elastic", "always_elastic", "4",
       "The box bounces as fast as it came: restitution is not used for boxes."},
      {"both_corners_take_all", "both_corners_take_all", "4",
       "Both corners get the whole impulse, computed from the same velocity: solve one corner after the "
       "other, each from the velocity that the last one left, several times, and keep each corner's sum of "
       "impulses from becoming negative."},
      {"one_corner", "one_corner", "4",
       "Only one corner gets an impulse: a flat landing has two contact points; go over them several times."},
      {"sinks", "sinks", "4", "The box sinks: correct its position by a share of the overlap each step."},
      {"friction_ignored", "friction_ignored", "4",
       "The box does not slow down: friction is not used, or its limit becomes 0. The sum of friction's "
       "impulses in a step is at most mu times the sum of the impulses along the normal, not times the last "
       "of them."},
      {"friction_unlimited", "friction_unlimited", "4",
       "The box stops at once: the impulse of friction is at most mu times the impulse along the normal."},
      {"friction_backwards", "friction_backwards", "4",
       "Friction speeds the box up: it acts against the sliding velocity along the tangent."},
      {"friction*0.5", "friction_halved", "4",
       "Half of the friction acts: its impulse is at most mu times the one along the normal."},
      {"friction*2", "friction_twice", "4",
       "Friction is twice too strong: each of two contact points is limited by the impulse at that point."},
      {"friction_product", "friction_product", "4",
       "The coefficients are multiplied: \"contact_rules\" says geometric_mean, the root of their product."},
      {"friction_average", "friction_average", "4",
       "The coefficients are averaged: \"contact_rules\" says geometric_mean, the root of their product."},
      {"friction_sum", "friction_sum", "4",
       "The coefficients are added: \"contact_rules\" says geometric_mean, the root of their product."},
      {"friction_minimum", "friction_minimum", "4",
       "The smaller coefficient, the box's, is taken: \"contact_rules\" says geometric_mean, the root of "
       "their product."},
      {"friction_maximum", "friction_maximum", "4",
       "The larger coefficient, the ground's, is taken: \"contact_rules\" says geometric_mean, the root of "
       "their product."},
      {"friction_without_normal", "friction_without_normal", "4",
       "Friction does not depend on the impulse along the normal: its impulse is at most mu times that one."},
      {"friction_without_mu", "friction_without_mu", "4",
       "Friction is as strong as the impulse along the normal: it is at most mu times that one."},
      {"joint_ignored", "joint_ignored", "5", "The joint does nothing: nothing holds the two together."},
      {"impulse of a joint*0.5", "joint_impulse_halved", "5",
       "Half of the joint's impulse acts: it is -dC/dt/(1/ma + 1/mb)."},
      {"impulse of a joint*2", "joint_impulse_twice", "5",
       "The joint's impulse is twice what it should be: it is to stop the change of length, not to reverse "
       "it."},
      {"impulse of a joint*-1", "impulse_backwards", "5",
       "The joint's impulse has the wrong sign: it is -dC/dt/(1/ma + 1/mb) along the joint; b gets it, and a "
       "the opposite one."},
      {"no_position_correction", "no_position_correction", "5",
       "The joint comes apart little by little: its velocities are corrected and its positions are not. "
       "Correct them by a share of the error each step."},
      {"correction of a joint*-1", "correction_backwards", "5",
       "The correction of positions drives the joint apart: a moves towards b, and b towards a."},
      {"length of a stick*0.5", "length_halved", "5",
       "The stick is held at half of its length: take \"length\" from the scene."},
      {"length of a stick*0", "length_ignored", "5",
       "The stick pulls its ends together: take \"length\" off the distance."},
      {"length of a stick*2", "length_twice", "5",
       "The stick is held at twice its length: take \"length\" from the scene."},
      {"stick_masses_ignored", "masses_ignored", "5",
       "Both ends are moved alike: share the correction by inverse mass; the light end takes ten parts in "
       "eleven."},
      {"stick_one_body_only", "one_body_only", "5",
       "Only the second body is held: the joint pulls on both, and the first must come along."},
      {"stick_pulls_the_second_only", "one_body_only", "5",
       "Only the second body is held: the joint pulls on both, and the first must come along."},
      {"stick_other_body_only", "one_body_only", "5",
       "Only the first body is held: the joint pulls on both, and the second must feel it as well."},
      {"stick_pulls_the_first_only", "one_body_only", "5",
       "Only the first body is held: the joint pulls on both, and the second must feel it as well."},
      {"joint_masses_in_place_of_inverses", "joint_impulse_weak", "5",
       "The joint's impulse is too weak: it is -dC/dt/(1/ma + 1/mb), not divided by ma + mb."},
      {"gravity*2", "gravity_twice", "5",
       "The swing is that of twice the gravity: gravity acts twice a step."},
      {"gravity*0.5", "gravity_halved", "5", "The swing is that of half the gravity."},
      {"lever_forgotten", "lever_forgotten", "5",
       "The hinge holds centres: it should hold the anchor, r from the centre. The anchor's velocity is v + "
       "w x r, and an impulse changes the spin by r x j/I."},
      {"anchor_not_turned", "anchor_not_turned", "5",
       "The anchor does not turn with the body: turn \"anchor_b\" by the body's angle to get r."},
      {"one_anchor_for_both", "one_anchor", "5",
       "One anchor is used for both bodies: \"anchor_a\" is a place on a, \"anchor_b\" one on b, each from "
       "its own centre."},
      {"second_anchor_for_both", "one_anchor", "5",
       "One anchor is used for both bodies: \"anchor_a\" is a place on a, \"anchor_b\" one on b, each from "
       "its own centre."},
      {"hinge_along_x_only", "hinge_one_axis", "5",
       "The hinge holds its anchor along x and lets go along y: solve both, along (1, 0) and along (0, 1)."},
      {"hinge_along_y_only", "hinge_one_axis", "5",
       "The hinge holds its anchor along y and lets go along x: solve both, along (1, 0) and along (0, 1)."},
      {"joint_never_spins", "joint_never_spins", "5",
       "The hinge's impulse never changes the spin: add r x j/I to w."},
      {"joint_without_rotation", "effective_mass_without_rotation", "5",
       "The effective mass of the hinge lacks (r x n)^2/I: its impulse is too strong."},
      {"joint_spins_the_first_only", "one_body_never_spins", "5", kOneNeverSpins},
      {"joint_spins_the_second_only", "one_body_never_spins", "5", kOneNeverSpins},
      {"joint_arms_swapped", "arm_of_the_other", "5", kArmOfTheOther},
      {"joint_first_arm_for_both", "arm_of_the_other", "5", kArmOfTheOther},
      {"joint_second_arm_for_both", "arm_of_the_other", "5", kArmOfTheOther},
      {"stick_only_pulls", "stick_only_pulls", "5",
       "The stick holds as a rope does, and gives way when its ends are pushed together: its impulse and its "
       "correction have both signs."},
      {"stick_only_pushes", "stick_only_pushes", "5",
       "The stick gives way when its ends are pulled apart: its impulse and its correction have both signs."},
      {"correction_of_the_first_end_only", "correction_of_one_end", "5", kOneEnd},
      {"correction_of_the_second_end_only", "correction_of_one_end", "5", kOneEnd},
      {"correction_turns_backwards", "correction_turns_backwards", "5",
       "Correcting the hinge's positions turns the bodies the wrong way: the angle changes by (r x push)/I, "
       "with the push that moves this body."},
      {"correction_never_turns", "correction_never_turns", "5",
       "Correcting the hinge's positions moves bodies and does not turn them: the push at the anchor also "
       "changes the angle by (r x push)/I."},
      {"joined_bodies_collide", "joined_bodies_collide", "5",
       "The rod is pushed out of the post that it hangs on: bodies that a joint connects do not collide, "
       "unless \"collide\" is true."},
      {"correction of an overlap*-1", "pushed_together", "1",
       "The correction of an overlap pushes the ball into the wall: it moves out, along the normal that "
       "points to "
       "the ball's centre."},
      {"pushed_by_the_distance", "pushed_too_far", "13", kTooFar},
      {"pushed_by_the_radius", "pushed_too_far", "13", kTooFar},
      {"circles_stay_in_each_other", "overlaps_stay", "3",
       "Balls are moved out of the floor, and not out of each other: correct the overlaps of all pairs."},
      {"sinks", "sinks", "3",
       "The pile sinks: correct positions as well as velocities, each ball by its share of the inverse "
       "masses."},
      {"box_first_not_turned", "normal_not_turned", "134", kNotTurned},
      {"axis_not_turned", "normal_not_turned", "4", kNotTurned},
      {"box_first_forgotten", "order_of_pair", "134",
       "A box and a circle collide only if the circle comes first in the scene: look for contacts of a box "
       "and a "
       "circle in both orders."},
      {"one_sweep", "too_few_iterations", "345", kOneSweep},
      {"force_as_impulse", "force_as_impulse", "2",
       "The force changes the velocity by F/m once, as an impulse does: it adds F dt/m in each step."},
      {"force_replaces_gravity", "force_replaces_gravity", "2",
       "A body with a force does not fall: gravity acts besides, a = g + F/m."},
      {"force_sets_velocity", "force_sets_velocity", "2",
       "The force sets the velocity: it is added to the velocity of before, v += F dt/m."},
      {"force_moves_positions", "force_moves_positions", "2",
       "The force also changes the position: it changes the velocity, and the velocity changes the "
       "position."},
      {"mass_of_the_first_for_all", "mass_of_another", "2",
       "All bodies have the mass of the first: each has its own."},
      {"drag_by_magnitude", "drag_by_magnitude", "2",
       "Drag pushes down and to the left whatever the velocity: it is -c v, a vector, and not -c |v| along "
       "each "
       "axis."},
      {"spring_along_x_only", "spring_along_one_axis", "2",
       "The spring pulls along x alone: its force points along the spring, from end to end."},
      {"spring_by_components", "spring_by_components", "2",
       "The rest length is taken off x and y apart: the force is stiffness (length - rest_length), along the "
       "spring."},
      {"first_spins_backwards", "r_cross_n_flipped", "4",
       "One of the two bodies spins the wrong way: a gets the impulse -j n and b +j n, and w changes by (rx "
       "jy - ry "
       "jx)/I of what each gets."},
      {"second_spins_backwards", "r_cross_n_flipped", "4",
       "One of the two bodies spins the wrong way: a gets the impulse -j n and b +j n, and w changes by (rx "
       "jy - ry "
       "jx)/I of what each gets."},
      {"spin of an impulse*0.5", "spin_halved", "4",
       "The impulse changes the spin by half of what it should: w changes by r x j/I."},
      {"spin of an impulse*2", "spin_twice", "4",
       "The impulse changes the spin twice as much as it should: w changes by r x j/I, once."},
      {"spin_by_mass", "spin_by_mass", "4",
       "The impulse changes the spin by r x j/m: divide it by the inertia."},
      {"spin_times_inertia", "spin_times_inertia", "4",
       "The impulse changes the spin by r x j I: divide it by the inertia."},
      {"axes_of_the_first_only", "axes_of_one_box", "4",
       "The axes of only one of the two boxes are tried: there are four, two of each."},
      {"friction_each_time", "friction_unlimited", "4",
       "Friction is limited each time and not as a sum, so that many times a step give more: keep the sum of "
       "its "
       "impulses within mu times the sum along the normal."},
      {"friction_one_sign", "friction_one_sign", "4",
       "Friction acts in one direction only: its sum lies between -mu and +mu times the sum along the "
       "normal."},
      {"friction_other_sign", "friction_one_sign", "4",
       "Friction acts in one direction only: its sum lies between -mu and +mu times the sum along the "
       "normal."},
      {"friction_never_spins", "friction_never_spins", "4",
       "Friction slows the box and does not turn it: its impulse acts at the contact point and changes w by "
       "r x "
       "j/I."},
      {"joint_only_pulls", "joint_one_sign", "5", kOneSign},
      {"joint_only_pushes", "joint_one_sign", "5", kOneSign},
      {"joint_sum_only_pulls", "joint_one_sign", "5", kOneSign},
      {"joint_sum_only_pushes", "joint_one_sign", "5", kOneSign},
      {"joint_spin_not_in_velocity", "joint_point_velocity", "5", kJointPoint},
      {"joint_point_velocity_flipped", "joint_point_velocity", "5", kJointPoint},
      {"joint_spins_backwards", "joint_spins_backwards", "5", kJointSpin},
      {"joint_spins_the_first_backwards", "joint_spins_backwards", "5", kJointSpin},
      {"joint_spins_the_second_backwards", "joint_spins_backwards", "5", kJointSpin},
      {"joint_same_direction_for_both", "same_direction_for_both", "5",
       "Both ends get the joint's impulse in the same direction: a gets -j n, b +j n."},
      {"joint_masses_swapped", "masses_swapped", "5", "Each end gets the other's inverse mass."},
      {"joint_inverse_mass_forgotten", "inverse_mass_forgotten", "5",
       "Both ends change their velocity by j: each changes by j times its own inverse mass."},
      {"joint_effective_mass_forgotten", "effective_mass_forgotten", "5",
       "The joint's impulse is not divided by 1/ma + 1/mb."},
      {"anchors_swapped", "one_anchor", "5",
       "The anchors are swapped: \"anchor_a\" is a place on a, \"anchor_b\" one on b, each from its own "
       "centre."},
      {"anchor_turned_backwards", "turned_backwards", "5",
       "The anchor turns against its body: turned by the angle a, (x, y) becomes (x cos a - y sin a, x sin a "
       "+ y "
       "cos a)."},
      {"correction_masses_ignored", "correction_split_evenly", "5",
       "Correcting a joint's positions moves 10 kg and 1 kg equally far: each moves by its inverse mass."},
      {"correction_masses_swapped", "correction_shares_swapped", "5",
       "Correcting a joint's positions moves the heavy end more: each moves by its inverse mass."},
      {"masses_swapped", "masses_swapped", "14", "Each body gets the other's inverse mass."},
      {"one_body_only", "one_body_only", "1",
       "Only the first of two bodies gets an impulse: the second gets the opposite one, and the two may come "
       "in "
       "either order."},
      {"other_body_only", "one_body_only", "1",
       "Only the second of two bodies gets an impulse: the first gets the opposite one, and the two may come "
       "in "
       "either order."},
      {"restitution_of_the_first", "restitution_of_one", "13",
       "The restitution of the first of the two counts: \"contact_rules\" says maximum, of both."},
      {"restitution_of_the_second", "restitution_of_one", "13",
       "The restitution of the second of the two counts: \"contact_rules\" says maximum, of both."},
      {"threshold_without_dt", "threshold_too_high", "1",
       "Speeds below 2 g do not bounce: restitution is 0 below 2 g dt, with the step, or below the scene's "
       "\"restitution_threshold\"."},
      {"one_plus_in_bounce", "one_plus_in_bounce", "134",
       "They part at 1 + e times the speed at which they met: the speed after is -e vn, and 1 + e belongs to "
       "the "
       "impulse alone."},
      {"velocities_scaled_after", "whole_velocity_scaled", "134",
       "The whole velocity is multiplied by e: only its part along the normal is."},
      {"velocity_of_the_first_alone", "relative_velocity", "134",
       "The velocity of the first of two bodies alone is used: the impulse depends on the relative velocity, "
       "(vb - "
       "va) . n."},
      {"velocity_of_the_second_alone", "relative_velocity", "134",
       "The velocity of the second of two bodies alone is used: the impulse depends on the relative "
       "velocity, (vb - "
       "va) . n."},
      {"first_arm_for_both", "arm_of_the_other", "1", kArmOfTheOther},
      {"second_arm_for_both", "arm_of_the_other", "1", kArmOfTheOther},
      {"first_arm_everywhere", "arm_of_the_other", "14", kArmOfTheOther},
      {"second_arm_everywhere", "arm_of_the_other", "14", kArmOfTheOther},
      {"normal_by_arctangent", "normal_not_turned", "3",
       "The normal is right if the second circle is on the right, and reversed if it is on the left: it is "
       "(xb - "
       "xa)/|xb - xa|, and not taken from the arctangent of dy/dx."},
      {"inverse_mass_whole", "inverse_mass_whole", "234",
       "The inverse mass is rounded down to a whole number, so that forces and impulses do nothing to more "
       "than 1 "
       "kg: divide as real numbers, 1.0/m."},
      {"forces_a_step_late", "forces_a_step_late", "2",
       "Forces act a step late: the step that computes them adds them."},
      {"force_turned", "force_turned", "4",
       "The force turns with the body: in the frame \"world\" it keeps its direction, in \"body\" it turns."},
      {"inertia_not_inverted", "inertia_not_inverted", "45",
       "Torques are multiplied by the inertia: divide, w changes by torque dt/I and r x j/I."},
      {"centre_turned_backwards", "box_frame", "4",
       "A circle is looked for in the wrong frame of a turned box: rotate its centre by minus the box's "
       "angle, find "
       "the nearest point, and rotate that by plus the angle."},
      {"centre_not_turned", "box_frame", "4",
       "A circle is looked for in the wrong frame of a turned box: rotate its centre by minus the box's "
       "angle, find "
       "the nearest point, and rotate that by plus the angle."},
      {"tangent_mixed_up", "tangent_wrong", "4",
       "The tangent of friction is not at a right angle to the normal: it is (-ny, nx)."},
      {"joint_row_only_pulls", "joint_one_sign", "5", kOneSign},
      {"joint_row_only_pushes", "joint_one_sign", "5", kOneSign},
      {"length_of_the_start", "length_of_the_start", "5",
       "A stick keeps the length that it has at the start: take \"length\" from the scene."},
      {"world_has_mass", "world_has_mass", "5",
       "The end named \"world\" has a mass: its inverse mass and inertia are 0, so that it takes no "
       "velocity."},
      {"forces_after_contacts", "forces_too_late", "5",
       "Forces and gravity change velocities after joints and contacts are solved: they come first, so that "
       "joints "
       "and contacts can answer them before bodies move."},
      {"arm_of_impulse_not_turned", "anchor_not_turned", "5",
       "The anchor does not turn with the body: turn \"anchor_a\" and \"anchor_b\" by the body's angle to "
       "get r, for "
       "impulses as well."},
      {"restitution*2", "restitution_twice", "13",
       "The motion is that of an engine in which the restitution is used twice."},
      {"torque*0.5", "torque_halved", "4",
       "The motion is that of an engine in which the torque is used by half."},
      {"torque*2", "torque_twice", "4", "The motion is that of an engine in which the torque is used twice."},
      {"length of a stick*-1", "length_of_stick_reversed", "5",
       "The motion is that of an engine in which the length of a stick has the wrong sign."},
  };
}

}  // namespace plumb::course
