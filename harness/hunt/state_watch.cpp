#include "harness/hunt/state_watch.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <fmt/format.h>

#include "engine/world/world_data.h"
#include "harness/hunt/shapes_of_world.h"

namespace plumb::harness::hunt {
namespace {

template <class Tag>
std::pair<std::uint32_t, std::uint32_t> key_of(Handle<Tag> handle) {
  return {handle.index, handle.generation};
}

// Fraction of the sizes of both shapes: a hundred times the error of shapes and rotations that are rounded to
// floats.
constexpr double kRounding = 2e-5;
// Depth from which shapes must be in contact, as a fraction of the smaller width, and distance beyond which
// they must be in none, as a fraction of their sizes. Contacts of a step are found before its bodies move, so
// the displacement of a step is added.
constexpr double kDeep = 0.02, kApart = 0.02;
// Largest difference of a change of momentum along a normal from the impulse, as a fraction of that: contacts
// turn with the bodies.
constexpr double kBalance = 0.05;
// rad, largest rotation in a step of bodies that are checked: beyond it angles are rounded.
constexpr double kWhirl = 3;
// Tolerance of the speed and the displacement of a body in flight, in roundings of a Real, for a step of 16
// substeps.
constexpr double kFlightRoundings = 200;
// Largest position, speed and angular speed of a world, m, m/s, rad/s.
constexpr double kLargest = 1e12;

double size_of(const Outline& outline) { return length(outline.high - outline.low); }

}  // namespace

template <class Real>
StateWatch<Real>::StateWatch(const BasicWorld<Real>& world) : world_(world) {
  for (const BodyId body : world.bodies())
    for (const ContactReading& contact : world.contacts(body))
      open_.insert(std::minmax(key_of(contact.shape_a), key_of(contact.shape_b)));
}

template <class Real>
void StateWatch<Real>::before_step() {
  before_.clear();
  std::set<Key> touched;
  for (const BodyId body : world_.bodies())
    for (const ShapeId shape : world_.shapes(body)) owners_[key_of(shape)] = body;
  for (const Pair& pair : open_)
    for (const Key& shape : {pair.first, pair.second})
      if (const auto owner = owners_.find(shape); owner != owners_.end())
        touched.insert(key_of(owner->second));
  for (const BodyId body : world_.bodies()) {
    before_[key_of(body)] = {
        world_.centre(body),
        world_.velocity(body),
        world_.angle(body),
        world_.angular_velocity(body),
        world_.awake(body),
        world_.type(body) == BodyType::Dynamic,
        world_.mass(body),
        world_.data().loads.get(static_cast<int>(body.index)).force.template as<double>(),
        static_cast<double>(world_.data().loads.get(static_cast<int>(body.index)).torque),
        world_.inertia(body)};
    const std::vector<ContactReading> contacts = world_.contacts(body);
    before_[key_of(body)].held = !world_.joints(body).empty();
    before_[key_of(body)].touched = !contacts.empty() || touched.contains(key_of(body));
    if (contacts.size() == 1)
      before_[key_of(body)].only = {key_of(contacts.front().shape_a), key_of(contacts.front().shape_b)};
  }
}

template <class Real>
std::string StateWatch<Real>::after_step(double dt) {
  // Turns of so many a step are not counted to a part of one. Of what a joint holds they may be taken back
  // within the step: as many as its way has sizes.
  for (const BodyId body : world_.bodies()) {
    const auto before = before_.find(key_of(body));
    if (before == before_.end()) continue;
    const double speed = std::max(length(world_.velocity(body)), length(before->second.velocity));
    const Aabb<double> box = world_.box(body);
    if (std::abs(world_.angle(body) - before->second.angle) > kWhirl ||
        (!world_.joints(body).empty() && dt * speed > kWhirl * length(box.upper - box.lower)))
      whirled_.insert(key_of(body));
  }
  // Asks large worlds less often: most checks cost as much as a step or more.
  const bool asks_all = world_.step_count() % (1 + world_.counts().shapes / 8) == 0;
  struct Check {
    const char* name;
    std::function<std::string()> check;
    bool always = false;
  };
  const Check checks[] = {{"impulses", [&] { return impulses(dt); }, true},
                          {"touches", [&] { return touches(); }, true},
                          {"flights", [&] { return flights(dt); }, true},
                          {"locks", [&] { return locks(); }},
                          {"wakings", [&] { return wakings(); }, true},
                          {"counts", [&] { return counts(); }},
                          {"moves", [&] { return moved(); }},
                          {"sleep", [&] { return sleep_events(); }},
                          {"islands", [&] { return islands(); }},
                          {"sensors", [&] { return sensors(); }},
                          {"joints", [&] { return joints(); }},
                          {"boxes", [&] { return boxes(); }},
                          {"limits", [&] { return limits(); }},
                          {"distances", [&] { return distances(dt); }}};
  for (const Check& each : checks) {
    if (!each.always && !asks_all) continue;
    if (std::string wrong = each.check(); !wrong.empty()) {
      failed_ = each.name;
      return wrong;
    }
  }
  return {};
}

template <class Real>
std::string StateWatch<Real>::counts() const {
  const WorldCounts counts = world_.counts();
  int bodies = 0, shapes = 0;
  std::set<Key> joints;
  for (const BodyId body : world_.bodies()) {
    ++bodies;
    shapes += static_cast<int>(world_.shapes(body).size());
    for (const JointId joint : world_.joints(body)) joints.insert(key_of(joint));
  }
  if (counts.bodies != bodies || counts.shapes != shapes || counts.joints != static_cast<int>(joints.size()))
    return fmt::format("counts {} bodies, {} shapes, {} joints, and lists {}, {}, {}", counts.bodies,
                       counts.shapes, counts.joints, bodies, shapes, joints.size());
  return {};
}

template <class Real>
std::string StateWatch<Real>::moved() const {
  std::vector<BodyId> list(world_.bodies().size());
  list.resize(std::min(list.size(), world_.moved(list)));
  std::set<Key> told;
  for (const BodyId body : list) told.insert(key_of(body));
  for (const BodyId body : world_.bodies()) {
    const auto before = before_.find(key_of(body));
    if (before == before_.end() || told.contains(key_of(body))) continue;
    if (world_.centre(body) != before->second.position || world_.angle(body) != before->second.angle)
      return fmt::format("'{}' moved, and is not told to have", world_.name(body));
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
      return fmt::format("'{}' fell asleep, and is not told to have", world_.name(body));
    if (!world_.awake(body) && world_.velocity(body) != Vec2d{} &&
        length(world_.centre(body) - before->second.position) > 0 && !before->second.awake)
      return fmt::format("'{}' moves asleep", world_.name(body));
  }
  return {};
}

template <class Real>
std::string StateWatch<Real>::touches() {
  const Events& events = world_.events();
  std::map<Pair, int> change;
  met_.clear(), links_.clear();
  const auto meet = [&](const Pair& pair) {
    const auto a = owners_.find(pair.first), b = owners_.find(pair.second);
    if (a == owners_.end() || b == owners_.end()) return;
    const Key one = key_of(a->second), other = key_of(b->second);
    met_.insert(one), met_.insert(other), links_.insert({one, other}), links_.insert({other, one});
  };
  for (const Pair& pair : open_) meet(pair);
  for (const auto* list : {&events.begin, &events.end})
    for (const TouchEvent& event : *list) meet({key_of(event.shape_a), key_of(event.shape_b)});
  for (const TouchEvent& event : events.begin)
    ++change[std::minmax(key_of(event.shape_a), key_of(event.shape_b))];
  for (const TouchEvent& event : events.end)
    --change[std::minmax(key_of(event.shape_a), key_of(event.shape_b))];
  for (const auto& [pair, by] : change) {
    const int open = (open_.contains(pair) ? 1 : 0) + by;
    if (open < 0 || open > 1)
      return open < 0 ? "a touch ends that had not begun" : "a touch begins that had begun";
    if (open == 1) open_.insert(pair);
    if (open == 0) open_.erase(pair);
  }
  return {};
}

// Checks the motion of bodies without joints and without a touch in the step. Only gravity and applied forces
// may change it, with constant accelerations, which the world integrates exactly; nothing changes that of a
// kinematic body. Another change requires a reported touch.
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
      // Locks end a velocity in the next step.
      if (locks.x) gain.x = -before.velocity.x;
      if (locks.y) gain.y = -before.velocity.y;
    }
    Vec2d way = dt * (before.velocity + 0.5 * gain);
    if (dynamic && locks.x) way.x = 0;
    if (dynamic && locks.y) way.y = 0;
    const Vec2d gone = world_.centre(body) - before.position;
    const double speed = length(before.velocity) + length(gain);
    const Aabb<double> box = world_.box(body);
    // Includes the way to the centre, whose place is computed from the origin.
    const double size = length(box.upper - box.lower) + length(world_.centre(body) - world_.position(body));
    const double off = length(world_.velocity(body) - before.velocity - gain), strayed = length(gone - way);
    const double spun = std::abs(world_.angular_velocity(body) - before.spin - turn);
    bool stopped = false;
    const bool flies =
        off <= rounding * speed + 1e-30 &&
        strayed <= rounding * (dt * speed + 1e-2 * size) + 1e-12 * length(before.position) + 1e-30;
    if (!flies) {
      // Continuous collision may stop it within the step, in front of what it meets in the next one: a part
      // of its way, and of what it would have gained.
      const double whole = length(way), part = whole > 0 ? dot(gone, way) / (whole * whole) : 1;
      // Slower by no more than what the forces would have done on the rest of its way.
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
            "'{}' touches nothing and flies on at {:.6g}, {:.6g} m/s, not {:.6g}, {:.6g}, by {:.6g}, {:.6g} "
            "m, not "
            "{:.6g}, {:.6g}",
            world_.name(body), world_.velocity(body).x, world_.velocity(body).y, before.velocity.x + gain.x,
            before.velocity.y + gain.y, gone.x, gone.y, way.x, way.y);
    }
    // A lock keeps moments from turning a body; a spin that calls give it is the next check's.
    if (!locks.rotation && !stopped && spun > rounding * (std::abs(before.spin) + std::abs(turn)) + 1e-30) {
      return fmt::format("'{}' touches nothing, and its spin is {:.3g} rad/s off that of its flight",
                         world_.name(body), spun);
    }
  }
  return {};
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
      return fmt::format("'{}' turns by {:.3g} rad, and its rotation is locked", world_.name(body),
                         world_.angle(body) - known->second.angle);
  }
  return {};
}

