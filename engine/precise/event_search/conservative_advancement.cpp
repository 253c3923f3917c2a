#include "engine/precise/event_search/conservative_advancement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/text.h"
#include "engine/scene/error.h"

namespace plumb::precise {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct View {
  const FeatureShape &a, &b;
  StepMotionBounds::BodyMotion at_a, at_b;
};

struct CornerMotion {
  Vec2d position, velocity;
};
CornerMotion corner_motion(const FeatureShape& o, int corner, const StepMotionBounds::BodyMotion& at) {
  const Vec2d arm = at.pose.rotation * o.corners[corner].point;
  return {at.pose.position + arm, at.twist.velocity + cross(at.twist.angular_velocity, arm)};
}

/// Returns the time for which all corners stay above an edge of `e`: f = n . (c - p), where the normal n
/// turns with the edge. With the corner's motion relative to the edge's body, and r from that body's centre,
/// f'' = n . r'' + 2 w t . r' + (dw/dt) t . r - w^2 n . r.
double edge_safe_time(const View& v, const StepMotionBounds& bounds, bool of_a, int edge, double left) {
  const FeatureShape &e = of_a ? v.a : v.b, &c = of_a ? v.b : v.a;
  const StepMotionBounds::BodyMotion &at_e = of_a ? v.at_a : v.at_b, &at_c = of_a ? v.at_b : v.at_a;
  const StepMotionBounds::RotationBounds rotation_e = bounds.rotation_bounds(e.body),
                                         rotation_c = bounds.rotation_bounds(c.body);
  const StepMotionBounds::Relative relative = bounds.relative(c.body, e.body);
  const double speed = relative.speed + rotation_c.speed * c.extent;
  const double acceleration =
      relative.acceleration + (rotation_c.acceleration + rotation_c.speed * rotation_c.speed) * c.extent;
  const double distance = length(at_c.pose.position - at_e.pose.position) + c.extent + left * speed;
  const double fall = acceleration + 2 * rotation_e.speed * speed +
                      (rotation_e.acceleration + rotation_e.speed * rotation_e.speed) * distance;
  const Vec2d n = at_e.pose.rotation * e.corners[edge].normal;
  const CornerMotion start = corner_motion(e, edge, at_e);
  double shortest_time = kInfinity;
  for (int k = 0; k < c.count(); ++k) {
    const CornerMotion corner = corner_motion(c, k, at_c);
    const double f = dot(n, corner.position - start.position) - v.a.radius - v.b.radius;
    // The velocity of the edge's body at the foot of the corner.
    const Vec2d edge_velocity =
        at_e.twist.velocity + cross(at_e.twist.angular_velocity, corner.position - at_e.pose.position);
    shortest_time =
        std::min(shortest_time, time_above_zero(f, dot(n, corner.velocity - edge_velocity), fall));
  }
  return shortest_time;
}

/// Does the same along a fixed direction, for every corner of b over every corner of a.
double direction_safe_time(const View& v, const StepMotionBounds& bounds, Vec2d n) {
  const auto rotation_bound = [&](const FeatureShape& o) {
    const StepMotionBounds::RotationBounds rotation = bounds.rotation_bounds(o.body);
    return (rotation.acceleration + rotation.speed * rotation.speed) * o.extent;
  };
  const double fall =
      bounds.relative(v.a.body, v.b.body).acceleration + rotation_bound(v.a) + rotation_bound(v.b);
  double shortest_time = kInfinity;
  for (int i = 0; i < v.a.count(); ++i) {
    const CornerMotion p = corner_motion(v.a, i, v.at_a);
    for (int j = 0; j < v.b.count(); ++j) {
      const CornerMotion q = corner_motion(v.b, j, v.at_b);
      const double f = dot(n, q.position - p.position) - v.a.radius - v.b.radius;
      shortest_time = std::min(shortest_time, time_above_zero(f, dot(n, q.velocity - p.velocity), fall));
    }
  }
  return shortest_time;
}

}  // namespace

double time_above_zero(double f, double rate, double max_fall) {
  if (!(f > 0)) return 0;
  if (max_fall <= 0) return rate < 0 ? f / -rate : kInfinity;
  const double root = std::sqrt(rate * rate + 2 * max_fall * f);
  return rate > 0 ? (rate + root) / max_fall : 2 * f / (root - rate);
}

double ConservativeAdvancement::distance(const ShapePair& pair, double time) const {
  const FeatureShape &a = shapes_[pair.a], &b = shapes_[pair.b];
  return separation(a, bounds_.at(a.body, time).pose, b, bounds_.at(b.body, time).pose).distance;
}

std::optional<double> ConservativeAdvancement::first_touch(const ShapePair& pair, double from, double until,
                                                           double tolerance) const {
  const FeatureShape &a = shapes_[pair.a], &b = shapes_[pair.b];
  double time = from;
  for (long i = 0;; ++i) {
    const View view{a, b, bounds_.at(a.body, time), bounds_.at(b.body, time)};
    const Separation apart = separation(a, view.at_a.pose, b, view.at_b.pose);
    if (apart.distance <= tolerance) return time;
    if (i == max_steps_)
      throw Error(Error::Kind::Run, "contact search", "steps", std::to_string(max_steps_) + " and more",
                  "two bodies move past each other too fast or too close for the step: a smaller max_dt or "
                  "Realtime may do");
    double step = 0;
    if (apart.feature.kind == Feature::Kind::Corners) {
      step = direction_safe_time(view, bounds_, apart.normal);
    } else {
      const bool of_a = apart.feature.kind == Feature::Kind::CornerOfB;
      step = edge_safe_time(view, bounds_, of_a, of_a ? apart.feature.a : apart.feature.b, until - time);
    }
    const double next = time + step;
    if (!(next < until)) {
      // No contact before the step's end; the state there is known.
      return time < until && distance(pair, until) <= tolerance ? std::optional(until) : std::nullopt;
    }
    time = next > time ? next : std::nextafter(time, until);
  }
}

ConservativeAdvancement::Departure ConservativeAdvancement::departure(const ShapePair& pair, double until,
                                                                      double tolerance,
                                                                      Overlap overlap) const {
  constexpr int kSamples = 14;
  Departure found;
  const double start = bounds_.start(), h = until - start;
  const double deepest = std::min(distance(pair, start), 0.0) - tolerance;
  double before = start, fraction = 1;
  for (int i = 0; i < kSamples; ++i) fraction *= 0.25;
  for (int i = 0; i <= kSamples; ++i, fraction *= 4) {
    const double time = i == kSamples ? until : start + fraction * h;
    if (!(time > before)) continue;
    const double d = distance(pair, time);
    if (d > tolerance) {
      found.apart = time;
      return found;
    }
    if (overlap == Overlap::Pressed && d < deepest) {
      // Find the first time at which the gap has this value, to rounding.
      double low = before, high = time;
      for (double middle = 0.5 * (low + high); low < middle && middle < high; middle = 0.5 * (low + high)) {
        (distance(pair, middle) < deepest ? high : low) = middle;
      }
      found.pressed = high;
      return found;
    }
    before = time;
  }
  return found;
}

}  // namespace plumb::precise
