#include "engine/world/islands/contact_gains.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "engine/core/capacity.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/contact_solver/contact_passes.h"
#include "engine/world/islands/hinge_trees.h"

namespace plumb {
namespace {

// The impulses of a substep as one change of a body's velocities, in double: m/s, rad/s.
template <class Real>
struct Change {
  Change(const VelocityIncrement<Real>& increment, const SolverBody<Real>& motion)
      : before(increment.velocity_before.template as<double>()),
        by(motion.velocity.template as<double>() - before),
        spin_before(increment.spin_before),
        spin_by(motion.angular_velocity - spin_before),
        mass(motion.inverse_mass > 0 ? 1 / double(motion.inverse_mass) : 0),
        inertia(motion.inverse_inertia > 0 ? 1 / double(motion.inverse_inertia) : 0) {}

  // Returns the work of the change on the velocities before it, J.
  double work() const { return mass * dot(before, by) + inertia * spin_before * spin_by; }
  // Returns twice the energy of the change alone, J.
  double own() const { return mass * length_squared(by) + inertia * spin_by * spin_by; }

  Vec2d before, by;
  double spin_before, spin_by;
  double mass, inertia;
};

// Calls `act(increment)` for the dynamic bodies that move by substeps.
template <class Real, class Act>
void for_each_moved(const WorldData<Real>& w, const Act& act) {
  for (const VelocityIncrement<Real>& increment : w.scratch.solver.velocity_increments)
    if (!increment.in_tree && is_dynamic(w.motion[increment.body])) act(increment);
}

template <class Real>
int root_of(const WorldData<Real>& w, const ContactConstraint<Real>& c) {
  return w.scratch.islands.island_of[w.is_dynamic(c.body_a) ? c.body_a : c.body_b];
}

// Computes what contacts gave a body in a substep beyond rounding and what its forces give from rest: twice
// the energy by mass, m^2/s^2, and by moment of inertia, rad^2/s^2.
template <class Real>
struct BodyGain {
  BodyGain(const VelocityIncrement<Real>& k, const SolverBody<Real>& motion)
      : linear(terms(k.velocity_before, motion.velocity, k.velocity)),
        angular(terms(Vec2<Real>{k.spin_before, 0}, Vec2<Real>{motion.angular_velocity, 0},
                      Vec2<Real>{k.spin, 0})) {}

  Real linear, angular;

