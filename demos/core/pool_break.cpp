#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "demos/core/registry.h"
#include "demos/core/world_demo.h"

namespace plumb::demos {
namespace {

constexpr double kLength = 2.54, kWidth = 1.27;     // m, a table of nine feet with its middle at the origin
constexpr double kRadius = 0.028575, kMass = 0.17;  // m, kg, of a ball
constexpr double kCushion = 0.1;                    // m, drawn thickness
constexpr double kPocket = 0.05;  // m: a ball falls into a pocket if its centre is nearer than this
constexpr Vec2d kCueSpot{-kLength / 4, 0}, kFootSpot{kLength / 4, 0};
constexpr double kGap = 1e-4;                   // m, between the balls of the rack
constexpr double kHardness = 8, kFastest = 12;  // 1/s, m/s: the cue ball's speed per metre of aim
constexpr double kGlow = 0.25;                  // s, for which a ball is highlighted
constexpr int kBalls = 16;                      // the cue ball is the first

const About kAbout{
    "pool_break",
    "aim, break the rack, watch momentum and energy",
    "Press and drag to where the cue ball is to go, the farther the harder, and release. Balls that "
    "touch light up. A heavy cue ball barely slows; a light one bounces back.",
    {{' ', "break as hard as it goes"}, {'m', "the next mass of the cue ball"}, kGrabKey}};

constexpr double kCueMasses[] = {kMass, 10 * kMass, kMass / 10};

class PoolBreak final : public WorldDemo {
 public:
  PoolBreak() : WorldDemo(kAbout) {
    dt_ = 1.0 / 240;
    add_pointer_play("shoot");
    add_slider("balls", "", 1, kBalls - 1, racked_, "in the rack; starts anew");
    add_slider("restitution", "", 0.0, 1.0, restitution_, "of balls and cushions, now");
    add_slider("cue mass", "kg", kMass / 10, kMass * 10, cue_mass_,
               "of the cue ball; the others have 0.17 kg");
    add_slider("cloth", "1/s", 0.0, 2.0, cloth_, "share of the speed that the cloth takes in a second");
    add_switch("pockets", pockets_, "whether balls fall into pockets");
    add_step_controls();
    restart();
  }

  void key(char key) override {
    WorldDemo::key(key);
    if (key == ' ') shoot({kFastest / kHardness, 0.01});
    if (key == 'm') {
      const double* here = std::ranges::find(kCueMasses, cue_mass_);
      const bool last = here >= std::end(kCueMasses) - 1;
      set("cue mass", last ? kCueMasses[0] : here[1]);
    }
  }

  std::vector<Figure> figures() const override {
    const Totals totals = totals_of(world_);
    return {{"time", time(), "s"},
            {"momentum", std::sqrt(length_squared(totals.momentum)), "kg m/s"},
            {"momentum x", totals.momentum.x, "kg m/s"},
            {"momentum y", totals.momentum.y, "kg m/s"},
            {"kinetic energy", totals.energy, "J"},
            {"cue ball's speed", std::sqrt(length_squared(world_.velocity(cue()))), "m/s"},
            {"collisions", collisions_, ""},
            {"balls in pockets", static_cast<double>(in_pockets()), ""}};
  }

  Aabb<double> view() const override {
    return Aabb<double>{{-kLength / 2, -kWidth / 2}, {kLength / 2, kWidth / 2}}.grown(0.15);
  }

 private:
  void begin(Vec2d point) override { aim_ = point; }
  void go_on(Vec2d point) override { aim_ = point; }
  void end(Vec2d point) override {
    aim_.reset();
    shoot(point - world_.position(cue()));
  }

  WorldDefinition definition() const override { return {.gravity = {0, 0}, .sleeping = false}; }

  Material material() const { return {.friction = 0, .restitution = restitution_}; }

  void fill() override {
    collisions_ = 0;
    std::ranges::fill(touched_, -kGlow);
    add_cushions();
    std::ranges::fill(balls_, BodyId{});
    balls_[0] = add_ball(0, kCueSpot);
    for (int ball = 1; ball <= racked_; ++ball) balls_[ball] = add_ball(ball, spot(ball));
    changed("");
  }

  void add_cushions() {
    const auto cushion = [&](Vec2d middle, double width, double height) {
      return ShapeDefinition{.geometry = Box{width, height}, .position = middle, .material = material()};
    };
    const double x = (kLength + kCushion) / 2, y = (kWidth + kCushion) / 2, whole = kLength + 2 * kCushion;
    const ShapeDefinition shapes[] = {cushion({0, y}, whole, kCushion), cushion({0, -y}, whole, kCushion),
                                      cushion({x, 0}, kCushion, kWidth), cushion({-x, 0}, kCushion, kWidth)};
    world_.create_body({.name = "table", .type = BodyType::Static, .user_data = kBalls}, shapes);
  }

  // Returns a ball's place in the rack: rows of 1, 2, ... 5 balls in a triangle with its tip on the foot
  // spot.
  static Vec2d spot(int ball) {
    int row = 0, first = 1;
    while (ball >= first + row + 1) first += ++row;
    const double apart = 2 * kRadius + kGap;
    return kFootSpot + Vec2d{row * apart * std::sqrt(0.75), (ball - first - 0.5 * row) * apart};
  }

