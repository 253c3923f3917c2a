#include "engine/world/debug_draw.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "engine/geometry/convex.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/lock.h"
#include "engine/world/state/shape_boxes.h"
#include "engine/world/step/contact_reading.h"
#include "engine/world/world_data.h"

namespace plumb {
namespace {

template <class Real>
class Drawing {
 public:
  Drawing(const WorldData<Real>& w, const PastPoses<Real>& before, double fraction, DebugDraw& out,
          const DrawOptions& options)
      : w_(w), previous_(before), fraction_(fraction), out_(out), options_(options) {}

  void draw() const {
    for_each_used(w_.bodies, [&](int body) {
      if (options_.shapes && is_visible(body)) draw_shapes(body);
    });
    if (options_.boxes) draw_boxes();
    if (options_.joints) for_each_used(w_.joints, [&](int joint) { draw_joint(joint); });
    if (options_.contacts || options_.normals || options_.impulses)
      for_each_used(w_.contacts, [&](int contact) { draw_contact(w_.contacts[contact]); });
    for_each_used(w_.bodies, [&](int body) {
      if (!is_visible(body)) return;
      if (options_.centres) draw_centre(body);
      if (options_.names && !w_.extras_of(body).name.empty())
        out_.text(centre(body), w_.extras_of(body).name, DrawRole::Name);
    });
  }

 private:
  template <class Items, class Visit>
  static void for_each_used(const Items& items, Visit&& visit) {
    for (int i = 0; i < items.size(); ++i) {
      if (items.used(i)) visit(i);
    }
  }

  // Returns true if the bounds overlap a box.
  bool is_visible(const Aabb<double>& box) const {
    return !options_.bounds || options_.bounds->overlaps(box);
  }
  // Returns true if the bounds may overlap a body, at any angle.
  bool is_visible(int body) const {
    const double extent = static_cast<double>(w_.extents[body]);
    const Vec2d middle = centre(body), size{extent, extent};
    return is_visible(Aabb<double>{middle - size, middle + size});
  }
  // Returns true if the bounds may overlap a shape. AABBs are those after the last step, so after changes by
  // calls only the body's size is reliable.
  bool is_shape_visible(int shape) const {
    if (!options_.bounds) return true;
    const Aabb<Real> box = current_aabb(w_, shape);
    return fraction_ == 1
               ? is_visible(Aabb<double>{box.lower.template as<double>(), box.upper.template as<double>()})
               : is_visible(w_.shapes[shape].body);
  }

  Pose<double> pose(int body) const { return previous_.between(w_, body, fraction_); }
  Vec2d centre(int body) const { return pose(body).position; }

  // Returns the world position of a point in the body's frame, whose origin is the centre of mass.
  static Vec2d transform(const Pose<double>& pose, Vec2d point) {
    return pose.position + pose.rotation * point;
  }
  Vec2d to_world(int body, Vec2d point) const { return transform(pose(body), point); }
  // Returns the world position of an anchor, which is given in the frame of the body's origin.
  Vec2d anchor(int body, Vec2d point) const {
    return to_world(body, point - w_.bodies[body].centre.template as<double>());
  }

  DrawRole role_of(int body, int shape) const {
    const BodyRecord<Real>& record = w_.bodies[body];
    if (w_.forms[shape].sensor) return DrawRole::Sensor;
    if (record.type == BodyType::Static) return DrawRole::Static;
    if (!record.awake) return DrawRole::Asleep;
    return record.type == BodyType::Kinematic ? DrawRole::Kinematic : DrawRole::Awake;
  }

