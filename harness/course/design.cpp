#include "harness/course/design.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <string>

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
              {.clips = true, .against = true},
              {.clips = true, .deepest_first = true},
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

// Overlap of two bodies at the start, radius of the balls, m, and the number of steps.
constexpr double kDeep = 0.1, kRadius = 0.4;
constexpr int kSteps = 6;

double length(Vec2d a) { return std::hypot(a.x, a.y); }

// Returns what a step removes of an overlap, given the overlap after each step.
std::optional<Push> push_of(const Trace& trace, const std::function<double(std::size_t)>& deep) {
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
}

}  // namespace

std::optional<Push> measured_push(const Lab& lab) try {
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}));
  const Body ball = make(Ball{.position = {0, kRadius - kDeep}, .radius = kRadius, .restitution = 0});
  const Trace trace = lab.run(scene_of("overlap", {}, {ball, floor}), (kSteps + 0.5) * lab.dt());
  return push_of(trace, [&](std::size_t k) { return kRadius - trace.states[k][0].position.y; });
} catch (const std::exception&) {
  return std::nullopt;
}

std::optional<Push> measured_push_of_two(const Lab& lab) try {
  const auto ball = [](const char* name, double x) {
    return make(Ball{.name = name, .position = {x, 0}, .radius = kRadius, .restitution = 0});
  };
  const Trace trace = lab.run(scene_of("overlap of two", {}, {ball("a", 0), ball("b", 2 * kRadius - kDeep)}),
                              (kSteps + 0.5) * lab.dt());
  return push_of(trace, [&](std::size_t k) {
    return 2 * kRadius - (trace.states[k][1].position.x - trace.states[k][0].position.x);
  });
} catch (const std::exception&) {
  return std::nullopt;
}

// The error of a stick at rest, m, and with the other sign: an engine may correct one of the two only.
constexpr double kTooLong = 0.05;

// Balls at rest in a row, each on a stick of 1 m to the one before. The first stick hangs on the world or, if
// `free`, on a ball.
Scene row_on_sticks(std::size_t sticks, double too_long, bool free) {
  Scene scene = scene_of("row on sticks", {}, {});
  if (free) scene.bodies.push_back(make(Ball{.name = "ball", .radius = 0.1}));
  std::string before = free ? "ball" : std::string(kWorld);
  for (std::size_t i = 1; i <= sticks; ++i) {
    const std::string name = "ball " + std::to_string(i);
    scene.bodies.push_back(
        make(Ball{.name = name, .position = {static_cast<double>(i) * (1 + too_long), 0}, .radius = 0.1}));
    DistanceJoint stick;
    stick.name = "stick of " + name;
    stick.body_a = before;
    stick.body_b = name;
    stick.length = 1;
    scene.joints.emplace_back(stick);
    before = name;
  }
  return scene;
}

