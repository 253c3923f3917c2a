// Bullet's capabilities, options and effective settings. Compiled twice: with btScalar = float and = double.
#include "reference/bullet/backend.h"

#include <LinearMath/btTransformUtil.h>

#include <limits>
#include <string>

#include "engine/core/text.h"
#include "engine/scene/features.h"
#include "reference/bullet/simulator.h"
#include "reference/support/range.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

constexpr bool kFloat = sizeof(btScalar) == sizeof(float);

class BulletBackend final : public Backend {
 public:
  BulletBackend(std::string_view name, std::string_view summary) : name_(name), summary_(summary) {}

  std::string_view name() const override { return name_; }
  std::string_view summary() const override { return summary_; }

  Identity identity() const override {
    const int version = btGetVersion();  // 324: 3.24
    return {.version = std::to_string(version / 100) + "." + std::to_string(version % 100),
            .precision = kFloat ? "float" : "double"};
  }

  std::vector<Option> options() const override {
    return {{"iterations", "10", "iterations per substep"},
            {"joint_erp", "0.2", "fraction of a joint's gap that a substep corrects"},
            {"contact_erp", "0.2", "fraction of a penetration that a substep corrects"},
            {"speculative", "off", "on or off: speculative contacts, which may suppress restitution"}};
  }

  std::vector<Knob> knobs() const override {
    return {{"iterations", {"1", "2", "5", "10", "20", "50", "100", "200"}},
            {"joint_erp", {"0.1", "0.2", "0.4", "0.8"}}};
  }

  Method method(const StepSettings& settings) const override {
    return {.scheme = Scheme::SemiImplicitEuler,
            .order = 1,
            .substep = read_settings(settings).substep,
            .epsilon = static_cast<double>(std::numeric_limits<btScalar>::epsilon())};
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    read_settings(settings);
    if (const std::string rule = unusual_rule(scene); !rule.empty())
      return rule + ", which Bullet does not have; 'plumb-precise' runs it";
    if (const std::string feature = unusual_feature(scene); !feature.empty())
      return feature + ", which this adapter does not translate; 'plumb' runs it";
    for (const Joint& joint : scene.joints) {
      const std::string reason = std::visit([&](const auto& j) { return ignored(scene, j); }, joint);
      if (!reason.empty()) return reason;
    }
    return out_of_range(scene, kFloat ? kFloatRange : kDoubleRange);
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    const BulletSettings chosen = read_settings(settings);
    Settings out{{"dt", shortest(settings.dt)},
                 {"substeps", std::to_string(chosen.substeps)},
                 {"iterations", std::to_string(chosen.iterations)},
                 {"joint_erp", shortest(chosen.joint_erp)},
                 {"contact_erp", shortest(chosen.contact_erp)},
                 {"speculative", chosen.speculative ? "on" : "off"},
                 {"split_impulse", "on, for any penetration"},
                 {"warm_starting", "contacts 0.85, joints none"},
                 {"sleeping", "off"},
                 {"linear_damping", "0"},
                 {"angular_damping", "0"},
                 {"gyroscopic_force", "off"},
                 {"inertia", "the scene's"},
                 {"filters", "the scene's"}};
    append_contact_rules(out, scene);
    out.insert(out.end(),
               {{"forces", "at the start of each substep"},
                {"plane", "linear factor (1, 1, 0), angular factor (0, 0, 1)"},
                {"shapes", "circles as spheres, boxes as 2D boxes"},
                {"revolute", "point to point"},
                {"distance", "one exact row, added to Bullet"},
                {"margin", "0 m"},
                {"linear_slop", "0 m"},
                {"contact_breaking_threshold", "0.02 of a shape's size"},
                {"continuous", "off"},
                {"max_rotation", shortest(static_cast<double>(ANGULAR_MOTION_THRESHOLD)) + " rad a substep"},
                {"precision", kFloat ? "float" : "double"}});
    return out;
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    return make_bullet_simulator(scene, read_settings(settings));
  }

 private:
  /// Returns the reason if Bullet would ignore `joint`, otherwise an empty text. Bullet's solver skips rows
  /// whose J M^-1 J^T is below its epsilon, as between heavy bodies.
  template <class SceneJoint>
  static std::string ignored(const Scene& scene, const SceneJoint& joint) {
    double inverse_mass = 0;
    for (const std::string& name : {joint.body_a, joint.body_b}) {
      const auto index = find_body(scene, name);
      if (!index || scene.bodies[*index].type != BodyType::Dynamic) continue;
      inverse_mass += 1 / scene.bodies[*index].mass;
    }
    const double least = static_cast<double>(SIMD_EPSILON);
    if (inverse_mass > 2 * least) return "";
    return "joint " + plumb::quoted(joint.name) +
           ": its bodies are too heavy; Bullet ignores joints of more than " + shortest(1 / (2 * least)) +
           " kg";
  }

  BulletSettings read_settings(const StepSettings& settings) const {
    check_steps(name_, settings, Stepping::Fixed);
    const OptionReader given(name_, settings, options());
    BulletSettings out;
    out.substeps = settings.substeps.value_or(1);
    out.substep = settings.dt / out.substeps;
    out.iterations = given.integer("iterations", 1);
    out.joint_erp = given.number("joint_erp", 0);
    out.contact_erp = given.number("contact_erp", 0);
    out.speculative = given.toggle("speculative");
    // The double build also skips steps below its roundoff, but that limit is far smaller.
    if (kFloat) require_float_step(name_, out.substep);
    return out;
  }

  std::string_view name_, summary_;
};

}  // namespace

std::unique_ptr<Backend> make_bullet_backend(std::string_view name, std::string_view summary) {
  return std::make_unique<BulletBackend>(name, summary);
}

}  // namespace plumb::reference
