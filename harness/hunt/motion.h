#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/hunt/case.h"
#include "harness/hunt/run_mode.h"
#include "reference/backend.h"

namespace plumb::harness::hunt {

/// State of every body after a step, in the scene's order.
struct Sample {
  std::vector<BodyState> states{};
  std::vector<bool> present{};  ///< true if the body exists
  std::vector<bool> asleep{};
};

/// A sensor overlap reported by the engine: the sensor's and the visitor's body index.
struct Visit {
  std::size_t sensor = 0, visitor = 0;
  friend auto operator<=>(const Visit&, const Visit&) = default;
};

/// A run, sampled after each step; the first sample is the start.
struct Motion {
  double dt = 0;  ///< s, from sample to sample
  std::vector<Sample> samples{};
  std::string failure{};  ///< reason for a premature end; empty if there is none
  std::string stopped{};  ///< the engine's own reason for ending prematurely; empty if there is none
  /// Begin and end events that do not match, with their time.
  struct EventFault {
    double time = 0;
    std::string what;
  };
  std::vector<EventFault> event_faults{};
  std::vector<std::vector<Visit>> visits{};  ///< open after each step, sorted; empty without sensors
  std::vector<double> costs{};               ///< s, processor time of each step of a World
  std::vector<Digest> digests{};             ///< of a World after each step, if asked for
  std::string broken_promise{};  ///< first promise that a World in a run mode broke; empty if it broke none
};

/// An engine with its kind and precision.
struct Engine {
  const reference::Backend* backend = nullptr;
  enum class Kind { World, DoubleWorld, Precise, Other } kind = Kind::Other;

  explicit Engine(const reference::Backend& of);
  std::string name() const { return std::string(backend->name()); }
  bool is_world() const { return kind == Kind::World || kind == Kind::DoubleWorld; }
  double epsilon() const;  ///< unit roundoff of its velocities
};

struct RunOptions {
  int refine = 1;                     ///< steps per step of the case
  bool flip_sleep = false;            ///< turns sleep on if it is off, and off if it is on
  RunMode mode = RunMode::Plain;      ///< of a World
  bool digests = false;               ///< fills `Motion::digests`
  std::optional<double> tolerance{};  ///< of an engine that chooses its own steps; empty: its default
  double seconds = 2;                 ///< limit of processor time
};

/// Returns why `engine` does not support `one`; empty if it does.
std::string unsupported(const Engine& engine, const Case& one);

/// Runs the case. Exceptions of the engine become the motion's failure, or `stopped` if the engine itself
/// gives up with a reason. Precise may take arbitrarily long, so it runs in a process of its own; its motion
/// is empty if that process exceeds the limit.
Motion run(const Engine& engine, const Case& one, const RunOptions& options = {});

}  // namespace plumb::harness::hunt
