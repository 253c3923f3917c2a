// Force laws of the C interface against the same calls of the C++ interface.
#include "engine/world/force_laws.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "engine/scene/json.h"
#include "engine/world/scene/scene_forces.h"
#include "tests/bindings/c/fixture.h"

namespace {

using plumb::tests::C;
using plumb::tests::kDt;
using ::testing::HasSubstr;

constexpr plumb_wrench kLift{{0.5, 12}, 0.25};

/// A law of each kind, in both languages.
struct Law {
  const char* name;
  std::function<plumb_status(plumb_world*, plumb_body, plumb_body)> c;
  std::function<void(plumb::World&, plumb::BodyId, plumb::BodyId)> cpp;
};
const Law kLaws[] = {
    {"own law",
     [](plumb_world* w, plumb_body, plumb_body) {
       return plumb_world_apply_law(
           w, [](const plumb_law_body*, void* context) { return *static_cast<const plumb_wrench*>(context); },
           const_cast<plumb_wrench*>(&kLift), 0, false);
     },
     [](plumb::World& w, plumb::BodyId, plumb::BodyId) {
       plumb::apply_law(w, [](const plumb::LawBody&) {
         return plumb::Wrench<double>{{kLift.force.x, kLift.force.y}, kLift.torque};
       });
     }},
    {"linear drag",
     [](plumb_world* w, plumb_body, plumb_body) {
       return plumb_world_apply_linear_drag(w, 0.7, 0.1, kDt, false);
     },
     [](plumb::World& w, plumb::BodyId, plumb::BodyId) {
       plumb::apply_linear_drag(w, {0.7, 0.1}, kDt);
     }},
    {"quadratic drag",
     [](plumb_world* w, plumb_body, plumb_body) {
       return plumb_world_apply_quadratic_drag(w, 0.3, kDt, false);
     },
     [](plumb::World& w, plumb::BodyId, plumb::BodyId) { plumb::apply_quadratic_drag(w, 0.3, kDt); }},
    {"attraction",
     [](plumb_world* w, plumb_body, plumb_body) {
       plumb_attraction law = plumb_default_attraction();
       law.strength = 20, law.falloff = PLUMB_LINEAR;
       return plumb_world_apply_attraction(w, {1, 4}, &law, kDt, false);
     },
     [](plumb::World& w, plumb::BodyId, plumb::BodyId) {
       plumb::apply_attraction(w, {1, 4}, {.strength = 20, .falloff = plumb::Attraction::Falloff::Linear},
                               kDt);
     }},
    {"attraction to a body",
     [](plumb_world* w, plumb_body a, plumb_body) {
       plumb_attraction law = plumb_default_attraction();
       law.strength = 30, law.softening = 0.2;
       return plumb_world_apply_attraction_to(w, a, &law, kDt, false);
     },
     [](plumb::World& w, plumb::BodyId a, plumb::BodyId) {
       plumb::apply_attraction_to_body(w, a, {.strength = 30, .softening = 0.2}, kDt);
     }},
    {"wind",
     [](plumb_world* w, plumb_body, plumb_body) {
       plumb_wind wind = plumb_default_wind();
       wind.velocity = {6, 1};
       return plumb_world_apply_wind(w, &wind, kDt, false);
     },
     [](plumb::World& w, plumb::BodyId, plumb::BodyId) {
       plumb::apply_wind(w, {.velocity = {6, 1}}, kDt);
     }},
    {"water",
     [](plumb_world* w, plumb_body, plumb_body) {
       plumb_water water = plumb_default_water();
       water.level = 3, water.density = 2, water.velocity = {1, 0}, water.linear_drag = 3;
       water.angular_drag = 1;
       return plumb_world_apply_water(w, &water, kDt, false);
     },
     [](plumb::World& w, plumb::BodyId, plumb::BodyId) {
       plumb::apply_water(
           w, {.level = 3, .density = 2, .velocity = {1, 0}, .linear_drag = 3, .angular_drag = 1}, kDt);
     }},
    {"spring",
     [](plumb_world* w, plumb_body a, plumb_body b) {
       plumb_elastic_spring spring = plumb_default_elastic_spring();
       spring.damping = 2, spring.pulls_only = true;
       return plumb_world_apply_spring(w, a, {0.5, 0}, b, {-0.5, 0}, &spring, kDt, false);
     },
     [](plumb::World& w, plumb::BodyId a, plumb::BodyId b) {
       plumb::apply_spring(w, a, {0.5, 0}, b, {-0.5, 0}, {.damping = 2, .pulls_only = true}, kDt);
     }},
    {"explosion behind cover",
     [](plumb_world* w, plumb_body, plumb_body) {
       plumb_blast blast = plumb_default_blast();
       blast.centre = {-2, 4.2}, blast.radius = 6, blast.impulse = 0.4, blast.occlusion = true;
       return plumb_world_explode(w, &blast);
     },
     [](plumb::World& w, plumb::BodyId, plumb::BodyId) {
       plumb::explode(w, {.centre = {-2, 4.2}, .radius = 6, .impulse = 0.4}, {.occlusion = true});
     }},
    {"explosion that ignores a body as cover",
     [](plumb_world* w, plumb_body a, plumb_body) {
       plumb_blast blast = plumb_default_blast();
       blast.centre = {-2, 4.2}, blast.radius = 6, blast.impulse = 0.4, blast.occlusion = true;
       blast.cover.ignore = a;
       return plumb_world_explode(w, &blast);
     },
     [](plumb::World& w, plumb::BodyId a, plumb::BodyId) {
       plumb::explode(w, {.centre = {-2, 4.2}, .radius = 6, .impulse = 0.4},
                      {.occlusion = true, .cover = {.ignore = a}});
     }},
};

TEST_F(C, ForceLawsGiveTheBitsOfCpp) {
  const auto run_cpp = [](const Law* law) {
    plumb::World cpp;
    const plumb::ShapeDefinition shape{.geometry = plumb::Box{1, 1}, .hit_events = true};
    const plumb::BodyId a = cpp.create_body({.position = {0, 4}}, shape);
    const plumb::BodyId b = cpp.create_body({.position = {3, 4.5}}, shape);
    cpp.set_velocity(b, {-1, 2});
    for (int i = 0; i < 30; ++i) {
      if (law != nullptr) law->cpp(cpp, a, b);
      cpp.step(kDt, 4);
    }
    return cpp.hash();
  };
  const uint64_t without = run_cpp(nullptr);
  for (const Law& law : kLaws) {
    plumb_world_destroy(world);
    world = plumb_world_create(nullptr);
    const plumb_body a = box(PLUMB_DYNAMIC, {0, 4}, 1, 1), b = box(PLUMB_DYNAMIC, {3, 4.5}, 1, 1);
    plumb_body_set_velocity(world, b, {-1, 2});
    for (int i = 0; i < 30; ++i) {
      ASSERT_EQ(law.c(world, a, b), PLUMB_OK) << law.name << ": " << plumb_last_error().message;
      plumb_world_step(world, kDt, 4);
    }
    EXPECT_EQ(plumb_world_hash(world), run_cpp(&law)) << law.name;
    EXPECT_NE(plumb_world_hash(world), without) << law.name << " does nothing";
  }
}

TEST_F(C, ALawOfOnesOwnSeesTheMiddleOfTheStep) {
  plumb_world_set_gravity(world, {0, 0});
  const plumb_body body = box(PLUMB_DYNAMIC, {3, 0}, 1, 2);
  const plumb_law_function spring = [](const plumb_law_body* at, void*) {
    return plumb_wrench{{-8 * at->centre.x, -8 * at->centre.y}, 0};
  };
  for (int i = 0; i < 300; ++i) {
    ASSERT_EQ(plumb_world_apply_law(world, spring, nullptr, kDt, false), PLUMB_OK);
    plumb_world_step(world, kDt, 4);
  }
  // x_i = 3 cos(i a) solves x_(i+1) - 2 x_i + x_(i-1) = -(w dt)^2 x_i, the force at the middle of each step.
  const double a = std::acos(1 - 0.5 * 4 * kDt * kDt);
  EXPECT_NEAR(plumb_body_position(world, body).x, 3 * std::cos(300 * a), 2e-4);
  EXPECT_EQ(plumb_world_apply_law(world, spring, nullptr, -1, false), PLUMB_VALUE);
}

TEST_F(C, ALawOfOnesOwnSeesEachBody) {
  const plumb_body lifted = box(PLUMB_DYNAMIC, {0, 4}, 1, 2);
  plumb_body_set_user_data(world, lifted, 9);
  plumb_body_set_velocity(world, lifted, {3, 0});
  plumb_law_body seen{};
  const plumb_law_function weightless = [](const plumb_law_body* body, void* context) {
    *static_cast<plumb_law_body*>(context) = *body;
    return plumb_wrench{{0, 9.81 * body->mass}, 0};
  };
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(plumb_world_apply_law(world, weightless, &seen, 0, false), PLUMB_OK);
    plumb_world_step(world, kDt, 4);
  }
  EXPECT_EQ(seen.body.index, lifted.index);
  EXPECT_EQ(seen.mass, 2);
  EXPECT_NEAR(seen.inertia, 2 * 5 / 12., 1e-6);
  EXPECT_EQ(seen.user_data, 9u);
  EXPECT_EQ(seen.velocity.x, 3);
  // The weight is cancelled: it flies straight on.
  EXPECT_NEAR(plumb_body_position(world, lifted).y, 4, 1e-5);
  EXPECT_NEAR(plumb_body_position(world, lifted).x, 3, 1e-5);
}

