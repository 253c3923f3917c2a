#include "harness/course/design.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "harness/course/scenes.h"

namespace plumb::course {
namespace {

// The design variants for a chapter, before anything is measured.
std::vector<Manner> variants(int chapter) {
  switch (chapter) {
    case 1:
      return {{},
              {.once = true},
              {.once = true, .after_move = true},
              {.sweeps = 20},
              {.sweeps = 10},
              {.sweeps = 20, .deep = true}};
    case 2:
      return {{}};
    case 3:
      return {{},
              {.once = true},
              {.once = true, .after_move = true},
              {.sweeps = 10},
              {.sweeps = 20},
              {.once = true, .share = 0.4},
              {.once = true, .share = 0.2}};
    case 4:
      return {{},
              {.clips = true},
              {.clips = true, .turning_push = true},
              {.clips = true, .extends = true},
              {.clips = true, .extends = true, .turning_push = true},
              {.once = true},
              {.sweeps = 20},
              {.sweeps = 10},
              {.sweeps = 5},
              {.sweeps = 30}};
    default:
      return {{},
              {.clips = true},
              {.clips = true, .turning_push = true},
              {.once = true},
              {.by_positions = true},
              {.sweeps = 10},
              {.sweeps = 20},
              {.fed = 0.2}};
  }
}

// The chapters in which forces act and boxes turn.
constexpr int kForces = 2, kBoxes = 4;

}  // namespace

std::optional<Push> measured_push(const Lab& lab) try {
  constexpr double kDeep = 0.1, kRadius = 0.4;  // m
  constexpr int kSteps = 6;
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}));
  const Body ball = make(Ball{.position = {0, kRadius - kDeep}, .radius = kRadius, .restitution = 0});
  const Trace trace = lab.run(scene_of("overlap", {}, {ball, floor}), (kSteps + 0.5) * lab.dt());
  const auto deep = [&](std::size_t k) { return kRadius - trace.states[k][0].position.y; };
  const double first = deep(0) - deep(1), second = deep(1) - deep(2);
  if (!(first > 0) || second < 0) return std::nullopt;
  const Push out{.share = 1 - second / first, .slop = deep(0) - first / (1 - second / first)};
  if (!(out.share > 0.01) || !(out.slop > -1e-9 && out.slop < 0.02)) return std::nullopt;
  double left = deep(0);
  for (std::size_t k = 1; k < trace.states.size(); ++k) {
    left -= out.share * (left - out.slop);
    if (std::abs(deep(k) - left) > 1e-9) return std::nullopt;
  }
  return out;
} catch (const std::exception&) {
  return std::nullopt;
}

std::optional<double> measured_joint_error(const Lab& lab) try {
  constexpr double kLength = 1, kTooLong = 0.05;  // m
  Scene scene =
      scene_of("stick too long", {}, {make(Ball{.position = {kLength + kTooLong, 0}, .radius = 0.1})});
  DistanceJoint stick;
  stick.name = "stick";
  stick.body_a = kWorld;
  stick.body_b = scene.bodies[0].name;
  stick.length = kLength;
  scene.joints.emplace_back(stick);
  const Trace trace = lab.run(scene, 2.5 * lab.dt());
  const auto error = [&](std::size_t k) { return trace.states[k][0].position.x - kLength; };
  const double left = error(1) / error(0);
  constexpr double kMost = 1e3;  // with the wrong sign a correction makes the error grow
  if (trace.states[1][0].velocity != Vec2d{} || !(left >= 0 && left < kMost)) return std::nullopt;
  if (std::abs(error(2) - left * error(1)) > 1e-9 * std::max(1.0, left * left)) return std::nullopt;
  return left;
} catch (const std::exception&) {
  return std::nullopt;
}

bool turns_bodies(const Lab& lab) try {
  Body ball = make(Ball{});
  ball.angular_velocity = 1;
  return lab.run(scene_of("turning ball", {}, {ball}), 1.5 * lab.dt()).last(0).angle != 0;
} catch (const std::exception&) {
  return false;
}

