#include "engine/world/snapshot.h"

#include "bindings/c/handle.h"
#ifndef PLUMB_NO_FILES
#include "engine/world/replay.h"
#endif

using namespace plumb::c;
using plumb::Error;

size_t plumb_world_save(const plumb_world* world, void* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) { return fill_bytes(plumb::save(w), to, capacity); });
}
plumb_status plumb_world_restore(plumb_world* world, const void* bytes, size_t count) {
  return change_checked(world, [&](auto& w) {
    const auto* first = count > 0 ? &require(static_cast<const std::byte*>(bytes), "bytes") : nullptr;
    const std::span<const std::byte> all(first, count);
    if constexpr (requires { w.restore(all); }) {
      w.restore(all);
    } else {
      plumb::restore(w, all);
    }
  });
}

#ifndef PLUMB_NO_FILES
namespace {

template <class Real>
void record(plumb_world& world, const char* file, bool bodies) {
  auto& plain = std::get<plumb::BasicWorld<Real>>(world.world);
  const std::vector<std::byte> state = plumb::save(plain);
  try {
    plumb::RecordedWorld<Real> recorded(file, std::move(plain), {.bodies = bodies});
    world.world.template emplace<plumb::RecordedWorld<Real>>(std::move(recorded));
  } catch (...) {
    plumb::BasicWorld<Real> same;
    plumb::restore(same, state);
    world.world.template emplace<plumb::BasicWorld<Real>>(std::move(same));
    throw;
  }
}

plumb_status report_of(const plumb::ReplayReport& from, plumb_replay_report& to) {
  to = {from.calls, from.steps, from.first_difference.value_or(-1), from.recorded_hash, from.hash};
  return PLUMB_OK;
}

}  // namespace

plumb_status plumb_world_record(plumb_world* world, const char* file, bool bodies) {
  return checked([&] {
    plumb_world& w = require(world, "world");
    require(file, "file");
    if (std::holds_alternative<plumb::World>(w.world)) return record<float>(w, file, bodies);
    if (std::holds_alternative<plumb::DoubleWorld>(w.world)) return record<double>(w, file, bodies);
    throw Error(Error::Kind::Unsupported, "world", "record", file, "it is recorded already");
  });
}

plumb_status plumb_replay(const char* file, plumb_precision precision, plumb_replay_report* report) {
  return checked([&] {
    require(file, "file");
    plumb_replay_report& to = require(report, "report");
    if (in<int>(precision, 2, "replay", "precision") == PLUMB_FLOAT) {
      report_of(plumb::replay<float>(file), to);
    } else {
      report_of(plumb::replay<double>(file), to);
    }
  });
}
#endif
