#include "engine/world/contact_solver/contact_graph.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

ContactConstraint<float> between(int a, int b) {
  ContactConstraint<float> c;
  c.body_a = a, c.body_b = b;
  return c;
}

// The colour that is solved last holds best: the ground, and before it a body with more contacts than there
// are colours, which holds what it touches.
TEST(ContactGraph, BodiesWithManyContactsComeBeforeTheGroundAlone) {
  ContactGraph<float> graph;
  constexpr int kGround = 0, kDrum = 1;
  for (int i = 2; i < 100; i += 2) {
    graph.add(between(kGround, i), false, true);
    graph.add(between(kDrum, i), true, true);
    graph.add(between(i, i + 1), true, true);
  }
  int seen = 0, drum = 0, at_end_of_pairs = 0, first_of_ground = 0;
  graph.for_each([&](const ContactConstraint<float>& c) {
    ++seen;
    if (c.body_a == kDrum) ++drum;
    if (c.body_a > kDrum) at_end_of_pairs = seen;
    if (c.body_a == kGround && first_of_ground == 0) first_of_ground = seen;
    if (c.body_a == kDrum && first_of_ground > 0) ADD_FAILURE() << "after the ground";
  });
  EXPECT_EQ(seen, 3 * 49);
  EXPECT_EQ(drum, 49);
  // All but one of each colour of the drum's contacts come after all of the pairs.
  EXPECT_LE(at_end_of_pairs, 49 + ContactGraph<float>::kDynamicColours);
  EXPECT_EQ(first_of_ground, 49 + 49 + 1);
}

}  // namespace
}  // namespace plumb
