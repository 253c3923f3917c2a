#include "engine/precise/plan.h"

#include <algorithm>
#include <string>
#include <variant>

#include "engine/precise/dynamics/joints.h"

namespace plumb::precise {
namespace {

std::string count(std::size_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

}  // namespace

Plan plan_of(const Scene& scene, const ScenePartition& partition, bool every_stage) {
  const std::size_t bodies = scene.bodies.size();
  const std::size_t laws = static_cast<std::size_t>(
      std::count_if(scene.forces.begin(), scene.forces.end(), [&](const ForceLaw& law) {
        const auto ends = ends_of(law);
        return std::any_of(ends.begin(), ends.end(), [&](std::string_view name) {
          const auto body = find_body(scene, name);
          return body && std::binary_search(partition.integrated.begin(), partition.integrated.end(), *body);
        });
      }));
  const std::string some =
      std::to_string(partition.integrated.size()) + " of " + count(bodies, "body", "bodies");
  const bool integrates = !partition.integrated.empty(), joints = !scene.joints.empty(),
             contacts = !partition.shapes.empty();

  Plan plan{"precise", std::vector<Stage>(kStageCount)};
  const auto stage = [&](StageIndex index, const char* name, bool active, const std::string& why,
                         const std::string& why_not) {
    plan.stages[index] = {name, active ? why : why_not, active || every_stage, 0};
  };
  stage(
      kContacts, "contacts", contacts,
      "shapes that meet get Newton's restitution and Coulomb's friction; contacts that last are constraints",
      "no shapes may touch");
  const bool springs = GeneralJoints(scene).has_springs();
  std::string forces = laws > 0 ? count(laws, "force law", "force laws") + " on integrated bodies" : "";
  if (springs) forces += (laws > 0 ? ", and " : "") + std::string("springs of joints");
  stage(kForces, "forces", laws > 0 || springs, forces, "no force depends on the motion");
  stage(kJointAccelerations, "joint_accelerations", joints,
        count(scene.joints.size(), "joint is", "joints are") + " held by accelerations, solved directly",
        "no joints");
  stage(kRungeKutta, "runge_kutta", integrates,
        some + " under joints, forces that are not constant, or with shapes that may touch",
        "every body is in free flight under constant forces");
  stage(kProjection, "projection", joints, "closes joints to rounding after each step", "no joints");
  stage(kPolynomialFlight, "polynomial_flight", !partition.ballistic.empty(),
        std::to_string(partition.ballistic.size()) + " of " + count(bodies, "body", "bodies") +
            " at rest or under constant forces: evaluated, not integrated",
        "no body is in free flight");
  stage(kContactSearch, "contact_search", contacts,
        count(partition.shapes.size(), "shape", "shapes") + " may touch: events are located in time",
        "no shapes may touch");
  return plan;
}

}  // namespace plumb::precise
