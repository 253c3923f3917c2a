#include "harness/course/turning_scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

constexpr double kSpeed = 2, kRadius = 0.3;  // m/s, m

Rotation<double> turn_by(double angle) { return {std::cos(angle), std::sin(angle)}; }

// Throws a ball along `way` at a point of a static box that is `reach` m from its centre.
Rebound thrown(const Lab& lab, const Body& box, Vec2d way, double reach) {
  const Vec2d from = box.position - (reach + kRadius + 0.713) * way;
  const Body ball =
      make(Ball{.position = from, .velocity = kSpeed * way, .radius = kRadius, .restitution = 0.5});
  const Trace trace = lab.run(scene_of("end of a box", {}, {ball, box}), 0.8);
  Rebound out{.back = -dot(trace.last(0).velocity, way)};
  for (const auto& states : trace.states)
    out.deep = std::max(out.deep, reach + kRadius - dot(box.position - states[0].position, way));
  return out;
}

// Runs a scene whose first body is a box; a refusal counts as the motion that is due.
Spin spin_of(const Lab& lab, const Scene& scene, double duration, double due) try {
  return {lab.run(scene, duration).last(0).angular_velocity, due};
} catch (const NotYet&) {
  return {due, due};
}

}  // namespace

Rebound off_a_corner(const Lab& lab) {
  const Body square =
      fixed(make(Crate{.position = {0.4, -0.7}, .angle = std::numbers::pi / 4, .restitution = 0}));
  return thrown(lab, square, {1, 0}, std::numbers::sqrt2 / 2);
}

Rebound off_a_rods_end(const Lab& lab) {
  constexpr double kTurned = 1.5, kHalf = 1;  // rad, m
  const Body rod = fixed(make(
      Crate{.position = {0.4, -0.7}, .angle = kTurned, .width = 0.2, .height = 2 * kHalf, .restitution = 0}));
  return thrown(lab, rod, turn_by(kTurned) * Vec2d{0, -1}, kHalf);
}

Spin by_a_spring(const Lab& lab) {
  constexpr double kTime = 0.3, kFine = 1e-4;  // s
  const Crate crate{
      .position = {-0.6, 0.4}, .angle = 1.3, .angular_velocity = -3, .mass = 2, .width = 1.2, .height = 0.5};
  const double inertia = crate.mass * (1.44 + 0.25) / 12;
  Scene scene = scene_of("spring at a corner", {}, {make(crate)});
  SpringForce law;
  law.body_a = kWorld;
  law.body_b = crate.name;
  law.anchor_a = {1.2, 1.1};
  law.anchor_b = {0.5, 0.2};
  law.rest_length = 1.2;
  law.stiffness = 4;
  law.damping = 4;
  scene.forces.emplace_back(law);
  // The same motion in steps so fine that their error does not count.
  Vec2d at = crate.position, v{};
  double angle = crate.angle, w = crate.angular_velocity;
  const double steps = std::floor(kTime / lab.dt() + 1e-6) * lab.dt() / kFine;
  for (int i = 0; i < static_cast<int>(std::round(steps)); ++i) {
    const Vec2d arm = turn_by(angle) * law.anchor_b, way = at + arm - law.anchor_a;
    const double length = std::hypot(way.x, way.y);
    const Vec2d along = 1 / length * way;
    const double tension =
        law.stiffness * (length - law.rest_length) + law.damping * dot(v + cross(w, arm), along);
    v -= kFine / crate.mass * tension * along;
    w -= kFine / inertia * tension * cross(arm, along);
    at += kFine * v;
    angle += kFine * w;
  }
  lab.run(scene_of("turning box", {}, {make(crate)}), kTime);
  return spin_of(lab, scene, kTime, w);
}

Spin by_a_force_of_the_box(const Lab& lab) {
  const Crate crate{.position = {2, 1}, .angle = 2, .mass = 2};
  Scene scene = scene_of("force of the box", {}, {make(crate)});
  PointForce law = push(crate.name, {1.5, -0.5}, {0.3, 0.4});
  law.frame = Frame::Body;
  scene.forces.emplace_back(law);
  constexpr double kTime = 0.25, kInertia = 1.0 / 3;  // s; 2 kg, 1 m by 1 m
  const double t = std::floor(kTime / lab.dt() + 1e-6) * lab.dt();
  return spin_of(lab, scene, kTime, cross(law.point, law.force) * t / kInertia);
}

Spin by_a_torque_for_a_time(const Lab& lab) {
  Scene scene = scene_of("torque for a time", {}, {make(Crate{.mass = 3, .width = 1, .height = 1})});
  constexpr double kInertia = 0.5;  // 3 kg, 1 m by 1 m
  Torque law;
  law.body = "box";
  law.torque = 2;
  law.start = 0.2;
  law.duration = 0.2;
  scene.forces.emplace_back(law);
  return spin_of(lab, scene, 0.6, law.torque * law.duration / kInertia);
}

