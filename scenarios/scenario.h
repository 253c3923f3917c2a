#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"
#include "reference/backend.h"

namespace plumb::scenarios {

/// Upper bounds for each metric of a run, in SI units; NaN if none is stated.
struct Bounds {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double position = kNone;          ///< m, largest over bodies and time
  double angle = kNone;             ///< rad
  double velocity = kNone;          ///< m/s, away from impacts
  double angular_velocity = kNone;  ///< rad/s, away from impacts
  double energy = kNone;            ///< relative to the largest energy in the run
  double momentum = kNone;          ///< relative to the sum of the bodies' |m v|
  double angular_momentum = kNone;  ///< relative to the sum of the bodies' |angular momentum|
  double joint_gap = kNone;         ///< m
  double penetration = kNone;       ///< m
};

/// How exact motion is known.
enum class TruthKind {
  ClosedForm,   ///< a formula, or formulas joined at events
  Integrated,   ///< equations of motion in coordinates of their own, solved to about 15 digits
  Equilibrium,  ///< nothing moves, by statics
};

/// Exact motion, computed by no engine.
struct Truth {
  /// Source: the formula's name and its origin.
  std::string source;

  /// Computes the exact state of every body at `time`.
  std::function<void(double time, std::span<BodyState> out)> exact{};

  /// Computes the exact result of `scheme` after `steps` steps of `substep`; returns false if it is unknown.
  std::function<bool(reference::Scheme scheme, double substep, long steps, std::span<BodyState> out)>
      discrete{};

  /// Times at which the exact velocities jump, s.
  std::vector<double> impacts{};

  /// True if contacts last: bodies push and rub each other between impacts.
  bool contacts_last = false;

  TruthKind kind = TruthKind::ClosedForm;
};

/// Quantities that the scene's physics conserves.
struct Conserved {
  bool energy = false;
  bool momentum_x = false;
  bool momentum_y = false;
  bool angular_momentum = false;  ///< about the origin
};

/// A statement about a run with a tolerance of its own, from a case file.
struct Expectation {
  /// Quantities that every run measures, held from the start to the end.
  enum class Law { None, Energy, Momentum, AngularMomentum, Joints, NoOverlap };

  /// Distance of a state from the expected one, and its limit; in the unit of the quantity.
  struct Miss {
    double value = 0, tolerance = 0;
  };

  std::string name;  ///< of the check: "ball.x"
  Law law = Law::None;
  double tolerance = 0;  ///< of a law: relative for what is conserved, m for gaps and overlaps

  /// Without a law: computes the miss at `time`.
  std::function<Miss(double time, std::span<const BodyState> states)> miss{};
  std::vector<double> times{};  ///< s, in order; empty: every sample from `from` to `until`
  double from = 0, until = std::numeric_limits<double>::infinity();  ///< s
};

/// One scene with its answer and the bounds expected of engines.
struct Problem {
  Scene scene;
  double duration = 1;  ///< s
  Truth truth{};
  Conserved conserved{};

  /// Error bounds promised for engines with a tolerance, at 1e-9.
  Bounds precise{};

  /// For second-order engines: C in error <= C h^2 + rounding, h the substep. 0: exact up to rounding.
  /// Unstated bounds are derived from the truth's own motion, as for first-order engines.
  Bounds second_order{};

  /// Expectations of a case file. They replace the bounds derived from the method.
  std::vector<Expectation> expected{};

  /// Engines whose misses are failures; empty: all.
  std::vector<std::string> must_pass{};
};

/// A family of problems: one file, registered nowhere else.
struct Scenario {
  std::string name;
  std::string summary;
  std::vector<std::string> variants{""};  ///< named cases; one empty name if there is only one
  std::vector<int> sizes{1};              ///< run by default; any size >= 1 is allowed if `scales`
  bool scales = false;
  std::function<Problem(std::string_view variant, int size)> build;
};

/// One member of a family: "elastic_collision/oblique", "pendulum_chain[20]".
struct Instance {
  const Scenario* scenario = nullptr;
  std::string variant;
  int size = 1;

  std::string label() const;
  Problem build() const { return scenario->build(variant, size); }
};

/// Returns every scenario, sorted by name.
const std::vector<Scenario>& all();

/// Returns the members that `name` selects: a scenario's variants and sizes, or one of them ("name/variant",
/// "name[size]"). `size` > 0 overrides the sizes. Throws `Error` (Name, Value) that suggests the nearest
/// name.
std::vector<Instance> select(std::string_view name, int size = 0);

/// Adds a scenario: `static const Register r{{.name = ..., .build = ...}};`
struct Register {
  explicit Register(Scenario scenario);
};

}  // namespace plumb::scenarios
