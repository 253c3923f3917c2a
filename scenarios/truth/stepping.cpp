#include "scenarios/truth/stepping.h"

#include <memory>
#include <span>
#include <utility>

namespace plumb::scenarios::truth {
namespace {

using reference::Scheme;

/// A recurrence that continues from the last requested step.
struct Recurrence {
  std::vector<Motion> start;
  Law law;

  Scheme scheme{};
  double substep = 0;
  long steps = -1;
  std::vector<Motion> now{};

  void go_to(Scheme wanted_scheme, double wanted_substep, long wanted_steps) {
    if (wanted_scheme != scheme || wanted_substep != substep || steps < 0 || wanted_steps < steps) {
      scheme = wanted_scheme;
      substep = wanted_substep;
      steps = 0;
      now = start;
    }
    for (; steps < wanted_steps; ++steps) step();
  }

  void step() {
    const Real h = substep;
    const double time = static_cast<double>(steps) * substep;
    for (std::size_t i = 0; i < now.size(); ++i) {
      const Motion before = now[i];
      const Acceleration a = law(i, time, before);
      now[i].velocity += h * a.linear;
      now[i].angular_velocity += h * a.angular;
      const Motion& mover = scheme == Scheme::SemiImplicitEuler ? now[i] : before;
      now[i].position = before.position + h * mover.velocity;
      now[i].angle = before.angle + h * mover.angular_velocity;
    }
  }
};

}  // namespace

Discrete discrete_constant(std::vector<Motion> start, std::vector<Acceleration> accelerations) {
  return [start = std::move(start), accelerations = std::move(accelerations)](
             Scheme scheme, double substep, long steps, std::span<BodyState> out) {
    if (scheme == Scheme::Adaptive) return false;
    const Real h = substep, t = h * steps;
    const Real shift = scheme == Scheme::SemiImplicitEuler ? h * t / 2
                       : scheme == Scheme::ExplicitEuler   ? -h * t / 2
                                                           : 0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      Motion motion = coast(start[i], t, accelerations[i]);
      motion.position += shift * accelerations[i].linear;
      motion.angle += shift * accelerations[i].angular;
      out[i] = rounded(motion);
    }
    return true;
  };
}

Discrete discrete_euler(std::vector<Motion> start, Law law, std::function<bool(double)> usable) {
  auto recurrence = std::make_shared<Recurrence>(Recurrence{std::move(start), std::move(law)});
  return [recurrence = std::move(recurrence), usable = std::move(usable)](
             Scheme scheme, double substep, long steps, std::span<BodyState> out) {
    if (scheme != Scheme::SemiImplicitEuler && scheme != Scheme::ExplicitEuler) return false;
    if (!usable(substep)) return false;
    recurrence->go_to(scheme, substep, steps);
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = rounded(recurrence->now[i]);
    return true;
  };
}

}  // namespace plumb::scenarios::truth
