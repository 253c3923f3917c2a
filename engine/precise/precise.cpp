#include "engine/precise/precise.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/text.h"
#include "engine/precise/body_laws.h"
#include "engine/precise/driver.h"
#include "engine/precise/dynamics/clock.h"
#include "engine/precise/error_estimate.h"
#include "engine/precise/shifted_origin.h"
#include "engine/scene/error.h"

namespace plumb::precise {
namespace {

/// Limits on impacts and steps within one max_dt: beyond them the run counts as stuck.
constexpr int kMaxImpacts = 1000000, kMaxSteps = 200000;
/// Maximum length of a flight, as a multiple of the last one.
constexpr double kMaxFlightRatio = 2;
/// Fraction of the scene's length: an initial overlap deeper than this is an error at any tolerance.
constexpr double kMaxOverlap = 1e-3;
/// Number of roundings of a position by which joints may be open at the start.
constexpr double kGapRoundings = 16;

}  // namespace

void PreciseDriver::step() {
  const double end = static_cast<double>(grid_steps_ + 1) * max_dt_;
  steps_in_step_ = 0;
  impacts_before_ = contacts_.impacts();
  try {
    close_joints();
    while (integrator_.time() < end) advance(end);
  } catch (const Error& error) {
    time_ = integrator_.time();
    fail(error.subject(), error.field(), error.value(), error.problem());
  }
  time_ = end;
  check_finite();
  ++grid_steps_;
  report_cost();
}

/// Advances the motion by one step. The step may go beyond `end`, because states are interpolated within it:
/// step sizes do not depend on the output times. An event ends a step.
void PreciseDriver::advance(double end) {
  prepare_step();
  {
    const Clock clock(profiling_, cost_[kRungeKutta]);
    integrator_.step(limit_of_step(end));
  }
  if (!contacts_.empty()) {
    const Clock clock(profiling_, cost_[kContactSearch]);
    contacts_.truncate_at_event();  // at the first event within the step
    if (!contacts_.is_resolved()) {
      last_flight_ = integrator_.time() - last_event_;
      last_event_ = integrator_.time();
    }
  }
  if (integrator_.dimension() > 0) invariants_.account(integrator_);
  if (++steps_in_step_ > kMaxSteps) integrator_.throw_step_underflow();
  if (contacts_.impacts() - impacts_before_ > kMaxImpacts) {
    fail("the scene", "impacts", std::to_string(kMaxImpacts) + " and more",
         "they do not stop within one step; Realtime may do");
  }
  ++statistics_.steps;
}

/// Determines the forces, contacts, limits and motors of the next step.
void PreciseDriver::prepare_step() {
  advance_sensitivities();
  switch_forces();
  if (!contacts_.empty() && !contacts_.is_resolved()) resolve_event();
}

/// Resolves the event at which the last step ended.
void PreciseDriver::resolve_event() {
  const Clock clock(profiling_, cost_[kContacts]);
  if (!sensitivities_) return contacts_.resolve_event();
  const Compensated before = integrator_.state();
  contacts_.resolve_event();
  sensitivities_->pass_event(before, integrator_.state(), contacts_);
}

/// Without contacts, only the motion limits the step. Ballistic flights may have any length, but longer ones
/// have more candidate contacts. So the limit is twice the previous flight, or twice the present one so far.
double PreciseDriver::limit_of_step(double end) const {
  if (integrator_.dimension() == 0) return end;
  if (contacts_.empty()) return std::numeric_limits<double>::infinity();
  return integrator_.is_ballistic()
             ? std::max(end, integrator_.time() +
                                 kMaxFlightRatio * std::max(last_flight_, integrator_.time() - last_event_))
             : end;
}

/// Switches forces, prescribed motions and motors that change at the end of the last step.
void PreciseDriver::switch_forces() {
  const double now = integrator_.time();
  const bool formulas = equations_.next_switch() == now;
  if (!formulas && !std::binary_search(partition_.switches.begin(), partition_.switches.end(), now)) return;
  if (formulas) {
    // Contacts and joints of a prescribed body whose velocity jumps meet an impact: nothing holds them
    // together.
    if (equations_.prescribed_velocity_jumps(now)) contacts_.release();
    integrator_.pass_switch();
  }
  ballistic_.switch_forces(now);
  if (sensitivities_) sensitivities_->switch_forces(now);
  contacts_.invalidate();
}

PreciseDriver::PreciseDriver(const Scene& scene, const Precise& precise, const CompileOptions& options,
                             std::vector<Variation> variations)
    : max_dt_(precise.max_dt),
      overlap_tolerance_(std::min(precise.tolerance, kMaxOverlap)),
      partition_(partition_scene(scene)),
      plan_(plan_of(scene, partition_, options.every_stage)),
      ballistic_(scene, partition_),
      equations_(scene, partition_, ballistic_, options.every_stage, precise.tolerance),
      integrator_(scene, partition_, precise, equations_),
      sample_(equations_.dimension()),
      contacts_(scene, partition_, ballistic_, equations_, integrator_),
      invariants_(scene, partition_, precise, equations_) {
  for (const Body& body : scene.bodies) {
    names_.push_back(body.name);
    is_static_.push_back(body.type == BodyType::Static);
    locked_.push_back(body.fixed_rotation);
  }
  if (!variations.empty())
    sensitivities_ = std::make_unique<Sensitivities>(scene, std::move(variations), precise);
  report_redundant_joints();
  const double rounding = kGapRoundings * equations_.rounding_of_gaps(), length = equations_.length();
  for (const InitialJointError& start : initial_joint_errors(scene)) {
    const double allowed = overlap_tolerance_ * (start.is_angle ? 1 : length) + rounding;
    if (start.gap > allowed && start.gap > open_joint_.gap) open_joint_ = start;
  }
}

void PreciseDriver::report_redundant_joints() {
  std::string names;
  for (const std::string& joint : integrator_.redundant_joints())
    names += (names.empty() ? "'" : ", '") + joint + "'";
  if (!names.empty())
    plan_.stages[kJointAccelerations].why +=
        "; redundant where they start, and without force of their own: " + names;
}

/// Closes joints and their velocities: at the start, and after bodies were changed from outside.
void PreciseDriver::close_joints() {
  if (joints_closed_) return;
  check_initial_gaps();
  const Compensated given = integrator_.state();
  integrator_.reset();
  if (sensitivities_) sensitivities_->start(integrator_.time(), given, integrator_.state());
  if (!contacts_.empty()) contacts_.check_overlaps(overlap_tolerance_);
  contacts_.invalidate();
  joints_closed_ = true;
}

/// At the start of a run joints must be closed, because no law says how they would close.
void PreciseDriver::check_initial_gaps() const {
  if (open_joint_.gap == 0 || written_ || integrator_.time() > 0) return;
  throw Error(Error::Kind::Run, "joint '" + open_joint_.joint + "'", "gap",
              shortest(open_joint_.gap) + (open_joint_.is_angle ? " rad" : " m"),
              "it is open, too long or beyond its limit where the scene starts, by more than tolerance " +
                  shortest(overlap_tolerance_) +
                  " allows, and no law says how it closes: place its bodies, anchors or lengths so that they "
                  "fit; 'plumb' closes it");
}

std::size_t PreciseDriver::slot_of(std::size_t body) const {
  const auto place = std::lower_bound(partition_.integrated.begin(), partition_.integrated.end(), body);
  return static_cast<std::size_t>(place - partition_.integrated.begin());
}

}  // namespace plumb::precise

namespace plumb {

std::unique_ptr<Driver> make_precise_driver(const Scene& given, const Precise& precise,
                                            CompileOptions options) {
  const Vec2d origin = precise::local_origin(precise::with_body_laws(given));
  const auto prepared = [&](const Scene& scene) {
    const Scene whole = precise::with_body_laws(scene);
    return origin == Vec2d{} ? whole : precise::relative_to(whole, origin);
  };
  const auto make = [&](const Precise& p, const std::vector<std::string>& parameters) {
    auto driver = std::make_unique<precise::PreciseDriver>(
        prepared(given), p, options, precise::variations_of(given, parameters, prepared));
    if (origin == Vec2d{}) return std::unique_ptr<Driver>(std::move(driver));
    return std::unique_ptr<Driver>(std::make_unique<precise::ShiftedOriginDriver>(std::move(driver), origin));
  };
  if (!precise.estimate_error) return make(precise, options.parameters);
  return std::make_unique<precise::ErrorEstimatingDriver>(
      precise, given.bodies.size(), [&](const Precise& p) { return make(p, options.parameters); },
      [&](const Precise& p) { return make(p, {}); });
}

}  // namespace plumb
