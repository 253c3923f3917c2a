#include <limits>
#include <string>

#include "engine/scene/error.h"
#include "engine/scene/joint_fields.h"
#include "engine/scene/json.h"
#include "engine/scene/json/json_emitter.h"
#include "engine/scene/names.h"
#include "engine/scene/subject.h"
#include "engine/scene/validate.h"

namespace plumb {
namespace {

using json::Emitter;

/// Writes a scene's parts in a fixed order of keys.
class Writer {
 public:
  explicit Writer(int indent) : out_(indent) {}

  void scene(const Scene& scene) {
    out_.begin('{');
    out_.key("plumb_scene"), out_.integer(1);
    write("name", scene.name);
    write("gravity", scene.gravity);
    contact_rules(scene.contact_rules);
    list("bodies", scene.bodies, [this](const Body& body) { this->body(body); });
    list("joints", scene.joints, [this](const Joint& joint) { this->joint(joint); });
    list("forces", scene.forces, [this](const ForceLaw& force) { this->force(force); });
    // Left out where there is none, as `motion` of a body is: scenes from before them keep their hashes.
    if (!scene.drives.empty())
      list("drives", scene.drives, [this](const Drive& drive) { this->drive(drive); });
    out_.end('}');
  }

  bool failed() const { return failed_ || out_.failed(); }
  std::string take() { return out_.take(); }

 private:
  void write(std::string_view key, double value) { out_.key(key), out_.number(value); }
  void write(std::string_view key, bool value) { out_.key(key), out_.boolean(value); }
  void write(std::string_view key, std::string_view value) { out_.key(key), out_.string(value); }
  void write(std::string_view key, const std::string& value) { write(key, std::string_view(value)); }
  void write(std::string_view key, Vec2d value) { out_.key(key), out_.vector(value); }

  template <class Enum, std::size_t kCount>
  void write(std::string_view key, Enum value, const std::array<std::string_view, kCount>& names) {
    const auto index = static_cast<std::size_t>(value);
    failed_ = failed_ || index >= kCount;
    write(key, index < kCount ? names[index] : std::string_view("?"));
  }

  template <class Items, class WriteItem>
  void list(std::string_view key, const Items& items, WriteItem write_item) {
    out_.key(key);
    out_.begin('[');
    for (const auto& item : items) write_item(item);
    out_.end(']');
  }

  void contact_rules(const ContactRules& rules) {
    out_.key("contact_rules");
    out_.begin('{');
    write("friction", rules.friction, kCombineNames);
    write("restitution", rules.restitution, kCombineNames);
    write("restitution_threshold", rules.restitution_threshold);
    // Omitted when default, so that the hashes of scenes from before these options stay the same.
    if (rules.simultaneous != Simultaneous::Sequence)
      write("simultaneous", rules.simultaneous, kSimultaneousNames);
    if (rules.impact != ImpactRule::Newton) write("impact", rules.impact, kImpactNames);
    if (rules.yield_speed != 0) write("yield_speed", rules.yield_speed);
    if (rules.tangential_restitution != 0) write("tangential_restitution", rules.tangential_restitution);
    if (rules.friction_after_stop != 1) write("friction_after_stop", rules.friction_after_stop);
    if (rules.friction_while_sliding != 1) write("friction_while_sliding", rules.friction_while_sliding);
    out_.end('}');
  }

  void body(const Body& body) {
    out_.begin('{');
    write("name", body.name);
    write("type", body.type, kBodyTypeNames);
    write("position", body.position);
    write("angle", body.angle);
    write("velocity", body.velocity);
    write("angular_velocity", body.angular_velocity);
    write("mass", body.mass);
    if (body.inertia) write("inertia", *body.inertia);
    write("fixed_rotation", body.fixed_rotation);
    write("lock_x", body.lock_x);
    write("lock_y", body.lock_y);
    write("gravity_scale", body.gravity_scale);
    write("linear_damping", body.linear_damping);
    write("angular_damping", body.angular_damping);
    if (!body.motion.empty()) motion(body.motion);
    list("shapes", body.shapes, [this](const Shape& shape) { this->shape(shape); });
    out_.end('}');
  }

  void motion(const PrescribedMotion& motion) {
    out_.key("motion");
    out_.begin('{', Emitter::Layout::Inline);
    if (!motion.x.empty()) write("x", motion.x);
    if (!motion.y.empty()) write("y", motion.y);
    if (!motion.angle.empty()) write("angle", motion.angle);
    out_.end('}');
  }

  void drive(const Drive& drive) {
    out_.begin('{');
    write("joint", drive.joint);
    write("speed", drive.speed);
    out_.end('}');
  }

  void shape(const Shape& shape) {
    out_.begin('{');
    write("type", kGeometryNames[shape.geometry.index()]);
    std::visit([this](const auto& geometry) { this->geometry(geometry); }, shape.geometry);
    write("position", shape.position);
    write("angle", shape.angle);
    write("friction", shape.friction);
    write("restitution", shape.restitution);
    write("rolling_resistance", shape.rolling_resistance);
    write("surface_speed", shape.surface_speed);
    if (shape.density) write("density", *shape.density);
    out_.key("filter");
    out_.begin('{', Emitter::Layout::Inline);
    // Signed, so that all bits are -1: readers with doubles would round 2^64 - 1.
    out_.key("category"), out_.integer(static_cast<std::int64_t>(shape.filter.category));
    out_.key("mask"), out_.integer(static_cast<std::int64_t>(shape.filter.mask));
    out_.key("group"), out_.integer(shape.filter.group);
    out_.end('}');
    out_.end('}');
  }

