#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/driver/accuracy.h"
#include "engine/driver/sensitivity.h"
#include "engine/driver/snapshot.h"
#include "engine/integrate/compensated.h"
#include "engine/precise/events/contacts.h"
#include "engine/precise/sensitivity/scene_model.h"
#include "engine/precise/sensitivity/variation.h"
#include "engine/scene/scene.h"

namespace plumb::precise {

/// Forward sensitivities S = dy/dp of a run of `Precise`, computed beside it. Between events they obey the
/// variational equations
///     dS/dt = f_y S + f_p,
/// with f the laws of motion with the contact modes of that time. They are integrated together with the
/// state. At an event, where a guard g(t, y, p) is zero, the time of the event moves by
///     t' = -(g_y S + g_p) / (g_t + g_y f-).
/// With the impact R(t, y, p), or the identity where only modes change,
///     S+ = R_y (S- + f- t') + R_t t' + R_p - f+ t'     (the saltation matrix; Aizerman and Gantmakher 1958).
/// All derivatives of f, g and R are fourth-order differences along a direction. The functions are those of
/// the engine itself, with modes, features and order of impacts frozen, so they are smooth, and the
/// differences never cross an event. Hence any number of a scene may be a parameter, and every law of the
/// engine has sensitivities. The bits of the run itself do not change.
class Sensitivities {
 public:
  /// `scene` has the laws from which the `variations` differ.
  Sensitivities(const Scene& scene, std::vector<Variation> variations, const Precise& precise);

  std::size_t size() const { return names_.size(); }
  double time() const { return now_.time; }

  /// Continues from a state that was set from outside: `given` before its joints were closed, `closed` after
  /// that.
  void start(double time, const Compensated& given, const Compensated& closed);
  /// Continues to `time` without an event; `y` is the run's state there.
  void advance(double time, const Compensated& y);
  /// Handles the event of the last step. `before` and `after` are the run's states, `contacts` are its
  /// contacts.
  void pass_event(const Compensated& before, const Compensated& after, const Contacts& contacts);
  /// Switches forces that change at `time`.
  void switch_forces(double time);
  /// Handles a state of a body that was set from outside: it no longer depends on parameters. `slot` is that
  /// of an integrated body.
  void write(std::size_t body, std::optional<std::size_t> slot, double time, const BodyState& state);
  /// Ends all derivatives.
  void fail_all(NoDerivative reason, double time);

  /// Returns d state / d parameter at `time`, which is not before the last `advance`, by body of the scene,
  /// in units of the state over the parameter's. Throws `NotDifferentiable`. Changes no derivatives.
  std::vector<BodyState> at(std::size_t parameter, double time, std::size_t bodies);

  /// Throws `NotDifferentiable` with the recorded reason why the derivative ended, or else with `reason` and
  /// `time`, s.
  [[noreturn]] void throw_not_differentiable(std::size_t parameter, NoDerivative reason, double time) const;

  void save(SnapshotWriter& out) const;
  /// `contacts` are the run's, restored.
  void restore(SnapshotReader& in, const Contacts& contacts);

 private:
  using Values = std::vector<double>;
  struct Failure {
    NoDerivative reason{};
    double time = 0;
  };
  /// The state and its derivatives by each parameter.
  struct Present {
    double time = 0;  // s
    Values y;
    std::vector<Values> by;  // by parameter
  };
  /// A function of a scene's laws, the time and the state; fills its last argument.
  using Function = std::function<void(SceneModel&, double, std::span<const double>, std::span<double>)>;
  /// A time and a state at which functions are derived.
  struct Point {
    double time = 0;  // s
    std::span<const double> y;
  };
  /// A direction in time and state along which a function is derived.
  struct Direction {
    double time = 0;
    std::span<const double> state;
  };
  class VariationalFlow;

  bool is_valid(std::size_t parameter) const { return !failures_[parameter]; }
  void fail(std::size_t parameter, NoDerivative reason);
  Point present() const { return {now_.time, now_.y}; }
  double differentiate_state(const Function& function, const Point& from, const Direction& along,
                             std::span<double> out, double step = Variation::kStep);
  void differentiate_parameter(std::size_t parameter, const Function& function, const Point& from,
                               std::span<double> out);
  bool differentiate(std::size_t parameter, const Function& function, const Direction& along,
                     std::span<const double> scale, std::span<double> out);
  double norm(std::span<const double> direction) const;
  std::vector<std::size_t> integrate(Present& present, std::span<const std::size_t> parameters, double end);
  void set_windows(double time);
  /// A guard that has a zero at the present state, and its rate along the motion.
  struct Zero {
    Contacts::Guard guard;
    double rate = 0;
  };
  double propagate(std::size_t parameter, const Contacts::Record& record, std::span<const double> before_rate,
                   const std::optional<Contacts::Guard>& guard, double guard_rate,
                   std::span<const Zero> others);
  std::vector<Zero> coincident_zeros(const Contacts::Guard& guard, std::span<const double> rate);
  bool grazes(const Contacts& contacts, const Contacts::Guard& guard, std::span<const double> rate,
              double& guard_rate);
  std::optional<Contacts::Guard> guard_of(const Contacts::Record& record) const;
  bool opens_initial_contacts(std::size_t parameter, const Contacts::Record& record);
  void stop_slips(std::size_t parameter);
  template <class Change>
  void for_each_model(const Change& change);

  const double tolerance_;
  std::vector<std::string> names_;
  std::vector<double> steps_;        // by parameter, in its unit
  std::vector<char> initial_only_;   // by parameter
  std::unique_ptr<SceneModel> own_;  // of the scene itself
  std::vector<std::array<std::unique_ptr<SceneModel>, Variation::kOffsets.size()>>
      perturbed_;          // by parameter
  Values scale_;           // by component of y: m, rad, m/s, rad/s
  double time_scale_ = 1;  // s, the scene's length over its speed
  Present now_;
  bool started_ = false;  // `start` was called after the last event
  std::vector<std::optional<Failure>> failures_;
  std::vector<Values> values_;  // of a function, one for each place of a difference
  Values at_, middle_, part_;
};

}  // namespace plumb::precise
