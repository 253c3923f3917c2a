#include "engine/collision/distance/time_of_impact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/distance/hull_distance.h"
#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

constexpr double kSweepRounding = 4 * std::numeric_limits<double>::epsilon();

/// Returns q r: the rotation by both angles.
constexpr Rotation<double> composed(Rotation<double> q, Rotation<double> r) {
  return {q.c * r.c - q.s * r.s, q.s * r.c + q.c * r.s};
}

Rotation<double> rotated_by(double angle, Rotation<double> start) {
  return angle != 0 ? composed(rotation_of(angle), start) : start;
}

/// Normalises in double precision: a rotation in float is of unit length only to a float's rounding.
template <class Real>
Rotation<double> unit(Rotation<Real> q) {
  const double c = static_cast<double>(q.c), s = static_cast<double>(q.s), length = std::sqrt(c * c + s * s);
  return {c / length, s / length};
}

/// A shape that rotates during the interval.
template <class Real>
struct RotatingShape {
  const Convex<Real>& shape;
  Rotation<double> start;
  double delta_angle;
  double extent;  ///< m, from the centre of rotation to the farthest corner

  template <class Moving>
  RotatingShape(const Convex<Real>& convex, const Sweep<Moving>& sweep)
      : shape(convex),
        start(unit(sweep.start_rotation)),
        delta_angle(static_cast<double>(sweep.delta_angle)),
        extent(corner_extent(convex)) {}
  Vec2d corner(int i) const { return shape.corners[i].point.template as<double>(); }
  Rotation<double> rotation(double fraction) const { return rotated_by(fraction * delta_angle, start); }
};

/// x + v t - c t^2 / 2 with c >= 0: a lower bound of a separation for t >= 0.
struct Bound {
  double value = 0, slope = 0, curvature = 0;

  double at(double t) const { return value + t * (slope - 0.5 * curvature * t); }
  friend Bound operator+(Bound a, Bound b) {
    return {a.value + b.value, a.slope + b.slope, a.curvature + b.curvature};
  }
  /// Returns how long the bound stays >= 0; 0 if it is not > 0 at the start.
  double root() const {
    if (!(value > 0)) return 0;
    const double fall = std::sqrt(slope * slope + 2 * curvature * value) - slope;
    return fall > 0 ? 2 * value / fall : std::numeric_limits<double>::infinity();
  }
};

/// Relative motion of two shapes, with a's centre as origin and the world's axes.
template <class Real>
class Approach {
 public:
  template <class Moving>
  Approach(const Convex<Real>& a, const Sweep<Moving>& sweep_a, const Convex<Real>& b,
           const Sweep<Moving>& sweep_b)
      : a_(a, sweep_a),
        b_(b, sweep_b),
        start_(sweep_b.start.template as<double>() - sweep_a.start.template as<double>()),
        motion_(sweep_b.motion.template as<double>() - sweep_a.motion.template as<double>()),
        curve_(sweep_b.curve.template as<double>() - sweep_a.curve.template as<double>()),
        speed_(std::sqrt(length_squared(motion_))),
        bend_(std::sqrt(length_squared(curve_))),
        radius_(static_cast<double>(a.radius) + static_cast<double>(b.radius)) {}

  /// Returns a bound (m) of the rounding error of a separation up to a fraction.
  double rounding(double fraction) const {
    const double max_displacement =
        speed_ + bend_ + std::abs(a_.delta_angle) * a_.extent + std::abs(b_.delta_angle) * b_.extent;
    return kSweepRounding * (std::abs(start_.x) + std::abs(start_.y) + fraction * max_displacement +
                             a_.extent + b_.extent + radius_);
  }

  /// Computes the separation of the surfaces at a fraction. Points and normal of `hulls()` are in the world's
  /// directions.
  double measure(double fraction) {
    fraction_ = fraction;
    rotation_a_ = a_.rotation(fraction);
    rotation_b_ = b_.rotation(fraction);
    between_ = start_ + fraction * (motion_ + fraction * curve_);
    velocity_ = motion_ + (2 * fraction) * curve_;
    const Rotation<double> back = rotation_a_.inverse();
    hulls_ = hull_distance(a_.shape, b_.shape, {back * between_, composed(back, rotation_b_)}, &cache_);
    hulls_.normal = rotation_a_ * hulls_.normal;
    hulls_.point_a = rotation_a_ * hulls_.point_a;
    hulls_.point_b = rotation_a_ * hulls_.point_b;
    return hulls_.separation - radius_;
  }
  const HullDistance& hulls() const { return hulls_; }

