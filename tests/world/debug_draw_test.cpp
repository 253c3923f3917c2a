#include "engine/world/debug_draw.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/world/svg_draw.h"
#include "tests/world/busy_world.h"

namespace plumb {
namespace {

struct Item {
  std::string what;
  DrawRole role;
  std::vector<Vec2d> points;
  double radius = 0;
};

// Keeps what is drawn.
struct Log : DebugDraw {
  std::vector<Item> items;

  void polygon(std::span<const Vec2d> corners, double radius, DrawRole role) override {
    items.push_back({"polygon", role, {corners.begin(), corners.end()}, radius});
  }
  void circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) override {
    items.push_back({"circle", role, {centre, axis}, radius});
  }
  void capsule(Vec2d start, Vec2d end, double radius, DrawRole role) override {
    items.push_back({"capsule", role, {start, end}, radius});
  }
  void segment(Vec2d start, Vec2d end, DrawRole role) override {
    items.push_back({"segment", role, {start, end}});
  }
  void point(Vec2d point, DrawRole role) override { items.push_back({"point", role, {point}}); }
  void text(Vec2d point, std::string_view text, DrawRole role) override {
    items.push_back({"text " + std::string(text), role, {point}});
  }

  std::vector<Item> of(const std::string& what, DrawRole role) const {
    std::vector<Item> found;
    for (const Item& item : items) {
      if (item.what == what && item.role == role) found.push_back(item);
    }
    return found;
  }
};

DrawOptions everything() {
  return {.contacts = true, .normals = true, .impulses = true, .boxes = true, .centres = true, .names = true};
}

template <class Real>
Log log_of(const BasicWorld<Real>& world, const DrawOptions& options = {}) {
  Log log;
  draw(world, log, options);
  return log;
}

void expect_near(Vec2d a, Vec2d b, double tolerance = 1e-6) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
}

template <class Real>
class Drawn : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Drawn, Precisions);

// Between two steps bodies, what hangs on them and contacts lie between where they were and where they are;
// a body that came since is where it is.
TYPED_TEST(Drawn, LiesBetweenTwoSteps) {
  BasicWorld<TypeParam> world({.gravity = {0, 0}});
  const double quarter = std::acos(0.0);
  const BodyId body = world.create_body({.position = {1, 2}, .velocity = {60, -30}, .angular_velocity = 60},
                                        {.geometry = Circle{0.5}, .position = {1, 0}});
  PastPoses<TypeParam> before;
  before.keep(world);
  const BodyId young = world.create_body({.position = {-9, 0}, .velocity = {60, 0}}, {.geometry = Circle{2}});
  world.step(quarter / 60);
  const auto circles = [&](double fraction) {
    Log log;
    draw(world, before, fraction, log);
    return log.of("circle", DrawRole::Awake);
  };
  const double travel = quarter, tolerance = 1e-5;  // m a step at 60 m/s; float's
  for (const double fraction : {0.0, 0.5, 1.0}) {
    const std::vector<Item> drawn = circles(fraction);
    ASSERT_EQ(drawn.size(), 2u);
    const double angle = fraction * quarter;
    const Vec2d centre{1 + 1 + fraction * travel, 2 - fraction * travel / 2};  // of mass
    expect_near(drawn[0].points[0], centre, tolerance);
    expect_near(drawn[0].points[1], {std::cos(angle), std::sin(angle)}, tolerance);
    expect_near(drawn[1].points[0], world.position(young), tolerance);
  }
  // Another body in the place of one that is gone has no past.
  world.destroy(body);
  world.create_body({.position = {5, 5}}, {.geometry = Circle{1}});
  expect_near(circles(0)[0].points[0], {5, 5});
}

