// Every number of everything that a world is made from, with every bad value.
#include <gtest/gtest.h>

#include <functional>

#include "engine/joints/joint_check.h"
#include "engine/world/recording/definition_members.h"
#include "tests/bad_input/refusal.h"

namespace plumb::bad_input {
namespace {

// As the headers of the definitions say, with the limits of engine/world/state/validate.h and
// engine/joints/joint_check.h.
constexpr Rule kAny{-1e12, 1e12}, kNotNegative{0, 1e12}, kPositive{1e-12, 1e12}, kShare{0, 1};
constexpr Rule kMass{1e-18, 1e18}, kInertia{1e-30, 1e30};
constexpr Rule kJointAny{-1e15, 1e15}, kJointNotNegative{0, 1e15}, kJointPositive{1e-15, 1e15};
constexpr Rule kBound{-1e15, 1e15, 0, true}, kAngleNotZero{-1e15, 1e15, 1e-6};

std::map<std::string, Rule> world_rules() {
  return {{"WorldDefinition.gravity", kAny},
          {"WorldDefinition.combine_friction", {0, 4}},
          {"WorldDefinition.combine_restitution", {0, 4}},
          {"WorldDefinition.solver", {0, 4}},
          {"WorldDefinition.integrator", {0, 2}},
          {"WorldDefinition.iterations", {1, 1000}},
          {"Thresholds.hit", kAny},
          {"Thresholds.bounce", kAny},
          {"Thresholds.sleep", kAny}};
}

std::map<std::string, Rule> body_rules() {
  return {{"BodyDefinition.type", {0, 2}},
          {"BodyDefinition.position", kAny},
          {"BodyDefinition.angle", kAny},
          {"BodyDefinition.velocity", kAny},
          {"BodyDefinition.angular_velocity", kAny},
          {"BodyDefinition.gravity_scale", kAny},
          {"BodyDefinition.linear_damping", kNotNegative},
          {"BodyDefinition.angular_damping", kNotNegative},
          {"MassProperties.mass", kMass},
          {"MassProperties.centre", kAny},
          {"MassProperties.inertia", kInertia}};
}

std::map<std::string, Rule> shape_rules() {
  return {{"Circle.radius", kPositive},
          {"Box.width", kPositive},
          {"Box.height", kPositive},
          {"Capsule.start", kAny},
          {"Capsule.end", kAny},
          {"Capsule.radius", kPositive},
          {"Polygon.points", kAny},
          {"Polygon.radius", kNotNegative},
          {"Segment.start", kAny},
          {"Segment.end", kAny},
          {"ShapeDefinition.position", kAny},
          {"ShapeDefinition.angle", kAny},
          {"ShapeDefinition.density", {0, 1e12, 1e-12, false, true}},
          {"Material.friction", kNotNegative},
          {"Material.restitution", kShare},
          {"Material.rolling_resistance", kNotNegative},
          {"Material.surface_speed", kAny},
          {"Filter.group", {-2147483648.0, 2147483647.0}}};
}

std::map<std::string, Rule> chain_rules() {
  return {{"ChainDefinition.points", kAny}, {"Material.friction", kNotNegative},
          {"Material.restitution", kShare}, {"Material.rolling_resistance", kNotNegative},
          {"Material.surface_speed", kAny}, {"Filter.group", {-2147483648.0, 2147483647.0}}};
}

std::map<std::string, Rule> joint_rules() {
  std::map<std::string, Rule> rules{{"Spring.hertz", kJointPositive},
                                    {"Spring.damping_ratio", kJointNotNegative},
                                    {"Range.lower", kBound},
                                    {"Range.upper", kBound},
                                    {"Motor.speed", kJointAny},
                                    {"Motor.max_force", kJointNotNegative},
                                    {"DistanceDefinition.length", kJointPositive},
                                    {"RevoluteDefinition.target_angle", kJointAny},
                                    {"PrismaticDefinition.target_translation", kJointAny},
                                    {"MotorDefinition.target_position", kJointAny},
                                    {"MotorDefinition.target_angle", kJointAny},
                                    {"MouseDefinition.target", kJointAny},
                                    {"GearDefinition.ratio", {-1e15, 1e15, 1e-9}},
                                    {"GearDefinition.phase", kJointAny},
                                    {"PulleyDefinition.ground_a", kJointAny},
                                    {"PulleyDefinition.ground_b", kJointAny},
                                    {"PulleyDefinition.ratio", kJointPositive},
                                    {"PulleyDefinition.length", kJointPositive},
                                    {"RatchetDefinition.tooth", kAngleNotZero},
                                    {"RatchetDefinition.phase", kJointAny},
                                    {"JointDefinition.break_force", kNotNegative},
                                    {"JointDefinition.break_torque", kNotNegative},
                                    {"JointDefinition.report_force", kNotNegative},
                                    {"JointDefinition.report_torque", kNotNegative}};
  for (const char* kind : {"Distance", "Revolute", "Prismatic", "Weld", "Wheel", "Pulley", "Friction"})
    rules[std::string(kind) + "Definition.anchor_a"] = rules[std::string(kind) + "Definition.anchor_b"] =
        kJointAny;
  rules["MouseDefinition.anchor_b"] = kJointAny;
  for (const char* kind : {"Revolute", "Prismatic", "Weld"})
    rules[std::string(kind) + "Definition.reference_angle"] = kJointAny;
  for (const char* kind : {"Prismatic", "Wheel"}) rules[std::string(kind) + "Definition.axis"] = kJointAny;
  for (const char* kind : {"Motor", "Friction"})
    rules[std::string(kind) + "Definition.max_force"] = rules[std::string(kind) + "Definition.max_torque"] =
        kJointNotNegative;
  rules["MouseDefinition.max_force"] = kJointNotNegative;
  return rules;
}

/// A world with what definitions refer to, and something in motion that must not be disturbed.
template <class Real>
struct Place {
  BasicWorld<Real> world;
  BodyId ground, a, b;
  ShapeId shape;
  JointId joint;  ///< that is tried

