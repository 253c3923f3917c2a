#include "engine/world/solvers/driven_contacts.h"

#include <algorithm>
#include <cmath>

#include "engine/core/capacity.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_rows.h"
#include "engine/world/state/drivers.h"

namespace plumb {
namespace {

// Calls `act` for the contacts that may be of kinematic bodies.
template <class Real, class Act>
void for_each_with_ground(WorldData<Real>& w, const Act& act) {
  using Graph = ContactGraph<Real>;
  for (int i = Graph::kDynamicColours; i <= Graph::kColours; ++i)
    for (ContactConstraint<Real>& c : w.graph.colour(i)) act(c);
}

}  // namespace

template <class Real>
bool mark_driven_contacts(WorldData<Real>& w) {
  if (!enabled(Switch::YieldingContacts) || w.graph.empty()) return false;
  const auto& bodies = w.scratch.solver.velocity_increments;
  if (std::none_of(bodies.begin(), bodies.end(), [&](const auto& k) { return is_driver(w, k.body); }))
    return false;
  bool any = false;
  for_each_with_ground(w, [&](ContactConstraint<Real>& c) {
    // Contacts of locked bodies have a compliance of their own (contact_solver/locked_axes.h), and in islands
    // with joints others yield (islands/island_rows.h).
    if (c.hardness != ContactHardness::Stiff || c.locks != 0 ||
        !(is_driver(w, c.body_a) || is_driver(w, c.body_b)) ||
        w.bodies[w.is_dynamic(c.body_a) ? c.body_a : c.body_b].first_joint != kNone)
      return;
    c.hardness = ContactHardness::Driven;
    any = true;
  });
  return any;
}

template <class Real>
void set_driver_loads(WorldData<Real>& w) {
  IslandScratch<Real>& s = w.scratch.islands;
  // Only these find the islands of a step.
  const bool known = w.settings.solver != Solver::SequentialImpulses &&
                     (w.settings.solver == Solver::Direct || w.settings.direct_islands) && s.islands_known;
  // Islands with joints have compliances of their own (islands/island_rows.h).
  for (int i = 0; known && i < s.jointed_count; ++i)
    for (ContactConstraint<Real>* c : s.jointed_islands[i].contacts)
      if (is_driven(*c)) c->hardness = ContactHardness::Stiff;
  const auto root_of = [&](int body) { return known ? s.island_of[body] : 0; };
  std::vector<double>& loads = s.contact_gains;  // which are summed later in the step
  ensure_capacity(loads, w.bodies.size());
  loads.assign(w.bodies.size(), 0.0);
  for (const VelocityIncrement<Real>& k : w.scratch.solver.velocity_increments) {
    const SolverBody<Real>& motion = w.motion[k.body];
    if (motion.inverse_mass > 0)
      loads[root_of(k.body)] += std::sqrt(double(length_squared(k.velocity))) / double(motion.inverse_mass);
  }
  for_each_with_ground(w, [&](ContactConstraint<Real>& c) {
    if (!is_driven(c)) return;
    const Real most = static_cast<Real>(loads[root_of(w.is_dynamic(c.body_a) ? c.body_a : c.body_b)]);
    const std::array<Real, 2> stopping =
        ContactPair<Real>(w.motion.data(), c).normal_block({0, 0}, true, c.count == 2, 0, 0);
    for (int i = 0; i < c.count; ++i) c.load_estimate[i] = std::min(c.normal_impulse[i], most) + stopping[i];
  });
}

template <class Real>
void unmark_driven_contacts(WorldData<Real>& w) {
  for_each_with_ground(w, [&](ContactConstraint<Real>& c) {
    if (c.hardness == ContactHardness::Driven) c.hardness = ContactHardness::Stiff;
  });
}

#define PLUMB_FOR(Real)                                 \
  template bool mark_driven_contacts(WorldData<Real>&); \
  template void set_driver_loads(WorldData<Real>&);     \
  template void unmark_driven_contacts(WorldData<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
