#include "demos/window/history.h"

#include <utility>

namespace plumb::window {

void History::clear() {
  states_.clear();
  bytes_ = 0;
}

void History::push(std::vector<std::byte> state) {
  bytes_ += state.size();
  states_.push_back(std::move(state));
  while (bytes_ > most_bytes_ && states_.size() > 2) {
    bytes_ -= states_.front().size();
    states_.pop_front();
  }
}

std::span<const std::byte> History::back() {
  if (states_.size() < 2) return {};
  bytes_ -= states_.back().size();
  states_.pop_back();
  return states_.back();
}

}  // namespace plumb::window
