#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/simulation/precise_flight.h"
#include "engine/simulation/precise_motion.h"
#include "engine/simulation/precise_smooth.h"
#include "engine/simulation/snapshot.h"

namespace plumb::precise {

/// Limits and motors of joints, by events located in time as those of contacts are. A limit that is met takes
/// the approach away (no restitution) and is a constraint for as long as it pushes; a motor is a constraint
/// at its speed for as long as its force suffices, and a constant force else. Which of them hold is decided
/// at events by a complementarity problem in the accelerations.
class Stops {
 public:
  Stops(const Scene& scene, const Parts& parts, EquationsOfMotion& equations, SmoothMotion& smooth);

  bool empty() const { return count_ == 0; }

  /// At the time where the motion has stopped: after events, jumps of forces and changes from outside.
  void settle();
  bool settled() const { return settled_; }
  void unsettle() { settled_ = false; }

  /// Cuts the last step at its first event, and is unsettled then.
  void stop();

  std::int64_t impacts() const { return impacts_; }

  void save(SnapshotWriter& out) const;
  void restore(SnapshotReader& in);

 private:
  using Mode = EquationsOfMotion::StopMode;
  struct Event {
    double time = 0;
    std::optional<std::size_t> met;  // a limit
  };
  /// Rows that take part at an instant, with what unit forces along them change, and their rates.
  struct Problem {
    std::vector<std::size_t> stops;
    ContactResponse response;
    std::vector<double> matrix, rate, least, most;
  };

  void look();
  double rate_of(std::size_t stop) const;
  bool at_end(std::size_t stop) const;
  Problem problem(const std::vector<std::size_t>& stops);
  std::vector<double> solve(const Problem& p, std::vector<Mode>& modes) const;
  void strike();
  void decide();
  std::optional<Event> first_event();
  void refine(std::size_t stop);
  void evaluate(double time, std::span<double> values);

  EquationsOfMotion& equations_;
  SmoothMotion& smooth_;
  std::size_t count_;
  double length_, speed_;  // the scene's
  bool settled_ = false;
  std::vector<Mode> modes_;
  std::optional<std::size_t> met_;  // the limit that the last step ended at
  std::vector<Row<double>> rows_;   // at the motion's time
  std::vector<Twist<double>> twists_;
  std::vector<double> tolerance_, scratch_;
  double force_scale_ = 0;
  Compensated sample_;
  std::int64_t impacts_ = 0;
  double last_event_ = -1;
  int events_at_once_ = 0;
};

}  // namespace plumb::precise
