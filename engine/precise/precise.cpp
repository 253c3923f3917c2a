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
constexpr int kMostImpacts = 1000000, kMostSteps = 200000;
/// Maximum length of a flight, as a multiple of the last one.
constexpr double kLonger = 2;
/// Fraction of the scene's length: an initial overlap deeper than this is an error at any tolerance.
constexpr double kDeepestOverlap = 1e-3;
/// Number of roundings of a position by which joints may be open at the start.
constexpr double kGapRoundings = 16;

}  // namespace

void PreciseDriver::step() {
  const double end = static_cast<double>(grid_steps_ + 1) * max_dt_;
  steps_in_step_ = 0;
  impacts_before_ = contacts_.impacts();
  try {
    close_joints();
    while (smooth_.time() < end) go_on(end);
  } catch (const Error& error) {
    time_ = smooth_.time();
    fail(error.subject(), error.field(), error.value(), error.problem());
  }
  time_ = end;
  check_finite();
  ++grid_steps_;
  report_cost();
}

/// Advances the motion by one step. The step may go beyond `end`, because states are interpolated within it:
/// step sizes do not depend on the output times. An event ends a step.
void PreciseDriver::go_on(double end) {
  decide();
  {
    const Clock clock(profiling_, cost_[kRungeKutta]);
    smooth_.step(limit_of_step(end));
  }
  if (!contacts_.empty()) {
    const Clock clock(profiling_, cost_[kContactSearch]);
    contacts_.stop();  // at the first event within the step
    if (!contacts_.settled()) {
      last_flight_ = smooth_.time() - last_event_;
      last_event_ = smooth_.time();
    }
  }
  if (smooth_.dimension() > 0) invariants_.account(smooth_);
  if (++steps_in_step_ > kMostSteps) smooth_.throw_step_underflow();
  if (contacts_.impacts() - impacts_before_ > kMostImpacts) {
    fail("the scene", "impacts", std::to_string(kMostImpacts) + " and more",
         "they do not stop within one step; Realtime may do");
  }
  ++statistics_.steps;
}

/// Determines the forces, contacts, limits and motors of the next step.
void PreciseDriver::decide() {
  follow();
  arrive();
  if (!contacts_.empty() && !contacts_.settled()) settle();
}

/// Resolves the event at which the last step ended.
void PreciseDriver::settle() {
  const Clock clock(profiling_, cost_[kContacts]);
  if (!sensitivities_) return contacts_.settle();
  const Compensated before = smooth_.state();
  contacts_.settle();
  sensitivities_->pass_event(before, smooth_.state(), contacts_);
}

/// Without contacts, only the motion limits the step. Ballistic flights may have any length, but longer ones
/// have more candidate contacts. So the limit is twice the previous flight, or twice the present one so far.
double PreciseDriver::limit_of_step(double end) const {
  if (smooth_.dimension() == 0) return end;
  if (contacts_.empty()) return std::numeric_limits<double>::infinity();
  return smooth_.flies()
             ? std::max(end, smooth_.time() + kLonger * std::max(last_flight_, smooth_.time() - last_event_))
             : end;
}

/// Switches forces that change at the end of the last step.
void PreciseDriver::arrive() {
  const double now = smooth_.time();
  if (!std::binary_search(parts_.switches.begin(), parts_.switches.end(), now)) return;
  flight_.switch_forces(now);
  if (sensitivities_) sensitivities_->switch_forces(now);
  contacts_.unsettle();
}

PreciseDriver::PreciseDriver(const Scene& scene, const Precise& precise, const CompileOptions& options,
                             std::vector<Variation> variations)
    : max_dt_(precise.max_dt),
      overlap_(std::min(precise.tolerance, kDeepestOverlap)),
      parts_(divide(scene)),
      plan_(plan_of(scene, parts_, options.every_stage)),
      flight_(scene, parts_),
      equations_(scene, parts_, flight_, options.every_stage, precise.tolerance),
      smooth_(scene, parts_, precise, equations_),
      sample_(equations_.dimension()),
      contacts_(scene, parts_, flight_, equations_, smooth_),
      invariants_(scene, parts_, precise, equations_) {
  for (const Body& body : scene.bodies) {
    names_.push_back(body.name);
    at_rest_.push_back(body.type == BodyType::Static);
    locked_.push_back(body.fixed_rotation);
  }
  if (!variations.empty())
    sensitivities_ = std::make_unique<Sensitivities>(scene, std::move(variations), precise);
  name_redundant_joints();
  const double rounding = kGapRoundings * equations_.rounding_of_gaps(), length = equations_.length();
  for (const JointStart& start : joint_starts(scene)) {
    const double allowed = overlap_ * (start.turns ? 1 : length) + rounding;
    if (start.gap > allowed && start.gap > open_.gap) open_ = start;
  }
}

void PreciseDriver::name_redundant_joints() {
  std::string names;
  for (const std::string& joint : smooth_.redundant_joints())
    names += (names.empty() ? "'" : ", '") + joint + "'";
  if (!names.empty())
    plan_.stages[kJointAccelerations].why +=
        "; redundant where they start, and without force of their own: " + names;
}

/// Closes joints and their velocities: at the start, and after bodies were changed from outside.
void PreciseDriver::close_joints() {
  if (joints_closed_) return;
  refuse_open_joints();
  const Compensated given = smooth_.state();
  smooth_.start_anew();
  if (sensitivities_) sensitivities_->start(smooth_.time(), given, smooth_.state());
  if (!contacts_.empty()) contacts_.refuse_overlaps(overlap_);
  contacts_.unsettle();
  joints_closed_ = true;
}

/// At the start of a run joints must be closed, because no law says how they would close.
void PreciseDriver::refuse_open_joints() const {
  if (open_.gap == 0 || written_ || smooth_.time() > 0) return;
  throw Error(Error::Kind::Run, "joint '" + open_.joint + "'", "gap",
              shortest(open_.gap) + (open_.turns ? " rad" : " m"),
              "it is open, too long or beyond its limit where the scene starts, by more than tolerance " +
                  shortest(overlap_) +
                  " allows, and no law says how it closes: place its bodies, anchors or lengths so that they "
                  "fit; 'plumb' closes it");
}

std::size_t PreciseDriver::slot_of(std::size_t body) const {
  const auto place = std::lower_bound(parts_.integrated.begin(), parts_.integrated.end(), body);
  return static_cast<std::size_t>(place - parts_.integrated.begin());
}

}  // namespace plumb::precise

namespace plumb {

std::unique_ptr<Driver> make_precise_driver(const Scene& given, const Precise& precise,
                                            CompileOptions options) {
  const Vec2d origin = precise::local_origin(precise::with_body_laws(given));
  const auto prepared = [&](const Scene& scene) {
    const Scene whole = precise::with_body_laws(scene);
    return origin == Vec2d{} ? whole : precise::seen_from(whole, origin);
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