// A body at (3, 4), turned by a quarter: a local point (x, y) is at (3 - y, 4 + x).
TYPED_TEST(Drawn, ShapesStandWhereTheirBodiesPutThem) {
  BasicWorld<TypeParam> world;
  const ShapeDefinition shapes[] = {{.geometry = Circle{0.5}, .position = {1, 0}},
                                    {.geometry = Box{2, 1}},
                                    {.geometry = Capsule{{0, 2}, {1, 2}, 0.25}},
                                    {.geometry = Segment{{0, 3}, {2, 3}}},
                                    {.geometry = Polygon{{{0, 5}, {1, 5}, {0, 6}}, 0.1}}};
  world.create_body({.position = {3, 4}, .angle = std::acos(0.0)}, shapes);
  const Log log = log_of(world);
  ASSERT_EQ(log.items.size(), 5u);
  const std::vector<Item> circles = log.of("circle", DrawRole::Awake);
  ASSERT_EQ(circles.size(), 1u);
  expect_near(circles[0].points[0], {3, 5});
  expect_near(circles[0].points[1], {0, 1});
  EXPECT_NEAR(circles[0].radius, 0.5, 1e-7);
  const std::vector<Item> capsules = log.of("capsule", DrawRole::Awake);
  ASSERT_EQ(capsules.size(), 1u);
  expect_near(capsules[0].points[0], {1, 4});
  expect_near(capsules[0].points[1], {1, 5});
  EXPECT_NEAR(capsules[0].radius, 0.25, 1e-7);
  const std::vector<Item> segments = log.of("segment", DrawRole::Awake);
  ASSERT_EQ(segments.size(), 1u);
  expect_near(segments[0].points[0], {0, 4});
  expect_near(segments[0].points[1], {0, 6});
  const std::vector<Item> polygons = log.of("polygon", DrawRole::Awake);
  ASSERT_EQ(polygons.size(), 2u);
  for (const Item& polygon : polygons) {
    const bool box = polygon.points.size() == 4;
    EXPECT_NEAR(polygon.radius, box ? 0 : 0.1, 1e-7);
    double area = 0;
    for (std::size_t i = 0; i < polygon.points.size(); ++i)
      area += 0.5 * cross(polygon.points[i], polygon.points[(i + 1) % polygon.points.size()]);
    EXPECT_NEAR(area, box ? 2 : 0.5, 1e-5);  // positive: counter-clockwise
  }
}

TYPED_TEST(Drawn, RolesSayWhatBodiesAre) {
  BasicWorld<TypeParam> world;
  const ShapeDefinition box{.geometry = Box{1, 1}};
  world.create_body({.type = BodyType::Static}, box);
  world.create_body({.type = BodyType::Kinematic, .position = {5, 0}}, box);
  const BodyId dynamic = world.create_body({.position = {10, 0}}, box);
  world.create_body({.type = BodyType::Static, .position = {15, 0}}, {.geometry = Box{1, 1}, .sensor = true});
  const auto count = [&](DrawRole role) { return log_of(world).of("polygon", role).size(); };
  EXPECT_EQ(count(DrawRole::Static), 1u);
  EXPECT_EQ(count(DrawRole::Kinematic), 1u);
  EXPECT_EQ(count(DrawRole::Awake), 1u);
  EXPECT_EQ(count(DrawRole::Sensor), 1u);
  EXPECT_EQ(count(DrawRole::Asleep), 0u);
  world.set_awake(dynamic, false);
  EXPECT_EQ(count(DrawRole::Awake), 0u);
  EXPECT_EQ(count(DrawRole::Asleep), 1u);
}

// A box of 1 m and 2 kg on the ground: two points under its corners, normals along y, and impulses that
// together hold its weight over a substep, m g h.
TYPED_TEST(Drawn, ContactsHoldTheWeight) {
  BasicWorld<TypeParam> world;
  world.create_body({.type = BodyType::Static}, {.geometry = Box{10, 1}, .position = {0, -0.5}});
  const BodyId box = world.create_body({.position = {2, 0.5}}, {.geometry = Box{1, 1}, .density = 2});
  for (int i = 0; i < 25; ++i) world.step();
  ASSERT_TRUE(world.awake(box));
  const Log log = log_of(world, {.contacts = true, .normals = true, .impulses = true, .impulse_length = 1});
  const std::vector<Item> points = log.of("point", DrawRole::Contact);
  ASSERT_EQ(points.size(), 2u);
  const double left = std::min(points[0].points[0].x, points[1].points[0].x);
  EXPECT_NEAR(left, 1.5, 1e-3);
  EXPECT_NEAR(points[0].points[0].x + points[1].points[0].x, 4, 1e-3);
  for (const Item& normal : log.of("segment", DrawRole::Normal)) {
    const Vec2d way = normal.points[1] - normal.points[0];
    EXPECT_NEAR(std::abs(way.y), 0.2, 1e-6);
    EXPECT_NEAR(way.x, 0, 1e-6);
  }
  EXPECT_EQ(log.of("segment", DrawRole::Normal).size(), 2u);
  double held = 0;
  for (const Item& impulse : log.of("segment", DrawRole::Impulse))
    held += std::abs(impulse.points[1].y - impulse.points[0].y);
  EXPECT_NEAR(held, 2 * 9.81 / 240, 1e-4);
  // Asleep, they are there still.
  world.set_awake(box, false);
  EXPECT_EQ(log_of(world, {.contacts = true}).of("point", DrawRole::Contact).size(), 2u);
}

