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

constexpr double kWidth = 12, kHeight = 8;  // m, of the room with its middle at the origin
constexpr double kMass = 1;                 // kg, of every box
constexpr double kPush = 0.1;               // s, duration of a push
constexpr double kForceScale = 0.05;        // m of arrow per N
constexpr std::size_t kMost = 60;           // boxes at a time

struct Form {
  const char* name;
  Box box;
};
constexpr Form kForms[] = {{"square", {1, 1}}, {"thin", {2, 0.25}}, {"short thin", {1, 0.25}}};

const About kAbout{
    "spinning_boxes",
    "push boxes at a corner or in the middle, square and thin ones of one mass",
    "Click a box near its middle or a corner to push it there, upwards; drag for another direction. Click "
    "elsewhere for a new box. A push in the middle does not spin; the same at a corner does. Of one mass, a "
    "thin box as long as the square has half its inertia; one of the same area has twice as much.",
    {{'1', "new boxes are square"},
     {'2', "new boxes are thin, of the square's area"},
     {'3', "new boxes are thin, as long as the square"},
     kGrabKey}};

/// A force at a point of a box for the duration of a push.
struct Push {
  BodyId body{};
  Vec2d point{};    // m, in the body's frame
  Vec2d force{};    // N
  double left = 0;  // s, remaining duration
};

class SpinningBoxes final : public WorldDemo {
 public:
  SpinningBoxes() : WorldDemo(kAbout) {
    add_pointer_play("push");
    add_choice("new boxes", {kForms[0].name, kForms[1].name, kForms[2].name}, form_,
               "what a click on free room makes");
    add_choice("rotation", {"boxes turn", "along the axes"}, locked_, "whether boxes may turn at all");
    add_slider("push", "N", 0.0, 50.0, strength_, "force of a push; it lasts 0.1 s");
    add_slider("restitution", "", 0.0, 1.0, restitution_, "share of the speed that a bounce gives back");
    add_slider("friction", "", 0.0, 1.0, friction_, "of boxes and walls");
    add_slider("gravity", "m/s^2", 0.0, 20.0, gravity_, "how fast falling speeds up");
    add_step_controls();
    restart();
  }

  void key(char key) override {
    WorldDemo::key(key);
    if (key >= '1' && key <= '3') set("new boxes", key - '1');
  }

  std::vector<Figure> figures() const override {
    const Totals totals = totals_of(world_);
    std::vector<Figure> out = {{"time", time(), "s"},
                               {"boxes", static_cast<double>(boxes().size()), ""},
                               {"momentum", std::sqrt(length_squared(totals.momentum)), "kg m/s"},
                               {"kinetic energy", totals.energy, "J"}};
    if (!world_.valid(last_.body)) return out;
    out.push_back({"pushed box's inertia", form_inertia(last_.body), "kg m^2"});
    out.push_back({"its speed", std::sqrt(length_squared(world_.velocity(last_.body))), "m/s"});
    out.push_back({"its angular velocity", world_.angular_velocity(last_.body), "rad/s"});
    return out;
  }

  Aabb<double> view() const override {
    return Aabb<double>{{-kWidth / 2, -kHeight / 2}, {kWidth / 2, kHeight / 2}}.grown(0.4);
  }

 private:
  // Starts a push on a box, or adds a new box elsewhere.
  void begin(Vec2d point) override {
    const auto is_box = [&](ShapeId shape) { return world_.type(world_.body(shape)) == BodyType::Dynamic; };
    const std::optional<NearestResult> hit = nearest(world_, point, 0, {.condition = is_box});
    if (!hit) {
      spawn(point);
      return;
    }
    aimed_ = hit->body;
    aimed_point_ = nearest_handle(aimed_, world_.local_point(aimed_, point));
    from_ = to_ = point;
  }
  void go_on(Vec2d point) override { to_ = point; }
  void end(Vec2d point) override {
    to_ = point;
    if (world_.valid(aimed_)) push(aimed_, aimed_point_, strength_ * direction());
    aimed_ = {};
  }

  WorldDefinition definition() const override { return {.gravity = {0, -gravity_}, .sleeping = false}; }
  Material material() const { return {.friction = friction_, .restitution = restitution_}; }

  void fill() override {
    pushes_.clear();
    last_ = {};
    aimed_ = {};
    constexpr double kThick = 1;
    const double x = (kWidth + kThick) / 2, y = (kHeight + kThick) / 2;
    const auto wall = [&](Vec2d middle, double width, double height) {
      return ShapeDefinition{.geometry = Box{width, height}, .position = middle, .material = material()};
    };
    const ShapeDefinition walls[] = {wall({0, y}, kWidth + 2 * kThick, kThick),
                                     wall({0, -y}, kWidth + 2 * kThick, kThick),
                                     wall({x, 0}, kThick, kHeight), wall({-x, 0}, kThick, kHeight)};
    world_.create_body({.name = "room", .type = BodyType::Static}, walls);
    for (int i = 0; i < 3; ++i) {
      add_box({-3, -2.5 + 2.5 * i}, 0);
      add_box({2, -2.5 + 2.5 * i}, 1);
      add_box({4.9, -2.5 + 2.5 * i}, 2);
    }
  }

