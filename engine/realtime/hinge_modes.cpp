#include "engine/realtime/hinge_modes.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/joints/joints.h"

namespace plumb {
namespace {

constexpr double kZigzag = 3;  // see `HingeModes::link`

/// A body and the hinge that it hangs on.
struct Hanging {
  int body = 0;
  int parent = -1;                  // place of what holds it; -1: the fixed frame
  Vec2d anchor{}, parent_anchor{};  // m, in the bodies' frames
  double load = 0;                  // kg, of it and all below
  bool is_leaf = true;
};

struct End {
  int other = kFixedFrame;
  Vec2d anchor{}, other_anchor{};
};

double norm(Vec2d v) { return std::sqrt(length_squared(v)); }

/// Returns a body's effective mass for a push perpendicular to `arm`, kg: 1 / (1/m + r^2/I).
double resistance(const Body& body, Vec2d arm) {
  const double inertia = inertia_of(body);
  return 1 / (1 / body.mass + (inertia > 0 ? length_squared(arm) / inertia : 0));
}

class Hangings {
 public:
  explicit Hangings(const Scene& scene) : scene_(scene), ends_(scene.bodies.size()), found_(ends_.size(), 0) {
    const Joints<double> joints = compile_joints<double>(scene);
    for (const Revolute<double>& hinge : joints.revolute) {
      const int a = held(hinge.a) ? kFixedFrame : hinge.a, b = held(hinge.b) ? kFixedFrame : hinge.b;
      if (a != kFixedFrame) ends_[a].push_back({b, hinge.anchor_a, hinge.anchor_b});
      if (b != kFixedFrame) ends_[b].push_back({a, hinge.anchor_b, hinge.anchor_a});
    }
    for (int body = 0; body < static_cast<int>(ends_.size()); ++body)
      for (const End& end : ends_[body])
        if (end.other == kFixedFrame && !found_[body]) grow(body, end);
  }

  const std::vector<Hanging>& all() const { return all_; }

 private:
  bool held(int body) const { return body == kFixedFrame || scene_.bodies[body].type != BodyType::Dynamic; }

  /// Adds the bodies that hang on one hinge to the fixed frame, parents first; none if they form a loop.
  void grow(int root, const End& ground) {
    const std::size_t first = all_.size();
    bool loop = false;
    all_.push_back({root, -1, ground.anchor, ground.other_anchor, 0, true});
    found_[root] = 1;
    for (std::size_t at = first; at < all_.size(); ++at) {
      const int body = all_[at].body;
      int ties = 0;
      for (const End& end : ends_[body]) {
        if (end.other == kFixedFrame || found_[end.other]) {
          loop = loop || ++ties > 1;  // the one that it was found by is none
          continue;
        }
        found_[end.other] = 1;
        all_[at].is_leaf = false;
        all_.push_back({end.other, static_cast<int>(at), end.other_anchor, end.anchor, 0, true});
      }
    }
    if (loop) return all_.resize(first);
    for (std::size_t at = all_.size(); at-- > first;) {
      all_[at].load += scene_.bodies[all_[at].body].mass;
      if (all_[at].parent >= 0) all_[all_[at].parent].load += all_[at].load;
    }
  }

  const Scene& scene_;
  std::vector<std::vector<End>> ends_;  // by body
  std::vector<char> found_;
  std::vector<Hanging> all_;
};

}  // namespace

HingeModes hinge_modes(const Scene& scene) {
  const double g = norm(scene.gravity);
  HingeModes modes;
  if (g == 0) return modes;
  const Hangings hangings(scene);
  double pendulum = 0, link = 0;
  for (const Hanging& of : hangings.all()) {
    const Body& body = scene.bodies[of.body];
    const double arm = norm(of.anchor);
    if (of.is_leaf && arm > 0)
      pendulum = std::max(pendulum, body.mass * g * arm / (inertia_of(body) + body.mass * arm * arm));
    if (of.parent < 0) continue;
    // The hinge between this and what it hangs on: taut links above and below.
    const Hanging& above = hangings.all()[of.parent];
    const double length = norm(of.parent_anchor - above.anchor);
    double stiffness = length > 0 ? g * above.load / length : 0;
    if (arm > 0) stiffness += g * of.load / arm;
    const double mass = resistance(scene.bodies[above.body], of.parent_anchor) + resistance(body, of.anchor);
    link = std::max(link, kZigzag * stiffness / mass);
  }
  modes.pendulum = std::sqrt(pendulum), modes.link = std::sqrt(link);
  return modes;
}

}  // namespace plumb
