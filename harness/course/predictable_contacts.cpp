#include "harness/course/predictable.h"

// The mistakes of chapter 3, some of which spoil later ones as well.
namespace plumb::course {
namespace {

// Causes that several mistakes share.
constexpr const char* kDistanceBySum =
    "The distance of two centres is taken as |dx| + |dy|: it is the root of dx^2 + dy^2, for the comparison "
    "with r1 + "
    "r2, the normal and the overlap.";
constexpr const char* kDistanceByLargest =
    "The distance of two centres is taken as the larger of |dx| and |dy|: it is the root of dx^2 + dy^2, for "
    "the "
    "comparison with r1 + r2, the normal and the overlap.";
constexpr const char* kAlongAxis =
    "The normal of two circles is taken along an axis: it points along the line of centres, (b - a)/|b - a|.";
constexpr const char* kPairsLeftOut =
    "Some pairs of bodies are never compared: go over all i < j, the last body included.";

constexpr const char* kTestReversed =
    "A contact is answered when the two part, and left alone when they close: with the normal from a to b "
    "they close "
    "when (vb - va) . n < 0.";

constexpr const char* kSumShared =
    "Several contacts share one sum of impulses, so that one may pull as long as another pushes: each "
    "contact of "
    "each pair keeps a sum of its own, which is 0 at the start of the step and never negative.";

constexpr const char* kNotSummed =
    "The impulses of the last step are applied again at the start of a step, and the sums begin at 0, so "
    "that contacts "
    "cannot take them back: each sum begins with what was applied (warm starting), or nothing is applied.";

constexpr const char* kNotCleared =
    "The sum of a contact's impulses is kept from the last step without being applied, so that it may pull "
    "as hard as "
    "it pushed before: the sum is 0 at the start of a step, or the kept impulse is applied then (warm "
    "starting).";

constexpr const char* kRadiusOfAnother =
    "All circles have the radius of one of them: each body keeps its own.";

constexpr const char* kCells =
    "Circles are compared only with those in the same cell of a grid, so that two go through each other at "
    "the "
    "border of two cells: compare those of neighbouring cells as well.";

}  // namespace

std::vector<Predictable> mistakes_of_contacts() {
  return {
      {"size of the cells in which circles are compared*0.5", "place_matters", "3", kCells},
      {"size of the cells in which circles are compared*1", "place_matters", "3", kCells},
      {"size of the cells in which circles are compared*2", "place_matters", "3", kCells},
      {"size of the cells in which circles are compared*5", "place_matters", "3", kCells},
      {"size of the cells in which circles are compared*10", "place_matters", "3", kCells},
      {"sums_applied_again", "warm_start_not_summed", "134", kNotSummed},
      {"sums_applied_again_with_friction", "warm_start_not_summed", "4", kNotSummed},
      {"sums_kept", "sum_not_cleared", "34", kNotCleared},
      {"sums_kept_with_friction", "sum_not_cleared", "4", kNotCleared},
      {"sum_of_the_first_body", "sum_shared", "34", kSumShared},
      {"sum_of_the_second_body", "sum_shared", "34", kSumShared},
      {"sum_of_the_earlier_body", "sum_shared", "34", kSumShared},
      {"sum_of_the_later_body", "sum_shared", "34", kSumShared},
      {"sum_of_the_pair", "sum_shared", "4", kSumShared},
      {"sum_of_all_contacts", "sum_shared", "34", kSumShared},
      {"impulse of a contact*0.5", "impulse_halved", "13",
       "The impulse is half of what it should be: it is -(1 + e) vn/(1/m1 + 1/m2)."},
      {"impulse of a contact*-1", "impulse_backwards", "3",
       "They speed up into each other: the impulse has the wrong sign. The normal points from a to b, and a "
       "gets -j n, b +j n."},
      {"impulse_backwards", "impulse_backwards", "3",
       "They speed up into each other: the impulse has the wrong sign. The normal points from a to b, and a "
       "gets -j n, b +j n."},
      {"always_elastic", "always_elastic", "3", "Every collision is elastic: restitution is not used."},
      {"restitution*0", "restitution_ignored", "3",
       "None of the speed comes back: restitution is not used, or what it gives is taken back in the same "
       "step. If you go over contacts several times, compute the bounce -e vn once, before the first time."},
      {"no_detection", "no_detection", "3",
       "The circles go through each other: they touch when their centres are nearer than r1 + r2. Is the "
       "contact found, and are the velocities changed?"},
      {"impulse of a contact*0", "no_collision", "34",
       "The velocities do not change: no contact is found, or no impulse is applied."},
      {"diameters", "diameters", "3", "They turn back too early: add the radii, not the diameters."},
      {"diameters_in_depth", "diameters", "3", "They turn back too early: add the radii, not the diameters."},
      {"one_radius", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with one radius."},
      {"one_radius_in_depth", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with one radius."},
      {"other_radius", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with one radius."},
      {"other_radius_in_depth", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with one radius."},
      {"larger_radius_alone", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with the larger radius."},
      {"larger_radius_alone_in_depth", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with the larger radius."},
      {"smaller_radius_alone", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with the smaller radius."},
      {"smaller_radius_alone_in_depth", "one_radius", "3",
       "They turn back too late: compare the distance with r1 + r2, not with the smaller radius."},
      {"larger_radius", "larger_radius", "3",
       "They touch at twice the larger radius: they touch at r1 + r2."},
      {"larger_radius_in_depth", "larger_radius", "3",
       "They touch at twice the larger radius: they touch at r1 + r2."},
      {"smaller_radius", "smaller_radius", "3",
       "They touch at twice the smaller radius: they touch at r1 + r2."},
      {"smaller_radius_in_depth", "smaller_radius", "3",
       "They touch at twice the smaller radius: they touch at r1 + r2."},
      {"sum_of_squared_radii", "sum_of_squared_radii", "3",
       "They touch at the root of r1^2 + r2^2: they touch at r1 + r2, whose square is (r1 + r2)^2."},
      {"sum_of_squared_radii_in_depth", "sum_of_squared_radii", "3",
       "They touch at the root of r1^2 + r2^2: they touch at r1 + r2, whose square is (r1 + r2)^2."},
      {"first_radius_twice", "one_radius", "3",
       "They touch at twice the radius of the first: they touch at r1 + r2."},
      {"first_radius_twice_in_depth", "one_radius", "3",
       "They touch at twice the radius of the first: they touch at r1 + r2."},
      {"second_radius_twice", "one_radius", "3",
       "They touch at twice the radius of the second: they touch at r1 + r2."},
      {"second_radius_twice_in_depth", "one_radius", "3",
       "They touch at twice the radius of the second: they touch at r1 + r2."},
      {"mean_of_radii", "mean_of_radii", "3", "They touch at (r1 + r2)/2: they touch at r1 + r2."},
      {"mean_of_radii_in_depth", "mean_of_radii", "3", "They touch at (r1 + r2)/2: they touch at r1 + r2."},
      {"distance_by_sum", "distance_by_sum", "3", kDistanceBySum},
      {"distance_by_sum_in_test", "distance_by_sum", "3", kDistanceBySum},
      {"distance_by_largest", "distance_by_sum", "3", kDistanceByLargest},
      {"distance_by_largest_in_test", "distance_by_sum", "3", kDistanceByLargest},
      {"square_for_distance", "square_of_distance", "3",
       "The square of the distance stands for the distance: take the root, for the comparison with r1 + r2, "
       "the "
       "normal and the overlap."},
      {"square_of_distance", "square_of_distance", "3",
       "The square of the distance is compared with r1 + r2: compare it with (r1 + r2)^2."},
      {"normal_flipped", "normal_flipped", "3",
       "The two are caught inside each other: they are pushed together when they part and let go when they "
       "close. The normal is flipped: it points from a to b, and they close when (vb - va) . n < 0."},
      {"normal_flipped_in_depth", "normal_flipped", "3",
       "The two are caught inside each other: they are pushed together when they part and let go when they "
       "close. The normal is flipped: it points from a to b, and they close when (vb - va) . n < 0."},
      {"normal_not_unit", "normal_not_unit", "3",
       "The impulse depends on the distance of the centres: divide the line of centres by its length to get "
       "the normal."},
      {"normal_over_square", "normal_not_unit", "3",
       "The impulse depends on the distance of the centres: divide the line of centres by its length to get "
       "the normal."},
      {"normal_along_x", "normal_along_axis", "3", kAlongAxis},
      {"normal_along_y", "normal_along_axis", "3", kAlongAxis},
      {"normal_along_longer_axis", "normal_along_axis", "3", kAlongAxis},
      {"normal_along_x_with_point", "normal_along_axis", "3", kAlongAxis},
      {"normal_along_y_with_point", "normal_along_axis", "3", kAlongAxis},
      {"normal_along_longer_axis_with_point", "normal_along_axis", "3", kAlongAxis},
      {"normal_along_shorter_axis", "normal_along_axis", "3", kAlongAxis},
      {"normal_along_shorter_axis_with_point", "normal_along_axis", "3", kAlongAxis},
      {"normal_along_velocity", "normal_along_velocity", "3",
       "The impulse follows the velocity: it follows the line of centres."},
      {"normal_along_approach", "normal_along_velocity", "3",
       "The impulse follows the velocity: it follows the line of centres."},
      {"tangent", "tangent", "3", "The parts along and across the line of centres are mixed up."},
      {"normal_components_swapped", "normal_components_swapped", "3",
       "The x and y of the normal are swapped: it is (b - a)/|b - a|, x first."},
      {"y_of_normal_flipped", "y_of_normal_flipped", "3", "The y of the normal has the wrong sign."},
      {"whole_velocity", "whole_velocity", "3",
       "The whole velocities are exchanged: only the parts along the line of centres are."},
      {"whole_velocity_scaled", "whole_velocity_scaled", "3",
       "Both whole velocities are multiplied by -e: only the relative velocity along the normal changes, "
       "shared by "
       "the inverse masses."},
      {"last_body_left_out", "pairs_left_out", "34", kPairsLeftOut},
      {"first_body_left_out", "pairs_left_out", "34", kPairsLeftOut},
      {"neighbours_only", "pairs_left_out", "34", kPairsLeftOut},
      {"first_against_others_only", "pairs_left_out", "34", kPairsLeftOut},
      {"moving_pairs_left_out", "pairs_left_out", "34", kPairsLeftOut},
      {"static_pairs_left_out", "pairs_left_out", "34", kPairsLeftOut},
      {"correction_of_the_first_only_always", "correction_of_one_only", "134",
       "Only the first body is moved out of an overlap: both move, each by its share of the inverse masses."},
      {"correction_of_the_second_only_always", "correction_of_one_only", "134",
       "Only the second body is moved out of an overlap: both move, each by its share of the inverse "
       "masses."},
      {"first_contact_only", "first_contact_only", "3",
       "Only the first contact of a step is answered: go over all of them."},
      {"last_contact_only", "first_contact_only", "3",
       "Only the last contact of a step is answered: go over all of them."},
      {"contacts_once", "one_sweep", "34",
       "Each contact is answered once a step, so that what one changes spoils another: go over all contacts "
       "several "
       "times."},
      {"sinks", "sinks", "3", "What rests sinks in: correct positions by a share of the overlap each step."},
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
      {"inverse_mass_mean", "one_inverse_mass", "3",
       "Both velocities change by j times the mean of the two inverse masses: each has its own."},
      {"masses_in_place_of_inverses", "masses_in_place_of_inverses", "3",
       "The impulse is too weak: it is divided by m1 + m2, which is right only for two masses of 1. It is "
       "-(1 + e) vn/(1/m1 + 1/m2)."},
      {"masses_in_place_of_inverses_of_moving", "masses_in_place_of_inverses", "3",
       "The impulse is too weak: it is divided by m1 + m2, which is right only for two masses of 1. It is "
       "-(1 + e) vn/(1/m1 + 1/m2)."},
      {"masses_swapped", "masses_swapped", "3", "Each ball gets the other's inverse mass."},
      {"masses_swapped_of_moving", "masses_swapped", "3", "Each ball gets the other's inverse mass."},
      {"effective_mass_forgotten", "effective_mass_forgotten", "3",
       "The impulse is not divided by 1/m1 + 1/m2."},
      {"effective_mass_multiplied", "effective_mass_forgotten", "3",
       "The impulse is multiplied by 1/m1 + 1/m2: divide by it."},
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
      {"closing_test_reversed", "closing_test_reversed", "134", kTestReversed},
      {"closing_test_reversed_with_bounce", "closing_test_reversed", "134", kTestReversed},
      {"circles_as_squares", "circles_as_squares", "34",
       "Circles collide when the squares around them overlap: they touch when their distance is below r1 + "
       "r2."},
      {"radius#the first", "radius_of_another", "3", kRadiusOfAnother},
      {"radius#the last", "radius_of_another", "3", kRadiusOfAnother},
      {"static_bodies_not_answered", "static_bodies_not_answered", "134",
       "A contact with a static body gives no impulse: its inverse mass is 0, and 1/ma + 1/mb is that of the "
       "other body."},
      {"overlap_test_reversed", "overlap_test_reversed", "3",
       "Circles that are apart collide, and those that overlap do not: they touch when their distance is "
       "below r1 + r2."},
      {"each_turned_by_itself", "each_turned", "34",
       "Each ball turns round as at a wall: reverse the relative velocity, (vb - va) . n, and share the "
       "impulse by "
       "the inverse masses."},
      {"static_has_mass", "static_has_mass", "3",
       "The static post has a mass: its inverse mass is 0, so that no impulse changes its velocity."},
      {"correction_split_evenly", "correction_split_evenly", "3",
       "10 kg and 1 kg are moved equally far: each moves by its inverse mass over the sum of both, here 1 "
       "and 10 parts of 11."},
      {"correction_not_divided", "correction_not_divided", "3",
       "The correction of an overlap is not divided by 1/ma + 1/mb: light balls are pushed apart by many "
       "times "
       "their overlap. Each moves by its inverse mass over that sum."},
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
  };
}

}  // namespace plumb::course
