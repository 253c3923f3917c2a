// Begin and end pair up in every history: of what shapes do, sensors see and bodies sleep, whatever is
// called.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <random>
#include <set>

#include "engine/scene/error.h"
#include "engine/world/snapshot.h"
#include "engine/world/snapshot_check.h"
#include "engine/world/world_data.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

using Pair = std::pair<std::uint64_t, std::uint64_t>;

template <class Id>
std::uint64_t key(Id id) {
  return std::uint64_t{id.index} << 32 | id.generation;
}
Pair sorted(ShapeId a, ShapeId b) { return std::minmax(key(a), key(b)); }

/// Keeps what has begun and not ended, as events tell it.
struct Ledger {
  std::set<Pair> touching, sensed;
  std::map<std::uint64_t, bool> asleep;

  /// Of one step that was taken, or that a hook ended.
  void note(const Events& events) {
    // Within a step a pair may end and begin, or begin and end: what matters is that both are told.
    std::map<Pair, int> change, sense_change;
    for (const TouchEvent& e : events.begin) ++change[sorted(e.shape_a, e.shape_b)];
    for (const TouchEvent& e : events.end) --change[sorted(e.shape_a, e.shape_b)];
    for (const SensorEvent& e : events.sensor_begin) ++sense_change[{key(e.sensor), key(e.visitor)}];
    for (const SensorEvent& e : events.sensor_end) --sense_change[{key(e.sensor), key(e.visitor)}];
    apply(change, touching, "contact"), apply(sense_change, sensed, "sensor");
  }

  static void apply(const std::map<Pair, int>& changes, std::set<Pair>& now, const char* what) {
    for (const auto& [pair, by] : changes) {
      if (by == 0) continue;
      EXPECT_TRUE(by == 1 || by == -1) << what << " told " << by << " times at once";
      if (by > 0) {
        EXPECT_TRUE(now.insert(pair).second) << what << " begins twice";
      } else {
        EXPECT_EQ(now.erase(pair), 1u) << what << " ends without a begin";
      }
    }
  }
};

template <class Real>
class History {
 public:
  explicit History(unsigned seed) : random_(seed) {
    ground_ = world_.create_body({.type = BodyType::Static},
                                 ShapeDefinition{.geometry = Box{30, 1}, .position = {0, -0.5}});
    world_.create_chain(ground_, {.points = {{9, 4}, {6, 0.5}, {-6, 0.5}, {-9, 4}}, .pre_solve = true});
    for (int i = 0; i < 6; ++i) make();
    world_.on_pre_solve([this](const ContactReading&) {
      if (throws_ && number(0, 20) < 0.2) throw std::runtime_error("hook");
      return !waives_ || number(0, 10) > 1;
    });
  }

  void run(int steps) {
    for (int i = 0; i < steps && !testing::Test::HasFailure(); ++i) {
      for (int k = static_cast<int>(number(0, 4)); k > 0; --k) {
        const std::string did = act();
        trace_ += did + "; ";
      }
      trace_ += "step\n";
      if (trace_.size() > 3000) trace_.erase(0, 1000);
      try {
        world_.step();
      } catch (const std::runtime_error&) {
      }
      ledger_.note(world_.events());
      check_state(world_.data());
      compare();
      ASSERT_FALSE(testing::Test::HasFailure()) << trace_;
    }
    for (const BodyId body : world_.bodies()) world_.destroy(body);
    throws_ = false;
    world_.step();
    ledger_.note(world_.events());
    EXPECT_TRUE(ledger_.touching.empty() && ledger_.sensed.empty()) << "all is gone";
  }

 private:
  double number(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }
  Vec2d place() { return {number(-6, 6), number(0, 4)}; }
  template <class Id>
  Id any(const std::vector<Id>& all) {
    return all[static_cast<std::size_t>(number(0, 0.999) * static_cast<double>(all.size()))];
  }
  BodyId body() { return any(world_.bodies()); }
  ShapeDefinition shape() {
    ShapeDefinition made{.geometry = Circle{number(0.2, 0.8)}};
    if (number(0, 2) < 1) made.geometry = Box{number(0.3, 2), number(0.3, 2)};
    made.sensor = number(0, 5) < 1, made.pre_solve = number(0, 4) < 1, made.hit_events = number(0, 4) < 1;
    made.material.restitution = number(0, 3) < 1 ? 0.8 : 0;
    return made;
  }
  void make() {
    const BodyType types[] = {BodyType::Dynamic, BodyType::Dynamic, BodyType::Dynamic, BodyType::Kinematic,
                              BodyType::Static};
    std::vector<ShapeDefinition> shapes{shape()};
    if (number(0, 3) < 1) shapes.push_back(shape());
    world_.create_body({.type = types[static_cast<int>(number(0, 4.99))],
                        .position = place(),
                        .angle = number(-3, 3),
                        .awake = number(0, 5) < 4},
                       shapes);
  }