TEST_F(C, ALawMayReadTheWorldAndNotChangeIt) {
  box(PLUMB_DYNAMIC, {0, 4}, 1, 1);
  const plumb_law_function changes = [](const plumb_law_body* body, void* context) {
    auto* w = static_cast<plumb_world*>(context);
    EXPECT_EQ(plumb_body_position(w, body->body).y, 4);
    EXPECT_EQ(plumb_body_destroy(w, body->body), PLUMB_UNSUPPORTED);
    return plumb_wrench{};
  };
  EXPECT_EQ(plumb_world_apply_law(world, changes, world, 0, false), PLUMB_OK);
  EXPECT_EQ(plumb_world_counts(world).bodies, 1);
}

TEST_F(C, QuarantinedBodiesAreListedWithTheirFaults) {
  const plumb_body bad = box(PLUMB_DYNAMIC, {0, 4}, 1, 1);
  const plumb_law_function broken = [](const plumb_law_body*, void*) {
    return plumb_wrench{{std::numeric_limits<double>::quiet_NaN(), 0}, 0};
  };
  ASSERT_EQ(plumb_world_apply_law(world, broken, nullptr, 0, false), PLUMB_OK);
  plumb_quarantine_event fault;
  ASSERT_EQ(plumb_world_quarantined(world, &fault, 1), 1u);
  EXPECT_EQ(fault.body.index, bad.index);
  EXPECT_STREQ(fault.field, "force");
  EXPECT_TRUE(std::isnan(fault.value));
  EXPECT_EQ(plumb_body_release(world, bad), PLUMB_OK);
  EXPECT_EQ(plumb_world_quarantined(world, nullptr, 0), 0u);
}

