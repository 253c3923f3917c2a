// Judges Precise beyond its motion: forces, derivatives, error estimates, rejected scenes, and agreement of
// methods.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "engine/driver/sensitivity.h"
#include "engine/scene/error.h"
#include "engine/scene/number.h"
#include "engine/simulation/simulation.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/random.h"
#include "harness/hunt/subject.h"

namespace plumb::harness::hunt {
namespace {

constexpr std::size_t kMostBodies = 8;  // dynamic bodies, because the scene is run several times

/// Runs a check in a separate process, and returns the check's text as an objection.
Verdict judged(const char* name, const char* right, const std::function<std::string()>& check) {
  const std::string what = checked_apart(check);
  if (what.empty()) return {};
  return Objection{.law = name, .judge = name, .what = what, .right = right};
}

std::size_t dynamic_bodies(const Scene& scene) {
  return static_cast<std::size_t>(
      std::count_if(scene.bodies.begin(), scene.bodies.end(),
                    [](const Body& body) { return body.type == BodyType::Dynamic; }));
}

std::int64_t events_of(const Statistics& of) {
  std::int64_t sum = of.impacts;
  for (const EventCount& each : of.contacts) sum += each.count;
  return sum;
}

std::vector<BodyState> states_of(const Simulation& run) {
  std::vector<BodyState> out(run.body_count());
  run.read(out);
  return out;
}

double distance(const Scene& scene, const std::vector<double>& extent, const std::vector<BodyState>& a,
                const std::vector<BodyState>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (scene.bodies[i].type == BodyType::Dynamic)
      most = std::max(most,
                      length(a[i].position - b[i].position) + extent[i] * std::abs(a[i].angle - b[i].angle));
  return most;
}

// Checks that the forces of joints and contacts, with gravity and damping, explain the accelerations.
std::string balanced(const Case& one) {
  const Scene& scene = one.scene;
  for (const Joint& joint : scene.joints)
    if (std::holds_alternative<PulleyJoint>(joint) || std::holds_alternative<GearJoint>(joint)) return {};
  for (const Body& body : scene.bodies)
    for (const Shape& shape : body.shapes)
      if (shape.rolling_resistance != 0) return {};
  if (!scene.forces.empty() || dynamic_bodies(scene) > kMostBodies) return {};
  Random random(one.seed, one.index + 53);
  const double h = one.dt / 20;
  Simulation run = compile(scene, Precise{.tolerance = 1e-11, .max_dt = h});
  for (int look = 0; look < 4; ++look) {
    run.step(random.whole(5, 150));
    std::vector<std::vector<BodyState>> at;
    const std::int64_t before = events_of(run.statistics());
    Reactions forces;
    for (int k = 0; k < 5; ++k) {
      at.push_back(states_of(run));
      if (k == 2) forces = run.forces();
      if (k < 4) run.step();
    }
    if (events_of(run.statistics()) != before) continue;
    struct Load {
      Vec2d force{};
      double torque = 0, size = 0, turning = 0;
    };
    std::vector<Load> loads(scene.bodies.size());
    const auto push = [&](std::optional<std::size_t> body, Vec2d force, double torque, Vec2d point) {
      if (!body) return;
      Load& to = loads[*body];
      const Vec2d arm = point - at[2][*body].position;
      to.force += force, to.torque += torque + cross(arm, force);
      to.size += length(force), to.turning += std::abs(torque) + length(arm) * length(force);
    };
    for (std::size_t i = 0; i < forces.joints.size() && i < scene.joints.size(); ++i) {
      const JointReaction& of = forces.joints[i];
      std::visit(
          [&](const auto& joint) {
            push(find_body(scene, joint.body_b), of.force, of.torque, of.position);
            push(find_body(scene, joint.body_a), -1.0 * of.force, -of.torque, of.position);
          },
          scene.joints[i]);
    }
    for (const ContactReaction& of : forces.contacts) {
      const Vec2d tangent{-of.normal.y, of.normal.x},
          force = of.normal_force * of.normal + of.tangent_force * tangent;
      if (of.normal_force < -1e-9) return fmt::format("a contact pulls with {:.3g} N", -of.normal_force);
      push(of.body_b, force, 0, of.position), push(of.body_a, -1.0 * force, 0, of.position);
    }
    for (std::size_t i = 0; i < loads.size(); ++i) {
      const Body& body = scene.bodies[i];
      const double inertia = body.type == BodyType::Dynamic ? inertia_of(body) : 0;
      if (inertia == 0 || body.lock_x || body.lock_y) continue;
      const auto rate = [&](auto of) {
        return (1 / (12 * h)) * (8.0 * (of(at[3][i]) - of(at[1][i])) - (of(at[4][i]) - of(at[0][i])));
      };
      const auto rough = [&](auto of) { return (1 / (2 * h)) * (of(at[3][i]) - of(at[1][i])); };
      const auto velocity = [](const BodyState& s) { return s.velocity; };
      const auto spin = [](const BodyState& s) { return s.angular_velocity; };
      const BodyState& now = at[2][i];
      const Vec2d own = body.mass * (body.gravity_scale * scene.gravity - body.linear_damping * now.velocity);
      const Vec2d missing = body.mass * rate(velocity) - own - loads[i].force;
      const double turning =
          inertia * (rate(spin) + body.angular_damping * now.angular_velocity) - loads[i].torque;
      // The error of a second-order difference is far larger than that of a fourth-order one, so their
      // difference bounds it.
      const double slack = body.mass * length(rate(velocity) - rough(velocity)),
                   slack_turn = inertia * std::abs(rate(spin) - rough(spin));
      const double rounding = 1e-11 / h * (body.mass * (length(now.velocity) + 1) + inertia);
      const double bound = 1e-4 * (loads[i].size + length(own)) + slack + rounding,
                   bound_turn = 1e-4 * loads[i].turning + slack_turn + rounding;
      if (length(missing) > bound)
        return fmt::format("'{}': mass times acceleration exceeds the forces by {:.5g} N, of {:.5g} N in all",
                           body.name, length(missing), loads[i].size + length(own));
      if (std::abs(turning) > bound_turn)
        return fmt::format(
            "'{}': inertia times angular acceleration exceeds the torques by {:.5g} N m, of {:.5g} N m in "
            "all",
            body.name, std::abs(turning), loads[i].turning);
    }
  }
  return {};
}

/// Returns a number of the scene with respect to which its motion can be differentiated.
std::string some_parameter(const Scene& scene, Random& random) {
  std::vector<std::string> names{"gravity.y"};
  for (const Body& body : scene.bodies) {
    const std::string of = "bodies." + body.name + ".";
    if (!body.shapes.empty()) {
      names.push_back(of + "shapes.friction"), names.push_back(of + "shapes.restitution");
      names.push_back(of + "shapes.restitution");
    }
    if (body.type != BodyType::Dynamic) continue;
    for (const char* number : {"mass", "position.y", "velocity.x", "velocity.y", "angular_velocity"})
      names.push_back(of + number);
  }
  return random.pick(names);
}

// Checks derivatives with respect to a number of the scene against one-sided differences of nearby runs.
std::string derived(const Case& one) {
  const Scene& scene = one.scene;
  if (dynamic_bodies(scene) > 4 || has_formulas(scene)) return {};
  Random random(one.seed, one.index + 59);
  const std::string name = some_parameter(scene, random);
  const int steps = std::min(one.steps, random.whole(5, 60));
  Scene changed = scene;
  const std::vector<double*> numbers = numbers_at(changed, name);
  if (numbers.empty()) return {};
  std::vector<double> usual;
  for (const double* each : numbers) usual.push_back(*each);
  if (usual.front() == 0 && kind_of_number(changed, name) == NumberKind::Relative &&
      name.find("velocity") == std::string::npos)
    return {};
  const double scale = std::max(std::abs(usual.front()), 1.0), step = 1e-5 * scale;
  const Precise accuracy{.tolerance = 1e-12, .max_dt = one.dt};
  Simulation run = compile(scene, accuracy, {.parameters = {name}});
  run.step(steps);
  std::vector<BodyState> answer;
  try {
    answer = run.sensitivities(0);
  } catch (const NotDifferentiable&) {
    return {};
  }
  const std::int64_t events = events_of(run.statistics());
  const std::vector<BodyState> here = states_of(run);
  struct Beside {
    std::vector<BodyState> states;
    bool same = false;  // events
  };
  const auto beside = [&](double by) {
    for (std::size_t i = 0; i < numbers.size(); ++i) *numbers[i] = usual[i] + by;
    Simulation other = compile(changed, accuracy);
    other.step(steps);
    return Beside{states_of(other), events_of(other.statistics()) == events};
  };
  const Beside up = beside(step), up2 = beside(step / 2), down = beside(-step), down2 = beside(-step / 2);
  if (!up.same || !up2.same || !down.same || !down2.same) return {};
  const auto differs = [&](auto of, double size, const char* what) -> std::string {
    double most = 0;
    for (const BodyState& each : answer) most = std::max(most, std::abs(of(each)) * size);
    for (std::size_t i = 0; i < here.size(); ++i) {
      if (scene.bodies[i].type != BodyType::Dynamic) continue;
      const double x = of(here[i]);
      const double right = (of(up.states[i]) - x) / step, right2 = (of(up2.states[i]) - x) / (step / 2),
                   left = (x - of(down.states[i])) / step, left2 = (x - of(down2.states[i])) / (step / 2);
      // Extrapolates the limit of each side separately (Richardson); gives up on sides that do not converge.
      const double to_right = 2 * right2 - right, to_left = 2 * left2 - left;
      const double settled = std::abs(right2 - right) + std::abs(left2 - left);
      const double scale_of =
          std::abs(to_right) + std::abs(to_left) + most + 1e-3 * (1 + std::abs(x)) / scale;
      if (settled > 0.02 * scale_of) continue;
      const double found = of(answer[i]);
      if (std::abs(found - to_right) > 0.02 * scale_of || std::abs(found - to_left) > 0.02 * scale_of)
        return fmt::format("d {} of '{}' / d {} is {:.6g} and {:.6g} by one-sided differences, not {:.6g}",
                           what, scene.bodies[i].name, name, to_left, to_right, found);
    }
    return {};
  };
  const std::string wrong = differs([](const BodyState& s) { return s.position.x; }, 1, "x") +
                            differs([](const BodyState& s) { return s.position.y; }, 1, "y") +
                            differs([](const BodyState& s) { return s.angle; }, 1, "angle");
  return wrong;
}

// Checks that the estimated error is of the order of the true one.
std::string estimated(const Case& one) {
  if (dynamic_bodies(one.scene) > kMostBodies) return {};
  const int steps = std::min(one.steps, 60);
  const Precise rough{.tolerance = 1e-3, .max_dt = one.dt, .estimate_error = true},
      fine{.tolerance = 1e-11, .max_dt = one.dt};
  Simulation run = compile(one.scene, rough), truth = compile(one.scene, fine);
  double off = 0;
  for (int k = 0; k < steps; ++k) {
    run.step(), truth.step();
    // If only one of the runs has an event, they cannot be compared.
    if (events_of(run.statistics()) > 0 || events_of(truth.statistics()) > 0) return {};
    const auto a = states_of(run), b = states_of(truth);
    for (std::size_t i = 0; i < a.size(); ++i)
      if (one.scene.bodies[i].type == BodyType::Dynamic)
        off = std::max(off, length(a[i].position - b[i].position));
  }
  const ErrorEstimate error = run.statistics().error;
  if (!error.known) return "does not estimate the error although it was requested";
  // The documentation promises a factor of ten for some named motions; any other motion is allowed a factor
  // of a thousand.
  if (off > 1e-10 * largest_size(one.scene) && error.position < 1e-3 * off)
    return fmt::format("has an error of {:.3g} m, and estimates {:.3g} m", off, error.position);
  return {};
}

// Checks that a scene which starts with overlapping shapes, or with an open joint, is refused.
std::string refuses_start(const Case& one) {
  Random random(one.seed, one.index + 61);
  const double size = largest_size(one.scene);
  const auto goes_on = [&](const Scene& scene) {
    try {
      Simulation run = compile(scene, Precise{.max_dt = 1e-3});
      run.step();
    } catch (const Error&) {
      return false;
    }
    return true;
  };
  if (!goes_on(one.scene)) return {};
  for (const Body& body : one.scene.bodies) {
    if (body.type != BodyType::Dynamic || body.shapes.empty()) continue;
    Scene scene = one.scene;
    Body other = body;
    other.name = "intruder";
    for (Shape& shape : other.shapes) shape.filter = {};
    bool meets = false;
    for (const Shape& shape : body.shapes) meets = meets || may_touch(shape.filter, Filter{});
    scene.bodies.push_back(other);
    if (meets && goes_on(scene)) return "continues with shapes that overlap at the start";
    break;
  }
  for (std::size_t i = 0; i < one.scene.joints.size(); ++i) {
    Scene scene = one.scene;
    auto* hinge = std::get_if<RevoluteJoint>(&scene.joints[i]);
    if (hinge == nullptr) continue;
    hinge->anchor_a += 0.02 * size * Vec2d{random.pick({-1.0, 1.0}), random.pick({-1.0, 1.0})};
    if (goes_on(scene)) return "continues with a hinge that is open at the start";
    break;
  }
  return {};
}

// Compares two methods of integration that share nothing but the equations.
std::string alike_by_methods(const Case& one, const Motion& motion, const Engine& engine) {
  if (dynamic_bodies(one.scene) > kMostBodies) return {};
  const int steps = std::min(one.steps, 90);
  const auto by = [&](MotionMethod method) {
    return compile(one.scene, Precise{.tolerance = 1e-10, .max_dt = one.dt, .method = method});
  };
  Simulation first = by(MotionMethod::Explicit), second = by(MotionMethod::Implicit);
  const std::vector<double> extent = extents(one.scene);
  const double size = largest_size(one.scene);
  std::vector<double> calm;
  for (int k = 0; k < steps; ++k) {
    first.step(), second.step();
    const double off = distance(one.scene, extent, states_of(first), states_of(second));
    if (off <= 1e-7 * size) continue;
    if (calm.empty()) calm = growth(one, engine, motion);
    const auto at = static_cast<std::size_t>(k) + 1;
    // Perturbations of 3e-5 grow to `calm`, so an error of the tolerance 1e-10 grows to 3e-6 of that.
    if (at >= calm.size() || off <= 1e-7 * size + 1e-3 * calm[at] || calm[at] > 0.03 * size) return {};
    return fmt::format(
        "differs by {:.3g} m with another method at {:.3g} s; a perturbation has grown to {:.2g} m", off,
        first.time(), calm[at]);
  }
  return {};
}

bool is_precise(const Engine& engine) { return engine.kind == Engine::Kind::Precise; }

}  // namespace

bool on_precise(const Case& one, const Engine& engine) { return is_precise(engine) && !one.world_only(); }

Verdict forces(const Case& one, const Engine&, const Motion&) {
  return judged("forces",
                "mass times acceleration is the sum of the forces of joints, contacts and force laws",
                [&] { return balanced(one); });
}
Verdict derivatives(const Case& one, const Engine&, const Motion&) {
  return judged("derivatives", "sensitivities agree with finite differences, or are rejected",
                [&] { return derived(one); });
}
Verdict estimates(const Case& one, const Engine&, const Motion&) {
  return judged("estimates", "an error estimate has the size of the error", [&] { return estimated(one); });
}
Verdict starts(const Case& one, const Engine&, const Motion&) {
  return judged("starts", "overlaps and open joints at the start are rejected",
                [&] { return refuses_start(one); });
}
Verdict methods(const Case& one, const Engine& engine, const Motion& motion) {
  return judged("methods", "the motion is the same by each method of integration",
                [&] { return alike_by_methods(one, motion, engine); });
}
}  // namespace plumb::harness::hunt
