#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <fmt/format.h>

#include "harness/hunt/objection.h"
#include "harness/hunt/outline.h"
#include "harness/hunt/subject.h"

namespace plumb::harness::hunt {
namespace {

// s: overlaps that end sooner are tolerated, because impacts press shapes together for a moment.
constexpr double kLasting = 0.5;
constexpr double kWidthShare = 0.15, kReachShare = 0.02;

struct Part {
  std::size_t body;
  const Shape* shape;
  Outline outline;
  double width, extent;
  bool line;
};

bool senses(const Case& one, std::size_t body) {
  return std::find(one.sensors.begin(), one.sensors.end(), one.scene.bodies[body].name) != one.sensors.end();
}

std::vector<Part> parts_of(const Case& one) {
  std::vector<Part> out;
  for (std::size_t i = 0; i < one.scene.bodies.size(); ++i)
    for (const Shape& shape : one.scene.bodies[i].shapes)
      for (Outline& outline : outlines_of(shape)) {
        const double width = width_of(outline), extent = reach_of(outline);
        const bool line = outline.core.size() == 2 && outline.radius == 0;
        out.push_back({i, &shape, std::move(outline), width, extent, line});
      }
  return out;
}

bool boxes_meet(const Outline& a, const Outline& b, double margin) {
  return a.low.x - margin < b.high.x && b.low.x - margin < a.high.x && a.low.y - margin < b.high.y &&
         b.low.y - margin < a.high.y;
}

std::string pair_name(const Case& one, const Part& a, const Part& b) {
  return fmt::format("{} and {}", one.scene.bodies[a.body].name, one.scene.bodies[b.body].name);
}

bool filters_change(const Case& one) {
  return std::any_of(one.actions.begin(), one.actions.end(), [](const Action& action) {
    return action.kind == ActionKind::SetFilter || action.kind == ActionKind::DestroyShape;
  });
}

bool types_change(const Case& one) {
  return std::any_of(one.actions.begin(), one.actions.end(),
                     [](const Action& action) { return action.kind == ActionKind::SetType; });
}

bool pressed(const Case& one) {
  for (const Body& body : one.scene.bodies)
    if (body.type == BodyType::Kinematic && (length(body.velocity) > 0 || body.angular_velocity != 0))
      return true;
  for (const Joint& joint : one.scene.joints)
    if (std::holds_alternative<MouseJoint>(joint) || std::holds_alternative<MotorJoint>(joint)) return true;
  return false;
}

}  // namespace

Verdict penetration_law(const Case& one, const Engine& engine, const Motion& motion) {
  if (filters_change(one) || pressed(one) || motion.samples.size() < 2) return {};
  const std::vector<Part> parts = parts_of(one);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t j = i + 1; j < parts.size(); ++j) {
      const Part &a = parts[i], &b = parts[j];
      const bool dynamic = one.scene.bodies[a.body].type == BodyType::Dynamic ||
                           one.scene.bodies[b.body].type == BodyType::Dynamic;
      if (a.body != b.body && dynamic && !a.line && !b.line && !senses(one, a.body) && !senses(one, b.body) &&
          may_touch(a.shape->filter, b.shape->filter) && !joined(one.scene, a.body, b.body))
        pairs.emplace_back(i, j);
    }
  std::vector<int> in(pairs.size(), 0);
  std::vector<double> least(pairs.size(), INFINITY);
  std::vector<bool> given(pairs.size(), false);  // overlapping from the start: joints may keep them so
  // Bodies that joints connect with an overlapping body are pulled along when it is pushed out.
  const std::vector<std::size_t> group = joint_groups(one.scene);
  std::set<std::pair<std::size_t, std::size_t>> given_groups;
  const auto groups_of = [&](std::size_t n) {
    return std::minmax(group[parts[pairs[n].first].body], group[parts[pairs[n].second].body]);
  };
  const auto gives_way = [&](std::size_t body) {
    const Body& of = one.scene.bodies[body];
    return of.type == BodyType::Dynamic &&
           std::none_of(one.actions.begin(), one.actions.end(), [&](const Action& action) {
             return action.kind == ActionKind::SetType && action.target == of.name;
           });
  };
  const bool intruded = std::any_of(one.actions.begin(), one.actions.end(), [](const Action& action) {
    return action.kind == ActionKind::Create || action.kind == ActionKind::Teleport ||
           action.kind == ActionKind::SetType;
  });
  // Precise promises that shapes do not overlap at any time.
  const int lasting =
      engine.kind == Engine::Kind::Precise ? 1 : std::max(3, static_cast<int>(kLasting / one.dt));
  std::vector<Outline> now(parts.size());
  std::vector<double> depths(pairs.size(), 0), bounds;
  for (const auto& [i, j] : pairs) {
    const Part &a = parts[i], &b = parts[j];
    const double least_extent = std::min(a.extent, b.extent);
    bounds.push_back(engine.kind == Engine::Kind::Precise
                         ? 1e-5 * least_extent
                         : std::max({kWidthShare * std::min(a.width, b.width), kReachShare * least_extent,
                                     2 * length(one.scene.gravity) * one.dt * one.dt}));
  }
  bool overlapped = false;  // some shapes overlap from the start
  for (std::size_t k = 0; k < motion.samples.size(); ++k) {
    const Sample& sample = motion.samples[k];
    for (std::size_t i = 0; i < parts.size(); ++i)
      now[i] = placed(parts[i].outline, sample.states[parts[i].body]);
    // For each body, the static and kinematic bodies that it overlaps: it cannot leave two of these at once.
    std::map<std::size_t, std::set<std::size_t>> pressed_by;
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const auto [i, j] = pairs[n];
      const Part &a = parts[i], &b = parts[j];
      depths[n] = 0;
      if (sample.present[a.body] && sample.present[b.body] && boxes_meet(now[i], now[j], 0))
        depths[n] = -separation(now[i], now[j]);
      // For Precise no initial overlap is tolerated, because it must refuse such scenes.
      if (k == 0 && depths[n] > bounds[n] && engine.kind != Engine::Kind::Precise)
        given[n] = true, given_groups.insert(groups_of(n)), overlapped = true;
      if (depths[n] <= bounds[n] || engine.kind == Engine::Kind::Precise) continue;
      if (!gives_way(a.body)) pressed_by[b.body].insert(a.body);
      if (!gives_way(b.body)) pressed_by[a.body].insert(b.body);
    }
    if (k == 0)
      for (std::size_t n = 0; n < pairs.size(); ++n) {
        const auto [one_group, other_group] = groups_of(n);
        given[n] = given[n] || (one_group != other_group && given_groups.contains({one_group, other_group}));
      }
    for (std::size_t n = 0; n < pairs.size(); ++n) {
      const Part &a = parts[pairs[n].first], &b = parts[pairs[n].second];
      const double depth = depths[n], bound = bounds[n];
      // A body placed onto another one may be unable to escape, but must then be awake.
      const bool asleep = sample.asleep[a.body] || sample.asleep[b.body];
      const bool is_pressed =
          (intruded || overlapped) && (pressed_by[a.body].size() > 1 || pressed_by[b.body].size() > 1);
      if (depth <= bound || given[n] || is_pressed || (intruded && !asleep)) {
        in[n] = 0, least[n] = INFINITY;
        continue;
      }
      ++in[n];
      // An overlap that existed at the start or comes from an action may last longer if it keeps shrinking.
      if (in[n] == lasting / 2 && lasting > 1) least[n] = depth;
      if (in[n] < lasting || depth < 0.7 * least[n]) {
        if (in[n] >= lasting) in[n] = 0, least[n] = INFINITY;
        continue;
      }
      return Objection{.judge = "penetration",
                       .what = fmt::format("{} overlap by {:.3g} m for {:.2g} s", pair_name(one, a, b), depth,
                                           in[n] * one.dt),
                       .right = "overlaps are pushed apart",
                       .figure = depth,
                       .bound = bound,
                       .unit = "m",
                       .time = static_cast<double>(k) * one.dt,
                       .subject = pair_name(one, a, b)};
    }
  }
  return {};
}

