// A Scene's mechanisms as Bullet's articulated bodies, one for each tree of hinges attached to the world. The
// coordinates are the hinges' angles.
#include "reference/bullet/multibody.h"

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/text.h"
#include "engine/math/trigonometry.h"
#include "reference/support/applied_forces.h"
#include "reference/support/mechanism.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

struct MultibodySettings {
  int substeps = 1;
  double substep = 0;  ///< s
  bool fourth_order = true;
};

btVector3 to_bullet(Vec2d v) { return {static_cast<btScalar>(v.x), static_cast<btScalar>(v.y), 0}; }

/// Tree and index of a link in Bullet.
struct Place {
  std::size_t tree = 0;
  int index = 0;
};

class MultibodySimulator final : public Simulator {
 public:
  MultibodySimulator(const Scene& scene, const MultibodySettings& settings)
      : scene_(scene),
        settings_(settings),
        links_(links_of(scene_)),
        places_(links_.size()),
        states_(links_.size()),
        link_of_(scene_.bodies.size(), -1),
        forces_(scene_) {
    world_.setGravity(to_bullet(scene_.gravity));
    std::size_t end = 0;
    for (std::size_t root = 0; root < links_.size(); root = end) {
      end = root + 1;
      while (end < links_.size() && links_[end].parent >= 0) ++end;
      add_tree(root, end);
    }
    for (std::size_t i = 0; i < links_.size(); ++i) link_of_[links_[i].body] = static_cast<int>(i);
  }

  ~MultibodySimulator() override {
    for (const auto& tree : trees_) world_.removeMultiBody(tree.get());
  }

  double advance(int steps) override {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < steps * settings_.substeps; ++i) {
      apply_forces();
      world_.stepSimulation(static_cast<btScalar>(settings_.substep), 0);
      ++substeps_done_;
    }
    return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
  }

  double time() const override { return static_cast<double>(substeps_done_) * settings_.substep; }

  void read(std::span<BodyState> out) const override {
    find_states();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) out[i] = state_of(i);
  }

 private:
  /// Adds the links [root, end), which form a tree of their own.
  void add_tree(std::size_t root, std::size_t end) {
    constexpr bool kFixedBase = true, kCanSleep = false, kApart = true;
    auto tree = std::make_unique<btMultiBody>(static_cast<int>(end - root), btScalar(0), btVector3(0, 0, 0),
                                              kFixedBase, kCanSleep);
    tree->setBasePos({0, 0, 0});
    tree->setHasSelfCollision(false);
    tree->setLinearDamping(0);
    tree->setAngularDamping(0);
    tree->setMaxCoordinateVelocity(std::numeric_limits<btScalar>::max());
    tree->useRK4Integration(settings_.fourth_order);
    for (std::size_t i = root; i < end; ++i) {
      const Link& link = links_[i];
      const Body& body = scene_.bodies[link.body];
      const auto inertia = static_cast<btScalar>(inertia_of(body));
      const int index = static_cast<int>(i - root),
                parent = link.parent < 0 ? -1 : link.parent - static_cast<int>(root);
      tree->setupRevolute(index, static_cast<btScalar>(body.mass), {inertia, inertia, inertia}, parent,
                          btQuaternion::getIdentity(), {0, 0, 1}, to_bullet(link.parent_anchor),
                          to_bullet(-link.anchor), kApart);
      places_[i] = {trees_.size(), index};
    }
    tree->finalizeMultiDof();
    for (std::size_t i = root; i < end; ++i) {
      tree->setJointPos(static_cast<int>(i - root), static_cast<btScalar>(links_[i].angle));
      tree->setJointVel(static_cast<int>(i - root), static_cast<btScalar>(links_[i].angle_speed));
    }
    world_.addMultiBody(tree.get());
    trees_.push_back(std::move(tree));
  }

  /// Forward kinematics: angles add up along a tree, and count whole turns.
  void find_states() const {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      const Link& link = links_[i];
      const btMultiBody& tree = *trees_[places_[i].tree];
      BodyState& state = states_[i];
      state = {.angle = static_cast<double>(tree.getJointPos(places_[i].index)),
               .angular_velocity = static_cast<double>(tree.getJointVel(places_[i].index))};
      Vec2d hinge = link.parent_anchor, velocity{};
      if (link.parent >= 0) {
        const BodyState& parent = states_[static_cast<std::size_t>(link.parent)];
        state.angle += parent.angle;
        state.angular_velocity += parent.angular_velocity;
        const Vec2d arm = rotation_of(parent.angle) * link.parent_anchor;
        hinge = parent.position + arm;
        velocity = parent.velocity + cross(parent.angular_velocity, arm);
      }
      const Vec2d arm = rotation_of(state.angle) * link.anchor;
      state.position = hinge - arm;
      state.velocity = velocity - cross(state.angular_velocity, arm);
    }
  }

  /// Returns the state of a body of the scene. Call `find_states` first.
  BodyState state_of(std::size_t body) const {
    if (link_of_[body] >= 0) return states_[static_cast<std::size_t>(link_of_[body])];
    BodyState state = initial_state(scene_.bodies[body]);
    state.position += time() * state.velocity;
    state.angle += time() * state.angular_velocity;
    return state;
  }

  // Evaluates forces at the step's start and keeps them constant during the step; Bullet's stages do not
  // evaluate them again.
  void apply_forces() {
    if (forces_.empty()) return;
    find_states();
    const double start = time(), end = static_cast<double>(substeps_done_ + 1) * settings_.substep;
    forces_.apply(
        start, end, [&](std::size_t body) { return state_of(body); },
        [&](std::size_t body, const Wrench<double>& wrench) {
          if (link_of_[body] < 0) return;
          const Place& place = places_[static_cast<std::size_t>(link_of_[body])];
          btMultiBody& tree = *trees_[place.tree];
          tree.addLinkForce(place.index, to_bullet(wrench.force));
          tree.addLinkTorque(place.index, {0, 0, static_cast<btScalar>(wrench.torque)});
        });
  }

  Scene scene_;
  MultibodySettings settings_;
  std::vector<Link> links_;
  std::vector<Place> places_;              // by link
  mutable std::vector<BodyState> states_;  // by link, as of the last `find_states`
  std::vector<int> link_of_;               // by body of the scene, or -1
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btMultiBody>> trees_;
  AppliedForces forces_;
  std::int64_t substeps_done_ = 0;
};

