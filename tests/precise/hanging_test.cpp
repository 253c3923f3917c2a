#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "engine/math/trigonometry.h"
#include "tests/precise/support.h"
#include "tests/precise/truth.h"

// Mechanisms that hang by hinges, which Precise follows by their angles alone. Truth: Lagrange's equations in
// the links' angles with a full mass matrix, in long double.
namespace plumb {
namespace {

using truth::Real;

struct Link {
  int parent = -1;  // a link before it; -1: what stands
  double mass = 1, inertia = 0.1;
  Vec2d on{};      // its hinge, in the parent's frame (from its centre of mass), or where that stands
  Vec2d centre{};  // from its hinge to its centre of mass, in its own frame
  double angle = 0, spin = 0;
};

/// Centre of mass of link k: the sum over its line of ancestors of a way in each one's frame.
struct Way {
  int link = 0;
  Vec2d way{};
};
std::vector<Way> ways_to(const std::vector<Link>& links, int k) {
  std::vector<Way> ways{{k, links[k].centre}};
  for (int child = k; links[child].parent >= 0; child = links[child].parent) {
    const int parent = links[child].parent;
    ways.push_back({parent, links[parent].centre + links[child].on});
  }
  return ways;
}

/// sum_j M_ij q_j'' = f_i with x_k = sum of R(q_i) w_ki:
///   M_ij = sum_k m_k (R w_ki) . (R w_kj) + I_i delta_ij,
///   f_i = sum_k m_k perp(R w_ki) . (g + sum_j q_j'^2 R w_kj).
truth::Rate lagrange(const std::vector<Link>& links, Vec2d gravity) {
  const int n = static_cast<int>(links.size());
  return [=](Real, const std::vector<Real>& y, std::vector<Real>& out) {
    std::vector<std::vector<Real>> m(n, std::vector<Real>(n + 1));
    for (int i = 0; i < n; ++i) m[i][i] = links[i].inertia;
    for (int k = 0; k < n; ++k) {
      const std::vector<Way> ways = ways_to(links, k);
      std::vector<Real> x, z;
      Real pull_x = gravity.x, pull_y = gravity.y;
      for (const Way& w : ways) {
        const Real c = std::cos(y[w.link]), s = std::sin(y[w.link]), rate = y[n + w.link];
        x.push_back(c * w.way.x - s * w.way.y), z.push_back(s * w.way.x + c * w.way.y);
        pull_x += rate * rate * x.back(), pull_y += rate * rate * z.back();
      }
      for (std::size_t a = 0; a < ways.size(); ++a) {
        m[ways[a].link][n] += links[k].mass * (-z[a] * pull_x + x[a] * pull_y);
        for (std::size_t b = 0; b < ways.size(); ++b)
          m[ways[a].link][ways[b].link] += links[k].mass * (x[a] * x[b] + z[a] * z[b]);
      }
    }
    for (int j = 0; j < n; ++j) {  // the matrix is positive definite: no pivoting
      for (int i = 0; i < n; ++i) {
        if (i == j) continue;
        const Real factor = m[i][j] / m[j][j];
        for (int k = j; k <= n; ++k) m[i][k] -= factor * m[j][k];
      }
    }
    for (int i = 0; i < n; ++i) out[i] = y[n + i], out[n + i] = m[i][n] / m[i][i];
  };
}

/// The scene: on the world, or on a static body that is turned. `turned_round`: every second hinge names the
/// child first.
Scene scene_of(const std::vector<Link>& links, bool on_a_wall, bool turned_round) {
  Scene scene{.name = "tree"};
  const Vec2d corner{0.7, -0.2};
  const double tilt = 0.4;
  if (on_a_wall)
    scene.bodies.push_back({.name = "wall", .type = BodyType::Static, .position = corner, .angle = tilt});
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& link = links[i];
    Body body{.name = "link" + std::to_string(i), .mass = link.mass, .inertia = link.inertia};
    body.angle = link.angle, body.angular_velocity = link.spin;
    RevoluteJoint hinge{
        .name = "hinge" + std::to_string(i), .body_a = std::string(kWorld), .body_b = body.name};
    hinge.anchor_a = link.on, hinge.anchor_b = -link.centre;
    Vec2d at = link.on, speed{};
    if (link.parent >= 0) {
      hinge.body_a = "link" + std::to_string(link.parent);
      const Body& parent = scene.bodies[static_cast<std::size_t>(link.parent) + (on_a_wall ? 1 : 0)];
      const Vec2d arm = rotation_of(parent.angle) * link.on;
      at = parent.position + arm;
      speed = parent.velocity + cross(parent.angular_velocity, arm);
    } else if (on_a_wall) {
      hinge.body_a = "wall";
      hinge.anchor_a = rotation_of(-tilt) * (link.on - corner);
    }
    const Vec2d way = rotation_of(link.angle) * link.centre;
    body.position = at + way;
    body.velocity = speed + cross(link.spin, way);
    if (turned_round && i % 2 == 1)
      std::swap(hinge.body_a, hinge.body_b), std::swap(hinge.anchor_a, hinge.anchor_b);
    scene.bodies.push_back(body);
    scene.joints.push_back(hinge);
  }
  return scene;
}

/// A beam with two strings of links on it, one of which forks, and a pendulum beside it.
const std::vector<Link> kTree = {
    {-1, 2, 0.5, {0, 1}, {0.1, -0.4}, 0.3, 0.2},     {0, 1, 0.2, {-0.6, -0.1}, {0, -0.5}, -0.2, 0},
    {0, 0.5, 0.1, {0.7, 0}, {0.3, -0.3}, 0.5, -1},   {2, 3, 0.4, {0.2, -0.2}, {0, -0.3}, 1.1, 0.5},
    {2, 0.2, 0.05, {0.1, -0.4}, {0.2, 0}, -0.7, 2},  {-1, 1, 0.3, {3, 0}, {0.5, 0.1}, 0, 0},
    {3, 0.7, 0.02, {0, -0.4}, {-0.1, -0.2}, 0.2, 1},
};

TEST(PreciseHanging, TreesFollowLagrangesEquations) {
  const double seconds = 1.5;
  const Vec2d gravity{1, -9.81};
  const std::size_t n = kTree.size();
  std::vector<Real> start(2 * n);
  for (std::size_t i = 0; i < n; ++i) start[i] = kTree[i].angle, start[n + i] = kTree[i].spin;
  const std::vector<Real> end = truth::integrate_twice(lagrange(kTree, gravity), start, 0, seconds, 3000);
  for (const bool on_a_wall : {false, true}) {
    for (const bool turned_round : {false, true}) {
      Scene scene = scene_of(kTree, on_a_wall, turned_round);
      scene.gravity = gravity;
      const auto states = run(scene, 90, {.tolerance = 1e-10});
      for (std::size_t i = 0; i < n; ++i) {
        const BodyState& found = states[i + (on_a_wall ? 1 : 0)];
        EXPECT_NEAR(found.angle, static_cast<double>(end[i]), 3e-12) << i;
        EXPECT_NEAR(found.angular_velocity, static_cast<double>(end[n + i]), 3e-11) << i;
        Real x = 0, y = 0;
        int root = static_cast<int>(i);
        while (kTree[root].parent >= 0) root = kTree[root].parent;
        x = kTree[root].on.x, y = kTree[root].on.y;
        for (const Way& w : ways_to(kTree, static_cast<int>(i))) {
          x += std::cos(end[w.link]) * w.way.x - std::sin(end[w.link]) * w.way.y;
          y += std::sin(end[w.link]) * w.way.x + std::cos(end[w.link]) * w.way.y;
        }
        EXPECT_NEAR(found.position.x, static_cast<double>(x), 3e-12) << i;
        EXPECT_NEAR(found.position.y, static_cast<double>(y), 3e-12) << i;
      }
    }
  }
}

// Links between masses a million times apart: what moves a light one across the line is a small difference of
// what pulls along it.
TEST(PreciseHanging, HeavyTipsFollowLagrangesEquations) {
  std::vector<Link> links;
  for (int i = 0; i < 4; ++i)
    links.push_back({i - 1, i == 3 ? 1e6 : 1, i == 3 ? 1e4 : 1.0 / 12, i == 0 ? Vec2d{} : Vec2d{0.5, 0},
                     i == 3 ? Vec2d{} : Vec2d{0.5, 0}, 0.3, 0});
  const std::size_t n = links.size();
  std::vector<Real> start(2 * n);
  for (std::size_t i = 0; i < n; ++i) start[i] = links[i].angle;
  const Scene scene = scene_of(links, false, false);
  const double seconds = 0.2;
  const std::vector<Real> end =
      truth::integrate_twice(lagrange(links, scene.gravity), start, 0, seconds, 20000);
  const auto states = run(scene, 12, {.tolerance = 1e-9});
  for (std::size_t i = 0; i < n; ++i) EXPECT_NEAR(states[i].angle, static_cast<double>(end[i]), 3e-11) << i;
}

// A rod that flies sideways is caught by its hinge: what it had about that is what it turns with, and for two
// rods the impulses at both hinges are found from their sums of momentum.
TEST(PreciseHanging, HingesCatchWhatTheyDoNotAllow) {
  const std::vector<Link> links = {{-1, 2, 0.3, {0, 0}, {0, -0.5}, 0, 0.7}};
  Scene scene = scene_of(links, false, false);
  scene.gravity = {};
  scene.bodies[0].velocity = {3, 1};
  const auto states = run(scene, 1);
  // (I + m c^2) w = I w0 + c x m v, c = (0, -0.5).
  const double w = (0.3 * 0.7 + 2 * 0.5 * 3) / (0.3 + 2 * 0.25);
  EXPECT_NEAR(states[0].angular_velocity, w, 1e-14);

  // A second one, at rest but for its own turning: energy is lost, never gained.
  const std::vector<Link> two = {{-1, 2, 0.3, {0, 0}, {0, -0.5}, 0, 0},
                                 {0, 1, 0.1, {0, -0.5}, {0, -0.5}, 0, 0}};
  Scene pair = scene_of(two, false, false);
  pair.gravity = {};
  pair.bodies[0].velocity = pair.bodies[1].velocity = {};
  pair.bodies[0].angular_velocity = 0, pair.bodies[1].angular_velocity = 4;
  const auto caught = run(pair, 1);
  // With A1 = I1 + m1 c^2 + m2 L^2 = 0.3 + 0.5 + 1, A2 = I2 + m2 c^2 = 0.35, B = m2 L c = 0.5: momenta about
  // the hinges are A1 w1 + B w2 = 0 of the upper, B w1 + A2 w2 = I2 4 of the lower.
  const double a1 = 1.8, a2 = 0.35, b = 0.5, p = 0.4;
  double energy = 0, momentum = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const BodyState& rod = caught[i];
    energy += 0.5 * (two[i].mass * length_squared(rod.velocity) +
                     two[i].inertia * rod.angular_velocity * rod.angular_velocity);
    momentum += two[i].mass * cross(rod.position, rod.velocity) + two[i].inertia * rod.angular_velocity;
  }
  EXPECT_NEAR(energy, 0.5 * p * p * a1 / (a1 * a2 - b * b), 5e-14);
  EXPECT_NEAR(momentum, p, 1e-14);
}

