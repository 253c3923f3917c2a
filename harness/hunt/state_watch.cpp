#include "harness/hunt/state_watch.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

#include "engine/world/world_data.h"
#include "harness/hunt/shapes_of_world.h"

// Checks the lists, events and readings of a world; state_watch_motion.cpp checks how its bodies moved.
namespace plumb::harness::hunt {
namespace {

// Fraction of the sizes of both shapes: a hundred times the error of shapes and rotations that are rounded to
// floats.
constexpr double kRounding = 2e-5;
// Depth from which shapes must be in contact, as a fraction of the smaller width. Contacts of a step are
// found before its bodies move, so the displacement of a step is added.
constexpr double kDeep = 0.02;
// rad, largest rotation in a step of bodies that are checked: beyond it angles are rounded.
constexpr double kWhirl = 3;

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
  // Rotations of several turns a step are not counted exactly. A joint may reverse them within the step.
  for (const BodyId body : world_.bodies()) {
    const auto before = before_.find(key_of(body));
    if (before == before_.end()) continue;
    const double speed = std::max(length(world_.velocity(body)), length(before->second.velocity));
    const Aabb<double> box = world_.box(body);
    if (std::abs(world_.angle(body) - before->second.angle) > kWhirl ||
        (!world_.joints(body).empty() && dt * speed > kWhirl * length(box.upper - box.lower)))
      whirled_.insert(key_of(body));
  }
  // Checks large worlds less often, because most checks cost as much as a step or more.
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
    return fmt::format("counts {} bodies, {} shapes, {} joints, but lists {}, {}, {}", counts.bodies,
                       counts.shapes, counts.joints, bodies, shapes, joints.size());
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
    if (open < 0 || open > 1) return open < 0 ? "a touch ends that never began" : "a touch begins twice";
    if (open == 1) open_.insert(pair);
    if (open == 0) open_.erase(pair);
  }
  return {};
}

// Checks that touching pairs have begun to touch, and that pairs far apart have ended. Contacts are found at
// the start of a step, so shapes may have moved by the displacement of a step since.
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
  // Returns true in the third consecutive step with an error of a pair, because contacts of a body that a
  // call has moved are found a step later.
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
        return fmt::format("the touch of '{}' and '{}' does not end at a distance of {:.3g} m",
                           world_.name(a.body), world_.name(b.body), apart);
      }
      if (open || apart > -kDeep * std::min(width_of(a.outline), width_of(b.outline)) - a.way - b.way ||
          !may_touch(world_.filter(a.shape), world_.filter(b.shape)) || is_held(a.body, b.body) ||
          (world_.type(a.body) != BodyType::Dynamic && world_.type(b.body) != BodyType::Dynamic) ||
          (!world_.awake(a.body) && !world_.awake(b.body)))
        continue;
      // A point in two overlapping shapes may belong to either, even if both are of one body, so only pairs
      // without other shapes nearby are judged.
      const auto meets_others = [&](const Placed& one, const Placed& other) {
        return std::any_of(all.begin(), all.end(), [&](const Placed& third) {
          return third.shape != one.shape && third.shape != other.shape &&
                 separation(third.outline, one.outline) < one.way + kApart * size_of(one.outline);
        });
      };
      if (meets_others(a, b) || meets_others(b, a) || !lasts(pair)) continue;
      return fmt::format("'{}' and '{}' overlap by {:.3g} m, but no touch has begun", world_.name(a.body),
                         world_.name(b.body), -apart);
    }
  wrong_ = std::move(wrong);
  return {};
}

// Joined bodies do not collide unless their joint allows it.
template <class Real>
bool StateWatch<Real>::is_held(BodyId one, BodyId other) const {
  for (const JointId joint : world_.joints(one)) {
    const auto [a, b] = world_.bodies(joint);
    if ((a == other || b == other) && !world_.definition(joint).collide) return true;
  }
  return false;
}