  BodyId add_ball(int ball, Vec2d position) {
    return world_.create_body(
        {.name = ball == 0 ? "cue" : std::to_string(ball),
         .position = position,
         .mass = MassProperties{.mass = kMass, .inertia = kMass * kRadius * kRadius / 2},
         .user_data = static_cast<std::uint64_t>(ball)},
        {.geometry = Circle{kRadius}, .material = material(), .hit_events = true});
  }

  BodyId cue() const { return balls_[0]; }
  bool labelled(BodyId body) const override { return body == cue(); }
  bool on_table(int ball) const { return world_.valid(balls_[ball]); }
  int in_pockets() const {
    int count = 0;
    for (int ball = 0; ball <= racked_; ++ball) count += on_table(ball) ? 0 : 1;
    return count;
  }

  void changed(std::string_view control) override {
    if (control == "balls") return restart();
    world_.set_mass(cue(), {.mass = cue_mass_, .inertia = cue_mass_ * kRadius * kRadius / 2});
    for (const BodyId body : world_.bodies()) {
      if (world_.type(body) == BodyType::Dynamic) world_.set_damping(body, cloth_, cloth_);
      for (const ShapeId shape : world_.shapes(body)) world_.set_material(shape, material());
    }
  }

  static Vec2d speed_for(Vec2d way) {
    const double length = std::sqrt(length_squared(way));
    return length * kHardness > kFastest ? kFastest / length * way : kHardness * way;
  }
  void shoot(Vec2d way) { world_.apply_impulse(cue(), cue_mass_ * speed_for(way)); }

  // Records the time of a ball's last contact: hit events for balls that meet and separate within a step, and
  // touching pairs.
  void touch(ShapeId shape) {
    const std::uint64_t ball = world_.valid(shape) ? world_.user_data(world_.body(shape)) : kBalls;
    if (ball < kBalls) touched_[ball] = time();
  }
  bool is_pressed(BodyId body) const {
    return std::ranges::any_of(world_.contacts(body), [](const ContactReading& contact) {
      return contact.count > 0 && contact.impulses[0] > 0;
    });
  }

  void after_step() override {
    collisions_ += static_cast<double>(world_.events().hits.size());
    for (const HitEvent& hit : world_.events().hits) touch(hit.shape_a), touch(hit.shape_b);
    for (int ball = 0; ball < kBalls; ++ball) {
      if (on_table(ball) && is_pressed(balls_[ball])) touched_[ball] = time();
    }
    if (pockets_) drop_into_pockets();
  }

  static bool over_pocket(Vec2d at) {
    for (const double x : {-kLength / 2, 0.0, kLength / 2}) {
      const Vec2d from{at.x - x, std::abs(at.y) - kWidth / 2};
      if (length_squared(from) < kPocket * kPocket) return true;
    }
    return false;
  }

  // Removes balls over pockets; the cue ball returns to its spot.
  void drop_into_pockets() {
    for (int ball = 0; ball < kBalls; ++ball) {
      if (!on_table(ball) || !over_pocket(world_.position(balls_[ball]))) continue;
      world_.destroy(balls_[ball]);
      if (ball == 0) {
        balls_[0] = add_ball(0, kCueSpot);
        changed("");
      }
    }
  }

  void draw_over(DebugDraw& out) const override {
    if (pockets_) {
      for (const double x : {-kLength / 2, 0.0, kLength / 2}) {
        for (const double y : {-kWidth / 2, kWidth / 2})
          out.circle({x, y}, kPocket, {0, 0}, DrawRole::Sensor);
      }
    }
    // The cue ball has its own colour and mass.
    if (world_.valid(cue())) {
      const Vec2d centre = drawn_centre(cue());
      out.circle(centre, kRadius, {0, 0}, DrawRole::Kinematic);
      out.text(centre + Vec2d{0, 1.5 * kRadius}, mass_text(world_.mass(cue())), DrawRole::Name);
    }
    for (int ball = 0; ball < kBalls; ++ball) {
      if (on_table(ball) && time() - touched_[ball] < kGlow)
        out.circle(drawn_centre(balls_[ball]), kRadius, {0, 0}, DrawRole::Highlight);
    }
    if (!aim_) return;
    const Vec2d from = drawn_centre(cue());
    draw_arrow(out, from, *aim_, DrawRole::Aim);
  }

  std::vector<double> own() const override {
    std::vector<double> out = {collisions_};
    for (int ball = 0; ball < kBalls; ++ball) {
      for (const double each : {touched_[ball], static_cast<double>(balls_[ball].index),
                                static_cast<double>(balls_[ball].generation)})
        out.push_back(each);
    }
    return out;
  }
  void set_own(std::span<const double> in) override {
    collisions_ = in[0];
    for (int ball = 0; ball < kBalls; ++ball) {
      touched_[ball] = in[1 + 3 * ball];
      balls_[ball] = {static_cast<std::uint32_t>(in[2 + 3 * ball]),
                      static_cast<std::uint32_t>(in[3 + 3 * ball])};
    }
    aim_.reset();
  }

  int racked_ = kBalls - 1;
  double restitution_ = 0.95, cue_mass_ = kMass, cloth_ = 0.3;
  bool pockets_ = true;
  BodyId balls_[kBalls];
  double touched_[kBalls] = {};  // s, time of each ball's last contact
  double collisions_ = 0;
  std::optional<Vec2d> aim_;
};

const Register kEntry{3, kAbout, [] { return std::unique_ptr<Demo>(new PoolBreak); }};

}  // namespace
}  // namespace plumb::demos
