#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "engine/realtime/contact_finder.h"
#include "engine/realtime/stages.h"
#include "engine/realtime/substeps.h"

namespace plumb {
namespace {

/// Properties of contacts that may occur.
struct Touching {
  bool any = false, friction = false, restitution = false;
};

/// Key of shapes that `PairRules` treats alike, apart from body and joints.
using Likeness = std::tuple<std::uint32_t, std::uint32_t, std::int32_t, double, double, bool>;

/// Tests pairs of kinds of shapes, and for each kind pairs of shapes until one may touch.
Touching find_touching(const Scene& scene) {
  const PairRules rules(scene);
  std::map<Likeness, std::vector<int>> kinds;
  for (int i = 0; i < rules.shape_count(); ++i) {
    const Shape& shape = rules.shape(i);
    kinds[{shape.filter.category, shape.filter.mask, shape.filter.group, shape.friction, shape.restitution,
           rules.dynamic(rules.body_of(i))}]
        .push_back(i);
  }
  const auto one_touches = [&](const std::vector<int>& of,
                               const std::vector<int>& with) -> std::optional<PairKey> {
    for (const int a : of)
      for (const int b : with)
        if (rules.may_touch(a, b)) return pair_key(a, b);
    return std::nullopt;
  };
  Touching out;
  for (auto of = kinds.begin(); of != kinds.end(); ++of) {
    for (auto with = of; with != kinds.end(); ++with) {
      const int a = of->second.front(), b = with->second.front();
      const bool friction = rules.friction(a, b) > 0, restitution = rules.restitution(a, b) > 0;
      const bool dynamic = std::get<5>(of->first) || std::get<5>(with->first);
      const bool news = !out.any || (friction && !out.friction) || (restitution && !out.restitution);
      if (!news || !dynamic || !may_touch(rules.shape(a).filter, rules.shape(b).filter)) continue;
      if (!one_touches(of->second, with->second)) continue;
      out = {true, out.friction || friction, out.restitution || restitution};
    }
  }
  return out;
}

bool turns(const Body& body) {
  return body.type == BodyType::Kinematic || (body.type == BodyType::Dynamic && !body.fixed_rotation);
}

/// Returns the reason why a body rotates or may do so; empty when none can.
std::string why_it_turns(const Scene& scene, bool touching) {
  bool any_free = false;
  for (const Body& body : scene.bodies) {
    if (turns(body) && body.angular_velocity != 0) return "body '" + body.name + "' spins";
    any_free = any_free || (body.type == BodyType::Dynamic && !body.fixed_rotation);
  }
  if (!any_free) return "";
  if (touching) return "contacts can turn bodies";
  if (!scene.joints.empty()) return "joints can turn bodies";
  for (const ForceLaw& law : scene.forces)
    if (!std::holds_alternative<LinearDrag>(law) && !std::holds_alternative<QuadraticDrag>(law))
      return "a force law turns bodies";
  return "";
}

std::string count(std::size_t number, std::string_view what) {
  return std::to_string(number) + " " + std::string(what) + (number == 1 ? "" : "s");
}

}  // namespace

Plan plan_realtime(const Scene& scene, const Realtime& accuracy, bool every_stage) {
  const Touching touching = find_touching(scene);
  const std::string turning = why_it_turns(scene, touching.any);
  const bool joints = !scene.joints.empty(), forces = !scene.forces.empty();
  const bool two_passes = accuracy.integrator == Integrator::VelocityVerlet;
  const std::string no_pair = "no two shapes can touch", no_joint = "no joints";
  const std::string once = "this integrator solves velocities once a substep";
  const std::string some_pair = "shapes of different bodies can touch";

  Plan plan;
  plan.driver = "realtime<" + std::string(name_of(accuracy.precision)) + ">";
  const SubstepPlan substeps = plan_substeps(scene, accuracy, touching.any);
  plan.substeps = static_cast<int>(std::min(substeps.count, double{kMostSubsteps}));
  plan.substeps_why = substeps.why;
  const auto add = [&](RealtimeStage stage, std::string name, bool needed, std::string why) {
    plan.stages.resize(static_cast<std::size_t>(stage) + 1);
    if (!needed && every_stage) why += "; runs all the same, as every stage was asked for";
    plan.stages.back() = {std::move(name), std::move(why), needed || every_stage, 0};
  };
  add(RealtimeStage::BroadPhase, "broad_phase", touching.any, touching.any ? some_pair : no_pair);
  add(RealtimeStage::NarrowPhase, "narrow_phase", touching.any, touching.any ? some_pair : no_pair);
  add(RealtimeStage::Forces, "forces", forces,
      forces ? count(scene.forces.size(), "force law") : "no force laws: gravity alone is constant");
  add(RealtimeStage::Kick, "kick", true, "velocities follow from accelerations");
  add(RealtimeStage::Restitution, "restitution", touching.restitution,
      touching.restitution ? "shapes that can touch bounce"
      : touching.any       ? "no pair that can touch bounces"
                           : no_pair);
  add(RealtimeStage::ContactHold, "contact_hold", touching.any, touching.any ? some_pair : no_pair);
  add(RealtimeStage::JointHold, "joint_hold", joints,
      joints ? count(scene.joints.size(), "joint") : no_joint);
  add(RealtimeStage::Drift, "drift", true, "positions follow from velocities");
  add(RealtimeStage::Turn, "turn", !turning.empty(), turning.empty() ? "nothing can turn a body" : turning);
  add(RealtimeStage::PushOut, "push_out", touching.any, touching.any ? some_pair : no_pair);
  add(RealtimeStage::JointRelax, "joint_relax", joints && two_passes,
      !joints      ? no_joint
      : two_passes ? "velocities must fit the joints where the bodies arrived"
                   : once);
  add(RealtimeStage::ContactRelax, "contact_relax", touching.any && two_passes,
      !touching.any ? no_pair
      : two_passes  ? "velocities must fit the contacts where the bodies arrived"
                    : once);
  add(RealtimeStage::Friction, "friction", touching.friction,
      touching.friction ? "shapes that can touch have friction"
      : touching.any    ? "no pair that can touch has friction"
                        : no_pair);
  add(RealtimeStage::Check, "check", true, "no state that is not finite leaves the engine");
  add(RealtimeStage::Watch, "watch", two_passes,
      two_passes ? "no gap, overlap or loss of energy beyond what is promised goes unsaid"
                 : "this integrator promises nothing");
  return plan;
}

}  // namespace plumb
