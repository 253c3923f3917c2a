#include "engine/realtime/direct_joints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/realtime/constants.h"

namespace plumb {
namespace {

template <class Real>
std::vector<Row<Real>> rows_at(const Joints<Real>& joints, const Bodies<Real>& bodies) {
  std::vector<Row<Real>> rows(joints.row_count());
  joints.rows(bodies.pose, bodies.twist, rows);
  return rows;
}

/// Returns J v of one row.
template <class Real>
Real rate(const Row<Real>& row, std::span<const Twist<Real>> twists) {
  Real out = 0;
  if (row.a != kFixedFrame)
    out += dot(row.linear_a, twists[row.a].velocity) + row.angular_a * twists[row.a].angular_velocity;
  if (row.b != kFixedFrame)
    out += dot(row.linear_b, twists[row.b].velocity) + row.angular_b * twists[row.b].angular_velocity;
  return out;
}

}  // namespace

template <class Real>
DirectJoints<Real>::DirectJoints(const Scene& scene, const Bodies<Real>& bodies)
    : joints_(compile_joints<Real>(scene)),
      rows_(rows_at(joints_, bodies)),
      ahead_(rows_.size()),
      kept_gap_(rows_.size()),
      feedback_(rows_.size()),
      right_side_(rows_.size()),
      multiplier_(rows_.size()),
      arrival_(bodies.pose),
      jointed_(bodies.size(), 0),
      system_(rows_, bodies.inverse_mass, bodies.inverse_inertia) {
  for (const Row<Real>& row : rows_)
    for (const int body : {row.a, row.b})
      if (body != kFixedFrame) jointed_[body] = 1;
  const auto span = [](const auto& joint) {
    return std::sqrt(std::max(length_squared(joint.anchor_a), length_squared(joint.anchor_b)));
  };
  for (const Revolute<Real>& joint : joints_.revolute) span_.insert(span_.end(), 2, span(joint));
  for (const Distance<Real>& joint : joints_.distance) span_.push_back(std::max(span(joint), joint.length));
  for (std::size_t body = 0; body < bodies.size(); ++body)
    if (jointed_[body]) moving_.push_back(static_cast<int>(body));
}

template <class Real>
void DirectJoints<Real>::factor(const Bodies<Real>& bodies) {
  joints_.rows(bodies.pose, bodies.twist, rows_);
  system_.factor(rows_);
  factored_ = true;
}

/// v += sign M^-1 J^T multiplier.
template <class Real>
void DirectJoints<Real>::apply(const Bodies<Real>& bodies, std::span<Twist<Real>> twists, Real sign) const {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row<Real>& row = rows_[i];
    const Real impulse = sign * multiplier_[i];
    const auto kick = [&](int body, Vec2<Real> linear, Real angular) {
      if (body == kFixedFrame) return;
      twists[body].velocity += (bodies.inverse_mass[body] * impulse) * linear;
      twists[body].angular_velocity += (bodies.inverse_inertia[body] * impulse) * angular;
    };
    kick(row.a, row.linear_a, row.angular_a);
    kick(row.b, row.linear_b, row.angular_b);
  }
}

template <class Real>
void DirectJoints<Real>::project(const Bodies<Real>& bodies, std::span<Twist<Real>> twists) {
  for (std::size_t i = 0; i < rows_.size(); ++i) right_side_[i] = -rate<Real>(rows_[i], twists);
  multiplier_ = right_side_;
  system_.solve(multiplier_);
  system_.refine(rows_, right_side_, multiplier_);
  apply(bodies, twists, Real{1});
}

template <class Real>
void DirectJoints<Real>::begin_substep(const Bodies<Real>& bodies, Real h) {
  if (!factored_) factor(bodies);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Real most = Real(constants::kGapSpeed) * h * span_[i];
    const Real gap = rows_[i].residual;
    kept_gap_[i] = span_[i] > 0 ? gap - std::clamp(gap, -most, most) : Real{0};
  }
}

