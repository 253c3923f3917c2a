#include "harness/course/predictable.h"

// The mistakes of loops over bodies, of the order of a step's stages, and of bounds compared before shapes.
namespace plumb::course {
namespace {

constexpr const char* kPairEndsTheLoop =
    "A pair that cannot collide ends the loop, so that the bodies after it in the list are not compared: go "
    "on "
    "with the next one (continue, not break or return).";
constexpr const char* kStaticEndsTheLoop =
    "A pair of two static bodies ends the loop, so that the bodies after it in the list are not compared: go "
    "on "
    "with the next one (continue, not break or return).";
constexpr const char* kForcesAfterSolving =
    "Each step moves bodies with a g dt that nothing has stopped: forces act after contacts and joints are "
    "solved, or bodies move before that. First the forces change the velocities, then contacts and joints "
    "do, then bodies move.";
constexpr const char* kOnePartner =
    "A body that touches two others is answered by the first of them only: go over all pairs, and do not end "
    "the loop at the first contact.";
constexpr const char* kOpening =
    "Contacts whose bodies do not close before the first sweep are left out of all sweeps: an impulse at "
    "another "
    "contact may close them in the same step. Keep them, and let the sum of impulses, which stays at 0 or "
    "above, "
    "decide in each sweep.";
constexpr const char* kOrderOfPair =
    "Pairs are left out by which of the two bodies comes first in the scene: a pair is left out only if both "
    "are static.";
constexpr const char* kFlippedInOneOrder =
    "The normal points the wrong way if the box and the circle come in one of the two orders: when the two "
    "bodies are exchanged for the test, reverse its normal.";
constexpr const char* kBounds =
    "Two bodies are compared only if their bounds overlap, and the bounds of a turned box are too small: its "
    "half extents are w/2 |cos a| + h/2 |sin a| along x and w/2 |sin a| + h/2 |cos a| along y, and a circle "
    "around it has half of its diagonal as radius.";
constexpr const char* kWholeSum =
    "The sum of the impulses is applied in each sweep: apply what the sum has changed by.";
constexpr const char* kSpringTurnsOne =
    "A spring turns only one of its bodies: each gets the torque r x F, with its own r and the force that "
    "pulls it.";
constexpr const char* kSpringArm =
    "A spring's torque on a body has the other body's arm: each has its own r, from its centre to its "
    "anchor.";
constexpr const char* kSpringRateArm =
    "The velocity of a spring's end has the other body's arm: it is v + w x r, with the body's own r.";
constexpr const char* kSpringAnchor =
    "One anchor of a spring is used for both ends: \"anchor_a\" is a point of a, \"anchor_b\" one of b.";

}  // namespace

std::vector<Predictable> mistakes_of_order() {
  return {
      {"static_pair_ends_the_loop", "pair_ends_the_loop", "134", kStaticEndsTheLoop},
      {"joined_pair_ends_the_loop", "pair_ends_the_loop", "5", kPairEndsTheLoop},
      {"inactive_force_ends_the_loop", "forces_after_another_lost", "2",
       "A force that does not act now ends the loop over all forces, so that those after it in the list do "
       "not act: go on with the next one (continue, not break or return)."},
      {"force_to_come_ends_the_loop", "forces_after_another_lost", "2",
       "A force that has not begun ends the loop over all forces, so that those after it in the list do not "
       "act: go on "
       "with the next one (continue, not break or return)."},
      {"force_over_ends_the_loop", "forces_after_another_lost", "2",
       "A force that is over ends the loop over all forces, so that those after it in the list do not act: "
       "go on with "
       "the next one (continue, not break or return)."},
      {"first_partner_only", "pairs_missed", "34", kOnePartner},
      {"one_partner_for_each", "pairs_missed", "34", kOnePartner},
      {"one_partner_for_each_moving", "pairs_missed", "34", kOnePartner},
      {"one_contact_of_the_first", "pairs_missed", "34", kOnePartner},
      {"one_contact_of_the_second", "pairs_missed", "34", kOnePartner},
      {"opening_contacts_left_out", "opening_contacts_left_out", "34", kOpening},
      {"parting_contacts_left_out", "opening_contacts_left_out", "34", kOpening},
      {"pairs_of_a_static_first_left_out", "pairs_left_out", "134", kOrderOfPair},
      {"pairs_of_a_static_second_left_out", "pairs_left_out", "134", kOrderOfPair},
      {"normal_flipped_if_box_first", "normal_flipped", "14", kFlippedInOneOrder},
      {"normal_flipped_if_circle_first", "normal_flipped", "14", kFlippedInOneOrder},
      {"parting_contact_ends_the_loop", "contacts_after_another_lost", "34",
       "A contact whose bodies part ends the loop over contacts, so that those after it are not answered: go "
       "on "
       "with the next one (continue, not break or return)."},
      {"forces_after_solving", "forces_after_solving", "1345", kForcesAfterSolving},
      {"moves_before_contacts", "forces_after_solving", "45", kForcesAfterSolving},
      {"contacts_before_forces", "forces_after_solving", "5", kForcesAfterSolving},
      {"distance_of_centres_at_box", "distance_of_centres", "134",
       "The distance from a box is that of the two centres: it is the distance of the circle's centre from "
       "the box's "
       "nearest point."},
      {"distance_by_sum_at_box", "distance_by_sum", "134",
       "The distance from a box's nearest point is taken as |dx| + |dy|: it is the root of dx^2 + dy^2."},
      {"bounds_not_turned", "bounds_too_small", "45", kBounds},
      {"bounds_of_first_angle", "bounds_too_small", "45", kBounds},
      {"bounds_sign_lost", "bounds_too_small", "45", kBounds},
      {"bounds_of_one_corner", "bounds_too_small", "45", kBounds},
      {"bounds_by_longer_side", "bounds_too_small", "45", kBounds},
      {"bounds_by_shorter_side", "bounds_too_small", "145", kBounds},
      {"bounds_by_width", "bounds_too_small", "145", kBounds},
      {"bounds_by_height", "bounds_too_small", "145", kBounds},
      {"whole_sum_applied", "whole_sum_applied", "134", kWholeSum},
      {"whole_friction_sum_applied", "whole_sum_applied", "4", kWholeSum},
      {"threshold_without_dt", "threshold_too_high", "13",
       "Impacts slower than 2 g, about 20 m/s, do not bounce: the speed below which restitution is 0 is 2 g "
       "dt, "
       "what gravity adds in two steps."},
      {"threshold_of_whole_speed", "threshold_of_whole_speed", "14",
       "A ball that rolls or slides on the floor bounces, as the test for slow impacts takes its whole "
       "speed: "
       "compare the speed along the normal, vn, with 2 g dt."},
      {"spring_velocity_flipped", "point_velocity", "4",
       "The velocity of a point has its spin with the wrong sign: it is v + w x r, which is (vx - w ry, vy + "
       "w "
       "rx)."},
      {"bounce_of_centres", "point_velocity", "4",
       "A bounce gives back e of the speed at which the centres close: it is that of their points, v + w x "
       "r."},
      {"stick_along_centres", "stick_along_centres", "5",
       "A stick's impulse is along the line of the two centres: it is along the stick, from anchor to "
       "anchor."},
      {"spring_rate_of_centres", "point_velocity", "4",
       "A spring's damping takes the velocities of the centres: it acts against the speed at which the "
       "anchors "
       "part, v + w x r each."},
      {"spring_never_turns", "spring_never_turns", "4",
       "A spring at a point off the centre does not turn the body: its force acts at the anchor, with the "
       "torque r x F."},
      {"spring_turns_the_first_only", "one_body_never_spins", "4", kSpringTurnsOne},
      {"spring_turns_the_second_only", "one_body_never_spins", "4", kSpringTurnsOne},
      {"spring_torque_arms_swapped", "arm_of_the_other", "4", kSpringArm},
      {"spring_torque_first_arm", "arm_of_the_other", "4", kSpringArm},
      {"spring_torque_second_arm", "arm_of_the_other", "4", kSpringArm},
      {"spring_rate_arms_swapped", "arm_of_the_other", "4", kSpringRateArm},
      {"spring_rate_first_arm", "arm_of_the_other", "4", kSpringRateArm},
      {"spring_rate_second_arm", "arm_of_the_other", "4", kSpringRateArm},
      {"spring_turns_backwards", "torque_backwards", "4",
       "A spring turns its bodies the wrong way: the torque is r x F = rx Fy - ry Fx, with the force that "
       "pulls "
       "this body."},
      {"spring_one_anchor_for_both", "one_anchor", "4", kSpringAnchor},
      {"spring_second_anchor_for_both", "one_anchor", "4", kSpringAnchor},
      {"spring_damps_the_whole_velocity", "damping_not_along_spring", "24",
       "A spring's damping acts against the whole relative velocity: it acts along the spring alone, against "
       "the "
       "speed at which the ends part."},
      {"damping_without_sign", "damping_by_speed", "24",
       "A spring's damping always pulls: the speed at which its ends part has a sign, and is negative when "
       "they "
       "come nearer."},
      {"torque_time_ignored", "torque_always", "4",
       "A torque acts all the time: it acts from \"start\" to \"start\" + \"duration\", as a force does."},
      {"force_never_turned", "force_frame", "4",
       "A force whose \"frame\" is \"body\" does not turn with its body: turn it by the body's angle."},
      {"force_always_turned", "force_frame", "4",
       "All forces turn with their bodies: only those whose \"frame\" is \"body\" do."},
      {"drag_slows_spin", "drag_slows_spin", "4",
       "Drag slows the spin as well: linear_drag is a force at the centre, -c v, and has no torque."},
      {"angle_by_old_spin", "explicit_euler", "4",
       "Angles turn with the spin of before the step's torques: update the spin first, then the angle with "
       "the "
       "new one."},
      {"stick_anchors_ignored", "lever_forgotten", "5",
       "A stick holds centres: it should hold its anchors, each at r from its body's centre."},
  };
}

}  // namespace plumb::course
