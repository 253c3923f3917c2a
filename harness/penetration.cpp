#include "harness/penetration.h"

#include <algorithm>
#include <cmath>

#include "engine/math/trigonometry.h"

namespace plumb::harness {
namespace {

PlacedShape place_shape(const Shape& shape, const BodyState& state) {
  PlacedShape placed;
  placed.centre = state.position + rotation_of(state.angle) * shape.position;
  if (const auto* circle = std::get_if<Circle>(&shape.geometry)) {
    placed.half_width = placed.half_height = circle->radius;
    return placed;
  }
  const auto& box = std::get<Box>(shape.geometry);
  placed.is_circle = false;
  placed.axis = rotation_of(state.angle + shape.angle) * Vec2d{1, 0};
  placed.half_width = box.width / 2;
  placed.half_height = box.height / 2;
  return placed;
}

bool any_pair_passes(const std::vector<Filter>& filters) {
  for (std::size_t i = 0; i < filters.size(); ++i)
    for (std::size_t j = i; j < filters.size(); ++j)
      if (may_touch(filters[i], filters[j])) return true;
  return false;
}

}  // namespace

PenetrationMeter::PenetrationMeter(const Scene& scene) {
  std::vector<Filter> filters;
  bool moves = false;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    for (const Shape& shape : scene.bodies[i].shapes) {
      if (!std::holds_alternative<Circle>(shape.geometry) && !std::holds_alternative<Box>(shape.geometry))
        continue;
      entries_.push_back({i, scene.bodies[i].type == BodyType::Dynamic, &shape});
      moves = moves || entries_.back().moves;
      if (std::find(filters.begin(), filters.end(), shape.filter) == filters.end())
        filters.push_back(shape.filter);
    }
  }
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          const auto a = find_body(scene, j.body_a), b = find_body(scene, j.body_b);
          if (!j.collide && a && b) jointed_.insert(std::minmax(*a, *b));
        },
        joint);
  }
  possible_ = moves && entries_.size() > 1 && any_pair_passes(filters);
  if (possible_ && entries_.size() <= 64) {  // small enough to test every pair
    possible_ = false;
    for (std::size_t i = 0; i < entries_.size(); ++i)
      for (std::size_t j = i + 1; j < entries_.size(); ++j)
        possible_ = possible_ || pair_may_touch(entries_[i], entries_[j]);
  }
}

bool PenetrationMeter::pair_may_touch(const Entry& a, const Entry& b) const {
  return a.body != b.body && (a.moves || b.moves) && may_touch(a.shape->filter, b.shape->filter) &&
         (jointed_.empty() || !jointed_.contains(std::minmax(a.body, b.body)));
}

void PenetrationMeter::place(std::span<const BodyState> states) {
  for (Entry& entry : entries_) {
    entry.placed = place_shape(*entry.shape, states[entry.body]);
    const double half = half_extent(entry.placed, {1, 0});
    entry.low = entry.placed.centre.x - half;
    entry.high = entry.placed.centre.x + half;
  }
  const auto before = [](const Entry& a, const Entry& b) { return a.low < b.low; };
  if (!std::is_sorted(entries_.begin(), entries_.end(), before))
    std::stable_sort(entries_.begin(), entries_.end(), before);
}

double PenetrationMeter::deepest(std::span<const BodyState> states) {
  if (!possible_) return 0;
  place(states);
  double deepest = 0;
  std::vector<const Entry*> open;  // shapes whose interval along x still extends
  for (const Entry& entry : entries_) {
    std::erase_if(open, [&](const Entry* other) { return other->high < entry.low; });
    for (const Entry* other : open) {
      const double half = half_extent(entry.placed, {0, 1}) + half_extent(other->placed, {0, 1});
      if (half - std::abs(entry.placed.centre.y - other->placed.centre.y) <= deepest) continue;
      if (pair_may_touch(entry, *other)) deepest = std::max(deepest, overlap(entry.placed, other->placed));
    }
    open.push_back(&entry);
  }
  return deepest;
}

}  // namespace plumb::harness
