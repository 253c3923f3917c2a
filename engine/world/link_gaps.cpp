#include "engine/world/link_gaps.h"

#include <algorithm>
#include <cmath>

#include "engine/math/small_turn.h"
#include "engine/world/constants.h"
#include "engine/world/link_inertia.h"

namespace plumb {
namespace {

// How bodies would be moved by what the system has found.
template <class Real>
void find_changes(WorldData<Real>& w, DirectIsland<Real>& island) {
  for (LinkBody<Real>& link : island.links) link.shift = {}, link.turn = 0;
  for (std::size_t i = 0; i < island.system.rows.size(); ++i) {
    const DirectRow<Real>& row = island.system.rows[i];
    if (!row.active) continue;
    const Real x = static_cast<Real>(island.system.found(static_cast<int>(i)));
    const auto add = [&](int body, Vec2<Real> linear, Real angular) {
      if (!w.gives_way(body)) return;
      LinkBody<Real>& link = island.links[w.scratch.link_of[body]];
      link.shift += (x * w.motion[body].inverse_mass) * linear;
      link.turn += x * w.motion[body].inverse_inertia * angular;
    };
    add(row.a, row.linear_a, row.angular_a);
    add(row.b, row.linear_b, row.angular_b);
  }
}

// Bodies that would turn too far get so much inertia that others give way; whether there are any.
template <class Real>
bool hold_back(WorldData<Real>& w, DirectIsland<Real>& island) {
  bool any = false;
  for (const LinkBody<Real>& link : island.links) {
    const Real excess = std::abs(link.turn) / Real(tuning::kLinkTurn);
    if (!(excess > 1)) continue;
    w.motion[link.body].inverse_inertia /= 4 * excess * excess;
    any = true;
  }
  return any;
}

}  // namespace

template <class Real>
void pull_gaps(WorldData<Real>& w, DirectIsland<Real>& island, const JointStep<Real>& step) {
  const Real rate = step.softness.bias_rate;
  island.system.correct();
  find_changes(w, island);
  Real widest = 0;
  for (const LinkBody<Real>& link : island.links) widest = std::max(widest, std::abs(link.turn));
  island.jerks = widest * rate * step.h > Real(tuning::kLinkPull);
  for (int i = 0; i < island.joint_rows; ++i) {
    DirectRow<Real>& row = island.system.rows[i];
    row.bias = island.jerks ? Real(0) : rate * row.gap;
  }
}

template <class Real>
void close_gaps(WorldData<Real>& w, DirectIsland<Real>& island, Real h) {
  constexpr int kTries = 3;
  constexpr Real kShare = Real(tuning::kLinkShare);
  if (!island.jerks) return;
  bool found = island.system.correct(), held = false;
  find_changes(w, island);
  for (int i = 0; found && i < kTries && hold_back(w, island); ++i) {
    held = true;
    island.system.factorise(w.motion.data());
    found = island.system.correct();
    find_changes(w, island);
  }
  if (held) {
    // Held back they were moved, not driven: to velocities, which they keep, that inertia would be a blow.
    load_links(w, island, h);
    island.system.factorise(w.motion.data());
  }
  if (!found) return;
  for (const LinkBody<Real>& link : island.links) {
    BodyMotion<Real>& motion = w.motion[link.body];
    const BodyRecord<Real>& record = w.bodies[link.body];
    if (!record.lock_x) motion.moved.x += kShare * link.shift.x;
    if (!record.lock_y) motion.moved.y += kShare * link.shift.y;
    motion.turned += kShare * link.turn;
    w.rotation[link.body] = turned_by(w.rotation[link.body], kShare * link.turn);
  }
}

#define PLUMB_FOR(Real)                                                                   \
  template void pull_gaps(WorldData<Real>&, DirectIsland<Real>&, const JointStep<Real>&); \
  template void close_gaps(WorldData<Real>&, DirectIsland<Real>&, Real);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
