// Debug drawing of the C interface: what C++ draws, item by item.
#include <gmock/gmock.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "engine/world/svg_draw.h"
#include "tests/bindings/c/fixture.h"

namespace {

using plumb::tests::C;
using plumb::tests::kDt;
using ::testing::HasSubstr;

using Lines = std::vector<std::string>;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, " %.17g", value);
  return text;
}
std::string at(double x, double y) { return number(x) + number(y); }

/// Writes a line for each item that C++ draws.
struct Cpp : plumb::DebugDraw {
  Lines lines;
  void add(const std::string& line, plumb::DrawRole role) {
    lines.push_back(line + number(static_cast<int>(role)));
  }
  void polygon(std::span<const plumb::Vec2d> corners, double radius, plumb::DrawRole role) override {
    std::string line = "polygon";
    for (const plumb::Vec2d corner : corners) line += at(corner.x, corner.y);
    add(line + number(radius), role);
  }
  void circle(plumb::Vec2d c, double radius, plumb::Vec2d axis, plumb::DrawRole role) override {
    add("circle" + at(c.x, c.y) + number(radius) + at(axis.x, axis.y), role);
  }
  void capsule(plumb::Vec2d a, plumb::Vec2d b, double radius, plumb::DrawRole role) override {
    add("capsule" + at(a.x, a.y) + at(b.x, b.y) + number(radius), role);
  }
  void segment(plumb::Vec2d a, plumb::Vec2d b, plumb::DrawRole role) override {
    add("segment" + at(a.x, a.y) + at(b.x, b.y), role);
  }
  void point(plumb::Vec2d p, plumb::DrawRole role) override { add("point" + at(p.x, p.y), role); }
  void text(plumb::Vec2d p, std::string_view text, plumb::DrawRole role) override {
    add("text" + at(p.x, p.y) + " " + std::string(text), role);
  }
};

/// Draws to lines of the same form.
plumb_debug_draw lines_to(Lines& lines) {
  const auto add = [](void* to, const std::string& line, plumb_draw_role role) {
    static_cast<Lines*>(to)->push_back(line + number(static_cast<int>(role)));
  };
  static const auto keep = add;
  plumb_debug_draw draw{};
  draw.polygon = [](const plumb_vec2* corners, size_t count, double radius, plumb_draw_role role, void* to) {
    std::string line = "polygon";
    for (size_t i = 0; i < count; ++i) line += at(corners[i].x, corners[i].y);
    keep(to, line + number(radius), role);
  };
  draw.circle = [](plumb_vec2 c, double radius, plumb_vec2 axis, plumb_draw_role role, void* to) {
    keep(to, "circle" + at(c.x, c.y) + number(radius) + at(axis.x, axis.y), role);
  };
  draw.capsule = [](plumb_vec2 a, plumb_vec2 b, double radius, plumb_draw_role role, void* to) {
    keep(to, "capsule" + at(a.x, a.y) + at(b.x, b.y) + number(radius), role);
  };
  draw.segment = [](plumb_vec2 a, plumb_vec2 b, plumb_draw_role role, void* to) {
    keep(to, "segment" + at(a.x, a.y) + at(b.x, b.y), role);
  };
  draw.point = [](plumb_vec2 p, plumb_draw_role role, void* to) { keep(to, "point" + at(p.x, p.y), role); };
  draw.text = [](plumb_vec2 p, const char* text, plumb_draw_role role, void* to) {
    keep(to, "text" + at(p.x, p.y) + " " + text, role);
  };
  draw.context = &lines;
  return draw;
}

