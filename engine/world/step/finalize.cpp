#include <algorithm>
#include <cmath>
#include <limits>
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
constexpr int kRefresh = 256;

// Returns the Kahan compensation of positions (Kahan, 1965), in double only: 1e7 m from the origin, 600 steps
// would otherwise lose 1e-6 m. In float the steps themselves are coarser than that.
template <class Real>
Vec2d* position_compensation_of(WorldData<Real>& w) {
  if (!std::is_same_v<Real, double> || w.bodies.size() == 0) return nullptr;
  w.position_compensation.at(0, w.bodies.size());
  return w.position_compensation.data();
}

// Moves a body by the displacement and rotation that the solver found.
template <class Real>
void move_body(WorldData<Real>& w, int body, BodyRecord<Real>& record, const SolverBody<Real>& motion,
               [[maybe_unused]] Vec2d* position_compensation) {
  if constexpr (std::is_same_v<Real, double>) {
    const Vec2d way = motion.delta_position + position_compensation[body], before = w.position[body];
    w.position[body] = before + way;
    position_compensation[body] = way - (w.position[body] - before);
  } else {
    w.position[body] += motion.delta_position.template as<double>();
  }
  if (motion.delta_angle == 0) return;
  record.angle += static_cast<double>(motion.delta_angle);
  // One Newton step towards |q| = 1.
  Rotation<Real>& q = w.rotation[body];
  const Real scale = Real(1.5) - Real(0.5) * (q.c * q.c + q.s * q.s);
  q = {scale * q.c, scale * q.s};
  if ((w.steps + body) % kRefresh == 0) {
    const Rotation<double> exact = rotation_of(record.angle);
    q = {static_cast<Real>(exact.c), static_cast<Real>(exact.s)};
  }
}

// Bodies per block of a shared loop: about 10 us of work.
constexpr int kBodiesOfBlock = 128;

// Applies the consequences of the bodies' motion, on one thread.
template <class Real>
struct TakenAtOnce {
  WorldData<Real>& w;
  PrefetchedEnlarging<Real>& tree;
  // Stores the new fat AABB `box` of a shape that has left its previous one.
  void leave(int shape, const Aabb<Real>& box) const { store_fat_aabb(w, shape, box, tree); }
  void find_fast(const FastBody& fast) const { append(w.scratch.fast_bodies, fast); }
  void find_nonfinite(int body) const { append(w.scratch.nonfinite_bodies, body); }
};

// Records the same changes in the lists of a block, for later.
template <class Real>
struct NotedInBlock {
  WorldData<Real>& w;
  int block;
  void leave(int shape, const Aabb<Real>& box) const {
    w.scratch.proxy_updates.add(block, ProxyUpdate<Real>{shape, box});
  }
  void find_fast(const FastBody& fast) const { w.scratch.found_fast.add(block, fast); }
  void find_nonfinite(int body) const { w.scratch.found_nonfinite.add(block, body); }
};

