// Judges a world whose owner calls it between steps: random calls in every scene.
#include <unistd.h>

#include <algorithm>
#include <cfenv>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>

#include "engine/core/loop_scheduler.h"
#include "engine/math/vector_width.h"
#include "engine/scene/error.h"
#include "engine/world/add_scene.h"
#include "engine/world/recorder.h"
#include "engine/world/replay.h"
#include "engine/world/snapshot.h"
#include "engine/world/state_hash.h"
#include "engine/world/world_data.h"
#include "harness/hunt/calls.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/state_watch.h"

namespace plumb::harness::hunt {
namespace {

// Number of steps of a run, and largest number of calls before each.
constexpr int kSteps = 90, kMostCalls = 2;
// Steps between restores, and between exceptions of hooks, of the second world.
constexpr int kBetweenRestores = 11, kBetweenFaults = 17;

WorldDefinition definition_of(const Case& one) {
  WorldDefinition out = world_definition(one.scene);
  out.sleeping = one.sleeping || one.index % 2 == 0;
  return out;
}

/// A unique file name; the file is removed at the end.
class Scratch {
 public:
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "plumb-hunt-XXXXXX").string();
    const int file = mkstemp(name.data());
    if (file >= 0) close(file);
    path_ = name;
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

double dt_of(const Case& one, int step) { return step % 5 == 4 ? 0.25 * one.dt : one.dt; }
int steps_of(const Case& one) { return std::min(one.steps, kSteps); }

// In some scenes calls begin late, so that bodies are asleep by then; in others they are rarer.
int calls_of(const Case& one, Random& random, int step) {
  const int first = one.index % 3 == 0 ? 30 : 0;
  if (step < first || random.chance(one.index % 2 == 0 ? 0.5 : 0.85)) return 0;
  return random.whole(1, kMostCalls);
}

template <class Real>
BasicWorld<Real> world_of(const Case& one) {
  BasicWorld<Real> out(definition_of(one));
  add_scene(out, one.scene);
  return out;
}

template <class Real>
std::string live_recorded(const Case& one, std::string& part) {
  const Scratch scratch;
  std::uint64_t last = 0;
  std::int64_t steps = 0;
  {
    RecordedWorld<Real> recorded(scratch.path(), world_of<Real>(one));
    recorded.on_pre_solve([](const ContactReading&) { return true; });
    StateWatch<Real> watch(*recorded);
    Random random(one.seed, one.index);
    for (int step = 0; step < steps_of(one); ++step) {
      for (int i = calls_of(one, random, step); i > 0; --i)
        if (std::string wrong = make_call(random, *recorded, recorded); !wrong.empty()) {
          part = wrong.find(" hash ") != std::string::npos ? "hashes" : "calls";
          return fmt::format("{}, before step {}", wrong, step + 1);
        }
      watch.before_step();
      recorded.step(dt_of(one, step), one.substeps);
      if (std::string wrong = watch.after_step(dt_of(one, step)); !wrong.empty()) {
        part = watch.failed();
        return fmt::format("{}, after step {}", wrong, step + 1);
      }
    }
    last = full_hash(*recorded), steps = recorded->step_count();
  }
  part = "recording";
  Replay<Real> again(scratch.path(), [](const ContactReading&) { return true; });
  while (again.step())
    if (again.report().first_difference)
      return fmt::format("its recording differs in step {}", *again.report().first_difference);
  if (again.world().step_count() != steps) return "its recording ends early: " + again.report().message;
  if (full_hash(again.world()) != last) return "its recording ends in another state";
  return {};
}

/// Sets the rounding mode and the width of vector registers during its lifetime.
class OtherMachine {
 public:
  OtherMachine(int rounding, VectorWidth width) : rounding_(std::fegetround()), width_(vector_width()) {
    std::fesetround(rounding);
    set_vector_width(width);
  }
  ~OtherMachine() {
    std::fesetround(rounding_);
    set_vector_width(width_);
  }
  OtherMachine(const OtherMachine&) = delete;
  OtherMachine& operator=(const OtherMachine&) = delete;

