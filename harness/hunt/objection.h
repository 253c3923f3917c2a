#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/hunt/case.h"
#include "harness/hunt/motion.h"

namespace plumb::harness::hunt {

/// A judge's sentence about a run.
struct Objection {
  std::string law{};    ///< that was broken: one of `laws()`, or the symmetries
  std::string judge{};  ///< the same, but for an expectation its name
  std::string what{};   ///< one line that says what is wrong: "energy has grown"
  std::string right{};  ///< one line that says what is right
  double figure = 0, bound = 0;
  std::string unit{};
  double time = 0;        ///< s, when it was first seen
  std::string subject{};  ///< a body, joint or pair; may be empty
};

using Verdict = std::optional<Objection>;

/// A law that a motion is held against, alone.
struct Law {
  std::string name{};
  Verdict (*judge)(const Case& one, const Engine& engine, const Motion& motion);
};

/// In the order in which they are asked: the first that objects speaks for the run.
const std::vector<Law>& laws();

// The laws. docs/hunting.md says where each bound comes from.
Verdict finite_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict energy_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict momentum_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict angular_momentum_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict joint_gap_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict joint_angle_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict penetration_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict expectation_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict event_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict sensor_law(const Case& one, const Engine& engine, const Motion& motion);
Verdict sleep_law(const Case& one, const Engine& engine, const Motion& motion);

}  // namespace plumb::harness::hunt
