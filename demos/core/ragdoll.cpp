#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "demos/core/doll.h"
#include "demos/core/registry.h"
#include "demos/core/world_demo.h"
#include "engine/world/queries.h"

namespace plumb::demos {
namespace {

constexpr double kLeft = -4.6, kRight = 3.4, kHeight = 6.3;  // m, of the room above the ground
constexpr double kReach = 0.2;                               // m, search radius of the pointer
constexpr int kMostDolls = 6;
constexpr Vec2d kStart{1.5, 5.0};  // m, of the first figure's hip

constexpr Vec2d kRopeHook{-4.2, 5.5}, kChainHook{-2.2, 5.5};
constexpr int kRopeParts = 16, kChainParts = 10;
constexpr double kRopePart = 0.25, kRopeRadius = 0.04, kRopePartMass = 0.2;  // m, m, kg
constexpr double kChainLink = 0.3, kChainRadius = 0.12, kChainMass = 1;      // m, m, kg

enum Joints { kHinges, kSticks, kDirect };

const About kAbout{
    "ragdoll",
    "a figure of jointed parts to pick up and fling, a rope and a chain of circles",
    "Drag a body with the pointer and let go to fling it. Hinges hold rigid parts; sticks hold points "
    "apart by moving them several times a step.",
    {{'n', "another figure"}, {'j', "hinges or sticks"}}};

class Ragdoll final : public WorldDemo {
 public:
  Ragdoll() : WorldDemo(kAbout) {
    substeps_ = 8;
    add_choice("joints", {"hinges", "sticks", "direct"}, joints_,
               "hinges in sweeps, points and sticks, or hinges all at once; starts anew");
    add_slider("iterations", "", 1, 30, iterations_, "how often sticks are gone through in a substep");
    add_slider("gravity", "m/s^2", 0.0, 20.0, gravity_, "how fast falling speeds up");
    add_step_controls();
    restart();
  }

  void key(char key) override {
    if (key == 'j') set("joints", joints_ == kHinges ? kSticks : kHinges);
    if (key == 'n') add_another();
  }

  std::vector<Figure> figures() const override {
    return {{"time", time(), "s"},
            {"figures", static_cast<double>(dolls_), ""},
            {"joints", static_cast<double>(world_.counts().joints), ""},
            {"widest gap of a joint", 1000 * widest_gap(), "mm"},
            {"kinetic energy", totals_of(world_).energy, "J"}};
  }

  Aabb<double> view() const override { return {{kLeft - 0.2, -0.3}, {kRight + 0.2, kHeight}}; }

 private:
  double reach() const override { return kReach; }

  // Iterative solvers yield if a figure is pinched with its joints at their limits. The direct solver keeps
  // joints closed to micrometres until such a pinch.
  WorldDefinition definition() const override {
    constexpr Solver kSolvers[] = {Solver::SoftSteps, Solver::Jakobsen, Solver::Direct};
    return {.gravity = {0, -gravity_},
            .solver = kSolvers[joints_],
            .iterations = iterations_,
            .direct_islands = false};
  }

  void fill() override {
    dolls_ = 0;
    add_room();
    add_rope();
    add_chain();
    add_doll(kStart);
  }

  void add_room() {
    const auto block = [](Vec2d middle, double width, double height, double angle, double friction) {
      return ShapeDefinition{.geometry = Box{width, height},
                             .position = middle,
                             .angle = angle,
                             .material = {.friction = friction}};
    };
    constexpr double kRough = 0.6, kSmooth = 0.15;
    const ShapeDefinition shapes[] = {
        block({(kLeft + kRight) / 2, -0.5}, kRight - kLeft + 2, 1, 0, kRough),
        block({kLeft - 0.5, 10}, 1, 20, 0, kSmooth),
        block({kRight + 0.5, 10}, 1, 20, 0, kSmooth),
        block({2.8, 1.9}, 1.4, 0.2, 0.5, kSmooth),
        block({0.2, 1.4}, 2.2, 0.2, 0.4, kSmooth),
        block({-2.1, 0.2}, 1.2, 0.4, 0, kRough),
        block({-1.9, 0.5}, 0.8, 0.3, 0, kRough),
        {.geometry = Circle{0.3}, .position = {1.8, 3.2}, .material = {.friction = kSmooth}},
    };
    world_.create_body({.name = "room", .type = BodyType::Static}, shapes);
  }

