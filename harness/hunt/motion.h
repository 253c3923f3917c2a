#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/hunt/case.h"
#include "reference/backend.h"

namespace plumb::harness::hunt {

/// Every body after a step, in the scene's order.
struct Sample {
  std::vector<BodyState> states{};
  std::vector<bool> present{};  ///< whether the body is there
  std::vector<bool> asleep{};
};

/// A pair of bodies that a sensor says overlap: the sensor's and the visitor's index.
struct Visit {
  std::size_t sensor = 0, visitor = 0;
  friend auto operator<=>(const Visit&, const Visit&) = default;
};

/// A run, sampled after each step; the first sample is the start.
struct Motion {
  double dt = 0;  ///< s, from sample to sample
  std::vector<Sample> samples{};
  std::string failure{};  ///< empty, or why it ended before its time
  std::string stopped{};  ///< empty, or why the engine itself says that it ends before its time
  /// Events that do not pair up: what and when.
  struct EventFault {
    double time = 0;
    std::string what;
  };
  std::vector<EventFault> event_faults{};
  std::vector<std::vector<Visit>> visits{};  ///< open after each step, sorted; empty where nothing senses
};

/// An engine as the hunt sees it.
struct Engine {
  const reference::Backend* backend = nullptr;
  enum class Kind { World, DoubleWorld, Precise, Other } kind = Kind::Other;

  explicit Engine(const reference::Backend& of);
  std::string name() const { return std::string(backend->name()); }
  bool is_world() const { return kind == Kind::World || kind == Kind::DoubleWorld; }
  double epsilon() const;  ///< unit roundoff of its velocities
};

struct RunOptions {
  int refine = 1;           ///< each step in so many
  int restore_at = -1;      ///< step after which a World is saved and goes on as another
  bool flip_sleep = false;  ///< sleep on where it is off, and the other way around
  double seconds = 5;       ///< of processor time, after which the run is given up
};

/// Empty, or why `engine` does not take `one`.
std::string unsupported(const Engine& engine, const Case& one);

/// Runs it. What the engine throws is the motion's failure, but where one in this process says why it goes no
/// further. Precise, whose steps may take any time, runs in a process of its own; it has no samples where it
/// did not come to a sample in time.
Motion run(const Engine& engine, const Case& one, const RunOptions& options = {});

}  // namespace plumb::harness::hunt