// A link that may not turn swings none: what hangs on it has the world for its root.
TEST(PreciseHanging, LinksThatMayNotTurnStay) {
  const std::vector<Link> links = {{-1, 1, 0.1, {0, 0}, {0.5, 0}, 0, 0},
                                   {0, 1, 0.1, {0.5, 0}, {0, -1}, 1, 0}};
  Scene scene = scene_of(links, false, false);
  scene.bodies[0].fixed_rotation = true;
  const std::vector<Link> alone = {{-1, 1, 0.1, {1, 0}, {0, -1}, 1, 0}};
  const std::vector<Real> end =
      truth::integrate_twice(lagrange(alone, scene.gravity), std::vector<Real>{1, 0}, 0, 2, 2000);
  const auto states = run(scene, 120);
  EXPECT_EQ(states[0].angle, 0);
  EXPECT_EQ(states[0].position, (Vec2d{0.5, 0}));
  EXPECT_NEAR(states[1].angle, static_cast<double>(end[0]), 1e-12);
}

// Bodies on which a force acts, and those that hang on a moving body, are followed in all coordinates: with a
// force of no effect and a body that does not move these are the same motions.
TEST(PreciseHanging, AgreesWithAllCoordinates) {
  Scene in_angles = scene_of(kTree, true, false);
  Scene pushed = in_angles;
  pushed.forces = {LinearDrag{"link3", 1e-300}};
  Scene carried = in_angles;
  carried.bodies[0].type = BodyType::Kinematic;
  const auto expected = run(in_angles, 60, {.tolerance = 1e-11});
  for (const Scene& scene : {pushed, carried}) {
    const auto states = run(scene, 60, {.tolerance = 1e-11});
    for (std::size_t i = 0; i < states.size(); ++i) {
      EXPECT_NEAR(states[i].angle, expected[i].angle, 1e-12) << i;
      EXPECT_NEAR(states[i].velocity.x, expected[i].velocity.x, 1e-11) << i;
    }
  }
}