/// Returns the largest gap at the predicted positions: C(x + h v).
template <class Real>
Real DirectJoints<Real>::predict_gap(const Bodies<Real>& bodies, Real h) {
  for (const int body : moving_) {
    const Twist<Real>& twist = bodies.twist[body];
    const Real turn = h * twist.angular_velocity;
    arrival_[body].position = bodies.pose[body].position + h * twist.velocity;
    arrival_[body].rotation = turn == 0 ? bodies.pose[body].rotation : rotation_of(bodies.angle[body] + turn);
  }
  joints_.rows(arrival_, bodies.twist, ahead_);
  Real largest = 0;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    right_side_[i] = kept_gap_[i] - ahead_[i].residual;
    largest = std::max(largest, std::abs(right_side_[i]));
  }
  return largest;
}

/// Makes one quasi-Newton correction: h J M^-1 J^T lambda = -C.
template <class Real>
void DirectJoints<Real>::correct(Bodies<Real>& bodies, Real h) {
  for (std::size_t i = 0; i < rows_.size(); ++i) multiplier_[i] = right_side_[i] / h;
  system_.solve(multiplier_);
  apply(bodies, bodies.twist, Real{1});
}

template <class Real>
void DirectJoints<Real>::sweep_hold(Bodies<Real>& bodies, Real h) {
  predict_gap(bodies, h);
  correct(bodies, h);
}

template <class Real>
void DirectJoints<Real>::finish_hold(Bodies<Real>& bodies, Real h) {
  Real largest = 0;
  for (const int body : moving_) {
    const Vec2<Real> position = bodies.pose[body].position;
    largest = std::max({largest, std::abs(position.x), std::abs(position.y)});
  }
  for (const Real span : span_) largest = std::max(largest, span);
  const Real rounding = 4 * std::numeric_limits<Real>::epsilon() * largest;

  Real before = std::numeric_limits<Real>::infinity();
  for (int k = 0; k < constants::kPositionCorrections; ++k) {
    const Real gap = predict_gap(bodies, h);
    if (gap <= rounding) return;
    if (!(gap < before)) {
      if (gap > 2 * before)
        apply(bodies, bodies.twist, Real{-1});  // undo the last correction, which increased the gap
      return;
    }
    correct(bodies, h);
    before = gap;
  }
}

/// Corrects positions, x += M^-1 J^T lambda with J M^-1 J^T lambda = -C; J is that at the start of the
/// substep.
template <class Real>
void DirectJoints<Real>::settle(Bodies<Real>& bodies) {
  for (int k = 0; k < constants::kSettlings; ++k) {
    joints_.rows(bodies.pose, bodies.twist, ahead_);
    for (std::size_t i = 0; i < rows_.size(); ++i) multiplier_[i] = kept_gap_[i] - ahead_[i].residual;
    system_.solve(multiplier_);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Row<Real>& row = rows_[i];
      if (row.a != kFixedFrame)
        bodies.move(row.a, multiplier_[i] * row.linear_a, multiplier_[i] * row.angular_a);
      if (row.b != kFixedFrame)
        bodies.move(row.b, multiplier_[i] * row.linear_b, multiplier_[i] * row.angular_b);
    }
  }
}

template <class Real>
void DirectJoints<Real>::begin_relax(Bodies<Real>& bodies) {
  factor(bodies);
}

template <class Real>
void DirectJoints<Real>::sweep_relax(Bodies<Real>& bodies) {
  project(bodies, bodies.twist);
}

template <class Real>
void DirectJoints<Real>::begin_follow(Bodies<Real>& bodies, Real h) {
  factor(bodies);
  for (std::size_t i = 0; i < rows_.size(); ++i)
    feedback_[i] = -(Real(constants::kJointFeedback) / h) * rows_[i].residual;
}

/// Solves J v = -feedback C / h.
template <class Real>
void DirectJoints<Real>::sweep_follow(Bodies<Real>& bodies) {
  for (std::size_t i = 0; i < rows_.size(); ++i)
    multiplier_[i] = feedback_[i] - rate<Real>(rows_[i], bodies.twist);
  system_.solve(multiplier_);
  apply(bodies, bodies.twist, Real{1});
}

template <class Real>
void DirectJoints<Real>::pass_on(const Bodies<Real>& bodies, std::span<Twist<Real>> jump) {
  project(bodies, jump);
}

template class DirectJoints<float>;
template class DirectJoints<double>;

}  // namespace plumb
