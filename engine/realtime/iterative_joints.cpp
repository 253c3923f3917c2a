#include "engine/realtime/iterative_joints.h"

#include <algorithm>

#include "engine/realtime/constants.h"

namespace plumb {

template <class Real>
IterativeJoints<Real>::IterativeJoints(const Scene& scene, const Bodies<Real>& bodies)
    : joints_(compile_joints<Real>(scene)),
      rows_(joints_.row_count()),
      mass_(rows_.size()),
      impulses_(2 * rows_.size()) {
  place(bodies);
}

template <class Real>
void IterativeJoints<Real>::place(const Bodies<Real>& bodies) {
  joints_.rows(bodies.pose, bodies.twist, rows_);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row<Real>& row = rows_[i];
    Real inverse = 0;
    if (row.a != kFixedFrame)
      inverse += bodies.inverse_mass[row.a] * length_squared(row.linear_a) +
                 bodies.inverse_inertia[row.a] * row.angular_a * row.angular_a;
    if (row.b != kFixedFrame)
      inverse += bodies.inverse_mass[row.b] * length_squared(row.linear_b) +
                 bodies.inverse_inertia[row.b] * row.angular_b * row.angular_b;
    mass_[i] = inverse > 0 ? 1 / inverse : Real{0};
  }
}

template <class Real>
void IterativeJoints<Real>::warm_start(Bodies<Real>& bodies, std::span<const Real> impulses) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row<Real>& row = rows_[i];
    if (row.a != kFixedFrame) bodies.apply(row.a, impulses[i] * row.linear_a, impulses[i] * row.angular_a);
    if (row.b != kFixedFrame) bodies.apply(row.b, impulses[i] * row.linear_b, impulses[i] * row.angular_b);
  }
}

template <class Real>
void IterativeJoints<Real>::sweep(Bodies<Real>& bodies, const Spring& spring, std::span<Real> impulses) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row<Real>& row = rows_[i];
    Real speed = 0;
    if (row.a != kFixedFrame)
      speed += dot(row.linear_a, bodies.twist[row.a].velocity) +
               row.angular_a * bodies.twist[row.a].angular_velocity;
    if (row.b != kFixedFrame)
      speed += dot(row.linear_b, bodies.twist[row.b].velocity) +
               row.angular_b * bodies.twist[row.b].angular_velocity;
    const Real change =
        -mass_[i] * spring.scale * (speed + spring.rate * row.residual) - spring.leak * impulses[i];
    impulses[i] += change;
    if (row.a != kFixedFrame) bodies.apply(row.a, change * row.linear_a, change * row.angular_a);
    if (row.b != kFixedFrame) bodies.apply(row.b, change * row.linear_b, change * row.angular_b);
  }
}

/// Uses the implicit spring of frequency w and damping ratio z over a step h:
/// rate = w / (2 z + h w), a = h w (2 z + h w), scale = a / (1 + a), leak = 1 / (1 + a).
template <class Real>
void IterativeJoints<Real>::begin_hold(Bodies<Real>& bodies, Real h) {
  place(bodies);
  constexpr double kTwoPi = 6.283185307179586;
  constexpr double kPhase = kTwoPi * constants::kJointFrequencyShare;  // h w
  constexpr double kSum = 2 * constants::kJointDampingRatio + kPhase;
  spring_ = {Real(kPhase / kSum) / h, Real(kPhase * kSum / (1 + kPhase * kSum)),
             Real(1 / (1 + kPhase * kSum))};
  warm_start(bodies, hold_impulses());
}

template <class Real>
void IterativeJoints<Real>::sweep_hold(Bodies<Real>& bodies, Real) {
  sweep(bodies, spring_, hold_impulses());
}

template <class Real>
void IterativeJoints<Real>::begin_relax(Bodies<Real>& bodies) {
  place(bodies);
  warm_start(bodies, relax_impulses());
}

template <class Real>
void IterativeJoints<Real>::sweep_relax(Bodies<Real>& bodies) {
  sweep(bodies, Spring{}, relax_impulses());
}

template <class Real>
void IterativeJoints<Real>::begin_follow(Bodies<Real>& bodies, Real h) {
  place(bodies);
  spring_ = {Real(constants::kJointFeedback) / h, Real{1}, Real{0}};
  warm_start(bodies, hold_impulses());
}

template <class Real>
void IterativeJoints<Real>::sweep_follow(Bodies<Real>& bodies) {
  sweep(bodies, spring_, hold_impulses());
}

template <class Real>
void IterativeJoints<Real>::forget() {
  std::fill(impulses_.begin(), impulses_.end(), Real{0});
}

template class IterativeJoints<float>;
template class IterativeJoints<double>;

}  // namespace plumb