std::optional<int> measured_corrections(const Lab& lab, Manner like, double left) try {
  constexpr double kLength = 1, kTooLong = 0.05;  // m
  constexpr int kMost = 30;
  Scene scene = scene_of("two sticks too long", {},
                         {make(Ball{.name = "a", .position = {kLength + kTooLong, 0}, .radius = 0.1}),
                          make(Ball{.name = "b", .position = {2 * (kLength + kTooLong), 0}, .radius = 0.1})});
  const auto join = [&](const std::string& a, const std::string& b) {
    DistanceJoint stick;
    stick.name = "stick of " + b;
    stick.body_a = a;
    stick.body_b = b;
    stick.length = kLength;
    scene.joints.emplace_back(stick);
  };
  join(std::string(kWorld), "a");
  join("a", "b");
  const auto places = [&](const Lab& of) { return of.run(scene, 1.5 * lab.dt()).states[1]; };
  const std::vector<BodyState> due = places(lab);
  for (like.corrections = 1; like.corrections <= kMost; ++like.corrections) {
    like.joint_share = std::abs(1 - std::pow(left, 1.0 / like.corrections));
    const auto student = make_student("", lab.scheme(), like);
    const std::vector<BodyState> is = places(Lab(*student, lab.plain_settings()));
    const double off =
        std::abs(is[0].position.x - due[0].position.x) + std::abs(is[1].position.x - due[1].position.x);
    if (off < 1e-9) return like.corrections;
  }
  return std::nullopt;
} catch (const std::exception&) {
  return std::nullopt;
}

std::optional<int> measured_sweeps(const Lab& lab, Manner like) try {
  // The centres are 1 m apart, so that a normal that is not normalised is right too.
  constexpr double kRadius = 0.505, kDeep = 0.01, kGravity = 9.81;  // m, m, m/s^2
  constexpr int kMost = 60;
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}));
  const auto ball = [](const char* name, double y, double mass) {
    return make(Ball{.name = name, .position = {0, y}, .mass = mass, .radius = kRadius, .restitution = 0});
  };
  const Scene scene =
      scene_of("heavy on light", {0, -kGravity},
               {ball("light", kRadius - kDeep, 1), ball("heavy", 3 * kRadius - 2 * kDeep, 50), floor});
  const auto speeds = [&](const Lab& of) { return of.run(scene, 1.5 * lab.dt()).states[1]; };
  const std::vector<BodyState> due = speeds(lab);
  for (like.sweeps = 1; like.sweeps <= kMost; ++like.sweeps) {
    const auto student = make_student("", lab.scheme(), like);
    const std::vector<BodyState> is = speeds(Lab(*student, lab.plain_settings()));
    const double off =
        std::abs(is[0].velocity.y - due[0].velocity.y) + std::abs(is[1].velocity.y - due[1].velocity.y);
    if (off < 1e-9) return like.sweeps;
  }
  return std::nullopt;
} catch (const std::exception&) {
  return std::nullopt;
}

std::vector<Manner> manners_of(int chapter, const Lab& lab) {
  std::vector<Manner> out = variants(chapter);
  if (const auto push = measured_push(lab))
    for (Manner& manner : out) {
      if (manner.share == Manner{}.share) manner.share = push->share;
      manner.slop = std::max(0.0, push->slop);
    }
  if (chapter < kBoxes && !turns_bodies(lab))
    for (Manner& manner : out) manner.turns = false;
  if (chapter != kForces)
    if (const auto sweeps = measured_sweeps(lab, out.front()))
      for (Manner& manner : out)
        if (manner.sweeps == Manner{}.sweeps) manner.sweeps = *sweeps;
  if (chapter <= kBoxes) return out;
  if (const auto left = measured_joint_error(lab)) {
    const auto corrections = measured_corrections(lab, out.front(), *left);
    for (Manner& manner : out) {
      manner.corrections = corrections.value_or(std::max(1, manner.sweeps / 4));
      manner.joint_share = std::abs(1 - std::pow(*left, 1.0 / manner.corrections));
    }
  }
  return out;
}

}  // namespace plumb::course