  std::string act() {
    if (world_.bodies().size() < 4) return make(), "make";
    const BodyId one = body(), two = body();
    const std::vector<ShapeId> shapes = world_.shapes(one);
    switch (static_cast<int>(number(0, 22))) {
      case 0:
        if (world_.bodies().size() < 25) make();
        return "make";
      case 1:
        if (one != ground_ || number(0, 5) < 1) world_.destroy(one);
        return "destroy body";
      case 2:
        if (shapes.size() > 1 && one != ground_) world_.destroy(any(shapes));
        return "destroy shape";
      case 3:
        if (shapes.size() < 4) world_.create_shape(one, shape());
        return "create shape";
      case 4:
        if (!shapes.empty()) world_.set_filter(any(shapes), {.mask = number(0, 2) < 1 ? 0u : 0xFFFFFFFFu});
        return "set_filter";
      case 5:
        if (!shapes.empty()) world_.set_filter(any(shapes), {.category = number(0, 2) < 1 ? 2u : 1u});
        return "set_filter";
      case 6:
        if (!shapes.empty()) world_.set_material(any(shapes), {.friction = number(0, 1)});
        return "set_material";
      case 7:
        if (one != ground_) world_.set_position(one, place(), number(-3, 3));
        return "set_position";
      case 8:
        if (one != ground_) world_.set_type(one, static_cast<BodyType>(static_cast<int>(number(0, 2.99))));
        return "set_type";
      case 9:
        return world_.set_awake(one, number(0, 2) < 1), "set_awake";
      case 10:
        return world_.set_velocity(one, {number(-5, 5), number(-5, 5)}), "set_velocity";
      case 11:
        try {
          world_.create_joint(one, two,
                              {.kind = DistanceDefinition{.length = 1}, .collide = number(0, 2) < 1});
        } catch (const Error&) {
        }
        return "create_joint";
      case 12:
        if (const auto joints = world_.joints(one); !joints.empty()) world_.destroy(any(joints));
        return "destroy joint";
      case 13:
        try {
          for (int i = 0; i < 9; ++i) world_.apply_impulse(one, {1e12, 0});
        } catch (const Error&) {  // it is beyond 1e12 m already
        }
        return "quarantine";
      case 14:
        return world_.release(one), "release";
      case 15: {
        const std::vector<std::byte> state = save(world_);
        restore(world_, state);
        return "save and restore";
      }
      case 16: {
        // Events of steps that are rolled back happen to nobody.
        const std::vector<std::byte> state = save(world_);
        throws_ = false;
        for (int i = 0; i < 5; ++i) world_.step();
        restore(world_, state);
        return "back";
      }
      case 17:
        return waives_ = !waives_, "hook waives";
      case 18:
        return throws_ = !throws_, "hook throws";
      case 19:
        for (int i = 0; i < 400; ++i) world_.set_awake(one, i % 2 == 0);
        return "up and down";
      case 20:
        return world_.set_sleeping(number(0, 2) < 1), "set_sleeping";
      default:
        return world_.set_mass(one, {.mass = number(0.5, 3), .centre = {number(-1, 1), 0}}), "set_mass";
    }
  }

  /// Overlaps that have begun are those that are there.
  void compare() {
    std::set<Pair> sensed;
    for (const BodyId each : world_.bodies()) {
      for (const ShapeId shape : world_.shapes(each)) {
        if (!world_.sensor(shape)) continue;
        for (const ShapeId visitor : world_.overlapping(shape)) sensed.insert({key(shape), key(visitor)});
      }
    }
    EXPECT_EQ(ledger_.sensed, sensed);
    std::set<Pair> touching;
    const WorldData<Real>& w = std::as_const(world_).data();
    for (int i = 0; i < w.contacts.size(); ++i) {
      const ContactRecord& c = w.contacts[i];
      if (!w.contacts.used(i) || !c.touching) continue;
      const auto id = [&](int shape) {
        return ShapeId{static_cast<std::uint32_t>(shape), w.shapes.generation(shape)};
      };
      touching.insert(sorted(id(c.shape_a), id(c.shape_b)));
    }
    EXPECT_EQ(ledger_.touching, touching);
  }