// Returns true if a shape of another body is within `way` m of one of the body's, or moved off it in the
// step.
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
  // Spreads from what was awake.
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
      // A joint that broke has gone.
      reached = reached || !world_.events().broken.empty();
      if (reached)
        at = woken.erase(at), spreads = true;
      else
        ++at;
    }
  }
  if (woken.empty()) return {};
  return fmt::format("'{}' wakes, and nothing that moved has reached it", world_.name(woken.begin()->second));
}

// Checks that touching pairs have begun to touch, and that pairs far apart have ended. Contacts are found
// where a step begins, so shapes may have moved as far as a step takes them.
template <class Real>
std::string StateWatch<Real>::distances(double dt) {
  struct Placed {
    ShapeId shape{};
    BodyId body{};
    Outline outline{};
    double way = 0;  // m, in a step
  };
  std::vector<Placed> all;
  for (const BodyId body : world_.bodies()) {
    const auto before = before_.find(key_of(body));
    if (before == before_.end() || !world_.enabled(body)) continue;
    for (const ShapeId shape : world_.shapes(body)) {
      if (world_.sensor(shape) || world_.valid(world_.chain(shape))) continue;
      Placed one{shape, body, outline_in_world(world_, shape)};
      const double speed = std::max(length(world_.velocity(body)), length(before->second.velocity)),
                   spin = std::max(std::abs(world_.angular_velocity(body)), std::abs(before->second.spin));
      const Aabb<double> box = world_.box(body);
      one.way = dt * (speed + spin * (length(box.upper - box.lower) + size_of(one.outline)) +
                      dt * length(world_.gravity())) +
                length(world_.centre(body) - before->second.position);
      all.push_back(std::move(one));
    }
  }
  std::map<Pair, int> wrong;
  // Returns true in the third step in which something is wrong with a pair: what calls have just put
  // somewhere is found a step later.
  const auto lasts = [&](const Pair& pair) {
    const auto known = wrong_.find(pair);
    return (wrong[pair] = known != wrong_.end() ? known->second + 1 : 1) >= 3;
  };
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const Placed &a = all[i], &b = all[j];
      if (a.body == b.body) continue;
      const double way = a.way + b.way + kApart * (size_of(a.outline) + size_of(b.outline));
      const Pair pair = std::minmax(key_of(a.shape), key_of(b.shape));
      const bool open = open_.contains(pair);
      const bool far = a.outline.low.x > b.outline.high.x || a.outline.low.y > b.outline.high.y ||
                       b.outline.low.x > a.outline.high.x || b.outline.low.y > a.outline.high.y;
      if (!open && far) continue;
      const double apart = separation(a.outline, b.outline);
      if (open && apart > way && (world_.awake(a.body) || world_.awake(b.body))) {
        if (!lasts(pair)) continue;
        return fmt::format("a touch of '{}' and '{}' does not end, {:.3g} m away", world_.name(a.body),
                           world_.name(b.body), apart);
      }
      if (open || apart > -kDeep * std::min(width_of(a.outline), width_of(b.outline)) - a.way - b.way ||
          !may_touch(world_.filter(a.shape), world_.filter(b.shape)) || is_held(a.body, b.body) ||
          (world_.type(a.body) != BodyType::Dynamic && world_.type(b.body) != BodyType::Dynamic) ||
          (!world_.awake(a.body) && !world_.awake(b.body)))
        continue;
      // A point in two shapes at once, also of one body, may be taken for the other's, so only pairs that lie
      // alone are judged.
      const auto meets_others = [&](const Placed& one, const Placed& other) {
        return std::any_of(all.begin(), all.end(), [&](const Placed& third) {
          return third.shape != one.shape && third.shape != other.shape &&
                 separation(third.outline, one.outline) < one.way + kApart * size_of(one.outline);
        });
      };
      if (meets_others(a, b) || meets_others(b, a) || !lasts(pair)) continue;
      return fmt::format("'{}' and '{}' lie in each other by {:.3g} m, and no touch has begun",
                         world_.name(a.body), world_.name(b.body), -apart);
    }
  wrong_ = std::move(wrong);
  return {};
}