TEST(PreciseHanging, RestoredWithinAStepGoesOnWithTheSameBits) {
  const Scene scene = scene_of(kTree, false, false);
  const Precise precise{.tolerance = 1, .max_dt = 1.0 / 240};  // several reads a step
  const auto driver = make_precise_driver(scene, precise, {});
  for (int part = 0; part < 20; ++part) {
    advance(*driver, kTree.size(), 3);
    const auto other = make_precise_driver(scene, precise, {});
    other->restore(driver->save());
    EXPECT_EQ(advance(*other, kTree.size(), 30), advance(*driver, kTree.size(), 30)) << part;
  }
}

// A long chain that hangs nearly at rest is stiff at a tolerance this wide; when its end is struck it is not
// any more. The same motion as by the explicit method alone at a tight tolerance.
TEST(PreciseHanging, ImplicitStepsInBetween) {
  std::vector<Link> links;
  for (int i = 0; i < 60; ++i)
    links.push_back(
        {i - 1, 1, 1.0 / 12, i == 0 ? Vec2d{} : Vec2d{0, -0.5}, {0, -0.5}, i == 59 ? 0.01 : 0, 0});
  const Scene scene = scene_of(links, false, false);
  const auto hanging = make_precise_driver(scene, {.tolerance = 0.1}, {});
  const auto reference =
      make_precise_driver(scene, {.tolerance = 1e-9, .method = MotionMethod::Explicit}, {});
  const auto agree = [&](int steps) {
    const auto found = advance(*hanging, links.size(), steps),
               expected = advance(*reference, links.size(), steps);
    for (std::size_t i = 0; i < links.size(); ++i) EXPECT_NEAR(found[i].angle, expected[i].angle, 3e-5) << i;
    return found;
  };
  BodyState end = agree(300).back();
  const Statistics at_rest = hanging->statistics();
  EXPECT_GT(at_rest.implicit, 0);
  EXPECT_LT(at_rest.implicit, at_rest.steps);
  end.angular_velocity = 40;
  hanging->write(links.size() - 1, end);
  reference->write(links.size() - 1, end);
  agree(20);
  const Statistics struck = hanging->statistics();
  EXPECT_LT(struck.rejected - at_rest.rejected, 6);  // 12 with rates of the method before
  EXPECT_GT(struck.steps - at_rest.steps, struck.implicit - at_rest.implicit);
}

}  // namespace
}  // namespace plumb
