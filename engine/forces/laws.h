#pragma once

#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/forces/attraction_force.h"
#include "engine/forces/formula_force.h"
#include "engine/forces/formula_spring.h"
#include "engine/forces/linear_drag.h"
#include "engine/forces/point_force.h"
#include "engine/forces/quadratic_drag.h"
#include "engine/forces/sinusoidal_force.h"
#include "engine/forces/spring_force.h"
#include "engine/forces/torque.h"
#include "engine/forces/wrench.h"
#include "engine/joints/row.h"
#include "engine/scene/scene.h"

namespace plumb {

/// Returns the fraction of [t0, t1] inside [start, start + duration]: a force switched within a step still
/// gives its exact impulse. At an instant, t0 == t1, it is 1 from `start` until before the end, else 0.
double active_fraction(double start, double duration, double t0, double t1);

/// A scene's force laws by body index, one array per law. Each law's formula is in a file of its own.
class Forces {
 public:
  /// Takes the laws of a valid scene for which `wanted` is true: every law's bodies exist.
  explicit Forces(
      const Scene& scene, bool (*wanted)(const ForceLaw&) = [](const ForceLaw&) { return true; });

  bool empty() const;
  /// Returns true if any law acts on `body`.
  bool acts_on(std::size_t body) const;

  /// Adds every law's wrench to `out`: averaged over [t0, t1] where a law depends on time, at the given
  /// motion otherwise; formulas at the middle of [t0, t1]. Arrays are indexed by body. Gravity is not
  /// included.
  void add(double t0, double t1, const Pose<double>* poses, const Twist<double>* twists,
           Wrench<double>* out) const;

  /// Does the same at the instant `time` inside [t0, t1]: laws that change smoothly with time are evaluated
  /// there. For switched laws the active fraction of [t0, t1] counts; the caller ends [t0, t1] at the times
  /// of switching.
  void add_at(double time, double t0, double t1, const Pose<double>* poses, const Twist<double>* twists,
              Wrench<double>* out) const;

  /// Calls visit(formula, variables) for each formula of the laws.
  template <class Visit>
  void for_each_formula(double time, const Pose<double>* poses, const Twist<double>* twists,
                        const Visit& visit) const {
    for (const FormulaForceLaw& law : all<FormulaForceLaw>()) {
      const FormulaForceLaw::Variables now = law.variables(time, poses[law.body], twists[law.body]);
      for (const Formula* formula : {&law.x, &law.y, &law.torque})
        visit(*formula, std::span<const double>(now));
    }
    for (const FormulaSpringLaw& law : all<FormulaSpringLaw>()) {
      const auto end = [&](int body) {
        return body == kFixedFrame ? std::pair<Pose<double>, Twist<double>>{}
                                   : std::pair{poses[body], twists[body]};
      };
      const auto [pose_a, twist_a] = end(law.a);
      const auto [pose_b, twist_b] = end(law.b);
      const FormulaSpringLaw::Line line = law.line(pose_a, twist_a, pose_b, twist_b);
      const double now[] = {time, line.length, line.rate};
      visit(law.tension, std::span<const double>(now));
    }
  }

 private:
  void add_time_independent(const Pose<double>* poses, const Twist<double>* twists,
                            Wrench<double>* out) const;
  void add_switched(double t0, double t1, const Pose<double>* poses, const Twist<double>* twists,
                    Wrench<double>* out) const;
  void add_sinusoidal(double t0, double t1, const Pose<double>* poses, const Twist<double>* twists,
                      Wrench<double>* out) const;
  void add_formulas(double time, const Pose<double>* poses, const Twist<double>* twists,
                    Wrench<double>* out) const;

  template <class Law>
  const std::vector<Law>& all() const {
    return std::get<std::vector<Law>>(laws_);
  }

  std::tuple<std::vector<LinearDragLaw>, std::vector<QuadraticDragLaw>, std::vector<PointForceLaw>,
             std::vector<TorqueLaw>, std::vector<SpringForceLaw>, std::vector<AttractionForceLaw>,
             std::vector<SinusoidalForceLaw>, std::vector<FormulaForceLaw>, std::vector<FormulaSpringLaw>>
      laws_;
  std::vector<char> acts_on_;  // by body
};

}  // namespace plumb
