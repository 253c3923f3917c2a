#include "engine/simulation/precise_joints.h"

#include <cmath>
#include <limits>
#include <type_traits>

#include "engine/joints/kind_of.h"
#include "engine/math/trigonometry.h"
#include "engine/solve/joint_angle.h"

namespace plumb::precise {

/// How a joint's two bodies stand and move; derivatives are along `Directions`.
struct KindJoints::Ends {
  JointPose<Dual> pose{};
  Vec2<Dual> velocity_a{}, velocity_b{};
  Dual spin_a{}, spin_b{};
};

/// The rates at which places and velocities of both bodies change with whatever derivatives are taken by.
struct KindJoints::Directions {
  Twist<double> place_a{}, place_b{}, motion_a{}, motion_b{};
};

/// Forces on both bodies.
struct KindJoints::Pull {
  Wrench<Dual> a{}, b{};

  void add(const JointRow<Dual>& row, Dual lambda) {
    a.force += lambda * row.linear_a, a.torque += lambda * row.angular_a;
    b.force += lambda * row.linear_b, b.torque += lambda * row.angular_b;
  }
};

namespace {

Vec2<Dual> moving(Vec2d value, Vec2d change) { return {{value.x, change.x}, {value.y, change.y}}; }

Rotation<Dual> turning(Rotation<double> q, double change) {
  return {{q.c, -q.s * change}, {q.s, q.c * change}};
}

template <class Rows>
constexpr bool kPulley = std::is_same_v<Rows, PulleyRows<Dual>>;

/// Whole turns that bring an angle into [-pi, pi].
double turns_back(double angle) { return nearest_turn(angle, 0) - angle; }

const Body* body_called(const Scene& scene, const std::string& name) {
  const auto index = find_body(scene, name);
  return index ? &scene.bodies[*index] : nullptr;
}

}  // namespace

KindJoints::Ends KindJoints::ends_of(const Entry& e, const BodiesNow& now, const Directions& along) {
  const auto pose_of = [&](int body) { return body == kFixedFrame ? Pose<double>{} : now.poses[body]; };
  const auto twist_of = [&](int body) { return body == kFixedFrame ? Twist<double>{} : now.twists[body]; };
  const auto angle_of_body = [&](int body) { return body == kFixedFrame ? 0.0 : now.angles[body]; };
  const Pose<double> a = pose_of(e.a), b = pose_of(e.b);
  const Twist<double> motion_a = twist_of(e.a), motion_b = twist_of(e.b);
  Ends ends;
  ends.pose.rotation_a = turning(a.rotation, along.place_a.angular_velocity);
  ends.pose.rotation_b = turning(b.rotation, along.place_b.angular_velocity);
  ends.velocity_a = moving(motion_a.velocity, along.motion_a.velocity);
  ends.velocity_b = moving(motion_b.velocity, along.motion_b.velocity);
  ends.spin_a = {motion_a.angular_velocity, along.motion_a.angular_velocity};
  ends.spin_b = {motion_b.angular_velocity, along.motion_b.angular_velocity};
  std::visit(
      [&](const auto& kind) {
        using Rows = std::remove_cvref_t<decltype(kind)>;
        if constexpr (Rows::kGrounded) {
          ends.pose.offset = moving(b.position - kind.ground_b, along.place_b.velocity);
          ends.pose.offset_a = moving(a.position - kind.ground_a, along.place_a.velocity);
        } else {
          ends.pose.offset = moving(b.position - a.position, along.place_b.velocity - along.place_a.velocity);
        }
        if constexpr (Rows::kAngle != AngleUse::None) {
          double angle = angle_of_body(e.b) - e.ratio * angle_of_body(e.a) + e.angle_offset;
          if (Rows::kAngle == AngleUse::Wrapped) angle = nearest_turn(angle, 0);
          ends.pose.angle = {angle,
                             along.place_b.angular_velocity - e.ratio * along.place_a.angular_velocity};
        }
      },
      e.kind);
  return ends;
}

/// Calls visit.row(row, rule) for each scalar coordinate with each of its rules, and visit.point(point, rule)
/// for a point whose rule is not rigid. The residual of a row is C.
template <class Visit>
void KindJoints::each_coordinate(const Entry& e, const Ends& ends, const Visit& visit) {
  std::visit(
      [&](const auto& kind) {
        using Rows = std::remove_cvref_t<decltype(kind)>;
        JointRows<Dual> rows;
        kind.evaluate(ends.pose, rows);
        const auto coordinate = [&](JointRow<Dual> row, const RowRules& rules) {
          const Dual q = row.residual;
          for (int i = 0; i < rules.count; ++i) {
            row.residual = q - rules.rule[i].origin;
            visit.row(row, rules.rule[i]);
          }
        };
        for (int i = 0; i < Rows::kBlock; ++i) visit.row(rows.block[i], RowRule{});
        for (int i = 0; i < Rows::kAxial; ++i) coordinate(rows.axial[i], e.rules.axial[i]);
        if constexpr (Rows::kTurn) coordinate({{}, {}, -1, 1, ends.pose.angle}, e.rules.turn);
        if constexpr (Rows::kPoint) {
          if (e.rules.point.role == RowRole::Rigid) {
            visit.row(rows.point.plain_row({1, 0}), e.rules.point);
            visit.row(rows.point.plain_row({0, 1}), e.rules.point);
          } else {
            visit.point(rows.point, e.rules.point);
          }
        }
      },
      e.kind);
}

KindJoints::Pull KindJoints::pull_of_springs(const Entry& e, const Ends& ends) {
  struct Visitor {
    const Entry& e;
    const Ends& ends;
    Pull& pull;

    void row(const JointRow<Dual>& j, const RowRule& rule) const {
      if (rule.role != RowRole::Spring) return;
      const Dual response = e.mass_a * dot(j.linear_a, j.linear_a) + e.inertia_a * j.angular_a * j.angular_a +
                            e.mass_b * dot(j.linear_b, j.linear_b) + e.inertia_b * j.angular_b * j.angular_b;
      if (!(response > 0)) return;
      const Dual rate = dot(j.linear_a, ends.velocity_a) + j.angular_a * ends.spin_a +
                        dot(j.linear_b, ends.velocity_b) + j.angular_b * ends.spin_b;
      const double w = kWholeTurn * rule.spring.hertz;
      Dual force = -(w * w * j.residual + 2 * rule.spring.damping_ratio * w * rate) / response;
      if (force > rule.max_force) force = rule.max_force;
      if (force < -rule.max_force) force = -rule.max_force;
      pull.add(j, force);
    }

    void point(const AnchorPoint<Dual>& at, const RowRule& rule) const {
      if (rule.role != RowRole::Spring) return;
      const JointRow<Dual> x = at.plain_row({1, 0}), y = at.plain_row({0, 1});
      const double mass = e.mass_a + e.mass_b;
      const Dual xx =
          mass + e.inertia_a * x.angular_a * x.angular_a + e.inertia_b * x.angular_b * x.angular_b;
      const Dual yy =
          mass + e.inertia_a * y.angular_a * y.angular_a + e.inertia_b * y.angular_b * y.angular_b;
      const Dual xy = e.inertia_a * x.angular_a * y.angular_a + e.inertia_b * x.angular_b * y.angular_b;
      const Dual determinant = xx * yy - xy * xy;
      if (!(determinant > 0)) return;
      const Vec2<Dual> rate =
          (ends.velocity_b + cross(ends.spin_b, at.arm_b)) - (ends.velocity_a + cross(ends.spin_a, at.arm_a));
      const double w = kWholeTurn * rule.spring.hertz;
      const Vec2<Dual> wanted = Dual(w * w) * at.gap + Dual(2 * rule.spring.damping_ratio * w) * rate;
      Vec2<Dual> force =
          (Dual(-1) / determinant) * Vec2<Dual>{yy * wanted.x - xy * wanted.y, xx * wanted.y - xy * wanted.x};
      const Dual size = sqrt(length_squared(force));
      if (size > rule.max_force) force *= Dual(rule.max_force) / size;
      pull.add(x, force.x);
      pull.add(y, force.y);
    }
  };
  Pull pull;
  each_coordinate(e, ends, Visitor{e, ends, pull});
  return pull;
}

namespace {

/// Calls `take(row)` for each rigid row.
template <class Take>
struct RigidRows {
  const Take& take;
  void row(const JointRow<Dual>& j, const RowRule& rule) const {
    if (rule.role == RowRole::Rigid) take(j);
  }
  void point(const AnchorPoint<Dual>&, const RowRule&) const {}
};
template <class Take>
RigidRows(const Take&) -> RigidRows<Take>;

}  // namespace

KindJoints::Pull KindJoints::pull_of_rows(const Entry& e, const Ends& ends,
                                          std::span<const double> multipliers) {
  Pull pull;
  std::size_t next = e.first_row;
  const auto take = [&](const JointRow<Dual>& j) { pull.add(j, multipliers[next++]); };
  each_coordinate(e, ends, RigidRows{take});
  return pull;
}

void KindJoints::rows(const BodiesNow& now, std::span<Row<double>> out) const {
  for (const Entry& e : entries_) {
    if (e.rows == 0) continue;
    const auto twist_of = [&](int body) { return body == kFixedFrame ? Twist<double>{} : now.twists[body]; };
    const Twist<double> motion_a = twist_of(e.a), motion_b = twist_of(e.b);
    std::size_t next = e.first_row;
    const auto take = [&](const JointRow<Dual>& j) {
      const auto value = [](Vec2<Dual> v) { return Vec2d{v.x.value, v.y.value}; };
      const auto change = [](Vec2<Dual> v) { return Vec2d{v.x.change, v.y.change}; };
      Row<double>& row = out[next++];
      row = {e.a,
             e.b,
             value(j.linear_a),
             value(j.linear_b),
             j.angular_a.value,
             j.angular_b.value,
             j.residual.value,
             dot(change(j.linear_a), motion_a.velocity) + j.angular_a.change * motion_a.angular_velocity +
                 dot(change(j.linear_b), motion_b.velocity) + j.angular_b.change * motion_b.angular_velocity};
    };
    each_coordinate(e, ends_of(e, now, {.place_a = motion_a, .place_b = motion_b}), RigidRows{take});
  }
}

void KindJoints::add_springs(const BodiesNow& now, std::span<Wrench<double>> out) const {
  for (const Entry& e : entries_) {
    if (!e.has_springs) continue;
    const Pull pull = pull_of_springs(e, ends_of(e, now, {}));
    const auto add = [&](int body, const Wrench<Dual>& w) {
      if (body == kFixedFrame) return;
      out[body].force += Vec2d{w.force.x.value, w.force.y.value};
      out[body].torque += w.torque.value;
    };
    add(e.a, pull.a);
    add(e.b, pull.b);
  }
}

/// The derivatives of a pull by the first `directions` of: x, y and angle of a, of b; their velocities.
template <class Evaluate>
void KindJoints::add_blocks(const Entry& e, const BodiesNow& now, int directions, const Evaluate& evaluate,
                            std::vector<ForceBlock>& out) {
  const int body[2] = {e.a, e.b};
  ForceBlock blocks[2][2];
  for (int k = 0; k < directions; ++k) {
    const int by = (k / 3) % 2, column = k % 3;
    Directions along;
    Twist<double>& unit =
        k < 6 ? (by == 0 ? along.place_a : along.place_b) : (by == 0 ? along.motion_a : along.motion_b);
    (column == 0 ? unit.velocity.x : column == 1 ? unit.velocity.y : unit.angular_velocity) = 1;
    const Pull pull = evaluate(ends_of(e, now, along));
    const Wrench<Dual> wrench[2] = {pull.a, pull.b};
    for (int on = 0; on < 2; ++on) {
      auto& matrix = k < 6 ? blocks[on][by].position : blocks[on][by].velocity;
      matrix[0][column] = wrench[on].force.x.change;
      matrix[1][column] = wrench[on].force.y.change;
      matrix[2][column] = wrench[on].torque.change;
    }
  }
  for (int on = 0; on < 2; ++on) {
    for (int by = 0; by < 2; ++by) {
      if (body[on] == kFixedFrame || body[by] == kFixedFrame) continue;
      blocks[on][by].on = static_cast<std::size_t>(body[on]);
      blocks[on][by].by = static_cast<std::size_t>(body[by]);
      out.push_back(blocks[on][by]);
    }
  }
}

void KindJoints::add_spring_blocks(const BodiesNow& now, std::vector<ForceBlock>& out) const {
  for (const Entry& e : entries_) {
    if (!e.has_springs) continue;
    add_blocks(
        e, now, 12, [&](const Ends& ends) { return pull_of_springs(e, ends); }, out);
  }
}

void KindJoints::add_tension_blocks(const BodiesNow& now, std::span<const double> multipliers,
                                    std::vector<ForceBlock>& out) const {
  for (const Entry& e : entries_) {
    if (e.rows == 0) continue;
    add_blocks(
        e, now, 6, [&](const Ends& ends) { return pull_of_rows(e, ends, multipliers); }, out);
  }
}

void KindJoints::add(const Scene& scene, const Joint& joint, std::vector<Entry>& entries) {
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
          plain = !definition.spring;
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
          plain = true;  // not one that Precise takes
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
  if (std::holds_alternative<MouseRows<Dual>>(e.kind)) e.a = kFixedFrame, e.mass_a = e.inertia_a = 0;
  entries.push_back(std::move(e));
}

KindJoints::KindJoints(const Scene& scene) {
  std::vector<Pose<double>> poses;
  std::vector<double> angles;
  for (const Body& body : scene.bodies) {
    poses.push_back({body.position, rotation_of(body.angle)});
    angles.push_back(body.angle);
  }
  const std::vector<Twist<double>> twists(scene.bodies.size());
  const BodiesNow start{poses, angles, twists};
  for (const Joint& joint : scene.joints) {
    const std::size_t before = entries_.size();
    add(scene, joint, entries_);
    if (entries_.size() == before) continue;
    Entry& e = entries_.back();
    // Turns are counted from the angles that are nearest at the start, as gears and springs are put together.
    const double angle_a = e.a == kFixedFrame ? 0 : angles[static_cast<std::size_t>(e.a)];
    const double angle_b = e.b == kFixedFrame ? 0 : angles[static_cast<std::size_t>(e.b)];
    std::visit(
        [&](const auto& kind) {
          using Rows = std::remove_cvref_t<decltype(kind)>;
          if constexpr (Rows::kAngle == AngleUse::Geared) {
            const double back_a = e.ratio * turns_back(angle_a), fits = e.ratio * angle_a + back_a;
            e.angle_offset = turns_back(angle_b - fits - kind.reference) - back_a - kind.reference;
          } else if constexpr (Rows::kAngle != AngleUse::None) {
            e.angle_offset = turns_back(angle_b - angle_a) - kind.reference;
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
    if (!e.rigid_elsewhere) each_coordinate(e, ends_of(e, start, {}), RigidRows{count});
    row_names_.insert(row_names_.end(), e.rows, std::visit([](const auto& j) { return j.name; }, joint));
    struct Springs {
      bool& any;
      void row(const JointRow<Dual>&, const RowRule& rule) const {
        any = any || rule.role == RowRole::Spring;
      }
      void point(const AnchorPoint<Dual>&, const RowRule& rule) const {
        any = any || rule.role == RowRole::Spring;
      }
    };
    each_coordinate(e, ends_of(e, start, {}), Springs{e.has_springs});
    has_springs_ = has_springs_ || e.has_springs;
  }
}

}  // namespace plumb::precise
