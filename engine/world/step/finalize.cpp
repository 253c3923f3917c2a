#include <algorithm>
#include <cmath>
#include <type_traits>

#include "engine/collision/broad_phase/prefetched_enlarging.h"
#include "engine/core/capacity.h"
#include "engine/geometry/convex_bounds.h"
#include "engine/math/trigonometry.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/prefetch_awake_bodies.h"
#include "engine/world/state/quarantine.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/state/sleeping.h"
#include "engine/world/step/step.h"

namespace plumb {
namespace {

// Steps after which a body's rotation is recomputed from its angle, because rounding accumulates in between.
constexpr int kRotationRefreshSteps = 256;

// Returns the Kahan compensation of positions (Kahan, 1965), in double only: 1e7 m from the origin, 600 steps
// would otherwise lose 1e-6 m. In float the steps themselves are coarser than that.
template <class Real>
Vec2d* position_compensation_of(WorldData<Real>& w) {
  if (!std::is_same_v<Real, double> || w.bodies.size() == 0) return nullptr;
  w.position_compensation.at(0, w.bodies.size());
  return w.position_compensation.data();
}

// Returns the displacements since sleep timers started; none if sleeping is off.
template <class Real>
RestDisplacement* rest_displacements_of(WorldData<Real>& w) {
  if (!w.settings.sleeping || w.bodies.size() == 0) return nullptr;
  w.rest_displacements.at(0, w.bodies.size());
  return w.rest_displacements.data();
}

// Moves a body by the displacement and rotation that the solver found.
template <class Real>
void move_body(WorldData<Real>& w, int body, BodyRecord<Real>& record, const SolverBody<Real>& motion,
               [[maybe_unused]] Vec2d* position_compensation) {
  if constexpr (std::is_same_v<Real, double>) {
    const Vec2d displacement = motion.delta_position + position_compensation[body], before = w.position[body];
    w.position[body] = before + displacement;
    position_compensation[body] = displacement - (w.position[body] - before);
  } else {
    w.position[body] += motion.delta_position.template as<double>();
  }
  if (motion.delta_angle == 0) return;
  record.angle += static_cast<double>(motion.delta_angle);
  // One Newton step towards |q| = 1.
  Rotation<Real>& q = w.rotation[body];
  const Real scale = Real(1.5) - Real(0.5) * (q.c * q.c + q.s * q.s);
  q = {scale * q.c, scale * q.s};
  if ((w.steps + body) % kRotationRefreshSteps == 0) {
    const Rotation<double> exact = rotation_of(record.angle);
    q = {static_cast<Real>(exact.c), static_cast<Real>(exact.s)};
  }
}

// Bodies per block of a shared loop: about 10 us of work.
constexpr int kBodiesPerBlock = 128;

// Applies the consequences of the bodies' motion, on one thread.
template <class Real>
struct ImmediateUpdates {
  WorldData<Real>& w;
  PrefetchedEnlarging<Real>& tree;
  // Stores the new fat AABB `box` of a shape that has left its previous one.
  void enlarge(int shape, const Aabb<Real>& box) const { store_fat_aabb(w, shape, box, tree); }
  void add_fast(const FastBody& fast) const { append(w.scratch.continuous.fast_bodies, fast); }
  void add_nonfinite(int body) const { append(w.scratch.nonfinite_bodies, body); }
};

// Records the same changes in the lists of a block, for later.
template <class Real>
struct DeferredUpdates {
  WorldData<Real>& w;
  int block;
  void enlarge(int shape, const Aabb<Real>& box) const {
    w.scratch.broad_phase.proxy_updates.add(block, ProxyUpdate<Real>{shape, box});
  }
  void add_fast(const FastBody& fast) const { w.scratch.continuous.found_fast.add(block, fast); }
  void add_nonfinite(int body) const { w.scratch.found_nonfinite.add(block, body); }
};

// Moves a body, and updates its tight AABBs.
template <class Real, class Updates>
[[gnu::always_inline]] inline void finalize_body(WorldData<Real>& w, int body, Real dt, bool any_expected,
                                                 Load<Real>* loads, Vec2d* position_compensation,
                                                 RestDisplacement* rest_displacements,
                                                 const Updates& updates) {
  BodyRecord<Real>& record = w.bodies[body];
  const SolverBody<Real>& motion = w.motion[body];
  const Real extent = w.extents[body];
  const Real rotation_distance = std::abs(motion.delta_angle) * extent;
  const Real displacement =
      std::abs(motion.delta_position.x) + std::abs(motion.delta_position.y) + rotation_distance;
  const bool expects_impact = any_expected && w.scratch.narrow_phase.expects_impact[body];
  const bool fast = expects_impact || displacement > Real(tuning::kFastFraction) * record.half_width;
  if (!is_finite_motion(motion) || (fast && !(is_valid_motion(motion) && stays_in_range(w, body)))) {
    updates.add_nonfinite(body);
    return;
  }
  move_body(w, body, record, motion, position_compensation);
  if (rest_displacements != nullptr) {
    const Load<Real>* const load = loads != nullptr ? &loads[body] : nullptr;
    record.sleep_time = is_still(w, record, motion, extent, dt)
                            ? time_at_rest(w, body, extent, dt, load, rest_displacements[body])
                            : Real(0);
  } else if (record.sleep_time != 0) {
    record.sleep_time = 0;
  }
  if (loads != nullptr) loads[body] = {};
  w.enlarged[body] = 0;
  if (!expects_impact && motion.delta_position == Vec2<Real>{} && motion.delta_angle == 0) return;
  const auto enlarge = [&](int shape, const Aabb<Real>& box) { updates.enlarge(shape, box); };
  if (fast) {
    bool covered = true;
    for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next)
      covered = update_aabbs(w, shape, dt, rotation_distance, enlarge) && covered;
    // A body that stays within its fat AABBs and has no contact cannot hit anything.
    const bool alone = covered && record.first_contact == kNone;
    if (!alone) updates.add_fast({body, covered, expects_impact});
  } else {
    const Pose<Real> pose{w.position[body].template as<Real>(), w.rotation[body]};
    for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) {
      const int proxy = w.shapes[shape].proxy;
      if (proxy == kNone) continue;
      const Aabb<Real> box = convex_bounds(w.convex(shape), pose);
      w.tight_aabbs[shape] = box;
      // Predict one step ahead, so that a pair exists in the step in which its shapes meet.
      if (!w.dynamic_tree.box(proxy).contains(
              predicted_aabb(box, dt * motion.velocity, rotation_distance, extent)))
        enlarge(shape, fat_aabb(w, shape, dt));
    }
  }
}

}  // namespace

