#include "engine/world/link_inertia.h"

#include <algorithm>

namespace plumb {
namespace {

// The inverse of max(1 / inverse, least).
template <class Real>
Real at_least(Real inverse, Real least) {
  return inverse * least > 1 ? 1 / least : inverse;
}

// Loads by the rows' impulses as they stand.
template <class Real>
void count_loads(const WorldData<Real>& w, DirectIsland<Real>& island) {
  for (LinkBody<Real>& link : island.links) link.turning = link.sliding = 0;
  for (int i = 0; i < island.joint_rows; ++i) {
    const DirectRow<Real>& row = island.system.rows[i];
    const Real impulse = *row.impulse;
    const auto add = [&](int body, Real turning) {
      if (!w.gives_way(body)) return;
      LinkBody<Real>& link = island.links[w.scratch.link_of[body]];
      link.turning += impulse * turning;
      link.sliding += impulse * row.sliding;
    };
    add(row.a, row.turning_a);
    add(row.b, row.turning_b);
  }
}

}  // namespace

template <class Real>
void find_links(WorldData<Real>& w, DirectIsland<Real>& island) {
  std::vector<int>& link_of = w.scratch.link_of;
  island.links.clear();
  const auto add = [&](int body) {
    if (!w.gives_way(body)) return;
    const int place = link_of[body];
    if (place < static_cast<int>(island.links.size()) && island.links[place].body == body) return;
    link_of[body] = static_cast<int>(island.links.size());
    island.links.push_back({body, w.motion[body].inverse_mass, w.motion[body].inverse_inertia});
  };
  link_of.resize(std::max(link_of.size(), static_cast<std::size_t>(w.bodies.size())));
  for (const int joint : island.joints) {
    const auto [a, b] = w.joint_set.bodies(joint);
    add(a), add(b);
  }
  for (const ContactConstraint<Real>* c : island.contacts) add(c->body_a), add(c->body_b);
}

template <class Real>
void load_links(WorldData<Real>& w, DirectIsland<Real>& island, Real h) {
  count_loads(w, island);
  for (const LinkBody<Real>& link : island.links) {
    BodyMotion<Real>& motion = w.motion[link.body];
    motion.inverse_inertia = at_least(link.inverse_inertia, h * link.turning);
    motion.inverse_mass = at_least(link.inverse_mass, h * link.sliding);
  }
}

template <class Real>
void damp_links(WorldData<Real>& w, DirectIsland<Real>& island) {
  const auto excess = [&](int body) {
    const LinkBody<Real>& link = island.links[w.scratch.link_of[body]];
    return link.inverse_inertia > 0 ? 1 - w.motion[body].inverse_inertia / link.inverse_inertia : Real(0);
  };
  for (int i = 0; i < island.joint_rows; ++i) {
    const DirectRow<Real>& row = island.system.rows[i];
    if (i > 0 && island.system.rows[i - 1].block == row.block) continue;
    if (!w.gives_way(row.a) || !w.gives_way(row.b)) continue;
    BodyMotion<Real>&a = w.motion[row.a], &b = w.motion[row.b];
    const Real share = std::max(excess(row.a), excess(row.b));
    const Real inverse = a.inverse_inertia + b.inverse_inertia;
    if (!(inverse > 0)) continue;
    const Real impulse = share * (b.angular_velocity - a.angular_velocity) / inverse;
    a.angular_velocity += a.inverse_inertia * impulse;
    b.angular_velocity -= b.inverse_inertia * impulse;
  }
}

template <class Real>
void restore_links(WorldData<Real>& w, DirectIsland<Real>& island) {
  for (const LinkBody<Real>& link : island.links) {
    w.motion[link.body].inverse_mass = link.inverse_mass;
    w.motion[link.body].inverse_inertia = link.inverse_inertia;
  }
  island.links.clear();
}

#define PLUMB_FOR(Real)                                                  \
  template void find_links(WorldData<Real>&, DirectIsland<Real>&);       \
  template void load_links(WorldData<Real>&, DirectIsland<Real>&, Real); \
  template void damp_links(WorldData<Real>&, DirectIsland<Real>&);       \
  template void restore_links(WorldData<Real>&, DirectIsland<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
