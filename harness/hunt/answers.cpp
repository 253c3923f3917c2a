#include "harness/hunt/answers.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "engine/world/queries.h"
#include "harness/hunt/outline.h"
#include "harness/hunt/random.h"

namespace plumb::harness::hunt {
namespace {

// Tolerance, as a fraction of the sizes of both shapes and the length of a cast: a hundred times the error of
// shapes and rotations rounded to floats.
constexpr double kRounding = 2e-5;
constexpr int kQueries = 12, kPlaces = 8;

struct Known {
  ShapeId id;
  std::string body;
  Outline outline;
  Vec2d middle{};
  double size = 0;  // m
};

template <class Real>
std::vector<Known> known_shapes(const BasicWorld<Real>& world) {
  std::vector<Known> out;
  for (const BodyId body : world.bodies()) {
    if (!world.enabled(body)) continue;
    const BodyState at{.position = world.position(body), .angle = world.angle(body)};
    for (const ShapeId id : world.shapes(body)) {
      const ShapeDefinition definition = world.definition(id);
      if (definition.sensor || definition.filter.mask == 0 || world.valid(world.chain(id))) continue;
      Shape shape;
      shape.position = definition.position, shape.angle = definition.angle;
      std::visit([&](const auto& geometry) { shape.geometry = geometry; }, definition.geometry);
      const Outline local = outlines_of(shape).front();
      Known known{.id = id, .body = world.name(body), .outline = placed(local, at)};
      known.middle = 0.5 * (known.outline.low + known.outline.high);
      known.size = length(known.outline.high - known.outline.low);
      out.push_back(std::move(known));
    }
  }
  return out;
}

Outline point_at(Vec2d at) { return placed({{{0, 0}}, 0}, {.position = at}); }

/// Draws queries of a world and judges their answers.
template <class Real>
class Questions {
 public:
  Questions(const BasicWorld<Real>& world, std::uint64_t seed)
      : world_(world), random_(seed, 0), known_(known_shapes(world)) {}

  std::string first_wrong() {
    if (known_.empty()) return {};
    for (int i = 0; i < kQueries; ++i)
      for (const auto& ask : {&Questions::ray, &Questions::cast, &Questions::overlaps, &Questions::near_point,
                              &Questions::between, &Questions::filtered})
        if (std::string wrong = (this->*ask)(); !wrong.empty()) return wrong;
    return {};
  }

 private:
  const Known& some() {
    return known_[static_cast<std::size_t>(random_.whole(0, static_cast<int>(known_.size()) - 1))];
  }
  Vec2d off(double most) { return {random_.within(-most, most), random_.within(-most, most)}; }
  const Known* find(ShapeId id) const {
    const auto at =
        std::find_if(known_.begin(), known_.end(), [&](const Known& each) { return each.id == id; });
    return at != known_.end() ? &*at : nullptr;
  }
  double tolerance(const Known& shape, double others) const { return kRounding * (shape.size + others); }

  std::string ray() {
    const Known& target = some();
    const Vec2d from = target.middle + off(2 * target.size), way = target.middle + off(target.size) - from;
    const auto hit = ray_cast_closest(world_, from, way);
    const double far = length(way);
    if (hit)
      if (const Known* met = find(hit->shape)) {
        const double apart = std::abs(separation(point_at(hit->point), met->outline));
        if (apart > tolerance(*met, far))
          return fmt::format("a ray hits '{}' {:.3g} m off its surface", met->body, apart);
      }
    for (const Known& each : known_) {
      const double slack = tolerance(each, far),
                   part = (hit ? hit->fraction : 1) - (far > 0 ? slack / far : 0);
      if (part <= 0 || separation(point_at(from), each.outline) < slack) continue;
      const double apart = separation(placed({{from, from + part * way}, 0}, {}), each.outline);
      if (apart < -slack) return fmt::format("a ray passes through '{}', {:.3g} m inside", each.body, -apart);
    }
    return {};
  }

  ShapeGeometry some_geometry(double size) {
    if (random_.chance(0.4)) return Circle{size};
    if (random_.chance(0.5)) return Box{2 * size, size};
    return Capsule{{-size, 0}, {size, 0}, 0.3 * size};
  }
  static Outline outline_of(const ShapeGeometry& geometry) {
    Shape shape;
    std::visit([&](const auto& each) { shape.geometry = each; }, geometry);
    return outlines_of(shape).front();
  }