TYPED_TEST(Drawn, JointsRunFromAnchorToAnchor) {
  BasicWorld<TypeParam> world;
  const BodyId wall = world.create_body({.type = BodyType::Static, .position = {0, 5}});
  const BodyId a = world.create_body({.position = {3, 5}}, {.geometry = Box{1, 1}, .position = {0.5, 0}});
  world.create_joint(wall, a,
                     {.kind = DistanceDefinition{.anchor_a = {0, 1}, .anchor_b = {-0.5, 0}, .length = 2.7}});
  const Log log = log_of(world, {.shapes = false});
  const std::vector<Item> points = log.of("point", DrawRole::JointLine);
  ASSERT_EQ(points.size(), 2u);
  expect_near(points[0].points[0], {0, 6});
  expect_near(points[1].points[0], {2.5, 5});
  const std::vector<Item> lines = log.of("segment", DrawRole::JointLine);
  ASSERT_EQ(lines.size(), 2u);
  expect_near(lines[0].points[0], {0, 6});
  expect_near(lines[0].points[1], {2.5, 5});
  expect_near(lines[1].points[0], {3.5, 5});  // the centre of mass
}

// A zigzag of twelve lines from anchor to anchor, to either side of the straight line by a sixteenth.
TYPED_TEST(Drawn, SpringsAreZigzags) {
  BasicWorld<TypeParam> world;
  const BodyId wall = world.create_body({.type = BodyType::Static});
  const BodyId a = world.create_body({.position = {3, 0}}, {.geometry = Circle{0.3}});
  world.create_joint(wall, a, {.kind = DistanceDefinition{.length = 3, .spring = Spring{.hertz = 2}}});
  const std::vector<Item> lines = log_of(world).of("segment", DrawRole::JointLine);
  ASSERT_EQ(lines.size(), 12u);
  expect_near(lines.front().points[0], {0, 0});
  expect_near(lines.back().points[1], {3, 0});
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    EXPECT_NEAR(lines[i].points[1].x, 0.25 * static_cast<double>(i + 1), 1e-6);
    EXPECT_NEAR(std::abs(lines[i].points[1].y), 3.0 / 16, 1e-6);
    if (i > 0) {
      EXPECT_LT(lines[i].points[1].y * lines[i - 1].points[1].y, 0);
    }
  }
}

TYPED_TEST(Drawn, PulleysHangFromTheGround) {
  BasicWorld<TypeParam> world;
  const BodyId a = world.create_body({.position = {-1, 0}}, {.geometry = Circle{0.3}});
  const BodyId b = world.create_body({.position = {1, 0}}, {.geometry = Circle{0.3}});
  world.create_joint(a, b, {.kind = PulleyDefinition{.ground_a = {-1, 4}, .ground_b = {1, 4}}});
  const std::vector<Item> lines = log_of(world).of("segment", DrawRole::JointLine);
  ASSERT_EQ(lines.size(), 3u);
  expect_near(lines[1].points[0], {-1, 4});
  expect_near(lines[1].points[1], {1, 4});
  const std::vector<Item> wheels = log_of(world).of("circle", DrawRole::JointLine);
  ASSERT_EQ(wheels.size(), 2u);
  expect_near(wheels[0].points[0], {-1, 4});
  EXPECT_NEAR(wheels[1].radius, 0.2, 1e-6);
}

