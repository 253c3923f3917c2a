#include "engine/precise/dynamics/articulated_tree.h"

#include <algorithm>
#include <utility>

#include "engine/math/rotations.h"
#include "engine/precise/dynamics/clock.h"

namespace plumb::precise {

ArticulatedTree::ArticulatedTree(const Scene& scene, const ScenePartition& partition,
                                 EquationsOfMotion& equations, bool enabled)
    : equations_(equations), gravity_(scene.gravity) {
  if (!enabled || !partition.shapes.empty() || !equations.has_hinges_only()) return;
  if (!find_links(scene, partition)) links_.clear();
  width_ = links_.size() + links_.size() % 2;
  sums_.resize(links_.size());
  acceleration_.resize(links_.size());
  cosines_.resize(links_.size());
  sines_.resize(links_.size());
  state_.resize(2 * width_);
}

/// Adds hinge by hinge from the static bodies, each with one known body and one unknown. Returns false if the
/// hinges do not form a tree of all bodies.
bool ArticulatedTree::find_links(const Scene& scene, const ScenePartition& partition) {
  constexpr int kUnknown = -2, kStatic = -1;
  std::vector<int> link_of(scene.bodies.size(), kUnknown);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (scene.bodies[i].type == BodyType::Static) link_of[i] = kStatic;
  const auto known = [&](int body) { return body == kFixedFrame ? kStatic : link_of[body]; };
  std::vector<Revolute> left = equations_.joints().revolute;
  if (left.size() != partition.integrated.size()) return false;
  while (!left.empty()) {
    const std::size_t before = left.size();
    std::vector<Revolute> later;
    for (Revolute hinge : left) {
      if (known(hinge.a) == kUnknown) {
        std::swap(hinge.a, hinge.b);
        std::swap(hinge.anchor_a, hinge.anchor_b);
      }
      if (known(hinge.a) == kUnknown) {
        later.push_back(hinge);
        continue;
      }
      const auto body = static_cast<std::size_t>(hinge.b);
      if (known(hinge.b) != kUnknown || scene.bodies[body].type != BodyType::Dynamic) return false;
      Link link{.parent = known(hinge.a), .body = hinge.b, .parent_body = hinge.a};
      link.anchor = hinge.anchor_b, link.parent_anchor = hinge.anchor_a;
      if (link.parent >= 0)
        link.hinge = hinge.anchor_a - links_[static_cast<std::size_t>(link.parent)].anchor;
      link.slot = static_cast<std::size_t>(
          std::lower_bound(partition.integrated.begin(), partition.integrated.end(), body) -
          partition.integrated.begin());
      link.mass = 1 / equations_.inverse_mass(body);
      link.moment = -link.mass * link.anchor;
      link.can_rotate = equations_.inverse_inertia(body) > 0;
      if (link.can_rotate)
        link.inertia = 1 / equations_.inverse_inertia(body) + link.mass * length_squared(link.anchor);
      link_of[body] = static_cast<int>(links_.size());
      links_.push_back(link);
    }
    if (later.size() == before) return false;
    left = std::move(later);
  }
  return true;
}

void ArticulatedTree::forward_kinematics(double time, Compensated& y) {
  equations_.update_poses(time, y.value());
  const std::span<const Pose<double>> poses = equations_.poses();
  for (const Link& link : links_) {
    Vec2d parent_arm = link.parent_anchor, place{}, velocity{};
    if (link.parent_body != kFixedFrame) {
      const Pose<double>& pose = poses[link.parent_body];
      parent_arm = pose.rotation * parent_arm;
      place = pose.position;
    }
    if (link.parent >= 0) {
      const Link& parent = links_[static_cast<std::size_t>(link.parent)];
      const BodyState state = EquationsOfMotion::state(y.value(), parent.slot);
      place = state.position;
      velocity = state.velocity + cross(state.angular_velocity, parent_arm);
    }
    const Vec2d own_arm = poses[link.body].rotation * link.anchor;
    const std::size_t first = EquationsOfMotion::kPerBody * link.slot;
    const Vec2d at = place + (parent_arm - own_arm), new_velocity = velocity - cross(y[first + 5], own_arm);
    y.set(first, at.x);
    y.set(first + 1, at.y);
    y.set(first + 3, new_velocity.x);
    y.set(first + 4, new_velocity.y);
  }
}

std::span<const double> ArticulatedTree::angles_of(std::span<const double> y) {
  for (std::size_t link = 0; link < links_.size(); ++link) {
    const double* body = y.data() + EquationsOfMotion::kPerBody * links_[link].slot;
    state_[link] = body[2];
    state_[width_ + link] = body[5];
  }
  return state_;
}

void ArticulatedTree::rate(double, std::span<const double> state, std::span<double> out) {
  equations_.count_evaluation();
  const Clock clock(equations_.cost.on, equations_.cost.joints);
  const std::size_t count = links_.size();
  rotations_of(state.first(count), cosines_, sines_);
  for (std::size_t i = 0; i < count; ++i) {
    const Link& link = links_[i];
    Sums& own = sums_[i];
    const double w = state[width_ + i];
    const Vec2d moment = Rotation<double>{cosines_[i], sines_[i]} * link.moment;
    own.spin = w * w;
    own.xx = own.yy = link.mass;
    own.xy = own.t = 0;
    own.j = link.inertia;
    own.u = {-moment.y, moment.x};
    own.w = own.spin * moment;
    const auto parent = static_cast<std::size_t>(link.parent);
    if (link.parent >= 0) own.e = Rotation<double>{cosines_[parent], sines_[parent]} * link.hinge;
    out[i] = w;
  }
  eliminate();
  for (std::size_t i = 0; i < count; ++i) {
    const Link& link = links_[i];
    const Sums& own = sums_[i];
    Vec2d a = -gravity_;
    if (link.parent >= 0) {
      const auto parent = static_cast<std::size_t>(link.parent);
      const double alpha = out[width_ + parent], spin = sums_[parent].spin;
      a.x = acceleration_[parent].x - alpha * own.e.y - spin * own.e.x;
      a.y = acceleration_[parent].y + alpha * own.e.x - spin * own.e.y;
    }
    acceleration_[i] = a;
    out[width_ + i] = own.t - dot(own.u, a);  // both over J
  }
}

/// Eliminates from the tips on: adds each link's inertia and bias at its hinge to its parent. Leaves T / J in
/// `t` and U / J in `u`.
void ArticulatedTree::eliminate() {
  for (std::size_t i = links_.size(); i-- > 0;) {
    Sums& own = sums_[i];
    const double inverse = links_[i].can_rotate ? 1 / own.j : 0;
    const Vec2d u = own.u;
    own.u = inverse * u;
    own.t *= inverse;
    if (links_[i].parent < 0) continue;
    Sums& to = sums_[static_cast<std::size_t>(links_[i].parent)];
    const Vec2d e = own.e;
    const double xx = own.xx - u.x * own.u.x, xy = own.xy - u.x * own.u.y, yy = own.yy - u.y * own.u.y;
    const Vec2d along{xx * e.x + xy * e.y, xy * e.x + yy * e.y};   // L e
    const Vec2d across{xy * e.x - xx * e.y, yy * e.x - xy * e.y};  // L e^
    const Vec2d q{to.spin * along.x + (own.w.x - own.t * u.x), to.spin * along.y + (own.w.y - own.t * u.y)};
    to.xx += xx, to.xy += xy, to.yy += yy;
    to.j += e.x * across.y - e.y * across.x;
    to.u += across;
    to.w += q;
    to.t += e.x * q.y - e.y * q.x;
  }
}

}  // namespace plumb::precise
