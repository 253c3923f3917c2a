#include "engine/precise/dynamics/hinges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace plumb::precise {
namespace {

/// A pivot that has lost all but a few digits consists of rounding: its direction depends on others.
constexpr double kDependent = 4096 * std::numeric_limits<double>::epsilon();

}  // namespace

HingeLines::HingeLines(std::span<const HingePlace> order, const std::vector<Revolute>& hinges,
                       std::span<const double> inverse_mass, std::span<const double> inverse_inertia) {
  const auto of = [](std::span<const double> values, int body) {
    return body == kFixedFrame ? 0.0 : values[static_cast<std::size_t>(body)];
  };
  for (const HingePlace& place : order) {
    const Revolute& hinge = hinges[static_cast<std::size_t>(place.hinge)];
    lines_.push_back({hinge.a, hinge.b, place.hinge, place.next, place.side == 1, place.next_side == 1,
                      of(inverse_mass, hinge.a), of(inverse_mass, hinge.b), of(inverse_inertia, hinge.a),
                      of(inverse_inertia, hinge.b), hinge.anchor_a, hinge.anchor_b, 0, 0});
  }
  blocks_.resize(lines_.size());
  find_root();
  from_both_ends();
  for (Line& line : lines_) {
    const double sign = line.side == line.next_side ? 1 : -1;
    line.shared_mass = sign * (line.side ? line.mass_b : line.mass_a);
    line.shared_inertia = sign * (line.side ? line.inertia_b : line.inertia_a);
  }
}

/// Reorders a single line so that it is eliminated from both ends alternately. Two short independent
/// recursions are faster than a long one, in which every step waits for the one before.
void HingeLines::from_both_ends() {
  const int n = static_cast<int>(lines_.size());
  for (int k = 0; k < n; ++k) {
    if (lines_[k].next != (k + 1 < n ? k + 1 : -1)) return;
  }
  const auto place = [n](int k) { return k < (n + 1) / 2 ? 2 * k : 2 * (n - 1 - k) + 1; };
  std::vector<Line> turned(lines_.size());
  for (int k = 0; k < n; ++k) {
    Line line = lines_[k];
    if (2 * k + 1 < n) {
      line.next = place(k + 1);
    } else if (2 * k == n - 1 || (n % 2 == 0 && 2 * k == n)) {
      line.next = -1;
    } else {
      line.next = place(k - 1);
      line.side = lines_[k - 1].next_side, line.next_side = lines_[k - 1].side;
    }
    turned[static_cast<std::size_t>(place(k))] = line;
  }
  for (Step& step : steps_) step.line = static_cast<std::size_t>(place(static_cast<int>(step.line)));
  lines_ = std::move(turned);
}

/// Orders the hinges so that each has one body of known position, and one not yet known.
void HingeLines::find_root() {
  int last = -1;
  for (const Line& line : lines_) last = std::max({last, line.a, line.b});
  std::vector<char> known(static_cast<std::size_t>(last + 1), 0);
  const auto stands = [&](int body, double mass, double inertia) {
    return body == kFixedFrame || (mass == 0 && inertia == 0) || known[static_cast<std::size_t>(body)] != 0;
  };
  std::vector<char> used(lines_.size(), 0);
  for (bool found = true; found;) {
    found = false;
    for (std::size_t k = lines_.size(); k-- > 0;) {
      const Line& line = lines_[k];
      const bool a = stands(line.a, line.mass_a, line.inertia_a);
      const bool b = stands(line.b, line.mass_b, line.inertia_b);
      if (used[k] || a == b) continue;
      steps_.push_back({k, a});
      known[static_cast<std::size_t>(a ? line.b : line.a)] = 1;
      used[k] = 1;
      found = true;
    }
  }
  if (steps_.size() == lines_.size()) return;
  steps_.clear();
  // A free mechanism is a tree if it has fewer hinges than bodies. Loops may become singular and are not
  // handled here.
  std::vector<char> moving(known.size(), 0);
  for (const Line& line : lines_) {
    if (line.mass_a > 0 || line.inertia_a > 0) moving[static_cast<std::size_t>(line.a)] = 1;
    if (line.mass_b > 0 || line.inertia_b > 0) moving[static_cast<std::size_t>(line.b)] = 1;
  }
  if (lines_.size() >= static_cast<std::size_t>(std::count(moving.begin(), moving.end(), 1))) lines_.clear();
}

void HingeLines::place(std::span<const Pose<double>> poses) {
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const Line& line = lines_[k];
    Block& block = blocks_[k];
    const Vec2d a = line.a == kFixedFrame ? line.anchor_a : poses[line.a].rotation * line.anchor_a;
    const Vec2d b = line.b == kFixedFrame ? line.anchor_b : poses[line.b].rotation * line.anchor_b;
    const double mass = line.mass_a + line.mass_b;
    const Vec2d turn_a = line.inertia_a * a, turn_b = line.inertia_b * b;
    block.arm_a = a, block.arm_b = b;
    block.own_x = mass + (turn_a.y * a.y + turn_b.y * b.y);
    block.own_y = mass + (turn_a.x * a.x + turn_b.x * b.x);
    block.xx = block.own_x, block.yy = block.own_y;
    block.xy = -(turn_a.x * a.y + turn_b.x * b.y);
  }
}

