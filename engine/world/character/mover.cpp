#include "engine/world/mover.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/trigonometry.h"
#include "engine/world/character/mover_queries.h"
#include "engine/world/character/plane_solver.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

// Maximum number of surfaces hit in one move, and of iterations to resolve overlaps. Corners need fewer.
constexpr int kMaxSlides = 16;
constexpr int kMaxPushes = 8;
// Maximum number of pieces of one walk: each ends at a step, a bend of the ground or a drop. A step takes one
// to three, so a move climbs at least 20 steps; a longer motion stops there until the
// next move.
constexpr int kMaxPieces = 64;
// Skins: accuracy of the place up to which a piece of a walk leads, and the least advance onto a step. It is
// far above the rounding of casts, and narrower treads cannot be told from a wall.
constexpr double kPlaceAccuracy = 0.1;
// Maximum number of halvings to find that place. 2^40 accuracies are further than any world is wide.
constexpr int kMaxHalvings = 40;

// Half planes of one move.
struct Planes {
  std::array<HalfPlane, 2 * kMaxSlides> items{};
  std::size_t count = 0;
  void add(HalfPlane plane) {
    if (count < items.size()) items[count++] = plane;
  }
  Vec2d nearest(Vec2d target) const { return solve_planes(std::span(items.data(), count), target).point; }
};

// One move. Position and velocity are the current ones.
template <class Real>
class Move {
 public:
  Move(const BasicWorld<Real>& world, const Capsule& capsule, const MoverOptions& options, double dt)
      : world_(world), options_(options), queries_(world, capsule, options), dt_(dt) {}

  MoverResult run(Vec2d position, Vec2d velocity) {
    position_ = position, velocity_ = velocity;
    push_out();
    detect_ground();
    const double press_speed = std::max(0.0, -dot(velocity_, queries_.up()));
    remaining_ = dt_;
    advance();
    if (!ground_) try_to_land();
    while (ground_ && !snap_to_ground(press_speed)) {
      if (descend()) {
        advance();
      } else {
        leave_ground();
      }
    }
    if (ground_) move_with_ground();
    finish();
    return std::move(result_);
  }

 private:
  // Straight part of a walk, without what bends it.
  struct Piece {
    Vec2d start{}, direction{};
    double distance = 0, speed = 0;  // m, m/s >= 0
    double remaining = 0;            // s, at the start
  };
  // Place that a piece of a walk leads to.
  struct Place {
    double distance = 0;
    Vec2d position{};
    MoverGround ground{};
  };

  void push_out();
  void detect_ground();
  void advance();
  bool walk();
  bool fly();
  bool step_up(double speed);
  bool descend();
  template <class PlaceAt>
  Place farthest(Place nearest, double unreachable, const PlaceAt& place_at) const;
  void change_ground(const MoverGround& ground);
  void land(const MoverGround& ground);
  void try_to_land();
  double max_drop() const { return queries_.step_height() + 2 * queries_.skin(); }
  bool snap_to_ground(double press_speed);
  void leave_ground();
  void move_with_ground();
  void finish();

  Vec2d velocity_of(const MoverContact& contact) const;
  double record_hit(const MoverContact& contact, Vec2d velocity);
  void add_obstacle(const MoverContact& contact, Vec2d velocity);

  const BasicWorld<Real>& world_;
  const MoverOptions& options_;
  MoverQueries<Real> queries_;
  double dt_, remaining_ = 0;
  Vec2d position_{}, velocity_{};
  std::optional<MoverGround> ground_{};
  Piece piece_{};  // the last one walked
  int pieces_ = 0, slides_ = 0;
  Planes overlap_planes_{};  // overlaps that it could not leave
  Planes contact_planes_{};  // current contacts, for the displacement
  Planes hit_planes_{};      // all contacts of the move, for the velocity
  MoverResult result_{};
};

// Returns the velocity of the ground's surface. The surface moves along (n.y, -n.x), to the right of someone
// standing on it.
template <class Real>
Vec2d Move<Real>::velocity_of(const MoverContact& contact) const {
  const double surface = world_.material(contact.shape).surface_speed;
  return world_.velocity_at(contact.body, contact.point) - surface * perpendicular(contact.normal);
}

// Pushes the mover out of overlaps, the deepest first. Each overlap adds its half plane, and the displacement
// is the shortest one into all half planes. If none reaches all of them, moves as far as obstacles permit.
template <class Real>
void Move<Real>::push_out() {
  const Vec2d start = position_;
  Planes all;
  for (int push = 0; push < kMaxPushes; ++push) {
    const std::optional<MoverContact> deepest = queries_.deepest(position_, velocity_);
    if (!deepest) return;
    const double offset = dot(deepest->normal, position_ - start) + queries_.skin() - deepest->gap;
    all.add({deepest->normal, offset});
    const MoverCast cast = queries_.cast_quarter_skin(position_, start + all.nearest({}) - position_);
    position_ = cast.position;
    // No further into the obstacle.
    if (cast.hit) all.add({cast.hit->normal, dot(cast.hit->normal, position_ - start)});
  }
  const std::optional<MoverContact> remaining_overlap = queries_.deepest(position_, velocity_);
  if (!remaining_overlap || remaining_overlap->gap >= 0) return;
  result_.squeezed = true;
  overlap_planes_.add({remaining_overlap->normal, 0});
}

