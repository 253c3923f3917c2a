#pragma once

#include <cstddef>
#include <deque>
#include <span>
#include <vector>

namespace plumb::window {

/// The last states of a demo, oldest first, as many as there is memory for.
class History {
 public:
  explicit History(std::size_t most_bytes = std::size_t{96} << 20) : most_bytes_(most_bytes) {}

  void clear();
  void push(std::vector<std::byte> state);
  /// Removes the newest state and returns the one before it. If there is none, returns an empty span and
  /// keeps the newest.
  std::span<const std::byte> back();
  std::size_t size() const { return states_.size(); }

 private:
  std::deque<std::vector<std::byte>> states_;
  std::size_t bytes_ = 0, most_bytes_;
};

}  // namespace plumb::window