// Joints keep the bodies that they join from colliding, unless they say otherwise.
template <class Real>
bool StateWatch<Real>::is_held(BodyId one, BodyId other) const {
  for (const JointId joint : world_.joints(one)) {
    const auto [a, b] = world_.bodies(joint);
    if ((a == other || b == other) && !world_.definition(joint).collide) return true;
  }
  return false;
}

// Checks that bodies that touch or are joined sleep as a whole.
template <class Real>
std::string StateWatch<Real>::islands() const {
  const auto differs = [&](BodyId a, BodyId b) {
    return world_.type(a) == BodyType::Dynamic && world_.type(b) == BodyType::Dynamic && world_.enabled(a) &&
           world_.enabled(b) && world_.awake(a) != world_.awake(b);
  };
  for (const BodyId body : world_.bodies()) {
    for (const JointId joint : world_.joints(body)) {
      const auto [a, b] = world_.bodies(joint);
      if (differs(a, b))
        return fmt::format("of '{}' and '{}', which a joint holds, one sleeps", world_.name(a),
                           world_.name(b));
    }
    for (const ContactReading& contact : world_.contacts(body)) {
      const double least = contact.count > 1 ? std::min(contact.separations[0], contact.separations[1])
                                             : contact.separations[0];
      if (contact.count == 0 || least > 0 || world_.sensor(contact.shape_a) || world_.sensor(contact.shape_b))
        continue;
      const BodyId a = world_.body(contact.shape_a), b = world_.body(contact.shape_b);
      if (differs(a, b))
        return fmt::format("of '{}' and '{}', which touch, one sleeps", world_.name(a), world_.name(b));
    }
  }
  return {};
}

