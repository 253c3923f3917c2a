#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

/// Scenes that nobody thought of, judged without an answer sheet.
namespace plumb::harness::hunt {

enum class ActionKind : std::uint8_t {
  Create,        ///< a body of the scene that is not there before
  Destroy,       ///< a body
  CreateJoint,   ///< a joint of the scene that is not there before
  DestroyJoint,  ///< a joint
  Teleport,      ///< a body to `position` and `angle`
  Push,          ///< a body: its velocity becomes `position` per second, its angular velocity `angle`
  SetType,       ///< of a body
  SetFilter,     ///< of all shapes of a body: they meet nothing, or everything
  DestroyShape,  ///< the last shape of a body
  Sleep,         ///< a body with its island
};
inline constexpr std::string_view kActionNames[] = {
    "create", "destroy",  "create_joint", "destroy_joint", "teleport",
    "push",   "set_type", "set_filter",   "destroy_shape", "sleep"};

/// Something that is done to a world before a step.
struct Action {
  ActionKind kind = ActionKind::Destroy;
  int step = 0;        ///< before which it happens; 0: before the first
  std::string target;  ///< the name of a body or joint
  Vec2d position{};
  double angle = 0;
  BodyType type = BodyType::Static;
  bool touches = false;  ///< of a filter
};

enum class Quantity : std::uint8_t {
  X,
  Y,
  Angle,
  VelocityX,
  VelocityY,
  AngularVelocity,
  Drift,  ///< m, the distance from where the body was at `from`
};
inline constexpr std::string_view kQuantityNames[] = {
    "x", "y", "angle", "velocity_x", "velocity_y", "angular_velocity", "drift"};

/// Among an expectation's needs: that masses and inertias are those that it was composed with.
inline constexpr std::string_view kMasses = "masses";

/// What the one who composed a scene knows of its motion.
struct Expectation {
  std::string name;  ///< "keeps its speed"
  std::string body;
  Quantity quantity = Quantity::X;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double from = 0;                                      ///< s
  double to = std::numeric_limits<double>::infinity();  ///< s
  std::vector<std::string> needs{};       ///< bodies or joints without which it is not owed; or `kMasses`
  std::map<std::string, double> until{};  ///< s: bodies without which it is owed only until then
  std::string why{};                      ///< one line that says what is right
};

/// One scene with all that a run of it takes.
struct Case {
  std::uint64_t seed = 0, index = 0;
  std::vector<std::string> idioms{};  ///< that it was composed of
  Scene scene{};
  double dt = 1.0 / 60;  ///< s
  int substeps = 4;
  int steps = 120;
  bool sleeping = false;               ///< of a World
  std::vector<std::string> sensors{};  ///< bodies whose shapes are sensors
  std::vector<Action> actions{};       ///< in the order of their steps
  std::vector<Expectation> expectations{};

  /// Whether only a World can run it.
  bool world_only() const { return !actions.empty() || !sensors.empty(); }
};

/// The case as JSON, which reads back to the same bits.
std::string to_json(const Case& one, int indent = 2);

/// Throws `Error` for what is no case.
Case case_from_json(std::string_view text);

}  // namespace plumb::harness::hunt
