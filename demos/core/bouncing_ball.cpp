#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "demos/core/registry.h"
#include "engine/simulation/simulation.h"

namespace plumb::demos {
namespace {

constexpr double kWidth = 8, kHeight = 6;  // m, of the room, whose corner is the origin
constexpr double kRadius = 0.3;            // m
constexpr double kMass = 1;                // kg
constexpr Vec2d kStart{1.5, 5.2};          // m
constexpr Vec2d kStartVelocity{2.5, 0};    // m/s
constexpr std::size_t kTrail = 180;        // points

const About kAbout{"bouncing_ball", "a ball falls, speeds up, bounces off four walls and settles",
                   "Click to put the ball somewhere, drag to carry it, let go on the move to throw it. Watch "
                   "the energy with "
                   "the Euler schemes and a long step: explicit Euler gains some each step, and neither ever "
                   "lies quite still."};

constexpr Integrator kIntegrators[] = {Integrator::ExplicitEuler, Integrator::SemiImplicitEuler,
                                       Integrator::VelocityVerlet};

class BouncingBall final : public Demo {
 public:
  BouncingBall() : Demo(kAbout) {
    add_slider("gravity", "m/s^2", 0.0, 20.0, gravity_, "how fast falling speeds up");
    add_slider("restitution", "", 0.0, 1.0, restitution_, "share of the speed that a bounce gives back");
    add_slider("damping", "1/s", 0.0, 2.0, damping_, "share of the speed that the air takes in a second");
    add_choice("integrator", {"explicit Euler", "semi-implicit Euler", "Verlet"}, integrator_,
               "how velocity and position follow from the forces");
    add_slider("dt", "s", 0.001, 0.05, dt_, "length of a step");
    restart();
  }

  void press(Vec2d point) override {
    hold(point);
    hand_ = {};
    held_before_ = *held_;
  }
  void drag(Vec2d point) override { hold(point); }
  void release(Vec2d point) override {
    hold(point);
    simulation_->set_state(kBall, {.position = *held_, .velocity = hand_});
    held_.reset();
  }

  void draw(DebugDraw& out, const DrawOptions& options) const override {
    for (std::size_t i = 1; i < trail_.size(); ++i) out.segment(trail_[i - 1], trail_[i], DrawRole::Trail);
    if (options.shapes) {
      const Vec2d corners[] = {{0, 0}, {kWidth, 0}, {kWidth, kHeight}, {0, kHeight}};
      for (int i = 0; i < 4; ++i) out.segment(corners[i], corners[(i + 1) % 4], DrawRole::Static);
      out.circle(drawn_position(), kRadius, {1, 0}, DrawRole::Awake);
    }
    if (options.centres) out.point(drawn_position(), DrawRole::Centre);
    if (options.names) out.text(drawn_position(), "ball", DrawRole::Name);
  }

  std::vector<Figure> figures() const override {
    const BodyState ball = simulation_->state(kBall);
    const double kinetic = kMass / 2 * length_squared(ball.velocity);
    const double height = ball.position.y - kRadius;
    return {{"time", time(), "s"},
            {"height", height, "m"},
            {"speed", std::sqrt(length_squared(ball.velocity)), "m/s"},
            {"kinetic energy", kinetic, "J"},
            {"energy", kinetic + kMass * gravity_ * height, "J"}};
  }

  Aabb<double> view() const override { return Aabb<double>{{0, 0}, {kWidth, kHeight}}.grown(0.3); }
  std::vector<Moving> moving() const override {
    const BodyState ball = simulation_->state(kBall);
    const Vec2d at = drawn_position(), size{kRadius, kRadius};
    const Vec2d force = step_count() > 0 ? kMass / dt() * (ball.velocity - before_.velocity) : Vec2d{};
    return {{{at - size, at + size}, at, ball.velocity, held_ ? Vec2d{} : force, kMass}};
  }
  double gravity() const override { return gravity_; }
  std::optional<Scene> scene() const override {
    Scene now = start();
    const BodyState ball = simulation_->state(kBall);
    now.bodies[kBall].position = ball.position, now.bodies[kBall].velocity = ball.velocity;
    return now;
  }
  std::uint64_t hash() const override { return simulation_->hash(); }
  const Simulation* simulation() const override { return &*simulation_; }

