#include "tests/fuzz/support/world_checks.h"

#include <cmath>
#include <string>

#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "engine/world/snapshot_check.h"
#include "engine/world/world_data.h"
#include "tests/fuzz/support/require.h"

namespace plumb::fuzz {
namespace {

constexpr double kFastest = 1e5;  // m/s, rad/s: a thousand times what everyday runs begin with

bool is_finite(const BodyState& state) {
  return std::isfinite(state.position.x) && std::isfinite(state.position.y) && std::isfinite(state.angle) &&
         std::isfinite(state.velocity.x) && std::isfinite(state.velocity.y) &&
         std::isfinite(state.angular_velocity);
}

template <class Real>
void check_counts(const BasicWorld<Real>& world) {
  const WorldCounts counts = world.counts();
  int bodies = 0, awake = 0, shapes = 0, ends = 0;
  for (const BodyId body : world.bodies()) {
    require(world.valid(body), "handles of bodies that are there are valid");
    ++bodies;
    if (world.awake(body)) ++awake;
    for (const ShapeId shape : world.shapes(body)) {
      require(world.valid(shape) && world.body(shape) == body, "a shape knows its body");
      ++shapes;
    }
    for (const JointId joint : world.joints(body)) {
      require(world.valid(joint), "handles of joints that are there are valid");
      const auto [a, b] = world.bodies(joint);
      require(a == body || b == body, "a joint knows its bodies");
      ++ends;
    }
    require(is_finite(world.state(body)), "states are finite");
  }
  require(bodies == counts.bodies && awake == counts.awake && shapes == counts.shapes &&
              ends == 2 * counts.joints && counts.touching <= counts.contacts,
          "the counts are those of what is there");
}

// Describes a body that went wrong.
template <class Real>
std::string story_of(const BasicWorld<Real>& world, BodyId body) {
  const BodyState state = world.state(body);
  std::string out = "body " + std::to_string(body.index) + " of " + shortest(world.mass(body)) + " kg, " +
                    shortest(world.inertia(body)) + " kg m^2 at " + shortest(state.velocity.x) + ", " +
                    shortest(state.velocity.y) + " m/s, " + shortest(state.angular_velocity) + " rad/s by " +
                    name_of(world.solver()) + " in step " + std::to_string(world.step_count()) + ", " +
                    std::to_string(world.contacts(body).size()) + " contacts, joints of kinds";
  for (const JointId joint : world.joints(body)) out += " " + std::to_string(world.kind(joint).index());
  return out;
}

}  // namespace

template <class Real>
void check_world(const BasicWorld<Real>& world) {
  try {
    check_state(world.data());
  } catch (const Error& error) {
    fail("the world's lists fit together", error.what());
  }
  check_counts(world);
}

template <class Real>
StepCheck<Real>::StepCheck(const BasicWorld<Real>& before) {
  for (const BodyId body : before.bodies()) {
    const BodyLocks locks = before.locks(body);
    const bool fixed = before.type(body) == BodyType::Static;
    const bool dynamic = before.type(body) == BodyType::Dynamic;
    held_.push_back(
        {body, before.state(body), fixed || (dynamic && locks.x), fixed || (dynamic && locks.y), fixed});
  }
}

template <class Real>
void StepCheck<Real>::check(const BasicWorld<Real>& after, bool everyday) const {
  for (const QuarantineEvent& event : after.events().quarantined) {
    // One that went bad before the step may be gone since.
    require(!after.valid(event.body) || after.quarantined(event.body), "what is told to be in quarantine is");
    if (everyday)
      fail("an everyday world has nothing that goes bad", kBadFieldNames[static_cast<int>(event.field)]);
  }
  for (const Held& held : held_) {
    require(after.valid(held.body), "a step takes no body away");
    const BodyState now = after.state(held.body);
    const auto stays = [&](bool is_held, double then, double there, const char* what) {
      if (!is_held || then == there) return;
      const std::string solver = name_of(after.solver()), change = shortest(then) + " -> " + shortest(there);
      fail(what, (change + " by " + solver).c_str());
    };
    stays(held.x, held.state.position.x, now.position.x, "a locked x stays");
    stays(held.y, held.state.position.y, now.position.y, "a locked y stays");
    stays(held.rotation, held.state.angle, now.angle, "a fixed angle stays");
    const double speed = std::sqrt(length_squared(now.velocity));
    if (everyday && !(speed < kFastest && std::abs(now.angular_velocity) < kFastest))
      fail("speeds stay within what a game sees", story_of(after, held.body).c_str());
  }
}

template void check_world(const BasicWorld<float>&);
template void check_world(const BasicWorld<double>&);
template class StepCheck<float>;
template class StepCheck<double>;

}  // namespace plumb::fuzz