  void draw_shapes(int body) const {
    const Pose<double> body_pose = pose(body);
    for (int shape = w_.bodies[body].first_shape; shape != kNone; shape = w_.shapes[shape].next) {
      if (!is_shape_visible(shape)) continue;
      const Convex<Real> convex = w_.convex(shape);
      const double radius = static_cast<double>(convex.radius);
      const DrawRole role = role_of(body, shape);
      Vec2d corners[kMaxCorners];
      for (int i = 0; i < convex.count; ++i)
        corners[i] = transform(body_pose, convex.corners[i].point.template as<double>());
      if (convex.count == 1) {
        out_.circle(corners[0], radius, {body_pose.rotation.c, body_pose.rotation.s}, role);
      } else if (convex.count > 2) {
        out_.polygon(std::span(corners, static_cast<std::size_t>(convex.count)), radius, role);
      } else if (radius > 0) {
        out_.capsule(corners[0], corners[1], radius, role);
      } else {
        out_.segment(corners[0], corners[1], role);
      }
    }
  }

  void draw_boxes() const {
    for_each_used(w_.shapes, [&](int shape) {
      if (w_.shapes[shape].proxy == kNone || !is_shape_visible(shape)) return;
      const Aabb<Real>& box = w_.tight_aabbs[shape];
      const Vec2d a = box.lower.template as<double>(), b = box.upper.template as<double>();
      const Vec2d corners[] = {a, {b.x, a.y}, b, {a.x, b.y}};
      out_.polygon(corners, 0, DrawRole::Box);
    });
  }

  void draw_contact(const ContactRecord& contact) const {
    const bool sleeping = contact.home == ContactHome::Sleeping;
    if (!sleeping && contact.home != ContactHome::Graph) return;
    if (!is_shape_visible(contact.shape_a) && !is_shape_visible(contact.shape_b)) return;
    const ContactConstraint<Real>& constraint =
        sleeping ? w_.sleeping_contacts[contact.index] : w_.graph.at({contact.colour, contact.index});
    const ContactReading reading = reading_of(w_, contact, constraint);
    const int body = contact.body_a;
    const Vec2d offset = centre(body) - w_.position[body];
    for (int i = 0; i < reading.count; ++i) {
      const Vec2d at = reading.points[i] + offset;
      if (options_.contacts) out_.point(at, DrawRole::Contact);
      if (options_.normals) out_.segment(at, at + options_.normal_length * reading.normal, DrawRole::Normal);
      if (options_.impulses && reading.impulses[i] > 0) {
        const double length = options_.impulse_length * reading.impulses[i];
        out_.segment(at, at + length * reading.normal, DrawRole::Impulse);
      }
    }
  }

  void draw_centre(int body) const {
    const Vec2d at = centre(body);
    const double length = w_.extents[body] > 0 ? 0.3 * static_cast<double>(w_.extents[body]) : 0.1;
    out_.segment(at, to_world(body, {length, 0}), DrawRole::Centre);
    out_.segment(at, to_world(body, {0, length}), DrawRole::Centre);
    out_.point(at, DrawRole::Centre);
  }

  // Ends of a joint: its anchors if it has any, else the centres of mass.
  struct Ends {
    Vec2d a{}, b{};
  };

  // Returns a box that contains everything drawn for a joint: arms from the centres, ropes over pulleys with
  // their wheels, and zigzags, which reach a sixteenth of their length to the side.
  Aabb<double> box_of(const Ends& ends, int a, int b, const JointKind& kind) const {
    Aabb<double> box{ends.a, ends.a};
    const auto add = [&box](Vec2d point) { box = merged(box, Aabb<double>{point, point}); };
    add(ends.b), add(centre(a)), add(centre(b));
    if (const auto* pulley = std::get_if<PulleyDefinition>(&kind))
      add(pulley->ground_a), add(pulley->ground_b);
    const Vec2d size = box.upper - box.lower;
    return box.grown((size.x + size.y) / 16);
  }

  Ends ends_of(int a, int b, const JointKind& kind) const {
    Ends ends{centre(a), centre(b)};
    std::visit(
        [&](const auto& definition) {
          if constexpr (requires { definition.anchor_a; }) ends.a = anchor(a, definition.anchor_a);
          if constexpr (requires { definition.anchor_b; }) ends.b = anchor(b, definition.anchor_b);
        },
        kind);
    if (const auto* mouse = std::get_if<MouseDefinition>(&kind)) ends.a = mouse->target;
    if (const auto* motor = std::get_if<MotorDefinition>(&kind)) ends.a = anchor(a, motor->target_position);
    return ends;
  }

