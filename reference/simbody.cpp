//! cmake: include(simbody/library.cmake)
//! link: plumb_simbody
//! guest: yes
//! missing: Simbody was not found; install libsimbody-dev and build again

// Simbody in double, for mechanisms: trees of hinges become joint angles, integrated to a tolerance. Contacts
// are left to other engines: Simbody's are compliant.
#include <chrono>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "reference/backend.h"
#include "reference/guests.h"
#include "reference/simbody/tree.h"
#include "reference/support/applied_forces.h"
#include "reference/support/mechanism.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

constexpr double kPromised = 1e-9, kOutOfTheBox = 1e-3;  // Simbody's own accuracy

class SimbodySimulator final : public Simulator {
 public:
  SimbodySimulator(const Scene& scene, double dt, double tolerance)
      : scene_(scene), dt_(dt), links_(links_of(scene_)), laws_(scene_), states_(scene.bodies.size()) {
    for (std::size_t i = 0; i < states_.size(); ++i) states_[i] = initial_state(scene_.bodies[i]);
    std::vector<simbody::TreeLink> tree;
    for (const Link& link : links_) tree.push_back(to_simbody(link));
    tree_ = std::make_unique<simbody::Tree>(
        std::move(tree),
        [this](double time, const std::vector<simbody::TreeState>& states,
               std::vector<simbody::TreeWrench>& out) { push(time, states, out); },
        tolerance);
  }

  double advance(int steps) override {
    const auto begin = std::chrono::steady_clock::now();
    try {
      for (int i = 0; i < steps; ++i) tree_->advance(static_cast<double>(++done_) * dt_);
    } catch (const std::runtime_error& error) {
      throw Error(Error::Kind::Run, "engine 'simbody'", "", "", printable(error.what(), 400));
    }
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
  }

  double time() const override { return static_cast<double>(done_) * dt_; }

  void read(std::span<BodyState> out) const override {
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = coasting(i, time());
    const std::vector<simbody::TreeState> states = tree_->states();
    for (std::size_t i = 0; i < links_.size(); ++i) out[links_[i].body] = from_simbody(states[i]);
  }

 private:
  static BodyState from_simbody(const simbody::TreeState& s) {
    return {.position = {s.x, s.y}, .angle = s.angle, .velocity = {s.vx, s.vy}, .angular_velocity = s.w};
  }

  simbody::TreeLink to_simbody(const Link& link) const {
    const Body& body = scene_.bodies[link.body];
    simbody::TreeLink out;
    out.parent = link.parent;
    out.hinged = link.hinged;
    out.mass = body.mass;
    out.inertia = inertia_of(body);
    if (link.hinged) {
      out.q[0] = link.angle;
      out.u[0] = link.angle_speed;
      const Vec2d anchors[] = {link.parent_anchor, link.anchor};
      double* const to[] = {out.parent_anchor, out.anchor};
      for (int k = 0; k < 2; ++k) to[k][0] = anchors[k].x, to[k][1] = anchors[k].y;
    } else {
      const double q[] = {body.angle, body.position.x, body.position.y};
      const double u[] = {body.angular_velocity, body.velocity.x, body.velocity.y};
      for (int c = 0; c < 3; ++c) out.q[c] = q[c], out.u[c] = u[c];
    }
    return out;
  }

  // Returns the state of a body that no force moves.
  BodyState coasting(std::size_t i, double time) const {
    BodyState state = initial_state(scene_.bodies[i]);
    state.position += time * state.velocity;
    state.angle += time * state.angular_velocity;
    return state;
  }

  // Adds gravity with each body's scale, and the scene's laws.
  void push(double time, const std::vector<simbody::TreeState>& states,
            std::vector<simbody::TreeWrench>& out) {
    std::vector<std::size_t> link_of(scene_.bodies.size(), links_.size());
    for (std::size_t i = 0; i < states_.size(); ++i) states_[i] = coasting(i, time);
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Body& body = scene_.bodies[links_[i].body];
      states_[links_[i].body] = from_simbody(states[i]);
      link_of[links_[i].body] = i;
      const Vec2d weight = body.mass * body.gravity_scale * scene_.gravity;
      out[i] = {weight.x, weight.y, 0};
    }
    laws_.apply_at(
        time, time, time, [&](std::size_t body) { return states_[body]; },
        [&](std::size_t body, const Wrench<double>& wrench) {
          if (link_of[body] == links_.size()) return;
          simbody::TreeWrench& sum = out[link_of[body]];
          sum = {sum.fx + wrench.force.x, sum.fy + wrench.force.y, sum.torque + wrench.torque};
        });
  }

  Scene scene_;
  double dt_;
  std::vector<Link> links_;
  AppliedForces laws_;
  std::vector<BodyState> states_;  // by body, while forces are evaluated
  std::unique_ptr<simbody::Tree> tree_;
  std::int64_t done_ = 0;
};

class SimbodyBackend final : public Backend {
 public:
  explicit SimbodyBackend(bool equalised) : equalised_(equalised) {}

  std::string_view name() const override { return equalised_ ? "simbody" : "simbody-default"; }
  std::string_view summary() const override {
    return equalised_ ? "Simbody: mechanisms in joint angles, to a tolerance of 1e-9"
                      : "Simbody: mechanisms in joint angles, to its default accuracy of 1e-3";
  }
  Identity identity() const override {
    return {
        .version = PLUMB_SIMBODY_VERSION,
        .precision = "double",
        .guest = true,
        .limits = equalised_
                      ? "Simbody's tolerance is for the error of one step; the errors of all steps add up."
                      : "Simbody's default accuracy is 1e-3 for the error of one step; the errors of all "
                        "steps add up."};
  }

  Method method(const StepSettings& settings) const override {
    check_steps(name(), settings, Stepping::Adaptive);
    OptionReader(name(), settings, options());
    return {.scheme = Scheme::Adaptive,
            .order = 0,
            .substep = settings.dt,
            .epsilon = std::numeric_limits<double>::epsilon()};
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    method(settings);
    for (const Body& body : scene.bodies)
      if (body.lock_x || body.lock_y || body.linear_damping != 0 || body.angular_damping != 0)
        return "body " + plumb::quoted(body.name) + ": locked axes and damping are not mapped";
    if (links_of(scene).empty()) return "nothing moves by forces";
    if (std::string reason = not_a_mechanism(scene); !reason.empty()) return reason;
    return out_of_range(scene, kDoubleRange);
  }

  Settings effective_settings(const Scene&, const StepSettings& settings) const override {
    return {{"dt", shortest(settings.dt)},        {"tolerance", shortest(tolerance_of(settings))},
            {"integrator", "Runge-Kutta-Merson"}, {"coordinates", "joint angles"},
            {"forces", "at each stage"},          {"precision", "double"}};
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    try {
      return std::make_unique<SimbodySimulator>(scene, settings.dt, tolerance_of(settings));
    } catch (const std::runtime_error& error) {
      throw Error(Error::Kind::Run, "engine 'simbody'", "", "", printable(error.what(), 400));
    }
  }

 private:
  double tolerance_of(const StepSettings& settings) const {
    return settings.tolerance.value_or(equalised_ ? kPromised : kOutOfTheBox);
  }

  bool equalised_;
};

const GuestRegistration equalised{std::make_unique<SimbodyBackend>(true)};
const GuestRegistration out_of_the_box{std::make_unique<SimbodyBackend>(false)};

}  // namespace
}  // namespace plumb::reference
