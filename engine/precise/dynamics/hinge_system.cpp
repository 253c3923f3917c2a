#include "engine/precise/dynamics/hinge_system.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plumb::precise {
namespace {

/// A pivot that has lost all but a few digits consists of rounding: its direction depends on others.
constexpr double kDependent = 4096 * std::numeric_limits<double>::epsilon();

}  // namespace

HingeSystem::HingeSystem(std::span<const HingePlace> order, const std::vector<Revolute>& hinges,
                         std::span<const double> inverse_mass, std::span<const double> inverse_inertia) {
  const auto of = [](std::span<const double> values, int body) {
    return body == kFixedFrame ? 0.0 : values[static_cast<std::size_t>(body)];
  };
  for (const HingePlace& place : order) {
    const Revolute& hinge = hinges[static_cast<std::size_t>(place.hinge)];
    nodes_.push_back({hinge.a, hinge.b, place.hinge, place.next, place.side == 1, place.next_side == 1,
                      of(inverse_mass, hinge.a), of(inverse_mass, hinge.b), of(inverse_inertia, hinge.a),
                      of(inverse_inertia, hinge.b), hinge.anchor_a, hinge.anchor_b, 0, 0});
  }
  blocks_.resize(nodes_.size());
  order_from_root();
  reorder_from_both_ends();
  for (Node& node : nodes_) {
    const double sign = node.side == node.next_side ? 1 : -1;
    node.shared_mass = sign * (node.side ? node.mass_b : node.mass_a);
    node.shared_inertia = sign * (node.side ? node.inertia_b : node.inertia_a);
  }
}

/// Reorders a single line so that it is eliminated from both ends alternately. Two short independent
/// recursions are faster than a long one, in which every step waits for the one before.
void HingeSystem::reorder_from_both_ends() {
  const int n = static_cast<int>(nodes_.size());
  for (int k = 0; k < n; ++k) {
    if (nodes_[k].next != (k + 1 < n ? k + 1 : -1)) return;
  }
  const auto place = [n](int k) { return k < (n + 1) / 2 ? 2 * k : 2 * (n - 1 - k) + 1; };
  std::vector<Node> reordered(nodes_.size());
  for (int k = 0; k < n; ++k) {
    Node node = nodes_[k];
    if (2 * k + 1 < n) {
      node.next = place(k + 1);
    } else if (2 * k == n - 1 || (n % 2 == 0 && 2 * k == n)) {
      node.next = -1;
    } else {
      node.next = place(k - 1);
      node.side = nodes_[k - 1].next_side, node.next_side = nodes_[k - 1].side;
    }
    reordered[static_cast<std::size_t>(place(k))] = node;
  }
  for (Step& step : steps_) step.node = static_cast<std::size_t>(place(static_cast<int>(step.node)));
  nodes_ = std::move(reordered);
}

/// Orders the hinges so that each has one body of known position, and one not yet known.
void HingeSystem::order_from_root() {
  int last = -1;
  for (const Node& node : nodes_) last = std::max({last, node.a, node.b});
  std::vector<char> known(static_cast<std::size_t>(last + 1), 0);
  const auto is_known = [&](int body, double mass, double inertia) {
    return body == kFixedFrame || (mass == 0 && inertia == 0) || known[static_cast<std::size_t>(body)] != 0;
  };
  std::vector<char> used(nodes_.size(), 0);
  for (bool found = true; found;) {
    found = false;
    for (std::size_t k = nodes_.size(); k-- > 0;) {
      const Node& node = nodes_[k];
      const bool a = is_known(node.a, node.mass_a, node.inertia_a);
      const bool b = is_known(node.b, node.mass_b, node.inertia_b);
      if (used[k] || a == b) continue;
      steps_.push_back({k, a});
      known[static_cast<std::size_t>(a ? node.b : node.a)] = 1;
      used[k] = 1;
      found = true;
    }
  }
  if (steps_.size() == nodes_.size()) return;
  steps_.clear();
  // A free mechanism is a tree if it has fewer hinges than bodies. Loops may become singular and are not
  // handled here.
  std::vector<char> moving(known.size(), 0);
  for (const Node& node : nodes_) {
    if (node.mass_a > 0 || node.inertia_a > 0) moving[static_cast<std::size_t>(node.a)] = 1;
    if (node.mass_b > 0 || node.inertia_b > 0) moving[static_cast<std::size_t>(node.b)] = 1;
  }
  if (nodes_.size() >= static_cast<std::size_t>(std::count(moving.begin(), moving.end(), 1))) nodes_.clear();
}