TEST_F(C, LawsRefuseWhatTheyCannotUse) {
  const plumb_body a = box(PLUMB_DYNAMIC, {0, 4}, 1, 1), gone = box(PLUMB_DYNAMIC, {3, 4}, 1, 1);
  plumb_body_destroy(world, gone);
  const uint64_t before = plumb_world_full_hash(world);
  EXPECT_EQ(plumb_world_apply_linear_drag(world, -1, 0, kDt, false), PLUMB_VALUE);
  EXPECT_THAT(plumb_last_error().message, HasSubstr("-1"));
  EXPECT_EQ(plumb_world_apply_quadratic_drag(world, 1, 0, false), PLUMB_VALUE);
  plumb_attraction attraction = plumb_default_attraction();
  const int unknown = 7;
  std::memcpy(&attraction.falloff, &unknown, sizeof unknown);
  EXPECT_EQ(plumb_world_apply_attraction(world, {0, 0}, &attraction, kDt, false), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().field, "falloff");
  attraction = plumb_default_attraction();
  EXPECT_EQ(plumb_world_apply_attraction_to(world, gone, &attraction, kDt, false), PLUMB_NAME);
  const plumb_elastic_spring spring = plumb_default_elastic_spring();
  EXPECT_EQ(plumb_world_apply_spring(world, a, {0, 0}, gone, {0, 0}, &spring, kDt, false), PLUMB_NAME);
  EXPECT_EQ(plumb_world_apply_wind(world, nullptr, kDt, false), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().subject, "wind");
  EXPECT_EQ(plumb_world_apply_water(world, nullptr, kDt, false), PLUMB_VALUE);
  EXPECT_EQ(plumb_world_apply_law(world, nullptr, nullptr, 0, false), PLUMB_VALUE);
  plumb_blast blast = plumb_default_blast();
  blast.radius = 0;
  EXPECT_EQ(plumb_world_explode(world, &blast), PLUMB_VALUE);
  EXPECT_STREQ(plumb_last_error().field, "radius");
  EXPECT_EQ(plumb_world_full_hash(world), before);
}

