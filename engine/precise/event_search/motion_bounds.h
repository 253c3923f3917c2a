#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/geometry/aabb.h"
#include "engine/integrate/bernstein.h"
#include "engine/math/pose.h"
#include "engine/precise/dynamics/ballistic_motion.h"
#include "engine/precise/dynamics/feature_shape.h"
#include "engine/precise/integration/integrator.h"

namespace plumb::precise {

/// Motion of all bodies during one step, with bounds that hold throughout.
class StepMotionBounds {
 public:
  StepMotionBounds(const BallisticMotion& ballistic, std::span<const std::size_t> integrated,
                   std::size_t bodies);

  /// Bounds the motion of the last step of `motion`; valid until its next step.
  void update(EventFreeIntegrator& motion);

  double start() const { return start_; }
  double end() const { return end_; }

  struct BodyMotion {
    Pose<double> pose{};
    Twist<double> twist{};
  };
  BodyMotion at(std::size_t body, double time) const;

  /// Bounds over the step: on one body's rotation, and on the relative motion of two bodies.
  struct RotationBounds {
    double speed = 0;         ///< rad/s
    double acceleration = 0;  ///< rad/s^2
  };
  RotationBounds rotation_bounds(std::size_t body) const { return rotation_bounds_[body]; }
  struct Relative {
    double speed = 0;         ///< m/s
    double acceleration = 0;  ///< m/s^2
  };
  Relative relative(std::size_t a, std::size_t b) const;

  /// Does the same for a body that may be `kFixedFrame`.
  BodyMotion motion_of(int body, double time) const {
    return body == kFixedFrame ? BodyMotion{} : at(static_cast<std::size_t>(body), time);
  }
  RotationBounds rotation_bounds_of(int body) const {
    return body == kFixedFrame ? RotationBounds{} : rotation_bounds_[static_cast<std::size_t>(body)];
  }
  Relative relative_of(int a, int b) const;

  /// Returns a box that contains the shape during the step.
  Aabb<double> swept(const FeatureShape& shape) const;

 private:
  static constexpr std::size_t kControls = StepPolynomial::kMaxTerms + 1;
  struct Path {
    Bernstein<kControls> vx{}, vy{};
    Aabb<double> hull{};      // box of the path of the centre of mass
    double max_rotation = 0;  // rad, largest rotation away from the start
  };

  Relative relative_bounds(const Path& p, const Path& q) const;
  void bound_integrated(std::size_t body, int slot, EventFreeIntegrator& motion);
  void bound_parabola(std::size_t body, const BodyState& from, const BodyState& to);

  const BallisticMotion& ballistic_;
  std::vector<int> slot_;  // by body: its index among the integrated ones, or -1
  std::vector<Path> paths_;
  std::vector<RotationBounds> rotation_bounds_;
  EventFreeIntegrator* motion_ = nullptr;
  double start_ = 0, end_ = 0;
};

}  // namespace plumb::precise