Verdict sensor_law(const Case& one, const Engine& engine, const Motion& motion) {
  // Sensors do not detect static bodies, and a visitor may become static.
  if (!engine.is_world() || one.sensors.empty() || filters_change(one) || types_change(one)) return {};
  const std::vector<Part> parts = parts_of(one);
  const double margin = 0.05 * typical_size(one.scene);
  std::map<Visit, int> wrong;
  for (std::size_t k = 0; k < motion.visits.size(); ++k) {
    const Sample& sample = motion.samples[k + 1];
    std::map<Visit, double> nearest;
    for (const Part& a : parts) {
      if (!senses(one, a.body) || !sample.present[a.body] || a.line) continue;
      const Outline sensor = placed(a.outline, sample.states[a.body]);
      for (const Part& b : parts) {
        if (senses(one, b.body) || b.body == a.body || !sample.present[b.body] || b.line) continue;
        if (one.scene.bodies[b.body].type == BodyType::Static || !may_touch(a.shape->filter, b.shape->filter))
          continue;
        const double apart = separation(sensor, placed(b.outline, sample.states[b.body]));
        const auto at = nearest.try_emplace({a.body, b.body}, apart).first;
        at->second = std::min(at->second, apart);
      }
    }
    for (const auto& [visit, apart] : nearest) {
      const bool open = std::binary_search(motion.visits[k].begin(), motion.visits[k].end(), visit);
      const bool bad = open ? apart > margin : apart < -margin;
      const int count = wrong[visit] = bad ? wrong[visit] + 1 : 0;
      if (count < 4) continue;
      return Objection{
          .judge = "sensors",
          .what = fmt::format("{} {} {}, {:.3g} m {}", one.scene.bodies[visit.sensor].name,
                              open ? "still sees" : "misses", one.scene.bodies[visit.visitor].name,
                              std::abs(apart), open ? "away" : "inside"),
          .right = "a sensor reports the shapes that overlap it, and no others",
          .figure = std::abs(apart),
          .bound = margin,
          .unit = "m",
          .time = static_cast<double>(k + 1) * one.dt,
          .subject = one.scene.bodies[visit.visitor].name};
    }
  }
  return {};
}