class CDrawing : public C {
 protected:
  CDrawing() {
    const plumb_body ground = box(PLUMB_STATIC, {0, -1}, 40, 2);
    const plumb_body crate = box(PLUMB_DYNAMIC, {0, 0.5}, 1, 1);
    plumb_body_set_name(world, crate, "crate");
    plumb_body_definition body = plumb_default_body();
    body.position = {3, 4};
    plumb_shape_definition shapes[] = {plumb_default_shape(), plumb_default_shape()};
    shapes[1].geometry = plumb_capsule({0, 0}, {1, 0}, 0.25);
    const plumb_body lamp = plumb_body_create(world, &body, shapes, 2);
    plumb_joint_definition rope = plumb_default_joint(PLUMB_DISTANCE);
    rope.anchor_a = {3, 8}, rope.length = 3;
    plumb_joint_create(world, ground, lamp, &rope);

    cpp.create_body({.type = plumb::BodyType::Static, .position = {0, -1}},
                    {.geometry = plumb::Box{40, 2}, .hit_events = true});
    cpp.create_body({.name = "crate", .position = {0, 0.5}},
                    {.geometry = plumb::Box{1, 1}, .hit_events = true});
    const plumb::ShapeDefinition two[] = {{}, {.geometry = plumb::Capsule{{0, 0}, {1, 0}, 0.25}}};
    const plumb::BodyId same = cpp.create_body({.position = {3, 4}}, two);
    cpp.create_joint(cpp.bodies()[0], same,
                     {.kind = plumb::DistanceDefinition{.anchor_a = {3, 8}, .length = 3}});
  }
  void step() {
    plumb_world_step(world, kDt, 4);
    cpp.step(kDt, 4);
  }

  plumb::World cpp;
  Lines lines{};
};

TEST_F(CDrawing, DrawsWhatCppDraws) {
  for (int i = 0; i < 5; ++i) step();
  const plumb_debug_draw draw = lines_to(lines);
  plumb_draw_options options = plumb_default_draw();
  for (const bool everything : {false, true}) {
    plumb::DrawOptions same;
    if (everything) {
      options.contacts = options.normals = options.impulses = options.boxes = options.centres = true;
      options.names = true;
      options.normal_length = 0.5;
      same = {.contacts = true,
              .normals = true,
              .impulses = true,
              .boxes = true,
              .centres = true,
              .names = true,
              .normal_length = 0.5};
    }
    lines.clear();
    Cpp want;
    plumb::draw(cpp, want, same);
    ASSERT_EQ(plumb_world_draw(world, &draw, everything ? &options : nullptr), PLUMB_OK);
    EXPECT_EQ(lines, want.lines);
    EXPECT_GT(lines.size(), everything ? 12u : 3u);
  }
  options = plumb_default_draw();
  options.bounded = true;
  options.bounds = {{2, 2}, {9, 9}};
  lines.clear();
  Cpp within;
  plumb::draw(cpp, within, {.bounds = plumb::Aabb<double>{{2, 2}, {9, 9}}});
  plumb_world_draw(world, &draw, &options);
  EXPECT_EQ(lines, within.lines);
}

TEST_F(CDrawing, FunctionsThatAreMissingAreLeftOut) {
  plumb_debug_draw draw{};
  draw.circle = lines_to(lines).circle;
  draw.context = &lines;
  plumb_draw_options options = plumb_default_draw();
  options.contacts = options.boxes = options.centres = options.names = true;
  EXPECT_EQ(plumb_world_draw(world, &draw, &options), PLUMB_OK);
  for (const std::string& line : lines) EXPECT_THAT(line, HasSubstr("circle"));
  EXPECT_FALSE(lines.empty());
  EXPECT_EQ(plumb_world_draw(world, nullptr, nullptr), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().subject, "draw");
}

TEST_F(CDrawing, DrawsBetweenTwoSteps) {
  plumb_past_poses* past = plumb_past_poses_create();
  plumb::PastPoses<float> same;
  const plumb_debug_draw draw = lines_to(lines);
  EXPECT_EQ(plumb_world_draw_between(world, past, 0.5, &draw, nullptr), PLUMB_OK) << "nothing kept: as it is";
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(plumb_past_poses_keep(past, world), PLUMB_OK);
    same.keep(cpp);
    step();
  }
  lines.clear();
  Cpp want;
  plumb::draw(cpp, same, 0.25, want);
  ASSERT_EQ(plumb_world_draw_between(world, past, 0.25, &draw, nullptr), PLUMB_OK);
  EXPECT_EQ(lines, want.lines);

  plumb_world_definition exact = plumb_default_world();
  exact.precision = PLUMB_DOUBLE;
  plumb_world* other = plumb_world_create(&exact);
  EXPECT_EQ(plumb_world_draw_between(other, past, 0.25, &draw, nullptr), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().subject, "past poses");
  plumb_world_destroy(other);
  plumb_past_poses_destroy(past);
}

