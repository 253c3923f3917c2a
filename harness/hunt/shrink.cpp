#include "harness/hunt/shrink.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>

#include "engine/scene/validate.h"

namespace plumb::harness::hunt {
namespace {

using Clock = std::chrono::steady_clock;

const std::string& name_of(const Joint& joint) {
  return std::visit([](const auto& j) -> const std::string& { return j.name; }, joint);
}

bool names(const Joint& joint, const std::string& body) {
  return std::visit([&](const auto& j) { return j.body_a == body || j.body_b == body; }, joint);
}

// Removes everything that names a removed body or joint, and the expectations that need it.
void forget(Case& one, const std::string& gone) {
  std::erase_if(one.actions, [&](const Action& action) { return action.target == gone; });
  std::erase(one.sensors, gone);
  for (Expectation& each : one.expectations) {
    const auto at = each.until.find(gone);
    if (at == each.until.end()) continue;
    each.to = std::min(each.to, at->second);
    each.until.erase(at);
  }
  std::erase_if(one.expectations, [&](const Expectation& each) {
    return each.body == gone || each.to < each.from ||
           std::find(each.needs.begin(), each.needs.end(), gone) != each.needs.end();
  });
}

void remove_joint(Case& one, std::size_t index) {
  const std::string name = name_of(one.scene.joints[index]);
  one.scene.joints.erase(one.scene.joints.begin() + static_cast<std::ptrdiff_t>(index));
  forget(one, name);
}

void remove_body(Case& one, std::size_t index) {
  const std::string name = one.scene.bodies[index].name;
  for (std::size_t i = one.scene.joints.size(); i-- > 0;)
    if (names(one.scene.joints[i], name)) remove_joint(one, i);
  std::erase_if(one.scene.forces, [&](const ForceLaw& law) {
    const auto ends = ends_of(law);
    return ends[0] == name || ends[1] == name;
  });
  one.scene.bodies.erase(one.scene.bodies.begin() + static_cast<std::ptrdiff_t>(index));
  forget(one, name);
}

// Returns true if an expectation requires the body or joint unchanged, with its springs, motors and limits.
bool is_needed(const Case& one, const std::string& name) {
  return std::any_of(one.expectations.begin(), one.expectations.end(), [&](const Expectation& each) {
    return std::find(each.needs.begin(), each.needs.end(), name) != each.needs.end();
  });
}

bool needs_masses(const Case& one) {
  return std::any_of(one.expectations.begin(), one.expectations.end(), [](const Expectation& each) {
    return std::find(each.needs.begin(), each.needs.end(), kMasses) != each.needs.end();
  });
}

double with_digits(double value, int digits) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return std::strtod(text, nullptr);
}

/// Tries candidates and keeps those that still fail.
class Shrinker {
 public:
  Shrinker(Case one, const StillFails& still_fails, int most, double seconds)
      : best_(std::move(one)),
        still_fails_(still_fails),
        left_(most),
        end_(Clock::now() +
             std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds))) {}

  Case shrunk() {
    for (bool smaller = true; smaller && going();) {
      smaller = bodies();
      smaller = joints() || smaller;
      smaller = shapes() || smaller;
      smaller = rest() || smaller;
      smaller = features() || smaller;
    }
    for (const int digits : {1, 2, 3, 4}) round_all(digits);
    steps();
    return best_;
  }

 private:
  bool going() const { return left_ > 0 && Clock::now() < end_; }

  template <class Change>
  bool try_change(const Change& change) {
    if (!going()) return false;
    Case candidate = best_;
    change(candidate);
    try {
      validate(candidate.scene);
    } catch (const std::exception&) {
      return false;
    }
    --left_;
    if (!still_fails_(candidate)) return false;
    best_ = std::move(candidate);
    return true;
  }

  // Removes halves, quarters, ..., and finally single bodies, as delta debugging does (Zeller 2002).
  bool bodies() {
    bool any = false;
    for (std::size_t part = best_.scene.bodies.size() / 2; part >= 1; part /= 2) {
      for (std::size_t at = best_.scene.bodies.size(); at > 0 && going();) {
        const std::size_t count = std::min(part, at);
        at -= count;
        if (at + count > best_.scene.bodies.size()) continue;
        any = try_change([&](Case& one) {
                for (std::size_t i = at + count; i-- > at;) remove_body(one, i);
              }) ||
              any;
      }
    }
    return any;
  }

  bool joints() {
    bool any = false;
    for (std::size_t i = best_.scene.joints.size(); i-- > 0;)
      any = try_change([&](Case& one) { remove_joint(one, i); }) || any;
    return any;
  }

  bool shapes() {
    bool any = false;
    // Expectations depend on the shapes of the bodies that they need.
    for (std::size_t i = 0; i < best_.scene.bodies.size() && best_.expectations.empty(); ++i) {
      for (std::size_t k = best_.scene.bodies[i].shapes.size(); k-- > 0;) {
        any = try_change([&](Case& one) {
                Body& body = one.scene.bodies[i];
                if (body.type == BodyType::Dynamic && !body.inertia && !body.fixed_rotation)
                  body.inertia = inertia_of(body);
                body.shapes.erase(body.shapes.begin() + static_cast<std::ptrdiff_t>(k));
              }) ||
              any;
      }
    }
    return any;
  }

  bool rest() {
    bool any = false;
    for (std::size_t i = best_.actions.size(); i-- > 0;)
      any = try_change([&](Case& one) {
              one.actions.erase(one.actions.begin() + static_cast<std::ptrdiff_t>(i));
            }) ||
            any;
    for (std::size_t i = best_.expectations.size(); i-- > 0;)
      any = try_change([&](Case& one) {
              one.expectations.erase(one.expectations.begin() + static_cast<std::ptrdiff_t>(i));
            }) ||
            any;
    for (std::size_t i = best_.sensors.size(); i-- > 0;)
      any = try_change([&](Case& one) {
              one.sensors.erase(one.sensors.begin() + static_cast<std::ptrdiff_t>(i));
            }) ||
            any;
    return any;
  }

  // Sets numbers and options to the simplest value, one at a time.
  bool features() {
    bool any = false;
    const auto set = [&](auto reach, auto value) {
      if (reach(best_) == value) return;
      any = try_change([&](Case& one) { reach(one) = value; }) || any;
    };
    // Expectations that need the masses have figures that depend on the weights and the step.
    const bool bare = !needs_masses(best_);
    if (bare) set([](Case& one) -> double& { return one.dt; }, 1.0 / 60);
    set([](Case& one) -> int& { return one.substeps; }, 4);
    set([](Case& one) -> bool& { return one.sleeping; }, false);
    if (bare) set([](Case& one) -> Vec2d& { return one.scene.gravity; }, Vec2d{0, 0});
    // Sets no gravity in a scene that has none: otherwise the two changes would alternate.
    if (bare && !(best_.scene.gravity == Vec2d{0, 0}))
      set([](Case& one) -> Vec2d& { return one.scene.gravity; }, Vec2d{0, -10});
    for (std::size_t i = 0; i < best_.scene.bodies.size(); ++i) {
      const auto body = [i](Case& one) -> Body& { return one.scene.bodies[i]; };
      if (best_.expectations.empty()) {
        set([&](Case& one) -> Vec2d& { return body(one).velocity; }, Vec2d{});
        set([&](Case& one) -> double& { return body(one).angular_velocity; }, 0.0);
      }
      if (bare) set([&](Case& one) -> double& { return body(one).mass; }, 1.0);
      for (std::size_t k = 0; k < best_.scene.bodies[i].shapes.size(); ++k) {
        const auto shape = [&, k](Case& one) -> Shape& { return body(one).shapes[k]; };
        if (!best_.expectations.empty()) continue;
        set([&](Case& one) -> double& { return shape(one).friction; }, 0.0);
        set([&](Case& one) -> double& { return shape(one).restitution; }, 0.0);
        set([&](Case& one) -> Filter& { return shape(one).filter; }, Filter{});
      }
    }
    for (std::size_t i = 0; i < best_.scene.joints.size(); ++i) {
      std::visit(
          [&](const auto& sample) {
            using Kind = std::decay_t<decltype(sample)>;
            const auto drop = [&](auto member) {
              if (!(sample.*member) || is_needed(best_, sample.name)) return;
              any = try_change([&](Case& one) { (std::get<Kind>(one.scene.joints[i]).*member).reset(); }) ||
                    any;
            };
            if constexpr (requires { sample.limits.value(); }) drop(&Kind::limits);
            if constexpr (requires { sample.motor.value(); }) drop(&Kind::motor);
            if constexpr (requires { sample.spring.value(); }) drop(&Kind::spring);
            if constexpr (requires { sample.linear_spring.value(); }) drop(&Kind::linear_spring);
            if constexpr (requires { sample.angular_spring.value(); }) drop(&Kind::angular_spring);
          },
          Joint(best_.scene.joints[i]));
    }
    return any;
  }

  // Rounds to few digits, for all bodies at once or one by one. Rounds nothing in scenes with joints, so that
  // anchors still fit.
  void round_all(int digits) {
    const auto round = [&](Body& body) {
      for (double* value : {&body.position.x, &body.position.y, &body.angle, &body.velocity.x,
                            &body.velocity.y, &body.angular_velocity, &body.mass})
        *value = with_digits(*value, digits);
    };
    // The figures of expectations depend on the positions.
    if (!best_.scene.joints.empty() || !best_.expectations.empty()) return;
    if (try_change(
            [&](Case& one) { std::for_each(one.scene.bodies.begin(), one.scene.bodies.end(), round); }))
      return;
    for (std::size_t i = 0; i < best_.scene.bodies.size(); ++i) {
      Case copy = best_;
      round(copy.scene.bodies[i]);
      if (!(copy.scene.bodies[i] == best_.scene.bodies[i]))
        try_change([&](Case& one) { round(one.scene.bodies[i]); });
    }
  }

  void steps() {
    for (int steps = 1; steps < best_.steps && going(); steps *= 2)
      if (try_change([&](Case& one) { one.steps = steps; })) return;
  }

  Case best_;
  const StillFails& still_fails_;
  int left_;
  Clock::time_point end_;
};

}  // namespace

Case shrink(Case one, const StillFails& still_fails, int most, double seconds) {
  return Shrinker(std::move(one), still_fails, most, seconds).shrunk();
}

}  // namespace plumb::harness::hunt
