// Every 8 steps a column of 5 groups of 5 ragdolls falls, one group per storey, until there are 40 columns;
// then the oldest column is removed and created anew. 5 storeys of 501 static boxes of 0.5 m, 45 m apart.
// With all columns 11001 bodies and 10000 joints. The time includes creating and destroying bodies.
#include <array>
#include <memory>

#include "bench/field/scenes/ragdoll.h"
#include "bench/field/scenes/scenes.h"

namespace plumb::field {
namespace {

constexpr int kGroupSize = 5;
constexpr double kStorey = 45;  // m
constexpr double kGrid = 0.5;   // m, side of a box of the ground
constexpr double kDrop = 40;    // m, above each storey

struct Extent {
  int storeys, columns, boxes, delay;
  double width() const { return boxes * kGrid; }
};

constexpr Extent kFull{.storeys = 5, .columns = 40, .boxes = 500, .delay = 8};
constexpr Extent kQuick{.storeys = 2, .columns = 6, .boxes = 100, .delay = 8};

/// Bodies of each column, so that a column can be removed.
class Rain {
 public:
  explicit Rain(const Extent& extent) : extent_(extent), bodies_(extent.columns) {}

  void before_step(Builder& world, int step) {
    if (step % extent_.delay != 0) return;
    std::vector<int>& column = bodies_[next_];
    for (const int body : column) world.destroy_body(body);
    column.clear();
    const double pitch = extent_.width() / extent_.columns;
    for (int storey = 0; storey < extent_.storeys; ++storey) {
      for (int i = 0; i < kGroupSize; ++i) {
        const Vec2d position{-extent_.width() / 2 + pitch * (next_ + 0.5) + 0.5 * i,
                             kDrop + kStorey * storey};
        const auto bones = add_ragdoll(world, position, i + 1);
        column.insert(column.end(), bones.begin(), bones.end());
      }
    }
    next_ = (next_ + 1) % extent_.columns;
  }

 private:
  Extent extent_;
  std::vector<std::vector<int>> bodies_;
  int next_ = 0;
};

Built build(Builder& world, bool quick) {
  const Extent& extent = quick ? kQuick : kFull;
  std::vector<ShapeDefinition> ground;
  for (int storey = 0; storey < extent.storeys; ++storey)
    for (int i = 0; i <= extent.boxes; ++i)
      ground.push_back(
          {.geometry = box(kGrid / 2, kGrid / 2, {kGrid * i - extent.width() / 2, kStorey * storey})});
  world.create_body({.type = BodyType::Static}, ground);
  const auto rain = std::make_shared<Rain>(extent);
  return {.before_step = [rain](Builder& in, int step) { rain->before_step(in, step); },
          .tops = {},
          .region = {}};
}

}  // namespace

Scene rain() {
  return {.name = "rain",
          .summary = "ragdolls fall, 1000 at a time, and are taken away",
          .steps = 1000,
          .quick_steps = 120,
          .build = build};
}

}  // namespace plumb::field