Vec2d HingeLines::gap(std::size_t k, std::span<const Pose<double>> poses) const {
  const Line& line = lines_[k];
  const Vec2d a = line.a == kFixedFrame ? Vec2d{} : poses[line.a].position;
  const Vec2d b = line.b == kFixedFrame ? Vec2d{} : poses[line.b].position;
  return (b - a) + (blocks_[k].arm_b - blocks_[k].arm_a);
}

HingeLines::Widest HingeLines::widest(std::span<const Pose<double>> poses) const {
  Widest found;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const Vec2d open = gap(k, poses);
    const double most = std::max(std::abs(open.x), std::abs(open.y));
    if (!(most <= found.gap)) found = {most, lines_[k].hinge};
  }
  return found;
}

/// Inverts a block by its determinant. The block's pivots are xx and determinant / xx.
HingeLines::Inverse HingeLines::inverse(const Block& block) {
  const double determinant = block.xx * block.yy - block.xy * block.xy, own = block.own_y * block.xx;
  if (!(block.xx > kDependent * block.own_x && determinant > kDependent * own)) return deficient(block);
  if (block.xx < weakest_ * block.own_x) weakest_ = block.xx / block.own_x;
  if (determinant < weakest_ * own) weakest_ = determinant / own;
  const double share = 1 / determinant;
  return {block.yy * share, -(block.xy * share), block.xx * share};
}

/// Inverts a singular block. A direction that depends on others gets no force.
HingeLines::Inverse HingeLines::deficient(const Block& block) {
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
void HingeLines::eliminate() {
  weakest_ = 1;
  dependent_ = 0;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const Line& line = lines_[k];
    Block& block = blocks_[k];
    const Inverse s = inverse(block);
    const double x = block.x, y = block.y;
    block.x = s.xx * x + s.xy * y;
    block.y = s.xy * x + s.yy * y;
    if (line.next < 0) continue;
    Block& next = blocks_[line.next];
    const Vec2d arm = line.side ? block.arm_b : block.arm_a;
    const Vec2d turn = line.shared_inertia * (line.next_side ? next.arm_b : next.arm_a);
    const double b00 = line.shared_mass + turn.y * arm.y, b01 = -(turn.y * arm.x);
    const double b10 = -(turn.x * arm.y), b11 = line.shared_mass + turn.x * arm.x;
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
void HingeLines::solve(std::span<Twist<double>> motion) {
  eliminate();
  for (std::size_t k = lines_.size(); k-- > 0;) {
    const Line& line = lines_[k];
    Block& block = blocks_[k];
    if (line.next >= 0) {
      const Block& next = blocks_[line.next];
      block.x -= block.w00 * next.x + block.w10 * next.y;
      block.y -= block.w01 * next.x + block.w11 * next.y;
    }
    const Vec2d push{block.x, block.y};
    if (line.a != kFixedFrame) {
      motion[line.a].velocity -= line.mass_a * push;
      motion[line.a].angular_velocity -= line.inertia_a * cross(block.arm_a, push);
    }
    if (line.b != kFixedFrame) {
      motion[line.b].velocity += line.mass_b * push;
      motion[line.b].angular_velocity += line.inertia_b * cross(block.arm_b, push);
    }
  }
}

void HingeLines::accelerate(std::span<const Twist<double>> twists, std::span<Twist<double>> accelerations) {
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const Line& line = lines_[k];
    Block& block = blocks_[k];
    block.x = block.y = 0;
    const auto add = [&](int body, Vec2d arm, double sign) {
      if (body == kFixedFrame) return;
      const Twist<double>& a = accelerations[body];
      const double w = twists[body].angular_velocity, spin = w * w;
      block.x -= sign * (a.velocity.x - a.angular_velocity * arm.y - spin * arm.x);
      block.y -= sign * (a.velocity.y + a.angular_velocity * arm.x - spin * arm.y);
    };
    add(line.a, block.arm_a, -1);
    add(line.b, block.arm_b, 1);
  }
  solve(accelerations);
}

void HingeLines::stop(std::span<const Twist<double>> twists, std::span<Twist<double>> shift) {
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const Line& line = lines_[k];
    Block& block = blocks_[k];
    block.x = block.y = 0;
    const auto add = [&](int body, Vec2d arm, double sign) {
      if (body == kFixedFrame) return;
      const Twist<double>& v = twists[body];
      block.x -= sign * (v.velocity.x - v.angular_velocity * arm.y);
      block.y -= sign * (v.velocity.y + v.angular_velocity * arm.x);
    };
    add(line.a, block.arm_a, -1);
    add(line.b, block.arm_b, 1);
  }
  solve(shift);
}

void HingeLines::close(std::span<const Pose<double>> poses, std::span<Twist<double>> shift) {
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const Vec2d open = gap(k, poses);
    blocks_[k].x = -open.x;
    blocks_[k].y = -open.y;
  }
  solve(shift);
}

}  // namespace plumb::precise
