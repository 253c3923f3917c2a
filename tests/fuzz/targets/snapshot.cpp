// Snapshots of worlds and of simulations that were changed on their way: they are refused with a typed error,
// and nothing has changed then, or they are worlds that step. Bytes alone hardly ever get past the checksum:
// most runs make a world, save it, change what was saved and repair the checksum.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "engine/simulation/simulation.h"
#include "engine/world/checksum.h"
#include "engine/world/snapshot.h"
#include "tests/fuzz/support/patches.h"
#include "tests/fuzz/support/require.h"
#include "tests/fuzz/support/world_player.h"

namespace plumb::fuzz {
namespace {

using Bytes = std::vector<std::byte>;

constexpr std::size_t kHeader = 32;  // magic, version and layout, then size and sum

void repair(Bytes& bytes) {
  if (bytes.size() < kHeader) return;
  const std::span<const std::byte> content = std::span(bytes).subspan(kHeader);
  const std::uint64_t size = content.size(), sum = checksum(content);
  std::memcpy(bytes.data() + 16, &size, sizeof(size));
  std::memcpy(bytes.data() + 24, &sum, sizeof(sum));
}

template <class Real>
BasicWorld<Real> small_world() {
  BasicWorld<Real> world;
  world.create_body({.type = BodyType::Static}, {.geometry = Box{10, 1}});
  world.create_body({.position = {0, 1}}, {.geometry = Circle{0.5}});
  for (int i = 0; i < 3; ++i) world.step();
  return world;
}

// A world that came from a snapshot is used as any other: nothing that it does may leave its arrays.
template <class Real>
void use(BasicWorld<Real>& world) {
  try {
    for (int i = 0; i < 3; ++i) world.step();
    for (const BodyId body : world.bodies()) {
      const BodyState state = world.state(body);
      require(std::isfinite(state.position.x + state.position.y + state.angle), "places stay finite");
      world.contacts(body);
    }
    world.create_body({.position = {0, 5}}, {.geometry = Box{1, 1}});
    for (const BodyId body : world.bodies()) {
      world.destroy(body);
      if (world.counts().bodies % 4 == 0) world.step();
    }
  } catch (const Error&) {
    // Numbers too large for a step, as snapshots may hold them.
  }
}

template <class Real>
void restore_world(const Bytes& bytes) {
  BasicWorld<Real> world = small_world<Real>();
  const Bytes before = save(world);
  try {
    restore(world, std::span<const std::byte>(bytes));
  } catch (const Error& error) {
    require(error.kind() == Error::Kind::Value, "a snapshot is refused for its values");
    require(save(world) == before, "a refused snapshot changes nothing");
    return;
  }
  use(world);
}

template <class Real>
void change_saved(ByteSource& in) {
  ByteSource recipe(in.take(in.word() % 256));
  WorldPlayer<Real> player(recipe);
  player.play();
  Bytes bytes = save(player.world());
  in.set_extreme(true);
  Bytes content(bytes.begin() + kHeader, bytes.end());
  patch(content, in);
  bytes.resize(kHeader);
  bytes.insert(bytes.end(), content.begin(), content.end());
  repair(bytes);
  restore_world<Real>(bytes);
}

constexpr char kScene[] = R"({"name": "saved", "bodies": [
  {"name": "ground", "type": "static", "shapes": [{"type": "box", "width": 20, "height": 1}]},
  {"name": "a", "position": [0, 1], "mass": 1, "shapes": [{"type": "box", "width": 1, "height": 1}]},
  {"name": "b", "position": [0.2, 2.1], "mass": 2, "shapes": [{"type": "circle", "radius": 0.5}]},
  {"name": "c", "position": [5, 4], "mass": 1, "inertia": 0.1}, {"name": "d", "position": [6, 4], "mass": 1, "inertia": 0.1}],
 "joints": [
  {"type": "revolute", "name": "p", "body_a": "world", "body_b": "c", "anchor_a": [4, 4], "anchor_b": [-1, 0]},
  {"type": "distance", "name": "q", "body_a": "c", "body_b": "d", "length": 1}]})";

// A simulation that goes on after each restoring, and what it is to do from the state that it was saved in.
struct Saved {
  explicit Saved(const Accuracy& accuracy) : simulation(compile(scene_from_json(kScene), accuracy)) {
    simulation.step(20);
    bytes = simulation.save();
    simulation.step(2);
    future = simulation.hash();
    simulation.restore(bytes);
  }
  Simulation simulation;
  Bytes bytes;
  std::uint64_t future = 0;
};

void change_simulation(ByteSource& in) {
  static Saved all[] = {Saved(Realtime{}), Saved(Realtime{.precision = Precision::Float}),
                        Saved(Realtime{.solver = Solver::SequentialImpulses})};
  Saved& saved = all[in.below(static_cast<int>(std::size(all)))];
  Bytes bytes = saved.bytes;
  in.set_extreme(true);
  patch(bytes, in);
  try {
    saved.simulation.restore(bytes);
  } catch (const Error& error) {
    require(error.kind() == Error::Kind::Value, "a snapshot is refused for its values");
    require(saved.simulation.save() == saved.bytes, "a refused snapshot changes nothing");
    return;
  }
  try {
    saved.simulation.step(3);
    for (std::size_t body = 0; body < saved.simulation.body_count(); ++body)
      require(std::isfinite(saved.simulation.state(body).position.x), "places stay finite");
  } catch (const Error&) {
    // Numbers too large for a step.
  }
  saved.simulation.restore(saved.bytes);
  saved.simulation.step(2);
  require(saved.simulation.hash() == saved.future, "a restored simulation goes on with the same bits");
  saved.simulation.restore(saved.bytes);
}

void restore_as_they_are(ByteSource& in, bool repaired) {
  const auto rest = in.rest();
  Bytes bytes(rest.size());
  if (!rest.empty()) std::memcpy(bytes.data(), rest.data(), rest.size());
  if (repaired) {
    const Bytes empty = save(World());
    bytes.insert(bytes.begin(), empty.begin(), empty.begin() + kHeader);
    repair(bytes);
  }
  restore_world<float>(bytes);
  restore_world<double>(bytes);
}

}  // namespace
}  // namespace plumb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumb::fuzz;
  ByteSource in({data, size});
  const int kind = in.byte() % 8;
  if (kind < 3) {
    change_saved<float>(in);
  } else if (kind < 5) {
    change_saved<double>(in);
  } else if (kind == 5) {
    change_simulation(in);
  } else {
    restore_as_they_are(in, kind == 7);
  }
  return 0;
}