Verdict event_law(const Case&, const Engine&, const Motion& motion) {
  if (motion.event_faults.empty()) return {};
  return Objection{
      .judge = "events",
      .what = motion.event_faults.front().what,
      .right = "each begin event is followed by one end event, also when a body or shape is destroyed",
      .figure = static_cast<double>(motion.event_faults.size()),
      .unit = "events",
      .time = motion.event_faults.front().time};
}

Verdict sleep_law(const Case& one, const Engine& engine, const Motion& motion) {
  if (!engine.is_world() || length(one.scene.gravity) == 0 || !one.scene.forces.empty()) return {};
  const std::vector<Part> parts = parts_of(one);
  const std::vector<double> extent = extents(one.scene);
  std::vector<int> hanging(one.scene.bodies.size(), 0);
  for (std::size_t k = 1; k < motion.samples.size(); ++k) {
    const Sample& sample = motion.samples[k];
    for (std::size_t i = 0; i < one.scene.bodies.size(); ++i) {
      const Body& body = one.scene.bodies[i];
      bool bad =
          sample.present[i] && sample.asleep[i] && body.gravity_scale != 0 && !body.lock_y && !body.lock_x;
      for (const Joint& joint : one.scene.joints)
        std::visit([&](const auto& j) { bad = bad && j.body_a != body.name && j.body_b != body.name; },
                   joint);
      // The distance to the nearest shape is expensive, so compute it only after 10 samples asleep.
      hanging[i] = bad ? hanging[i] + 1 : 0;
      if (hanging[i] < 10 || hanging[i] % 10 != 0) continue;
      double least = INFINITY;
      for (const Part& a : parts)
        for (const Part& b : parts) {
          if (a.body != i || b.body == i || !sample.present[b.body] || senses(one, b.body)) continue;
          least = std::min(least, separation(placed(a.outline, sample.states[i]),
                                             placed(b.outline, sample.states[b.body])));
        }
      const double bound = 0.05 * extent[i];
      if (least <= bound) continue;
      return Objection{.judge = "sleep",
                       .what = fmt::format("{} sleeps without support, {:.3g} m away from the nearest shape",
                                           body.name, least),
                       .right = "a body that loses its support wakes and falls",
                       .figure = least,
                       .bound = bound,
                       .unit = "m",
                       .time = static_cast<double>(k) * one.dt,
                       .subject = body.name};
    }
  }
  return {};
}

Verdict expectation_law(const Case& one, const Engine&, const Motion& motion) {
  for (const Expectation& expected : one.expectations) {
    const auto body = find_body(one.scene, expected.body);
    if (!body) continue;
    std::optional<Vec2d> from;
    for (std::size_t k = 0; k < motion.samples.size(); ++k) {
      const double time = static_cast<double>(k) * one.dt;
      if (time < expected.from - 1e-9 || time > expected.to + 1e-9) continue;
      const BodyState& s = motion.samples[k].states[*body];
      if (!from) from = s.position;
      double value = 0;
      switch (expected.quantity) {
        case Quantity::X:
          value = s.position.x;
          break;
        case Quantity::Y:
          value = s.position.y;
          break;
        case Quantity::Angle:
          value = s.angle;
          break;
        case Quantity::VelocityX:
          value = s.velocity.x;
          break;
        case Quantity::VelocityY:
          value = s.velocity.y;
          break;
        case Quantity::AngularVelocity:
          value = s.angular_velocity;
          break;
        case Quantity::Drift:
          value = length(s.position - *from);
          break;
      }
      if (value >= expected.lower && value <= expected.upper) continue;
      return Objection{.judge = expected.name,
                       .what = fmt::format("{} of {} is {:.6g}; expected {:.6g} to {:.6g}",
                                           kQuantityNames[static_cast<std::size_t>(expected.quantity)],
                                           expected.body, value, expected.lower, expected.upper),
                       .right = expected.why,
                       .figure = value,
                       .bound = value < expected.lower ? expected.lower : expected.upper,
                       .time = time,
                       .subject = expected.body};
    }
  }
  return {};
}

}  // namespace plumb::harness::hunt