template <class Real>
std::string StateWatch<Real>::sensors() const {
  for (const BodyId body : world_.bodies()) {
    for (const ShapeId sensor : world_.shapes(body)) {
      if (!world_.sensor(sensor) || !world_.enabled(body)) continue;
      const std::vector<ShapeId> seen = world_.overlapping(sensor);
      const Outline own = outline_in_world(world_, sensor);
      for (const BodyId other : world_.bodies()) {
        if (other == body || !world_.enabled(other)) continue;
        if (world_.type(other) == BodyType::Static && world_.type(body) == BodyType::Static) continue;
        for (const ShapeId shape : world_.shapes(other)) {
          if (world_.sensor(shape) || !may_touch(world_.filter(sensor), world_.filter(shape))) continue;
          const Outline outline = outline_in_world(world_, shape);
          const double apart = separation(own, outline);
          const double slack = kRounding * (size_of(own) + size_of(outline) +
                                            1e-3 * length(world_.centre(body) - world_.centre(other)));
          const bool is_seen = std::find(seen.begin(), seen.end(), shape) != seen.end();
          if (std::abs(apart) <= slack || is_seen == (apart < 0)) continue;
          return fmt::format("a sensor of '{}' {} '{}', {:.3g} m {}", world_.name(body),
                             is_seen ? "sees" : "does not see", world_.name(other), std::abs(apart),
                             apart > 0 ? "away" : "inside");
        }
      }
    }
  }
  return {};
}

