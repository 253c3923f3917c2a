#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/hunt/case.h"
#include "harness/hunt/motion.h"

namespace plumb::harness::hunt {

/// Objection of a judge to a run.
struct Objection {
  std::string law{};    ///< the law or relation that was broken
  std::string judge{};  ///< the same as `law`; for an expectation, its name
  std::string what{};   ///< the violation, in one line: "energy has grown"
  std::string right{};  ///< the correct behaviour, in one line
  double figure = 0, bound = 0;
  std::string unit{};
  double time = 0;        ///< s, of its first detection
  std::string subject{};  ///< a body, joint or pair; may be empty
};

using Verdict = std::optional<Objection>;

/// A law that a motion alone is checked against.
struct Law {
  std::string name{};
  Verdict (*judge)(const Case& one, const Engine& engine, const Motion& motion);
};

/// Returns the laws in the order of evaluation; a run is reported for the first that objects.
const std::vector<Law>& laws();

// The laws. docs/hunting.md gives the source of each bound.
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
Verdict cost_law(const Case& one, const Engine& engine, const Motion& motion);

}  // namespace plumb::harness::hunt
