#include "scenarios/truth/pushes.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "scenarios/truth/fresnel.h"
#include "scenarios/truth/stepping.h"
#include "scenarios/truth/trajectory.h"

namespace plumb::scenarios::truth {
namespace {

/// A force of fixed direction in the world at the point p of the body, for kPush: I angle'' = R(angle) p x F,
/// the equation of a pendulum; then the body coasts. The centre accelerates along F: x'' = F/m.
class Pushed {
 public:
  Pushed(const Body& body, const PointForce& push)
      : start_(motion_of(body)),
        linear_(1 / static_cast<Real>(body.mass) * push.force.as<Real>()),
        force_(1 / static_cast<Real>(*body.inertia) * push.force.as<Real>()),
        point_(push.point.as<Real>()),
        turning_(
            {start_.angle, start_.angular_velocity},
            [force = force_, point = point_](const Trajectory::State& y, Trajectory::State& rate) {
              rate = {y[1], cross(turned(y[0], point), force)};
            },
            1.0L / 64) {}

  Acceleration acceleration(const Motion& motion) const {
    return {linear_, cross(turned(motion.angle, point_), force_)};
  }

  Motion at(Real time) const {
    const Real pushed = std::fmin(time, static_cast<Real>(kPush));
    Motion motion = coast(start_, pushed, {linear_});
    const Trajectory::State turn = turning_.at(pushed);
    motion.angle = turn[0];
    motion.angular_velocity = turn[1];
    return coast(motion, time - pushed);
  }

 private:
  Motion start_;
  Vec2<Real> linear_, force_, point_;  // force_ over the inertia
  Trajectory turning_;
};

}  // namespace

Body free_box(std::string name, double mass, double width, double height, Vec2d position) {
  Body body = piece(std::move(name), position, untouchable(Box{width, height}), mass);
  body.inertia = mass * (width * width + height * height) / 12;
  return body;
}

Problem pushed(Scene scene) {
  std::vector<std::shared_ptr<const Pushed>> bodies;
  double strongest = 0;  // F/m
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const auto& push = std::get<PointForce>(scene.forces[i]);
    bodies.push_back(std::make_shared<const Pushed>(scene.bodies[i], push));
    strongest = std::max(strongest, std::sqrt(length_squared(push.force)) / scene.bodies[i].mass);
  }
  Problem problem{.scene = std::move(scene), .duration = kWatch};
  const auto law = [bodies](std::size_t i, double time, const Motion& motion) {
    return time < kPush * (1 - 1e-9) ? bodies[i]->acceleration(motion) : Acceleration{};
  };
  // If the push ends within a step, the engine may choose which part of it counts.
  const auto ends_on_a_step = [](double substep) {
    const double steps = kPush / substep;
    return std::fabs(steps - std::round(steps)) < 1e-9 * steps;
  };
  problem.truth = {.source = "I angle'' = r x F, long double Runge-Kutta-Fehlberg 7(8); x'' = F/m",
                   .exact =
                       [bodies](double time, std::span<BodyState> out) {
                         std::ranges::transform(bodies, out.begin(),
                                                [&](const auto& body) { return rounded(body->at(time)); });
                       },
                   .discrete = discrete_euler(motions_of(problem.scene), law, ends_on_a_step),
                   .kind = TruthKind::Integrated};
  problem.precise = {.position = 1e-9, .angle = 1e-9, .velocity = 1e-9, .angular_velocity = 1e-9};
  // The centre has a constant acceleration, which velocity Verlet integrates exactly, except in the substep
  // in which the push ends. With its mean force F s (0 < s < 1) the velocity is right, and the displacement
  // is off by (F/m) h^2 s (1 - s)/2 <= F/m h^2/8.
  problem.second_order = {.position = strongest / 8, .velocity = 0};
  return problem;
}

Problem thrust(Scene scene) {
  Problem problem{.scene = std::move(scene), .duration = kWatch};
  const Body& body = problem.scene.bodies[0];
  const auto& push = std::get<PointForce>(problem.scene.forces[0]);
  const Real alpha = cross(push.point, push.force) / static_cast<Real>(*body.inertia);
  const Vec2<Real> linear = 1 / static_cast<Real>(body.mass) * push.force.as<Real>();
  const auto law = [=](std::size_t, double, const Motion& motion) -> Acceleration {
    return {turned(motion.angle, linear), alpha};
  };
  problem.truth = {
      .source = "Fresnel integrals",
      .exact = [=](double time,
                   std::span<BodyState> out) { out[0] = rounded(truth::thruster(linear, alpha, time)); },
      .discrete = discrete_euler(motions_of(problem.scene), law)};
  problem.precise = {.position = 1e-9, .angle = 1e-9, .velocity = 1e-9, .angular_velocity = 1e-9};
  // The torque is constant, so the angle is exact. Velocity Verlet gives x(t + h) - 2 x(t) + x(t - h) = h^2
  // a(t), and the motion has h^4 a''/12 more. Summed twice, and with a'(0) = 0, that is h^2 (a(t) - a(0))/12
  // <= h^2 |a|/6. The trapezoidal velocity is off by h^2 (a'(t) - a'(0))/12 = h^2 alpha t |a|/12. Higher
  // terms add less than a tenth while the body turns less than a radian a substep.
  const double a = static_cast<double>(linear.x);
  problem.second_order = {.position = 1.1 * a / 6,
                          .angle = 0,
                          .velocity = 1.1 * static_cast<double>(alpha) * kWatch * a / 12,
                          .angular_velocity = 0};
  return problem;
}

Problem coasting(Scene scene) {
  Problem problem{.scene = std::move(scene), .duration = kSpins};
  const double rate = problem.scene.bodies[0].angular_velocity;
  const std::vector<Motion> start = motions_of(problem.scene);
  problem.truth = {.source = "angle0 + w t (Newton's first law)",
                   .exact =
                       [=](double time, std::span<BodyState> out) {
                         std::ranges::transform(start, out.begin(),
                                                [&](const Motion& m) { return rounded(coast(m, time)); });
                       },
                   .discrete = discrete_constant(start, std::vector<Acceleration>(start.size()))};
  problem.conserved = {.energy = true, .momentum_x = true, .momentum_y = true, .angular_momentum = true};
  // Relative 1e-12 of the rotation and of the extent of about ten metres.
  problem.precise = {.position = 1e-12 * 10,
                     .angle = 1e-12 * rate * kSpins,
                     .velocity = 1e-12,
                     .angular_velocity = 1e-12 * rate,
                     .energy = 1e-12,
                     .momentum = 1e-12,
                     .angular_momentum = 1e-12};
  problem.second_order = {.position = 0,
                          .angle = 0,
                          .velocity = 0,
                          .angular_velocity = 0,
                          .energy = 0,
                          .momentum = 0,
                          .angular_momentum = 0};
  return problem;
}

}  // namespace plumb::scenarios::truth
