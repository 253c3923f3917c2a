// A chain whose segments differ in material.
#include <gmock/gmock.h>

#include "engine/scene/error.h"
#include "engine/world/recorder.h"
#include "engine/world/replay.h"
#include "engine/world/state_hash.h"
#include "tests/world/support.h"

namespace plumb {
namespace {

template <class Real>
class ChainMaterials : public testing::Test {};
using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ChainMaterials, Reals);

// From x = 10 to -10: ice, then a belt, then a rough floor.
const std::vector<Vec2d> kFloor = {{30, 0}, {10, 0}, {-10, 0}, {-30, 0}};
const std::vector<Material> kMaterials = {
    {.friction = 0}, {.friction = 0.5, .surface_speed = 2}, {.friction = 0.5, .restitution = 0.25}};

TYPED_TEST(ChainMaterials, AreThoseOfTheirSegments) {
  BasicWorld<TypeParam> w;
  const BodyId ground = w.create_body({.type = BodyType::Static});
  const ChainId chain = w.create_chain(ground, {.points = kFloor, .materials = kMaterials});
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(w.material(w.segments(chain)[i]), kMaterials[i]);
  const BodyId on_ice = add_body(w, {15, 0.5}, {.geometry = Box{1, 1}}, {3, 0});
  const BodyId on_belt = add_box(w, {-5, 0.5});
  const BodyId on_floor = add_body(w, {-20, 0.5}, {.geometry = Box{1, 1}}, {2, 0});
  run(w, 90);
  EXPECT_NEAR(w.velocity(on_ice).x, 3, 1e-6);
  EXPECT_NEAR(std::abs(w.velocity(on_belt).x), 2, 1e-2);
  // v^2 / (2 mu g) with mu = sqrt(0.5 * 0.6), the geometric mean.
  EXPECT_NEAR(w.position(on_floor).x, -20 + 4 / (2 * std::sqrt(0.3) * kGravity), 0.05);
}

TYPED_TEST(ChainMaterials, AreReadBackAndCreatedAgain) {
  BasicWorld<TypeParam> w;
  const BodyId ground = w.create_body({.type = BodyType::Static});
  const ChainId open = w.create_chain(ground, {.points = kFloor, .materials = kMaterials});
  const ChainId closed =
      w.create_chain(ground, {.points = {{0, 9}, {1, 9}, {0, 8}}, .closed = true, .materials = kMaterials});
  const ChainId uniform =
      w.create_chain(ground, {.points = {{0, 19}, {1, 19}}, .material = {.friction = 0.125}});
  for (const ChainId chain : {open, closed}) EXPECT_EQ(w.definition(chain).materials.size(), 3u);
  EXPECT_EQ(w.definition(open).materials, kMaterials);
  EXPECT_TRUE(w.definition(uniform).materials.empty());
  EXPECT_EQ(w.definition(uniform).material.friction, 0.125);
  const ChainId again = w.create_chain(ground, w.definition(closed));
  EXPECT_EQ(w.definition(again).materials, kMaterials);
}

TYPED_TEST(ChainMaterials, OfAnotherNumberAreRefused) {
  BasicWorld<TypeParam> w;
  const BodyId ground = w.create_body({.type = BodyType::Static});
  const auto refused = [&](ChainDefinition chain, const std::string& field) {
    const std::uint64_t before = full_hash(w);
    try {
      w.create_chain(ground, chain);
      ADD_FAILURE() << field;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), Error::Kind::Value);
      EXPECT_EQ(error.field(), field) << error.what();
    }
    EXPECT_EQ(full_hash(w), before);
  };
  ChainDefinition chain{.points = kFloor, .materials = kMaterials};
  chain.materials.pop_back();
  refused(chain, "materials");
  chain.materials = kMaterials;
  chain.closed = true, refused(chain, "materials");
  chain.closed = false;
  chain.materials[1].friction = -1;
  refused(chain, "materials[1].friction");
}

TYPED_TEST(ChainMaterials, AreRecorded) {
  const std::string file = testing::TempDir() + "chain_materials." + std::to_string(sizeof(TypeParam));
  std::uint64_t hash = 0;
  {
    RecordedWorld<TypeParam> w(file);
    const BodyId ground = w.create_body({.type = BodyType::Static});
    w.create_chain(ground, {.points = kFloor, .materials = kMaterials});
    w.create_body({.position = {0, 0.5}}, {.geometry = Box{1, 1}});
    for (int i = 0; i < 30; ++i) w.step();
    hash = full_hash(*w);
  }
  Replay<TypeParam> replayed(file);
  while (replayed.step()) {
  }
  EXPECT_EQ(full_hash(replayed.world()), hash);
}

}  // namespace
}  // namespace plumb
