#pragma once

#include <algorithm>
#include <array>

#include "engine/world/contact_solver/contact_constraint.h"
#include "engine/world/contact_solver/locked_axes.h"
#include "engine/world/contact_solver/solver_body.h"

namespace plumb {

/// A contact and its two bodies, for solving one row at a time: used by sequential impulses, position-based
/// solvers and impacts at their time of impact. The soft steps have their own passes, also for SIMD lanes
/// (contact_passes.h and contact_pair.h).
template <class Real>
struct ContactPair {
  ContactPair(SolverBody<Real>* motion, ContactConstraint<Real>& contact)
      : c(contact), a(motion[contact.body_a]), b(motion[contact.body_b]) {}

  /// Returns the separation of a point, m, updated from the start of the step to first order.
  Real separation(int i) const {
    return c.separation[i] + dot(c.normal, b.delta_position - a.delta_position) + c.arm_b[i] * b.delta_angle -
           c.arm_a[i] * a.delta_angle;
  }
  /// Returns the velocity of a point along the normal, m/s; negative: closing.
  Real normal_velocity(int i) const {
    return dot(c.normal, b.velocity - a.velocity) + c.arm_b[i] * b.angular_velocity -
           c.arm_a[i] * a.angular_velocity;
  }
  /// Returns the relative tangential velocity minus the target surface speed, m/s.
  Real slip_velocity() const {
    return dot(tangent(), b.velocity - a.velocity) + c.arm_tangent_b * b.angular_velocity -
           c.arm_tangent_a * a.angular_velocity - c.surface_speed;
  }
  Real rolling_mass() const {
    const Real inverse = a.inverse_inertia + b.inverse_inertia;
    return inverse > 0 ? 1 / inverse : Real(0);
  }

  /// Returns the changes of impulses that bring the chosen points' velocities along n to `target`, such that
  /// their sums with the impulses `p` and `q` stay >= 0. The points are coupled by the bodies' rotation and
  /// solved together (Catto, 2007). A point that would have to pull gets no impulse, and the other one is
  /// solved alone.
  std::array<Real, 2> normal_block(const Real (&target)[2], bool first, bool second, Real p, Real q) const {
    const Real compliance = driver_compliance(a, b, c, ContactRow::Normal);
    const Real rate_p = normal_velocity(0) + compliance * p - target[0],
               rate_q = normal_velocity(1) + compliance * q - target[1];
    Real dp = 0, dq = 0;
    if (first && second) {
      dp = -(c.inverse_pp * rate_p + c.inverse_pq * rate_q);
      dq = -(c.inverse_pq * rate_p + c.inverse_qq * rate_q);
      if (p + dp < 0 || q + dq < 0) {
        if (p + dp < q + dq) {
          dp = -p;
          dq = std::max(-c.mass[1] * (rate_q + c.k_pq * dp), -q);
        } else {
          dq = -q;
          dp = std::max(-c.mass[0] * (rate_p + c.k_pq * dq), -p);
        }
      }
    } else if (first) {
      dp = std::max(-c.mass[0] * rate_p, -p);
    } else if (second) {
      dq = std::max(-c.mass[1] * rate_q, -q);
    }
    return {dp, dq};
  }
  /// Applies them. Driven contacts yield to what exceeds their load (solvers/driven_contacts.h).
  void solve_normal_block(const Real (&target)[2], bool first, bool second) {
    const Real p = c.normal_impulse[0], q = c.normal_impulse[1];
    std::array<Real, 2> by = normal_block(target, first, second, p, q);
    if (is_driven(c)) {
      by[0] -= Real(kDrivenYield) * std::max(p + by[0] - c.load_estimate[0], Real(0));
      by[1] -= Real(kDrivenYield) * std::max(q + by[1] - c.load_estimate[1], Real(0));
    }
    apply_normal(by[0], by[1]);
  }
  void apply_normal(Real first, Real second) {
    c.normal_impulse[0] += first, c.normal_impulse[1] += second;
    apply((first + second) * c.normal, first * c.arm_a[0] + second * c.arm_a[1],
          first * c.arm_b[0] + second * c.arm_b[1]);
  }
  /// Sets and applies impulses that nearly cancel along the bodies' free axes: only their sums are rounded.
  void apply_unrounded(const double (&normal)[2], double friction) {
    for (int i = 0; i < 2; ++i) c.normal_impulse[i] = static_cast<Real>(normal[i]);
    c.tangent_impulse = static_cast<Real>(friction);
    const Vec2d n = c.normal.template as<double>(), t{n.y, -n.x},
                impulse = (normal[0] + normal[1]) * n + friction * t;
    const auto change = [&](SolverBody<Real>& body, Vec2d by, const Real(&arm)[2], double arm_tangent,
                            double sign) {
      const double angular = normal[0] * double(arm[0]) + normal[1] * double(arm[1]) + friction * arm_tangent;
      body.velocity =
          (body.velocity.template as<double>() + (sign * double(body.inverse_mass)) * by).template as<Real>();
      body.angular_velocity =
          static_cast<Real>(double(body.angular_velocity) + sign * double(body.inverse_inertia) * angular);
    };
    change(a, free_of_a(impulse, c.locks), c.arm_a, double(c.arm_tangent_a), -1);
    change(b, free_of_b(impulse, c.locks), c.arm_b, double(c.arm_tangent_b), 1);
  }
  /// Returns the total friction impulse with which the contact would stick.
  Real sticking_impulse() const {
    const Real yielding = driver_compliance(a, b, c, ContactRow::Friction) * c.tangent_impulse;
    return c.tangent_impulse - c.tangent_mass * (slip_velocity() + yielding);
  }
  Real sticking_torque() const {
    return c.rolling_impulse - rolling_mass() * (b.angular_velocity - a.angular_velocity);
  }
  void set_friction(Real impulse) {
    const Real d = impulse - c.tangent_impulse;
    c.tangent_impulse = impulse;
    apply(d * tangent(), d * c.arm_tangent_a, d * c.arm_tangent_b);
  }
  void set_rolling(Real impulse) {
    const Real d = impulse - c.rolling_impulse;
    c.rolling_impulse = impulse;
    apply({}, d, d);
  }
  /// Applies Coulomb friction, |friction| <= mu normal impulse, and likewise the rolling resistance torque.
  void solve_friction_and_rolling() {
    const Real total_normal = c.normal_impulse[0] + c.normal_impulse[1];
    set_friction(std::clamp(sticking_impulse(), -c.friction * total_normal, c.friction * total_normal));
    solve_rolling();
  }
  void solve_rolling() {
    const Real max_torque = c.rolling_arm * (c.normal_impulse[0] + c.normal_impulse[1]);
    if (c.rolling_arm > 0) set_rolling(std::clamp(sticking_torque(), -max_torque, max_torque));
  }
  void record_max_impulse() {
    if (c.tracking == ImpactTracking::Off) return;
    for (int i = 0; i < 2; ++i)
      c.max_normal_impulse[i] = std::max(c.max_normal_impulse[i], c.normal_impulse[i]);
  }

  ContactConstraint<Real>& c;
  SolverBody<Real>&a, &b;

 private:
  Vec2<Real> tangent() const { return {c.normal.y, -c.normal.x}; }
  void apply(Vec2<Real> impulse, Real angular_a, Real angular_b) {
    a.velocity -= a.inverse_mass * free_of_a(impulse, c.locks);
    a.angular_velocity -= a.inverse_inertia * angular_a;
    b.velocity += b.inverse_mass * free_of_b(impulse, c.locks);
    b.angular_velocity += b.inverse_inertia * angular_b;
  }
};

}  // namespace plumb
