#pragma once

#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/driver/driver.h"
#include "engine/scene/scene.h"

namespace plumb::reference {

/// One scene running in one engine.
class Simulator {
 public:
  using Sink = std::function<void(double time, std::span<const BodyState> states)>;

  virtual ~Simulator() = default;

  /// Advances by `steps` steps of dt. Returns the wall time the engine spent, in ns, without any transport.
  virtual double advance(int steps) = 0;

  virtual double time() const = 0;  ///< s since the start

  /// Reads the state of every body, in the scene's order; `out` has one element per body.
  virtual void read(std::span<BodyState> out) const = 0;

  /// Returns the engine's own statistics so far, as name/value pairs: steps, events, estimated error.
  /// Empty if it has none.
  virtual std::vector<std::pair<std::string, std::string>> report() const { return {}; }

  /// Advances `samples` times by `every` steps and passes each resulting state to `sink`. Returns ns as
  /// `advance`.
  virtual double record(int samples, int every, std::size_t bodies, const Sink& sink);

  /// Returns the forces of joints and contacts now. Throws `Error` (Unsupported) if the engine does not
  /// provide them.
  virtual Reactions forces() const;
};

}  // namespace plumb::reference