// Checks that groups of touching or joined bodies sleep as a whole.
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
        return fmt::format("only one of '{}' and '{}' sleeps, although a joint connects them", world_.name(a),
                           world_.name(b));
    }
    for (const ContactReading& contact : world_.contacts(body)) {
      const double least = contact.count > 1 ? std::min(contact.separations[0], contact.separations[1])
                                             : contact.separations[0];
      if (contact.count == 0 || least > 0 || world_.sensor(contact.shape_a) || world_.sensor(contact.shape_b))
        continue;
      const BodyId a = world_.body(contact.shape_a), b = world_.body(contact.shape_b);
      if (differs(a, b))
        return fmt::format("only one of '{}' and '{}' sleeps, although they touch", world_.name(a),
                           world_.name(b));
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
                             is_seen ? "sees" : "misses", world_.name(other), std::abs(apart),
                             apart > 0 ? "away" : "inside");
        }
      }
    }
  }
  return {};
}

template <class Real>
std::string StateWatch<Real>::joints() const {
  std::map<Key, JointLoadEvent> reported;
  for (const JointLoadEvent& event : world_.events().loaded) reported[key_of(event.joint)] = event;
  for (const BodyId body : world_.bodies())
    for (const JointId joint : world_.joints(body)) {
      const auto [a, b] = world_.bodies(joint);
      if (a != body || !world_.enabled(a) || !world_.enabled(b)) continue;
      const JointReading reading = world_.read(joint);
      const JointDefinition definition = world_.definition(joint);
      // Sleeping bodies keep their last loads, which are not reported again.
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
      const bool is_reported = reported.contains(key_of(joint));
      if (awake && (is_reported ? !perhaps : surely))
        return fmt::format(
            "a joint of '{}' bears {:.6g} N and {:.6g} N m; its limits for reports are {:.6g} and {:.6g}; "
            "its load is {}",
            world_.name(b), reading.force, reading.torque, definition.report_force, definition.report_torque,
            is_reported ? "reported" : "not reported");
      if (beyond(reading.force, definition.break_force, 1e-3) && awake)
        return fmt::format("a joint of '{}' bears {:.6g} N without breaking; its limit is {:.6g} N",
                           world_.name(b), reading.force, definition.break_force);
      if (beyond(reading.torque, definition.break_torque, 1e-3) && awake)
        return fmt::format("a joint of '{}' bears {:.6g} N m without breaking; its limit is {:.6g} N m",
                           world_.name(b), reading.torque, definition.break_torque);
      if (const auto* hinge = std::get_if<RevoluteDefinition>(&world_.kind(joint))) {
        const Vec2d on_a = world_.world_point(a, hinge->anchor_a),
                    on_b = world_.world_point(b, hinge->anchor_b);
        const double gap = length(on_a - on_b);
        const Aabb<double> box_a = world_.box(a), box_b = world_.box(b);
        // Points are rounded relative to the centre of mass, which may be far from the origin.
        const double size = length(hinge->anchor_a) + length(hinge->anchor_b) +
                            length(box_a.upper - box_a.lower) + length(box_b.upper - box_b.lower) +
                            length(world_.centre(a) - world_.position(a)) +
                            length(world_.centre(b) - world_.position(b));
        if (std::abs(reading.linear_error - gap) > kRounding * (size + gap + 1e-3 * length(on_a)) + 1e-15)
          return fmt::format("a hinge of '{}' is open by {:.4g} m, but reads {:.4g} m", world_.name(b), gap,
                             reading.linear_error);
        if (whirled_.contains(key_of(a)) || whirled_.contains(key_of(b))) continue;
        const double turns = (reading.angle - (world_.angle(b) - world_.angle(a) - hinge->reference_angle)) /
                             6.283185307179586;
        if (std::abs(turns - std::round(turns)) >
            2e-3 * (1 + 1e-3 * std::abs(world_.angle(b)) + 1e-3 * std::abs(world_.angle(a))))
          return fmt::format("a hinge of '{}' reads an angle that is off by {:.3g} revolutions",
                             world_.name(b), turns - std::round(turns));
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
              "the AABB of '{}' is from {:.4g}, {:.4g} to {:.4g}, {:.4g}, its shape from {:.4g}, {:.4g} to "
              "{:.4g}, {:.4g}",
              world_.name(body), box.lower.x, box.lower.y, box.upper.x, box.upper.y, outline.low.x,
              outline.low.y, outline.high.x, outline.high.y);
    }
  }
  return {};
}

template class StateWatch<float>;
template class StateWatch<double>;

}  // namespace plumb::harness::hunt