template <class Real>
void Move<Real>::detect_ground() {
  const bool leaves = dot(velocity_, queries_.up()) > 0;
  Vec2d standing = position_;
  const std::optional<MoverGround> ground = queries_.find_ground(standing, 2 * queries_.skin());
  if (!ground) return;
  if (leaves) {
    velocity_ += velocity_of(ground->contact);
  } else {
    position_ = standing, ground_ = ground;
  }
}

// Records a hit at `velocity` (relative to the world) and its impulse. Returns the surface's speed along the
// normal after the hit.
template <class Real>
double Move<Real>::record_hit(const MoverContact& contact, Vec2d velocity) {
  const Vec2d normal = contact.normal;
  const double surface = dot(normal, world_.velocity_at(contact.body, contact.point));
  const double approach_speed = surface - dot(normal, velocity);
  for (const MoverHit& hit : result_.hits) {
    if (hit.shape == contact.shape && dot(hit.normal, normal) > 0.999) return surface;
  }
  double impulse = 0, velocity_change = 0;
  if (options_.mass > 0 && approach_speed > 0 && world_.type(contact.body) == BodyType::Dynamic) {
    // The hit is inelastic: both continue at one speed, within the force limit.
    const double lever = cross(contact.point - world_.centre(contact.body), normal);
    const double inertia = world_.inertia(contact.body);
    const double inverse_effective_mass =
        1 / world_.mass(contact.body) + (inertia > 0 ? lever * lever / inertia : 0);
    impulse =
        std::min(options_.push_force * dt_, approach_speed / (1 / options_.mass + inverse_effective_mass));
    velocity_change = impulse * inverse_effective_mass;
  }
  result_.hits.push_back({contact.shape, contact.body, contact.point, normal, impulse});
  return surface - velocity_change;
}

template <class Real>
void Move<Real>::add_obstacle(const MoverContact& contact, Vec2d velocity) {
  const double speed = std::min(0.0, record_hit(contact, velocity));
  contact_planes_.add({contact.normal, 0});
  hit_planes_.add({contact.normal, speed});
  // A surface that is too steep to walk on must not be climbed in the air either, so it also acts as a
  // vertical wall.
  const double rise = dot(contact.normal, queries_.up());
  const Vec2d across = contact.normal - rise * queries_.up();
  if (rise > 0 && !queries_.is_walkable(contact.normal) && length(across) > 0) {
    const double flat = length(across);
    contact_planes_.add({(1 / flat) * across, 0});
    hit_planes_.add({(1 / flat) * across, speed / flat});
  }
}

template <class Real>
void Move<Real>::land(const MoverGround& ground) {
  const Vec2d ground_velocity = velocity_of(ground.contact);
  record_hit(ground.contact, velocity_);
  velocity_ = hit_planes_.nearest(velocity_) - ground_velocity;
  velocity_ = dot(velocity_, queries_.right()) * queries_.right();
  ground_ = ground;
  contact_planes_.count = hit_planes_.count = 0;
}

// Lands if there is ground within the distance that detect_ground() searches.
template <class Real>
void Move<Real>::try_to_land() {
  if (dot(velocity_, queries_.up()) > 0) return;
  const std::optional<MoverGround> ground = queries_.find_ground(position_, 2 * queries_.skin());
  if (ground) land(*ground);
}

// Moves until the end of the motion, or until an obstacle stops it.
template <class Real>
void Move<Real>::advance() {
  while (remaining_ > 0 && pieces_ < kMaxPieces && slides_ < kMaxSlides) {
    ++(ground_ ? pieces_ : slides_);
    const bool unfinished = ground_ ? walk() : fly();
    if (!unfinished) return;
  }
}

// Moves in the air: straight, or along current contacts. Returns false at the end of the move.
template <class Real>
bool Move<Real>::fly() {
  Vec2d clipped_velocity = contact_planes_.nearest(velocity_);
  if (overlap_planes_.count > 0) clipped_velocity = overlap_planes_.nearest(clipped_velocity);
  const double max_distance = remaining_ * length(clipped_velocity);
  if (!(max_distance > 1e-9 * queries_.skin())) return false;
  const MoverCast cast = queries_.cast(position_, remaining_ * clipped_velocity);
  position_ = cast.position;
  if (!cast.hit) return false;
  remaining_ *= 1 - cast.travelled / max_distance;
  if (cast.travelled > queries_.skin()) contact_planes_.count = 0;
  const bool rises = dot(clipped_velocity, queries_.up()) > 0;
  const std::optional<MoverGround> ground = rises ? std::nullopt : queries_.ground_at(position_, *cast.hit);
  if (ground) {
    land(*ground);
  } else {
    add_obstacle(*cast.hit, clipped_velocity);
  }
  return true;
}