Spin under_drag(const Lab& lab) {
  constexpr double kSpin = 2.5;
  const Crate crate{.velocity = {2, 1}, .angular_velocity = kSpin, .mass = 2};
  Scene scene = scene_of("drag", {}, {make(crate)});
  LinearDrag law;
  law.body = crate.name;
  law.coefficient = 0.7;
  scene.forces.emplace_back(law);
  return spin_of(lab, scene, 0.5, kSpin);
}

double sinks_of_joined_balls(const Lab& lab) {
  constexpr double kApart = 1, kSmall = 0.2;
  const auto ball = [](const char* name, double x) {
    return make(Ball{.name = name, .position = {x, kSmall + 0.05}, .radius = kSmall, .restitution = 0});
  };
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}));
  Scene scene = scene_of("joined balls", {0, -9.81}, {ball("a", 0), ball("b", kApart), floor});
  DistanceJoint stick;
  stick.name = "stick";
  stick.body_a = "a";
  stick.body_b = "b";
  stick.length = kApart;
  scene.joints.emplace_back(stick);
  const Trace trace = lab.run(scene, 0.8);
  return kSmall - std::min(trace.last(0).position.y, trace.last(1).position.y);
}

Stretch stick_at_a_rods_end(const Lab& lab) {
  const Vec2d end{0.5, 0.02};
  constexpr double kLength = 0.9;
  Scene scene = scene_of("stick at a rod's end", {},
                         {make(Crate{.name = "rod", .angle = 0.4, .mass = 2, .width = 1, .height = 0.1}),
                          make(Ball{.name = "ball", .velocity = {1, 1.4}, .radius = 0.1})});
  const Vec2d way{0.6, 0.8};
  scene.bodies[1].position = turn_by(0.4) * end + kLength * way;
  DistanceJoint stick;
  stick.name = "stick";
  stick.body_a = "rod";
  stick.body_b = "ball";
  stick.anchor_a = end;
  stick.length = kLength;
  scene.joints.emplace_back(stick);
  Stretch out;
  const Trace trace = lab.run(scene, 0.6);
  for (const auto& states : trace.states) {
    const Vec2d now = states[1].position - states[0].position - turn_by(states[0].angle) * end;
    const double apart = std::hypot(now.x, now.y);
    const Vec2d at_end =
        states[0].velocity + cross(states[0].angular_velocity, turn_by(states[0].angle) * end);
    out.change = std::max(out.change, std::abs(apart - kLength));
    if (&states != &trace.states.front())
      out.speed = std::max(out.speed, std::abs(dot(states[1].velocity - at_end, now)) / apart);
  }
  return out;
}

Tilt tips_over_an_end(const Lab& lab, double side, bool pillar_first) {
  constexpr double kTime = 0.3, kFine = 1e-4, kGravity = 9.81;             // s, s, m/s^2
  constexpr double kHalf = 0.6, kBeyond = 0.2, kWidth = 2, kHeight = 0.2;  // m
  const Body plank = make(Crate{.name = "plank",
                                .position = {side * (kHalf + kBeyond), kHeight / 2},
                                .width = kWidth,
                                .height = kHeight,
                                .restitution = 0,
                                .friction = 2});
  const Body pillar = fixed(make(Crate{.name = "pillar",
                                       .position = {0, -1},
                                       .width = 2 * kHalf,
                                       .height = 2,
                                       .restitution = 0,
                                       .friction = 2}));
  const auto bodies = pillar_first ? std::vector{pillar, plank} : std::vector{plank, pillar};
  const Trace trace = lab.run(scene_of("plank beyond a pillar", {0, -kGravity}, bodies), kTime);
  const double gyration =
      (kWidth * kWidth + kHeight * kHeight) / 12 + kBeyond * kBeyond + kHeight * kHeight / 4;
  double tilt = 0, speed = 0;
  for (double t = 0; t < trace.duration(); t += kFine) {
    speed += kFine * kGravity * (kBeyond * std::cos(tilt) + kHeight / 2 * std::sin(tilt)) / gyration;
    tilt += kFine * speed;
  }
  return {trace.last(pillar_first ? 1 : 0).angle, -side * tilt, 2.5 * lab.dt() * speed};
}

Spin hit_by_a_turning_rod(const Lab& lab) {
  constexpr double kArm = 0.8, kMass = 3, kTurns = 2, kSmall = 0.2;
  Body rod = make(Crate{.name = "rod", .mass = kMass, .width = 0.2, .height = 2});
  rod.angular_velocity = -kTurns;
  const Body ball = make(Ball{.position = {0.31, kArm}, .radius = kSmall});
  const double inertia = kMass * (0.04 + 4) / 12;
  const double due = 2 * kTurns * kArm / (1 + 1 / kMass + kArm * kArm / inertia);
  return {lab.run(scene_of("turning rod", {}, {ball, rod}), 0.3).last(0).velocity.x, due};
}

}  // namespace plumb::course
