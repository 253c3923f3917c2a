#include "reference/support/mechanism.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <variant>

#include "engine/core/text.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/features.h"

namespace plumb::reference {
namespace {

/// A hinge as seen from one of its bodies.
struct Hinge {
  std::size_t joint = 0;
  std::optional<std::size_t> other{};  ///< the other body; nullopt for the world
  Vec2d anchor{}, other_anchor{};      ///< m, in the bodies' frames
};

bool is_dynamic(const Scene& scene, std::size_t body) { return scene.bodies[body].type == BodyType::Dynamic; }

std::vector<std::vector<Hinge>> hinges_by_body(const Scene& scene) {
  std::vector<std::vector<Hinge>> out(scene.bodies.size());
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const auto* joint = std::get_if<RevoluteJoint>(&scene.joints[j]);
    if (joint == nullptr) continue;
    const auto a = find_body(scene, joint->body_a), b = find_body(scene, joint->body_b);
    if (a) out[*a].push_back({j, b, joint->anchor_a, joint->anchor_b});
    if (b) out[*b].push_back({j, a, joint->anchor_b, joint->anchor_a});
  }
  return out;
}

Vec2d in_world(const Body& body, Vec2d point) { return body.position + rotation_of(body.angle) * point; }

/// Traverses the graph of hinges from its roots: bodies hinged to the world or to a body that is not dynamic,
/// then free ones.
class Walk {
 public:
  explicit Walk(const Scene& scene)
      : scene_(scene),
        hinges_(hinges_by_body(scene)),
        link_of_(scene.bodies.size(), -1),
        used_(scene.joints.size(), false) {
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
      if (is_dynamic(scene, body)) start_if_held(body);
    }
    for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
      if (!is_dynamic(scene, body) || link_of_[body] >= 0) continue;
      const Body& free = scene.bodies[body];
      add({.body = body, .angle = free.angle, .angle_speed = free.angular_velocity});
      grow(links.size() - 1);
    }
  }

  std::vector<Link> links;
  std::optional<std::size_t> loop{};  ///< a joint that closes a loop, if there is one

 private:
  void start_if_held(std::size_t body) {
    for (const Hinge& hinge : hinges_[body]) {
      if (hinge.other && is_dynamic(scene_, *hinge.other)) continue;
      if (link_of_[body] >= 0) {
        if (!used_[hinge.joint]) loop = hinge.joint;
        continue;
      }
      used_[hinge.joint] = true;
      const Body& held = scene_.bodies[body];
      const Vec2d at =
          hinge.other ? in_world(scene_.bodies[*hinge.other], hinge.other_anchor) : hinge.other_anchor;
      add({body, -1, true, at, hinge.anchor, held.angle, held.angular_velocity});
      grow(links.size() - 1);
    }
  }

  /// Adds the descendants of all links from `root` on, breadth first.
  void grow(std::size_t root) {
    for (std::size_t at = root; at < links.size(); ++at) {
      const std::size_t parent = links[at].body;
      for (const Hinge& hinge : hinges_[parent]) {
        if (used_[hinge.joint] || !hinge.other || !is_dynamic(scene_, *hinge.other)) continue;
        if (link_of_[*hinge.other] >= 0) {
          loop = hinge.joint;
          continue;
        }
        used_[hinge.joint] = true;
        const Body &below = scene_.bodies[*hinge.other], &above = scene_.bodies[parent];
        add({*hinge.other, static_cast<int>(at), true, hinge.anchor, hinge.other_anchor,
             below.angle - above.angle, below.angular_velocity - above.angular_velocity});
      }
    }
  }

  void add(Link link) {
    link_of_[link.body] = static_cast<int>(links.size());
    links.push_back(link);
  }

  const Scene& scene_;
  std::vector<std::vector<Hinge>> hinges_;
  std::vector<int> link_of_;
  std::vector<bool> used_;
};

std::string quoted_joint(const Scene& scene, std::size_t joint) {
  return "joint " +
         plumb::quoted(std::visit([](const auto& j) -> std::string { return j.name; }, scene.joints[joint]));
}