TYPED_TEST(Drawn, BoxesCentresAndNames) {
  BasicWorld<TypeParam> world;
  world.create_body({.name = "ball", .position = {3, 4}}, {.geometry = Circle{0.5}});
  const Log log = log_of(world, everything());
  const std::vector<Item> boxes = log.of("polygon", DrawRole::Box);
  ASSERT_EQ(boxes.size(), 1u);
  expect_near(boxes[0].points[0], {2.5, 3.5}, 1e-5);
  expect_near(boxes[0].points[2], {3.5, 4.5}, 1e-5);
  ASSERT_EQ(log.of("point", DrawRole::Centre).size(), 1u);
  expect_near(log.of("point", DrawRole::Centre)[0].points[0], {3, 4});
  EXPECT_EQ(log.of("segment", DrawRole::Centre).size(), 2u);
  EXPECT_EQ(log.of("text ball", DrawRole::Name).size(), 1u);
  EXPECT_EQ(log_of(world).items.size(), 1u);
}

// ---- Pictures

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(SvgPicture, ShowsEveryRole) {
  test::BusyWorld<float> busy = test::make_busy_world<float>();
  test::run(busy, 150);
  busy.world.set_awake(busy.pile[39], false);
  SvgDraw svg;
  draw(busy.world, svg, everything());
  const std::string picture = svg.picture();
  for (int role = 0; role <= static_cast<int>(DrawRole::Name); ++role) {
    const std::string name(name_of(static_cast<DrawRole>(role)));
    EXPECT_GT(count_of(picture, "class=\"" + name + "\""), 0u) << name;
    EXPECT_EQ(count_of(picture, "\n." + name + "{"), 1u) << name;
  }
  EXPECT_EQ(count_of(picture, "<svg"), 1u);
  EXPECT_EQ(count_of(picture, "</svg>"), 1u);
  EXPECT_EQ(count_of(picture, "nan"), 0u);
  EXPECT_EQ(count_of(picture, "inf"), 0u);
}

// Bounds around one of ten boxes leave out the other nine, whatever is drawn of them.
TEST(DrawBounds, LeaveOutWhatLiesOutside) {
  World world;
  for (int i = 0; i < 10; ++i)
    world.create_body({.name = "box", .position = {5.0 * i, 0}}, {.geometry = Box{1, 1}});
  world.step();
  DrawOptions options{.boxes = true, .centres = true, .names = true};
  const std::size_t whole = log_of(world, options).items.size();
  options.bounds = Aabb<double>{{14, -1}, {16, 1}};
  const Log seen = log_of(world, options);
  EXPECT_EQ(10 * seen.items.size(), whole);
  EXPECT_EQ(seen.of("polygon", DrawRole::Awake).size(), 1u);
  options.bounds = Aabb<double>{{100, 100}, {101, 101}};
  EXPECT_TRUE(log_of(world, options).items.empty());
}

// y points down in a picture; the view has 3 % of its size around it.
TEST(SvgPicture, HasItsYDown) {
  SvgDraw svg;
  svg.circle({2, 3}, 1, {1, 0}, DrawRole::Awake);
  const Vec2d corners[] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}};
  svg.polygon(corners, 0, DrawRole::Static);
  svg.text({1, 1}, "a < b & c", DrawRole::Name);
  const std::string picture = svg.picture(100);
  EXPECT_NE(picture.find("cx=\"2\" cy=\"-3\" r=\"1\""), std::string::npos);
  EXPECT_NE(picture.find("d=\"M0 0 L2 0 L2 -1 L0 -1 Z\""), std::string::npos);
  EXPECT_NE(picture.find("a &lt; b &amp; c"), std::string::npos);
  // x in 0..3, y in 0..4: grown by 0.12.
  EXPECT_NE(picture.find("viewBox=\"-0.12 -4.12 3.24 4.24\""), std::string::npos);
  EXPECT_NE(picture.find("width=\"100\" height=\"131\""), std::string::npos);
}

// A capsule from (0, 0) to (2, 0) of radius 1/2: two edges, two half circles.
TEST(SvgPicture, RoundsCorners) {
  SvgDraw svg;
  svg.capsule({0, 0}, {2, 0}, 0.5, DrawRole::Awake);
  EXPECT_NE(svg.picture().find("d=\"M0 0.5 L2 0.5 A0.5 0.5 0 0 0 2 -0.5 L0 -0.5 A0.5 0.5 0 0 0 0 0.5 Z\""),
            std::string::npos);
}

}  // namespace
}  // namespace plumb
