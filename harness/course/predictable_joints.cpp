#include <fmt/format.h>

#include "harness/course/predictable.h"

// The mistakes of chapter 5.
namespace plumb::course {
namespace {

// Causes that several mistakes share.
constexpr const char* kArmOfTheOther =
    "An impulse acts at the other body's arm: each body has its own r, from its centre to the point.";
constexpr const char* kOneNeverSpins =
    "Only one of the two bodies gets spin from the joint: each changes its w by r x j/I, with its own r and "
    "I, and a gets the opposite impulse.";
constexpr const char* kOneAnchor =
    "One of the two anchors does not turn with its own body: turn each by the angle of the body that it is "
    "on.";
constexpr const char* kOneTurnsBackwards =
    "Correcting the hinge's positions turns one of the bodies the wrong way: the angle of a changes by (ra x "
    "push)/Ia, that of b by minus (rb x push)/Ib.";
constexpr const char* kJoinedCollide =
    "Some bodies that a joint connects collide: keep the pairs of all joints, in either order.";
constexpr const char* kJointsLeftOut =
    "Not all joints act: go over all of them, the first and the last included.";
constexpr const char* kHingeCorrection =
    "A gap of a hinge is closed along one axis only: correct its x and its y.";
constexpr const char* kOneEnd =
    "Correcting a joint's positions moves one end only: both move, each by its share of the inverse masses.";

}  // namespace

std::vector<Predictable> mistakes_of_kept_joints() {
  struct Part {
    unsigned parts;
    const char* what;
  };
  constexpr Part kParts[] = {{1, "the first body's arm is"},
                             {2, "the second body's arm is"},
                             {3, "the arms are"},
                             {4, "the direction of a stick is"},
                             {7, "the arms and the direction of a stick are"}};
  struct When {
    int when;
    const char* what;
  };
  constexpr When kWhen[] = {{1, "the first step"}, {2, "the step before"}};
  struct Rows {
    unsigned rows;
    const char* what;
  };
  constexpr Rows kRows[] = {{8, "a joint's impulse"},
                            {16, "the correction of a joint's positions"},
                            {24, "a joint's impulse and its correction"}};
  std::vector<Predictable> out;
  for (const Part& part : kParts)
    for (const When& when : kWhen)
      for (const Rows& rows : kRows)
        out.push_back(
            {fmt::format("stale:{}:{}:{}", part.parts, when.when, rows.rows), "joint_not_updated", "5",
             fmt::format("In {}, {} that of {}: turn the anchors by the angles of now, and take the "
                         "direction from them, in each step.",
                         rows.what, part.what, when.what),
             true});
  return out;
}

std::vector<Predictable> mistakes_of_joints() {
  return {
      {"joint_arms_of_before", "joint_arms_of_before", "5",
       "Positions of joints are corrected with arms of before the bodies moved: turn each anchor by its "
       "body's "
       "angle of now, again for each correction."},
      {"last_joined_pair_only", "joined_bodies_collide", "5", kJoinedCollide},
      {"first_joined_pair_only", "joined_bodies_collide", "5", kJoinedCollide},
      {"joined_in_one_order", "joined_bodies_collide", "5", kJoinedCollide},
      {"joint_ignored", "joint_ignored", "5", "The joint does nothing: nothing holds the two together."},
      {"last_joint_left_out", "joints_left_out", "5", kJointsLeftOut},
      {"first_joint_left_out", "joints_left_out", "5", kJointsLeftOut},
      {"first_joint_only", "joints_left_out", "5", kJointsLeftOut},
      {"last_joint_only", "joints_left_out", "5", kJointsLeftOut},
      {"impulse of a joint*0.5", "joint_impulse_halved", "5",
       "Half of the joint's impulse acts: it is -dC/dt/(1/ma + 1/mb)."},
      {"impulse of a joint*2", "joint_impulse_twice", "5",
       "The joint's impulse is twice what it should be: it is to stop the change of length, not to reverse "
       "it."},
      {"impulse of a joint*-1", "impulse_backwards", "5",
       "The joint's impulse has the wrong sign: it is -dC/dt/(1/ma + 1/mb) along the joint; b gets it, and a "
       "the opposite one."},
      {"joint_same_direction", "same_direction_for_both", "5",
       "Both ends get the joint's impulse in the same direction: b gets it, and a the opposite one."},
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
      {"correction_moves_both_alike", "masses_ignored", "5",
       "Correcting a joint's positions moves both ends alike: share it by inverse mass."},
      {"correction_by_the_first_mass", "masses_ignored", "5",
       "Correcting a joint's positions moves both ends by the inverse mass of the first: each moves by its "
       "own."},
      {"correction_by_the_second_mass", "masses_ignored", "5",
       "Correcting a joint's positions moves both ends by the inverse mass of the second: each moves by its "
       "own."},
      {"velocities_not_recomputed", "velocities_not_recomputed", "5",
       "Positions are corrected and velocities stay as they were: after joints have moved bodies, a velocity "
       "is the "
       "displacement over the step, v = (x' - x)/h."},
      {"spins_not_recomputed", "velocities_not_recomputed", "5",
       "Angles are corrected and spins stay as they were: after joints have turned bodies, w = (angle' - "
       "angle)/h."},
      {"stick_one_body_only", "one_body_only", "5",
       "Only the second body is held: the joint pulls on both, and the first must come along."},
      {"stick_pulls_the_second_only", "one_body_only", "5",
       "Only the second body is held: the joint pulls on both, and the first must come along."},
      {"stick_other_body_only", "one_body_only", "5",
       "Only the first body is held: the joint pulls on both, and the second must feel it as well."},
      {"stick_pulls_the_first_only", "one_body_only", "5",
       "Only the first body is held: the joint pulls on both, and the second must feel it as well."},
      {"joint_pulls_the_second_if_it_moves", "one_body_only", "5",
       "Only the second body is held: the joint pulls on both, and the first must come along."},
      {"joint_pulls_the_first_if_it_moves", "one_body_only", "5",
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
      {"first_anchor_not_turned", "anchor_not_turned", "5", kOneAnchor},
      {"second_anchor_not_turned", "anchor_not_turned", "5", kOneAnchor},
      {"second_anchor_turned_by_the_first", "anchor_not_turned", "5", kOneAnchor},
      {"first_anchor_turned_by_the_second", "anchor_not_turned", "5", kOneAnchor},
      {"joint_mass_of_the_first_arm", "arm_of_the_other", "5",
       "The joint's effective mass has the first body's arm for both: each term has its own r."},
      {"joint_mass_of_the_second_arm", "arm_of_the_other", "5",
       "The joint's effective mass has the second body's arm for both: each term has its own r."},
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
      {"hinge_as_stick", "hinge_as_stick", "5",
       "The hinge holds its ends as a stick of length 0 does, along the gap between them: it holds them "
       "along x "
       "and along y, whatever the gap is."},
      {"length_of_start", "length_of_start", "5",
       "A stick keeps the length that it has at the start: take \"length\" from the scene."},
      {"length_of_centres_at_start", "length_of_start", "5",
       "A stick has the distance that the two centres have at the start: take \"length\" from the scene, "
       "from "
       "anchor to anchor."},
      {"hinge_shares_spin", "hinge_shares_spin", "5",
       "The hinge makes both bodies turn alike: it holds the two anchors together and leaves the spins "
       "free."},
      {"joint_never_spins", "joint_never_spins", "5",
       "The hinge's impulse never changes the spin: add r x j/I to w."},
      {"joint_without_rotation", "effective_mass_without_rotation", "5",
       "The effective mass of the hinge lacks (r x n)^2/I: its impulse is too strong."},
      {"joint_spins_the_first_only", "one_body_never_spins", "5", kOneNeverSpins},
      {"joint_spins_the_second_only", "one_body_never_spins", "5", kOneNeverSpins},
      {"joint_arms_swapped", "arm_of_the_other", "5", kArmOfTheOther},
      {"joint_first_arm_for_both", "arm_of_the_other", "5", kArmOfTheOther},
      {"joint_second_arm_for_both", "arm_of_the_other", "5", kArmOfTheOther},
      {"stick_not_unit", "normal_not_unit", "5",
       "The stick's impulse depends on its length: divide the way from end to end by its length to get the "
       "direction."},
      {"stick_only_pulls", "stick_only_pulls", "5",
       "The stick holds as a rope does, and gives way when its ends are pushed together: its impulse and its "
       "correction have both signs."},
      {"stick_only_pushes", "stick_only_pushes", "5",
       "The stick gives way when its ends are pulled apart: its impulse and its correction have both signs."},
      {"stick_impulse_only_pulls", "stick_only_pulls", "5",
       "The stick's impulse only pulls, and lets its ends come together: it has both signs."},
      {"stick_impulse_only_pushes", "stick_only_pushes", "5",
       "The stick's impulse only pushes, and lets its ends part: it has both signs."},
      {"stick_correction_only_pulls", "correction_one_sided", "5",
       "A stick's positions are corrected only if it is too long: its error, length minus \"length\", has "
       "both "
       "signs, and a stick that is too short is lengthened."},
      {"stick_correction_only_pushes", "correction_one_sided", "5",
       "A stick's positions are corrected only if it is too short: its error, length minus \"length\", has "
       "both signs, and a stick that is too long is shortened."},
      {"stick_correction_sign_lost", "correction_sign_lost", "5",
       "A stick that is too short is shortened further: its error, length minus \"length\", keeps its sign."},
      {"hinge_correction_along_x_only", "hinge_one_axis", "5", kHingeCorrection},
      {"hinge_correction_along_y_only", "hinge_one_axis", "5", kHingeCorrection},
      {"hinges_corrected_only", "correction_of_some_joints", "5",
       "The positions of hinges are corrected and those of sticks are not: correct all joints."},
      {"sticks_corrected_only", "correction_of_some_joints", "5",
       "The positions of sticks are corrected and those of hinges are not: correct all joints."},
      {"correction_of_the_first_end_only", "correction_of_one_end", "5", kOneEnd},
      {"correction_of_the_second_end_only", "correction_of_one_end", "5", kOneEnd},
      {"correction_turns_backwards", "correction_turns_backwards", "5",
       "Correcting the hinge's positions turns the bodies the wrong way: the angle changes by (r x push)/I, "
       "with the push that moves this body."},
      {"correction_turns_the_first_backwards", "correction_turns_backwards", "5", kOneTurnsBackwards},
      {"correction_turns_the_second_backwards", "correction_turns_backwards", "5", kOneTurnsBackwards},
      {"correction_never_turns", "correction_never_turns", "5",
       "Correcting the hinge's positions moves bodies and does not turn them: the push at the anchor also "
       "changes the angle by (r x push)/I."},
      {"joined_bodies_collide", "joined_bodies_collide", "5",
       "The rod is pushed out of the post that it hangs on: bodies that a joint connects do not collide, "
       "unless \"collide\" is true."},
      {"length of a stick*-1", "length_of_stick_reversed", "5",
       "The motion is that of an engine in which the length of a stick has the wrong sign."},
  };
}

}  // namespace plumb::course
