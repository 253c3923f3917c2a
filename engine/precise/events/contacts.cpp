#include "engine/precise/events/contacts.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <variant>

#include "engine/core/text.h"
#include "engine/forces/compile.h"
#include "engine/math/trigonometry.h"
#include "engine/scene/error.h"

// Handles events: resolves impacts, then decides which contacts persist.
namespace plumb::precise {
namespace {

/// Bouncing ends when the rest of the Zeno cascade takes less than kLeftToBounce of the scene's own time, or
/// when bounces rise by less than kLowestBounce roundings of a gap. The scene's own time is the one in which
/// its accelerations cross its length.
constexpr double kLeftToBounce = 3e-5, kLowestBounce = 32;
/// Points that open are closed if they would touch again within this fraction of the scene's own time, as do
/// corners that touch alternately.
constexpr double kZenoTime = 1e-7;
/// Gaps up to this multiple of the rounding of positions count as touching.
constexpr double kTouching = 8;
constexpr int kMaxRounds = 100, kMaxEventsAtOnce = 500;

/// Returns an estimate of the angular frequency (rad/s) of a formula in time, with its other variables fixed:
/// its fastest change over half its range, both sampled over the first seconds. For a sine this is its
/// frequency.
template <std::size_t kCount>
double frequency_of(const Formula& formula, std::array<Jet, kCount> variables) {
  constexpr int kSampleCount = 4096;
  constexpr double kSpan = 10, kGolden = 0.6180339887498949;  // s; a stride that never repeats a fraction
  if (!formula.uses(0)) return 0;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  double fastest = 0, phase = 0;
  for (int i = 0; i < kSampleCount; ++i) {
    phase += kGolden;
    phase -= std::floor(phase);
    variables[0] = {kSpan * phase, 1};
    const Jet now = formula.at(std::span<const Jet>(variables));
    if (!std::isfinite(now.value) || !std::isfinite(now.first)) continue;
    lowest = std::min(lowest, now.value), highest = std::max(highest, now.value);
    fastest = std::max(fastest, std::abs(now.first));
  }
  return highest > lowest ? fastest / (0.5 * (highest - lowest)) : 0;
}

double frequency_of(const Scene& scene, const ForceLaw& law) {
  const LawCompiler compiler(scene);
  if (const auto* force = std::get_if<FormulaForce>(&law)) {
    const FormulaForceLaw compiled = compiler.compile(*force);
    const BodyState start = initial_state(scene.bodies[compiled.body]);
    const FormulaForceLaw::Variables values = compiled.variables(
        0, {start.position, rotation_of(start.angle)}, {start.velocity, start.angular_velocity});
    std::array<Jet, std::tuple_size_v<FormulaForceLaw::Variables>> jets;
    std::copy(values.begin(), values.end(), jets.begin());
    return std::max({frequency_of(compiled.x, jets), frequency_of(compiled.y, jets),
                     frequency_of(compiled.torque, jets)});
  }
  if (const auto* spring = std::get_if<FormulaSpring>(&law))
    return frequency_of(compiler.compile(*spring).tension, std::array<Jet, 3>{0, 1, 0});
  return 0;
}

}  // namespace

Contacts::Contacts(const Scene& scene, const ScenePartition& partition, const BallisticMotion& ballistic,
                   EquationsOfMotion& equations, EventFreeIntegrator& integrator)
    : ballistic_(ballistic),
      equations_(equations),
      integrator_(integrator),
      finder_(scene, partition),
      impact_solver_(finder_, equations),
      limits_and_motors_(scene, partition, equations),
      bounds_(ballistic, partition.integrated, scene.bodies.size()),
      search_(finder_.shapes(), bounds_),
      states_(scene.bodies.size()),
      sample_(equations.dimension()),
      rate_(equations.dimension()) {
  for (const ForceLaw& law : scene.forces) {
    if (const auto* sinusoidal = std::get_if<SinusoidalForce>(&law))
      fastest_force_ = std::max(fastest_force_, sinusoidal->angular_frequency);
    fastest_force_ = std::max(fastest_force_, frequency_of(scene, law));
  }
  for (const Drive& drive : scene.drives)
    fastest_force_ =
        std::max(fastest_force_, frequency_of(Formula(drive.speed, kTimeVariable), std::array<Jet, 1>{}));
}

void Contacts::count(ContactEvent event, double time, std::int64_t times) {
  EventCount& e = events_[static_cast<std::size_t>(event)];
  e.count += times;
  e.last = time;
}

void Contacts::update_states(double time, std::span<const double> y) {
  for (std::size_t body = 0; body < states_.size(); ++body) {
    if (ballistic_.contains(body)) states_[body] = ballistic_.at(body, time).state;
  }
  for (std::size_t slot = 0; slot < equations_.bodies().size(); ++slot) {
    states_[equations_.bodies()[slot]] = EquationsOfMotion::state(y, slot);
  }
}

void Contacts::check_overlaps(double share) {
  update_states();
  const double tolerance = kTouching * finder_.gap_rounding(states_),
               allowed = share * finder_.scale_of_length() + tolerance;
  std::vector<ShapePair> passing;
  double deepest = allowed;
  std::string subject;
  for (const ContactCandidate& candidate : finder_.find_candidates(states_, tolerance, passing)) {
    for (int i = 0; i < candidate.count; ++i) {
      const double depth = -candidate.rows[i].normal.residual;
      if (!(depth > deepest)) continue;
      deepest = depth;
      const auto name = [&](std::size_t shape) {
        return "'" + equations_.name(finder_.shapes()[shape].body) + "'";
      };
      subject = "bodies " + name(candidate.pair.a) + " and " + name(candidate.pair.b);
    }
  }
  if (subject.empty()) return;
  throw Error(
      Error::Kind::Run, subject, "overlap", shortest(deepest) + " m",
      "their shapes overlap by more than " + shortest(allowed) +
          " m, and no law says how they part: place them apart, or filter the pair out; Realtime parts them");
}

void Contacts::release() {
  held_.clear();
  equations_.set_contacts({});
  limits_and_motors_.release();
  invalidate();
}

void Contacts::resolve_event() {
  const double now = integrator_.time();
  const double time_scale = finder_.scale_of_length() / finder_.scale_of_speed();
  const double instant = 4 * std::numeric_limits<double>::epsilon() * std::max(now, time_scale);
  events_at_once_ = now - last_event_ <= instant ? events_at_once_ + 1 : 0;
  last_event_ = now;
  if (events_at_once_ > kMaxEventsAtOnce)
    throw Error(Error::Kind::Run, "contacts, limits and motors", "events",
                std::to_string(kMaxEventsAtOnce) + " and more",
                "they change at one instant without end; Realtime may do");
  equations_.set_window(now, now);
  update_states();
  gap_tolerance_ = kTouching * finder_.gap_rounding(states_);
  record_.impacts = record_.zeno = record_.paradox = false;
  record_.impact_count = 0;
  for (int round = 0;; ++round) {
    std::vector<ContactCandidate> candidates = finder_.find_candidates(states_, gap_tolerance_, passing_);
    limits_and_motors_.find_reached_limits(now, integrator_.state().value(), finder_, states_, candidates);
    if (round == 0) record_.candidates = candidates;
    if (round == 0 && candidates.empty() && held_.empty() &&
        limits_and_motors_.empty()) {  // no event: the motion continues
      touching_.clear();
      resolved_ = true;
      return;
    }
    resolve_impacts(candidates);
    if (solve_modes(candidates) == Decision::Done) break;
    if (round == kMaxRounds)
      throw Error(Error::Kind::Run, "contacts", "rounds", std::to_string(round),
                  "no set of contacts lasts at this instant; Realtime may do");
    update_states();
  }
  equations_.project(now, integrator_.mutable_state());
  integrator_.restart();
  resolved_ = true;
}

bool Contacts::is_held(const ContactCandidate& candidate, int point) const {
  if (candidate.limit) return false;
  for (std::size_t p = 0; p < held_.size(); ++p) {
    if (held_[p] != candidate.pair) continue;
    const ActiveContact& patch = equations_.active_contacts()[p];
    for (int i = 0; i < patch.count; ++i) {
      if (patch.features[i] == candidate.features[point]) return true;
    }
  }
  return false;
}

std::vector<Twist<double>> Contacts::accelerations() {
  equations_.rate(integrator_.time(), integrator_.state().value(), rate_);
  std::vector<Twist<double>> result(states_.size());
  for (std::size_t slot = 0; slot < equations_.bodies().size(); ++slot) {
    const double* rate = rate_.data() + EquationsOfMotion::kPerBody * slot;
    result[equations_.bodies()[slot]] = {{rate[3], rate[4]}, rate[5]};
  }
  return result;
}

/// Returns the acceleration with which each point's gap closes, minus its second derivative, under the held
/// contacts. Points that are held themselves are evaluated without contacts.
std::vector<std::array<double, 2>> Contacts::closing_accelerations(
    std::span<const ContactCandidate> candidates) {
  std::vector<std::array<double, 2>> result(candidates.size());
  const std::vector<Twist<double>> with = accelerations();
  const std::span<const Twist<double>> without =
      equations_.accelerations_without_contacts(integrator_.time(), integrator_.state().value());
  for (std::size_t t = 0; t < candidates.size(); ++t) {
    for (int i = 0; i < candidates[t].count; ++i) {
      const Row<double>& row = candidates[t].rows[i].normal;
      result[t][static_cast<std::size_t>(i)] =
          -(row.bias_acceleration +
            (is_held(candidates[t], i) ? rate_along(row, without) : rate_along(row, with)));
    }
  }
  return result;
}

/// Finds approaches that do not count as impacts. A gap that closes at v and opens with the acceleration a
/// narrows by only v^2 / (2 a). If that is within the rounding of a gap, there is no impact. An example is a
/// corner level with the face on which a disc rolls.
void Contacts::find_grazes(std::vector<ContactCandidate>& candidates) {
  const std::vector<Twist<double>> now = accelerations();
  for (ContactCandidate& candidate : candidates) {
    if (candidate.limit) continue;
    double grazing_speed = std::numeric_limits<double>::infinity();
    for (int i = 0; i < candidate.count; ++i) {
      if (!(candidate.gap_rate[i] < -candidate.rate_tolerance)) continue;
      const Row<double>& row = candidate.rows[i].normal;
      const double opening = std::max(rate_along(row, now) + row.bias_acceleration, 0.0);
      grazing_speed = std::min(grazing_speed, std::sqrt(2 * opening * gap_tolerance_));
    }
    for (int i = 0; i < candidate.count; ++i)
      if (candidate.gap_rate[i] < -candidate.rate_tolerance && candidate.gap_rate[i] < -grazing_speed)
        grazing_speed = 0;
    if (grazing_speed == std::numeric_limits<double>::infinity()) continue;
    candidate.grazing_speed = grazing_speed,
    candidate.rate_tolerance = std::max(candidate.rate_tolerance, grazing_speed);
  }
}

void Contacts::resolve_impacts(std::vector<ContactCandidate>& candidates) {
  if (std::any_of(candidates.begin(), candidates.end(), closes)) find_grazes(candidates);
  if (std::none_of(candidates.begin(), candidates.end(), closes)) return;
  if (!record_.impacts) record_.candidates = candidates;
  record_.impacts = true;
  const double now = integrator_.time();
  const std::vector<std::array<double, 2>> closing = closing_accelerations(candidates);
  const std::vector<ContactCandidate> before = candidates;
  const double time_scale = finder_.scale_of_length() / finder_.scale_of_speed();
  double limit = 0;
  bool ends = false;
  const auto restitution = [&](const ContactCandidate& candidate, int point) {
    const double speed = -candidate.gap_rate[point];
    const double e = finder_.restitution_at(candidate, point);
    if (e == 0 || e == 1) return e;
    const auto place = std::find_if(before.begin(), before.end(), [&](const ContactCandidate& t) {
      return !t.limit && t.pair == candidate.pair;
    });
    const double acceleration =
        closing[static_cast<std::size_t>(place - before.begin())][static_cast<std::size_t>(point)];
    if (!(acceleration > 0)) return e;
    // A bounce takes 2 v / a, the next one e times as long; the series has this limit. Its impulses add up to
    // those that a persistent contact would exert from now on, within the same time.
    const double left = 2 * e * speed / (acceleration * (1 - e)),
                 height = e * e * speed * speed / (2 * acceleration);
    if (left > kLeftToBounce * time_scale && height > kLowestBounce * gap_tolerance_) return e;
    ends = true;
    limit = std::max(limit, now + left);
    return 0.0;
  };
  const std::int64_t impacts =
      impact_solver_.resolve(now, candidates, states_, integrator_.mutable_state(), restitution);
  count(ContactEvent::Impact, now, impacts);
  record_.impact_count += impacts;
  record_.zeno = record_.zeno || ends;
  if (ends) count(ContactEvent::Rest, limit);
}

/// Decides by Coulomb's law for the accelerations which points with zero gap rate have forces, and which
/// motors at their speed maintain it.
Contacts::Decision Contacts::solve_modes(std::vector<ContactCandidate>& candidates) {
  const double now = integrator_.time();
  const std::span<const double> y = integrator_.state().value();
  const std::vector<MotorAtSpeed> motors = limits_and_motors_.update_motors(now, y, states_, candidates);
  ContactProblem p = ContactProblem::of(
      candidates,
      [&](std::size_t t, int i) {
        return std::abs(candidates[t].gap_rate[i]) <= candidates[t].rate_tolerance;
      },
      motors, equations_, now, y);
  const std::span<const Twist<double>> free = equations_.accelerations_without_contacts(now, y);
  for (std::size_t i = 0; i < p.problem.size(); ++i) {
    const Row<double>& row = p.response.rows[i];
    p.problem.rate.push_back(rate_along(row, free) + row.bias_acceleration);
  }
  for (std::size_t b = 0; b < motors.size(); ++b)
    p.problem.rate[p.problem.size() - motors.size() + b] -=
        limits_and_motors_.target_acceleration(motors[b], now);
  for (std::size_t q = 0; q < p.candidates.size(); ++q) {
    const ContactCandidate& candidate = candidates[p.candidates[q]];
    if (std::abs(candidate.slip_speed) <= candidate.rate_tolerance) continue;
    p.problem.patches[q].slip_direction = candidate.slip_speed > 0 ? 1 : -1;
    p.problem.patches[q].friction = candidate.sliding_friction;
  }
  if (p.problem.size() > 0 &&
      std::none_of(p.problem.response.begin(), p.problem.response.end(), [](double x) { return x != 0; }))
    p.problem.rate.assign(p.problem.size(), 0.0);  // no row can move
  CoulombSolution solution = solve(p.problem, motors);
  while (solution.solved && start_sliding(candidates, p, solution)) solution = solve(p.problem, motors);
  if (!solution.solved) {
    if (!impact_solver_.resolve_jamming(now, candidates, states_, integrator_.mutable_state())) {
      throw Error(Error::Kind::Run, "contacts", "forces", std::to_string(p.problem.points()) + " points",
                  "no forces obey Coulomb's law here, and no impulse either; Realtime may do");
    }
    count(ContactEvent::Paradox, now);
    record_.paradox = true;
    return Decision::Again;
  }
  if (solution.ambiguous) count(ContactEvent::Paradox, now);
  record_.paradox = record_.paradox || solution.ambiguous;
  activate(candidates, p, solution);
  apply_limits_and_motors(candidates, motors, p, solution);
  return resolve_zeno_contacts(candidates) ? Decision::Again : Decision::Done;
}

/// Sets the kinetic friction of patches that begin to slip. It may be less than the static friction that they
/// have overcome. Returns true if any patch begins to slip.
bool Contacts::start_sliding(std::span<const ContactCandidate> candidates, ContactProblem& p,
                             const CoulombSolution& solution) {
  bool any = false;
  for (std::size_t q = 0; q < p.candidates.size(); ++q) {
    const ContactCandidate& candidate = candidates[p.candidates[q]];
    CoulombProblem::Patch& patch = p.problem.patches[q];
    if (patch.slip_direction != 0 || solution.mode[q] == 0 ||
        candidate.sliding_friction == candidate.friction)
      continue;
    patch.slip_direction = solution.mode[q];
    patch.friction = candidate.sliding_friction;
    any = true;
  }
  return any;
}

/// Solves the problem with motors that are not far stronger than the other forces, which would otherwise lose
/// their digits: reduces the motors' bounds as long as weaker motors suffice.
CoulombSolution Contacts::solve(CoulombProblem& problem, std::span<const MotorAtSpeed> motors) {
  constexpr double kStronger = 1e3;
  if (motors.empty()) return solve_coulomb(problem);
  const std::size_t n = problem.size();
  double strength = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double own = problem.response[i * n + i];
    if (own > 0) strength = std::max(strength, std::abs(problem.rate[i]) / own);
  }
  const std::size_t first_patch = problem.patches.size() - motors.size();
  for (;;) {
    strength *= kStronger;
    bool weaker = false, is_dynamic = false;
    for (std::size_t b = 0; b < motors.size(); ++b) {
      double& bound = problem.patches[first_patch + b].bound;
      bound = strength > 0 ? std::min(motors[b].bound, strength) : motors[b].bound;
      weaker = weaker || bound < motors[b].bound;
    }
    const CoulombSolution solution = solve_coulomb(problem);
    for (std::size_t b = 0; b < motors.size(); ++b)
      is_dynamic = is_dynamic || (solution.mode[first_patch + b] != 0 &&
                                  problem.patches[first_patch + b].bound < motors[b].bound);
    if (!weaker || (solution.solved && !is_dynamic)) return solution;
  }
}

