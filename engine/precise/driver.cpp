#include "engine/precise/driver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/text.h"
#include "engine/precise/dynamics/clock.h"
#include "engine/precise/events/state_members.h"
#include "engine/scene/error.h"

// All of the driver but its step: reading and writing, snapshots, errors, costs.
namespace plumb::precise {

void PreciseDriver::read(std::span<BodyState> out) const {
  for (const std::size_t body : partition_.ballistic) out[body] = ballistic_.at(body, time_).state;
  if (sampled_ != time_) integrator_.at(time_, true, sample_);
  sampled_ = time_;
  for (std::size_t slot = 0; slot < partition_.integrated.size(); ++slot) {
    out[partition_.integrated[slot]] = EquationsOfMotion::state(sample_.value(), slot);
  }
}

Reactions PreciseDriver::reactions() {
  if (partition_.integrated.empty()) return {};
  if (!joints_closed_) return reactions_of_next_step();
  if (sampled_ != time_) integrator_.at(time_, true, sample_);
  sampled_ = time_;
  return equations_.reactions(time_, sample_.value());
}

/// Computes the forces with which the next step begins. Before the first step, and after bodies were changed
/// from outside, no step has yet closed the joints and decided about contacts, limits and motors, so this
/// does both. It restores the motion afterwards: a request for forces changes no bits.
Reactions PreciseDriver::reactions_of_next_step() {
  const std::vector<std::byte> before = save();
  const bool written = written_;
  const auto put_back = [&] {
    load(before);
    written_ = written;
  };
  Reactions out;
  try {
    close_joints();
    prepare_step();
    equations_.set_window(time_, time_);
    out = equations_.reactions(time_, integrator_.state().value());
  } catch (...) {
    put_back();
    throw;
  }
  put_back();
  return out;
}

void PreciseDriver::write(std::size_t body, const BodyState& state) {
  BodyState allowed = state;
  if (is_static_[body]) allowed.velocity = {};
  if (is_static_[body] || locked_[body]) allowed.angular_velocity = 0;
  integrator_.rewind(time_);
  advance_sensitivities();
  contacts_.release();
  const auto slot = ballistic_.contains(body) ? std::nullopt : std::optional(slot_of(body));
  if (sensitivities_) sensitivities_->write(body, slot, time_, allowed);
  if (ballistic_.contains(body)) {
    ballistic_.restart(body, time_, allowed);
  } else {
    EquationsOfMotion::set_state(integrator_.mutable_state(), slot_of(body), allowed);
  }
  joints_closed_ = false;
  written_ = true;
  sampled_ = -1;
}

std::vector<BodyState> PreciseDriver::sensitivities(std::size_t parameter) {
  if (!sensitivities_ || parameter >= sensitivities_->size()) return Driver::sensitivities(parameter);
  // The last step may have crossed a singularity, which `follow` notices only before the next step.
  if (has_new_singularity())
    sensitivities_->throw_not_differentiable(parameter, NoDerivative::Singular, integrator_.start());
  return sensitivities_->at(parameter, time_, names_.size());
}

/// Advances the sensitivities to the end of the last step.
void PreciseDriver::advance_sensitivities() {
  if (!sensitivities_) return;
  if (has_new_singularity()) sensitivities_->fail_all(NoDerivative::Singular, integrator_.start());
  handled_singularities_ = integrator_.singularity_steps();
  sensitivities_->advance(integrator_.time(), integrator_.state());
}

void PreciseDriver::profile(bool on) {
  profiling_ = equations_.cost.on = on;
  equations_.cost.forces = equations_.cost.joints = integrator_.projection_nanoseconds = 0;
  for (Stage& stage : plan_.stages) stage.nanoseconds = 0;
  cost_ = {};
}

Statistics PreciseDriver::statistics() const {
  Statistics all = statistics_;
  all.evaluations = equations_.evaluations();
  all.rejected = integrator_.rejected();
  all.implicit = integrator_.implicit_steps();
  all.leaps = integrator_.singularity_steps();
  all.redundant_joints = static_cast<std::int64_t>(integrator_.redundant_joints().size());
  all.contacts = contacts_.events();
  all.impacts = contacts_.impacts();
  return all;
}

void PreciseDriver::check_finite() {
  const auto check = [&](std::size_t body, const BodyState& s) {
    const std::pair<const char*, double> numbers[] = {
        {"position.x", s.position.x}, {"position.y", s.position.y}, {"angle", s.angle},
        {"velocity.x", s.velocity.x}, {"velocity.y", s.velocity.y}, {"angular_velocity", s.angular_velocity}};
    for (const auto& [field, value] : numbers) {
      if (!std::isfinite(value)) fail("body '" + names_[body] + "'", field, shortest(value), "not finite");
    }
  };
  if (active(kPolynomialFlight)) {
    const Clock clock(profiling_, cost_[kPolynomialFlight]);
    for (const std::size_t body : partition_.ballistic) check(body, ballistic_.at(body, time_).state);
  }
  for (std::size_t slot = 0; slot < partition_.integrated.size(); ++slot) {
    check(partition_.integrated[slot], EquationsOfMotion::state(integrator_.state().value(), slot));
  }
}

void PreciseDriver::fail(const std::string& subject, const std::string& field, const std::string& value,
                         const std::string& problem) const {
  throw Error(Error::Kind::Run, subject, field, value,
              problem + ", in step " + std::to_string(grid_steps_ + 1) + " at t = " + shortest(time_) +
                  " s; the world is left at that time");
}

void PreciseDriver::report_cost() {
  if (!profiling_) return;
  cost_[kForces] = equations_.cost.forces;
  cost_[kJointAccelerations] = equations_.cost.joints;
  cost_[kProjection] = integrator_.projection_nanoseconds;
  for (int i = 0; i < kStageCount; ++i) plan_.stages[i].nanoseconds = cost_[i];
  double& rest = plan_.stages[kRungeKutta].nanoseconds;  // everything except evaluations and projection
  rest = std::max(0.0, rest - cost_[kForces] - cost_[kJointAccelerations] - cost_[kProjection]);
}

/// Writes a snapshot: numbers of 8 bytes, one after the other.
std::vector<std::byte> PreciseDriver::save() const {
  SnapshotWriter out;
  out.put(time_);
  out.put(last_event_);
  out.put(last_flight_);
  out.put(grid_steps_);
  out.put(std::int64_t{joints_closed_});
  out.put(statistics_.steps);
  contacts_.save(out);
  integrator_.save(time_, out);
  invariants_.save(out);
  out.put(equations_.evaluations());
  for (const BallisticMotion::Arc& arc : ballistic_.arcs()) out.put(arc);
  if (sensitivities_) {
    sensitivities_->save(out);
    out.put(handled_singularities_);
  }
  return out.bytes();
}

void PreciseDriver::restore(std::span<const std::byte> snapshot) {
  const std::vector<std::byte> before = save();
  try {
    load(snapshot);
  } catch (const Error&) {
    load(before);
    throw;
  }
}

void PreciseDriver::load(std::span<const std::byte> snapshot) {
  SnapshotReader in(snapshot);
  time_ = in.get<double>();
  last_event_ = in.get<double>();
  last_flight_ = in.get<double>();
  grid_steps_ = in.get<std::int64_t>();
  joints_closed_ = in.get<std::int64_t>() != 0;
  statistics_ = {};
  statistics_.steps = in.get<std::int64_t>();
  contacts_.restore(in);
  integrator_.restore(in);
  invariants_.restore(in);
  equations_.set_evaluations(in.get<std::int64_t>());
  for (BallisticMotion::Arc& arc : ballistic_.arcs()) arc = in.get<BallisticMotion::Arc>();
  if (sensitivities_) {
    sensitivities_->restore(in, contacts_);
    handled_singularities_ = in.get<std::int64_t>();
  }
  in.expect_end();
  written_ = true;  // its initial state no longer matters
  sampled_ = -1;
}

}  // namespace plumb::precise
