#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/world/debug_draw.h"

namespace plumb::web {

/// Records drawing commands as a sequence of numbers, for a reader outside C++. Each command is its own
/// number, the number of its role (as in DrawRole), and
///     0 polygon: radius, number of corners, their x and y
///     1 circle: x, y, radius, x and y of its axis
///     2 capsule: x and y of both ends, radius
///     3 segment: x and y of both ends
///     4 point: x, y
///     5 text: x, y, and its offset and length in `words`, in bytes
/// Outlines drawn over the bodies, such as those of other engines, have kGhost plus their index instead of a
/// role.
class CommandBuffer : public DebugDraw {
 public:
  void clear() {
    numbers_.clear();
    words_.clear();
  }
  void begin_ghost(std::size_t ghost) { ghost_ = kGhost + static_cast<int>(ghost); }
  void end_ghost() { ghost_ = 0; }
  static constexpr int kGhost = 100;

  const std::vector<double>& numbers() const { return numbers_; }
  const std::string& words() const { return words_; }

  void polygon(std::span<const Vec2d> corners, double radius, DrawRole role) override {
    put(0, role, {radius, static_cast<double>(corners.size())});
    for (const Vec2d& corner : corners) numbers_.insert(numbers_.end(), {corner.x, corner.y});
  }
  void circle(Vec2d centre, double radius, Vec2d axis, DrawRole role) override {
    put(1, role, {centre.x, centre.y, radius, axis.x, axis.y});
  }
  void capsule(Vec2d start, Vec2d end, double radius, DrawRole role) override {
    put(2, role, {start.x, start.y, end.x, end.y, radius});
  }
  void segment(Vec2d start, Vec2d end, DrawRole role) override {
    put(3, role, {start.x, start.y, end.x, end.y});
  }
  void point(Vec2d point, DrawRole role) override { put(4, role, {point.x, point.y}); }
  void text(Vec2d point, std::string_view text, DrawRole role) override {
    const auto begin = static_cast<double>(words_.size()), size = static_cast<double>(text.size());
    put(5, role, {point.x, point.y, begin, size});
    words_ += text;
  }

 private:
  void put(int command, DrawRole role, std::initializer_list<double> rest) {
    numbers_.push_back(command);
    numbers_.push_back(ghost_ != 0 ? ghost_ : static_cast<double>(role));
    numbers_.insert(numbers_.end(), rest);
  }

  int ghost_ = 0;
  std::vector<double> numbers_;
  std::string words_;
};

}  // namespace plumb::web