 private:
  static constexpr std::size_t kBall = 1;  // its index in the scene

  // Returns the scene: four walls around the room, as one body, and the ball, which has a fixed rotation.
  Scene start() const {
    constexpr double kThick = 1;
    const auto wall = [&](Vec2d middle, double width, double height) {
      return Shape{
          .geometry = Box{width, height}, .position = middle, .friction = 0, .restitution = restitution_};
    };
    const double broad = kWidth + 2 * kThick;
    Scene scene{.name = "bouncing_ball", .gravity = {0, -gravity_}};
    scene.bodies = {{.name = "room",
                     .type = BodyType::Static,
                     .shapes = {wall({kWidth / 2, -kThick / 2}, broad, kThick),
                                wall({kWidth / 2, kHeight + kThick / 2}, broad, kThick),
                                wall({-kThick / 2, kHeight / 2}, kThick, kHeight),
                                wall({kWidth + kThick / 2, kHeight / 2}, kThick, kHeight)}},
                    {.name = "ball",
                     .position = kStart,
                     .velocity = kStartVelocity,
                     .mass = kMass,
                     .fixed_rotation = true,
                     .shapes = {{.geometry = Circle{kRadius}, .friction = 0, .restitution = restitution_}}}};
    if (damping_ > 0) scene.forces = {LinearDrag{.body = "ball", .coefficient = damping_ * kMass}};
    return scene;
  }

  Simulation compiled() const {
    return compile(start(), Realtime{.dt = dt_, .substeps = 1, .integrator = kIntegrators[integrator_]});
  }

  void build() override {
    simulation_.emplace(compiled());
    trail_.clear();
    before_ = simulation_->state(kBall);
  }

  // Keeps the ball's state when a setting changes.
  void changed(std::string_view) override {
    const BodyState ball = simulation_->state(kBall);
    simulation_.emplace(compiled());
    simulation_->set_state(kBall, ball);
  }

  void step() override {
    if (held_) {
      simulation_->set_state(kBall, {.position = *held_});
      // Returns the speed of the hand, averaged over about a tenth of a second so that a single jerk counts
      // little.
      constexpr double kHand = 0.1;  // s
      const double share = std::min(1.0, dt() / kHand);
      hand_ += share * (1 / dt() * (*held_ - held_before_) - hand_);
      held_before_ = *held_;
    }
    before_ = simulation_->state(kBall);
    if (!held_) simulation_->step();
    if (trail_.size() == kTrail) trail_.erase(trail_.begin());
    trail_.push_back(simulation_->state(kBall).position);
  }

  // Fixes the ball at the pointer, inside the room.
  void hold(Vec2d point) {
    held_ = Vec2d{std::clamp(point.x, kRadius, kWidth - kRadius),
                  std::clamp(point.y, kRadius, kHeight - kRadius)};
    simulation_->set_state(kBall, {.position = *held_});
    before_ = simulation_->state(kBall);
  }

  Vec2d drawn_position() const {
    const Vec2d now = simulation_->state(kBall).position;
    return before_.position + fraction() * (now - before_.position);
  }

  void write(Encoder& out) const override { out.put(simulation_->save()); }
  void read(Decoder& in) override {
    std::vector<std::byte> snapshot;
    in.get(snapshot, "simulation");
    Simulation restored = compiled();
    restored.restore(snapshot);
    simulation_.emplace(std::move(restored));
    before_ = simulation_->state(kBall);
    held_.reset();
    trail_.clear();
  }

  double gravity_ = 9.81, restitution_ = 0.8, damping_ = 0.1;
  int integrator_ = 2;
  std::optional<Simulation> simulation_;
  std::optional<Vec2d> held_;  // position of the pointer that holds the ball
  Vec2d held_before_{};        // the same, a step earlier
  Vec2d hand_{};               // m/s, of the pointer
  BodyState before_;           // the ball before the step
  std::vector<Vec2d> trail_;
};

const Register kEntry{1, kAbout, [] { return std::unique_ptr<Demo>(new BouncingBall); }};

}  // namespace
}  // namespace plumb::demos