 private:
  int rounding_;
  VectorWidth width_;
};

/// Exception type thrown only by the hook, and by no engine.
struct Fault {};

/// Returns errors of a world whose hook throws in a step and tries to change the world. The other world's
/// hook does neither. The failed step must leave no trace, so both worlds must continue in the same way.
template <class Real>
std::string hooked(const BasicWorld<Real>& world, const Case& one) {
  BasicWorld<Real> other(definition_of(one));
  restore(other, save(world));
  other.set_threads(2), other.data().scheduler.set_eager(true);
  for (const BodyId body : other.bodies())
    for (const ShapeId shape : other.shapes(body)) other.set_pre_solve(shape, true);
  bool asked = false, changed = false, throws = true;
  const std::uint64_t before = other.hash();
  other.on_pre_solve([&](const ContactReading& contact) -> bool {
    if (!throws) return true;
    asked = true;
    try {
      other.set_gravity({1, 2}), changed = true;
    } catch (const Error& error) {
      changed = error.kind() != Error::Kind::Unsupported;
    }
    static_cast<void>(contact);
    throw Fault{};
  });
  bool thrown = false;
  try {
    other.step(one.dt, one.substeps);
  } catch (const Fault&) {
    thrown = true;
  }
  if (changed) return "a hook was allowed to change the world";
  if (asked && !thrown) return "an exception from a hook is lost";
  if (thrown && other.hash() != before) return "a step that a hook aborted moves bodies";
  throws = false;
  try {
    other.step(one.dt, one.substeps);
  } catch (const Error& error) {
    return fmt::format("a world cannot be used after a hook has thrown: {}", error.what());
  }
  return {};
}

/// Ways in which the second of two equal worlds is run.
struct Otherwise {
  bool threads = true, widths = true, restores = true;
};

template <class Real>
std::string live_as_twins(const Case& one, const Otherwise& otherwise) {
  const int rounding = one.index % 4 == 1 ? FE_DOWNWARD : one.index % 4 == 3 ? FE_UPWARD : FE_TONEAREST;
  const VectorWidth usual = vector_width();
  const OtherMachine both(rounding, usual);
  BasicWorld<Real> plain = world_of<Real>(one), other = world_of<Real>(one);
  const auto ready = [&](BasicWorld<Real>& world) {
    if (!otherwise.threads) return;
    world.set_threads(2);
    world.data().scheduler.set_eager(true);
  };
  // Setting a hook wakes bodies, so both worlds get theirs at the same time.
  const auto hook = [](BasicWorld<Real>& world) {
    world.on_pre_solve([](const ContactReading&) { return true; });
  };
  ready(other), hook(plain), hook(other);
  Random random(one.seed, one.index + 1), same = random;
  for (int step = 0; step < steps_of(one); ++step) {
    const int calls = calls_of(one, random, step);
    calls_of(one, same, step);
    for (int i = 0; i < calls; ++i) {
      // Ignores the answers here: the recorded run judges them.
      make_call(random, plain, plain), make_call(same, other, other);
    }
    plain.step(dt_of(one, step), one.substeps);
    {
      // Keeps the width unless numbers are rounded to nearest, because -(a b) and (-a) b may differ in other
      // rounding modes.
      const OtherMachine narrow(rounding, otherwise.widths && step % 2 == 0 && rounding == FE_TONEAREST
                                              ? VectorWidth::None
                                              : usual);
      other.step(dt_of(one, step), one.substeps);
    }
    if (full_hash(plain) != full_hash(other))
      return fmt::format("continues with other bits in step {}", step + 1);
    if (otherwise.restores && step % kBetweenRestores == kBetweenRestores - 1) {
      BasicWorld<Real> restored(definition_of(one));
      restore(restored, save(other));
      other = std::move(restored);
      ready(other), hook(plain), hook(other);
    }
    if (step % kBetweenFaults == kBetweenFaults - 1)
      if (std::string wrong = hooked(plain, one); !wrong.empty()) return wrong;
  }
  return {};
}

bool in_float(const Engine& engine) { return engine.kind == Engine::Kind::World; }

}  // namespace

Verdict life(const Case& one, const Engine& engine, const Motion&) {
  std::string part;
  const std::string what = checked(
      [&] { return in_float(engine) ? live_recorded<float>(one, part) : live_recorded<double>(one, part); });
  if (what.empty()) return {};
  return Objection{
      .law = "life",
      .judge = "life_of_" + part,
      .what = what,
      .right = "calls have their documented effect, getters agree, and the recording leads to the same state",
      .time = steps_of(one) * one.dt};
}

Verdict twins(const Case& one, const Engine& engine, const Motion&) {
  const auto live = [&](const Otherwise& otherwise) {
    return checked([&] {
      return in_float(engine) ? live_as_twins<float>(one, otherwise) : live_as_twins<double>(one, otherwise);
    });
  };
  std::string what = live({});
  if (what.empty()) return {};
  // If one of the differences alone suffices, it names the judge.
  struct Way {
    const char* name;
    Otherwise otherwise;
  };
  std::string judge = "twins";
  for (const Way& way :
       {Way{"twins_of_threads", {true, false, false}}, Way{"twins_of_widths", {false, true, false}},
        Way{"twins_of_restores", {false, false, true}}}) {
    if (std::string alone = live(way.otherwise); !alone.empty()) {
      judge = way.name, what = std::move(alone);
      break;
    }
  }
  return Objection{.law = "twins",
                   .judge = judge,
                   .what = what,
                   .right = "threads, vector widths, restores and hooks change no bits",
                   .time = steps_of(one) * one.dt};
}

}  // namespace plumb::harness::hunt
