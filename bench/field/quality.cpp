#include "bench/field/quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "bench/field/gap.h"
#include "bench/field/neighbours.h"

namespace plumb::field {
namespace {

/// A placed shape of the world.
struct Entry {
  int body = 0;
  const ShapeDefinition* definition = nullptr;
  PlacedShape placed;
};

Bounds bounds_of(const PlacedShape& shape, double margin) {
  Bounds out{shape.core.front(), shape.core.front()};
  for (const Vec2d p : shape.core) {
    out.low = {std::min(out.low.x, p.x), std::min(out.low.y, p.y)};
    out.high = {std::max(out.high.x, p.x), std::max(out.high.y, p.y)};
  }
  const Vec2d grown{shape.radius + margin, shape.radius + margin};
  return {out.low - grown, out.high + grown};
}

Vec2d to_world(const BodyState& state, Vec2d point) {
  return state.position + Rotation<double>{std::cos(state.angle), std::sin(state.angle)} * point;
}

bool all_finite(const Inventory& inventory, std::span<const BodyState> states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!inventory.bodies[i].alive) continue;
    const BodyState& s = states[i];
    for (const double value : {s.position.x, s.position.y, s.angle, s.velocity.x, s.velocity.y, s.spin})
      if (!std::isfinite(value)) return false;
  }
  return true;
}

/// Returns the pairs of bodies whose joint keeps them from colliding.
std::set<std::pair<int, int>> joined_pairs(const Inventory& inventory) {
  std::set<std::pair<int, int>> out;
  for (const JointRecord& joint : inventory.joints)
    if (joint.alive && !joint.definition.collide) out.insert(std::minmax(joint.a, joint.b));
  return out;
}

void measure_overlaps(const Inventory& inventory, std::span<const BodyState> states, Quality& out) {
  std::vector<Entry> entries;
  std::vector<Bounds> boxes;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (!inventory.bodies[i].alive) continue;
    for (const ShapeDefinition& shape : inventory.bodies[i].shapes) {
      entries.push_back({static_cast<int>(i), &shape, place(shape.geometry, states[i])});
      boxes.push_back(bounds_of(entries.back().placed, kNear / 2));
    }
  }
  const auto joined = joined_pairs(inventory);
  for_each_meeting(boxes, [&](int i, int j) {
    const Entry &a = entries[i], &b = entries[j];
    if (a.body == b.body || !may_touch(*a.definition, *b.definition)) return;
    if (inventory.bodies[a.body].definition.type != BodyType::Dynamic &&
        inventory.bodies[b.body].definition.type != BodyType::Dynamic)
      return;
    if (!joined.empty() && joined.contains(std::minmax(a.body, b.body))) return;
    const double distance = gap(a.placed, b.placed);
    if (distance < kNear) ++out.near;
    if (distance >= -kTouch) return;
    ++out.overlapping;
    out.deepest = std::max(out.deepest, -distance);
    out.mean_depth -= distance;
  });
  if (out.overlapping > 0) out.mean_depth /= out.overlapping;
}

void measure_joints(const Inventory& inventory, std::span<const BodyState> states, Quality& out) {
  int count = 0;
  for (const JointRecord& joint : inventory.joints) {
    if (!joint.alive) continue;
    const RevoluteDefinition& definition = joint.definition;
    const BodyState &a = states[joint.a], &b = states[joint.b];
    const double error =
        std::sqrt(length_squared(to_world(b, definition.anchor_b) - to_world(a, definition.anchor_a)));
    out.worst_joint = std::max(out.worst_joint, error);
    out.mean_joint += error;
    ++count;
    if (!definition.limits) continue;
    // Engines may normalise angles by whole turns.
    const double angle = std::remainder(b.angle - a.angle - definition.reference_angle, 2 * std::numbers::pi);
    out.worst_limit =
        std::max({out.worst_limit, definition.limits->lower - angle, angle - definition.limits->upper});
  }
  if (count > 0) out.mean_joint /= count;
}

}  // namespace

bool may_touch(const ShapeDefinition& a, const ShapeDefinition& b) {
  if (a.group != 0 && a.group == b.group) return false;
  return (a.mask & b.category) != 0 && (b.mask & a.category) != 0;
}

Quality measure_quality(const Inventory& inventory, std::span<const BodyState> states) {
  Quality out;
  out.finite = all_finite(inventory, states);
  if (!out.finite) return out;
  measure_overlaps(inventory, states, out);
  measure_joints(inventory, states, out);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const MassProperties& mass = inventory.bodies[i].mass;
    out.kinetic_energy += mass.mass * length_squared(states[i].velocity) / 2 +
                          mass.inertia * states[i].spin * states[i].spin / 2;
  }
  return out;
}

Speed measure_speed(const Inventory& inventory, std::span<const BodyState> before,
                    std::span<const BodyState> after, double dt) {
  Speed out;
  int count = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const BodyRecord& body = inventory.bodies[i];
    if (!body.alive || body.definition.type != BodyType::Dynamic) continue;
    const Vec2d moved = to_world(after[i], body.mass.centre) - to_world(before[i], body.mass.centre);
    const double square = length_squared(moved) / (dt * dt);
    out.max = std::max(out.max, std::sqrt(square));
    out.rms += square;
    ++count;
  }
  if (count > 0) out.rms = std::sqrt(out.rms / count);
  return out;
}

}  // namespace plumb::field
