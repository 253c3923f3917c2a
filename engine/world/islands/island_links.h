#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/math/small_turn.h"
#include "engine/world/integration/free_motion.h"
#include "engine/world/world_data.h"

/// Bodies of an island with joints.
namespace plumb {

/// Returns the index of a body among the island's links, where it is added if it is new.
template <class Real>
int link_at(WorldData<Real>& w, JointedIsland<Real>& island, int body) {
  int& place = w.scratch.link_of[body];
  if (place < static_cast<int>(island.links.size()) && island.links[place].body == body) return place;
  place = static_cast<int>(island.links.size());
  const BodyMotion<Real>& motion = w.motion[body];
  const BodyRecord<Real>& record = w.bodies[body];
  const double inverse_mass = motion.inverse_mass;
  island.links.push_back({body});
  island.system.bodies.push_back(
      {.inverse_mass = {record.lock_x ? 0 : inverse_mass, record.lock_y ? 0 : inverse_mass},
       .inverse_inertia = motion.inverse_inertia});
  return place;
}

/// Begins an island without links.
template <class Real>
void start_links(WorldData<Real>& w, JointedIsland<Real>& island) {
  island.links.clear(), island.system.bodies.clear(), island.blocks.clear(), island.sizes.clear();
  w.scratch.link_of.resize(std::max(w.scratch.link_of.size(), static_cast<std::size_t>(w.bodies.size())));
}

/// Finds the bodies of an island's joints and contacts.
template <class Real>
void find_links(WorldData<Real>& w, JointedIsland<Real>& island) {
  start_links(w, island);
  const auto add = [&](int a, int b) {
    const int link_a = link_at(w, island, a);
    island.blocks.emplace_back(link_a, link_at(w, island, b));
  };
  for (const int joint : island.joints) {
    const auto [a, b] = w.joint_set.bodies(joint);
    add(a, b);
  }
  for (const ContactConstraint<Real>* c : island.contacts) add(c->body_a, c->body_b);
}

/// Moves and turns a body within a substep.
template <class Real>
void shift(WorldData<Real>& w, int body, Vec2d way, double turn) {
  BodyMotion<Real>& motion = w.motion[body];
  motion.moved += way.template as<Real>();
  if (turn == 0) return;
  motion.turned += static_cast<Real>(turn);
  w.rotation[body] = turned_by(w.rotation[body], static_cast<Real>(turn));
}

/// Notes where the bodies of an island are before they are shifted.
template <class Real>
void note_poses(const WorldData<Real>& w, JointedIsland<Real>& island) {
  for (JointedLink& link : island.links) {
    const BodyMotion<Real>& motion = w.motion[link.body];
    link.moved = motion.moved.template as<double>(), link.turned = motion.turned;
  }
}

/// Pays for the energy that shifts of an island's bodies have given them since `note_poses`, so that closing
/// gaps adds none: first with the bodies' motion along the shift, then with what their fall `way(link)`, m,
/// has lost before, since that is what a mechanism that sags falls by. The part of the shift that neither
/// pays for is taken back. `velocity(link)` and `spin(link)` are references; `count`: links that moved.
template <class Real, class Way, class Velocity, class Spin>
void pay_for_lift(WorldData<Real>& w, JointedIsland<Real>& island, std::size_t count, const Way& way,
                  const Velocity& velocity, const Spin& spin) {
  double lift = 0, fall = 0, along = 0, own = 0;
  const auto shifted = [&](const JointedLink& link) {
    const BodyMotion<Real>& motion = w.motion[link.body];
    return BoundedRows::Shift{motion.moved.template as<double>() - link.moved,
                              double(motion.turned) - link.turned};
  };
  for (std::size_t i = 0; i < count; ++i) {
    JointedLink& link = island.links[i];
    if (!w.is_dynamic(link.body)) continue;
    const double mass = w.bodies[link.body].mass, i_inverse = w.motion[link.body].inverse_inertia;
    const double inertia = i_inverse > 0 ? 1 / i_inverse : 0;
    const BoundedRows::Shift d = shifted(link);
    const Vec2d weight = mass * free_acceleration(w, link.body);
    lift -= dot(weight, d.way), fall += dot(weight, way(link));
    along += mass * dot(d.way, velocity(link)) + inertia * d.turn * spin(link);
    own += mass * length_squared(d.way) + inertia * d.turn * d.turn;
  }
  if (!(lift > 0) || !(own > 0)) return;
  // Taking `part` of the shift from the velocities takes part (along - part own / 2) of their energy.
  const double most = 0.5 * along * along / own, paid = std::min(lift, most);
  const double part = (along - std::copysign(std::sqrt(2 * own * (most - paid)), along)) / own;
  const double kept = std::min((paid + std::max(fall, 0.0)) / lift, 1.0);
  for (std::size_t i = 0; i < count; ++i) {
    JointedLink& link = island.links[i];
    if (!w.is_dynamic(link.body)) continue;
    const BoundedRows::Shift d = shifted(link);
    velocity(link) -= part * d.way, spin(link) -= part * d.turn;
    if (kept < 1) shift(w, link.body, (kept - 1) * d.way, (kept - 1) * d.turn);
  }
}

/// Moves the bodies of an island by the `shifts` of its system, all by the same fraction, such that none
/// turns by more than `most`, rad, or moves by more than that share of its extent.
template <class Real>
void shift_links(WorldData<Real>& w, const JointedIsland<Real>& island, double most) {
  double share = 1;
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    const BoundedRows::Shift& s = island.system.shifts[i];
    const double turn = std::abs(s.turn), way = length(s.way);
    const double longest = most * double(w.extents[island.links[i].body]);
    if (turn * share > most) share = most / turn;
    if (longest > 0 && way * share > longest) share = longest / way;
  }
  for (std::size_t i = 0; i < island.links.size(); ++i) {
    if (!w.is_dynamic(island.links[i].body)) continue;
    const BoundedRows::Shift& s = island.system.shifts[i];
    shift(w, island.links[i].body, share * s.way, share * s.turn);
  }
}

}  // namespace plumb
