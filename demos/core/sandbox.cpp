#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "demos/core/registry.h"
#include "demos/core/world_demo.h"
#include "engine/world/queries.h"

namespace plumb::demos {
namespace {

constexpr double kHalfWidth = 6, kHeight = 7;  // m, of the room
constexpr double kClick = 0.1;                 // m: a shorter drag, as by a shaky hand, counts as a click
constexpr double kSmallest = 0.1;              // m, width or height of a shape
constexpr Vec2d kUsual{0.8, 0.6};              // m, of a shape made by a click
constexpr std::size_t kMost = 400;             // bodies at a time

enum Tool { kBox, kCircle, kCapsule, kTriangle, kWall, kHinge, kRod, kSpring, kRope, kWeld, kPaint, kErase };

const About kAbout{
    "sandbox",
    "shapes, joints and materials by hand, saved as a scene that plumb run takes",
    "Drag to make the shape of the tool; click for one of the usual size. Joints go from where you press to "
    "where you release, on bodies or on the background. Paint gives a body the present density and material. "
    "Key w writes all of it as a scene.",
    {{'1', "box"},
     {'2', "circle"},
     {'3', "capsule"},
     {'4', "triangle"},
     {'5', "wall"},
     {'6', "hinge"},
     {'7', "rod"},
     {'8', "spring"},
     {'9', "erase"},
     {'c', "clear"},
     kGrabKey}};

class Sandbox final : public WorldDemo {
 public:
  Sandbox() : WorldDemo(kAbout) {
    add_pointer_play("build");
    add_choice("tool",
               {"box", "circle", "capsule", "triangle", "wall", "hinge", "rod", "spring", "rope", "weld",
                "paint", "erase"},
               tool_, "what the pointer builds");
    add_slider("density", "kg/m^2", 0.1, 20.0, density_, "of what is made or painted");
    add_slider("friction", "", 0.0, 1.5, friction_, "of what is made or painted");
    add_slider("restitution", "", 0.0, 1.0, restitution_, "of what is made or painted");
    add_slider("thickness", "m", 0.05, 0.6, thickness_, "of capsules and walls");
    add_switch("turns", turns_, "whether what is made may turn");
    add_slider("stiffness", "1/s", 0.5, 10.0, hertz_, "natural frequency of springs that are made");
    add_slider("gravity", "m/s^2", 0.0, 20.0, gravity_, "how fast falling speeds up");
    add_step_controls();
    restart();
  }

  void key(char key) override {
    WorldDemo::key(key);
    constexpr Tool kTools[] = {kBox, kCircle, kCapsule, kTriangle, kWall, kHinge, kRod, kSpring, kErase};
    if (key >= '1' && key <= '9') set("tool", kTools[key - '1']);
    if (key == 'c') clear();
  }

  std::vector<Figure> figures() const override {
    const WorldCounts counts = world_.counts();
    return {{"time", time(), "s"},
            {"bodies", static_cast<double>(made_bodies().size()), ""},
            {"joints", static_cast<double>(counts.joints), ""},
            {"contacts", static_cast<double>(counts.touching), ""},
            {"kinetic energy", totals_of(world_).energy, "J"}};
  }

  Aabb<double> view() const override { return {{-kHalfWidth - 0.4, -0.6}, {kHalfWidth + 0.4, kHeight}}; }

 private:
  WorldDefinition definition() const override { return {.gravity = {0, -gravity_}}; }
  Material material() const { return {.friction = friction_, .restitution = restitution_}; }

  void fill() override {
    from_.reset();
    const auto wall = [](Vec2d middle, double width, double height) {
      return ShapeDefinition{.geometry = Box{width, height}, .position = middle};
    };
    const ShapeDefinition walls[] = {wall({0, -0.5}, 2 * kHalfWidth + 2, 1),
                                     wall({-kHalfWidth - 0.5, 10}, 1, 20),
                                     wall({kHalfWidth + 0.5, 10}, 1, 20)};
    world_.create_body({.name = "room", .type = BodyType::Static}, walls);
    // A swing, to begin with.
    const BodyId plank = add("plank", {-1.5, 2.5}, {.geometry = Box{2.4, 0.2}});
    for (const double side : {-1.0, 1.0})
      world_.create_joint(frame_, plank,
                          {.kind = DistanceDefinition{
                               .anchor_a = Vec2d{-1.5 + side, 5}, .anchor_b = {side, 0}, .length = 2.5}});
    add("ball", {-1.8, 3}, {.geometry = Circle{0.3}});
    add("box", {2.5, 0.5}, {.geometry = Box{1, 1}});
  }

