#include "engine/simulation/precise_hinges.h"

#include <algorithm>
#include <cmath>

namespace plumb::precise {

HingeLines::HingeLines(std::span<const HingePlace> order, const std::vector<Revolute<double>>& hinges,
                       std::span<const double> inverse_mass, std::span<const double> inverse_inertia) {
  const auto of = [](std::span<const double> values, int body) {
    return body == kFixedFrame ? 0.0 : values[static_cast<std::size_t>(body)];
  };
  for (const HingePlace& place : order) {
    const Revolute<double>& hinge = hinges[static_cast<std::size_t>(place.hinge)];
    lines_.push_back({hinge.a, hinge.b, place.hinge, place.next, place.side == 1, place.next_side == 1,
                      of(inverse_mass, hinge.a), of(inverse_mass, hinge.b), of(inverse_inertia, hinge.a),
                      of(inverse_inertia, hinge.b), hinge.anchor_a, hinge.anchor_b});
  }
  blocks_.resize(lines_.size());
  find_root();
}

/// Hinges in an order in which each has one body that is known where it stands, and one that is not yet.
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
  // What flies freely is a tree where there are fewer hinges than bodies. Loops may become singular: not
  // here.
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

/// A = L D L^T, and L^-1 of the right side.
void HingeLines::eliminate() {
  weakest_ = 1;
  dependent_ = 0;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    const Line& line = lines_[k];
    Block& block = blocks_[k];
    const double inverse_x = pivot(block.xx, block.own_x), within = block.xy * inverse_x;
    const double inverse_y = pivot(block.yy - within * block.xy, block.own_y);
    const double x = block.x, y = block.y - within * x;
    block.inverse_x = inverse_x, block.within = within, block.inverse_y = inverse_y;
    block.y = y;
    if (line.next < 0) continue;
    Block& next = blocks_[line.next];
    const double sign = line.side == line.next_side ? 1 : -1;
    const double mass = sign * (line.side ? line.mass_b : line.mass_a);
    const double inertia = sign * (line.side ? line.inertia_b : line.inertia_a);
    const Vec2d arm = line.side ? block.arm_b : block.arm_a;
    const Vec2d turn = inertia * (line.next_side ? next.arm_b : next.arm_a);
    const double y00 = mass + turn.y * arm.y, y10 = -(turn.x * arm.y);
    const double y01 = -(turn.y * arm.x) - within * y00, y11 = mass + turn.x * arm.x - within * y10;
    const double l00 = y00 * inverse_x, l10 = y10 * inverse_x;
    const double l01 = y01 * inverse_y, l11 = y11 * inverse_y;
    next.xx -= l00 * y00 + l01 * y01;
    next.xy -= l00 * y10 + l01 * y11;
    next.yy -= l10 * y10 + l11 * y11;
    next.x -= l00 * x + l01 * y;
    next.y -= l10 * x + l11 * y;
    block.below[0][0] = l00, block.below[0][1] = l01;
    block.below[1][0] = l10, block.below[1][1] = l11;
  }
}

/// A lambda = right side, and motion += M^-1 J^T lambda.
void HingeLines::solve(std::span<Twist<double>> motion) {
  eliminate();
  for (std::size_t k = lines_.size(); k-- > 0;) {
    const Line& line = lines_[k];
    Block& block = blocks_[k];
    double x = block.x * block.inverse_x, y = block.y * block.inverse_y;
    if (line.next >= 0) {
      const Block& next = blocks_[line.next];
      x -= block.below[0][0] * next.x + block.below[1][0] * next.y;
      y -= block.below[0][1] * next.x + block.below[1][1] * next.y;
    }
    x -= block.within * y;
    block.x = x, block.y = y;
    const Vec2d push{x, y};
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
