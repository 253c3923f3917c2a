#include "engine/simulation/precise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/scene/error.h"
#include "engine/simulation/precise_clock.h"
#include "engine/simulation/precise_driver.h"

namespace plumb::precise {
namespace {

/// Impacts, and steps, within one max_dt: more of them do not end.
constexpr int kMostImpacts = 20000, kMostSteps = 200000;

}  // namespace

void PreciseDriver::step() {
  const double end = static_cast<double>(grid_steps_ + 1) * max_dt_;
  impacts_in_step_ = steps_in_step_ = 0;
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

/// One step of the motion. It may go beyond `end`, and what is read there lies within it: steps do not depend
/// on how often they are looked at. Events do end it.
void PreciseDriver::go_on(double end) {
  arrive();
  if (active(kResolve)) resolve_impacts();
  // Polynomials are exact over any time; their impacts are looked for as far as is asked for.
  const bool as_asked = smooth_.dimension() == 0 || !parts_.discs.empty();
  double limit = as_asked ? end : std::numeric_limits<double>::infinity();
  if (active(kImpactSearch)) limit = std::min(limit, smooth_.time() + impacts_.longest_step(start_));
  {
    const Clock clock(profiling_, cost_[kRungeKutta]);
    smooth_.step(limit);
  }
  if (active(kImpactSearch)) stop_at_impact(smooth_.time());  // the first one on the way
  if (++steps_in_step_ > kMostSteps) smooth_.blame_fastest();
  ++statistics_.steps;
}

/// Where the last step ended, forces may be switched.
void PreciseDriver::arrive() {
  const double now = smooth_.time();
  if (std::binary_search(parts_.switches.begin(), parts_.switches.end(), now)) flight_.switch_forces(now);
}

PreciseDriver::PreciseDriver(const Scene& scene, const Precise& precise, CompileOptions options)
    : max_dt_(precise.max_dt),
      parts_(divide(scene)),
      plan_(plan_of(scene, parts_, options.every_stage)),
      flight_(scene, parts_),
      equations_(scene, parts_, flight_, options.every_stage),
      smooth_(scene, parts_, precise, equations_),
      sample_(equations_.dimension()),
      impacts_(scene, parts_),
      start_(scene.bodies.size()),
      end_(scene.bodies.size()),
      normal_response_(scene.bodies.size()),
      tangent_response_(scene.bodies.size()) {
  for (const Body& body : scene.bodies) {
    names_.push_back(body.name);
    at_rest_.push_back(body.type == BodyType::Static);
    locked_.push_back(body.fixed_rotation);
  }
  name_redundant_joints();
}

void PreciseDriver::name_redundant_joints() {
  std::string names;
  for (const std::string& joint : smooth_.redundant_joints())
    names += (names.empty() ? "'" : ", '") + joint + "'";
  if (!names.empty())
    plan_.stages[kJointAccelerations].why +=
        "; redundant where they start, and without force of their own: " + names;
}

/// Once, and after bodies were moved from outside: closes joints and their velocities.
void PreciseDriver::close_joints() {
  if (joints_closed_) return;
  smooth_.start_anew();
  joints_closed_ = true;
}

/// Pairs that touch and approach bounce, one after the other, until none does.
void PreciseDriver::resolve_impacts() {
  const Clock clock(profiling_, cost_[kResolve]);
  const double now = smooth_.time();
  motions(now, smooth_.state().value(), {}, start_);
  while (const auto impact = impacts_.touching(now, start_)) {
    if (++impacts_in_step_ > kMostImpacts) {
      const auto name = [&](std::size_t disc) { return "'" + names_[impacts_.discs()[disc].body] + "'"; };
      fail("bodies " + name(impact->disc_a) + " and " + name(impact->disc_b), "impacts",
           std::to_string(kMostImpacts) + " and more",
           "they do not stop: Precise has no resting contact; use Realtime");
    }
    strike(*impact);
    motions(now, smooth_.state().value(), {}, start_);
  }
}

/// One impact: impulses along its normal and tangent, which joints pass on.
void PreciseDriver::strike(const Impact& impact) {
  const auto [normal, tangent] = impacts_.directions(impact, start_);
  const double now = smooth_.time();
  equations_.respond(now, smooth_.state().value(), normal, normal_response_);
  equations_.respond(now, smooth_.state().value(), tangent, tangent_response_);
  const std::size_t a = normal.a, b = normal.b;
  const auto along = [&](const Row<double>& row, const Twist<double>& of_a, const Twist<double>& of_b) {
    return dot(row.linear_a, of_a.velocity) + row.angular_a * of_a.angular_velocity +
           dot(row.linear_b, of_b.velocity) + row.angular_b * of_b.angular_velocity;
  };
  const auto twist = [&](std::size_t body) {
    return Twist<double>{start_[body].state.velocity, start_[body].state.angular_velocity};
  };
  const double nn = along(normal, normal_response_[a], normal_response_[b]);
  if (!(nn > 0))
    fail("body '" + names_[a] + "'", "effective mass", "infinite",
         "an impact meets joints that hold everything fast: nothing can give way");
  const auto [push, rub] =
      impacts_.impulse(impact, along(normal, twist(a), twist(b)), along(tangent, twist(a), twist(b)), nn,
                       along(tangent, normal_response_[a], normal_response_[b]),
                       along(tangent, tangent_response_[a], tangent_response_[b]));
  for (const std::size_t body : {a, b}) {
    if (!flight_.holds(body)) continue;
    BodyState state = start_[body].state;
    state.velocity += push * normal_response_[body].velocity + rub * tangent_response_[body].velocity;
    state.angular_velocity +=
        push * normal_response_[body].angular_velocity + rub * tangent_response_[body].angular_velocity;
    flight_.restart(body, now, state);
  }
  equations_.kick(normal_response_, push, smooth_.change());
  equations_.kick(tangent_response_, rub, smooth_.change());
  smooth_.restart();
  ++statistics_.impacts;
}

/// Looks for impacts up to `next`. Where there is one, the step is cut there, at a time located by Newton's
/// method on the motion itself.
void PreciseDriver::stop_at_impact(double next) {
  const Clock clock(profiling_, cost_[kImpactSearch]);
  const double start = smooth_.start();
  motions(start, smooth_.state_at_start().value(), smooth_.rate_at_start(), start_);
  motions(next, smooth_.state().value(), smooth_.rate_at_end(), end_);
  const auto impact = impacts_.first(start, next, start_, end_);
  if (!impact) return;

  constexpr int kMostRefinements = 12;
  double time = impact->time;
  for (int i = 0;; ++i) {
    time = std::clamp(time, std::nextafter(start, next), next);
    smooth_.cut(time);
    motions(time, smooth_.state().value(), {}, end_);
    const Encounter e = impacts_.encounter(*impact, end_);
    const double correction = e.gap / e.speed;
    const bool grazing = e.speed >= -e.quiet;
    if (grazing || i == kMostRefinements || std::abs(e.gap) <= e.noise / 16 || time - correction == time)
      return;
    time -= correction;
  }
}

/// The motions of bodies with discs. `rate` may be empty: then accelerations are zero where they are
/// integrated.
void PreciseDriver::motions(double time, std::span<const double> y, std::span<const double> rate,
                            std::span<Motion> out) const {
  for (const Disc& disc : impacts_.discs()) {
    if (flight_.holds(disc.body)) {
      out[disc.body] = flight_.at(disc.body, time);
      continue;
    }
    const std::size_t slot = slot_of(disc.body);
    Motion& motion = out[disc.body];
    motion = {EquationsOfMotion::state(y, slot), {}, 0};
    if (rate.empty()) continue;
    const double* change = rate.data() + EquationsOfMotion::kPerBody * slot;
    motion.acceleration = {change[3], change[4]};
    motion.angular_acceleration = change[5];
  }
}

std::size_t PreciseDriver::slot_of(std::size_t body) const {
  const auto place = std::lower_bound(parts_.integrated.begin(), parts_.integrated.end(), body);
  return static_cast<std::size_t>(place - parts_.integrated.begin());
}

}  // namespace plumb::precise

namespace plumb {

std::unique_ptr<Driver> make_precise_driver(const Scene& scene, const Precise& precise,
                                            CompileOptions options) {
  return std::make_unique<precise::PreciseDriver>(scene, precise, options);
}

}  // namespace plumb
