#include "engine/world/rollback.h"

#include <memory>

#include "bindings/c/handle.h"
#include "engine/world/invariant_monitor.h"

using namespace plumb::c;
using plumb::BasicWorld;

/// The last states of a world of either precision.
struct plumb_rollback {
  plumb_world* world;
  int moves;
  std::variant<plumb::Rollback<float>, plumb::Rollback<double>> states;
};

/// A monitor of a world of either precision.
struct plumb_monitor {
  const plumb_world* world;
  int moves;
  std::variant<plumb::InvariantMonitor<float>, plumb::InvariantMonitor<double>> monitor;
};

namespace {

plumb_rollback& opened(plumb_rollback* rollback) {
  plumb_rollback& r = require(rollback, "rollback");
  require_unmoved(*r.world, r.moves, "rollback");
  return r;
}
plumb_monitor& opened(plumb_monitor* monitor) {
  plumb_monitor& m = require(monitor, "monitor");
  require_unmoved(*m.world, m.moves, "monitor");
  return m;
}

template <class Result, class Read>
Result read_states(Result otherwise, const plumb_rollback* rollback, Read&& read) {
  return checked_or(otherwise, [&]() -> Result {
    return std::visit([&](const auto& states) -> Result { return read(states); },
                      require(rollback, "rollback").states);
  });
}

}  // namespace

plumb_rollback* plumb_rollback_create(plumb_world* world, int frames) {
  return checked_or<plumb_rollback*>(nullptr, [&] {
    std::unique_ptr<plumb_rollback> made;
    edit(world, [&]<class Real>(BasicWorld<Real>& w) {
      made.reset(new plumb_rollback{world, world->moves, plumb::Rollback<Real>(w, frames)});
    });
    return made.release();
  });
}
void plumb_rollback_destroy(plumb_rollback* rollback) { delete rollback; }
plumb_status plumb_rollback_save(plumb_rollback* rollback) {
  return checked([&] { std::visit([](auto& states) { states.save(); }, opened(rollback).states); });
}
plumb_status plumb_rollback_back_to(plumb_rollback* rollback, int64_t step) {
  return checked([&] {
    plumb_rollback& r = opened(rollback);
    edit(r.world,
         [&]<class Real>(BasicWorld<Real>&) { std::get<plumb::Rollback<Real>>(r.states).back_to(step); });
  });
}
bool plumb_rollback_holds(const plumb_rollback* rollback, int64_t step) {
  return read_states(false, rollback, [&](const auto& states) { return states.holds(step); });
}
int plumb_rollback_size(const plumb_rollback* rollback) {
  return read_states(0, rollback, [](const auto& states) { return states.size(); });
}
int64_t plumb_rollback_oldest(const plumb_rollback* rollback) {
  return read_states<int64_t>(-1, rollback, [](const auto& states) { return states.oldest(); });
}
int64_t plumb_rollback_latest(const plumb_rollback* rollback) {
  return read_states<int64_t>(-1, rollback, [](const auto& states) { return states.latest(); });
}

plumb_monitor_bounds plumb_default_monitor(void) {
  const plumb::MonitorBounds d;
  return {d.joint_gap, d.overlap, d.energy, d.lasting};
}
plumb_monitor* plumb_monitor_create(const plumb_world* world, const plumb_monitor_bounds* bounds) {
  return checked_or<plumb_monitor*>(nullptr, [&] {
    const plumb_monitor_bounds b = bounds != nullptr ? *bounds : plumb_default_monitor();
    return read(world, [&]<class Real>(const BasicWorld<Real>& w) {
      return new plumb_monitor{
          world, world->moves,
          plumb::InvariantMonitor<Real>(w, {b.joint_gap, b.overlap, b.energy, b.lasting})};
    });
  });
}
void plumb_monitor_destroy(plumb_monitor* monitor) { delete monitor; }
plumb_status plumb_monitor_begin_step(plumb_monitor* monitor) {
  return checked([&] { std::visit([](auto& m) { m.begin_step(); }, opened(monitor).monitor); });
}
plumb_status plumb_monitor_end_step(plumb_monitor* monitor) {
  return checked([&] {
    std::visit(
        [](auto& m) {
          if (const auto violation = m.end_step()) throw *violation;
        },
        opened(monitor).monitor);
  });
}
plumb_status plumb_monitor_reset(plumb_monitor* monitor) {
  return checked([&] { std::visit([](auto& m) { m.reset(); }, opened(monitor).monitor); });
}
