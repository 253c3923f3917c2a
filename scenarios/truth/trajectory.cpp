#include "scenarios/truth/trajectory.h"

#include <algorithm>
#include <boost/numeric/odeint.hpp>
#include <cstddef>
#include <utility>

namespace plumb::scenarios::truth {

namespace odeint = boost::numeric::odeint;

Trajectory::Trajectory(State start, Law law, Real spacing, Real tolerance)
    : law_(std::move(law)), spacing_(spacing), tolerance_(tolerance), grid_{std::move(start)} {}

Trajectory::State Trajectory::at(Real time) const {
  const auto index = static_cast<std::size_t>(std::max<Real>(0, time / spacing_));
  for (std::size_t k = grid_.size(); k <= index; ++k) {
    State next = grid_.back();
    advance(next, spacing_ * (k - 1), spacing_ * k);
    grid_.push_back(std::move(next));
  }
  State y = grid_[index];
  advance(y, spacing_ * index, time);
  return y;
}

void Trajectory::advance(State& y, Real from, Real to) const {
  if (!(to > from)) return;
  using Stepper = odeint::runge_kutta_fehlberg78<State, Real, State, Real>;
  const auto system = [this](const State& state, State& rate, Real) { law_(state, rate); };
  odeint::integrate_adaptive(odeint::make_controlled<Stepper>(tolerance_, tolerance_), system, y, from, to,
                             to - from);
}

}  // namespace plumb::scenarios::truth