  BodyId add(const char* name, Vec2d position, ShapeDefinition shape, BodyType type = BodyType::Dynamic) {
    shape.density = density_, shape.material = material();
    return world_.create_body({.name = name, .type = type, .position = position, .lock_rotation = !turns_},
                              shape);
  }

  std::vector<BodyId> made_bodies() const {
    std::vector<BodyId> out = world_.bodies();
    std::erase_if(out, [&](BodyId body) { return body == frame_ || world_.name(body) == "room"; });
    return out;
  }
  void clear() {
    let_go();
    for (const BodyId body : made_bodies()) world_.destroy(body);
  }

  // Returns the body at a point, other than `but`.
  std::optional<BodyId> body_at(Vec2d point, BodyId but = {}) const {
    const auto wanted = [&](ShapeId shape) {
      return world_.body(shape) != but && world_.name(world_.body(shape)) != "room";
    };
    const auto found = nearest(world_, point, reach(), {.condition = wanted});
    if (!found) return {};
    return found->body;
  }

  void begin(Vec2d point) override {
    from_ = to_ = point;
    if (tool_ == kPaint) paint(point);
    if (tool_ == kErase) erase(point);
  }
  void go_on(Vec2d point) override { to_ = point; }
  void end(Vec2d point) override {
    if (!from_) return;
    to_ = point;
    if (tool_ <= kWall) make_shape();
    if (tool_ >= kHinge && tool_ <= kWeld) make_joint();
    from_.reset();
  }

  bool is_click() const { return length_squared(to_ - *from_) < kClick * kClick; }

  // A shape that the drag creates: its middle, and its geometry about the middle.
  struct Made {
    const char* name;
    Vec2d middle;
    ShapeGeometry geometry;
    BodyType type = BodyType::Dynamic;
  };
  Made made() const {
    const Vec2d a = is_click() ? *from_ - 0.5 * kUsual : *from_, b = is_click() ? *from_ + 0.5 * kUsual : to_;
    const Vec2d middle = 0.5 * (a + b), half = 0.5 * (b - a);
    const double x = std::max(std::abs(half.x), kSmallest / 2), y = std::max(std::abs(half.y), kSmallest / 2);
    switch (tool_) {
      case kCircle: {
        const double radius = is_click() ? kUsual.y / 2 : std::sqrt(length_squared(to_ - *from_));
        return {"ball", *from_, Circle{std::max(radius, kSmallest / 2)}};
      }
      case kCapsule:
        return {"capsule", middle, Capsule{-half, half, thickness_ / 2}};
      case kTriangle:
        return {"triangle", middle, Polygon{.points = {{-x, -y}, {x, -y}, {0, y}}}};
      case kWall:
        return {"wall", middle, Capsule{-half, half, thickness_ / 2}, BodyType::Static};
      default:
        return {"box", middle, Box{2 * x, 2 * y}};
    }
  }
  void make_shape() {
    if (made_bodies().size() >= kMost) return;
    const Made it = made();
    add(it.name, it.middle, {.geometry = it.geometry}, it.type);
  }

  // Joins the body at the press to the body at the release, or to the background. For a hinge or a weld, a
  // click joins the two bodies that lie above each other there.
  void make_joint() {
    const std::optional<BodyId> a = body_at(*from_);
    const std::optional<BodyId> b = body_at(to_, is_click() && a ? *a : BodyId{});
    const BodyId first = a.value_or(frame_), second = b.value_or(frame_);
    const auto moves = [&](BodyId body) { return world_.type(body) == BodyType::Dynamic; };
    if (first == second || (!moves(first) && !moves(second))) return;
    const bool at_one_point = tool_ == kHinge || tool_ == kWeld;
    const Vec2d anchor_a = world_.local_point(first, *from_);
    const Vec2d anchor_b = world_.local_point(second, at_one_point ? *from_ : to_);
    const double length = std::sqrt(length_squared(to_ - *from_));
    const double turned = world_.angle(second) - world_.angle(first);
    if (!at_one_point && is_click()) return;
    JointDefinition joint;
    switch (tool_) {
      case kHinge:
        joint.kind = RevoluteDefinition{.anchor_a = anchor_a, .anchor_b = anchor_b};
        break;
      case kWeld:
        joint.kind = WeldDefinition{.anchor_a = anchor_a, .anchor_b = anchor_b, .reference_angle = turned};
        break;
      case kSpring:
        joint.kind = DistanceDefinition{.anchor_a = anchor_a,
                                        .anchor_b = anchor_b,
                                        .length = length,
                                        .spring = Spring{.hertz = hertz_, .damping_ratio = 0.1}};
        joint.collide = true;
        break;
      case kRope:
        joint.kind = DistanceDefinition{.anchor_a = anchor_a,
                                        .anchor_b = anchor_b,
                                        .length = length,
                                        .range = Range{.lower = 0, .upper = length}};
        joint.collide = true;
        break;
      default:
        joint.kind = DistanceDefinition{.anchor_a = anchor_a, .anchor_b = anchor_b, .length = length};
        joint.collide = true;
    }
    world_.create_joint(first, second, joint);
  }