TEST_F(C, PosesBetweenTwoStepsAreThoseOfTheOrigins) {
  plumb_world_set_gravity(world, {0, 0});
  plumb_body_definition body = plumb_default_body();
  body.angle = 7;  // more than a turn
  plumb_shape_definition shape = plumb_default_shape();
  shape.position = {2, 0};  // the centre of mass lies beside the origin
  body.velocity = {6, 0};
  body.angular_velocity = 3;
  const plumb_body thrown = plumb_body_create(world, &body, &shape, 1);
  plumb_past_poses* past = plumb_past_poses_create();
  plumb_past_poses_keep(past, world);
  const plumb_pose before = plumb_body_pose(world, thrown);
  plumb_world_step(world, kDt, 4);
  const plumb_pose after = plumb_body_pose(world, thrown);
  plumb_pose pose;
  for (const auto& [fraction, want] : {std::pair{0.0, before}, std::pair{1.0, after}}) {
    ASSERT_EQ(plumb_past_poses_between(past, world, fraction, &pose, 1), 1u);
    EXPECT_NEAR(pose.position.x, want.position.x, 1e-6);
    EXPECT_NEAR(pose.position.y, want.position.y, 1e-6);
    EXPECT_NEAR(pose.angle, want.angle, 1e-12);
  }
  plumb_past_poses_between(past, world, 0.5, &pose, 1);
  // Half a step of a turn of 3 rad/s; the centre moves on a line, the origin on an arc around it.
  EXPECT_NEAR(pose.angle, 7 + 1.5 * kDt, 1e-6);
  EXPECT_NEAR(pose.position.x, 2 * std::cos(7.) + 3 * kDt - 2 * std::cos(7 + 1.5 * kDt), 1e-6);
  const plumb_body late = plumb_body_create(world, &body, &shape, 1);
  plumb_pose poses[2];
  ASSERT_EQ(plumb_past_poses_between(past, world, 0.5, poses, 2), 2u);
  EXPECT_NEAR(poses[1].position.x, plumb_body_position(world, late).x, 1e-6);
  plumb_clear_error();
  EXPECT_EQ(plumb_past_poses_between(past, world, std::nan(""), poses, 2), 0u);
  EXPECT_STREQ(plumb_last_error().field, "fraction");
  plumb_clear_error();
  const plumb_debug_draw draw{};
  EXPECT_EQ(plumb_world_draw_between(world, past, std::nan(""), &draw, nullptr), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().field, "fraction");
  plumb_past_poses_destroy(past);
}

TEST_F(CDrawing, PicturesAreThoseOfCpp) {
  step();
  std::vector<char> text(plumb_world_svg(world, nullptr, 400, nullptr, 0));
  ASSERT_EQ(plumb_world_svg(world, nullptr, 400, text.data(), text.size()), text.size());
  plumb::SvgDraw want;
  plumb::draw(cpp, want);
  EXPECT_EQ(std::string(text.data()), want.picture(400));
  plumb_draw_options options = plumb_default_draw();
  options.bounded = true;
  options.bounds = {{-2, -1}, {6, 7}};
  text.resize(plumb_world_svg(world, &options, 100, nullptr, 0));
  plumb_world_svg(world, &options, 100, text.data(), text.size());
  EXPECT_THAT(text.data(), HasSubstr("viewBox=\"-2 -7 8 8\""));
  options.bounds.upper.x = -2;
  EXPECT_EQ(plumb_world_svg(world, &options, 100, nullptr, 0), 0u);
  EXPECT_STREQ(plumb_last_error().field, "bounds");
  EXPECT_EQ(plumb_world_svg(world, nullptr, 0, nullptr, 0), 0u);
  EXPECT_STREQ(plumb_last_error().field, "width");
}

}  // namespace
