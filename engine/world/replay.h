#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/world/recording/recording_file.h"
#include "engine/world/world.h"

namespace plumb {

struct BodyDifference {
  BodyId body{};
  std::string name{};
};

/// Result of a replay.
struct ReplayReport {
  int calls = 0;           ///< repeated, steps included
  std::int64_t steps = 0;  ///< repeated
  /// Step count of the world after the first step whose resulting state differs; nullopt: all states were
  /// equal.
  std::optional<std::int64_t> first_difference{};
  std::uint64_t recorded_hash = 0, hash = 0;  ///< hashes of the world after the last compared step
  std::vector<BodyDifference> bodies{};       ///< bodies that differ then, if recorded
  std::string message{};                      ///< truncated end, rejected call or missing hook; else empty
};

/// Replays a recording (recorder.h) step by step on a world of its own.
template <class Real>
class Replay {
 public:
  /// Throws Error (Io) if the file cannot be read, Error (Value, "recording") if it is not a recording of
  /// this precision and version.
  explicit Replay(const std::filesystem::path& file, std::function<bool(const ContactReading&)> hook = {});

  /// Repeats all calls up to the next step, makes the step and compares the states. Returns false at the end
  /// of the recording. Throws Error (Value, "recording") for a damaged record, unless it is the last one.
  bool step();

  const BasicWorld<Real>& world() const { return world_; }
  const ReplayReport& report() const { return report_; }

 private:
  void replay_call(std::span<const std::byte> content);
  void compare(std::span<const std::byte> content);
  void add_message(const std::string& message);

  RecordingReader file_;
  std::function<bool(const ContactReading&)> hook_;
  BasicWorld<Real> world_;
  ReplayReport report_;
};

extern template class Replay<float>;
extern template class Replay<double>;

/// Replays a recording until a step differs, or to its end.
template <class Real = float>
ReplayReport replay(const std::filesystem::path& file, std::function<bool(const ContactReading&)> hook = {}) {
  Replay<Real> all(file, std::move(hook));
  while (all.step() && !all.report().first_difference) {
  }
  return all.report();
}

}  // namespace plumb