  std::mt19937 random_;
  BasicWorld<Real> world_;
  BodyId ground_;
  Ledger ledger_;
  bool waives_ = false, throws_ = false;
  std::string trace_;
};

int cases() {
  const char* asked = std::getenv("PLUMB_PROPERTY_CASES");
  return asked != nullptr ? 20 * std::atoi(asked) : 20;
}

template <class Real>
class Histories : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(Histories, Reals);

TYPED_TEST(Histories, BeginAndEndPairUp) {
  for (int seed = 0; seed < cases() && !this->HasFailure(); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    History<TypeParam>(static_cast<unsigned>(seed)).run(150);
  }
}

TYPED_TEST(Histories, ASensorThatIsDestroyedEndsItsOverlaps) {
  for (const bool whole_body : {true, false}) {
    BasicWorld<TypeParam> world(weightless());
    const BodyId zone =
        world.create_body({.type = BodyType::Static}, ShapeDefinition{.geometry = Box{2, 2}, .sensor = true});
    add_body(world, {0, 0}, {.geometry = Circle{0.5}});
    world.step();
    EXPECT_EQ(world.events().sensor_begin.size(), 1u);
    whole_body ? world.destroy(zone) : world.destroy(world.shapes(zone)[0]);
    world.step();
    EXPECT_EQ(world.events().sensor_end.size(), 1u);
  }
}

TYPED_TEST(Histories, ABodyInThePlaceOfOneThatHadMovedTouchesOnce) {
  BasicWorld<TypeParam> world;
  add_ground(world);
  const BodyId first = add_box(world, {0, 0.5});
  run(world, 5);
  world.set_position(first, {1, 0.5}, 0);
  world.destroy(first);
  const BodyId second = add_box(world, {0, 0.5});
  int begun = 0;
  for (int i = 0; i < 5; ++i) {
    world.step();
    begun += static_cast<int>(world.events().begin.size());
  }
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(world.contacts(second).size(), 1u);
}

TYPED_TEST(Histories, AMaterialThatChangesIsNoEndAndBegin) {
  BasicWorld<TypeParam> world;
  const BodyId ground = add_ground(world, {.friction = 0});
  const BodyId box =
      add_body(world, {0, 0.5}, {.geometry = Box{1, 1}, .material = {.friction = 0.5}}, {2, 0});
  run(world, 30);
  ASSERT_NEAR(world.velocity(box).x, 2, 1e-3);
  world.set_material(world.shapes(ground)[0], {.friction = 0.5});
  int told = 0;
  for (int i = 0; i < 20; ++i) {
    world.step();
    told += static_cast<int>(world.events().begin.size() + world.events().end.size());
  }
  EXPECT_EQ(told, 0);
  // sqrt(0.5 0.5) of the weight brakes it from then on.
  EXPECT_NEAR(world.velocity(box).x, 2 - 0.5 * kGravity * 20 / 60, 0.02);
}

TYPED_TEST(Histories, EventsBetweenStepsDoNotGrowWithoutBound) {
  BasicWorld<TypeParam> world;
  const BodyId ground = add_ground(world), box = add_box(world, {0, 0.5});
  run(world, 10);
  for (int i = 0; i < 20000; ++i) {
    world.set_awake(box, i % 2 == 1);
    const BodyId other = world.create_body({.position = {5, 5}}, ShapeDefinition{});
    world.set_awake(other, false);
    world.destroy(other);
    world.destroy(world.create_shape(ground, {.geometry = Circle{0.1}, .position = {30, 30}}));
    if (i % 20 == 0)
      world.apply_impulse(box, {1e12, 0}), world.apply_impulse(box, {1e12, 0}), world.release(box);
  }
  const WorldData<TypeParam>& w = std::as_const(world).data();
  EXPECT_LT(w.move_buffer.size(), 200u);
  EXPECT_LT(w.mass_changed_bodies.size(), 10u);
  world.step();
  EXPECT_LT(world.events().woke.size() + world.events().fell_asleep.size(), 500u);
  EXPECT_LE(world.events().quarantined.size(), 1u);
}

}  // namespace
}  // namespace plumb