  void geometry(const Circle& circle) { write("radius", circle.radius); }
  void geometry(const Box& box) {
    write("width", box.width);
    write("height", box.height);
  }

  void geometry(const Capsule& capsule) {
    write("start", capsule.start);
    write("end", capsule.end);
    write("radius", capsule.radius);
  }
  void geometry(const Polygon& polygon) {
    points(polygon.points);
    write("radius", polygon.radius);
  }
  void geometry(const Segment& segment) {
    write("start", segment.start);
    write("end", segment.end);
  }
  void geometry(const Chain& chain) {
    points(chain.points);
    write("closed", chain.closed);
  }
  void points(const std::vector<Vec2d>& points) {
    out_.key("points");
    out_.begin('[', Emitter::Layout::Inline);
    for (const Vec2d point : points) out_.vector(point);
    out_.end(']');
  }

  void write(std::string_view key, const Spring& spring) {
    out_.key(key);
    out_.begin('{', Emitter::Layout::Inline);
    write("hertz", spring.hertz);
    write("damping_ratio", spring.damping_ratio);
    out_.end('}');
  }
  void write(std::string_view key, const Motor& motor) {
    out_.key(key);
    out_.begin('{', Emitter::Layout::Inline);
    write("speed", motor.speed);
    write("max_force", motor.max_force);
    out_.end('}');
  }
  /// JSON has no infinity: an infinite end of a range is left out.
  void write(std::string_view key, const Range& range) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    out_.key(key);
    out_.begin('{', Emitter::Layout::Inline);
    if (range.lower != -kInfinity) write("lower", range.lower);
    if (range.upper != kInfinity) write("upper", range.upper);
    out_.end('}');
  }
  template <class T>
  void write(std::string_view key, const std::optional<T>& value) {
    if (value) write(key, *value);
  }

  void joint(const Joint& joint) {
    out_.begin('{');
    write("type", kJointNames[joint.index()]);
    std::visit(
        [this](const auto& any) {
          write("name", any.name);
          write("body_a", any.body_a);
          write("body_b", any.body_b);
          const auto field = [&](std::string_view key, const auto& value, const FieldRule&) {
            write(key, value);
          };
          anchor_fields(any, field);
          own_fields(any, field);
          last_fields(any, field);
        },
        joint);
    out_.end('}');
  }

  void force(const ForceLaw& force) {
    out_.begin('{');
    write("type", kForceNames[force.index()]);
    std::visit(
        [this](const auto& law) {
          if constexpr (requires { law.body; }) write("body", law.body);
          this->law(law);
        },
        force);
    out_.end('}');
  }

  void law(const LinearDrag& drag) {
    write("coefficient", drag.coefficient);
    write("angular_coefficient", drag.angular_coefficient);
  }
  void law(const QuadraticDrag& drag) { write("coefficient", drag.coefficient); }
  void law(const PointForce& force) {
    write("force", force.force);
    write("point", force.point);
    write("frame", force.frame, kFrameNames);
    times(force.start, force.duration);
  }
  void law(const Torque& torque) {
    write("torque", torque.torque);
    times(torque.start, torque.duration);
  }

  void law(const SpringForce& spring) {
    write("body_a", spring.body_a);
    write("body_b", spring.body_b);
    write("anchor_a", spring.anchor_a);
    write("anchor_b", spring.anchor_b);
    write("rest_length", spring.rest_length);
    write("stiffness", spring.stiffness);
    write("damping", spring.damping);
  }
  void law(const AttractionForce& attraction) {
    write("centre_body", attraction.centre_body);
    write("centre", attraction.centre);
    write("strength", attraction.strength);
    out_.key("exponent"), out_.integer(attraction.exponent);
  }
  void law(const SinusoidalForce& force) {
    write("amplitude", force.amplitude);
    write("point", force.point);
    write("angular_frequency", force.angular_frequency);
    write("phase", force.phase);
  }

  void law(const FormulaForce& force) {
    out_.key("force");
    out_.begin('[', Emitter::Layout::Inline);
    out_.string(force.x);
    out_.string(force.y);
    out_.end(']');
    write("torque", force.torque);
    write("point", force.point);
  }
  void law(const FormulaSpring& spring) {
    write("body_a", spring.body_a);
    write("body_b", spring.body_b);
    write("anchor_a", spring.anchor_a);
    write("anchor_b", spring.anchor_b);
    write("tension", spring.tension);
  }

  /// JSON has no infinity: an infinite duration is left out.
  void times(double start, double duration) {
    write("start", start);
    if (duration != std::numeric_limits<double>::infinity()) write("duration", duration);
  }

  Emitter out_;
  bool failed_ = false;
};

}  // namespace

std::string to_json(const Scene& scene, int indent) {
  Writer writer(indent);
  writer.scene(scene);
  if (writer.failed()) {
    validate(scene);  // throws with the name of the offending value
    throw Error(Error::Kind::Value, scene_subject(scene.name), "", "", "holds something that JSON cannot");
  }
  return writer.take();
}

}  // namespace plumb