// Moves along the ground and up steps, until an obstacle stops it. Returns false at the end of the move.
template <class Real>
bool Move<Real>::walk() {
  const double speed = dot(velocity_, queries_.right());
  const Vec2d direction = (speed < 0 ? 1.0 : -1.0) * perpendicular(ground_->floor);
  const double max_distance = remaining_ * std::abs(speed);
  if (!(max_distance > 1e-9 * queries_.skin())) return false;
  if (overlap_planes_.count > 0 && dot(overlap_planes_.items[0].normal, direction) < 0) {
    velocity_ = {};
    return false;
  }
  const MoverCast cast = queries_.cast(position_, max_distance * direction);
  piece_ = {position_, direction, cast.travelled, std::abs(speed), remaining_};
  position_ = cast.position;
  remaining_ *= 1 - cast.travelled / max_distance;
  if (!cast.hit) return false;
  const std::optional<MoverGround> ground = queries_.ground_at(position_, *cast.hit);
  const bool slope = queries_.is_walkable(cast.hit->normal);
  if (ground && !ground->edge) {
    change_ground(*ground);
    return true;
  }
  // Its obstacle may stand further down, at the foot of a drop that it must follow first.
  if (cast.travelled > queries_.skin()) {
    Vec2d standing = position_;
    if (!queries_.find_ground(standing, max_drop()) && descend()) return true;
  }
  if (step_up(speed)) return true;
  if (slope) {
    change_ground({*cast.hit, cast.hit->normal, false});
    return true;
  }
  // If the surface recedes, the mover follows it at that speed.
  const Vec2d ground_velocity = velocity_of(ground_->contact);
  const double surface = record_hit(*cast.hit, std::abs(speed) * direction + ground_velocity);
  const double receding = std::max(0.0, dot(cast.hit->normal, ground_velocity) - surface);
  const double allowed = receding / std::max(-dot(cast.hit->normal, direction), 1e-3);
  if (allowed < std::abs(speed)) velocity_ = (speed < 0 ? -allowed : allowed) * queries_.right();
  return false;
}

// Climbs a step: tries to move up, ahead and down again. If that leads to ground no higher than a step, moves
// there and returns true. If the whole motion leads onto something higher, as on stairs, or to no ground, it
// leads as far as that does not happen; the next piece climbs from there.
template <class Real>
bool Move<Real>::step_up(double speed) {
  const double max_distance = remaining_ * std::abs(speed), height = queries_.step_height();
  if (!(height > 0) || !(max_distance > 0)) return false;
  const MoverCast rise = queries_.cast(position_, height * queries_.up());
  const MoverCast ahead = queries_.cast(rise.position, remaining_ * speed * queries_.right());
  if (!(ahead.travelled > 1e-3 * queries_.skin())) return false;
  const Vec2d direction = (speed < 0 ? -1.0 : 1.0) * queries_.right();
  // Uphill, the mover touches the slope ahead of its lowest point, and the step rises from there.
  const bool uphill = !ground_->edge && dot(ground_->floor, direction) < 0;
  const double base = uphill ? queries_.contact_height(ground_->floor) : 0;
  const auto below = [&](double distance, Vec2d standing) -> std::optional<Place> {
    const std::optional<MoverGround> ground =
        queries_.find_ground(standing, rise.travelled + 2 * queries_.skin(), base);
    if (!ground || !queries_.is_within_step(ground->contact.point, position_, base)) return {};
    return Place{distance, standing, *ground};
  };
  const auto place_at = [&](double distance) {
    return below(distance, rise.position + distance * direction);
  };
  std::optional<Place> place = below(ahead.travelled, ahead.position);
  if (!place) {
    const double least = kPlaceAccuracy * queries_.skin();
    if (!(ahead.travelled > least)) return false;
    place = place_at(least);
    if (!place) return false;
    place = farthest(*place, ahead.travelled, place_at);
  }
  position_ = place->position;
  remaining_ *= 1 - place->distance / max_distance;
  change_ground(place->ground);
  return true;
}

