#include "engine/world/mover.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/math/trigonometry.h"
#include "engine/world/character/mover_senses.h"
#include "engine/world/character/plane_solver.h"
#include "engine/world/state/validate.h"

namespace plumb {
namespace {

// Maximum number of surfaces hit in one move, and of iterations to resolve overlaps. Corners need fewer.
constexpr int kMostRounds = 16;
constexpr int kMostPushes = 8;

// Half planes of one move.
struct Planes {
  std::array<HalfPlane, 2 * kMostRounds> items{};
  std::size_t count = 0;
  void add(HalfPlane plane) {
    if (count < items.size()) items[count++] = plane;
  }
  Vec2d nearest(Vec2d wanted) const { return solve_planes(std::span(items.data(), count), wanted).point; }
};

// One move. Position and velocity are the current ones.
template <class Real>
class Move {
 public:
  Move(const BasicWorld<Real>& world, const Capsule& capsule, const MoverOptions& options, double dt)
      : world_(world), options_(options), senses_(world, capsule, options), dt_(dt) {}

  MoverResult run(Vec2d position, Vec2d velocity) {
    position_ = position, velocity_ = velocity;
    push_out();
    feel_ground();
    const double press = std::max(0.0, -dot(velocity_, senses_.up()));
    remaining_ = dt_;
    for (int round = 0; round < kMostRounds && remaining_ > 0; ++round) {
      const bool goes_on = ground_ ? walk() : fly();
      if (!goes_on) break;
    }
    if (!ground_) touch_down();
    if (ground_) stay_on_ground(press);
    if (ground_) ride();
    finish();
    return std::move(result_);
  }

 private:
  void push_out();
  void feel_ground();
  bool walk();
  bool fly();
  bool step_up(double speed);
  void change_ground(const MoverGround& ground);
  void land(const MoverGround& ground);
  void touch_down();
  void stay_on_ground(double press);
  void ride();
  void finish();

  Vec2d velocity_of(const MoverContact& contact) const;
  double note_hit(const MoverContact& contact, Vec2d velocity);
  void block(const MoverContact& contact, Vec2d velocity);