class MultibodyBackend final : public Backend {
 public:
  MultibodyBackend(std::string_view name, std::string_view summary) : name_(name), summary_(summary) {}

  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return summary_; }

  Identity identity() const override {
    const int version = btGetVersion();  // 324: 3.24
    return {.version = std::to_string(version / 100) + "." + std::to_string(version % 100),
            .precision = sizeof(btScalar) == sizeof(float) ? "float" : "double"};
  }

  std::vector<Option> options() const override {
    return {{"integrator", "rk4", "rk4 or euler (semi-implicit)"}};
  }
  std::vector<Knob> knobs() const override { return {{"integrator", {"euler", "rk4"}, false}}; }

  Method method(const StepSettings& settings) const override {
    const MultibodySettings chosen = read_settings(settings);
    return {.scheme = chosen.fourth_order ? Scheme::RungeKutta4 : Scheme::SemiImplicitEuler,
            .order = chosen.fourth_order ? 4 : 1,
            .substep = chosen.substep,
            .epsilon = static_cast<double>(std::numeric_limits<btScalar>::epsilon())};
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    const MultibodySettings chosen = read_settings(settings);
    if (std::string reason = not_a_mechanism(scene); !reason.empty()) return reason;
    for (const Link& link : links_of(scene)) {
      if (!link.hinged)
        return "body " + plumb::quoted(scene.bodies[link.body].name) +
               " is not held by hinges: 'bullet-double' moves free bodies";
    }
    if (chosen.fourth_order && !scene.forces.empty())
      return "forces are constant within a step, so the method is not of fourth order; use --set "
             "integrator=euler";
    return out_of_range(scene, sizeof(btScalar) == sizeof(float) ? kFloatRange : kDoubleRange);
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const MultibodySettings chosen = read_settings(settings);
    Settings out{{"dt", shortest(settings.dt)},
                 {"substeps", std::to_string(chosen.substeps)},
                 {"integrator", chosen.fourth_order ? "rk4" : "euler"},
                 {"joints", "coordinates: hinges by their angle (Featherstone)"},
                 {"contacts", "off; scenes in which shapes may touch are rejected"},
                 {"forces", "at the start of each substep"},
                 {"linear_damping", "0"},
                 {"angular_damping", "0"},
                 {"sleeping", "off"},
                 {"inertia", "the scene's"},
                 {"filters", "the scene's"},
                 {"linear_slop", "0 m"},
                 {"continuous", "off"},
                 {"max_rotation", "none"},
                 {"precision", sizeof(btScalar) == sizeof(float) ? "float" : "double"}};
    append_contact_rules(out, scene);
    return out;
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return std::make_unique<MultibodySimulator>(scene, read_settings(settings));
  }

 private:
  MultibodySettings read_settings(const StepSettings& settings) const {
    check_steps(name_, settings, Stepping::Fixed);
    const OptionReader given(name_, settings, options());
    MultibodySettings out;
    out.substeps = settings.substeps.value_or(1);
    out.substep = settings.dt / out.substeps;
    out.fourth_order = given.choice<bool>("integrator", {{"rk4", true}, {"euler", false}});
    return out;
  }

  std::string_view name_, summary_;
};

}  // namespace

std::unique_ptr<Backend> make_bullet_multibody_backend(std::string_view name, std::string_view summary) {
  return std::make_unique<MultibodyBackend>(name, summary);
}

}  // namespace plumb::reference