void HingeSystem::update(std::span<const Pose<double>> poses) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    Block& block = blocks_[k];
    const Vec2d a = node.a == kFixedFrame ? node.anchor_a : poses[node.a].rotation * node.anchor_a;
    const Vec2d b = node.b == kFixedFrame ? node.anchor_b : poses[node.b].rotation * node.anchor_b;
    const double mass = node.mass_a + node.mass_b;
    const Vec2d angular_a = node.inertia_a * a, angular_b = node.inertia_b * b;
    block.arm_a = a, block.arm_b = b;
    block.own_x = mass + (angular_a.y * a.y + angular_b.y * b.y);
    block.own_y = mass + (angular_a.x * a.x + angular_b.x * b.x);
    block.xx = block.own_x, block.yy = block.own_y;
    block.xy = -(angular_a.x * a.y + angular_b.x * b.y);
  }
}

Vec2d HingeSystem::gap(std::size_t k, std::span<const Pose<double>> poses) const {
  const Node& node = nodes_[k];
  const Vec2d a = node.a == kFixedFrame ? Vec2d{} : poses[node.a].position;
  const Vec2d b = node.b == kFixedFrame ? Vec2d{} : poses[node.b].position;
  return (b - a) + (blocks_[k].arm_b - blocks_[k].arm_a);
}

HingeSystem::LargestGap HingeSystem::largest_gap(std::span<const Pose<double>> poses) const {
  LargestGap found;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Vec2d open = gap(k, poses);
    const double most = std::max(std::abs(open.x), std::abs(open.y));
    if (!(most <= found.gap)) found = {most, nodes_[k].hinge};
  }
  return found;
}

/// Inverts a block by its determinant. The block's pivots are xx and determinant / xx.
HingeSystem::Inverse HingeSystem::inverse(const Block& block) {
  const double determinant = block.xx * block.yy - block.xy * block.xy, own = block.own_y * block.xx;
  if (!(block.xx > kDependent * block.own_x && determinant > kDependent * own))
    return singular_inverse(block);
  if (block.xx < min_pivot_ratio_ * block.own_x) min_pivot_ratio_ = block.xx / block.own_x;
  if (determinant < min_pivot_ratio_ * own) min_pivot_ratio_ = determinant / own;
  const double share = 1 / determinant;
  return {block.yy * share, -(block.xy * share), block.xx * share};
}

/// Inverts a singular block. A direction that depends on others gets no force.
HingeSystem::Inverse HingeSystem::singular_inverse(const Block& block) {
  Inverse found;
  if (block.xx > kDependent * block.own_x) {
    found.xx = 1 / block.xx;
    ++dependent_;
  } else if (block.yy > kDependent * block.own_y) {
    found.yy = 1 / block.yy;
    ++dependent_;
  } else {
    dependent_ += 2;
  }
  return found;
}