  // Adds a bead; parts of one line do not collide with each other.
  BodyId add_bead(const char* name, Vec2d position, double radius, double mass, int group) {
    return world_.create_body({.name = name, .position = position},
                              {.geometry = Circle{radius},
                               .density = mass / extent_of(Circle{radius}).area,
                               .filter = {.group = -group}});
  }

  // Adds a stick from the hook to the centre of a body.
  void hang(Vec2d hook, BodyId body) {
    const double length = std::sqrt(length_squared(world_.centre(body) - hook));
    world_.create_joint(frame_, body, {.kind = DistanceDefinition{.anchor_a = hook, .length = length}});
  }

  static constexpr int kRopeGroup = 1, kChainGroup = 2, kFirstDollGroup = 3;

  // Adds a rope of rods joined by hinges, or of beads on sticks.
  void add_rope() {
    BodyId last = frame_;
    for (int i = 0; i < kRopeParts; ++i) {
      const Vec2d top = kRopeHook - Vec2d{0, i * kRopePart}, end = top - Vec2d{0, kRopePart};
      if (joints_ == kSticks) {
        const BodyId bead = add_bead("rope", end, kRopeRadius, kRopePartMass, kRopeGroup);
        if (i == 0) hang(kRopeHook, bead);
        if (i > 0) add_stick(world_, last, bead);
        last = bead;
        continue;
      }
      const Vec2d half{0, kRopePart / 2};
      const Capsule rod{half, -half, kRopeRadius};
      const BodyId part = world_.create_body({.name = "rope", .position = top - half},
                                             {.geometry = rod,
                                              .density = kRopePartMass / extent_of(rod).area,
                                              .filter = {.group = -kRopeGroup}});
      const Vec2d anchor = world_.local_point(last, top);
      world_.create_joint(last, part, {.kind = RevoluteDefinition{.anchor_a = anchor, .anchor_b = half}});
      last = part;
    }
  }

  // Adds a chain of circles joined by sticks between their centres, with either kind of joints.
  void add_chain() {
    BodyId last{};
    for (int i = 0; i < kChainParts; ++i) {
      const Vec2d place = kChainHook - Vec2d{0, (i + 1) * kChainLink};
      const BodyId bead = add_bead("chain", place, kChainRadius, kChainMass, kChainGroup);
      if (i == 0) hang(kChainHook, bead);
      if (i > 0) add_stick(world_, last, bead);
      last = bead;
    }
  }

  // Adds another figure at the first free place.
  void add_another() {
    constexpr Aabb<double> kRoom{{-0.5, -1}, {0.5, 1.1}};  // m, relative to the hip
    for (const double x : {1.5, 0.3, 2.7, -0.9, -3.2}) {
      const Vec2d hip{x, kStart.y};
      std::vector<ShapeId> there;
      overlap_box(world_, {hip + kRoom.lower, hip + kRoom.upper}, {}, there);
      if (there.empty() && dolls_ < kMostDolls) return add_doll(hip);
    }
  }

  void add_doll(Vec2d hip) {
    const int group = kFirstDollGroup + dolls_++;
    if (joints_ == kSticks) {
      add_stick_doll(world_, hip, group);
    } else {
      add_jointed_doll(world_, hip, group);
    }
  }

  void changed(std::string_view control) override {
    if (control == "joints") return restart();
    world_.set_gravity({0, -gravity_});
    world_.set_iterations(iterations_);
  }

  double widest_gap() const {
    double widest = 0;
    for (const BodyId body : world_.bodies()) {
      for (const JointId joint : world_.joints(body)) {
        if (!std::holds_alternative<MouseDefinition>(world_.kind(joint)))
          widest = std::max(widest, world_.read(joint).linear_error);
      }
    }
    return widest;
  }

  std::vector<double> own() const override { return {static_cast<double>(dolls_)}; }
  void set_own(std::span<const double> in) override { dolls_ = static_cast<int>(in[0]); }

  int joints_ = kHinges, iterations_ = 8;
  double gravity_ = 9.81;
  int dolls_ = 0;
};

const Register kEntry{5, kAbout, [] { return std::unique_ptr<Demo>(new Ragdoll); }};

}  // namespace
}  // namespace plumb::demos