  void paint(Vec2d point) {
    const std::optional<BodyId> body = body_at(point);
    if (!body) return;
    for (const ShapeId shape : world_.shapes(*body)) {
      world_.set_material(shape, material());
      world_.set_density(shape, density_);
    }
    const BodyLocks locks = world_.locks(*body);
    world_.set_locks(*body, locks.x, locks.y, !turns_);
  }

  // Removes the body at a point; if there is none, the nearest joint that ends there.
  void erase(Vec2d point) {
    if (const std::optional<BodyId> body = body_at(point)) return world_.destroy(*body);
    std::optional<JointId> found;
    double least = 4 * reach();
    for (const BodyId body : world_.bodies()) {
      for (const JointId joint : world_.joints(body)) {
        const auto [a, b] = world_.bodies(joint);
        const Vec2d ends[] = {end_of(joint, a, true), end_of(joint, b, false)};
        for (const Vec2d end : ends) {
          const double distance = std::sqrt(length_squared(end - point));
          if (distance < least) least = distance, found = joint;
        }
      }
    }
    if (found) world_.destroy(*found);
  }
  Vec2d end_of(JointId joint, BodyId body, bool first) const {
    return std::visit(
        [&](const auto& kind) {
          if constexpr (requires { kind.anchor_a, kind.anchor_b; })
            return world_.world_point(body, first ? kind.anchor_a : kind.anchor_b);
          return world_.centre(body);
        },
        world_.kind(joint));
  }

  void changed(std::string_view control) override {
    if (control == "gravity") world_.set_gravity({0, -gravity_});
  }

  // Draws the shape or joint that the drag would create.
  void draw_over(DebugDraw& out) const override {
    if (!from_ || tool_ >= kPaint) return;
    if (tool_ >= kHinge) {
      out.segment(*from_, to_, DrawRole::Aim);
      out.point(*from_, DrawRole::Highlight), out.point(to_, DrawRole::Highlight);
      return;
    }
    const Made it = made();
    if (const auto* circle = std::get_if<Circle>(&it.geometry)) {
      out.circle(it.middle, circle->radius, {0, 0}, DrawRole::Aim);
    } else if (const auto* capsule = std::get_if<Capsule>(&it.geometry)) {
      out.capsule(it.middle + capsule->start, it.middle + capsule->end, capsule->radius, DrawRole::Aim);
    } else if (const auto* polygon = std::get_if<Polygon>(&it.geometry)) {
      std::vector<Vec2d> corners;
      for (const Vec2d point : polygon->points) corners.push_back(it.middle + point);
      out.polygon(corners, 0, DrawRole::Aim);
    } else if (const auto* box = std::get_if<Box>(&it.geometry)) {
      const double x = box->width / 2, y = box->height / 2;
      const Vec2d corners[] = {it.middle + Vec2d{-x, -y}, it.middle + Vec2d{x, -y}, it.middle + Vec2d{x, y},
                               it.middle + Vec2d{-x, y}};
      out.polygon(corners, 0, DrawRole::Aim);
    }
  }

  void set_own(std::span<const double>) override { from_.reset(); }

  int tool_ = kBox;
  double density_ = 1, friction_ = 0.5, restitution_ = 0.2, thickness_ = 0.2, hertz_ = 2, gravity_ = 9.81;
  bool turns_ = true;
  std::optional<Vec2d> from_;  // m, where the drag began
  Vec2d to_{};
};

const Register kEntry{7, kAbout, [] { return std::unique_ptr<Demo>(new Sandbox); }};

}  // namespace
}  // namespace plumb::demos