constexpr const char* kScene =
    R"({"name": "hung", "gravity": [0, -4], "contact_rules": {"friction": "minimum"},
  "bodies": [{"name": "ball", "position": [0, 10], "mass": 1, "velocity": [2, 0],
    "shapes": [{"type": "circle", "radius": 0.5}]}],
  "joints": [{"name": "rope", "type": "distance", "body_a": "world", "body_b": "ball", "anchor_a": [0, 12], "length": 2}],
  "forces": [{"type": "linear_drag", "body": "ball", "coefficient": 0.5}]})";

TEST_F(C, ScenesBringTheirForceLaws) {
  plumb_world_definition definition;
  ASSERT_EQ(plumb_scene_world(kScene, &definition), PLUMB_OK) << plumb_last_error().message;
  EXPECT_EQ(definition.gravity.y, -4);
  EXPECT_EQ(definition.combine_friction, PLUMB_MINIMUM);
  plumb_world_destroy(world);
  world = plumb_world_create(&definition);
  plumb_added_scene* scene = plumb_scene_add(world, kScene);
  ASSERT_NE(scene, nullptr) << plumb_last_error().message;
  plumb_body ball;
  EXPECT_EQ(plumb_scene_bodies(scene, &ball, 1), 1u);
  EXPECT_EQ(plumb_body_position(world, ball).y, 10);
  EXPECT_EQ(plumb_scene_joints(scene, nullptr, 0), 1u);
  EXPECT_TRUE(plumb_body_valid(world, plumb_scene_frame(scene)));

  const plumb::Scene same = plumb::scene_from_json(kScene);
  plumb::World cpp(plumb::world_definition(same));
  const plumb::SceneParts parts = plumb::add_scene(cpp, same);
  plumb::SceneForces<float> forces(same, parts);
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(plumb_scene_apply_forces(scene, kDt), PLUMB_OK);
    plumb_world_step(world, kDt, 4);
    forces.apply(cpp, kDt);
    cpp.step(kDt, 4);
  }
  EXPECT_EQ(plumb_world_hash(world), cpp.hash());
  const uint64_t before = plumb_world_full_hash(world);
  for (const double dt : {-kDt, 0.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(plumb_scene_apply_forces(scene, dt), PLUMB_VALUE) << dt;
    EXPECT_STREQ(plumb_last_error().field, "dt");
  }
  EXPECT_EQ(plumb_world_full_hash(world), before);
  EXPECT_EQ(plumb_world_quarantined(world, nullptr, 0), 0u);
  plumb_scene_destroy(scene);
  EXPECT_TRUE(plumb_body_valid(world, ball));

  EXPECT_EQ(plumb_scene_add(world, "{\"bodies\": 3}"), nullptr);
  EXPECT_EQ(plumb_last_error().status, PLUMB_SYNTAX);
  EXPECT_EQ(plumb_scene_world(kScene, nullptr), PLUMB_VALUE);
}

}  // namespace