template <class Real>
void finalize_bodies(WorldData<Real>& w, Real dt) {
  Scratch<Real>& scratch = w.scratch;
  scratch.continuous.fast_bodies.clear(), scratch.nonfinite_bodies.clear();
  Load<Real>* const loads = w.loads.used() ? w.loads.data() : nullptr;
  Vec2d* const position_compensation = position_compensation_of(w);
  RestDisplacement* const rest_displacements = rest_displacements_of(w);
  const bool any_expected = !scratch.narrow_phase.impact_bodies.empty();
  const PrefetchAwakeBodies<Real> prefetch(w);
  const int count = static_cast<int>(w.awake.size());
  const auto finalize = [&w, &prefetch, dt, any_expected, loads, position_compensation, rest_displacements ](
      int first, int last, const auto& updates) __attribute__((always_inline)) {
    for (int index = first; index < last; ++index) {
      prefetch.prefetch_motion(index), prefetch.prefetch_pose(index);
      finalize_body(w, w.awake[index], dt, any_expected, loads, position_compensation, rest_displacements,
                    updates);
    }
  };
  // Awake bodies are never static, so all their proxies are in the dynamic tree.
  PrefetchedEnlarging<Real> moving(w.dynamic_tree);
  const ImmediateUpdates<Real> immediate{w, moving};
  if (!w.scheduler.shares()) {
    finalize(0, count, immediate);
  } else {
    const int blocks = (count + kBodiesPerBlock - 1) / kBodiesPerBlock;
    scratch.broad_phase.proxy_updates.begin(blocks), scratch.continuous.found_fast.begin(blocks),
        scratch.found_nonfinite.begin(blocks);
    w.scheduler.blocks(blocks, [&](int block) {
      finalize(block * kBodiesPerBlock, std::min(count, (block + 1) * kBodiesPerBlock),
               DeferredUpdates<Real>{w, block});
    });
    scratch.broad_phase.proxy_updates.for_each(
        [&](const ProxyUpdate<Real>& each) { immediate.enlarge(each.shape, each.box); });
    scratch.continuous.found_fast.for_each([&](const FastBody& fast) { immediate.add_fast(fast); });
    scratch.found_nonfinite.for_each([&](int body) { immediate.add_nonfinite(body); });
  }
  moving.finish();
  if (!scratch.nonfinite_bodies.empty()) quarantine_diverged(w, static_cast<double>(dt));
  w.dynamic_tree.rebuild();
}

template void finalize_bodies(WorldData<float>&, float);
template void finalize_bodies(WorldData<double>&, double);

}  // namespace plumb