  void add_box(Vec2d position, int form) {
    const Box box = kForms[form].box;
    const BodyId body = world_.create_body(
        {.name = kForms[form].name, .position = position, .user_data = static_cast<std::uint64_t>(form)},
        {.geometry = box, .density = kMass / (box.width * box.height), .material = material()});
    world_.set_locks(body, false, false, locked_ != 0);
  }

  void spawn(Vec2d point) {
    const std::vector<BodyId> all = boxes();
    if (all.size() >= kMost) world_.destroy(all.front());
    const double x = kWidth / 2 - 1, y = kHeight / 2 - 1;
    add_box({std::clamp(point.x, -x, x), std::clamp(point.y, -y, y)}, form_);
  }

  std::vector<BodyId> boxes() const {
    std::vector<BodyId> out = world_.bodies();
    std::erase_if(out, [&](BodyId body) { return world_.type(body) != BodyType::Dynamic; });
    return out;
  }
  Box box_of(BodyId body) const { return kForms[world_.user_data(body)].box; }
  // Returns m (w^2 + h^2) / 12, even if the box has a fixed rotation.
  double form_inertia(BodyId body) const {
    const Box box = box_of(body);
    return kMass * (box.width * box.width + box.height * box.height) / 12;
  }

  // Returns the centre or the corner that is nearest to a point of the box.
  Vec2d nearest_handle(BodyId body, Vec2d point) const {
    const double x = box_of(body).width / 2, y = box_of(body).height / 2;
    const Vec2d handles[] = {{0, 0}, {x, y}, {-x, y}, {-x, -y}, {x, -y}};
    return *std::ranges::min_element(handles, {}, [&](Vec2d each) { return length_squared(each - point); });
  }

  // Returns the direction of the push: up for a click, otherwise that of the drag.
  Vec2d direction() const {
    constexpr double kClick = 0.1;  // m, tolerance for a shaky hand
    const Vec2d way = to_ - from_;
    const double length = std::sqrt(length_squared(way));
    return length > kClick ? (1 / length) * way : Vec2d{0, 1};
  }

  void push(BodyId body, Vec2d point, Vec2d force) {
    last_ = {body, point, force, kPush};
    pushes_.push_back(last_);
  }

  // The force keeps its direction, and its point moves with the box. A push that ends within the step is
  // scaled by the fraction of the step.
  void before_step() override {
    std::erase_if(pushes_, [&](const Push& push) { return push.left <= 0 || !world_.valid(push.body); });
    for (Push& push : pushes_) {
      const double share = std::clamp(push.left / dt(), 0.0, 1.0);
      world_.apply_force(push.body, share * push.force, world_.world_point(push.body, push.point));
      push.left -= share * dt();
    }
  }

  void changed(std::string_view control) override {
    world_.set_gravity({0, -gravity_});
    for (const BodyId body : world_.bodies()) {
      for (const ShapeId shape : world_.shapes(body)) world_.set_material(shape, material());
    }
    if (control != "rotation") return;
    for (const BodyId box : boxes()) {
      world_.set_locks(box, false, false, locked_ != 0);
      if (locked_ == 0) continue;
      world_.set_position(box, world_.position(box), 0);
      world_.set_angular_velocity(box, 0);
    }
  }

  void draw_over(DebugDraw& out) const override {
    for (const Push& push : pushes_) {
      if (push.left > 0 && world_.valid(push.body)) draw_force(out, push);
    }
    if (!world_.valid(aimed_)) return;
    draw_force(out, {aimed_, aimed_point_, strength_ * direction(), 0});
    out.point(drawn_point(aimed_, aimed_point_), DrawRole::Highlight);
  }
  void draw_force(DebugDraw& out, const Push& push) const {
    const Vec2d at = drawn_point(push.body, push.point);
    draw_arrow(out, at, at + kForceScale * push.force, DrawRole::Force);
  }
  // A box's origin is its centre of mass.
  Vec2d drawn_point(BodyId body, Vec2d point) const {
    const Pose<double> pose = drawn_pose(body);
    return pose.position + pose.rotation * point;
  }

  std::vector<double> own() const override {
    std::vector<double> out;
    const auto put = [&](const Push& push) {
      for (const double each :
           {static_cast<double>(push.body.index), static_cast<double>(push.body.generation), push.point.x,
            push.point.y, push.force.x, push.force.y, push.left})
        out.push_back(each);
    };
    put(last_);
    for (const Push& push : pushes_) put(push);
    return out;
  }
  void set_own(std::span<const double> in) override {
    std::vector<Push> all;
    for (std::size_t i = 0; i + 7 <= in.size(); i += 7) {
      const BodyId body{static_cast<std::uint32_t>(in[i]), static_cast<std::uint32_t>(in[i + 1])};
      all.push_back({body, {in[i + 2], in[i + 3]}, {in[i + 4], in[i + 5]}, in[i + 6]});
    }
    last_ = all.front();
    pushes_.assign(all.begin() + 1, all.end());
    aimed_ = {};
  }

  int form_ = 0, locked_ = 0;
  double strength_ = 20, restitution_ = 0.6, friction_ = 0.2, gravity_ = 0;
  std::vector<Push> pushes_;  // active ones
  Push last_;                 // the last one
  BodyId aimed_{};            // the box under the pointer
  Vec2d aimed_point_{}, from_{}, to_{};
};

const Register kEntry{4, kAbout, [] { return std::unique_ptr<Demo>(new SpinningBoxes); }};

}  // namespace
}  // namespace plumb::demos