void Contacts::apply_limits_and_motors(std::span<const ContactCandidate> candidates,
                                       std::span<const MotorAtSpeed> motors, const ContactProblem& p,
                                       const CoulombSolution& solution) {
  double most = 0;
  for (std::size_t i = 0; i < p.problem.points(); ++i) {
    const ContactCandidate& candidate = candidates[p.candidate_of[i]];
    if (!candidate.limit || !solution.active[i]) continue;
    limits_and_motors_.activate_limit(*candidate.limit);
    most = std::max(most, solution.force[i]);
  }
  for (std::size_t b = 0; b < motors.size(); ++b) {
    const std::size_t patch = p.candidates.size() + b;
    limits_and_motors_.set_motor_mode(motors[b], solution.mode[patch]);
    most = std::max(most, std::abs(solution.force[p.problem.points() + patch]));
  }
  limits_and_motors_.apply_modes(most);
}

void Contacts::activate(std::span<const ContactCandidate> candidates, const ContactProblem& p,
                        const CoulombSolution& solution) {
  std::vector<ActiveContact> patches;
  const std::vector<ShapePair> before = held_;
  held_.clear();
  force_scale_ = 0;
  for (std::size_t q = 0; q < p.candidates.size(); ++q) {
    const ContactCandidate& candidate = candidates[p.candidates[q]];
    if (candidate.limit) continue;
    ActiveContact patch{&finder_.shapes()[candidate.pair.a],
                        &finder_.shapes()[candidate.pair.b],
                        candidate.friction,
                        candidate.sliding_friction,
                        solution.mode[q],
                        0,
                        {},
                        {},
                        solution.force[p.problem.points() + q]};
    for (std::size_t i = 0; i < p.problem.points(); ++i) {
      if (p.candidate_of[i] != p.candidates[q] || !solution.active[i]) continue;
      patch.normal_forces[patch.count] = solution.force[i];
      patch.features[patch.count++] = candidate.features[p.index_of[i]];
      force_scale_ = std::max(force_scale_, solution.force[i]);
    }
    assert(patch.count <= 2);
    if (patch.count == 0) continue;
    patches.push_back(patch);
    held_.push_back(candidate.pair);
    if (!std::binary_search(before.begin(), before.end(), candidate.pair))
      count(ContactEvent::Hold, integrator_.time());
  }
  touching_.clear();
  for (const ContactCandidate& candidate : candidates) {
    if (!candidate.limit && !std::binary_search(held_.begin(), held_.end(), candidate.pair))
      touching_.push_back(candidate.pair);
  }
  equations_.set_contacts(std::move(patches));
}