  void draw_joint(int joint) const {
    const JointRecord& record = w_.joints[joint];
    const int a = record.body_a, b = record.body_b;
    const JointKind& kind = w_.joint_set.definition(record.slot);
    const Ends ends = ends_of(a, b, kind);
    if (!is_visible(box_of(ends, a, b, kind))) return;
    out_.point(ends.a, DrawRole::JointLine), out_.point(ends.b, DrawRole::JointLine);
    if (const auto* pulley = std::get_if<PulleyDefinition>(&kind)) {
      draw_pulleys(out_, ends.a, pulley->ground_a, pulley->ground_b, ends.b, DrawRole::JointLine);
      return;
    }
    // Lines from body to anchor, between the anchors, and on to the other body. The centre of a static body
    // has no meaning, so no line starts there.
    const auto draw_arm = [&](int body, Vec2d end) {
      const Vec2d middle = centre(body);
      if (w_.bodies[body].type != BodyType::Static && !(middle == end))
        out_.segment(middle, end, DrawRole::JointLine);
    };
    draw_arm(a, ends.a);
    const auto* distance_joint = std::get_if<DistanceDefinition>(&kind);
    if (distance_joint != nullptr && distance_joint->spring) {
      draw_spring(out_, ends.a, ends.b, DrawRole::JointLine);
    } else if (!(ends.a == ends.b)) {
      out_.segment(ends.a, ends.b, DrawRole::JointLine);
    }
    draw_arm(b, ends.b);
  }

  const WorldData<Real>& w_;
  const PastPoses<Real>& previous_;
  const double fraction_;
  DebugDraw& out_;
  const DrawOptions& options_;
};

}  // namespace

void draw_spring(DebugDraw& out, Vec2d from, Vec2d to, DrawRole role) {
  constexpr int kSegments = 12;
  const Vec2d direction = to - from, across = 1.0 / 16 * perpendicular(direction);
  Vec2d last = from;
  for (int i = 1; i <= kSegments; ++i) {
    const double side = i == kSegments ? 0 : i % 2 == 0 ? 1 : -1;
    const Vec2d next = from + static_cast<double>(i) / kSegments * direction + side * across;
    out.segment(last, next, role);
    last = next;
  }
}

void draw_pulleys(DebugDraw& out, Vec2d end_a, Vec2d ground_a, Vec2d ground_b, Vec2d end_b, DrawRole role) {
  const auto distance = [](Vec2d a, Vec2d b) { return std::sqrt(length_squared(a - b)); };
  const double between = distance(ground_a, ground_b);
  const double size = between > 0 ? between : std::min(distance(end_a, ground_a), distance(end_b, ground_b));
  out.segment(end_a, ground_a, role);
  out.segment(ground_a, ground_b, role);
  out.segment(ground_b, end_b, role);
  if (!(size > 0)) return;
  out.circle(ground_a, 0.1 * size, {0, 0}, role);
  if (between > 0) out.circle(ground_b, 0.1 * size, {0, 0}, role);
}

template <class Real>
void draw(const BasicWorld<Real>& world, DebugDraw& out, const DrawOptions& options) {
  draw(world, PastPoses<Real>{}, 1, out, options);
}

template <class Real>
void draw(const BasicWorld<Real>& world, const PastPoses<Real>& before, double fraction, DebugDraw& out,
          const DrawOptions& options) {
  const Lock<Real> lock(world.data());
  Drawing<Real>(world.data(), before, fraction, out, options).draw();
}

template void draw(const BasicWorld<float>&, DebugDraw&, const DrawOptions&);
template void draw(const BasicWorld<double>&, DebugDraw&, const DrawOptions&);
template void draw(const BasicWorld<float>&, const PastPoses<float>&, double, DebugDraw&, const DrawOptions&);
template void draw(const BasicWorld<double>&, const PastPoses<double>&, double, DebugDraw&,
                   const DrawOptions&);

}  // namespace plumb
