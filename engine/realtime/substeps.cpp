#include "engine/realtime/substeps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>
#include <vector>

#include "engine/core/text.h"
#include "engine/forces/compile.h"
#include "engine/realtime/hinge_modes.h"

namespace plumb {
namespace {

/// Largest w h of a mode that moves: energy off by 1.6 % at most.
constexpr double kFollowed = 0.25;
/// Largest decay of a damper's velocity in a substep, as c h / m.
constexpr double kDamped = 0.5;
/// From here on a mode that should not move is in danger of growing, and where it is brought to: a chain that
/// swings pulls with up to three times its weight, which is 3^(1/2) in w.
constexpr double kEndangered = 1.4, kHeld = 1;

/// How far what rests may fall in a substep, g h^2/2, of its width; in as many substeps as are worth it: what
/// falls faster has fallen through its neighbours before they meet.
constexpr double kFall = 0.002, kMostForFall = 1000;

/// 1/s^2: g over the width of the narrowest shape that falls.
double fall_rate(const Scene& scene) {
  double narrowest = std::numeric_limits<double>::infinity();
  for (const Body& body : scene.bodies) {
    if (body.type != BodyType::Dynamic) continue;
    for (const Shape& shape : body.shapes) {
      const auto* circle = std::get_if<Circle>(&shape.geometry);
      const auto* box = std::get_if<Box>(&shape.geometry);
      if (circle) narrowest = std::min(narrowest, 2 * circle->radius);
      if (box) narrowest = std::min({narrowest, box->width, box->height});
    }
  }
  return std::sqrt(length_squared(scene.gravity)) / narrowest;
}

/// 1/kg: what the end of a law gives way by.
double give(const Body& body, Vec2d anchor) {
  if (body.type != BodyType::Dynamic) return 0;
  const double inertia = inertia_of(body);
  return 1 / body.mass + (inertia > 0 ? length_squared(anchor) / inertia : 0);
}

/// Bounds on the largest frequency of springs and the largest decay rate of their dampers, 1/s: the largest
/// eigenvalue of a matrix is at most its largest sum of a row (Gershgorin 1931).
struct Rates {
  double frequency = 0, decay = 0;
};

Rates spring_rates(const Scene& scene) {
  const LawCompiler<double> compiler(scene);
  std::vector<SpringForceLaw<double>> springs;
  std::vector<double> stiff(scene.bodies.size(), 0), slow(scene.bodies.size(), 0);
  const auto ends = [&](const SpringForceLaw<double>& spring, auto&& use) {
    if (spring.a != kFixedFrame) use(spring.a, give(scene.bodies[spring.a], spring.anchor_a));
    if (spring.b != kFixedFrame) use(spring.b, give(scene.bodies[spring.b], spring.anchor_b));
  };
  Rates rates;
  double curved = 0;
  for (const ForceLaw& law : scene.forces) {
    if (const auto* pull = std::get_if<AttractionForce>(&law); pull && pull->exponent == -1)
      curved = std::max(curved, pull->strength);
    if (const auto* spring = std::get_if<SpringForce>(&law)) springs.push_back(compiler.compile(*spring));
  }
  for (const auto& spring : springs)
    ends(spring, [&](int body, double by) {
      stiff[body] += std::sqrt(spring.stiffness * by), slow[body] += std::sqrt(spring.damping * by);
    });
  for (const auto& spring : springs) {
    double row = 0, damped = 0;
    ends(spring, [&](int body, double by) {
      row += std::sqrt(spring.stiffness * by) * stiff[body];
      damped += std::sqrt(spring.damping * by) * slow[body];
    });
    curved = std::max(curved, row), rates.decay = std::max(rates.decay, damped);
  }
  rates.frequency = std::sqrt(curved);
  return rates;
}

}  // namespace

SubstepPlan plan_substeps(const Scene& scene, const Realtime& accuracy, bool touching) {
  SubstepPlan plan{static_cast<double>(accuracy.substeps), "as asked for"};
  if (accuracy.integrator != Integrator::VelocityVerlet) return plan;
  // Rounding must not make one more.
  const auto ask = [&](double rate, double most, const std::string& what) {
    const double count = std::ceil(rate * accuracy.dt / most * (1 - 1e-9));
    if (!(count > plan.count)) return;
    plan = {count, what + " of " + shortest(std::round(rate * 100) / 100) + "/s"};
  };
  if (!scene.forces.empty()) {
    const Rates rates = spring_rates(scene);
    ask(rates.frequency, kFollowed, "springs have a frequency");
    ask(rates.decay, kDamped, "dampers have a rate");
  }
  if (!scene.joints.empty()) {
    const HingeModes modes = hinge_modes(scene);
    ask(modes.pendulum, kFollowed, "a pendulum has a frequency");
    if (modes.link * accuracy.dt > kEndangered * plan.count)
      ask(modes.link, kHeld, "links that carry a load have a frequency");
  }
  if (touching)
    ask(std::min(std::sqrt(fall_rate(scene) / (2 * kFall)), kMostForFall / accuracy.dt), 1,
        "what rests would fall into others at a rate");
  plan.count = std::min(plan.count, 2.0 * kMostSubsteps);
  return plan;
}

}  // namespace plumb