  Place() {
    ground = world.create_body({.type = BodyType::Static},
                               ShapeDefinition{.geometry = Box{20, 1}, .position = {0, -0.5}});
    a = world.create_body({.name = "crate", .position = {0, 1}, .velocity = {1, 0}});
    shape = world.create_shape(a, {.geometry = Box{1, 1}});
    b = world.create_body({.position = {2, 2}, .angular_velocity = 1},
                          ShapeDefinition{.geometry = Circle{0.5}});
    world.create_joint(ground, b, {.kind = RevoluteDefinition{.anchor_a = {2, 3}, .anchor_b = {0, 1}}});
    world.step();
  }
};

/// Counts how often each number was tried, and with what result.
struct Tally {
  int refused = 0, accepted = 0, related = 0;
};

/// Puts each bad value into each number of `good`; `use(place, definition)` makes something from it, in a
/// place that `prepare` may have changed.
template <class Real, class Definition, class Use>
void try_every_field(
    const Definition& good, const std::string& subject, Rules& rules, Tally& tally, Use use,
    const std::function<void(Place<Real>&)>& prepare = [](Place<Real>&) {}) {
  std::vector<FieldPlace> places;
  Definition sample = good;
  visit_fields(sample, {}, [&](const FieldPlace& at, auto&) { places.push_back(at); });
  for (const FieldPlace& at : places) {
    const Rule rule = rules.of(at.key);
    for (const double bad : bad_numbers()) {
      Definition spoilt = good;
      std::string text;
      visit_fields(spoilt, {}, [&]<class T>(const FieldPlace& here, T& value) {
        if (here.path != at.path || !can_hold<T>(bad)) return;
        value = static_cast<T>(bad);
        text = text_of<T>(bad);
      });
      if (text.empty()) continue;
      SCOPED_TRACE(at.path + " = " + text);
      Place<Real> place;
      prepare(place);
      if (!rule.accepts(bad)) {
        const bool joint = at.key.starts_with("JointDefinition");
        expect_refused(place.world, {joint ? "joint" : subject, at.path, text}, [&] { use(place, spoilt); });
        ++tally.refused;
        continue;
      }
      const std::vector<std::byte> before = save(place.world);
      try {
        use(place, spoilt);
        ++tally.accepted;
        expect_finite_steps(place.world);
      } catch (const Error& error) {
        // Together with the other numbers it makes no sense: a segment without length, a range turned over.
        EXPECT_EQ(error.kind(), Error::Kind::Value) << error.what();
        EXPECT_EQ(error.subject(), subject);
        EXPECT_TRUE(save(place.world) == before) << "something has changed: " << error.what();
        ++tally.related;
      }
    }
  }
}

template <class Real>
class WorldDefinitions : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(WorldDefinitions, Reals);

TYPED_TEST(WorldDefinitions, OfWorlds) {
  using Real = TypeParam;
  Rules rules(world_rules());
  Tally tally;
  try_every_field<Real>(WorldDefinition{}, "world", rules, tally,
                        [](Place<Real>&, const WorldDefinition& definition) {
                          BasicWorld<Real> world(definition);
                          world.create_body({}, ShapeDefinition{});
                          world.create_body({.position = {0.3, 0.3}}, ShapeDefinition{});
                          expect_finite_steps(world);
                        });
  rules.expect_all_used();
  EXPECT_GT(tally.refused, 40);
}

TYPED_TEST(WorldDefinitions, OfBodies) {
  using Real = TypeParam;
  Rules rules(body_rules());
  Tally tally;
  const BodyDefinition good{.name = "ball", .position = {5, 5}, .mass = MassProperties{}};
  try_every_field<Real>(good, "body 'ball'", rules, tally,
                        [](Place<Real>& place, const BodyDefinition& each) {
                          place.world.create_body(each, ShapeDefinition{});
                        });
  rules.expect_all_used();
  EXPECT_GT(tally.refused, 150);
}

TYPED_TEST(WorldDefinitions, OfMasses) {
  using Real = TypeParam;
  Rules rules({{"MassProperties.mass", kMass},
               {"MassProperties.centre", kAny},
               {"MassProperties.inertia", kInertia}});
  Tally tally;
  try_every_field<Real>(
      MassProperties{}, "body 'crate'", rules, tally,
      [](Place<Real>& place, const MassProperties& each) { place.world.set_mass(place.a, each); });
  EXPECT_GT(tally.refused, 40);
}

TYPED_TEST(WorldDefinitions, OfShapes) {
  using Real = TypeParam;
  Rules rules(shape_rules());
  Tally tally;
  for (const ShapeGeometry& geometry :
       {ShapeGeometry{Circle{0.5}}, ShapeGeometry{Box{1, 2}}, ShapeGeometry{Capsule{{0, 0}, {1, 0}, 0.25}},
        ShapeGeometry{Polygon{{{0, 0}, {1, 0}, {0, 1}}, 0.125}}, ShapeGeometry{Segment{{0, 0}, {1, 1}}}}) {
    const ShapeDefinition good{.geometry = geometry};
    const auto added = [](Place<Real>& place, const ShapeDefinition& each) {
      place.world.create_shape(place.a, each);
    };
    try_every_field<Real>(good, "shape of body 'crate'", rules, tally, added);
    const auto with_body = [](Place<Real>& place, const ShapeDefinition& each) {
      place.world.create_body({.name = "one", .position = {5, 5}}, std::vector{ShapeDefinition{}, each});
    };
    try_every_field<Real>(good, "shape 1 of body 'one'", rules, tally, with_body);
  }
  rules.expect_all_used();
  EXPECT_GT(tally.refused, 500);
}

TYPED_TEST(WorldDefinitions, OfMaterials) {
  using Real = TypeParam;
  Rules rules(shape_rules());
  Tally tally;
  try_every_field<Real>(
      Material{}, "shape 1 of body 'crate'", rules, tally,
      [](Place<Real>& place, const Material& each) { place.world.set_material(place.shape, each); });
  EXPECT_GT(tally.refused, 30);
}

TYPED_TEST(WorldDefinitions, OfChains) {
  using Real = TypeParam;
  Rules rules(chain_rules());
  Tally tally;
  for (const bool closed : {false, true}) {
    const ChainDefinition good{.points = {{-5, 4}, {-4, 3}, {-3, 4.5}},
                               .closed = closed,
                               .materials = std::vector<Material>(closed ? 3 : 2)};
    try_every_field<Real>(good, "chain of body 0", rules, tally,
                          [](Place<Real>& place, const ChainDefinition& each) {
                            place.world.create_chain(place.ground, each);
                          });
  }
  rules.expect_all_used();
  EXPECT_GT(tally.refused, 100);
}

std::vector<JointKind> joint_kinds() {
  const Spring spring{3, 0.5};
  const Range range{0.25, 1.5};
  const Motor motor{1, 2};
  return {DistanceDefinition{.spring = spring, .range = range, .motor = motor},
          RevoluteDefinition{.limits = range, .motor = motor, .spring = spring},
          PrismaticDefinition{.limits = range, .motor = motor, .spring = spring},
          WeldDefinition{.linear_spring = spring, .angular_spring = spring},
          WheelDefinition{.spring = spring, .limits = range, .motor = motor},
          MotorDefinition{},
          MouseDefinition{},
          GearDefinition{},
          PulleyDefinition{.ground_a = {0, 3}, .ground_b = {2, 3}, .length = 2.0},
          RatchetDefinition{},
          FrictionDefinition{}};
}

TYPED_TEST(WorldDefinitions, OfJoints) {
  using Real = TypeParam;
  Rules rules(joint_rules());
  Tally tally;
  ASSERT_EQ(joint_kinds().size(), std::variant_size_v<JointKind>);
  for (const JointKind& kind : joint_kinds()) {
    SCOPED_TRACE(name_of(kind));
    const auto add = [&](Place<Real>& place, const JointDefinition& each) {
      const bool mouse = std::holds_alternative<MouseDefinition>(kind);
      place.joint = place.world.create_joint(mouse ? place.ground : place.a, place.b, each);
    };
    try_every_field<Real>(JointDefinition{.kind = kind}, name_of(kind), rules, tally, add);
    const auto change = [](Place<Real>& place, const JointKind& each) {
      place.world.change(place.joint, each);
    };
    try_every_field<Real>(kind, name_of(kind), rules, tally, change,
                          [&](Place<Real>& place) { add(place, {.kind = kind}); });
  }
  rules.expect_all_used();
  EXPECT_GT(tally.refused, 1500);
}

}  // namespace
}  // namespace plumb::bad_input
