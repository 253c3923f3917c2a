#include "engine/world/character/mover_queries.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/collision/distance/hull_distance.h"
#include "engine/core/text.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"
#include "engine/world/queries/transformed_shape.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

constexpr double kSkinFraction = 0.02;
constexpr double kRightAngle = 0x1.921fb54442d18p+0;

Vec2d unit_up(Vec2d up) {
  require_finite("mover", "up", up);
  require_positive("mover", "up", length(up));
  return (1 / length(up)) * up;
}

double cosine_of(double slope) {
  require_not_negative("mover", "max_slope", slope);
  if (slope > kRightAngle) {
    throw Error(Error::Kind::Value, "mover", "max_slope", shortest(slope), "must be at most pi/2");
  }
  return std::max(rotation_of(slope).c, 1e-3);
}

double skin_of(const MoverOptions& options, double radius) {
  require_not_negative("mover", "skin", options.skin);
  return options.skin > 0 ? options.skin : kSkinFraction * radius;
}

Capsule grown(const Capsule& capsule, double by) { return {capsule.start, capsule.end, capsule.radius + by}; }

}  // namespace

template <class Real>
MoverQueries<Real>::MoverQueries(const BasicWorld<Real>& world, const Capsule& capsule,
                                 const MoverOptions& options)
    : world_(world),
      capsule_(capsule),
      with_skin_(grown(capsule, skin_of(options, capsule.radius))),
      with_quarter_skin_(grown(capsule, 0.25 * skin_of(options, capsule.radius))),
      filter_(options.filter),
      up_(unit_up(options.up)),
      radius_(capsule.radius),
      skin_(skin_of(options, capsule.radius)),
      step_height_(options.step_height),
      max_slope_cosine_(cosine_of(options.max_slope)),
      foot_height_(std::min(dot(capsule.start, up_), dot(capsule.end, up_)) - capsule.radius) {
  require_not_negative("mover", "step_height", options.step_height);
  filter_.sensors = false;
}

template <class Real>
MoverCast MoverQueries<Real>::cast(const QueryShape& shape, Vec2d from, Vec2d displacement,
                                   BodyId ignored) const {
  constexpr double kSliding = 1e-9;  // sine of the angle to a surface up to which a motion counts as along it
  const double distance = length(displacement);
  if (!(distance > 0)) return {from, 0, {}};
  const Vec2d direction = (1 / distance) * displacement;
  double fraction = 1;
  std::optional<MoverContact> first;
  cast_shape(world_, shape, from, 0, displacement, filter_, [&](const CastShapeResult& hit) {
    if (hit.body == ignored) return 1.0;
    MoverContact contact{hit.shape, hit.body, hit.point, hit.normal, skin_};
    if (hit.overlapped) {
      // The mover is already within the skin: it may move only away from the shape or along it.
      const std::optional<MoverContact> current = contact_with(hit.shape, from, displacement);
      if (!current || current->gap < 0) return 1.0;
      contact = *current;
    }
    if (dot(contact.normal, direction) > -kSliding) return 1.0;
    const bool sooner = !first || hit.fraction < fraction ||
                        (hit.fraction == fraction && hit.shape.index < first->shape.index);
    if (sooner) first = contact, fraction = hit.fraction;
    return std::max(fraction, std::numeric_limits<double>::min());
  });
  return {from + fraction * displacement, fraction * distance, first};
}

template <class Real>
std::optional<MoverGround> MoverQueries<Real>::find_ground(Vec2d& position, double max_drop,
                                                           double base) const {
  const MoverCast down = cast(position, -max_drop * up_);
  if (!down.hit) return {};
  const std::optional<MoverGround> ground = ground_at(down.position, *down.hit, base);
  if (ground) position = down.position;
  return ground;
}

template <class Real>
std::optional<MoverGround> MoverQueries<Real>::ground_at(Vec2d position, const MoverContact& contact,
                                                         double base) const {
  constexpr double kUpright = 1e-3;
  constexpr double kEdge = 0.995;  // cosine of 6 degrees: flatter edges, and round ground, count as slopes
  const double rise = dot(contact.normal, up_);
  if (!(rise > kUpright)) return {};
  // The capsule's round end touches a slope, or the edge of a step. A ray behind the edge distinguishes them.
  const Vec2d across = contact.normal - rise * up_;
  if (length(across) > kUpright && is_within_step(contact.point, position, base)) {
    const Vec2d inward = (-1 / length(across)) * across;
    const Vec2d above = contact.point + 0.25 * skin_ * inward + skin_ * up_;
    const std::optional<RayResult> tread = ray_cast_closest(world_, above, -2 * skin_ * up_, filter_);
    const bool is_edge = tread && is_walkable(tread->normal) && dot(tread->normal, contact.normal) < kEdge;
    if (is_edge) return MoverGround{contact, tread->normal, true};
  }
  if (!is_walkable(contact.normal)) return {};
  return MoverGround{contact, contact.normal, false};
}

template <class Real>
std::optional<MoverContact> MoverQueries<Real>::contact_with(ShapeId shape, Vec2d position,
                                                             Vec2d velocity) const {
  const WorldData<Real>& w = world_.data();
  const int index = static_cast<int>(shape.index);
  const TransformedShape target(w, index, position);
  const Convex<double> other = target.convex(), own = capsule_.convex();
  const HullDistance hulls = hull_distance(other, own, Pose<double>{}, nullptr);
  const double gap = hulls.separation - (other.radius + own.radius);
  const BodyId body = world_.body(shape);
  if (w.forms[index].chain) {
    const Vec2d front = other.corners[0].normal;
    const bool in_front = hulls.separation > 0 && dot(front, hulls.normal) > 1e-9 &&
                          dot(front, capsule_.middle() - other.corners[0].point) > 0;
    if (!in_front || gap < -0.5 * radius_) return {};
    const Vec2d relative = velocity - world_.velocity_at(body, position + hulls.point_a);
    if (gap < 0 && dot(relative, front) > 0) return {};
  }
  return MoverContact{shape, body, position + hulls.point_a + other.radius * hulls.normal, hulls.normal, gap};
}

template <class Real>
std::optional<MoverContact> MoverQueries<Real>::deepest(Vec2d position, Vec2d velocity) const {
  std::optional<MoverContact> worst;
  overlap_shape(world_, with_skin_, position, 0, filter_, [&](ShapeId shape) {
    const std::optional<MoverContact> contact = contact_with(shape, position, velocity);
    if (!contact || contact->gap >= 0.75 * skin_) return true;
    const bool deeper = !worst || contact->gap < worst->gap ||
                        (contact->gap == worst->gap && shape.index < worst->shape.index);
    if (deeper) worst = contact;
    return true;
  });
  return worst;
}

template class MoverQueries<float>;
template class MoverQueries<double>;

}  // namespace plumb
