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
  return w.shapes[shape].proxy == kNone ? tight_aabb(w, shape) : w.tight_aabbs[shape];
}

/// Returns the fat AABB of a shape: with a margin and the predicted motion of the next steps.
template <class Real>
Aabb<Real> fat_aabb(const WorldData<Real>& w, int shape, Real dt);

/// Updates a shape's AABBs to its body's current pose, after a motion whose rotation moved no point of the
/// shape by more than `rotation_distance`, m. Returns true if its fat AABB contained the whole motion.
template <class Real>
bool update_proxy(WorldData<Real>& w, int shape, Real dt, Real rotation_distance);

/// Returns the AABB that covers `box` during a displacement.
template <class Real>
Aabb<Real> swept_aabb(Aabb<Real> box, Vec2<Real> displacement) {
  box.lower.x += std::min(displacement.x, Real(0)), box.lower.y += std::min(displacement.y, Real(0));
  box.upper.x += std::max(displacement.x, Real(0)), box.upper.y += std::max(displacement.y, Real(0));
  return box;
}

/// Returns the AABB of a shape for the next step, in which its body moves by `displacement` and rotates such
/// that no point of it moves by more than `rotation_distance`, m. Rotations of more than a radian are not
/// predicted: the AABB is then that of the current angle.
template <class Real>
Aabb<Real> predicted_aabb(const Aabb<Real>& box, Vec2<Real> displacement, Real rotation_distance,
                          Real extent) {
  return swept_aabb(box, displacement).grown(rotation_distance <= extent ? rotation_distance : Real(0));
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
Aabb<Real> next_step_aabb(const WorldData<Real>& w, int shape, Real dt, Real rotation_distance) {
  const Aabb<Real>& box = w.tight_aabbs[shape];
  if (rotation_distance > Real(0.5 * tuning::kAabbMargin) * w.forms[shape].extent) return box;
  const Vec2<Real> ahead = dt * w.motion[w.shapes[shape].body].velocity;
  return merged(box, {box.lower + ahead, box.upper + ahead}).grown(rotation_distance);
}

/// Does the same as `update_proxy`, but leaves the tree to the caller: calls `enlarge(shape, fat AABB)` if
/// the shape has left its stored fat AABB.
template <class Real, class Enlarge>
bool update_aabbs(WorldData<Real>& w, int shape, Real dt, Real rotation_distance, const Enlarge& enlarge) {
  if (w.shapes[shape].proxy == kNone) return true;
  const Aabb<Real> before = w.tight_aabbs[shape];
  w.tight_aabbs[shape] = tight_aabb(w, shape);
  const ShapeRecord<Real>& record = w.shapes[shape];
  const Aabb<Real>& stored = w.tree_of(w.bodies[record.body].type).box(record.proxy);
  const bool covered = stored.contains(merged(before, w.tight_aabbs[shape]).grown(rotation_distance));
  if (!stored.contains(next_step_aabb(w, shape, dt, rotation_distance)))
    enlarge(shape, fat_aabb(w, shape, dt));
  return covered;
}

}  // namespace plumb