template <class Real>
std::string StateWatch<Real>::joints() const {
  std::map<Key, JointLoadEvent> told;
  for (const JointLoadEvent& event : world_.events().loaded) told[key_of(event.joint)] = event;
  for (const BodyId body : world_.bodies())
    for (const JointId joint : world_.joints(body)) {
      const auto [a, b] = world_.bodies(joint);
      if (a != body || !world_.enabled(a) || !world_.enabled(b)) continue;
      const JointReading reading = world_.read(joint);
      const JointDefinition definition = world_.definition(joint);
      // Loads of sleepers are those of before, and are not told again.
      const auto is_awake = [&](BodyId of) {
        const auto before = before_.find(key_of(of));
        return before != before_.end() && before->second.dynamic && before->second.awake && world_.awake(of);
      };
      const bool awake = is_awake(a) || is_awake(b);
      const auto beyond = [](double load, double limit, double share) {
        return limit > 0 && load > limit * (1 + share);
      };
      const bool surely = beyond(reading.force, definition.report_force, 1e-5) ||
                          beyond(reading.torque, definition.report_torque, 1e-5);
      const bool perhaps = beyond(reading.force, definition.report_force, -1e-5) ||
                           beyond(reading.torque, definition.report_torque, -1e-5);
      const bool is_told = told.contains(key_of(joint));
      if (awake && (is_told ? !perhaps : surely))
        return fmt::format("a joint of '{}' bears {:.6g} N and {:.6g} N m; of {:.6g} and {:.6g} it is {}",
                           world_.name(b), reading.force, reading.torque, definition.report_force,
                           definition.report_torque, is_told ? "told" : "not told");
      if (beyond(reading.force, definition.break_force, 1e-3) && awake)
        return fmt::format("a joint of '{}' bears {:.6g} N and holds, where {:.6g} break it", world_.name(b),
                           reading.force, definition.break_force);
      if (beyond(reading.torque, definition.break_torque, 1e-3) && awake)
        return fmt::format("a joint of '{}' bears {:.6g} N m and holds, where {:.6g} break it",
                           world_.name(b), reading.torque, definition.break_torque);
      if (const auto* hinge = std::get_if<RevoluteDefinition>(&world_.kind(joint))) {
        const Vec2d on_a = world_.world_point(a, hinge->anchor_a),
                    on_b = world_.world_point(b, hinge->anchor_b);
        const double gap = length(on_a - on_b);
        const Aabb<double> box_a = world_.box(a), box_b = world_.box(b);
        const double size = length(hinge->anchor_a) + length(hinge->anchor_b) +
                            length(box_a.upper - box_a.lower) + length(box_b.upper - box_b.lower);
        if (std::abs(reading.linear_error - gap) > kRounding * (size + gap + 1e-3 * length(on_a)) + 1e-15)
          return fmt::format("a hinge of '{}' is {:.4g} m open, and reads {:.4g}", world_.name(b), gap,
                             reading.linear_error);
        if (whirled_.contains(key_of(a)) || whirled_.contains(key_of(b))) continue;
        const double turns = (reading.angle - (world_.angle(b) - world_.angle(a) - hinge->reference_angle)) /
                             6.283185307179586;
        if (std::abs(turns - std::round(turns)) >
            2e-3 * (1 + 1e-3 * std::abs(world_.angle(b)) + 1e-3 * std::abs(world_.angle(a))))
          return fmt::format("a hinge of '{}' reads an angle that is {:.3g} turns off", world_.name(b),
                             turns - std::round(turns));
      }
    }
  return {};
}

