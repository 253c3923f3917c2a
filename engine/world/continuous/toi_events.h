#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "engine/geometry/aabb.h"
#include "engine/world/continuous/impact_hook.h"
#include "engine/world/continuous/swept_boxes.h"
#include "engine/world/continuous/swept_pair.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"
#include "engine/world/step/step.h"

/// Finds the first impact of a swept body within the step. Only for continuous.cpp.
namespace plumb {

/// Tests if bodies move fast relative to one body. Stores the terms that do not depend on the other body.
template <class Real>
class RelativeMotionTest {
 public:
  RelativeMotionTest(const WorldData<Real>& w, int body)
      : w_(w),
        moved_(w.motion[body].delta_position),
        turned_(turned(body)),
        threshold_(Real(tuning::kFastFraction) * w.bodies[body].half_width) {}

  /// Returns true if two bodies move fast relative to each other, so that one could pass through the other.
  bool is_fast(int other) const {
    const Vec2<Real> relative = w_.motion[other].delta_position - moved_;
    return std::abs(relative.x) + std::abs(relative.y) + (turned_ + turned(other)) > threshold_;
  }
  /// Returns true if another body may be an obstacle: it is fast relative to this one, or its motion differs
  /// from the solver's.
  bool may_be_blocked_by(int other) const {
    if (is_fast(other)) return true;
    const SweptBody* other_swept = find_swept_body(w_, other);
    return other_swept != nullptr && other_swept->changed;
  }

 private:
  Real turned(int body) const { return std::abs(w_.motion[body].delta_angle) * w_.extents[body]; }