/// Eliminates each hinge in turn: with S the inverse of its block and B the neighbour's off-diagonal block,
/// the neighbour's block loses B S B^T and its right side B S r.
void HingeSystem::eliminate() {
  min_pivot_ratio_ = 1;
  dependent_ = 0;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    Block& block = blocks_[k];
    const Inverse s = inverse(block);
    const double x = block.x, y = block.y;
    block.x = s.xx * x + s.xy * y;
    block.y = s.xy * x + s.yy * y;
    if (node.next < 0) continue;
    Block& next = blocks_[node.next];
    const Vec2d arm = node.side ? block.arm_b : block.arm_a;
    const Vec2d angular = node.shared_inertia * (node.next_side ? next.arm_b : next.arm_a);
    const double b00 = node.shared_mass + angular.y * arm.y, b01 = -(angular.y * arm.x);
    const double b10 = -(angular.x * arm.y), b11 = node.shared_mass + angular.x * arm.x;
    const double w00 = b00 * s.xx + b01 * s.xy, w01 = b00 * s.xy + b01 * s.yy;
    const double w10 = b10 * s.xx + b11 * s.xy, w11 = b10 * s.xy + b11 * s.yy;
    next.xx -= w00 * b00 + w01 * b01;
    next.xy -= w00 * b10 + w01 * b11;
    next.yy -= w10 * b10 + w11 * b11;
    next.x -= w00 * x + w01 * y;
    next.y -= w10 * x + w11 * y;
    block.w00 = w00, block.w01 = w01, block.w10 = w10, block.w11 = w11;
  }
}

/// Solves A lambda = right side, and adds M^-1 J^T lambda to `motion`.
void HingeSystem::solve(std::span<Twist<double>> motion) {
  eliminate();
  for (std::size_t k = nodes_.size(); k-- > 0;) {
    const Node& node = nodes_[k];
    Block& block = blocks_[k];
    if (node.next >= 0) {
      const Block& next = blocks_[node.next];
      block.x -= block.w00 * next.x + block.w10 * next.y;
      block.y -= block.w01 * next.x + block.w11 * next.y;
    }
    const Vec2d push{block.x, block.y};
    if (node.a != kFixedFrame) {
      motion[node.a].velocity -= node.mass_a * push;
      motion[node.a].angular_velocity -= node.inertia_a * cross(block.arm_a, push);
    }
    if (node.b != kFixedFrame) {
      motion[node.b].velocity += node.mass_b * push;
      motion[node.b].angular_velocity += node.inertia_b * cross(block.arm_b, push);
    }
  }
}

void HingeSystem::add_accelerations(std::span<const Twist<double>> twists,
                                    std::span<Twist<double>> accelerations) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    Block& block = blocks_[k];
    block.x = block.y = 0;
    const auto add = [&](int body, Vec2d arm, double sign) {
      if (body == kFixedFrame) return;
      const Twist<double>& a = accelerations[body];
      const double w = twists[body].angular_velocity, spin = w * w;
      block.x -= sign * (a.velocity.x - a.angular_velocity * arm.y - spin * arm.x);
      block.y -= sign * (a.velocity.y + a.angular_velocity * arm.x - spin * arm.y);
    };
    add(node.a, block.arm_a, -1);
    add(node.b, block.arm_b, 1);
  }
  solve(accelerations);
}

void HingeSystem::stop_velocities(std::span<const Twist<double>> twists, std::span<Twist<double>> shift) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Node& node = nodes_[k];
    Block& block = blocks_[k];
    block.x = block.y = 0;
    const auto add = [&](int body, Vec2d arm, double sign) {
      if (body == kFixedFrame) return;
      const Twist<double>& v = twists[body];
      block.x -= sign * (v.velocity.x - v.angular_velocity * arm.y);
      block.y -= sign * (v.velocity.y + v.angular_velocity * arm.x);
    };
    add(node.a, block.arm_a, -1);
    add(node.b, block.arm_b, 1);
  }
  solve(shift);
}

void HingeSystem::close_gaps(std::span<const Pose<double>> poses, std::span<Twist<double>> shift) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const Vec2d open = gap(k, poses);
    blocks_[k].x = -open.x;
    blocks_[k].y = -open.y;
  }
  solve(shift);
}

}  // namespace plumb::precise