  const BasicWorld<Real>& world_;
  const MoverOptions& options_;
  MoverSenses<Real> senses_;
  double dt_, remaining_ = 0;
  Vec2d position_{}, velocity_{};
  std::optional<MoverGround> ground_{};
  Planes held_{};     // overlaps that it could not leave
  Planes touched_{};  // current contacts, for the displacement
  Planes met_{};      // all contacts of the move, for the velocity
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
  for (int push = 0; push < kMostPushes; ++push) {
    const std::optional<MoverContact> deepest = senses_.deepest(position_, velocity_);
    if (!deepest) return;
    const double least = dot(deepest->normal, position_ - start) + senses_.skin() - deepest->gap;
    all.add({deepest->normal, least});
    const MoverPath path = senses_.squeeze(position_, start + all.nearest({}) - position_);
    position_ = path.position;
    // No further into the obstacle.
    if (path.stop) all.add({path.stop->normal, dot(path.stop->normal, position_ - start)});
  }
  const std::optional<MoverContact> left = senses_.deepest(position_, velocity_);
  if (!left || left->gap >= 0) return;
  result_.squeezed = true;
  held_.add({left->normal, 0});
}

template <class Real>
void Move<Real>::feel_ground() {
  const bool leaves = dot(velocity_, senses_.up()) > 0;
  Vec2d standing = position_;
  const std::optional<MoverGround> ground = senses_.find_ground(standing, 2 * senses_.skin());
  if (!ground) return;
  if (leaves) {
    velocity_ += velocity_of(ground->contact);
  } else {
    position_ = standing, ground_ = ground;
  }
}

// Records a hit at `velocity` (relative to the world), with its impulse. Returns the surface's speed along
// the normal afterwards.
template <class Real>
double Move<Real>::note_hit(const MoverContact& contact, Vec2d velocity) {
  const Vec2d normal = contact.normal;
  const double surface = dot(normal, world_.velocity_at(contact.body, contact.point));
  const double closing = surface - dot(normal, velocity);
  for (const MoverHit& hit : result_.hits) {
    if (hit.shape == contact.shape && dot(hit.normal, normal) > 0.999) return surface;
  }
  double impulse = 0, gained = 0;
  if (options_.mass > 0 && closing > 0 && world_.type(contact.body) == BodyType::Dynamic) {
    // The hit is inelastic: both continue at one speed, within the force limit.
    const double lever = cross(contact.point - world_.centre(contact.body), normal);
    const double inertia = world_.inertia(contact.body);
    const double gives = 1 / world_.mass(contact.body) + (inertia > 0 ? lever * lever / inertia : 0);
    impulse = std::min(options_.push_force * dt_, closing / (1 / options_.mass + gives));
    gained = impulse * gives;
  }
  result_.hits.push_back({contact.shape, contact.body, contact.point, normal, impulse});
  return surface - gained;
}

template <class Real>
void Move<Real>::block(const MoverContact& contact, Vec2d velocity) {
  const double speed = std::min(0.0, note_hit(contact, velocity));
  touched_.add({contact.normal, 0});
  met_.add({contact.normal, speed});
  // A surface that is too steep to walk on must not be climbed in the air either, so it also acts as a
  // vertical wall.
  const double rise = dot(contact.normal, senses_.up());
  const Vec2d across = contact.normal - rise * senses_.up();
  if (rise > 0 && !senses_.is_walkable(contact.normal) && length(across) > 0) {
    const double flat = length(across);
    touched_.add({(1 / flat) * across, 0});
    met_.add({(1 / flat) * across, speed / flat});
  }
}

template <class Real>
void Move<Real>::land(const MoverGround& ground) {
  const Vec2d ground_velocity = velocity_of(ground.contact);
  note_hit(ground.contact, velocity_);
  velocity_ = met_.nearest(velocity_) - ground_velocity;
  velocity_ = dot(velocity_, senses_.right()) * senses_.right();
  ground_ = ground;
  touched_.count = met_.count = 0;
}

// Lands on ground within the distance that feel_ground() searches.
template <class Real>
void Move<Real>::touch_down() {
  if (dot(velocity_, senses_.up()) > 0) return;
  const std::optional<MoverGround> ground = senses_.find_ground(position_, 2 * senses_.skin());
  if (ground) land(*ground);
}

// Moves in the air: straight, or along current contacts. Returns false at the end of the move.
template <class Real>
bool Move<Real>::fly() {
  Vec2d going = touched_.nearest(velocity_);
  if (held_.count > 0) going = held_.nearest(going);
  const double whole = remaining_ * length(going);
  if (!(whole > 1e-9 * senses_.skin())) return false;
  const MoverPath path = senses_.go(position_, remaining_ * going);
  position_ = path.position;
  if (!path.stop) return false;
  remaining_ *= 1 - path.travelled / whole;
  if (path.travelled > senses_.skin()) touched_.count = 0;
  const bool rises = dot(going, senses_.up()) > 0;
  const std::optional<MoverGround> ground = rises ? std::nullopt : senses_.ground_at(position_, *path.stop);
  if (ground) {
    land(*ground);
  } else {
    block(*path.stop, going);
  }
  return true;
}

// Moves along the ground and up steps, until an obstacle stops it. Returns false at the end of the move.
template <class Real>
bool Move<Real>::walk() {
  const double speed = dot(velocity_, senses_.right());
  const Vec2d direction = (speed < 0 ? 1.0 : -1.0) * perpendicular(ground_->floor);
  const double whole = remaining_ * std::abs(speed);
  if (!(whole > 1e-9 * senses_.skin())) return false;
  if (held_.count > 0 && dot(held_.items[0].normal, direction) < 0) {
    velocity_ = {};
    return false;
  }
  const MoverPath path = senses_.go(position_, whole * direction);
  position_ = path.position;
  remaining_ *= 1 - path.travelled / whole;
  if (!path.stop) return false;
  const std::optional<MoverGround> ground = senses_.ground_at(position_, *path.stop);
  const bool slope = senses_.is_walkable(path.stop->normal);
  if (ground && !ground->edge) {
    change_ground(*ground);
    return true;
  }
  if (step_up(speed)) return true;
  if (slope) {
    change_ground({*path.stop, path.stop->normal, false});
    return true;
  }
  // If the surface recedes, the mover follows it at that speed.
  const Vec2d ground_velocity = velocity_of(ground_->contact);
  const double surface = note_hit(*path.stop, std::abs(speed) * direction + ground_velocity);
  const double receding = std::max(0.0, dot(path.stop->normal, ground_velocity) - surface);
  const double allowed = receding / std::max(-dot(path.stop->normal, direction), 1e-3);
  if (allowed < std::abs(speed)) velocity_ = (speed < 0 ? -allowed : allowed) * senses_.right();
  return false;
}

// Climbs a step: tries to move up, ahead and down again. If that leads to ground no higher than a step, moves
// there and returns true.
template <class Real>
bool Move<Real>::step_up(double speed) {
  const double whole = remaining_ * std::abs(speed), height = senses_.step_height();
  if (!(height > 0) || !(whole > 0)) return false;
  const MoverPath rise = senses_.go(position_, height * senses_.up());
  const MoverPath ahead = senses_.go(rise.position, remaining_ * speed * senses_.right());
  if (!(ahead.travelled > 1e-3 * senses_.skin())) return false;
  Vec2d standing = ahead.position;
  const std::optional<MoverGround> ground =
      senses_.find_ground(standing, rise.travelled + 2 * senses_.skin());
  if (!ground || !senses_.is_within_step(ground->contact.point, position_)) return false;
  position_ = standing;
  remaining_ *= 1 - ahead.travelled / whole;
  change_ground(*ground);
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

// Follows the ground down by up to a step's height, or leaves it.
template <class Real>
void Move<Real>::stay_on_ground(double press) {
  const std::optional<MoverGround> ground =
      senses_.find_ground(position_, senses_.step_height() + 2 * senses_.skin());
  if (!ground) {
    velocity_ = dot(velocity_, senses_.right()) * senses_.right() + velocity_of(ground_->contact);
    ground_.reset();
    return;
  }
  change_ground(*ground);
  velocity_ = dot(velocity_, senses_.right()) * senses_.right();
  note_hit(ground->contact, velocity_of(ground->contact) - press * senses_.up());
}

// Carries the mover with the ground's motion during dt. The contact point moves on a circle about the body's
// centre, which moves on a line. Every other body stops the mover.
template <class Real>
void Move<Real>::ride() {
  const MoverContact& contact = ground_->contact;
  const Vec2d centre = world_.centre(contact.body), arm = contact.point - centre;
  const Vec2d centre_velocity = world_.velocity(contact.body);
  const Vec2d at_point = world_.velocity_at(contact.body, contact.point);
  const Vec2d on_surface = velocity_of(contact) - at_point;
  const Vec2d turned = rotation_of(dt_ * world_.angular_velocity(contact.body)) * arm - arm;
  position_ = senses_.go(position_, dt_ * (centre_velocity + on_surface) + turned, contact.body).position;
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
  if (held_.count > 0) met_.add(held_.items[0]);
  result_.velocity = met_.nearest(velocity_);
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
