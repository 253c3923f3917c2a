#include "harness/truth_table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <variant>

#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/magnitude.h"
#include "reference/support/plain_scene.h"

namespace plumb::harness {
namespace {

constexpr int kRefinement = 4;
constexpr std::size_t kMemory = std::size_t{256} << 20;  // bytes

}  // namespace

int step_count(double duration, double dt) {
  return std::max(1, static_cast<int>(std::floor(duration / dt + 1e-6)));
}

TruthTable::TruthTable(const scenarios::Problem& problem, double dt)
    : dt_(dt), steps_(step_count(problem.duration, dt)), bodies_(problem.scene.bodies.size()) {
  if (problem.truth.exact) {
    const std::size_t coarse = (static_cast<std::size_t>(steps_) + 1) * bodies_ * sizeof(BodyState);
    refinement_ = std::clamp(static_cast<int>(kMemory / std::max<std::size_t>(coarse, 1)), 1, kRefinement);
    const long samples = static_cast<long>(steps_) * refinement_ + 1;
    states_.resize(static_cast<std::size_t>(samples) * bodies_);
    for (long i = 0; i < samples; ++i) {
      if (interrupted()) throw Error(Error::Kind::Run, "the run", "", "", "was interrupted");
      problem.truth.exact(fine_time(i), {states_.data() + static_cast<std::size_t>(i) * bodies_, bodies_});
    }
  }
  impacts_ = find_impacts(problem);
  measure(problem.scene);
}

std::span<const BodyState> TruthTable::fine(long index) const {
  return {states_.data() + static_cast<std::size_t>(index) * bodies_, bodies_};
}

double TruthTable::fine_time(long index) const {
  // At the sample of a step the time is exactly k * dt, as on the engines' clocks.
  const long whole = index / refinement_, part = index % refinement_;
  return static_cast<double>(whole) * dt_ + dt_ * static_cast<double>(part) / refinement_;
}

namespace {

// Returns the sum of the largest accelerations that the force laws give to their bodies: constant and
// sinusoidal forces, springs and attractions by their lengths at the start, m/s^2.
double largest_push(const Scene& scene) {
  const auto mass_of = [&](const std::string& name) {
    const auto index = find_body(scene, name);
    const bool moves = index && scene.bodies[*index].type == BodyType::Dynamic;
    return moves ? scene.bodies[*index].mass : std::numeric_limits<double>::infinity();
  };
  const auto apart = [&](const std::string& a, Vec2d at_a, const std::string& b, Vec2d at_b) {
    return magnitude(reference::anchor_in_world(scene, b, at_b) - reference::anchor_in_world(scene, a, at_a));
  };
  double sum = 0;
  for (const ForceLaw& law : scene.forces) {
    if (const auto* push = std::get_if<PointForce>(&law)) {
      sum += magnitude(push->force) / mass_of(push->body);
    } else if (const auto* swing = std::get_if<SinusoidalForce>(&law)) {
      sum += magnitude(swing->amplitude) / mass_of(swing->body);
    } else if (const auto* spring = std::get_if<SpringForce>(&law)) {
      const double length = apart(spring->body_a, spring->anchor_a, spring->body_b, spring->anchor_b);
      sum += spring->stiffness * std::abs(length - spring->rest_length) /
             std::min(mass_of(spring->body_a), mass_of(spring->body_b));
    } else if (const auto* pull = std::get_if<AttractionForce>(&law)) {
      const double distance = apart(pull->body, {}, pull->centre_body, pull->centre);
      const double mass = mass_of(pull->body);
      if (distance > 0 && std::isfinite(mass))
        sum += std::abs(pull->strength) * std::pow(distance, -pull->exponent) *
               std::max(1.0, mass / mass_of(pull->centre_body));
    }
  }
  return sum;
}

}  // namespace

void TruthTable::measure(const Scene& scene) {
  scale_.duration = steps_ * dt_;
  scale_.angle = std::numbers::pi;
  Vec2d low{}, high{};
  bool first = true;
  const auto include = [&](std::size_t body, const BodyState& state) {
    const double radius = bounding_radius(scene.bodies[body]);
    scale_.length = std::max({scale_.length, std::abs(state.position.x), std::abs(state.position.y)});
    scale_.speed = std::max(scale_.speed, magnitude(state.velocity));
    scale_.angle = std::max(scale_.angle, std::abs(state.angle));
    scale_.angular_speed = std::max(scale_.angular_speed, std::abs(state.angular_velocity));
    const Vec2d a = state.position - Vec2d{radius, radius}, b = state.position + Vec2d{radius, radius};
    low = first ? a : Vec2d{std::min(low.x, a.x), std::min(low.y, a.y)};
    high = first ? b : Vec2d{std::max(high.x, b.x), std::max(high.y, b.y)};
    first = false;
  };
  for (std::size_t i = 0; i < bodies_; ++i) include(i, initial_state(scene.bodies[i]));
  for (std::size_t k = 0; k < states_.size(); ++k) include(k % bodies_, states_[k]);
  if (!known()) {
    // Without a truth, use the length and speed that gravity, forces and the initial speeds can reach.
    double pulled = 0;
    for (const Body& body : scene.bodies) pulled = std::max(pulled, std::abs(body.gravity_scale));
    scale_.speed += pulled * magnitude(scene.gravity) * scale_.duration;
    high += Vec2d{(scale_.speed + largest_push(scene) * scale_.duration) * scale_.duration, 0};
  }
  scale_.extent = std::max(magnitude(high - low), 1e-3);
  measure_joints(scene);
  for (const Impact& impact : impacts_) {
    double most = 0;
    for (const Jump& jump : impact.jumps) {
      const Body& body = scene.bodies[jump.body];
      const double inertia = body.type == BodyType::Dynamic ? inertia_of(body) : 0;
      if (inertia > 0) most = std::max(most, magnitude(jump.velocity) * body.mass / inertia);
    }
    scale_.impact_spin += most * (scale_.length + scale_.extent);
  }
}

void TruthTable::measure_joints(const Scene& scene) {
  double nearest = std::numeric_limits<double>::infinity();
  const auto include = [&](const std::string& name, Vec2d anchor) {
    const double arm = magnitude(anchor);
    if (name != kWorld && arm > 0) nearest = std::min(nearest, arm);
  };
  for (const Joint& joint : scene.joints) {
    std::visit(
        [&](const auto& j) {
          if constexpr (requires { j.anchor_a; }) include(j.body_a, j.anchor_a);
          if constexpr (requires { j.anchor_b; }) include(j.body_b, j.anchor_b);
        },
        joint);
  }
  if (!scene.joints.empty()) scale_.joint_length = scale_.length + scale_.extent;
  if (std::isfinite(nearest)) scale_.joint_arm = nearest;
}

}  // namespace plumb::harness
