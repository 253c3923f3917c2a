#include "engine/world/snapshot.h"

#include "bindings/c/handle.h"
#ifndef PLUMB_NO_FILES
#include "engine/world/replay.h"
#include "engine/world/state/lock.h"
#endif

using namespace plumb::c;
using plumb::Error;

size_t plumb_world_save(const plumb_world* world, void* to, size_t capacity) {
  return read_or<size_t>(0, world, [&](const auto& w) { return fill_bytes(plumb::save(w), to, capacity); });
}
plumb_status plumb_world_restore(plumb_world* world, const void* bytes, size_t count) {
  return change_checked(world, [&](auto& w) {
    require_countable("snapshot", "count", count);
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
  plumb::require_unlocked(plain.data());
  ++world.moves;
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

thread_local std::string message;  // of the last replay

template <class Real>
void replay(const char* file, const std::function<bool(const plumb::ContactReading&)>& hook,
            plumb_replay_report& to, plumb_body* differing, size_t capacity) {
  const plumb::ReplayReport from = plumb::replay<Real>(file, hook);
  message = from.message;
  to = {from.calls,         from.steps,     from.first_difference.value_or(-1), from.recorded_hash, from.hash,
        from.bodies.size(), message.c_str()};
  std::vector<plumb::BodyId> bodies;
  for (const plumb::BodyDifference& each : from.bodies) bodies.push_back(each.body);
  fill(bodies, differing, capacity);
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
  return plumb_replay_with(file, precision, nullptr, nullptr, report, nullptr, 0);
}
plumb_status plumb_replay_with(const char* file, plumb_precision precision, plumb_pre_solve_function hook,
                               void* context, plumb_replay_report* report, plumb_body* differing,
                               size_t capacity) {
  return checked([&] {
    require(file, "file");
    plumb_replay_report& to = require(report, "report");
    std::function<bool(const plumb::ContactReading&)> call;
    if (hook != nullptr) {
      call = [hook, context](const plumb::ContactReading& reading) {
        const plumb_contact contact = out(reading);
        return hook(&contact, context);
      };
    }
    if (in<int>(precision, 2, "replay", "precision") == PLUMB_FLOAT) {
      replay<float>(file, call, to, differing, capacity);
    } else {
      replay<double>(file, call, to, differing, capacity);
    }
  });
}
#endif
