// Impacts that are handed on within a substep: how many rounds they take.
#include "engine/world/contact_solver/impact_propagation.h"

#include <gtest/gtest.h>

#include <vector>

namespace plumb {
namespace {

/// Discs of 1 kg on a line, each `gap` m from the next and from the walls at both ends; the first one comes
/// with 1 m/s. Everything bounces with e = 1.
struct Line {
  Line(int discs, double gap) : bodies(discs + 2), rotations(discs + 2), contacts(discs + 1) {
    for (int i = 1; i <= discs; ++i) bodies[i].inverse_mass = 1;
    bodies[1].velocity = {1, 0};
    for (int i = 0; i <= discs; ++i) {
      ContactConstraint<double>& c = contacts[i];
      c.body_a = i, c.body_b = i + 1;
      c.normal = {1, 0};
      c.count = 1, c.restitution = 1;
      c.separation[0] = c.current_separation[0] = gap;
      c.mass[0] = 1 / (bodies[i].inverse_mass + bodies[i + 1].inverse_mass);
      bounces.push_back({.contact = &c, .has_impact = {i == 1}});
      bounces.back().end_speed[0] = 1;
    }
  }

  int resolve() {
    const ContactStep<double> step{.h = 0.01, .inverse_h = 100};
    if (!find_impacts(bodies.data(), bounces, scratch)) return 0;
    link_contacts(bodies.data(), bounces, scratch);
    return propagate_impacts(bodies.data(), rotations.data(), bounces, step, scratch);
  }

  std::vector<SolverBody<double>> bodies;
  std::vector<Rotation<double>> rotations;
  std::vector<ContactConstraint<double>> contacts;
  std::vector<RestitutionContact<double>> bounces;
  ImpactScratch<double> scratch;
};

TEST(BounceCrowds, HandAnImpactThroughALineInARoundForEachContact) {
  Line line(200, 0);
  line.contacts[200].separation[0] = 1;  // the wall behind the last one is far away
  EXPECT_EQ(line.resolve(), 199);
  EXPECT_EQ(line.bodies[1].velocity.x, 0);
  EXPECT_EQ(line.bodies[200].velocity.x, 1);
}

TEST(BounceCrowds, GoOnAsLongAsTimePasses) {
  // Two discs between walls, 10 um apart: after 10, 20, 30 and 50 us, and so on every 60 us until 10 ms.
  EXPECT_NEAR(Line(2, 1e-5).resolve(), 4 * 10e-3 / 60e-6, 1);
}

TEST(BounceCrowds, LeaveAnImpactElsewhereAsItIsAlone) {
  // All discs of a line are struck at once, which iterations do not solve to rounding. Two others meet far
  // away at the same time: they exchange their velocities exactly.
  Line line(60, 0);
  for (int i = 1; i <= 60; ++i) line.bodies[i].velocity = {i % 3 == 0 ? -1.0 : 1.0 / i, 0};
  const int a = static_cast<int>(line.bodies.size());
  line.bodies.resize(a + 2), line.rotations.resize(a + 2);
  for (const int body : {a, a + 1}) line.bodies[body].inverse_mass = 1;
  line.bodies[a].velocity = {1, 0};
  ContactConstraint<double> pair = line.contacts[1];
  pair.body_a = a, pair.body_b = a + 1;
  line.bounces.push_back({.contact = &pair, .has_impact = {true}});
  line.bounces.back().end_speed[0] = 1;
  line.resolve();
  EXPECT_EQ(line.bodies[a].velocity.x, 0);
  EXPECT_EQ(line.bodies[a + 1].velocity.x, 1);
}

TEST(BounceCrowds, SpendTheirWorkOnImpactsAndNotOnTheCrowdAroundThem) {
  // More contacts than a crowd with e = 1 may look at. Each round looks at three of them and solves a point.
  Line line(80000, 0);
  EXPECT_GE(line.resolve(), 5000);
  EXPECT_EQ(line.bodies[5000].velocity.x, 0);
}

TEST(BounceCrowds, LeaveToTheConstraintsWhatAFirstRoundWouldNotSolve) {
  // Of 60000 discs each other one comes towards the next: 30000 impacts, and a look and two sweeps for each.
  Line line(60000, 0);
  for (int i = 1; i <= 60000; ++i) {
    line.bodies[i].velocity = {i % 2 == 1 ? 1.0 : -1.0, 0};
    line.bounces[i].has_impact[0] = i % 2 == 1;
  }
  EXPECT_EQ(line.resolve(), 0);
  for (int i = 1; i <= 60000; ++i) ASSERT_EQ(line.bodies[i].velocity.x, i % 2 == 1 ? 1 : -1);
}

TEST(BounceCrowds, EndWhereABodyIsTurnedBackAtOnceForEver) {
  // As in the one above, but the walls hold what they push tight.
  Line line(2, -1e-3);
  EXPECT_LE(line.resolve(), 100);
  EXPECT_EQ(line.bodies[1].velocity.x + line.bodies[2].velocity.x, 1);
}

}  // namespace
}  // namespace plumb