// Returns the place farthest along a piece, between one that is reached and a distance that is not.
template <class Real>
template <class PlaceAt>
typename Move<Real>::Place Move<Real>::farthest(Place nearest, double unreachable,
                                                const PlaceAt& place_at) const {
  for (int i = 0; i < kMaxHalvings; ++i) {
    if (unreachable - nearest.distance <= kPlaceAccuracy * queries_.skin()) break;
    const double middle = 0.5 * (nearest.distance + unreachable);
    if (const std::optional<Place> place = place_at(middle)) {
      nearest = *place;
    } else {
      unreachable = middle;
    }
  }
  return nearest;
}

// Follows the ground down where the last piece of the walk leads over more than one step, as on stairs. Goes
// back to the last place of the piece with ground no lower than a step, and returns true. If there is no
// further ground from that place, the mover comes to an edge that it falls off: returns false.
template <class Real>
bool Move<Real>::descend() {
  if (!(piece_.distance > queries_.skin())) return false;
  const auto place_at = [&](double distance) -> std::optional<Place> {
    Vec2d standing = piece_.start + distance * piece_.direction;
    const std::optional<MoverGround> ground = queries_.find_ground(standing, max_drop());
    if (!ground) return {};
    return Place{distance, standing, *ground};
  };
  const Place place = farthest({}, piece_.distance, place_at);
  if (!(place.distance > 0)) return false;
  Vec2d beyond = place.position + 2 * kPlaceAccuracy * queries_.skin() * piece_.direction;
  if (!queries_.find_ground(beyond, max_drop())) return false;
  position_ = place.position;
  remaining_ = piece_.remaining - place.distance / piece_.speed;
  change_ground(place.ground);
  piece_ = {};
  return true;
}

// Sets the ground. The velocity becomes relative to the new ground.
template <class Real>
void Move<Real>::change_ground(const MoverGround& ground) {
  if (ground.contact.shape != ground_->contact.shape) {
    velocity_ += velocity_of(ground_->contact) - velocity_of(ground.contact);
  }
  ground_ = ground;
}

// Follows the ground down by up to a step's height. Returns false if there is none.
template <class Real>
bool Move<Real>::snap_to_ground(double press_speed) {
  const std::optional<MoverGround> ground = queries_.find_ground(position_, max_drop());
  if (!ground) return false;
  change_ground(*ground);
  velocity_ = dot(velocity_, queries_.right()) * queries_.right();
  record_hit(ground->contact, velocity_of(ground->contact) - press_speed * queries_.up());
  return true;
}

template <class Real>
void Move<Real>::leave_ground() {
  velocity_ = dot(velocity_, queries_.right()) * queries_.right() + velocity_of(ground_->contact);
  ground_.reset();
}

// Carries the mover with the ground's motion during dt. The contact point moves on a circle about the body's
// centre, which moves on a line. Every other body stops the mover.
template <class Real>
void Move<Real>::move_with_ground() {
  const MoverContact& contact = ground_->contact;
  const Vec2d centre = world_.centre(contact.body), arm = contact.point - centre;
  const Vec2d centre_velocity = world_.velocity(contact.body);
  const Vec2d at_point = world_.velocity_at(contact.body, contact.point);
  const Vec2d on_surface = velocity_of(contact) - at_point;
  const Vec2d by_rotation = rotation_of(dt_ * world_.angular_velocity(contact.body)) * arm - arm;
  position_ =
      queries_.cast(position_, dt_ * (centre_velocity + on_surface) + by_rotation, contact.body).position;
}

template <class Real>
void Move<Real>::finish() {
  result_.position = position_;
  result_.velocity = velocity_;
  if (ground_) {
    result_.on_ground = true;
    result_.ground_normal = ground_->floor;
    result_.ground = ground_->contact.body;
    result_.ground_velocity = velocity_of(ground_->contact);
    return;
  }
  if (overlap_planes_.count > 0) hit_planes_.add(overlap_planes_.items[0]);
  result_.velocity = hit_planes_.nearest(velocity_);
}

}  // namespace

template <class Real>
MoverResult move(const BasicWorld<Real>& world, const Capsule& capsule, Vec2d position, Vec2d velocity,
                 double dt, const MoverOptions& options) {
  require_finite("mover", "position", position);
  require_finite("mover", "velocity", velocity);
  require_positive("mover", "dt", dt);
  require_not_negative("mover", "mass", options.mass);
  require_not_negative("mover", "push_force", options.push_force);
  return Move<Real>(world, capsule, options, dt).run(position, velocity);
}

template <class Real>
void apply_pushes(BasicWorld<Real>& world, const MoverResult& result) {
  for (const MoverHit& hit : result.hits) {
    if (hit.impulse > 0) world.apply_impulse(hit.body, -hit.impulse * hit.normal, hit.point);
  }
}

#define PLUMB_FOR(Real)                                                                    \
  template MoverResult move(const BasicWorld<Real>&, const Capsule&, Vec2d, Vec2d, double, \
                            const MoverOptions&);                                          \
  template void apply_pushes(BasicWorld<Real>&, const MoverResult&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
