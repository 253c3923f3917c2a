#include <cmath>
#include <type_traits>
#include <utility>

#include "engine/joints/joint_angle.h"
#include "engine/joints/kind_of.h"
#include "engine/math/trigonometry.h"
#include "engine/precise/dynamics/joint_coordinates.h"
#include "engine/precise/dynamics/joints.h"

// Compiles the joints of a scene for the equations of motion.
namespace plumb::precise {

namespace {

template <class Rows>
constexpr bool kPulley = std::is_same_v<Rows, PulleyRows<Dual>>;

const Body* body_called(const Scene& scene, const std::string& name) {
  const auto index = find_body(scene, name);
  return index ? &scene.bodies[*index] : nullptr;
}

}  // namespace

void GeneralJoints::add(const Scene& scene, const Joint& joint, std::vector<Entry>& entries) {
  Entry e;
  bool plain = false;
  std::visit(
      [&](const auto& definition) {
        using Definition = std::remove_cvref_t<decltype(definition)>;
        e.rules = rules_of(definition);
        if constexpr (std::is_same_v<Definition, WeldDefinition>) {
          if (definition.linear_spring || definition.angular_spring) {
            e.kind = SoftWeldRows<Dual>(definition, {}, {});
          } else {
            e.kind = WeldRows<Dual>(definition, {}, {});
          }
        } else if constexpr (std::is_same_v<Definition, DistanceDefinition>) {
          e.kind = DistanceRows<Dual>(definition, {}, {});
          plain = !definition.spring && !definition.range;
        } else if constexpr (std::is_same_v<Definition, RevoluteDefinition>) {
          e.kind = RevoluteRows<Dual>(definition, {}, {});
          e.rigid_elsewhere = true;
          plain = e.rules.angular.count == 0;
        } else if constexpr (std::is_same_v<Definition, PrismaticDefinition>) {
          e.kind = PrismaticRows<Dual>(definition, {}, {});
        } else if constexpr (std::is_same_v<Definition, WheelDefinition>) {
          e.kind = WheelRows<Dual>(definition, {}, {});
        } else if constexpr (std::is_same_v<Definition, MotorDefinition>) {
          e.kind = MotorRows<Dual>(definition, {}, {});
        } else if constexpr (std::is_same_v<Definition, MouseDefinition>) {
          e.kind = MouseRows<Dual>(definition, {}, {});
        } else if constexpr (std::is_same_v<Definition, GearDefinition>) {
          e.kind = GearRows<Dual>(definition, {}, {});
          e.ratio = definition.ratio;
        } else if constexpr (std::is_same_v<Definition, PulleyDefinition>) {
          e.kind = PulleyRows<Dual>(definition, {}, {});
        } else {
          plain = true;  // a kind that Precise does not support
        }
      },
      kind_of(joint));
  if (plain) return;
  const auto& [name_a, name_b] =
      std::visit([](const auto& j) { return std::pair(j.body_a, j.body_b); }, joint);
  const auto take_body = [&](const std::string& name, int& index, double& mass, double& inertia) {
    if (const auto body = find_body(scene, name)) index = static_cast<int>(*body);
    const Body* body = body_called(scene, name);
    if (body == nullptr || body->type != BodyType::Dynamic) return;
    const double own = inertia_of(*body);
    mass = 1 / body->mass;
    inertia = own > 0 ? 1 / own : 0;
  };
  take_body(name_a, e.a, e.mass_a, e.inertia_a);
  take_body(name_b, e.b, e.mass_b, e.inertia_b);
  e.name = std::visit([](const auto& j) { return j.name; }, joint);
  const auto pose_of = [&scene](int body) -> Pose<double> {
    if (body == kFixedFrame) return {};
    const BodyState state = initial_state(scene.bodies[static_cast<std::size_t>(body)]);
    return {state.position, rotation_of(state.angle)};
  };
  e.springs = spring_mobility(kind_of(joint), reference_of(pose_of(e.a), {}, pose_of(e.b), {}), {}, {},
                              {e.mass_a, e.inertia_a, e.mass_b, e.inertia_b});
  if (std::holds_alternative<MouseRows<Dual>>(e.kind)) e.a = kFixedFrame, e.mass_a = e.inertia_a = 0;
  entries.push_back(std::move(e));
}

/// Sets the anchors of a limit or motor whose coordinate is not an angle.
void GeneralJoints::set_limit_anchors(const Entry& e, bool moves, LimitOrMotor& limit_motor) {
  if (!moves) return;
  const auto value = [](Vec2<Dual> v) { return Vec2d{v.x.value, v.y.value}; };
  if (const auto* rod = std::get_if<DistanceRows<Dual>>(&e.kind)) {
    limit_motor.kind = LimitOrMotor::Kind::Distance;
    limit_motor.anchor_a = value(rod->anchor_a), limit_motor.anchor_b = value(rod->anchor_b);
  } else {
    limit_motor.kind = LimitOrMotor::Kind::Translation;
    if (const auto* rail = std::get_if<PrismaticRows<Dual>>(&e.kind))
      limit_motor.anchor_b = value(rail->anchor_b);
    if (const auto* wheel = std::get_if<WheelRows<Dual>>(&e.kind))
      limit_motor.anchor_b = value(wheel->anchor_b);
  }
}

GeneralJoints::GeneralJoints(const Scene& scene) {
  std::vector<Pose<double>> poses;
  std::vector<double> angles;
  for (const Body& body : scene.bodies) {
    const BodyState state = initial_state(body);
    poses.push_back({state.position, rotation_of(state.angle)});
    angles.push_back(state.angle);
  }
  const std::vector<Twist<double>> twists(scene.bodies.size());
  const BodiesView start{poses, angles, twists};
  for (const Joint& joint : scene.joints) {
    const std::size_t before = entries_.size();
    add(scene, joint, entries_);
    if (entries_.size() == before) continue;
    Entry& e = entries_.back();
    // Counts whole turns from the angles at creation.
    const double angle_a = e.a == kFixedFrame ? 0 : angles[static_cast<std::size_t>(e.a)];
    const double angle_b = e.b == kFixedFrame ? 0 : angles[static_cast<std::size_t>(e.b)];
    std::visit(
        [&](const auto& kind) {
          using Rows = std::remove_cvref_t<decltype(kind)>;
          if constexpr (Rows::kAngle != AngleUse::None) {
            const double angle = angle_b - e.ratio * angle_a;
            const Range range = limits_of(e.rules.angular);
            e.angle_offset = angle_at_creation(angle - kind.reference, range.lower, range.upper) - angle;
          }
          if constexpr (kPulley<Rows>) {
            JointRows<Dual> rows;
            kind.evaluate(ends_of(e, start, {}).pose, rows);
            RowRule& rope = e.rules.axial[0].rule[0];
            if (rope.origin == 0) rope.origin = rows.axial[0].residual.value;
          }
        },
        e.kind);
    e.first_row = row_names_.size();
    const auto count = [&](const JointRow<Dual>&) { ++e.rows; };
    if (!e.rigid_elsewhere) for_each_coordinate(e, ends_of(e, start, {}), RigidRows{count});
    row_names_.insert(row_names_.end(), e.rows, std::visit([](const auto& j) { return j.name; }, joint));
    e.first_limit_motor = limits_and_motors_.size();
    const auto& name = std::visit([](const auto& j) -> const std::string& { return j.name; }, joint);
    const auto add_limit_motor = [&](const JointRow<Dual>& row, const RowRule& rule) {
      LimitOrMotor limit_motor{.role = rule.role,
                               .speed = rule.speed,
                               .max_force = rule.max_force,
                               .joint = name,
                               .a = e.a,
                               .b = e.b};
      for (const Drive& drive : scene.drives) {
        if (rule.role == RowRole::Motor && drive.joint == name)
          limit_motor.drive = Formula(drive.speed, kTimeVariable);
      }
      set_limit_anchors(e, length_squared(Vec2d{row.linear_b.x.value, row.linear_b.y.value}) > 0,
                        limit_motor);
      limits_and_motors_.push_back(limit_motor);
    };
    for_each_coordinate(e, ends_of(e, start, {}), LimitMotorRows{add_limit_motor});
    e.limit_motors = limits_and_motors_.size() - e.first_limit_motor;
    struct Springs {
      bool& any;
      void row(const JointRow<Dual>&, const RowRule& rule) const {
        any = any || rule.role == RowRole::Spring;
      }
      void point(const AnchorPoint<Dual>&, const RowRule& rule) const {
        any = any || rule.role == RowRole::Spring;
      }
    };
    for_each_coordinate(e, ends_of(e, start, {}), Springs{e.has_springs});
    has_springs_ = has_springs_ || e.has_springs;
  }
}

}  // namespace plumb::precise
