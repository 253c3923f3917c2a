#include "engine/precise/event_search/motion_bounds.h"

#include <algorithm>
#include <cmath>

#include "engine/math/trigonometry.h"

namespace plumb::precise {
namespace {

/// Fraction by which bounds are widened: positions and velocities are separate polynomials that agree only to
/// the step's error.
constexpr double kMargin = 1e-3;

}  // namespace

StepMotionBounds::StepMotionBounds(const BallisticMotion& ballistic, std::span<const std::size_t> integrated,
                                   std::size_t bodies)
    : ballistic_(ballistic), slot_(bodies, -1), paths_(bodies), rotation_bounds_(bodies) {
  for (std::size_t slot = 0; slot < integrated.size(); ++slot)
    slot_[integrated[slot]] = static_cast<int>(slot);
}

void StepMotionBounds::update(EventFreeIntegrator& motion) {
  motion_ = &motion;
  start_ = motion.start();
  end_ = motion.time();
  for (std::size_t body = 0; body < slot_.size(); ++body) {
    if (slot_[body] >= 0) {
      bound_integrated(body, slot_[body], motion);
    } else {
      bound_parabola(body, ballistic_.at(body, start_).state, ballistic_.at(body, end_).state);
    }
  }
}

StepMotionBounds::BodyMotion StepMotionBounds::at(std::size_t body, double time) const {
  BodyState now;
  if (slot_[body] < 0) {
    now = ballistic_.at(body, time).state;
  } else if (time >= end_) {
    now = EquationsOfMotion::state(motion_->state().value(), static_cast<std::size_t>(slot_[body]));
  } else {
    now = EquationsOfMotion::state(motion_->state_at_start().value(), static_cast<std::size_t>(slot_[body]));
    if (time > start_) {
      const StepPolynomial& path = motion_->polynomial();
      const double s = (time - start_) / (end_ - start_);
      const std::size_t first = EquationsOfMotion::kPerBody * static_cast<std::size_t>(slot_[body]);
      now.position += Vec2d{path.at(s, first), path.at(s, first + 1)};
      now.angle += path.at(s, first + 2);
      now.velocity += Vec2d{path.at(s, first + 3), path.at(s, first + 4)};
      now.angular_velocity += path.at(s, first + 5);
    }
  }
  return {{now.position, rotation_of(now.angle)}, {now.velocity, now.angular_velocity}};
}

void StepMotionBounds::bound_integrated(std::size_t body, int slot, EventFreeIntegrator& motion) {
  const BodyState from =
      EquationsOfMotion::state(motion.state_at_start().value(), static_cast<std::size_t>(slot));
  const StepPolynomial& path = motion.polynomial();
  if (path.degree() == 2) {
    bound_parabola(body, from,
                   EquationsOfMotion::state(motion.state().value(), static_cast<std::size_t>(slot)));
    return;
  }
  const std::size_t first = EquationsOfMotion::kPerBody * static_cast<std::size_t>(slot);
  const auto range = [](const Bernstein<kControls>& c) {
    const auto [low, high] = std::minmax_element(c.begin(), c.end());
    return std::pair{*low, *high};
  };
  const auto [left, right] = range(path.bernstein(first));
  const auto [bottom, top] = range(path.bernstein(first + 1));
  const auto [back, forth] = range(path.bernstein(first + 2));
  Path& p = paths_[body];
  p.hull = {from.position + Vec2d{left, bottom}, from.position + Vec2d{right, top}};
  p.max_rotation = std::max(-back, forth);
  p.vx = path.bernstein(first + 3);
  p.vy = path.bernstein(first + 4);
  for (std::size_t j = 0; j < kControls; ++j) p.vx[j] += from.velocity.x, p.vy[j] += from.velocity.y;
  const Bernstein<kControls> spin = path.bernstein(first + 5);
  RotationBounds& rotation = rotation_bounds_[body] = {};
  for (std::size_t j = 0; j < kControls; ++j) {
    rotation.speed = std::max(rotation.speed, std::abs(from.angular_velocity + spin[j]));
    if (j + 1 == kControls) break;
    rotation.acceleration =
        std::max(rotation.acceleration, (kControls - 1) * std::abs(spin[j + 1] - spin[j]) / (end_ - start_));
  }
  rotation.speed *= 1 + kMargin;
  rotation.acceleration *= 1 + kMargin;
}

void StepMotionBounds::bound_parabola(std::size_t body, const BodyState& from, const BodyState& to) {
  Path& p = paths_[body];
  const double h = end_ - start_;
  // The control points of a parabola in Bernstein form: its ends, and the intersection of its end tangents.
  const Vec2d a = from.position, b = to.position, middle = a + (0.5 * h) * from.velocity;
  p.hull = {{std::min({a.x, b.x, middle.x}), std::min({a.y, b.y, middle.y})},
            {std::max({a.x, b.x, middle.x}), std::max({a.y, b.y, middle.y})}};
  const double max_speed = std::max(std::abs(from.angular_velocity), std::abs(to.angular_velocity));
  p.max_rotation = max_speed * h;
  for (std::size_t j = 0; j < kControls; ++j) {
    const double share = static_cast<double>(j) / (kControls - 1);
    const Vec2d v = (1 - share) * from.velocity + share * to.velocity;
    p.vx[j] = v.x, p.vy[j] = v.y;
  }
  rotation_bounds_[body] = {max_speed * (1 + kMargin),
                            std::abs(to.angular_velocity - from.angular_velocity) / h * (1 + kMargin)};
}

StepMotionBounds::Relative StepMotionBounds::relative(std::size_t a, std::size_t b) const {
  return relative_bounds(paths_[a], paths_[b]);
}

StepMotionBounds::Relative StepMotionBounds::relative_of(int a, int b) const {
  const Path fixed;
  return relative_bounds(a == kFixedFrame ? fixed : paths_[static_cast<std::size_t>(a)],
                         b == kFixedFrame ? fixed : paths_[static_cast<std::size_t>(b)]);
}

StepMotionBounds::Relative StepMotionBounds::relative_bounds(const Path& p, const Path& q) const {
  Relative most;
  const auto velocity = [&](std::size_t j) { return Vec2d{p.vx[j] - q.vx[j], p.vy[j] - q.vy[j]}; };
  for (std::size_t j = 0; j < kControls; ++j) {
    most.speed = std::max(most.speed, length(velocity(j)));
    if (j + 1 < kControls)
      most.acceleration = std::max(most.acceleration, length(velocity(j + 1) - velocity(j)));
  }
  most.acceleration *= (kControls - 1) / (end_ - start_);
  most.speed *= 1 + kMargin;
  most.acceleration *= 1 + kMargin;
  return most;
}

Aabb<double> StepMotionBounds::swept(const FeatureShape& shape) const {
  const Path& path = paths_[shape.body];
  const Pose<double> pose = at(shape.body, start_).pose;
  Aabb<double> box{{1e300, 1e300}, {-1e300, -1e300}};
  for (const Corner<double>& corner : shape.corners) {
    const Vec2d p = pose.rotation * corner.point;
    box = merged(box, {p, p});
  }
  const double extent = shape.extent;
  box = box.grown(std::min(path.max_rotation, 2.0) * extent);
  const double noise = 1e-12 * (extent + shape.radius + length(path.hull.lower) + length(path.hull.upper));
  return Aabb<double>{path.hull.lower + box.lower, path.hull.upper + box.upper}.grown(shape.radius + noise);
}

}  // namespace plumb::precise