template <class Real>
std::string StateWatch<Real>::boxes() const {
  for (const BodyId body : world_.bodies()) {
    if (!world_.enabled(body)) continue;
    const Aabb<double> all = world_.box(body);
    for (const ShapeId shape : world_.shapes(body)) {
      const Outline outline = outline_in_world(world_, shape);
      const double slack =
          1e-2 * size_of(outline) + kRounding * (length(world_.centre(body)) + length(outline.low));
      for (const Aabb<double>& box : {all, world_.box(shape)})
        if (outline.low.x < box.lower.x - slack || outline.low.y < box.lower.y - slack ||
            outline.high.x > box.upper.x + slack || outline.high.y > box.upper.y + slack)
          return fmt::format(
              "a box of '{}' ends at {:.4g}, {:.4g} and {:.4g}, {:.4g}, its shape at {:.4g}, {:.4g} and "
              "{:.4g}, {:.4g}",
              world_.name(body), box.lower.x, box.lower.y, box.upper.x, box.upper.y, outline.low.x,
              outline.low.y, outline.high.x, outline.high.y);
    }
  }
  return {};
}

// Checks bodies with one contact, with a body that does not move and whose friction has no part along the
// normal: their momentum along the normal changes by their weight and the contact's impulse.
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
    // Other contacts may have begun and ended within the step. The normal is that of the step's start; it
    // turns during the step if shapes overlap deeply, so these are skipped.
    const double deepest = std::min(contact.separations[0], contact.separations[contact.count - 1]);
    const Aabb<double> box = world_.box(body);
    if (deepest < -0.05 * length(box.upper - box.lower)) continue;
    if (const auto told =
            [&](const auto& list) {
              return std::any_of(list.begin(), list.end(), [&](const TouchEvent& event) {
                for (const ShapeId shape : {event.shape_a, event.shape_b})
                  if (const auto owner = owners_.find(key_of(shape));
                      owner != owners_.end() && owner->second == body)
                    return true;
                return false;
              });
            };
        told(world_.events().begin) || told(world_.events().end))
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
    // Skips what continuous collision stops: it does not feel its weight on the rest of its way.
    const double speed = std::min(length(world_.velocity(body)), length(before->second.velocity));
    if (length(world_.centre(body) - before->second.position) < 0.9 * dt * speed) continue;
    const Vec2d n = is_a ? -1.0 * contact.normal : contact.normal;
    const Vec2d gain = world_.velocity(body) - before->second.velocity -
                       dt * world_.gravity_scale(body) * world_.gravity() -
                       (dt / mass) * before->second.force;
    const double off = mass * dot(gain, n) - contact.step_impulse;
    const double bound = kBalance * contact.step_impulse +
                         mass * (0.1 * length(gain) + 0.05 * dt * length(world_.gravity()) +
                                 0.02 * (length(world_.velocity(body)) + length(before->second.velocity)));
    if (contact.step_impulse > 0 && std::abs(off) > bound && std::abs(off) > 1e-6 * mass)
      return fmt::format("'{}' is pushed by {:.4g} N s, and its contact says {:.4g}", world_.name(body),
                         mass * dot(gain, n), contact.step_impulse);
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
        return fmt::format("'{}' goes on with {:.6g}", world_.name(body), value);
  }
  return {};
}

template class StateWatch<float>;
template class StateWatch<double>;

}  // namespace plumb::harness::hunt