// Moves a body, and updates its tight AABBs.
template <class Real, class Found>
[[gnu::always_inline]] inline void finalize_body(WorldData<Real>& w, int body, Real dt, bool expects,
                                                 Load<Real>* loads, Vec2d* position_compensation,
                                                 const Found& found) {
  BodyRecord<Real>& record = w.bodies[body];
  const SolverBody<Real>& motion = w.motion[body];
  const Real extent = w.extents[body];
  const Real turned = std::abs(motion.delta_angle) * extent;
  const Real way = std::abs(motion.delta_position.x) + std::abs(motion.delta_position.y) + turned;
  const bool expected = expects && w.scratch.expecting[body];
  const bool fast = expected || way > Real(tuning::kFastFraction) * record.half_width;
  if (!is_finite_motion(motion) || (fast && !(is_valid_motion(motion) && stays_in_range(w, body)))) {
    found.find_nonfinite(body);
    return;
  }
  move_body(w, body, record, motion, position_compensation);
  if (loads != nullptr) loads[body] = {};
  if (w.settings.sleeping) {
    record.sleep_time = is_still(w, record, motion, extent, dt) ? record.sleep_time + dt : Real(0);
  } else if (record.sleep_time != 0) {
    record.sleep_time = 0;
  }
  w.enlarged[body] = 0;
  if (!expected && motion.delta_position == Vec2<Real>{} && motion.delta_angle == 0) return;
  const auto note = [&](int shape, const Aabb<Real>& box) { found.leave(shape, box); };
  if (fast) {
    bool covered = true;
    for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next)
      covered = update_aabbs(w, shape, dt, turned, note) && covered;
    // A body that stays within its fat AABBs and has no contact cannot hit anything.
    const bool alone = covered && record.first_contact == kNone;
    if (!alone) found.find_fast({body, covered, expected});
  } else {
    const Pose<Real> pose{w.position[body].template as<Real>(), w.rotation[body]};
    for (int shape = record.first_shape; shape != kNone; shape = w.shapes[shape].next) {
      const int proxy = w.shapes[shape].proxy;
      if (proxy == kNone) continue;
      const Aabb<Real> box = convex_bounds(w.convex(shape), pose);
      w.boxes[shape] = box;
      // Predict one step ahead, so that a pair exists in the step in which its shapes meet.
      if (!w.dynamic_tree.box(proxy).contains(predicted_aabb(box, dt * motion.velocity, turned, extent)))
        note(shape, fat_aabb(w, shape, dt));
    }
  }
}

}  // namespace

template <class Real>
void finalize_bodies(WorldData<Real>& w, Real dt) {
  Scratch<Real>& scratch = w.scratch;
  scratch.fast_bodies.clear(), scratch.nonfinite_bodies.clear();
  Load<Real>* const loads = w.loads.used() ? w.loads.data() : nullptr;
  Vec2d* const position_compensation = position_compensation_of(w);
  const bool expects = !scratch.expecting_bodies.empty();
  const PrefetchAwakeBodies<Real> ahead(w);
  const int count = static_cast<int>(w.awake.size());
  const auto finalize = [&w, &ahead, dt, expects, loads, position_compensation ](
      int first, int last, const auto& found) __attribute__((always_inline)) {
    for (int place = first; place < last; ++place) {
      ahead.prefetch_motion(place), ahead.prefetch_pose(place);
      finalize_body(w, w.awake[place], dt, expects, loads, position_compensation, found);
    }
  };
  // Awake bodies are never static, so all their proxies are in the dynamic tree.
  PrefetchedEnlarging<Real> moving(w.dynamic_tree);
  const TakenAtOnce<Real> at_once{w, moving};
  if (!w.crew.shares()) {
    finalize(0, count, at_once);
  } else {
    const int blocks = (count + kBodiesOfBlock - 1) / kBodiesOfBlock;
    scratch.proxy_updates.begin(blocks), scratch.found_fast.begin(blocks),
        scratch.found_nonfinite.begin(blocks);
    w.crew.blocks(blocks, [&](int block) {
      finalize(block * kBodiesOfBlock, std::min(count, (block + 1) * kBodiesOfBlock),
               NotedInBlock<Real>{w, block});
    });
    scratch.proxy_updates.for_each(
        [&](const ProxyUpdate<Real>& left) { at_once.leave(left.shape, left.box); });
    scratch.found_fast.for_each([&](const FastBody& fast) { at_once.find_fast(fast); });
    scratch.found_nonfinite.for_each([&](int body) { at_once.find_nonfinite(body); });
  }
  moving.finish();
  if (!scratch.nonfinite_bodies.empty()) quarantine_diverged(w, static_cast<double>(dt));
  w.dynamic_tree.rebuild();
}

template void finalize_bodies(WorldData<float>&, float);
template void finalize_bodies(WorldData<double>&, double);

}  // namespace plumb