  /// Computes the part of 0 .. 1 in which the circles swept by the rotating shapes are closer than
  /// `separation`. Returns false when there is none.
  bool window(double separation, double& first, double& last) const;

  /// Returns a duration after the last measured time, up to `remaining`, during which the shapes stay at
  /// least `separation` apart. Near an edge, the edge's normal, which rotates with it, gives the longest
  /// step: all points of the edge have the same height along it.
  double safe_step(double separation, double remaining) const {
    const bool with_a = a_.delta_angle != 0 && cache_.edge_of_a();
    const bool with_b = b_.delta_angle != 0 && cache_.edge_of_b();
    double step = 0;
    if (with_a) step = safe_step(separation, remaining, a_.delta_angle);
    if (with_b && step < remaining) step = std::max(step, safe_step(separation, remaining, b_.delta_angle));
    if (!with_a && !with_b) step = safe_step(separation, remaining, 0);
    return step;
  }

 private:
  double safe_step(double separation, double remaining, double axis_rate) const;
  Bound lowest(const RotatingShape<Real>& body, Rotation<double> rotation, Vec2d normal, double rate,
               double t) const;

  RotatingShape<Real> a_, b_;
  Vec2d start_, motion_, curve_;
  double speed_, bend_, radius_;
  SimplexCache cache_;
  double fraction_ = 0;
  Rotation<double> rotation_a_, rotation_b_;
  Vec2d between_, velocity_;  // the latter in m an interval
  HullDistance hulls_;
};

template <class Real>
bool Approach<Real>::window(double separation, double& first, double& last) const {
  first = 0, last = 1;
  const double distance =
      (a_.extent + b_.extent + radius_ + separation + bend_ + 2 * rounding(1)) * (1 + kSweepRounding);
  if (!(speed_ > 0)) return length_squared(start_) <= distance * distance;
  const double across = cross(motion_, start_) / speed_, along = -dot(start_, motion_) / speed_;
  if (std::abs(across) > distance) return false;
  const double half = std::sqrt(distance * distance - across * across);
  const double slack = kSweepRounding * (std::abs(along) + half);
  first = std::max(0.0, (along - half - slack) / speed_);
  last = std::min(1.0, (along + half + slack) / speed_);
  return first <= last;
}

/// Returns a lower bound of normal . corner over all corners: the least at `t`. The normal rotates too;
/// `rate` is the body's angular speed relative to it. normal . r = |r| cos(angle + rate t), whose second
/// derivative is never less than -rate^2 |r|. To first order it is r . (normal + t normal'), so the lowest
/// corner is a support point in that direction.
template <class Real>
Bound Approach<Real>::lowest(const RotatingShape<Real>& body, Rotation<double> rotation, Vec2d normal,
                             double rate, double t) const {
  const Vec2d local = rotation.inverse() * normal, change = -rate * perpendicular(local);
  const Vec2d r = body.corner(farthest_corner(body.shape, -(local + t * change)));
  return {dot(local, r), dot(change, r), rate * rate * body.extent};
}

/// A separation along a normal that rotates by `axis_rate` is at most the distance. It is the minimum over
/// pairs of corners, and each pair's separation is bounded from below by a parabola that opens downwards. A
/// pair that is far enough apart at t was so before, so only pairs that fail at t matter.
template <class Real>
double Approach<Real>::safe_step(double separation, double remaining, double axis_rate) const {
  constexpr int kMaxRounds = 32;
  const Vec2d normal = hulls_.normal;
  // n . P with P' = V and V' = A: (n . P)'' = n . A + 2 n' . V - w^2 n . P.
  const double farthest = bend_ + std::max(std::sqrt(length_squared(between_)),
                                           std::sqrt(length_squared(between_ + remaining * velocity_)));
  const double fastest_centers = speed_ + 2 * bend_;
  const double pull = axis_rate != 0 ? 2 * bend_ : std::max(0.0, -2 * dot(normal, curve_));
  const Bound centers{dot(normal, between_) - radius_ - separation,
                      dot(normal, velocity_) + axis_rate * cross(normal, between_),
                      pull + std::abs(axis_rate) * (2 * fastest_centers + std::abs(axis_rate) * farthest)};
  double step = remaining;
  for (int round = 0; round < kMaxRounds; ++round) {
    const Bound total = centers + lowest(b_, rotation_b_, normal, b_.delta_angle - axis_rate, step) +
                        lowest(a_, rotation_a_, -normal, a_.delta_angle - axis_rate, step);
    if (total.at(step) >= 0) return step;
    const double root = total.root();
    if (!(root < step)) return step;  // at the root already, but for roundings
    step = root;
  }
  // Too many pairs of corners were tried: fall back to the first-order bound, with the speed of the fastest
  // point of either shape.
  const double gap = hulls_.separation - radius_ - separation;
  const double fastest = std::max(0.0, -dot(normal, velocity_)) + 2 * bend_ +
                         std::abs(a_.delta_angle) * a_.extent + std::abs(b_.delta_angle) * b_.extent;
  return gap > 0 && fastest > 0 ? std::min(gap / fastest, remaining) : 0;
}

