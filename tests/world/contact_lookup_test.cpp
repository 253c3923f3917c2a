// Finds the contact of two shapes: with what begin events do not have, its points and impulses.
#include <gmock/gmock.h>

#include <map>

#include "engine/scene/error.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

template <class Real>
class ContactLookup : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ContactLookup, Reals);

void expect_equal(const ContactReading& a, const ContactReading& b) {
  EXPECT_EQ(a.shape_a, b.shape_a);
  EXPECT_EQ(a.shape_b, b.shape_b);
  EXPECT_EQ(a.normal, b.normal);
  ASSERT_EQ(a.count, b.count);
  for (int i = 0; i < a.count; ++i) {
    EXPECT_EQ(a.points[i], b.points[i]);
    EXPECT_EQ(a.separations[i], b.separations[i]);
    EXPECT_EQ(a.impulses[i], b.impulses[i]);
  }
  EXPECT_EQ(a.step_impulse, b.step_impulse);
}

TYPED_TEST(ContactLookup, FindsEachContactOfAHeapInEitherOrder) {
  BasicWorld<TypeParam> w;
  const BodyId ground = add_ground(w);
  for (int i = 0; i < 12; ++i) add_box(w, {0.9 * (i % 4), 0.5 + 1.01 * (i / 4)});
  const BodyId away = add_box(w, {30, 9});
  for (const int steps : {30, 300}) {
    run(w, steps);
    std::size_t found = 0;
    for (const BodyId body : w.bodies()) {
      for (const ContactReading& contact : w.contacts(body)) {
        const auto same = w.contact(contact.shape_a, contact.shape_b);
        ASSERT_TRUE(same.has_value());
        expect_equal(*same, contact);
        expect_equal(*w.contact(contact.shape_b, contact.shape_a), contact);
        ++found;
      }
    }
    EXPECT_GT(found, 30u);
  }
  const ShapeId floor = w.shapes(ground)[0], lonely = w.shapes(away)[0];
  EXPECT_TRUE(w.contact(floor, lonely).has_value()) << "it has fallen";
  EXPECT_FALSE(w.contact(w.shapes(w.bodies()[1])[0], lonely).has_value());
  EXPECT_FALSE(w.contact(floor, floor).has_value());
  w.destroy(away);
  EXPECT_THROW(w.contact(floor, lonely), Error);
}

// A 2 kg ball stopped from 2 m/s takes 4 N s, and gravity's share of the step.
TYPED_TEST(ContactLookup, TellsTheImpulseOfAContactThatBegan) {
  BasicWorld<TypeParam> w;
  add_ground(w);
  const BodyId ball = add_body(w, {0, 0.6}, {.geometry = Circle{0.5}, .hit_events = true}, {0, -2});
  w.set_mass(ball, {.mass = 2, .inertia = 0.25});
  double sum = 0;
  int begun = 0;
  Vec2d velocity{0, -2};
  for (int i = 0; i < 20; ++i) {
    const Vec2d before = w.velocity(ball);
    w.step();
    for (const TouchEvent& event : w.events().begin) {
      const auto contact = w.contact(event.shape_a, event.shape_b);
      ASSERT_TRUE(contact.has_value());
      ++begun;
      velocity = w.velocity(ball) - before;
      sum = contact->step_impulse;
      EXPECT_NEAR(std::abs(contact->normal.y), 1, 1e-6);
      EXPECT_NEAR(contact->points[0].y, 0, 0.02);
      EXPECT_NEAR(contact->points[0].x, 0, 1e-6);
    }
  }
  EXPECT_EQ(begun, 1);
  EXPECT_NEAR(sum, 2 * (velocity.y + kGravity / 60), 1e-4);
  EXPECT_GT(sum, 3.9);
}

TYPED_TEST(ContactLookup, FindsNothingForABounceThatIsOver) {
  BasicWorld<TypeParam> w(weightless());
  add_ground(w);
  const BodyId ball = add_body(
      w, {0, 3}, {.geometry = Circle{0.1}, .material = {.restitution = 1}, .hit_events = true}, {0, -300});
  std::size_t begun = 0, hits = 0;
  for (int i = 0; i < 5; ++i) {
    w.step();
    hits += w.events().hits.size();
    for (const TouchEvent& event : w.events().begin) {
      ++begun;
      if (w.position(ball).y > 1) {
        EXPECT_FALSE(w.contact(event.shape_a, event.shape_b).has_value());
      }
    }
  }
  EXPECT_EQ(begun, 1u);
  EXPECT_EQ(hits, 1u) << "which has the point and the impulse";
}

}  // namespace
}  // namespace plumb
