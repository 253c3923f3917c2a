#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/math/vec2.h"

/// Measured motions of real bodies. They are not part of plumb: docs/reality.md describes them, names their
/// authors and says where to get them.
namespace plumb::harness::reality {

/// One impact of an ellipse on a floor, by motion capture. SI units, y up, angles counter-clockwise.
struct MeasuredImpact {
  Vec2d velocity{}, velocity_after{};                       ///< m/s, of the centre
  double angular_velocity = 0, angular_velocity_after = 0;  ///< rad/s
  double lever_normal = 0;   ///< m: the contact's rate perpendicular to the floor is v.y + lever_normal w
  double lever_tangent = 0;  ///< m: its slip along the floor is v.x + lever_tangent w
  double place = 0;          ///< m, position of the contact along the floor
  bool doubted = false;      ///< true: marked as doubtful in the data
};

/// One frame of a body in motion.
struct MeasuredPose {
  Vec2d position{};  ///< m, of the centre
  double angle = 0;  ///< rad, whole turns counted
};

/// One drop of a square, frame after frame.
struct MeasuredDrop {
  int number = 0;
  std::vector<MeasuredPose> frames{};
};

inline constexpr double kFramesPerSecond = 250;
/// Steps in which engines are run, s: one frame, and a quarter of it.
inline constexpr std::array<double, 2> kSteps{1 / kFramesPerSecond, 1 / (4 * kFramesPerSecond)};
inline constexpr const char* kImpactFile = "ellipse_impacts.csv";
inline constexpr const char* kDropFile = "square_drops.csv";

/// Returns the first of the two files that is not in `folder`; empty if both are there.
std::string missing_file(const std::string& folder);

/// Reads one of the files. Throws `Error` (Io; Syntax with the line for a missing column or a field that is
/// not a number; Value for a file without rows).
std::vector<MeasuredImpact> read_impacts(const std::string& path);
std::vector<MeasuredDrop> read_drops(const std::string& path);

}  // namespace plumb::harness::reality
