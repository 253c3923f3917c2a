#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"

/// Random scenes, judged without a known answer.
namespace plumb::harness::hunt {

enum class ActionKind : std::uint8_t {
  Create,        ///< creates a body of the scene, which is absent until then
  Destroy,       ///< a body
  CreateJoint,   ///< creates a joint of the scene, which is absent until then
  DestroyJoint,  ///< a joint
  Teleport,      ///< moves a body to `position` and `angle`
  Push,          ///< a body: its velocity becomes `position` per second, its angular velocity `angle`
  SetType,       ///< of a body
  SetFilter,     ///< changes all shapes of a body: they collide with nothing, or with everything
  DestroyShape,  ///< the last shape of a body
  Sleep,         ///< a body with its island
};
inline constexpr std::string_view kActionNames[] = {
    "create", "destroy",  "create_joint", "destroy_joint", "teleport",
    "push",   "set_type", "set_filter",   "destroy_shape", "sleep"};

/// An action on a world before a step.
struct Action {
  ActionKind kind = ActionKind::Destroy;
  int step = 0;        ///< step before which it happens; 0: the first
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
  Drift,  ///< m, the distance from the body's position at `from`
};
inline constexpr std::string_view kQuantityNames[] = {
    "x", "y", "angle", "velocity_x", "velocity_y", "angular_velocity", "drift"};

/// Special value of `needs`: the expectation requires the composed masses and inertias.
inline constexpr std::string_view kMasses = "masses";

/// Property of the motion that is known from a scene's composition.
struct Expectation {
  std::string name;  ///< "keeps its speed"
  std::string body;
  Quantity quantity = Quantity::X;
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double from = 0;                                      ///< s
  double to = std::numeric_limits<double>::infinity();  ///< s
  std::vector<std::string> needs{};       ///< bodies or joints required for the expectation; or `kMasses`
  std::map<std::string, double> until{};  ///< s: without these bodies it applies only until then
  std::string why{};                      ///< the expected behaviour, in one line
};

/// One scene with everything needed to run it.
struct Case {
  std::uint64_t seed = 0, index = 0;
  std::vector<std::string> idioms{};  ///< idioms that it was composed of
  Scene scene{};
  double dt = 1.0 / 60;  ///< s
  int substeps = 4;
  int steps = 120;
  bool sleeping = false;               ///< of a World
  std::vector<std::string> sensors{};  ///< bodies whose shapes are sensors
  std::vector<Action> actions{};       ///< in the order of their steps
  std::vector<Expectation> expectations{};
  std::string case_file{};  ///< the case file whose expectations hold while the scene is unchanged

  /// Returns true if only a World can run it.
  bool world_only() const { return !actions.empty() || !sensors.empty(); }
};

/// Converts the case to JSON, which reads back to the same bits.
std::string to_json(const Case& one, int indent = 2);

/// Throws `Error` if `text` is not a case.
Case case_from_json(std::string_view text);

}  // namespace plumb::harness::hunt