/// Closes points that open but would touch again at once, as do corners that touch alternately. Returns true
/// if there were any.
bool Contacts::resolve_zeno_contacts(std::vector<ContactCandidate>& candidates) {
  const double time_scale = finder_.scale_of_length() / finder_.scale_of_speed();
  const auto opens = [](const ContactCandidate& candidate, int i) {
    return !candidate.limit && candidate.gap_rate[i] > candidate.rate_tolerance;
  };
  bool any = false;
  for (const ContactCandidate& candidate : candidates) {
    for (int i = 0; i < candidate.count; ++i) any = any || opens(candidate, i);
  }
  if (!any) return false;
  const std::vector<Twist<double>> now = accelerations();
  std::vector<ActiveContact> closed;
  any = false;
  for (const ContactCandidate& candidate : candidates) {
    if (candidate.limit) continue;
    ActiveContact patch{&finder_.shapes()[candidate.pair.a], &finder_.shapes()[candidate.pair.b]};
    for (int i = 0; i < candidate.count; ++i) {
      const Row<double>& row = candidate.rows[i].normal;
      const double acceleration = -(rate_along(row, now) + row.bias_acceleration);
      const double speed = candidate.gap_rate[i];
      const bool soon = 2 * speed < kZenoTime * time_scale * acceleration ||
                        speed * speed < 2 * acceleration * kLowestBounce * gap_tolerance_;
      const bool returns = opens(candidate, i) && acceleration > 0 && soon;
      if (returns || std::abs(candidate.gap_rate[i]) <= candidate.rate_tolerance)
        patch.features[patch.count++] = candidate.features[i];
      any = any || returns;
    }
    if (patch.count > 0) closed.push_back(patch);
  }
  if (!any) return false;
  equations_.set_contacts(std::move(closed));
  equations_.project(integrator_.time(), integrator_.mutable_state());
  held_.clear();
  equations_.set_contacts({});
  count(ContactEvent::Rest, integrator_.time());
  record_.zeno = true;
  return true;
}

}  // namespace plumb::precise
