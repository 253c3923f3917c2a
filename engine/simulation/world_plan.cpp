#include "engine/simulation/world_plan.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/world/profile.h"

namespace plumb {
namespace {

using BodyPair = std::pair<std::size_t, std::size_t>;

/// Returns the pairs of bodies that a joint keeps from colliding.
std::set<BodyPair> joined_bodies(const Scene& scene) {
  std::map<std::string_view, std::size_t> index;
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) index.emplace(scene.bodies[body].name, body);
  std::set<BodyPair> pairs;
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          const auto a = index.find(j.body_a), b = index.find(j.body_b);
          if (!j.collide && a != index.end() && b != index.end())
            pairs.insert(std::minmax(a->second, b->second));
        },
        joint);
  }
  return pairs;
}

/// Returns true if two shapes of different bodies may touch. Shapes with the same filter form a kind: for
/// each pair of kinds that may touch, tries pairs of bodies until one is not excluded by a joint.
bool may_touch_anywhere(const Scene& scene) {
  using Kind = std::tuple<std::uint64_t, std::uint64_t, std::int32_t>;
  std::map<Kind, std::vector<std::size_t>> kinds;  // bodies
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    for (const Shape& shape : scene.bodies[body].shapes) {
      std::vector<std::size_t>& of = kinds[{shape.filter.category, shape.filter.mask, shape.filter.group}];
      if (of.empty() || of.back() != body) of.push_back(body);
    }
  }
  const std::set<BodyPair> joined = joined_bodies(scene);
  const auto dynamic = [&](std::size_t body) { return scene.bodies[body].type == BodyType::Dynamic; };
  const auto filter_of = [](const Kind& kind) {
    return Filter{.category = std::get<0>(kind), .mask = std::get<1>(kind), .group = std::get<2>(kind)};
  };
  for (auto one = kinds.begin(); one != kinds.end(); ++one) {
    for (auto other = one; other != kinds.end(); ++other) {
      if (!may_touch(filter_of(one->first), filter_of(other->first))) continue;
      for (const std::size_t a : one->second) {
        for (const std::size_t b : other->second) {
          if (a != b && (dynamic(a) || dynamic(b)) && !joined.contains(std::minmax(a, b))) return true;
        }
      }
    }
  }
  return false;
}

std::string count(std::size_t number, std::string_view thing) {
  return std::to_string(number) + " " + std::string(thing) + (number == 1 ? "" : "s");
}

}  // namespace

Plan plan_world(const Scene& scene, const Realtime& accuracy, bool every_stage) {
  const bool touching = may_touch_anywhere(scene), forces = !scene.forces.empty();
  const bool monitored = accuracy.on_violation != OnViolation::Ignore;
  const bool breaks = std::ranges::any_of(scene.joints, [](const Joint& joint) {
    return std::visit([](const auto& j) { return j.break_force > 0 || j.break_torque > 0; }, joint);
  });
  const std::string pair = touching ? "shapes of different bodies may touch" : "no two shapes can touch";
  const std::string joints = scene.joints.empty() ? "no joints" : count(scene.joints.size(), "joint");

  Plan plan;
  plan.driver = "world<" + std::string(name_of(accuracy.precision)) + ">";
  plan.substeps = accuracy.substeps;
  plan.substeps_why = "as asked for";
  const auto add = [&](std::string name, bool needed, std::string why) {
    if (!needed && every_stage) why += "; runs all the same, as every stage was asked for";
    plan.stages.push_back({std::move(name), std::move(why), needed || every_stage, 0});
  };
  const auto world = [&](WorldStage stage, bool needed, std::string why) {
    add(kWorldStageNames[static_cast<std::size_t>(stage)], needed, std::move(why));
  };
  add("forces", forces,
      forces ? count(scene.forces.size(), "force law") + ", evaluated in each substep"
             : "no force laws: gravity alone is constant");
  world(WorldStage::BroadPhase, touching, pair);
  world(WorldStage::NarrowPhase, touching, pair);
  world(WorldStage::Solver, true, "velocities follow from forces; " + joints + "; " + pair);
  world(WorldStage::Finalize, true, "positions follow from velocities");
  world(WorldStage::Continuous, touching && accuracy.continuous,
        touching && !accuracy.continuous ? "switched off" : pair);
  world(WorldStage::Events, touching || breaks, breaks ? "joints may break" : pair);
  world(WorldStage::Sleep, accuracy.sleeping, accuracy.sleeping ? "asked for" : "not asked for");
  add("monitor", monitored,
      monitored ? "asked for: gaps, overlaps and energy are checked after each step" : "not asked for");
  return plan;
}

bool needs_shapes(const Plan& plan) {
  const auto runs = [&](WorldStage stage) {
    return plan.stages[kFirstWorldStage + static_cast<std::size_t>(stage)].active;
  };
  return runs(WorldStage::BroadPhase) || runs(WorldStage::Sleep);
}

}  // namespace plumb
