#include "engine/forces/force_jacobian.h"

#include <cmath>
#include <string_view>
#include <variant>

#include "engine/forces/laws.h"

namespace plumb {
namespace {

struct Body2 {
  std::size_t index = 0;
  const Pose<double>& pose;
  const Twist<double>& twist;
};

/// Adds the blocks of one law.
struct Derivative {
  double time;
  Body2 body;
  std::vector<ForceBlock>& out;

  ForceBlock& block() const {
    out.push_back({body.index, body.index});
    return out.back();
  }

  // F = -c v.
  void operator()(const LinearDrag& law) const {
    ForceBlock& b = block();
    b.velocity[0][0] = b.velocity[1][1] = -law.coefficient;
  }

  // F = -c |v| v: dF/dv = -c (|v| 1 + v v^T / |v|).
  void operator()(const QuadraticDrag& law) const {
    ForceBlock& b = block();
    const Vec2d v = body.twist.velocity;
    const double speed = std::sqrt(length_squared(v)), c = law.coefficient;
    if (speed == 0) return;
    b.velocity[0][0] = -c * (speed + v.x * v.x / speed);
    b.velocity[1][1] = -c * (speed + v.y * v.y / speed);
    b.velocity[0][1] = b.velocity[1][0] = -c * v.x * v.y / speed;
  }

  // In the body's frame F turns with the body and its torque stays; in the world's F stays, and r x F changes
  // by (z x r) x F = -r . F.
  void operator()(const PointForce& law) const {
    ForceBlock& b = block();
    const double share = active_share(law.start, law.duration, time, time);
    if (law.frame == Frame::Body) {
      const Vec2d turned = share * perpendicular(body.pose.rotation * law.force);
      b.position[0][2] = turned.x;
      b.position[1][2] = turned.y;
    } else {
      b.position[2][2] = -share * dot(body.pose.rotation * law.point, law.force);
    }
  }

  void operator()(const Torque&) const {}
};

}  // namespace

ForceJacobian::ForceJacobian(const Scene& scene) {
  for (const ForceLaw& law : scene.forces) {
    laws_.push_back(
        {law, *find_body(scene, std::visit([](const auto& l) -> std::string_view { return l.body; }, law))});
  }
}

void ForceJacobian::evaluate(double time, std::span<const Pose<double>> poses,
                             std::span<const Twist<double>> twists, std::vector<ForceBlock>& out) const {
  out.clear();
  for (const Law& law : laws_) {
    std::visit(Derivative{time, {law.body, poses[law.body], twists[law.body]}, out}, law.law);
  }
}

}  // namespace plumb
