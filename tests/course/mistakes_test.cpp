// Every mistake that is planted in the learner's engine is recognised by name in the check that it spoils.
#include <gmock/gmock.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>

#include "harness/course/course.h"
#include "harness/course/report.h"
#include "harness/course/student/student.h"

namespace plumb::course {
namespace {

struct Seed {
  const char* planted;
  const char* check;
  const char* recognised;
};

constexpr Seed kSeeds[] = {
    {"no_gravity", "falls", "no_gravity"},
    {"damping", "falls", "damping"},
    {"speeding_up", "falls", "speeding_up"},
    {"gravity_of_9_8", "falls", "gravity_hard_coded"},
    {"gravity_upwards", "falls", "gravity_upwards"},
    {"gravity_twice", "falls", "gravity_twice"},
    {"dt_twice", "falls", "dt_twice"},
    {"dt_missing", "falls", "dt_missing"},
    {"milliseconds", "falls", "milliseconds"},
    {"explicit_euler", "falls_far_enough", "explicit_euler"},
    {"half_a_step_twice", "falls_far_enough", "half_a_step_twice"},
    {"velocity_without_dt", "falls_far_enough", "velocity_without_dt"},
    {"gravity_hard_coded", "scene_says_gravity", "gravity_hard_coded"},
    {"gravity_only_down", "scene_says_gravity", "gravity_only_down"},
    {"starts_at_rest", "scene_says_gravity", "starts_at_rest"},
    {"explicit_euler", "scene_says_gravity", "explicit_euler"},
    {"per_frame", "any_step_size", "per_frame"},
    {"falls_through", "bounces", "falls_through"},
    {"both_turned", "bounces", "both_turned"},
    {"restitution_squared", "restitution", "restitution_squared"},
    {"restitution_average", "restitution", "restitution_average"},
    {"restitution_product", "restitution", "restitution_product"},
    {"always_elastic", "restitution", "restitution_ignored"},
    {"restitution_zero", "restitution", "restitution_zero"},
    {"turned_every_step", "restitution", "turned_every_step"},
    {"wall_missing", "four_walls", "wall_missing"},
    {"always_elastic", "settles", "restitution_ignored"},
    {"ignores_slow", "settles", "sinks"},
    {"mass_not_divided", "ten_times_the_mass", "mass_not_divided"},
    {"gravity_divided_by_mass", "all_fall_alike", "gravity_divided_by_mass"},
    {"weight_not_divided", "all_fall_alike", "weight_not_divided"},
    {"last_force_only", "forces_add", "last_force_only"},
    {"first_force_lost", "forces_add", "first_force_lost"},
    {"force_not_cleared", "force_accelerates", "force_not_cleared"},
    {"push_never_ends", "push_ends", "push_never_ends"},
    {"drag_pushes", "drag", "drag_pushes"},
    {"drag_not_divided", "drag", "drag_not_divided"},
    {"explicit_euler", "spring", "explicit_euler"},
    {"spring_pushes", "spring", "spring_pushes"},
    {"rest_length_ignored", "spring", "rest_length_ignored"},
    {"no_detection", "detects", "no_detection"},
    {"normal_flipped", "detects", "normal_flipped"},
    {"diameters", "detects", "diameters"},
    {"one_radius", "detects", "one_radius"},
    {"square_of_distance", "detects", "square_of_distance"},
    {"normal_flipped", "equal_masses_swap", "normal_flipped"},
    {"impulse_backwards", "equal_masses_swap", "impulse_backwards"},
    {"each_turned", "equal_masses_swap", "each_turned"},
    {"no_test_of_parting", "parting_is_left_alone", "no_test_of_parting"},
    {"one_body_only", "equal_masses_swap", "one_body_only"},
    {"masses_ignored", "heavy_hits_light", "masses_ignored"},
    {"inverse_mass_forgotten", "heavy_hits_light", "inverse_mass_forgotten"},
    {"masses_in_place_of_inverses", "heavy_hits_light", "masses_in_place_of_inverses"},
    {"effective_mass_forgotten", "heavy_hits_light", "effective_mass_forgotten"},
    {"effective_mass_multiplied", "equal_masses_swap", "effective_mass_forgotten"},
    {"masses_swapped", "heavy_hits_light", "masses_swapped"},
    {"always_elastic", "restitution_of_two", "always_elastic"},
    {"restitution_zero", "restitution_of_two", "restitution_ignored"},
    {"restitution_squared", "restitution_of_two", "restitution_squared"},
    {"whole_velocity", "oblique", "whole_velocity"},
    {"normal_not_unit", "oblique", "normal_not_unit"},
    {"static_has_mass", "post", "static_has_mass"},
    {"correction_split_evenly", "overlap_is_shared", "correction_split_evenly"},
    {"correction_adds_energy", "break_shot", "correction_adds_energy"},
    {"sinks", "pile_rests", "sinks"},
    {"inertia_sixth", "torque_spins", "inertia_sixth"},
    {"one_side_only", "torque_spins", "one_side"},
    {"mass_for_inertia", "torque_spins", "mass_for_inertia"},
    {"thin_box_as_square", "shapes_have_inertia", "thin_box_as_square"},
    {"disc_as_ring", "shapes_have_inertia", "disc_as_ring"},
    {"angle_in_degrees", "angle_in_radians", "degrees"},
    {"spin_in_degrees", "angle_in_radians", "degrees"},
    {"lever_from_origin", "central_force", "lever_from_origin"},
    {"torque_backwards", "corner_force", "torque_backwards"},
    {"point_ignored", "corner_force", "point_ignored"},
    {"point_not_turned", "corner_force", "point_not_turned"},
    {"r_cross_n_flipped", "ball_hits_rod", "r_cross_n_flipped"},
    {"no_rotation", "ball_hits_rod", "no_rotation"},
    {"effective_mass_without_rotation", "ball_hits_rod", "effective_mass_without_rotation"},
    {"falls_through_boxes", "upright_boxes_collide", "no_collision"},
    {"fixed_rotation_ignored", "upright_boxes_collide", "fixed_rotation_ignored"},
    {"largest_overlap", "least_overlap", "largest_overlap"},
    {"friction_ignored", "slides", "friction_ignored"},
    {"friction_unlimited", "slides", "friction_unlimited"},
    {"both_corners_take_all", "lands_flat", "both_corners_take_all"},
    {"one_corner", "box_rests", "one_corner"},
    {"joint_ignored", "stick_keeps_its_length", "joint_ignored"},
    {"no_position_correction", "stick_keeps_its_length", "no_position_correction"},
    {"stick_masses_ignored", "stick_weighs_masses", "masses_ignored"},
    {"stick_one_body_only", "stick_weighs_masses", "one_body_only"},
    {"gravity_twice", "pendulum", "gravity_twice"},
    {"lever_forgotten", "hinged_rod", "lever_forgotten"},
    {"inertia_sixth", "hinged_rod", "inertia_sixth"},
    {"too_few_iterations", "chain_swings", "too_few_iterations"},
    {"joint_ignored", "ragdoll_flies", "joint_ignored"},
    {"stick_one_body_only", "ragdoll_flies", "one_body_only"},
    {"joint_ignored", "ragdoll_drops", "joint_ignored"},
    {"answers_before_the_step", "falls", "a_step_late"},
    {"first_step_twice", "falls", "a_step_ahead"},
    {"speed below which bodies stop*0.3", "falls", "slow_is_stopped"},
    {"wall_normal_from_centre", "bounces", "normal_from_centre"},
    {"bounce_of_whole_speed", "bounces", "bounce_of_whole_speed"},
    {"gravity_off_while_touching", "settles", "gravity_off_while_touching"},
    {"weight_with_every_force", "forces_add", "weight_with_every_force"},
    {"sum_of_squared_radii", "heavy_hits_light", "sum_of_squared_radii"},
    {"normal_along_approach", "oblique", "normal_along_velocity"},
    {"second_sees_new_velocity", "equal_masses_swap", "impulses_not_opposite"},
    {"second_moment_of_area", "torque_spins", "second_moment_of_area"},
    {"first_arm_for_both", "ball_hits_rod", "arm_of_the_other"},
    {"each_push_clamped", "lands_flat", "sum_not_kept"},
    {"joint_spins_the_second_only", "hinge_turns_both", "one_body_never_spins"},
    {"correction_of_the_second_end_only", "stick_weighs_masses", "correction_of_one_end"},
    {"stick_only_pulls", "stick_weighs_masses", "stick_only_pulls"},
    {"correction_turns_backwards", "hinged_rod", "correction_turns_backwards"},
    {"one_plus_twice", "bounces", "one_plus_twice"},
    {"inertia_inverted", "torque_spins", "inertia_inverted"},
    {"spring_same_direction", "spring", "same_direction_for_both"},
    {"stick_impulse_only_pushes", "stick_weighs_masses", "stick_only_pushes"},
    {"spring_pulls_the_first_only", "spring", "spring_at_one_end"},
    {"spring_pulls_the_second_only", "spring", "spring_at_one_end"},
    {"damping of a spring*0", "damped_spring", "damping_ignored"},
    {"spring_damps_the_second_only", "damped_spring", "damping_of_one_end"},
    {"normal_along_longer_axis_with_point", "oblique", "normal_along_axis"},
    {"box_taken_upright", "turned_box", "box_not_turned"},
    {"side_of_box_not_turned", "turned_box", "box_not_turned"},
    {"box_turned_backwards", "turned_box", "turned_backwards"},
    {"contact_point_at_second_centre", "discs_rub", "contact_point_at_centre"},
    {"friction_lever_not_squared", "discs_rub", "lever_not_squared"},
    {"friction_never_spins", "discs_rub", "friction_never_spins"},
    {"spring_never_turns", "corner_spring", "spring_never_turns"},
    {"spring_turns_backwards", "corner_spring", "torque_backwards"},
    {"stick_impulse_only_pulls", "stick_weighs_masses", "stick_only_pulls"},
    {"gravity@-x,y", "scene_says_gravity", "axis_reversed"},
    {"velocity in an impulse@y,x", "bounces", "axes_mixed"},
    {"drag@x,x", "drag", "axes_mixed"},
    {"move_per_frame", "any_step_size", "per_frame"},
    {"width of a box*2", "bounces", "whole_sizes"},
    {"height_for_both", "bounces", "one_side_for_both"},
    {"bounce_without_speed", "bounces", "bounce_without_speed"},
    {"push_from_zero", "push_ends", "push_from_zero"},
    {"drag_dt_twice", "drag", "drag_dt_twice"},
    {"length_squared", "spring", "length_squared"},
    {"damping_by_speed", "damped_spring", "damping_by_speed"},
    {"larger_radius_alone", "detects", "one_radius"},
    {"correction_not_divided", "overlap_is_shared", "correction_not_divided"},
    {"lever_not_squared", "ball_hits_rod", "lever_not_squared"},
    {"friction_by_weight", "discs_rub", "friction_without_normal"},
    {"sliding_of_the_second_centre", "discs_rub", "point_velocity"},
    {"share of a joint's error without dt*0.2", "stick_keeps_its_length", "bias_without_dt"},
    {"second_anchor_turned_by_the_first", "hinged_rod", "anchor_not_turned"},
    {"correction_turns_the_second_backwards", "hinged_rod", "correction_turns_backwards"},
    {"drag>position by dt", "drag", "force_moves_position"},
    {"drag>velocity", "drag", "force_without_dt"},
    {"spring>position by dt/m", "spring", "force_moves_position"},
    {"a force's point~overwriting x", "corner_force", "turn_overwrites_x"},
    {"a force's point~without the minus", "corner_force", "turn_sign_lost"},
    {"a joint's anchors~backwards", "hinged_rod", "turned_backwards"},
    {"a joint's anchors~overwriting x", "hinged_rod", "turn_overwrites_x"},
    {"closing_test_reversed", "bounces", "closing_test_reversed"},
    {"closing_test_reversed", "equal_masses_swap", "closing_test_reversed"},
    {"each_turned_by_itself", "equal_masses_swap", "each_turned"},
    {"threshold_reversed", "restitution", "threshold_reversed"},
    {"push_outside_its_time", "push_ends", "push_outside_its_time"},
    {"overlap_test_reversed", "detects", "overlap_test_reversed"},
    {"clamp_exchanged", "four_walls", "clamp_exchanged"},
    {"mass_from_area", "spring", "mass_from_size"},
    {"time_for_dt", "falls", "time_for_dt"},
    {"spring_by_component", "spring", "spring_by_component"},
    {"static_bodies_not_answered", "post", "static_bodies_not_answered"},
    {"hinge_shares_spin", "hinge_turns_both", "hinge_shares_spin"},
    {"circles_as_squares", "oblique", "circles_as_squares"},
    {"point_taken_for_world", "central_force", "point_taken_for_world"},
    {"friction_bounds_exchanged", "slides", "friction_bounds_exchanged"},
    {"speed below which bodies do not move*0.1", "scene_says_gravity", "slow_is_stopped"},
    {"size of the cells in which circles are compared*1", "detects", "place_matters"},
    {"inactive_force_ends_the_loop", "push_ends", "forces_after_another_lost"},
    {"spring_by_strain", "spring", "spring_by_strain"},
    {"sum_of_the_later_body", "parting_is_left_alone", "sum_shared"},
    {"a box~by the first angle", "turned_box", "first_angle_kept"},
    {"last_joined_pair_only", "hinge_turns_both", "joined_bodies_collide"},
    {"joint_arms_of_before", "hinged_rod", "joint_arms_of_before"},
    {"circle_as_square_at_box", "bounces", "circles_as_squares"},
    {"mass in F/m#the first", "push_ends", "mass_of_another"},
    {"drag_by_position", "drag", "drag_of_another_vector"},
    {"spring_damps_the_sum", "damped_spring", "damping_by_sum"},
    {"square_for_distance", "detects", "square_of_distance"},
    {"torque_not_cleared", "torque_spins", "force_not_cleared"},
    {"static_has_inertia", "lands_flat", "static_has_mass"},
    {"tangent_not_unit", "slides", "tangent_not_unit"},
    {"length_of_start", "stick_keeps_its_length", "length_of_start"},
};

// Runs the whole chapter: what a mistake does in the other checks tells it from others.
Finding finding_of(const std::string& mistake, const std::string& check) {
  static std::map<std::pair<std::string, int>, std::vector<std::pair<std::string, Finding>>> seen;
  for (const Chapter& chapter : chapters()) {
    if (std::none_of(chapter.checks.begin(), chapter.checks.end(),
                     [&](const Check& each) { return each.name == check; }))
      continue;
    const auto [place, is_new] = seen.try_emplace({mistake, chapter.number});
    if (is_new)
      examine(*make_student(mistake), {}, {&chapter, 1}, [&place = place](const Outcome& outcome) {
        place->second.emplace_back(outcome.check->name, outcome.finding);
      });
    for (const auto& [name, finding] : place->second)
      if (name == check) return finding;
  }
  throw std::out_of_range(check);
}

TEST(Mistakes, ALearnerWhoMakesNonePassesEveryCheck) {
  const std::vector<Chapter> all = chapters();
  for (const Outcome& outcome : examine(*make_student(""), {}, all, [](const Outcome&) {}))
    EXPECT_EQ(outcome.finding.verdict, Verdict::Pass) << line(outcome, {});
}

TEST(Mistakes, EachIsRecognisedByName) {
  std::size_t described = 0;
  for (const Seed& seed : kSeeds) {
    const Finding finding = finding_of(seed.planted, seed.check);
    std::string readings;
    for (const Reading& r : finding.readings) readings += "\n  " + r.what + " " + std::to_string(r.measured);
    EXPECT_EQ(finding.verdict, Verdict::Fail) << seed.planted << " in " << seed.check;
    // Accepts a description of both where two give one motion, and none is named.
    if (finding.mistake.empty() &&
        finding.says.find(" " + std::string(seed.recognised) + ": ") != std::string::npos) {
      ++described;
      continue;
    }
    // Accepts that an earlier check has named it.
    if (finding.mistake.empty() &&
        finding.says.starts_with(std::string(seed.recognised) + ", which is named"))
      continue;
    EXPECT_EQ(finding.mistake, seed.recognised)
        << seed.planted << " in " << seed.check << ": " << finding.says << readings;
  }
  EXPECT_LE(described, std::size(kSeeds) / 10);
}

TEST(Mistakes, EveryCheckIsSpoiltByOne) {
  std::set<std::string> spoilt;
  for (const Seed& seed : kSeeds) spoilt.insert(seed.check);
  for (const Chapter& chapter : chapters())
    for (const Check& check : chapter.checks) EXPECT_TRUE(spoilt.contains(check.name)) << check.name;
}

}  // namespace
}  // namespace plumb::course
