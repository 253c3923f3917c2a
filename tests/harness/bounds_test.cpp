#include "harness/bounds.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "harness/run.h"
#include "tests/harness/fakes.h"

// The bounds must hold for right implementations of a method and must not hold for wrong physics. The methods
// are written out here, apart from any engine.
namespace plumb::harness {
namespace {

using namespace fakes;
using reference::Scheme;

constexpr double kDt = 1.0 / 60;

Result run_fake(const scenarios::Problem& problem, Motion motion, reference::Method how, int substeps = 1) {
  const scenarios::Scenario scenario = family([&] { return problem; });
  const Case scene_case({&scenario, "", 1}, kDt);
  FakeBackend backend("fake", std::move(motion), how);
  backend.substeps_ = substeps;
  return run(scene_case, backend, {});
}

std::string missed(const Result& result) {
  std::string names;
  for (const Check& check : result.checks)
    if (!check.pass) names += check.name + " ";
  return names;
}

using Acceleration = std::function<Vec2d(Vec2d position, Vec2d velocity)>;

// One body under `acceleration`, stepped by the scheme from its start.
Motion stepped(BodyState start, Acceleration acceleration, Scheme scheme, int substeps) {
  return [=](long step, double dt, std::span<BodyState> out) {
    const double h = dt / substeps;
    BodyState s = start;
    for (long i = 0; i < step * substeps; ++i) {
      const Vec2d a = acceleration(s.position, s.velocity);
      if (scheme == Scheme::VelocityVerlet) {
        const Vec2d guess = s.velocity + h * a;
        s.position += h * s.velocity + h * h / 2 * a;
        s.velocity += h / 2 * (a + acceleration(s.position, guess));
      } else {
        if (scheme == Scheme::ExplicitEuler) s.position += h * s.velocity;
        s.velocity += h * a;
        if (scheme == Scheme::SemiImplicitEuler) s.position += h * s.velocity;
      }
    }
    out[0] = s;
  };
}

// A ball that falls through air with linear drag: time constant 0.5 s. Source: v = u + (v0 - u) exp(-t/tau).
scenarios::Problem falling_through_air() {
  scenarios::Problem problem = thrown();
  problem.scene.bodies[0].angular_velocity = 0;
  problem.conserved = {};
  problem.truth.exact = [](double t, std::span<BodyState> out) {
    const double tau = 0.5, gone = -std::expm1(-t / tau);
    const Vec2d u{0, -9.81 * tau}, excess = Vec2d{3, 4} - u;
    out[0] = {Vec2d{1, 2} + t * u + tau * gone * excess, 0, Vec2d{3, 4} - gone * excess, 0};
  };
  return problem;
}

Acceleration drag(double gravity, double tau) {
  return [=](Vec2d, Vec2d v) { return Vec2d{0, -gravity} - (1 / tau) * v; };
}

TEST(Bounds, HoldForTheCoursesSchemes) {
  const BodyState start = initial_state(thrown().scene.bodies[0]);
  for (const int substeps : {1, 4}) {
    for (const Scheme scheme : {Scheme::ExplicitEuler, Scheme::SemiImplicitEuler, Scheme::VelocityVerlet}) {
      const int order = scheme == Scheme::VelocityVerlet ? 2 : 1;
      BodyState still = start;
      still.angular_velocity = 0;
      const Result result = run_fake(falling_through_air(), stepped(still, drag(9.81, 0.5), scheme, substeps),
                                     method(scheme, order), substeps);
      EXPECT_EQ(missed(result), "") << static_cast<int>(scheme) << " with " << substeps;
      // Tight: within ten times of what the scheme does.
      EXPECT_GT(result.find_check("position_error")->value,
                result.find_check("position_error")->tolerance / 10);
    }
  }
}

TEST(Bounds, DoNotHoldForWrongPhysics) {
  BodyState start = initial_state(thrown().scene.bodies[0]);
  start.angular_velocity = 0;
  const auto verlet = method(Scheme::VelocityVerlet, 2);
  const auto with = [&](Acceleration a) {
    return missed(
        run_fake(falling_through_air(), stepped(start, std::move(a), Scheme::VelocityVerlet, 4), verlet, 4));
  };
  EXPECT_EQ(with(drag(9.81, 0.5)), "");
  EXPECT_NE(with(drag(9.80, 0.5)), "");    // a thousandth of gravity
  EXPECT_NE(with(drag(9.81, 0.501)), "");  // two thousandths of the drag
  // First order is caught from a few per cent on.
  const auto euler = [&](Acceleration a) {
    return missed(run_fake(falling_through_air(), stepped(start, std::move(a), Scheme::SemiImplicitEuler, 4),
                           method(Scheme::SemiImplicitEuler, 1), 4));
  };
  EXPECT_EQ(euler(drag(9.81, 0.5)), "");
  EXPECT_NE(euler(drag(9.4, 0.5)), "");
  // A first-order scheme that calls itself second order.
  EXPECT_NE(missed(run_fake(falling_through_air(),
                            stepped(start, drag(9.81, 0.5), Scheme::SemiImplicitEuler, 4), verlet, 4)),
            "");
}

// Two discs that meet off-centre, without friction, elastically; the impulse lies along the line of centres.
scenarios::Problem oblique(double distance_across) {
  scenarios::Problem problem;
  problem.scene.name = "oblique";
  problem.scene.gravity = {0, 0};
  const auto disc = [](const char* name, Vec2d position, Vec2d velocity) {
    return Body{.name = name,
                .position = position,
                .velocity = velocity,
                .mass = 1,
                .shapes = {{.geometry = Circle{0.5}, .friction = 0, .restitution = 1}}};
  };
  problem.scene.bodies = {disc("cue", {-2, distance_across}, {2, 0}), disc("object", {0, 0}, {0, 0})};
  problem.conserved = {.energy = true, .momentum_x = true, .momentum_y = true, .angular_momentum = true};
  const double along = std::sqrt(1 - distance_across * distance_across), hit = (2 - along) / 2;
  problem.truth.impacts = {hit};
  problem.truth.exact = [=](double t, std::span<BodyState> out) {
    const Vec2d n{along, -distance_across}, given = 2 * n.x * n, kept = Vec2d{2, 0} - given,
                                            where{-along, distance_across};
    if (t < hit) {
      out[0] = {{-2 + 2 * t, distance_across}, 0, {2, 0}, 0};
      out[1] = {};
    } else {
      out[0] = {where + (t - hit) * kept, 0, kept, 0};
      out[1] = {(t - hit) * given, 0, given, 0};
    }
  };
  problem.duration = 2;
  return problem;
}

// Discs stepped with h: the impact shows when they overlap, with the normal that they have by then. `wrong`
// scales the impulse.
Motion overlapping_discs(const scenarios::Problem& problem, double wrong) {
  const BodyState a = initial_state(problem.scene.bodies[0]), b = initial_state(problem.scene.bodies[1]);
  return [=](long step, double dt, std::span<BodyState> out) {
    out[0] = a;
    out[1] = b;
    for (long i = 0; i < step; ++i) {
      const Vec2d apart = out[1].position - out[0].position, relative = out[1].velocity - out[0].velocity;
      const double distance = std::hypot(apart.x, apart.y), speed = dot(relative, apart) / distance;
      if (distance < 1 && speed < 0) {
        const Vec2d impulse = wrong * speed / distance * apart;
        out[0].velocity += impulse;
        out[1].velocity -= impulse;
      }
      for (BodyState& s : out) s.position += dt * s.velocity;
    }
  };
}

TEST(Bounds, HoldForImpactsThatShowAStepLate) {
  for (const double across : {0.0, 0.3, 0.6, 0.9}) {
    const scenarios::Problem problem = oblique(across);
    const Result result =
        run_fake(problem, overlapping_discs(problem, 1), method(Scheme::SemiImplicitEuler, 1));
    EXPECT_EQ(missed(result), "") << across;
  }
}

TEST(Bounds, DoNotHoldForWrongImpulses) {
  const scenarios::Problem problem = oblique(0.3);
  const Result result =
      run_fake(problem, overlapping_discs(problem, 0.9), method(Scheme::SemiImplicitEuler, 1));
  EXPECT_NE(missed(result).find("energy_drift"), std::string::npos) << missed(result);
  // A head-on hit has no normal to get wrong: the velocity is exact but for rounding.
  const scenarios::Problem straight = oblique(0);
  const Result off =
      run_fake(straight, overlapping_discs(straight, 0.999), method(Scheme::SemiImplicitEuler, 1));
  EXPECT_NE(missed(off).find("velocity_error"), std::string::npos) << missed(off);
}

// A block that slides on level ground at 3 m/s until friction, 0.4 of its weight, has stopped it.
scenarios::Problem sliding() {
  scenarios::Problem problem;
  problem.scene.name = "sliding";
  problem.scene.bodies = {{.name = "ground",
                           .type = BodyType::Static,
                           .position = {0, -1},
                           .shapes = {{.geometry = Box{20, 2}, .friction = 0.4}}},
                          {.name = "block",
                           .position = {0, 0.125},
                           .velocity = {3, 0},
                           .shapes = {{.geometry = Box{0.5, 0.25}, .friction = 0.4}}}};
  problem.truth.exact = [](double t, std::span<BodyState> out) {
    const double rub = 0.4 * 9.81, moving = std::fmin(t, 3 / rub);
    out[0] = {{0, -1}, 0, {}, 0};
    out[1] = {{3 * moving - rub * moving * moving / 2, 0.125}, 0, {3 - rub * moving, 0}, 0};
  };
  problem.truth.contacts_last = true;
  problem.duration = 1.5;
  return problem;
}

// The block in steps of h, whose contact is felt from the `late`-th step on and then put right; it lies
// `sunk` too low.
Motion sliding_block(double friction, int late, double sunk) {
  return [=](long step, double dt, std::span<BodyState> out) {
    BodyState block{{0, 0.125}, 0, {3, 0}, 0};
    for (long i = 0; i < step; ++i) {
      const bool felt = i >= late;
      block.velocity.x = std::fmax(block.velocity.x - (felt ? friction * 9.81 * dt : 0), 0);
      block.velocity.y = felt ? 0 : block.velocity.y - 9.81 * dt;
      block.position += dt * block.velocity;
      if (felt) block.position.y = 0.125 - sunk;
    }
    out[0] = {{0, -1}, 0, {}, 0};
    out[1] = block;
  };
}

TEST(Bounds, HoldForContactsThatAreFeltAStepLate) {
  const reference::Method euler = method(Scheme::SemiImplicitEuler, 1);
  EXPECT_EQ(missed(run_fake(sliding(), sliding_block(0.4, 0, 0), euler)), "");
  EXPECT_EQ(missed(run_fake(sliding(), sliding_block(0.4, 1, 0), euler)), "");
}

TEST(Bounds, DoNotHoldForWrongContacts) {
  const reference::Method euler = method(Scheme::SemiImplicitEuler, 1);
  EXPECT_NE(missed(run_fake(sliding(), sliding_block(0.4, 3, 0), euler)), "");
  EXPECT_NE(missed(run_fake(sliding(), sliding_block(0.36, 0, 0), euler)), "");
  // More than h^2 g too low.
  EXPECT_NE(missed(run_fake(sliding(), sliding_block(0.4, 0, 0.01), euler)), "");
  // Without a lasting contact there is no such room.
  scenarios::Problem free = sliding();
  free.truth.contacts_last = false;
  EXPECT_NE(missed(run_fake(free, sliding_block(0.4, 1, 0), euler)), "");
}

// A ball that falls half a metre and bounces with `restitution`, noticed a step late.
TEST(Bounds, KnowThatGravityGoesOnUntilAnImpactIsNoticed) {
  scenarios::Problem problem;
  problem.scene.name = "bouncing";
  problem.scene.bodies = {
      {.name = "ground",
       .type = BodyType::Static,
       .position = {0, -1},
       .shapes = {{.geometry = Box{20, 2}, .restitution = 1}}},
      {.name = "ball", .position = {0, 0.75}, .shapes = {{.geometry = Circle{0.25}, .restitution = 1}}}};
  const double fall = std::sqrt(1 / 9.81);
  problem.truth.impacts = {fall};
  problem.truth.exact = [=](double t, std::span<BodyState> out) {
    const double since = t < fall ? t : t - 2 * fall;  // the parabola is the same on both sides
    out[0] = {{0, -1}, 0, {}, 0};
    out[1] = {{0, 0.75 - 9.81 * since * since / 2}, 0, {0, -9.81 * since}, 0};
  };
  problem.conserved = {.energy = true};
  problem.duration = 0.6;
  const auto bouncing = [](double restitution) -> Motion {
    return [=](long step, double dt, std::span<BodyState> out) {
      BodyState ball{{0, 0.75}, 0, {}, 0};
      for (long i = 0; i < step; ++i) {
        ball.velocity.y -= 9.81 * dt;
        if (ball.position.y < 0.25 && ball.velocity.y < 0) ball.velocity.y *= -restitution;
        ball.position += dt * ball.velocity;
      }
      out[0] = {{0, -1}, 0, {}, 0};
      out[1] = ball;
    };
  };
  const reference::Method euler = method(Scheme::SemiImplicitEuler, 1);
  EXPECT_EQ(missed(run_fake(problem, bouncing(1), euler)), "");
  EXPECT_NE(missed(run_fake(problem, bouncing(0.6), euler)), "");
}

TEST(Bounds, StatedOnesGoBeforeDerivedOnes) {
  scenarios::Problem problem = thrown();
  problem.precise.position = 1e-6;
  problem.second_order.position = 3;
  const auto off_by = [&](double error, reference::Method how) {
    return run_fake(
        problem,
        [exact = exactly(problem), error](long step, double dt, std::span<BodyState> out) {
          exact(step, dt, out);
          out[0].position.x += error;
        },
        how);
  };
  const auto adaptive = method(Scheme::Adaptive, 0), second = method(Scheme::VelocityVerlet, 2);
  EXPECT_EQ(off_by(0.9e-6, adaptive).find_check("position_error")->tolerance, 1e-6);
  EXPECT_EQ(missed(off_by(0.9e-6, adaptive)), "");
  EXPECT_EQ(missed(off_by(1.1e-6, adaptive)), "position_error ");
  EXPECT_EQ(missed(off_by(2.9 * kDt * kDt, second)), "");
  EXPECT_EQ(missed(off_by(3.1 * kDt * kDt, second)), "position_error ");
}

TEST(Bounds, APromiseHoldsAtItsToleranceAndScalesWithALooserOne) {
  scenarios::Problem problem = thrown();
  problem.precise.position = 1e-6;
  const TruthTable truth(problem, kDt);
  const ConservationScale scale = conservation_scale(problem.scene, truth);
  const auto bound_at = [&](double tolerance) {
    return *Tolerances(problem, truth, method(Scheme::Adaptive, 0),
                       {.dt = kDt, .substeps = {}, .tolerance = tolerance, .options = {}}, scale)
                .position(60, 0);
  };
  EXPECT_DOUBLE_EQ(bound_at(1e-9), 1e-6);
  EXPECT_DOUBLE_EQ(bound_at(1e-7), 1e-4);
  EXPECT_DOUBLE_EQ(bound_at(1e-12), 1e-6);
}

TEST(Bounds, APromiseOfNoErrorAllowsForRounding) {
  scenarios::Problem problem = thrown();
  problem.precise.position = 0;
  const TruthTable truth(problem, kDt);
  const Tolerances tolerances(problem, truth, method(Scheme::Adaptive, 0), {.dt = kDt},
                              conservation_scale(problem.scene, truth));
  EXPECT_GT(*tolerances.position(60, 0), 1e-16);
  EXPECT_LT(*tolerances.position(60, 0), 1e-11);
}

TEST(Bounds, ABodyFixedForceFeedsTheAngleErrorBack) {
  // A thruster: the angle is first order off, so the direction of the force is, so the velocity is.
  scenarios::Problem problem;
  problem.scene.name = "thruster";
  problem.scene.gravity = {0, 0};
  problem.scene.bodies = {{.name = "rocket", .mass = 1, .inertia = 1, .shapes = {{.geometry = Circle{0.5}}}}};
  problem.scene.forces = {
      PointForce{.body = "rocket", .force = {2, 0}, .point = {0, -1}, .frame = Frame::Body}};
  problem.duration = 2;
  // angle = t^2 (alpha = 2); the velocity by fine quadrature of (2 cos t^2, 2 sin t^2).
  problem.truth.exact = [](double t, std::span<BodyState> out) {
    const int n = 2000;
    BodyState s;
    for (int i = 0; i < n; ++i) {
      const double h = t / n, middle = (i + 0.5) * h;
      const Vec2d a{2 * std::cos(middle * middle), 2 * std::sin(middle * middle)};
      s.position += h * s.velocity + h * h / 2 * a;
      s.velocity += h * a;
    }
    s.angle = t * t;
    s.angular_velocity = 2 * t;
    out[0] = s;
  };
  const auto euler = [](double force) {
    return [force](long step, double h, std::span<BodyState> out) {
      BodyState s;
      for (long i = 0; i < step; ++i) {
        s.velocity += h * force * Vec2d{std::cos(s.angle), std::sin(s.angle)};
        s.angular_velocity += h * 2;
        s.position += h * s.velocity;
        s.angle += h * s.angular_velocity;
      }
      out[0] = s;
    };
  };
  // Everything as late as a first-order scheme may have it: the spin, the angle, and the angle that turns the
  // force.
  const Motion late = [](long step, double h, std::span<BodyState> out) {
    BodyState s;
    for (long i = 0; i < step; ++i) {
      s.position += h * s.velocity;
      s.velocity += h * 2 * Vec2d{std::cos(s.angle), std::sin(s.angle)};
      s.angle += h * (s.angular_velocity - (i > 0 ? h : 0));
      s.angular_velocity += h * 2;
    }
    out[0] = s;
  };
  scenarios::Problem start = problem;
  start.duration = 0.6;
  const Result at_worst = run_fake(start, late, method(Scheme::SemiImplicitEuler, 1));
  EXPECT_EQ(missed(at_worst), "");
  EXPECT_GT(at_worst.find_check("velocity_error")->value,
            0.55 * at_worst.find_check("velocity_error")->tolerance);
  EXPECT_EQ(missed(run_fake(problem, euler(2), method(Scheme::SemiImplicitEuler, 1))), "");
  EXPECT_NE(missed(run_fake(problem, euler(2.3), method(Scheme::SemiImplicitEuler, 1))), "");
}

}  // namespace
}  // namespace plumb::harness