std::optional<double> measured_joint_error(const Lab& lab, double too_long, bool free) try {
  const Trace trace = lab.run(row_on_sticks(1, too_long, free), 2.5 * lab.dt());
  const auto error = [&](std::size_t k) {
    const std::vector<BodyState>& states = trace.states[k];
    return states.back().position.x - (free ? states.front().position.x : 0) - 1;
  };
  const double left = error(1) / error(0);
  constexpr double kMost = 1e3;  // with the wrong sign a correction makes the error grow
  if (trace.states[1].back().velocity != Vec2d{} || !(left >= 0 && left < kMost)) return std::nullopt;
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

std::optional<int> measured_corrections(const Lab& lab, Manner like, double left, double too_long,
                                        bool free) try {
  constexpr int kMost = 30;
  const Scene scene = row_on_sticks(2, too_long, free);
  const auto places = [&](const Lab& of) { return of.run(scene, 1.5 * lab.dt()).states[1]; };
  const std::vector<BodyState> due = places(lab);
  for (like.corrections = 1; like.corrections <= kMost; ++like.corrections) {
    like.joint_share = std::abs(1 - std::pow(left, 1.0 / like.corrections));
    const auto student = make_student("", lab.scheme(), like);
    const std::vector<BodyState> is = places(Lab(*student, lab.plain_settings()));
    double off = 0;
    for (std::size_t i = 0; i < is.size(); ++i) off += std::abs(is[i].position.x - due[i].position.x);
    if (off < 1e-9) return like.corrections;
  }
  return std::nullopt;
} catch (const std::exception&) {
  return std::nullopt;
}

std::optional<int> measured_sweeps(const Lab& lab, Manner like) try {
  // The centres are 1 m apart, so that a normal that is not normalised is right too.
  constexpr double kUnevenRadius = 0.505, kUnevenDepth = 0.01, kGravity = 9.81;  // m, m, m/s^2
  constexpr int kMost = 60;
  const Body floor =
      fixed(make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}));
  const auto ball = [](const char* name, double y, double mass, double vy = 0) {
    return make(Ball{.name = name,
                     .position = {0, y},
                     .velocity = {0, vy},
                     .mass = mass,
                     .radius = kUnevenRadius,
                     .restitution = 0});
  };
  // The second scene has no static body, for engines that treat those wrongly.
  const Scene scenes[] = {
      scene_of("heavy on light", {0, -kGravity},
               {ball("light", kUnevenRadius - kUnevenDepth, 1),
                ball("heavy", 3 * kUnevenRadius - 2 * kUnevenDepth, 50), floor}),
      scene_of("light between heavy", {},
               {ball("light", 0, 1), ball("upper", 2 * kUnevenRadius - kUnevenDepth, 50, -1),
                ball("lower", -2 * kUnevenRadius + kUnevenDepth, 40, 1)})};
  for (const Scene& scene : scenes) {
    const auto speeds = [&](const Lab& of) { return of.run(scene, 1.5 * lab.dt()).states[1]; };
    const std::vector<BodyState> due = speeds(lab);
    for (like.sweeps = 1; like.sweeps <= kMost; ++like.sweeps) {
      const auto student = make_student("", lab.scheme(), like);
      const std::vector<BodyState> is = speeds(Lab(*student, lab.plain_settings()));
      double off = 0;
      for (std::size_t i = 0; i < 2; ++i) off += std::abs(is[i].velocity.y - due[i].velocity.y);
      if (off < 1e-9) return like.sweeps;
    }
  }
  return std::nullopt;
} catch (const std::exception&) {
  return std::nullopt;
}

namespace {

// A body that lies on a floor without an overlap, under gravity.
Scene lying(const Body& body) {
  return scene_of(
      "lying", {0, -9.81},
      {body, fixed(make(Crate{
                 .name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}))});
}

// A box that overlaps a floor at rest.
Scene overlapping_box() {
  return scene_of(
      "overlapping box", {},
      {make(Crate{.position = {0.1, 0.4}, .width = 1.2, .height = 0.9, .restitution = 0}),
       fixed(
           make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}))});
}

// Three balls at rest in a row that overlap.
Scene overlapping_row() {
  Scene scene = scene_of("overlapping row", {}, {});
  for (const double place : {0, 1, 2})
    scene.bodies.push_back(make(Ball{.name = "ball " + std::to_string(scene.bodies.size()),
                                     .position = {place * (2 * kRadius - kDeep), 0},
                                     .radius = kRadius,
                                     .restitution = 0}));
  return scene;
}

// A ball at rest on a stick of the world that is too long and pulls it into a floor.
Scene ball_between() {
  Scene scene = scene_of(
      "ball between", {},
      {make(Ball{.position = {0, kRadius - kDeep}, .radius = kRadius, .restitution = 0}),
       fixed(
           make(Crate{.name = "floor", .position = {0, -0.5}, .width = 20, .height = 1, .restitution = 0}))});
  DistanceJoint stick;
  stick.name = "stick";
  stick.body_a = std::string(kWorld);
  stick.body_b = scene.bodies[0].name;
  stick.anchor_a = {0.3, -1};
  stick.length = 1;
  scene.joints.emplace_back(stick);
  return scene;
}

// Two rods at rest whose hinge gapes, both turned, with the anchors off their centres.
Scene gaping_hinge() {
  Scene scene = scene_of(
      "gaping hinge", {},
      {make(Crate{.name = "a", .angle = 0.4, .mass = 2, .width = 0.8, .height = 0.2}),
       make(Crate{
           .name = "b", .position = {0.8, 0.3}, .angle = -0.7, .mass = 1, .width = 0.8, .height = 0.2})});
  RevoluteJoint hinge;
  hinge.name = "hinge";
  hinge.body_a = "a";
  hinge.body_b = "b";
  hinge.anchor_a = {0.4, 0.05};
  hinge.anchor_b = {-0.4, 0.02};
  scene.joints.emplace_back(hinge);
  return scene;
}

}  // namespace

