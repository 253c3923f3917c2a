#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include "tests/demos/play.h"

// The fifth project's milestones: things that hold together, played as a player would.
namespace plumb::demos {
namespace {

constexpr double kGravity = 9.81;
constexpr int kChain = 10;
constexpr double kLink = 0.3;           // m
constexpr Vec2d kChainHook{-2.2, 5.5};  // m

class EitherWay : public testing::TestWithParam<const char*> {
 protected:
  EitherWay() { demo_->set("joints", GetParam()); }
  const DemoWorld& world() const { return *demo_->world(); }
  bool sticks() const { return std::string_view(GetParam()) == "sticks"; }
  /// Of three bounds the one for these joints.
  double bound(double hinges, double sticks, double direct) const {
    const double bounds[] = {hinges, sticks, direct};
    return bounds[static_cast<int>(demo_->control("joints").value)];
  }

  std::unique_ptr<Demo> demo_ = make("ragdoll");
};
INSTANTIATE_TEST_SUITE_P(Joints, EitherWay, testing::Values("hinges", "sticks", "direct"),
                         [](const auto& each) { return std::string(each.param); });

// Returns the largest difference between the distance of neighbours in the chain and a link's length, m.
double worst_link(const Demo& demo) {
  const std::vector<BodyId> chain = bodies_called(demo, "chain");
  EXPECT_EQ(chain.size(), static_cast<std::size_t>(kChain));
  double worst = 0;
  Vec2d last = kChainHook;
  for (const BodyId bead : chain) {
    const Vec2d here = demo.world()->centre(bead);
    worst = std::max(worst, std::abs(std::sqrt(length_squared(here - last)) - kLink));
    last = here;
  }
  return worst;
}

// Pulled about by the pointer and let go, circles of the chain stay a link apart.
TEST_P(EitherWay, TwoCirclesKeepTheirDistance) {
  const Vec2d end = kChainHook - Vec2d{0, kChain * kLink};
  demo_->press(end);
  double worst = 0;
  for (int i = 0; i < 240; ++i) {
    const double t = i * demo_->dt();
    if (i < 120) demo_->drag(end + Vec2d{1.5 * std::sin(4 * t), 1 - std::cos(4 * t)});
    if (i == 120) demo_->release(end);
    demo_->step_once();
    worst = std::max(worst, worst_link(*demo_));
  }
  // Springs as stiff as a substep allows, sweeps of projections, all links at once.
  EXPECT_LT(worst, bound(0.02, 0.01, 1e-6));  // m
}

// The slowest swing of N equal masses on equal massless links l that hang: w^2 = (g / l) times the first zero
// of the Laguerre polynomial L_N, of which 0.137793471 for N = 10 is published (Abramowitz and Stegun,
// table 25.9). Its shape by inverse iteration: the tension above mass i carries all masses from there down.
struct Swing {
  std::array<double, kChain> shape{};
  double eigenvalue = 0;  // of w^2 l / g
};
Swing slowest_swing() {
  Swing swing;
  swing.shape.fill(1);
  for (int sweep = 0; sweep < 200; ++sweep) {
    // K x = b with K the chain of springs T_i / l: the force on all masses from i down stretches link i.
    std::array<double, kChain> next{};
    double below = 0, at = 0;
    std::array<double, kChain> pull{};
    for (int i = kChain - 1; i >= 0; --i) pull[i] = below += swing.shape[i];
    for (int i = 0; i < kChain; ++i) next[i] = at += pull[i] / (kChain - i);
    double product = 0, norm = 0;
    for (int i = 0; i < kChain; ++i) product += swing.shape[i] * swing.shape[i], norm += next[i] * next[i];
    swing.eigenvalue = std::sqrt(product / norm);
    for (int i = 0; i < kChain; ++i) swing.shape[i] = next[i] / std::sqrt(norm);
  }
  return swing;
}

TEST_P(EitherWay, AChainSwingsLikeARope) {
  const Swing swing = slowest_swing();
  ASSERT_NEAR(swing.eigenvalue, 0.137793471, 1e-9);
  const double period = 2 * std::numbers::pi / std::sqrt(swing.eigenvalue * kGravity / kLink);
  const Vec2d end = kChainHook - Vec2d{0, kChain * kLink};
  demo_->press(end);
  demo_->drag(end + Vec2d{0.15, 0});
  steps(*demo_, 240);
  demo_->release(end + Vec2d{0.15, 0});
  const auto amplitude = [&] {
    double sum = 0;
    const std::vector<BodyId> chain = bodies_called(*demo_, "chain");
    for (int i = 0; i < kChain; ++i) sum += swing.shape[i] * (world().centre(chain[i]).x - kChainHook.x);
    return sum;
  };
  std::vector<double> crossings;
  double before = amplitude();
  for (int i = 0; i < 60 * 16; ++i) {
    demo_->step_once();
    const double now = amplitude();
    const double share = now / (now - before);  // of the step, after the crossing
    if ((now < 0) != (before < 0)) crossings.push_back(demo_->time() - demo_->dt() * share);
    before = now;
  }
  ASSERT_GE(crossings.size(), 9u);
  const double measured =
      2 * (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  EXPECT_NEAR(measured, period, bound(5e-4, 1e-3, 1.2e-4) * period);
}

// More sweeps hold sticks better.
TEST(Ragdoll, MoreIterationsHoldSticksBetter) {
  std::vector<double> gaps;
  for (const double iterations : {1.0, 5.0, 10.0, 30.0}) {
    const std::unique_ptr<Demo> demo = make("ragdoll");
    demo->set("joints", "sticks");
    demo->set("iterations", iterations);
    const Vec2d end = kChainHook - Vec2d{0, kChain * kLink};
    demo->press(end);
    demo->drag(end + Vec2d{2, 1.5});
    double worst = 0;
    for (int i = 0; i < 60; ++i) {
      demo->step_once();
      worst = std::max(worst, worst_link(*demo));
    }
    gaps.push_back(worst);
  }
  EXPECT_TRUE(std::ranges::is_sorted(gaps, std::greater{}));
  EXPECT_LT(gaps.back(), 0.2 * gaps.front());
}

// Returns how far parts of the figure are from being together or at their distance, beside what they were
// at the start, m. Hinges stand where the figure is drawn to have them: here about the hip at (1.5, 5).
class Shape {
 public:
  explicit Shape(const Demo& demo) : demo_(demo) {
    const auto add = [&](const char* a, int i, const char* b, int j, Vec2d at_a, Vec2d at_b) {
      const BodyId body_a = bodies_called(demo, a).at(static_cast<std::size_t>(i));
      const BodyId body_b = bodies_called(demo, b).at(static_cast<std::size_t>(j));
      parts_.push_back({body_a, body_b, demo.world()->local_point(body_a, at_a),
                        demo.world()->local_point(body_b, at_b), std::sqrt(length_squared(at_b - at_a))});
    };
    if (demo.control("joints").value != 1) {
      const Vec2d hip{1.5, 5.0};
      const auto hinge = [&](const char* a, int i, const char* b, int j, Vec2d at) {
        add(a, i, b, j, hip + at, hip + at);
      };
      hinge("torso", 0, "head", 0, {0, 0.61});
      for (const int i : {0, 1}) {
        const double side = 2 * i - 1;
        hinge("torso", 0, "upper arm", i, {side * 0.2, 0.54});
        hinge("upper arm", i, "forearm", i, {side * 0.2, 0.26});
        hinge("torso", 0, "thigh", i, {side * 0.1, 0.02});
        hinge("thigh", i, "shin", i, {side * 0.1, -0.4});
      }
      return;
    }
    const auto stick = [&](const char* a, int i, const char* b, int j) {
      add(a, i, b, j, demo.world()->centre(bodies_called(demo, a).at(static_cast<std::size_t>(i))),
          demo.world()->centre(bodies_called(demo, b).at(static_cast<std::size_t>(j))));
    };
    stick("shoulder", 0, "shoulder", 1);
    stick("hip", 0, "hip", 1);
    for (const int i : {0, 1}) {
      stick("head", 0, "shoulder", i);
      stick("shoulder", i, "hip", 0);
      stick("shoulder", i, "hip", 1);
      stick("shoulder", i, "elbow", i);
      stick("elbow", i, "hand", i);
      stick("hip", i, "knee", i);
      stick("knee", i, "foot", i);
    }
  }

  double worst() const {
    double worst = 0;
    for (const Parts& each : parts_) {
      const Vec2d a = demo_.world()->world_point(each.a, each.at_a);
      const Vec2d b = demo_.world()->world_point(each.b, each.at_b);
      worst = std::max(worst, std::abs(std::sqrt(length_squared(b - a)) - each.apart));
    }
    return worst;
  }

 private:
  struct Parts {
    BodyId a, b;
    Vec2d at_a, at_b;  // m, in their frames
    double apart = 0;  // m
  };
  const Demo& demo_;
  std::vector<Parts> parts_;
};

// The pointer takes the figure by the middle and swings it about: what is joined stays joined.
TEST_P(EitherWay, TheRagdollHoldsItsShapeWhenDragged) {
  const Vec2d middle{1.5 + (sticks() ? 0.1 : 0), 5.0 + (sticks() ? 0.02 : 0.3)};  // a hip, or the torso
  demo_->press(middle);
  const Shape shape(*demo_);
  double worst = 0, farthest = 0;
  const BodyId part = body_called(*demo_, sticks() ? "hip" : "torso");
  for (int i = 0; i < 240; ++i) {
    const double t = i * demo_->dt();
    const Vec2d pointer = middle + Vec2d{-1.5 * std::sin(3 * t), 0.5 * std::sin(6 * t)};
    demo_->drag(pointer);
    demo_->step_once();
    worst = std::max(worst, shape.worst());
    if (i > 30) farthest = std::max(farthest, std::sqrt(length_squared(world().centre(part) - pointer)));
  }
  EXPECT_LT(worst, bound(0.006, 0.1, 3e-6));  // m
  EXPECT_LT(farthest, 0.8);                   // it comes along
}

// Dropped, it falls, hits the obstacles, turns over, and comes to rest lying low.
TEST_P(EitherWay, TheRagdollTumblesWhenDropped) {
  const BodyId head = body_called(*demo_, "head");
  const double start = world().centre(head).y;
  const BodyId foot = body_called(*demo_, sticks() ? "foot" : "shin");
  const double height = start - world().centre(foot).y;
  EXPECT_GT(height, 1.2);
  const Shape shape(*demo_);
  double worst = 0, fastest = 0, least = 10;
  for (int i = 0; i < 60 * 12; ++i) {
    demo_->step_once();
    worst = std::max(worst, shape.worst());
    fastest = std::max(fastest, std::sqrt(length_squared(world().velocity(head))));
    least = std::min(least, world().centre(head).y - world().centre(foot).y);
  }
  EXPECT_LT(least, height / 2);  // its head was hardly above its feet: it turned over
  EXPECT_GT(fastest, 3);
  EXPECT_LT(world().centre(head).y, start - 2);
  EXPECT_LT(figure(*demo_, "kinetic energy"), 5);
  // Largest gap, m.
  EXPECT_LT(worst, bound(0.04, 0.1, 1e-4));
}

// Elbows and knees turn as far as they may, and no farther.
TEST(Ragdoll, JointsStayWithinTheirLimits) {
  struct Turns {
    const char* part;
    double least, most;  // rad
  };
  constexpr Turns kTurns[] = {{"head", -0.5, 0.5},
                              {"upper arm", -0.9, 2.8},
                              {"forearm", -0.05, 2.4},
                              {"thigh", -0.5, 1.9},
                              {"shin", -2.4, 0.05}};
  const std::unique_ptr<Demo> demo = make("ragdoll");
  double worst = 0;
  int limited = 0;
  for (int i = 0; i < 60 * 6; ++i) {
    demo->step_once();
    for (const Turns& turns : kTurns) {
      for (const BodyId body : bodies_called(*demo, turns.part)) {
        for (const JointId joint : demo->world()->joints(body)) {
          const auto [parent, part] = demo->world()->bodies(joint);
          if (part != body) continue;
          const double angle = demo->world()->angle(part) - demo->world()->angle(parent);
          worst = std::max({worst, turns.least - angle, angle - turns.most});
          limited += angle < turns.least + 0.02 || angle > turns.most - 0.02 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(limited, 60);  // they are reached
  EXPECT_LT(worst, 0.1);   // rad
}

// Let go while it is carried along, it flies on.
TEST_P(EitherWay, AFlungFigureFlies) {
  demo_->set("gravity", 0);
  const Vec2d start{1.5 + (sticks() ? 0.1 : 0), 5.0 + (sticks() ? 0.02 : 0.3)};
  demo_->press(start);
  Vec2d pointer = start;
  for (int i = 0; i < 60; ++i) {
    pointer += Vec2d{-3 * demo_->dt(), 0};
    demo_->drag(pointer);
    demo_->step_once();
  }
  demo_->release(pointer);
  steps(*demo_, 12);
  Vec2d momentum{};
  double mass = 0;
  for (const BodyId body : world().bodies()) {
    if (world().name(body) == "rope" || world().name(body) == "chain") continue;
    momentum += world().mass(body) * world().velocity(body);
    mass += world().mass(body);
  }
  EXPECT_NEAR(mass, 60, 1e-4);
  EXPECT_NEAR(momentum.x / mass, -3, 1.5);  // parts of it swing about the band
}

// Sticks are distance joints between points, solved by moving positions; hinges are revolute joints.
TEST(Ragdoll, JointsCanBeSwitched) {
  const std::unique_ptr<Demo> demo = make("ragdoll");
  EXPECT_EQ(demo->world()->solver(), Solver::SoftSteps);
  EXPECT_EQ(bodies_called(*demo, "knee").size(), 0u);
  demo->key('j');
  EXPECT_EQ(demo->world()->solver(), Solver::Jakobsen);
  EXPECT_EQ(demo->world()->iterations(), 8);
  EXPECT_EQ(bodies_called(*demo, "knee").size(), 2u);
  demo->key('n');
  EXPECT_EQ(bodies_called(*demo, "knee").size(), 4u);
  demo->key('j');
  EXPECT_EQ(bodies_called(*demo, "torso").size(), 1u);
  demo->set("joints", "direct");
  EXPECT_EQ(demo->world()->solver(), Solver::Direct);
}

}  // namespace
}  // namespace plumb::demos
