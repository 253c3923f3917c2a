#include "harness/course/predictable.h"

// The mistakes of chapter 4, some of which spoil chapter 5 as well.
namespace plumb::course {
namespace {

// Causes that several mistakes share.
constexpr const char* kSlidingOfOneCentre =
    "Friction takes the velocity of one of the centres: it acts against the sliding of both points that "
    "touch, v + "
    "w x r each.";
constexpr const char* kOneArmInMass =
    "The effective mass has one body's arm for both: (ra x n)^2/Ia + (rb x n)^2/Ib, each with its own r.";
constexpr const char* kSecondMoment =
    "A second moment of area stands where the inertia of a mass should: a box has m (w^2 + h^2)/12.";
constexpr const char* kArmOfTheOther =
    "An impulse acts at the other body's arm: each body has its own r, from its centre to the point.";
constexpr const char* kBoxNotTurned =
    "A circle meets a turned box as if the box stood upright: turn the circle's centre by -angle into the "
    "box's frame, find the nearest point there, and turn that point by +angle back.";
constexpr const char* kPointAtBox =
    "The point where a circle touches a box is wrong: it is the box's nearest point to the circle's centre, "
    "turned by the "
    "box's angle and moved to its centre, and each body's r runs from its centre to it.";
constexpr const char* kPointAtCentre =
    "The point of contact of two circles is taken at a centre: it is on the rim, where friction acts.";
constexpr const char* kFrictionOnOne =
    "Friction spins only one of the two bodies: each changes its w by r x j/I, with its own r and I, and a "
    "gets the opposite impulse.";
constexpr const char* kTorqueNotCleared =
    "The torque piles up from step to step: set the sums of forces and of torques to zero at the start of "
    "each step.";
constexpr const char* kTangentNotUnit =
    "The tangent is the sliding velocity itself: divide it by its length, or take (-ny, nx).";
constexpr const char* kOneSide =
    "Friction is limited on one side only: its sum stays between -mu and +mu times the sum of the impulses "
    "along "
    "the normal.";
constexpr const char* kAxesLeftOut =
    "Some axes of two boxes are left out: compare them along the width and the height of both.";
constexpr const char* kClippedOnce =
    "The side that touches is clipped at one end of the face only, so that a point may lie beside the other "
    "end: clip "
    "it at both.";
constexpr const char* kExtent =
    "A box's extent along an axis is wrong: it is half of the width times |x . axis| plus half of the height "
    "times "
    "|y . axis|, with x and y the directions of its sides.";
constexpr const char* kExtentNotTurned =
    "A box's extent along an axis is that of an upright box: it is half of the width times |x . axis| plus "
    "half of the height times |y . axis|, with x and y the directions of its sides, which turn with it.";
constexpr const char* kNotOpposite =
    "The two impulses are not opposite: compute j once, from the velocities before either changes, and apply "
    "it to both.";

}  // namespace

std::vector<Predictable> mistakes_of_boxes() {
  return {
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
      {"inertia_inverted", "inertia_inverted", "45",
       "The inertia stands where its inverse should: w grows by torque dt/I, and by r x j/I."},
      {"inertia_without_mass", "inertia_without_mass", "45",
       "The mass is left out of the inertia: a box has m (w^2 + h^2)/12, a disc m r^2/2."},
      {"inertia_of_boxes_without_mass", "inertia_without_mass", "45",
       "The mass is left out of the inertia: a box has m (w^2 + h^2)/12, a disc m r^2/2."},
      {"inertia_of_discs_without_mass", "inertia_without_mass", "4",
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
      {"torque_not_cleared", "force_not_cleared", "4", kTorqueNotCleared},
      {"force_and_torque_not_cleared", "force_not_cleared", "4", kTorqueNotCleared},
      {"a box for boxes~by the first angle", "first_angle_kept", "45",
       "Two boxes touch as if they had their first angles: turn their sides and corners by the angle of now, "
       "in "
       "each step."},
      {"static_has_inertia", "static_has_mass", "4",
       "A static body takes spin: its inverse inertia is 0, as its inverse mass is, in the effective mass as "
       "well."},
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
      {"friction_bounds_exchanged", "friction_bounds_exchanged", "4",
       "Friction always acts with its limit in one direction: min and max are exchanged where its sum is "
       "limited, "
       "min(max(sum, -most), most)."},
      {"contact_between_centres", "contact_between_centres", "4",
       "The point of contact of two boxes is taken halfway between their centres: contact points lie where "
       "the sides "
       "touch, at both ends of what they share."},
      {"point_taken_for_world", "point_taken_for_world", "4",
       "The force's point is taken for a point of the world: it is a point of the body, from its centre."},
      {"contacts_averaged", "one_corner", "45",
       "The two contacts of a box are merged into one between them, which does not stop it from tipping: "
       "keep both."},
      {"fixed_rotation_ignored", "fixed_rotation_ignored", "4",
       "A box turns, and the scene says \"fixed_rotation\": its inverse inertia is 0."},
      {"normal_between_centres", "normal_between_centres", "4",
       "The boxes push each other along the line of their centres: the normal is the axis of least overlap."},
      {"largest_overlap", "largest_overlap", "4",
       "The box goes through, or is moved out at the side: the normal is the axis with the least overlap, "
       "not the one with the most."},
      {"first_arm_for_both", "arm_of_the_other", "4", kArmOfTheOther},
      {"second_arm_for_both", "arm_of_the_other", "4", kArmOfTheOther},
      {"contact_arms_exchanged", "arm_of_the_other", "134", kArmOfTheOther},
      {"contact_first_arm_everywhere", "arm_of_the_other", "134", kArmOfTheOther},
      {"contact_second_arm_everywhere", "arm_of_the_other", "134", kArmOfTheOther},
      {"contact_arms_zero", "no_rotation", "4",
       "Impulses act at the centres: r runs from a body's centre to the contact's point, and an impulse "
       "changes w by r "
       "x j/I."},
      {"normal_of_the_first_face_only", "normal_not_turned", "4",
       "The normal of two boxes points the wrong way if it is that of the second one's face: turn it so that "
       "it points "
       "from a to b."},
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
      {"spin_by_inverse_mass", "inertia_forgotten", "4",
       "The impulse changes the spin by r x j/m: divide it by I, not by the mass."},
      {"spin_by_inverse_mass_of_turning", "inertia_forgotten", "4",
       "The impulse changes the spin by r x j/m: divide it by I, not by the mass."},
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
      {"first_end_only", "one_corner", "4",
       "Only one corner gets an impulse: a flat landing has two contact points; go over them several times."},
      {"second_end_only", "one_corner", "4",
       "Only one corner gets an impulse: a flat landing has two contact points; go over them several times."},
      {"other_corner", "one_corner", "4",
       "Only one corner gets an impulse: a flat landing has two contact points; go over them several times."},
      {"sinks", "sinks", "4", "The box sinks: correct its position by a share of the overlap each step."},
      {"friction_ignored", "friction_ignored", "4",
       "The box does not slow down: friction is not used, or its limit becomes 0. The sum of friction's "
       "impulses in a step is at most mu times the sum of the impulses along the normal, not times the last "
       "of them."},
      {"friction_unlimited", "friction_unlimited", "4",
       "The box stops at once: the impulse of friction is at most mu times the impulse along the normal."},
      {"friction_unlimited_everywhere", "friction_unlimited", "4",
       "The box stops at once: the impulse of friction is at most mu times the impulse along the normal."},
      {"friction_backwards", "friction_backwards", "4",
       "Friction speeds the box up: it acts against the sliding velocity along the tangent."},
      {"friction*0.5", "friction_halved", "4",
       "Half of the friction acts: its impulse is at most mu times the one along the normal."},
      {"friction*2", "friction_twice", "4",
       "Friction is twice too strong: each of two contact points is limited by the impulse at that point."},
      {"friction_product", "friction_product", "4",
       "The coefficients are multiplied: \"contact_rules\" says geometric_mean, the root of their product."},
      {"friction_by_restitution", "friction_by_restitution", "134",
       "Friction acts with the coefficient of restitution: it is \"friction\" of the two shapes."},
      {"friction_by_restitution_of_its_rule", "friction_by_restitution", "134",
       "Friction acts with the coefficient of restitution: it is \"friction\" of the two shapes."},
      {"friction_of_the_first", "friction_of_one", "4",
       "Friction takes the coefficient of the first body: \"contact_rules\" says geometric_mean, the root of "
       "the "
       "product of both."},
      {"friction_of_the_second", "friction_of_one", "4",
       "Friction takes the coefficient of the second body: \"contact_rules\" says geometric_mean, the root "
       "of the "
       "product of both."},
      {"friction_by_mass_of_normal", "friction_mass_of_normal", "4",
       "Friction has the effective mass along the normal: it has its own, with (r x t)^2/I."},
      {"friction_limited_above_only", "friction_limited_on_one_side", "4", kOneSide},
      {"friction_limited_below_only", "friction_limited_on_one_side", "4", kOneSide},
      {"rough_limited_above_only", "friction_limited_on_one_side", "4", kOneSide},
      {"rough_limited_below_only", "friction_limited_on_one_side", "4", kOneSide},
      {"tangent_not_unit", "tangent_not_unit", "4", kTangentNotUnit},
      {"tangent_not_unit_in_mass", "tangent_not_unit", "4", kTangentNotUnit},
      {"friction_at_its_limit", "friction_at_its_limit", "4",
       "Friction always acts with its largest impulse: it acts with the one that stops the sliding, if that "
       "is "
       "smaller."},
      {"friction_each_limited", "friction_each_limited", "4",
       "Each sweep's impulse of friction is limited by itself: their sum is limited, by mu times the sum of "
       "the "
       "impulses along the normal."},
      {"axes_of_the_first_only", "axes_left_out", "4", kAxesLeftOut},
      {"axes_of_the_second_only", "axes_left_out", "4", kAxesLeftOut},
      {"axes_of_the_width_only", "axes_left_out", "4", kAxesLeftOut},
      {"axes_of_the_height_only", "axes_left_out", "4", kAxesLeftOut},
      {"axes_not_turned_by_sides", "axes_not_turned", "4",
       "The axes along which two boxes are compared do not turn with them: turn (1, 0) and (0, 1) by each "
       "angle."},
      {"axes_not_turned", "axes_not_turned", "4",
       "The axes along which two boxes are compared do not turn with them: turn (1, 0) and (0, 1) by each "
       "angle."},
      {"axis_not_turned_to_b", "normal_not_turned", "4",
       "The normal of two boxes may point from b to a: reverse the axis if the way from a to b is against "
       "it."},
      {"extent_sign_lost", "extent_wrong", "4", kExtent},
      {"extent_sign_lost_in_overlap", "extent_wrong", "4", kExtent},
      {"extent_of_the_sum", "extent_wrong", "4", kExtent},
      {"extent_of_the_sum_in_overlap", "extent_wrong", "4", kExtent},
      {"extent_of_the_difference", "extent_wrong", "4", kExtent},
      {"extent_of_the_difference_in_overlap", "extent_wrong", "4", kExtent},
      {"extent_sides_swapped", "extent_wrong", "4", kExtent},
      {"extent_sides_swapped_in_overlap", "extent_wrong", "4", kExtent},
      {"extent_of_width_only", "extent_wrong", "4", kExtent},
      {"extent_of_width_only_in_overlap", "extent_wrong", "4", kExtent},
      {"extent_of_height_only", "extent_wrong", "4", kExtent},
      {"extent_of_height_only_in_overlap", "extent_wrong", "4", kExtent},
      {"extent_not_halved", "extent_wrong", "4", kExtent},
      {"extent_not_halved_in_overlap", "extent_wrong", "4", kExtent},
      {"extent_of_a_circle", "extent_wrong", "4", kExtent},
      {"extent_of_a_circle_in_overlap", "extent_wrong", "4", kExtent},
      {"a box's extent~not", "extent_not_turned", "4", kExtentNotTurned},
      {"a box's extent in the overlap~not", "extent_not_turned", "4", kExtentNotTurned},
      {"face_of_the_other", "face_of_the_other", "4",
       "The side that touches is clipped against the wrong box: the face belongs to the box whose axis has "
       "the "
       "least overlap."},
      {"face_of_the_other_side", "clipped_wrong", "4",
       "The side that touches is clipped at the wrong half side of the face: along the face, not across it."},
      {"face_not_clipped", "not_clipped", "4",
       "The side that touches is not clipped at the ends of the face, so that points lie beside it."},
      {"clipped_at_the_upper_end_only", "not_clipped", "4", kClippedOnce},
      {"clipped_at_the_lower_end_only", "not_clipped", "4", kClippedOnce},
      {"corners_farthest_out", "corners_farthest_out", "4",
       "The contact points are the corners that are farthest out: those that are farthest in touch."},
      {"middle_of_the_side", "one_corner", "4",
       "Only one point holds the box, the middle of its side: a flat landing has two contact points."},
      {"deepest_corner_only", "one_corner", "4",
       "Only the deepest corner gets an impulse: a flat landing has two contact points; go over them several "
       "times."},
      {"deepest_corner_or_last", "one_corner", "4",
       "Only the deepest corner gets an impulse: a flat landing has two contact points; go over them several "
       "times."},
      {"depth_of_the_overlap", "depth_wrong", "4",
       "Both points have the depth of the overlap: each has its own, its distance behind the face."},
      {"effective_mass_of_the_first_arm", "arm_of_the_other", "4", kOneArmInMass},
      {"effective_mass_of_the_second_arm", "arm_of_the_other", "4", kOneArmInMass},
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
      {"friction_limit_times_dt", "friction_times_dt", "4",
       "The limit of friction is multiplied by dt: an impulse along the normal already is a force times dt."},
      {"friction_by_last_impulse", "friction_by_last_impulse", "4",
       "Friction is limited by the last of the impulses along the normal: it is at most mu times their sum."},
      {"friction_without_normal", "friction_without_normal", "4",
       "Friction does not depend on the impulse along the normal: its impulse is at most mu times that one."},
      {"friction_without_mu", "friction_without_mu", "4",
       "Friction is as strong as the impulse along the normal: it is at most mu times that one."},
      {"circle_at_box_point_from_origin", "contact_point_wrong", "4", kPointAtBox},
      {"circle_at_box_point_at_box", "contact_point_wrong", "4", kPointAtBox},
      {"circle_at_box_point_at_circle", "contact_point_at_centre", "4", kPointAtBox},
      {"circle_at_box_point_on_circle_beyond", "contact_point_wrong", "4", kPointAtBox},
      {"distance_along_axis_signed", "distance_sign_lost", "4",
       "The distance of two boxes along an axis keeps its sign, so that some never separate and others "
       "overlap too much: "
       "the overlap along the axis n is the sum of both extents minus |d . n|."},
      {"distance_along_axis_reversed", "distance_sign_lost", "4",
       "The distance of two boxes along an axis has a sign, and the wrong one: the overlap along the axis n "
       "is the sum of "
       "both extents minus |d . n|."},
      {"distance_along_axis_squared", "square_of_distance", "4",
       "The distance of two boxes along an axis is squared: the overlap along the axis n is the sum of both "
       "extents minus "
       "|d . n|."},
      {"distance_along_axis_left_out", "distance_left_out", "4",
       "The distance of two boxes along an axis is left out: the overlap along the axis n is the sum of both "
       "extents minus "
       "|d . n|."},
      {"box_taken_upright", "box_not_turned", "4", kBoxNotTurned},
      {"side_of_box_not_turned", "box_not_turned", "4", kBoxNotTurned},
      {"point_of_box_not_turned", "box_not_turned", "4", kBoxNotTurned},
      {"box_turned_backwards", "turned_backwards", "4",
       "A circle meets a turned box as if the box were turned the other way: turned by the angle a, (x, y) "
       "becomes (x cos a - y sin a, x sin a + y cos a)."},
      {"centre_turned_backwards", "turned_backwards", "4",
       "The centre of a circle is turned into the box's frame the wrong way, by +angle: turned by the angle "
       "a, (x, y) "
       "becomes (x cos a - y sin a, x sin a + y cos a)."},
      {"contact_point_at_first_centre", "contact_point_at_centre", "4", kPointAtCentre},
      {"contact_point_at_second_centre", "contact_point_at_centre", "4", kPointAtCentre},
      {"friction_lever_not_squared", "lever_not_squared", "4",
       "The effective mass of friction has (r x t)/I: square r x t."},
      {"friction_without_rotation", "effective_mass_without_rotation", "4",
       "The impulse of friction is too strong: its effective mass lacks (r x t)^2/I."},
      {"sliding_of_centres", "point_velocity", "4",
       "Friction acts against the sliding of the centres: it acts against that of the points that touch, v + "
       "w x r, which is (vx - w ry, vy + w rx)."},
      {"sliding_of_the_first_centre", "point_velocity", "4", kSlidingOfOneCentre},
      {"sliding_of_the_second_centre", "point_velocity", "4", kSlidingOfOneCentre},
      {"friction_by_weight", "friction_without_normal", "4",
       "The limit of friction follows from the weight: it is mu times the sum of the impulses along the "
       "normal, "
       "which a collision makes larger and a slope smaller."},
      {"friction_never_spins", "friction_never_spins", "4",
       "Friction never changes the spin: its impulse changes w by r x j/I, as any impulse."},
      {"friction_spins_the_first_only", "one_body_never_spins", "4", kFrictionOnOne},
      {"friction_spins_the_second_only", "one_body_never_spins", "4", kFrictionOnOne},
      {"torque*0.5", "torque_halved", "4",
       "The motion is that of an engine in which the torque is used by half."},
      {"torque*2", "torque_twice", "4", "The motion is that of an engine in which the torque is used twice."},
  };
}

}  // namespace plumb::course