  const WorldData<Real>& w_;
  Vec2<Real> moved_;
  Real turned_, threshold_;
};

/// Returns the AABB of a body's motion until the step's end. An arc and its chord, passed at the same rate,
/// are at most arm angle^2 / 8 apart, and at most two arms.
template <class Real>
Aabb<Real> swept_aabb_of(const WorldData<Real>& w, const SweptBody& swept) {
  const Vec2<Real> start = swept.position_at(swept.from).template as<Real>(),
                   end = swept.position_at(1).template as<Real>();
  const double arc_deviation = length(swept.arm) * std::min(swept.delta_angle * swept.delta_angle / 8, 2.0);
  const Real deviation = static_cast<Real>(std::abs(swept.curve.x) + std::abs(swept.curve.y) + arc_deviation);
  return merged(Aabb<Real>{start, start}, Aabb<Real>{end, end}).grown(w.extents[swept.body] + deviation);
}

/// Returns the solver's constraint of a contact, or null if it had none.
template <class Real>
const ContactConstraint<Real>* constraint_in(const WorldData<Real>& w, const ContactRecord& contact) {
  if (contact.home != ContactHome::Graph) return nullptr;
  return &w.graph.at({contact.colour, contact.index});
}

template <class Real>
const ContactConstraint<Real>* constraint_between(const WorldData<Real>& w, int shape, int other) {
  const int body = w.shapes[shape].body, other_body = w.shapes[other].body;
  const ContactConstraint<Real>* found = nullptr;
  const auto is_theirs = [&](const ContactRecord& contact) {
    if ((contact.shape_a != shape || contact.shape_b != other) &&
        (contact.shape_a != other || contact.shape_b != shape))
      return false;
    found = constraint_in(w, contact);
    return true;
  };
  any_between(w.contacts, w.bodies[body].first_contact, w.bodies[other_body].first_contact, body, other_body,
              is_theirs);
  return found;
}

/// Replaces the first impact by a pair's impact if that is earlier.
template <class Real>
void update_earliest_impact(const WorldData<Real>& w, const SweptPath& path, const SweptPair<Real>& pair,
                            ToiEvent& first) {
  if (is_disabled_pair(w, pair.shape, pair.other)) return;
  if (path.swept.is_held && pair.contact != nullptr &&
      w.bodies[w.shapes[pair.other].body].type == BodyType::Kinematic)
    return;
  const double fraction = fraction_of_impact(w, path, pair);
  if (fraction < first.fraction)
    first.fraction = fraction, first.shape = pair.shape, first.other = pair.other;
}

/// Finds the first impact of a body whose obstacles all have a contact with it. Computes its path only if an
/// obstacle may be on it.
template <class Real>
void find_impact_in_contacts(const WorldData<Real>& w, const SweptBody& swept, double from,
                             ImpactSearch& search, ToiEvent& first) {
  const int body = swept.body;
  const RelativeMotionTest<Real> motion_test(w, body);
  const SweptAabbTest<Real> aabb_test(w, swept, search.dt);
  std::optional<SweptPath> path;
  for_each_edge(w.contacts, w.bodies[body].first_contact, [&](int edge, const ContactRecord& contact) {
    const bool is_a = (edge & 1) == 0;
    if (!swept.expected && !motion_test.may_be_blocked_by(is_a ? contact.body_b : contact.body_a)) return;
    const int shape = is_a ? contact.shape_a : contact.shape_b,
              other = is_a ? contact.shape_b : contact.shape_a;
    if (aabb_test.cannot_collide(shape, other)) return;
    if (!path) path.emplace(swept, from, search);
    update_earliest_impact(w, *path, {shape, other, constraint_in(w, contact), false, true}, first);
  });
}

/// Returns true if two bodies move as one: in the same group, pushed by the same kinematic body, or one by
/// the other.
template <class Real>
bool move_as_one(const WorldData<Real>& w, const SweptBody& swept, int other) {
  if (swept.pushed_by == kNone && swept.group == kNone) return false;
  if (swept.pushed_by == other) return true;
  const SweptBody* other_swept = find_swept_body(w, other);
  return other_swept != nullptr && other_swept->pushed_by == swept.pushed_by &&
         other_swept->group == swept.group;
}

/// Finds the first impact by queries of the trees, because there are no contacts along a path that an impact
/// has changed.
template <class Real>
void find_impact_in_trees(const WorldData<Real>& w, const SweptPath& path, ToiEvent& first) {
  const int body = path.swept.body;
  const bool as_solved = !path.swept.changed;
  const bool in_contact =
      as_solved || path.swept.group != kNone || (path.swept.lifts > 0 && path.swept.impacts == 0);
  const Aabb<Real> swept_aabb = swept_aabb_of(w, path.swept);
  const RelativeMotionTest<Real> motion_test(w, body);
  const SweptAabbTest<Real> aabb_test(w, path.swept, path.search.dt);
  for (int shape = w.bodies[body].first_shape; shape != kNone; shape = w.shapes[shape].next) {
    const std::uint32_t mask = effective_mask(w.shapes[shape].filter);
    if (w.forms[shape].sensor || mask == 0) continue;
    const auto visit = [&](int other, int) {
      const int other_body = w.shapes[other].body;
      if (!may_create_contact(w, shape, other) || move_as_one(w, path.swept, other_body)) return true;
      if (as_solved && !path.swept.expected && !motion_test.may_be_blocked_by(other_body)) return true;
      if (aabb_test.cannot_collide(shape, other)) return true;
      const auto* const contact = in_contact ? constraint_between(w, shape, other) : nullptr;
      update_earliest_impact(w, path, {shape, other, contact, false, true}, first);
      return true;
    };
    w.static_tree.query(swept_aabb, mask, visit);
    w.dynamic_tree.query(swept_aabb, mask, visit);
  }
}

/// Sets the version of the other body's motion.
template <class Real>
ToiEvent with_other_version(const WorldData<Real>& w, ToiEvent found) {
  if (found.other == kNone) return found;
  if (const SweptBody* other = find_swept_body(w, w.shapes[found.other].body))
    found.other_version = other->version;
  return found;
}

/// Returns the first impact of a swept body from a fraction of the step on.
template <class Real>
ToiEvent first_toi_event(const WorldData<Real>& w, int index, double from, ImpactSearch& search) {
  const SweptBody& swept = w.scratch.continuous.swept_bodies[index];
  ToiEvent first{.swept_body = index, .version = swept.version};
  if (!w.is_dynamic(swept.body)) return first;
  if (swept.covered && !swept.changed) {
    find_impact_in_contacts(w, swept, from, search, first);
  } else {
    find_impact_in_trees(w, SweptPath(swept, from, search), first);
  }
  return with_other_version(w, first);
}

}  // namespace plumb
