#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "demos/core/registry.h"
#include "demos/core/world_demo.h"

namespace plumb::demos {
namespace {

constexpr double kGravity = 9.81;         // m/s^2
constexpr Vec2d kMuzzle{1, 1.5};          // m
constexpr double kBarrel = 1;             // m, from the hinge at the cannon's base to the muzzle
constexpr double kMasses[] = {1, 10};     // kg
constexpr double kRadii[] = {0.2, 0.43};  // m: a volume ratio of 10 to 1
constexpr double kApart = 0.8;            // m, between two balls fired together
constexpr std::size_t kMost = 40;         // balls at a time
constexpr double kLost = 200;             // m from the muzzle, beyond which a ball is removed
constexpr double kForceScale = 0.03;      // m of arrow per N
constexpr double kPathStep = 0.05;        // s
constexpr int kPathSteps = 60;

enum Fired { kLight, kHeavy, kBoth };
enum Mode { kImpulse, kForce };

const About kAbout{
    "cannonballs",
    "balls of 1 and 10 kg under the same force, in gravity and wind",
    "Point where to fire, click to fire. The same impulse, or the same force for as long, gives the "
    "heavy ball a tenth of the light one's speed. Arrows are forces: weight, wind and thrust add up.",
    {{'1', "fire light balls"},
     {'2', "fire heavy balls"},
     {'3', "fire one of each"},
     {' ', "fire"},
     {'c', "clear the balls away"},
     kGrabKey}};

/// A ball in flight, with its thrust.
struct Ball {
  BodyId body{};
  Vec2d thrust{};   // N
  double left = 0;  // s, remaining duration of the thrust
};

class Cannonballs final : public WorldDemo {
 public:
  Cannonballs() : WorldDemo(kAbout) {
    add_pointer_play("fire");
    add_choice("balls", {"light (1 kg)", "heavy (10 kg)", "both"}, fired_, "what is fired");
    add_choice("fired by", {"impulse", "force"}, mode_, "a blow at once, or a push that lasts");
    add_slider("impulse", "N s", 0.0, 60.0, impulse_, "of the blow");
    add_slider("force", "N", 0.0, 200.0, force_, "of the push");
    add_slider("duration", "s", 0.0, 2.0, duration_, "of the push");
    add_slider("wind", "N", -20.0, 20.0, wind_, "force on every ball, to the right");
    add_slider("gravity", "m/s^2", 0.0, 20.0, gravity_, "how fast falling speeds up");
    add_switch("each force", show_forces_, "arrows of weight, wind and thrust");
    add_step_controls();
    restart();
  }

  void hover(Vec2d point) override { aimed_ = point; }
  void key(char key) override {
    WorldDemo::key(key);
    if (key >= '1' && key <= '3') set("balls", key - '1');
    if (key == ' ') fire();
    if (key == 'c') clear();
  }

  std::vector<Figure> figures() const override {
    const Totals totals = totals_of(world_);
    std::vector<Figure> out = {{"time", time(), "s"},
                               {"balls", static_cast<double>(balls_.size()), ""},
                               {"momentum x", totals.momentum.x, "kg m/s"},
                               {"kinetic energy", totals.energy, "J"}};
    if (!balls_.empty()) {
      const BodyId last = balls_.back().body;
      const double mass = world_.mass(last);
      const Vec2d force = force_on(balls_.back());
      out.push_back({"last ball's mass", mass, "kg"});
      out.push_back({"its speed", std::sqrt(length_squared(world_.velocity(last))), "m/s"});
      out.push_back({"force on it", std::sqrt(length_squared(force)), "N"});
      out.push_back({"force over mass", std::sqrt(length_squared(force)) / mass, "m/s^2"});
    }
    return out;
  }

  Aabb<double> view() const override { return {{-1, -1}, {31, 17}}; }

 private:
  void begin(Vec2d point) override {
    aimed_ = point;
    fire();
  }
  void go_on(Vec2d point) override { aimed_ = point; }

  WorldDefinition definition() const override { return {.gravity = {0, -gravity_}}; }

  void fill() override {
    balls_.clear();
    world_.create_body({.name = "ground", .type = BodyType::Static},
                       {.geometry = Box{400, 2}, .position = {0, -1}, .material = {.restitution = 0.3}});
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 4; ++row) {
        world_.create_body({.name = "crate", .position = {24 + 1.2 * column, 0.5 + row}},
                           {.geometry = Box{1, 1}, .density = 2});
      }
    }
  }

  void changed(std::string_view) override {
    world_.set_gravity({0, -gravity_});
    for (const Ball& ball : balls_) world_.set_awake(ball.body, true);
  }

  Vec2d aim() const {
    const Vec2d way = aimed_ - kMuzzle;
    const double length = std::sqrt(length_squared(way));
    return length > 0 ? (1 / length) * way : Vec2d{1, 0};
  }

  void fire() {
    if (fired_ != kBoth) return fire(fired_, {});
    const Vec2d aside = kApart / 2 * perpendicular(aim());
    fire(kLight, aside), fire(kHeavy, -aside);
  }