std::optional<bool> measured(const Lab& lab, const Scene& scene, Manner like, bool Manner::*property) try {
  const auto places = [&](const Lab& of) { return of.run(scene, 1.5 * lab.dt()).states[1]; };
  const std::vector<BodyState> due = places(lab);
  const auto is = [&](bool has) {
    like.*property = has;
    const auto student = make_student("", lab.scheme(), like);
    const std::vector<BodyState> now = places(Lab(*student, lab.plain_settings()));
    double off = 0;
    for (std::size_t i = 0; i < now.size(); ++i)
      off += length(now[i].position - due[i].position) + std::abs(now[i].angle - due[i].angle);
    return off < 1e-9;
  };
  const bool without = is(false), with = is(true);
  if (without == with) return std::nullopt;
  return with;
} catch (const std::exception&) {
  return std::nullopt;
}

std::vector<Manner> manners_of(int chapter, const Lab& lab) {
  std::vector<Manner> out = variants(chapter);
  const auto push = measured_push(lab), of_two = measured_push_of_two(lab);
  const auto with = [](std::vector<Manner> manners, const Push& by) {
    for (Manner& manner : manners) {
      if (manner.share == Manner{}.share) manner.share = by.share;
      manner.slop = std::max(0.0, by.slop);
    }
    return manners;
  };
  const std::vector<Manner> unmeasured = out;
  if (push) out = with(unmeasured, *push);
  // If overlaps of a static body are corrected by another share than those of two that move, one of the two
  // is a mistake.
  if (push && of_two && std::abs(push->share - of_two->share) > 1e-6)
    for (const Manner& manner : with(unmeasured, *of_two)) out.push_back(manner);
  if (chapter < kBoxes && !turns_bodies(lab))
    for (Manner& manner : out) manner.turns = false;
  const Scene ball = lying(make(Ball{.position = {0, 0.5}, .radius = 0.5, .restitution = 0}));
  const Scene box = lying(make(Crate{.position = {0, 0.5}, .restitution = 0}));
  if (chapter != kForces && measured(lab, ball, out.front(), &Manner::circles_touch_at_0).value_or(false))
    for (Manner& manner : out) manner.circles_touch_at_0 = true;
  if (chapter >= kBoxes && measured(lab, box, out.front(), &Manner::boxes_touch_at_0).value_or(false))
    for (Manner& manner : out) manner.boxes_touch_at_0 = true;
  if (chapter != kForces)
    if (const auto sweeps = measured_sweeps(lab, out.front()))
      for (Manner& manner : out)
        if (manner.sweeps == Manner{}.sweeps) manner.sweeps = *sweeps;
  if (chapter != kForces && measured(lab, overlapping_row(), out.front(), &Manner::in_turn).value_or(false))
    for (Manner& manner : out) manner.in_turn = true;
  Manner clips = out.front();
  clips.clips = true;
  if (chapter >= kBoxes && measured(lab, overlapping_box(), clips, &Manner::per_point).value_or(false))
    for (Manner& manner : out) manner.per_point = true;
  if (chapter <= kBoxes) return out;
  // A mistake may spoil the correction of errors of one sign, or of joints of the world.
  double too_long = kTooLong;
  if (measured_joint_error(lab, too_long, false) == 1.0) too_long = -kTooLong;
  std::optional<double> left;
  std::optional<int> corrections;
  for (const bool free : {false, true}) {
    if (corrections) break;
    const auto by_these = measured_joint_error(lab, too_long, free);
    if (!by_these) continue;
    corrections = measured_corrections(lab, out.front(), *by_these, too_long, free);
    if (!left || corrections) left = by_these;
  }
  if (left)
    for (Manner& manner : out) {
      manner.corrections = corrections.value_or(std::max(1, manner.sweeps / 4));
      manner.joint_share = std::abs(1 - std::pow(*left, 1.0 / manner.corrections));
    }
  if (measured(lab, ball_between(), out.front(), &Manner::joints_first).value_or(false))
    for (Manner& manner : out) manner.joints_first = true;
  const auto by_rows = measured(lab, gaping_hinge(), out.front(), &Manner::by_rows);
  if (by_rows == true)
    for (Manner& manner : out) manner.by_rows = true;
  // A mistake at hinges hides how their gaps are closed: the designs that do it along the gap are followed by
  // the same ones by rows.
  constexpr std::size_t kPlain = 3;
  for (std::size_t i = 0; i < kPlain && !by_rows; ++i) {
    Manner manner = out[i];
    manner.by_rows = true;
    out.push_back(manner);
  }
  return out;
}

}  // namespace plumb::course