 private:
  // Rounding of the velocities before, whose squares are subtracted: 8 covers the sums of a contact's rows.
  // Less would mistake the rounding of crowds that fly at 100 m/s for energy.
  static constexpr Real kRounding = 8 * std::numeric_limits<Real>::epsilon();
  static Real terms(Vec2<Real> before, Vec2<Real> now, Vec2<Real> forces) {
    return dot(now - before, now + before) - kRounding * length_squared(before) - length_squared(forces);
  }
};

// Returns true if any body gained energy, be it by rounding. If none did, no island did.
template <class Real>
bool any_body_gained(const WorldData<Real>& w) {
  const SolverBody<Real>* const bodies = w.motion.data();
  bool any = false;
  for (const VelocityIncrement<Real>& k : w.scratch.solver.velocity_increments) {
    const SolverBody<Real>& motion = bodies[k.body];
    const Real linear = length_squared(motion.velocity) - length_squared(k.velocity_before),
               angular = motion.angular_velocity * motion.angular_velocity - k.spin_before * k.spin_before;
    // Energy times both inverses. The mass of bodies that cannot rotate does not matter.
    const Real inverse_inertia = motion.inverse_inertia > 0 ? motion.inverse_inertia : Real(1);
    any |= linear * inverse_inertia + angular * motion.inverse_mass > 0;
  }
  return any;
}

// Sums by island what its bodies gained, twice in J. Returns true if any island gained energy.
template <class Real>
bool sum_gains(WorldData<Real>& w) {
  IslandScratch<Real>& s = w.scratch.islands;
  s.contact_gains.assign(w.bodies.size(), 0.0);
  for_each_moved(w, [&](const VelocityIncrement<Real>& k) {
    const SolverBody<Real>& motion = w.motion[k.body];
    const BodyGain<Real> gain(k, motion);
    double& sum = s.contact_gains[s.island_of[k.body]];
    if (motion.inverse_mass > 0) sum += static_cast<double>(gain.linear / motion.inverse_mass);
    if (motion.inverse_inertia > 0) sum += static_cast<double>(gain.angular / motion.inverse_inertia);
  });
  return std::any_of(s.contact_gains.begin(), s.contact_gains.end(), [](double gain) { return gain > 0; });
}

// Marks islands to which others than contacts between their bodies give energy.
template <class Real>
void mark_driven(WorldData<Real>& w) {
  IslandScratch<Real>& s = w.scratch.islands;
  if (s.driven_known) return;
  s.driven_known = true;
  s.is_driven.assign(w.bodies.size(), 0);
  w.joints.for_each([&](int, const JointRecord& joint) {
    for (const int body : {joint.body_a, joint.body_b})
      if (w.is_dynamic(body)) s.is_driven[s.island_of[body]] = 1;
  });
  const auto drives = [&](int body) { return w.bodies[body].type == BodyType::Kinematic; };
  w.graph.for_each([&](const ContactConstraint<Real>& c) {
    if (drives(c.body_a) || drives(c.body_b) || c.surface_speed != 0) s.is_driven[root_of(w, c)] = 1;
  });
}

// Returns the work that pushing a contact's overlap apart may do in a substep, J: its impulses move its
// points at most as fast as the bias asks.
template <class Real>
double push_work(const ContactConstraint<Real>& c, const ContactStep<Real>& step) {
  const Real rate = step.softness[static_cast<int>(c.hardness)][0].bias_rate;
  double work = 0;
  for (int i = 0; i < c.count; ++i) {
    const Real speed = std::min(rate * std::max(-c.current_separation[i], Real(0)), c.depenetration_speed);
    // Direct solutions are non-negative to rounding only.
    work += std::max(static_cast<double>(c.normal_impulse[i]), 0.0) * static_cast<double>(speed);
  }
  return work;
}

// Computes by island the fraction of the impulses at which the energy grows by no more than it may. Returns
// true if one is less than 1.
template <class Real>
bool find_fractions(WorldData<Real>& w, const ContactStep<Real>& step) {
  IslandScratch<Real>& s = w.scratch.islands;
  s.contact_energy.assign(w.bodies.size(), {});
  for_each_moved(w, [&](const VelocityIncrement<Real>& k) {
    const int root = s.island_of[k.body];
    if (!(s.contact_gains[root] > 0) || s.is_driven[root]) return;
    const Change<Real> change(k, w.motion[k.body]);
    ContactEnergy& energy = s.contact_energy[root];
    energy.work += change.work(), energy.own += change.own();
    energy.allowed += (change.mass * double(length_squared(k.velocity)) +
                       change.inertia * double(k.spin) * double(k.spin)) /
                      2;
  });
  w.graph.for_each([&](const ContactConstraint<Real>& c) {
    ContactEnergy& energy = s.contact_energy[root_of(w, c)];
    if (energy.own > 0) energy.allowed += push_work(c, step);
  });
  bool any = false;
  for (ContactEnergy& energy : s.contact_energy) {
    // E(f) - E(0) = f work + f^2 own / 2.
    if (!(energy.own > 0) || !(energy.work + energy.own / 2 > energy.allowed)) continue;
    assert(energy.allowed >= 0);
    const double root = std::sqrt(energy.work * energy.work + 2 * energy.own * energy.allowed);
    energy.fraction = std::clamp((root - energy.work) / energy.own, 0.0, 1.0);
    any = true;
  }
  return any;
}

template <class Real>
void scale_contact(ContactConstraint<Real>& c, Real fraction) {
  if (c.tracking != ImpactTracking::Off) c.step_impulse -= (1 - fraction) * normal_sum(c);
  c.normal_impulse[0] *= fraction, c.normal_impulse[1] *= fraction;
  c.tangent_impulse *= fraction, c.rolling_impulse *= fraction;
}

}  // namespace

template <class Real>
void begin_contact_gains(WorldData<Real>& w, Real dt) {
  IslandScratch<Real>& s = w.scratch.islands;
  s.driven_known = false, s.bounds_gains = false;
  // Memory for the step of a gain, which may come at any time.
  ensure_capacity(s.contact_gains, w.bodies.size()), ensure_capacity(s.contact_energy, w.bodies.size()),
      ensure_capacity(s.is_driven, w.bodies.size());
  if (!enabled(Switch::ContactGains) || !s.islands_known || w.graph.empty()) return;
  const Real fall_squared = dt * dt * static_cast<Real>(length_squared(w.settings.gravity));
  const SolverBody<Real>* const bodies = w.motion.data();
  for (const VelocityIncrement<Real>& k : w.scratch.solver.velocity_increments) {
    const SolverBody<Real>& motion = bodies[k.body];
    const Real inverse_inertia = motion.inverse_inertia > 0 ? motion.inverse_inertia : Real(1);
    s.bounds_gains |= (length_squared(motion.velocity) - fall_squared) * inverse_inertia +
                          motion.angular_velocity * motion.angular_velocity * motion.inverse_mass >
                      0;
  }
}

template <class Real>
void bound_contact_gains(WorldData<Real>& w, const ContactStep<Real>& step) {
  IslandScratch<Real>& s = w.scratch.islands;
  if (!s.bounds_gains || !any_body_gained(w) || !sum_gains(w)) return;
  mark_driven(w);
  bool any = false;
  for_each_moved(w, [&](const auto& k) {
    const int root = s.island_of[k.body];
    any = any || (s.contact_gains[root] > 0 && !s.is_driven[root]);
  });
  if (!any) return;
  w.scratch.solver.soft_contacts.finish();
  if (!find_fractions(w, step)) return;
  w.graph.for_each([&](ContactConstraint<Real>& c) {
    const double fraction = s.contact_energy[root_of(w, c)].fraction;
    if (fraction < 1) scale_contact(c, static_cast<Real>(fraction));
  });
  w.scratch.solver.soft_contacts.regather();
  for_each_moved(w, [&](const VelocityIncrement<Real>& k) {
    const double fraction = s.contact_energy[s.island_of[k.body]].fraction;
    if (fraction == 1) return;
    SolverBody<Real>& motion = w.motion[k.body];
    const Real f = static_cast<Real>(fraction);
    if (!k.locked_x) motion.velocity.x = k.velocity_before.x + f * (motion.velocity.x - k.velocity_before.x);
    if (!k.locked_y) motion.velocity.y = k.velocity_before.y + f * (motion.velocity.y - k.velocity_before.y);
    motion.angular_velocity = k.spin_before + f * (motion.angular_velocity - k.spin_before);
  });
}

#define PLUMB_FOR(Real)                                      \
  template void begin_contact_gains(WorldData<Real>&, Real); \
  template void bound_contact_gains(WorldData<Real>&, const ContactStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