  void fire(int which, Vec2d aside) {
    const double mass = kMasses[which], radius = kRadii[which];
    if (balls_.size() == kMost) {
      world_.destroy(balls_.front().body);
      balls_.erase(balls_.begin());
    }
    Ball ball;
    ball.body = world_.create_body(
        {.name = which == kHeavy ? "heavy" : "light",
         .position = kMuzzle + aside,
         .mass = MassProperties{.mass = mass, .inertia = mass * radius * radius / 2},
         .angular_damping = 0.5},
        {.geometry = Circle{radius}, .material = {.restitution = 0.3, .rolling_resistance = 0.05}});
    if (mode_ == kImpulse) {
      world_.apply_impulse(ball.body, impulse_ * aim());
    } else {
      ball.thrust = force_ * aim(), ball.left = duration_;
    }
    balls_.push_back(ball);
  }

  void clear() {
    for (const Ball& ball : balls_) world_.destroy(ball.body);
    balls_.clear();
  }

  Vec2d force_on(const Ball& ball) const {
    const Vec2d weight = world_.mass(ball.body) * world_.gravity();
    return weight + Vec2d{wind_, 0} + (ball.left > 0 ? ball.thrust : Vec2d{});
  }

  // Gravity is the world's own. A thrust that ends within the step is scaled by the fraction of the step, so
  // that its impulse is right. Sleeping balls are skipped.
  void before_step() override {
    for (Ball& ball : balls_) {
      const double share = std::clamp(ball.left / dt(), 0.0, 1.0);
      if (world_.awake(ball.body)) world_.apply_force(ball.body, Vec2d{wind_, 0} + share * ball.thrust);
      ball.left -= share * dt();
    }
  }

  void after_step() override {
    std::erase_if(balls_, [&](const Ball& ball) {
      const bool lost = length_squared(world_.position(ball.body) - kMuzzle) > kLost * kLost;
      if (lost) world_.destroy(ball.body);
      return lost;
    });
  }

  bool labelled(BodyId body) const override {
    return std::ranges::any_of(balls_, [&](const Ball& ball) { return ball.body == body; });
  }

  void draw_over(DebugDraw& out) const override {
    out.capsule(kMuzzle - kBarrel * aim(), kMuzzle, kRadii[kHeavy], DrawRole::Kinematic);
    draw_path(out, fired_ == kHeavy ? kHeavy : kLight);
    if (fired_ == kBoth) draw_path(out, kHeavy);
    for (const Ball& ball : balls_) {
      const double radius = 0.25 * world_.box(ball.body).half_perimeter();
      out.text(drawn_centre(ball.body) + Vec2d{0, radius}, mass_text(world_.mass(ball.body)), DrawRole::Name);
    }
    if (!show_forces_) return;
    for (const Ball& ball : balls_) {
      if (!world_.awake(ball.body)) continue;
      const Vec2d centre = drawn_centre(ball.body);
      const auto arrow = [&](Vec2d force) {
        if (force != Vec2d{}) draw_arrow(out, centre, centre + kForceScale * force, DrawRole::Force);
      };
      arrow(world_.mass(ball.body) * world_.gravity());
      arrow({wind_, 0});
      if (ball.left > 0) arrow(ball.thrust);
    }
  }

  // Draws the predicted path of a ball: x = v t + a t^2/2 under thrust, then without thrust.
  void draw_path(DebugDraw& out, int which) const {
    const double mass = kMasses[which];
    const Vec2d free = world_.gravity() + Vec2d{wind_ / mass, 0};
    const double pushed = mode_ == kForce ? duration_ : 0;
    const Vec2d during = free + force_ / mass * aim();
    const Vec2d start = mode_ == kImpulse ? impulse_ / mass * aim() : Vec2d{};
    const Vec2d push_end = pushed * start + pushed * pushed / 2 * during, speed = start + pushed * during;
    Vec2d last = kMuzzle;
    for (int i = 1; i <= kPathSteps && last.y >= 0; ++i) {
      const double t = i * kPathStep, after = t - pushed;
      const Vec2d here = kMuzzle + (after < 0 ? t * start + t * t / 2 * during
                                              : push_end + after * speed + after * after / 2 * free);
      if (i % 2 == 1) out.segment(last, here, DrawRole::Aim);
      last = here;
    }
  }

  std::vector<double> own() const override {
    std::vector<double> out = {aimed_.x, aimed_.y};
    for (const Ball& ball : balls_) {
      for (const double each :
           {static_cast<double>(ball.body.index), static_cast<double>(ball.body.generation), ball.thrust.x,
            ball.thrust.y, ball.left})
        out.push_back(each);
    }
    return out;
  }
  void set_own(std::span<const double> in) override {
    aimed_ = {in[0], in[1]};
    balls_.clear();
    for (std::size_t i = 2; i + 5 <= in.size(); i += 5) {
      const BodyId body{static_cast<std::uint32_t>(in[i]), static_cast<std::uint32_t>(in[i + 1])};
      balls_.push_back({body, {in[i + 2], in[i + 3]}, in[i + 4]});
    }
  }

  int fired_ = kBoth, mode_ = kImpulse;
  double impulse_ = 15, force_ = 50, duration_ = 0.3, wind_ = 0, gravity_ = kGravity;
  bool show_forces_ = true;
  Vec2d aimed_{12, 9};
  std::vector<Ball> balls_;  // oldest first
};

const Register kEntry{2, kAbout, [] { return std::unique_ptr<Demo>(new Cannonballs); }};

}  // namespace
}  // namespace plumb::demos