  std::string cast() {
    const Known& target = some();
    const double size = target.size * random_.within(0.05, 0.5), angle = random_.within(-3, 3);
    const ShapeGeometry geometry = some_geometry(size);
    const Vec2d from = target.middle + off(2 * target.size), way = target.middle + off(target.size) - from;
    const auto hit = cast_shape_closest(world_, QueryShape(geometry), from, angle, way);
    const Outline moving = outline_of(geometry);
    const auto at = [&](double part) {
      return placed(moving, {.position = from + part * way, .angle = angle});
    };
    const double others = length(way) + 3 * size;
    if (hit)
      if (const Known* met = find(hit->shape)) {
        const double apart = separation(at(hit->fraction), met->outline);
        if (apart > tolerance(*met, others) || (!hit->overlapped && apart < -tolerance(*met, others)))
          return fmt::format("a shape cast stops at '{}' {:.3g} m {}", met->body, std::abs(apart),
                             apart > 0 ? "early" : "late");
      }
    for (const Known& each : known_) {
      if (separation(at(0), each.outline) < tolerance(each, others)) continue;
      for (int k = 1; k <= kPlaces; ++k) {
        const double apart = separation(at((hit ? hit->fraction : 1) * k / kPlaces), each.outline);
        if (apart < -tolerance(each, others))
          return fmt::format("a shape cast passes through '{}', {:.3g} m inside", each.body, -apart);
      }
    }
    return {};
  }

  std::string overlaps() {
    const Known& target = some();
    const double size = target.size * random_.within(0.05, 1), angle = random_.within(-3, 3);
    const ShapeGeometry geometry = some_geometry(size);
    const Vec2d at = target.middle + off(target.size);
    std::vector<ShapeId> found;
    overlap_shape(world_, QueryShape(geometry), at, angle, {}, found);
    const Outline own = placed(outline_of(geometry), {.position = at, .angle = angle});
    for (const Known& each : known_) {
      const double apart = separation(own, each.outline);
      const bool is_found = std::find(found.begin(), found.end(), each.id) != found.end();
      if (std::abs(apart) <= tolerance(each, 3 * size) || is_found == (apart < 0)) continue;
      return fmt::format("an overlap {} '{}', {:.3g} m {}", is_found ? "has" : "misses", each.body,
                         std::abs(apart), apart > 0 ? "away" : "inside");
    }
    return {};
  }

  // Makes the query see a shape by a random rule: one of 64 categories.
  std::string filtered() {
    const Known& target = some();
    QueryFilter filter;
    const auto some_bit = [&] { return std::uint64_t{1} << random_.whole(0, 63); };
    const Filter own = world_.filter(target.id);
    if (random_.chance(0.6))
      filter.mask = random_.chance(0.5) ? some_bit() : own.category << 32 | own.category >> 32;
    if (random_.chance(0.5)) filter.category = random_.chance(0.5) ? some_bit() : ~some_bit();
    if (random_.chance(0.3)) filter.ignore = world_.body(target.id);
    std::vector<ShapeId> found;
    const Vec2d reach{2 * target.size, 2 * target.size};
    overlap_box(world_, {target.middle - reach, target.middle + reach}, filter, found);
    for (const Known& each : known_) {
      const Filter of = world_.filter(each.id);
      const bool seen = (of.category & filter.mask) != 0 && (of.mask & filter.category) != 0 &&
                        !(world_.body(each.id) == filter.ignore);
      const bool is_found = std::find(found.begin(), found.end(), each.id) != found.end();
      const bool inside =
          each.outline.low.x > target.middle.x - reach.x && each.outline.high.x < target.middle.x + reach.x &&
          each.outline.low.y > target.middle.y - reach.y && each.outline.high.y < target.middle.y + reach.y;
      if (is_found && !seen) return fmt::format("a query finds '{}', which its filter excludes", each.body);
      if (inside && seen && !is_found)
        return fmt::format("a query misses '{}', which its filter accepts", each.body);
    }
    return {};
  }

  std::string near_point() {
    const Known& target = some();
    const Vec2d at = target.middle + off(2 * target.size);
    const auto found = nearest(world_, at, 4 * target.size);
    for (const Known& each : known_) {
      const double apart = separation(point_at(at), each.outline), slack = tolerance(each, 4 * target.size);
      if (apart < 4 * target.size - slack && (!found || found->distance > apart + slack))
        return fmt::format("'{}' is {:.3g} m away, but is not reported as the nearest", each.body, apart);
      if (found && found->shape == each.id && std::abs(found->distance - apart) > slack)
        return fmt::format("the nearest shape, '{}', is {:.3g} m away, not {:.3g}", each.body, apart,
                           found->distance);
    }
    return {};
  }

  std::string between() {
    const Known &a = some(), &b = some();
    if (a.id == b.id) return {};
    const double apart = separation(a.outline, b.outline), answer = distance(world_, a.id, b.id).distance;
    if (std::abs(answer - apart) <= tolerance(a, b.size + std::abs(apart))) return {};
    return fmt::format("'{}' and '{}' are {:.3g} m apart, not {:.3g}", a.body, b.body, apart, answer);
  }

  const BasicWorld<Real>& world_;
  Random random_;
  std::vector<Known> known_;
};

}  // namespace

template <class Real>
std::string wrong_answer(const BasicWorld<Real>& world, std::uint64_t seed) {
  return Questions<Real>(world, seed).first_wrong();
}
template std::string wrong_answer(const BasicWorld<float>&, std::uint64_t);
template std::string wrong_answer(const BasicWorld<double>&, std::uint64_t);

}  // namespace plumb::harness::hunt
