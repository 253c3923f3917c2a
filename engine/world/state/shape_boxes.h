#pragma once

#include <algorithm>

#include "engine/world/state/constants.h"
#include "engine/world/world_data.h"

/// Tight and fat AABBs of shapes, and their proxies in the trees.
namespace plumb {

/// Returns the tight AABB of a shape at its body's present pose.
template <class Real>
Aabb<Real> tight_aabb(const WorldData<Real>& w, int shape);

/// Returns the tight AABB of a shape after the last step. For shapes in the trees, a step stores it; for a
/// shape that collides with nothing it is computed.
template <class Real>
Aabb<Real> current_aabb(const WorldData<Real>& w, int shape) {
  return w.shapes[shape].proxy == kNone ? tight_aabb(w, shape) : w.boxes[shape];
}

/// Returns the fat AABB of a shape: with a margin and the predicted motion of the next steps.
template <class Real>
Aabb<Real> fat_aabb(const WorldData<Real>& w, int shape, Real dt);

/// Updates a shape's AABBs to its body's current pose, after a motion whose rotation moved no point of the
/// shape by more than `turned`, m. Returns true if its fat AABB contained the whole motion.
template <class Real>
bool update_proxy(WorldData<Real>& w, int shape, Real dt, Real turned);

/// Returns the AABB swept by a displacement `way`.
template <class Real>
Aabb<Real> stretched(Aabb<Real> box, Vec2<Real> way) {
  box.lower.x += std::min(way.x, Real(0)), box.lower.y += std::min(way.y, Real(0));
  box.upper.x += std::max(way.x, Real(0)), box.upper.y += std::max(way.y, Real(0));
  return box;
}

/// Returns the AABB of a shape for the next step, in which its body moves by `way` and rotates such that no
/// point of it moves by more than `turned`, m. Rotations of more than a radian are not predicted: the AABB is
/// then that of the current angle.
template <class Real>
Aabb<Real> room_ahead(const Aabb<Real>& box, Vec2<Real> way, Real turned, Real extent) {
  return stretched(box, way).grown(turned <= extent ? turned : Real(0));
}

/// Stores a fat AABB of a shape in a tree (or its PrefetchedEnlarging), and adds the shape to the move
/// buffer.
template <class Real, class Tree>
void store_fat_aabb(WorldData<Real>& w, int shape, const Aabb<Real>& box, Tree& tree) {
  ShapeRecord<Real>& record = w.shapes[shape];
  if (!record.moved) append(w.move_buffer, shape);
  record.moved = true;
  tree.enlarge(record.proxy, box);
  w.enlarged[record.body] = 1;
}

/// Returns the AABB of a fast shape through the next step, so that it does not leave its fat AABB in a step.
/// Shapes that rotate too fast are not predicted.
template <class Real>
Aabb<Real> box_ahead(const WorldData<Real>& w, int shape, Real dt, Real turned) {
  const Aabb<Real>& box = w.boxes[shape];
  if (turned > Real(0.5 * tuning::kBoxMargin) * w.forms[shape].extent) return box;
  const Vec2<Real> ahead = dt * w.motion[w.shapes[shape].body].velocity;
  return merged(box, {box.lower + ahead, box.upper + ahead}).grown(turned);
}

/// Does the same as `update_proxy`, but leaves the tree to the caller: calls `enlarge(shape, fat AABB)` if
/// the shape has left its stored fat AABB.
template <class Real, class Enlarge>
bool update_boxes(WorldData<Real>& w, int shape, Real dt, Real turned, const Enlarge& enlarge) {
  if (w.shapes[shape].proxy == kNone) return true;
  const Aabb<Real> before = w.boxes[shape];
  w.boxes[shape] = tight_aabb(w, shape);
  const ShapeRecord<Real>& record = w.shapes[shape];
  const Aabb<Real>& stored = w.tree_of(w.bodies[record.body].type).box(record.proxy);
  const bool covered = stored.contains(merged(before, w.boxes[shape]).grown(turned));
  if (!stored.contains(box_ahead(w, shape, dt, turned))) enlarge(shape, fat_aabb(w, shape, dt));
  return covered;
}

}  // namespace plumb
