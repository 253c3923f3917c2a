#include "harness/hunt/state_watch.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "engine/world/world_data.h"
#include "harness/hunt/shapes_of_world.h"

// Checks how the bodies of a world moved, fell asleep and woke in a step.
namespace plumb::harness::hunt {
namespace {

// Largest difference between the change of momentum along a normal and the impulse, as a fraction of the
// impulse: contacts rotate with the bodies.
constexpr double kBalance = 0.05;
// Tolerance of the speed and the displacement of a body in flight, in roundings of a Real, for a step of 16
// substeps.
constexpr double kFlightRoundings = 200;
// Largest position, speed and angular speed of a world, m, m/s, rad/s.
constexpr double kLargest = 1e12;

}  // namespace

// Checks the motion of bodies without joints and without a touch in the step. Only gravity and applied forces
// may change it, with constant accelerations, which the world integrates exactly; the motion of a kinematic
// body must not change. Any other change requires a reported touch.
template <class Real>
std::string StateWatch<Real>::flights(double dt) const {
  const double rounding = kFlightRoundings * std::numeric_limits<Real>::epsilon() / 2;
  for (const BodyId body : world_.bodies()) {
    const auto known = before_.find(key_of(body));
    if (known == before_.end() || !world_.enabled(body) || !known->second.awake || !world_.awake(body))
      continue;
    const Before& before = known->second;
    const BodyType type = world_.type(body);
    const bool dynamic = type == BodyType::Dynamic;
    if (type == BodyType::Static || dynamic != before.dynamic) continue;
    const BodyLocks locks = world_.locks(body);
    Vec2d gain{};
    double turn = 0;
    if (dynamic) {
      if (before.touched || before.held || met_.contains(key_of(body)) || !world_.joints(body).empty() ||
          !world_.contacts(body).empty() || world_.linear_damping(body) != 0 ||
          world_.angular_damping(body) != 0 || !(before.mass > 0) || world_.mass(body) != before.mass)
        continue;
      gain = dt * (world_.gravity_scale(body) * world_.gravity() + (1 / before.mass) * before.force);
      if (before.inertia > 0) turn = dt * before.torque / before.inertia;
      // Locks take effect on the velocity in the next step.
      if (locks.x) gain.x = -before.velocity.x;
      if (locks.y) gain.y = -before.velocity.y;
    }
    Vec2d way = dt * (before.velocity + 0.5 * gain);
    if (dynamic && locks.x) way.x = 0;
    if (dynamic && locks.y) way.y = 0;
    const Vec2d gone = world_.centre(body) - before.position;
    const double speed = length(before.velocity) + length(gain);
    const Aabb<double> box = world_.box(body);
    // Includes the offset of the centre of mass, whose position is computed from the origin.
    const double size = length(box.upper - box.lower) + length(world_.centre(body) - world_.position(body));
    const double off = length(world_.velocity(body) - before.velocity - gain), strayed = length(gone - way);
    const double spun = std::abs(world_.angular_velocity(body) - before.spin - turn);
    bool stopped = false;
    const bool flies =
        off <= rounding * speed + 1e-30 &&
        strayed <= rounding * (dt * speed + 1e-2 * size) + 1e-12 * length(before.position) + 1e-30;
    if (!flies) {
      // Continuous collision may stop it within the step, in front of an obstacle that it touches in the next
      // one: it then has only a part of its displacement and of its velocity gain.
      const double whole = length(way), part = whole > 0 ? dot(gone, way) / (whole * whole) : 1;
      // Its squared speed may differ by what the forces would have added on the rest of its path.
      const Vec2d now = world_.velocity(body), lost = before.velocity + gain - now;
      const double most = dt > 0 ? 2 * length(gain) / dt * length(way - gone) : 0;
      const bool is_stopped = dynamic && part < 1 &&
                              length(gone - part * way) <= 0.05 * whole + 1e-3 * size &&
                              (length(lost) <= length(gain) * (1 + 1e-3) + 1e-3 * speed ||
                               std::abs(dot(before.velocity, before.velocity) - dot(now, now)) <=
                                   2 * most + 10 * rounding * speed * speed);
      stopped = is_stopped && meets_something(body, length(way));
      if (!stopped)
        return fmt::format(
            "'{}' touches nothing; its velocity is {:.6g}, {:.6g} m/s, not {:.6g}, {:.6g}, and its "
            "displacement {:.6g}, {:.6g} m, not {:.6g}, {:.6g}",
            world_.name(body), world_.velocity(body).x, world_.velocity(body).y, before.velocity.x + gain.x,
            before.velocity.y + gain.y, gone.x, gone.y, way.x, way.y);
    }
    // A locked rotation ignores torques; a spin set by a call is checked below.
    if (!locks.rotation && !stopped && spun > rounding * (std::abs(before.spin) + std::abs(turn)) + 1e-30) {
      return fmt::format("'{}' touches nothing, but its angular velocity is off by {:.3g} rad/s",
                         world_.name(body), spun);
    }
  }
  return {};
}

// Returns true if a shape of another body is within `way` m of one of the body's shapes, apart from the other
// body's displacement in the step.
template <class Real>
bool StateWatch<Real>::meets_something(BodyId body, double way) const {
  for (const ShapeId own : world_.shapes(body)) {
    const Outline outline = outline_in_world(world_, own);
    for (const BodyId other : world_.bodies()) {
      if (other == body || !world_.enabled(other)) continue;
      for (const ShapeId shape : world_.shapes(other)) {
        const Outline of = outline_in_world(world_, shape);
        const auto before = before_.find(key_of(other));
        const double off =
            before != before_.end() ? length(world_.centre(other) - before->second.position) : 0;
        if (separation(outline, of) < kApart * (size_of(outline) + size_of(of)) + way + off) return true;
      }
    }
  }
  return false;
}

// Checks that locked coordinates do not change, whatever velocities calls have set.
template <class Real>
std::string StateWatch<Real>::locks() const {
  for (const BodyId body : world_.bodies()) {
    const auto known = before_.find(key_of(body));
    if (known == before_.end() || world_.type(body) != BodyType::Dynamic || !world_.enabled(body)) continue;
    const BodyLocks locks = world_.locks(body);
    const Vec2d gone = world_.centre(body) - known->second.position;
    if ((locks.x && gone.x != 0) || (locks.y && gone.y != 0))
      return fmt::format("'{}' moves by {:.3g}, {:.3g} m along an axis that is locked", world_.name(body),
                         gone.x, gone.y);
    if (locks.rotation && world_.angle(body) != known->second.angle)
      return fmt::format("'{}' rotates by {:.3g} rad, but its rotation is locked", world_.name(body),
                         world_.angle(body) - known->second.angle);
  }
  return {};
}

// Checks that each body that woke in a step is connected to one that moved, over joints and contacts of
// sleeping bodies.
template <class Real>
std::string StateWatch<Real>::wakings() const {
  std::map<Key, BodyId> woken;
  for (const BodyId body : world_.bodies()) {
    const auto known = before_.find(key_of(body));
    if (known != before_.end() && !known->second.awake && known->second.dynamic && world_.awake(body) &&
        world_.type(body) == BodyType::Dynamic && world_.enabled(body))
      woken[key_of(body)] = body;
  }
  // Flood fill that starts at the bodies that were awake.
  const std::vector<BodyId> bodies = world_.bodies();
  bool spreads = true;
  while (!woken.empty() && spreads) {
    spreads = false;
    for (auto at = woken.begin(); at != woken.end();) {
      const auto moved = [&](Key other) {
        const auto known = before_.find(other);
        if (known == before_.end()) return true;
        const Before& before = known->second;
        // A kinematic body that was moved by calls is awake.
        if (!before.dynamic) return before.awake;
        const auto it =
            std::find_if(bodies.begin(), bodies.end(), [&](BodyId b) { return key_of(b) == other; });
        return before.awake || (!woken.contains(other) && it != bodies.end() && world_.awake(*it));
      };
      bool reached = false;
      for (const JointId joint : world_.joints(at->second)) {
        const auto [a, b] = world_.bodies(joint);
        reached = reached || moved(a == at->second ? key_of(b) : key_of(a));
      }
      for (auto link = links_.lower_bound({at->first, Key{}});
           link != links_.end() && link->first == at->first; ++link)
        reached = reached || moved(link->second);
      for (const ContactReading& contact : world_.contacts(at->second)) {
        const BodyId a = world_.body(contact.shape_a), b = world_.body(contact.shape_b);
        reached = reached || moved(a == at->second ? key_of(b) : key_of(a));
      }
      // A broken joint no longer exists.
      reached = reached || !world_.events().broken.empty();
      if (reached)
        at = woken.erase(at), spreads = true;
      else
        ++at;
    }
  }
  if (woken.empty()) return {};
  return fmt::format("'{}' wakes, but no moving body has reached it", world_.name(woken.begin()->second));
}

// Checks bodies with exactly one contact, with a non-dynamic body at rest. Friction has no component along
// the normal, so their momentum along the normal changes by their weight and the contact's impulse.
template <class Real>
std::string StateWatch<Real>::impulses(double dt) const {
  for (const BodyId body : world_.bodies()) {
    const auto before = before_.find(key_of(body));
    if (before == before_.end() || !before->second.dynamic || world_.type(body) != BodyType::Dynamic ||
        !world_.awake(body) || !before->second.awake || !world_.joints(body).empty() || !world_.enabled(body))
      continue;
    const std::vector<ContactReading> contacts = world_.contacts(body);
    if (contacts.size() != 1 || world_.linear_damping(body) != 0) continue;
    const ContactReading& contact = contacts.front();
    // Other contacts may have begun and ended within the step. Deep overlaps are skipped, because their
    // normal turns during the step and the reading has that of the step's start.
    const double deepest = std::min(contact.separations[0], contact.separations[contact.count - 1]);
    const Aabb<double> box = world_.box(body);
    if (deepest < -0.05 * length(box.upper - box.lower)) continue;
    if (const auto reported =
            [&](const auto& list) {
              return std::any_of(list.begin(), list.end(), [&](const TouchEvent& event) {
                for (const ShapeId shape : {event.shape_a, event.shape_b})
                  if (const auto owner = owners_.find(key_of(shape));
                      owner != owners_.end() && owner->second == body)
                    return true;
                return false;
              });
            };
        reported(world_.events().begin) || reported(world_.events().end))
      continue;
    if (before->second.only != Pair{key_of(contact.shape_a), key_of(contact.shape_b)}) continue;
    const bool is_a = world_.body(contact.shape_a) == body;
    const BodyId other = world_.body(is_a ? contact.shape_b : contact.shape_a);
    const bool counted = world_.hit_events(contact.shape_a) || world_.hit_events(contact.shape_b) ||
                         world_.pre_solve(contact.shape_a) || world_.pre_solve(contact.shape_b);
    const BodyLocks locks = world_.locks(body);
    if (!counted || world_.type(other) != BodyType::Static || locks.x || locks.y) continue;
    const double mass = world_.mass(body);
    if (mass != before->second.mass) continue;
    // Skips bodies that continuous collision stops: their weight does not act in the rest of the step. The
    // path of one that was let go from rest does not show it.
    const double speed = std::min(length(world_.velocity(body)), length(before->second.velocity));
    if (length(world_.centre(body) - before->second.position) < 0.9 * dt * speed) continue;
    const auto& swept = world_.data().scratch.continuous.swept_bodies;
    if (std::any_of(swept.begin(), swept.end(), [&](const SweptBody& each) {
          return each.stopped && each.body == static_cast<int>(body.index);
        }))
      continue;
    const Vec2d n = is_a ? -1.0 * contact.normal : contact.normal;
    const Vec2d gain = world_.velocity(body) - before->second.velocity -
                       dt * world_.gravity_scale(body) * world_.gravity() -
                       (dt / mass) * before->second.force;
    const double off = mass * dot(gain, n) - contact.step_impulse;
    const double bound = kBalance * contact.step_impulse +
                         mass * (0.1 * length(gain) + 0.05 * dt * length(world_.gravity()) +
                                 0.02 * (length(world_.velocity(body)) + length(before->second.velocity)));
    if (contact.step_impulse > 0 && std::abs(off) > bound && std::abs(off) > 1e-6 * mass)
      return fmt::format("'{}' gets an impulse of {:.4g} N s, but its contact reports {:.4g} N s",
                         world_.name(body), mass * dot(gain, n), contact.step_impulse);
  }
  return {};
}

template <class Real>
std::string StateWatch<Real>::limits() const {
  for (const BodyId body : world_.bodies()) {
    if (world_.quarantined(body)) continue;
    const BodyState s = world_.state(body);
    for (const double value :
         {s.position.x, s.position.y, s.angle, s.velocity.x, s.velocity.y, s.angular_velocity})
      if (!(std::abs(value) <= kLargest))
        return fmt::format("'{}' continues with {:.6g}", world_.name(body), value);
  }
  return {};
}

template <class Real>
std::string StateWatch<Real>::moved() const {
  std::vector<BodyId> list(world_.bodies().size());
  list.resize(std::min(list.size(), world_.moved(list)));
  std::set<Key> reported;
  for (const BodyId body : list) reported.insert(key_of(body));
  for (const BodyId body : world_.bodies()) {
    const auto before = before_.find(key_of(body));
    if (before == before_.end() || reported.contains(key_of(body))) continue;
    if (world_.centre(body) != before->second.position || world_.angle(body) != before->second.angle)
      return fmt::format("'{}' moved, but there is no move event", world_.name(body));
  }
  return {};
}

template <class Real>
std::string StateWatch<Real>::sleep_events() const {
  std::set<Key> fell;
  for (const BodyId body : world_.events().fell_asleep) fell.insert(key_of(body));
  for (const BodyId body : world_.bodies()) {
    const auto before = before_.find(key_of(body));
    if (before == before_.end() || world_.type(body) != BodyType::Dynamic || !world_.enabled(body)) continue;
    if (before->second.awake && !world_.awake(body) && !fell.contains(key_of(body)))
      return fmt::format("'{}' fell asleep, but there is no event for it", world_.name(body));
    if (!world_.awake(body) && world_.velocity(body) != Vec2d{} &&
        length(world_.centre(body) - before->second.position) > 0 && !before->second.awake)
      return fmt::format("'{}' moves while asleep", world_.name(body));
  }
  return {};
}

#define PLUMB_FOR(Real)                                                  \
  template std::string StateWatch<Real>::flights(double) const;          \
  template bool StateWatch<Real>::meets_something(BodyId, double) const; \
  template std::string StateWatch<Real>::locks() const;                  \
  template std::string StateWatch<Real>::wakings() const;                \
  template std::string StateWatch<Real>::impulses(double) const;         \
  template std::string StateWatch<Real>::limits() const;                 \
  template std::string StateWatch<Real>::moved() const;                  \
  template std::string StateWatch<Real>::sleep_events() const;
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb::harness::hunt