template <class Real>
Real rounded_down(double fraction) {
  const Real nearest = static_cast<Real>(fraction);
  return static_cast<double>(nearest) > fraction ? std::nextafter(nearest, Real{0}) : nearest;
}

}  // namespace

template <class Real>
Pose<Real> pose_at(const Sweep<Real>& sweep, double fraction) {
  const Vec2d position =
      sweep.start.template as<double>() +
      fraction * (sweep.motion.template as<double>() + fraction * sweep.curve.template as<double>());
  const Rotation<double> q =
      rotated_by(fraction * static_cast<double>(sweep.delta_angle), unit(sweep.start_rotation));
  return {position.template as<Real>(), {static_cast<Real>(q.c), static_cast<Real>(q.s)}};
}

// Conservative advancement (Mirtich, 1996): from a time at which the shapes are apart, advance for as long as
// a bound shows that they stay apart. The bound is of second order, so that near an impact the steps are
// those of Newton's method.
template <class Real, class Moving>
ImpactResult<Real> time_of_impact(const Convex<Real>& a, const Sweep<Moving>& sweep_a, const Convex<Real>& b,
                                  const Sweep<Moving>& sweep_b, Real target_separation, Real tolerance,
                                  int most_iterations) {
  using State = typename ImpactResult<Real>::State;
  Approach<Real> approach(a, sweep_a, b, sweep_b);
  double target = std::max(0.0, static_cast<double>(target_separation));
  double slack = std::max(static_cast<double>(tolerance), approach.rounding(1));
  ImpactResult<Real> result;
  double fraction = 0, last = 1;
  if (!approach.window(target + slack, fraction, last)) return result;

  double separation = approach.measure(fraction);
  const auto finish = [&](State state) {
    result.state = state;
    result.exact_fraction = fraction;
    result.fraction = rounded_down<Real>(fraction);
    const HullDistance& hulls = approach.hulls();
    const Vec2d center_a =
        sweep_a.start.template as<double>() +
        fraction * (sweep_a.motion.template as<double>() + fraction * sweep_a.curve.template as<double>());
    const Vec2d middle =
        0.5 * (hulls.point_a + hulls.point_b +
               (static_cast<double>(a.radius) - static_cast<double>(b.radius)) * hulls.normal);
    result.point = (center_a + middle).template as<Real>();
    result.normal = hulls.normal.template as<Real>();
    return result;
  };
  if (!(fraction > 0)) {
    if (separation <= approach.rounding(0)) return finish(State::Overlapped);
    if (separation <= target + slack) {
      target = 0.5 * separation;
      slack = 0.25 * separation;
    }
  }

  // Steps aim slightly farther out than the target, because the last one ends with a rounding.
  const double aim = target + 0.25 * slack;
  while (separation > target + slack) {
    if (result.iterations >= most_iterations) return finish(State::Failed);
    ++result.iterations;
    const double step = approach.safe_step(aim, last - fraction);
    const double next = fraction + step;
    if (next >= last) return {State::Separated, 1, 1, {}, {}, result.iterations};
    if (next <= fraction) break;  // the step is below the resolution of time
    fraction = next;
    separation = approach.measure(fraction);
  }
  return finish(State::Hit);
}

#define PLUMB_INSTANTIATE(Real, Moving)                                                                      \
  template ImpactResult<Real> time_of_impact(const Convex<Real>&, const Sweep<Moving>&, const Convex<Real>&, \
                                             const Sweep<Moving>&, Real, Real, int);
PLUMB_INSTANTIATE(float, float)
PLUMB_INSTANTIATE(float, double)
PLUMB_INSTANTIATE(double, double)
#undef PLUMB_INSTANTIATE

template Pose<float> pose_at(const Sweep<float>&, double);
template Pose<double> pose_at(const Sweep<double>&, double);

}  // namespace plumb