/// Returns the pairs of bodies between which a hinge disables contacts, sorted.
std::vector<std::pair<std::size_t, std::size_t>> kept_apart(const Scene& scene) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (const Joint& joint : scene.joints) {
    const auto* hinge = std::get_if<RevoluteJoint>(&joint);
    if (hinge == nullptr || hinge->collide) continue;
    const auto a = find_body(scene, hinge->body_a), b = find_body(scene, hinge->body_b);
    if (a && b) out.emplace_back(std::min(*a, *b), std::max(*a, *b));
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// Returns the names of two bodies that may touch, as a reason; otherwise an empty text. First leaves out
/// bodies whose filters let nothing through, such as most bodies of long chains.
std::string what_may_touch(const Scene& scene) {
  const auto apart = kept_apart(scene);
  std::vector<std::size_t> touchable;
  for (std::size_t body = 0; body < scene.bodies.size(); ++body) {
    for (const Shape& shape : scene.bodies[body].shapes) {
      if (shape.filter.mask == 0 && shape.filter.group <= 0) continue;
      touchable.push_back(body);
      break;
    }
  }
  for (std::size_t i = 0; i < touchable.size(); ++i) {
    for (std::size_t j = i + 1; j < touchable.size(); ++j) {
      const std::size_t a = touchable[i], b = touchable[j];
      if (!is_dynamic(scene, a) && !is_dynamic(scene, b)) continue;
      if (std::binary_search(apart.begin(), apart.end(), std::pair{a, b})) continue;
      for (const Shape& one : scene.bodies[a].shapes) {
        for (const Shape& other : scene.bodies[b].shapes) {
          if (may_touch(one.filter, other.filter))
            return "bodies " + plumb::quoted(scene.bodies[a].name) + " and " +
                   plumb::quoted(scene.bodies[b].name) + " may touch";
        }
      }
    }
  }
  return "";
}

/// Returns the reason if the link's hinge is open at the start or its anchors move apart; otherwise an empty
/// text.
std::string ill_fitting(const Scene& scene, const Link& link, const std::vector<Link>& links) {
  constexpr double kRelative = 1e-9;
  const Body& body = scene.bodies[link.body];
  const Vec2d arm = rotation_of(body.angle) * link.anchor;
  Vec2d at = link.parent_anchor, velocity{};
  if (link.parent >= 0) {
    const Body& parent = scene.bodies[links[static_cast<std::size_t>(link.parent)].body];
    const Vec2d parent_arm = rotation_of(parent.angle) * link.parent_anchor;
    at = parent.position + parent_arm;
    velocity = parent.velocity + cross(parent.angular_velocity, parent_arm);
  }
  const Vec2d gap = body.position + arm - at;
  const Vec2d slip = body.velocity + cross(body.angular_velocity, arm) - velocity;
  const double length = std::sqrt(length_squared(at)) + std::sqrt(length_squared(arm));
  const double speed = std::sqrt(length_squared(velocity)) + std::sqrt(length_squared(body.velocity));
  if (std::sqrt(length_squared(gap)) > kRelative * length)
    return "the hinge of body " + plumb::quoted(body.name) + " is open at the start";
  if (std::sqrt(length_squared(slip)) > kRelative * speed)
    return "the velocity of body " + plumb::quoted(body.name) + " violates its hinge";
  return "";
}

}  // namespace

std::vector<Link> links_of(const Scene& scene) { return Walk(scene).links; }

std::string not_a_mechanism(const Scene& scene) {
  if (const std::string rule = unusual_rule(scene); !rule.empty())
    return rule + ", which this engine does not have; 'plumb-precise' runs it";
  if (const std::string field = unusual_field(scene); !field.empty())
    return field + ", which this engine does not have; 'plumb' runs it";
  for (std::size_t j = 0; j < scene.joints.size(); ++j) {
    const auto* hinge = std::get_if<RevoluteJoint>(&scene.joints[j]);
    if (hinge == nullptr) return quoted_joint(scene, j) + ": only revolute joints can be coordinates";
    for (const std::string& name : {hinge->body_a, hinge->body_b}) {
      const auto body = find_body(scene, name);
      if (body && scene.bodies[*body].type == BodyType::Kinematic)
        return quoted_joint(scene, j) + ": body " + plumb::quoted(name) + " is kinematic";
      if (body && scene.bodies[*body].fixed_rotation)
        return quoted_joint(scene, j) + ": body " + plumb::quoted(name) + " has a fixed rotation";
    }
  }
  const Walk walk(scene);
  if (walk.loop) return quoted_joint(scene, *walk.loop) + ": it closes a loop";
  for (const Link& link : walk.links) {
    if (!link.hinged) continue;
    if (std::string reason = ill_fitting(scene, link, walk.links); !reason.empty()) return reason;
  }
  return what_may_touch(scene);
}

}  // namespace plumb::reference
