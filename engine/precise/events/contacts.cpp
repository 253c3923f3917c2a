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
constexpr double kClatter = 1e-7;
/// Gaps up to this multiple of the rounding of positions count as touching.
constexpr double kTouching = 8;
constexpr int kMostRounds = 100, kMostEventsAtOnce = 500;

/// Returns an estimate of the angular frequency (rad/s) of a formula in time, with its other variables fixed:
/// its fastest change over half its range, both sampled over the first seconds. For a sine this is its
/// frequency.
template <std::size_t kCount>
double swing_of(const Formula& formula, std::array<Jet, kCount> variables) {
  constexpr int kTimes = 4096;
  constexpr double kSpan = 10, kGolden = 0.6180339887498949;  // s; a stride that never repeats a fraction
  if (!formula.uses(0)) return 0;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  double fastest = 0, place = 0;
  for (int i = 0; i < kTimes; ++i) {
    place += kGolden;
    place -= std::floor(place);
    variables[0] = {kSpan * place, 1};
    const Jet now = formula.at(std::span<const Jet>(variables));
    if (!std::isfinite(now.value) || !std::isfinite(now.first)) continue;
    lowest = std::min(lowest, now.value), highest = std::max(highest, now.value);
    fastest = std::max(fastest, std::abs(now.first));
  }
  return highest > lowest ? fastest / (0.5 * (highest - lowest)) : 0;
}

double swing_of(const Scene& scene, const ForceLaw& law) {
  const LawCompiler compiler(scene);
  if (const auto* force = std::get_if<FormulaForce>(&law)) {
    const FormulaForceLaw compiled = compiler.compile(*force);
    const BodyState start = initial_state(scene.bodies[compiled.body]);
    const FormulaForceLaw::Variables values = compiled.variables(
        0, {start.position, rotation_of(start.angle)}, {start.velocity, start.angular_velocity});
    std::array<Jet, std::tuple_size_v<FormulaForceLaw::Variables>> jets;
    std::copy(values.begin(), values.end(), jets.begin());
    return std::max(
        {swing_of(compiled.x, jets), swing_of(compiled.y, jets), swing_of(compiled.torque, jets)});
  }
  if (const auto* spring = std::get_if<FormulaSpring>(&law))
    return swing_of(compiler.compile(*spring).tension, std::array<Jet, 3>{0, 1, 0});
  return 0;
}

}  // namespace

Contacts::Contacts(const Scene& scene, const Parts& parts, const Flight& flight, EquationsOfMotion& equations,
                   EventFreeIntegrator& smooth)
    : flight_(flight),
      equations_(equations),
      smooth_(smooth),
      finder_(scene, parts),
      law_(finder_, equations),
      stops_(scene, parts, equations),
      paths_(flight, parts.integrated, scene.bodies.size()),
      search_(finder_.outlines(), paths_),
      states_(scene.bodies.size()),
      sample_(equations.dimension()),
      rate_(equations.dimension()) {
  for (const ForceLaw& law : scene.forces) {
    if (const auto* swinging = std::get_if<SinusoidalForce>(&law))
      fastest_force_ = std::max(fastest_force_, swinging->angular_frequency);
    fastest_force_ = std::max(fastest_force_, swing_of(scene, law));
  }
  for (const Drive& drive : scene.drives)
    fastest_force_ =
        std::max(fastest_force_, swing_of(Formula(drive.speed, kTimeVariable), std::array<Jet, 1>{}));
}

void Contacts::count(ContactEvent event, double time, std::int64_t times) {
  EventCount& e = events_[static_cast<std::size_t>(event)];
  e.count += times;
  e.last = time;
}

void Contacts::look_at_states(double time, std::span<const double> y) {
  for (std::size_t body = 0; body < states_.size(); ++body) {
    if (flight_.holds(body)) states_[body] = flight_.at(body, time).state;
  }
  for (std::size_t slot = 0; slot < equations_.bodies().size(); ++slot) {
    states_[equations_.bodies()[slot]] = EquationsOfMotion::state(y, slot);
  }
}

void Contacts::refuse_overlaps(double share) {
  look_at_states();
  const double near = kTouching * finder_.near(states_), allowed = share * finder_.scale_of_length() + near;
  std::vector<OutlinePair> passing;
  double deepest = allowed;
  std::string subject;
  for (const ContactCandidate& touch : finder_.touches(states_, near, passing)) {
    for (int i = 0; i < touch.count; ++i) {
      const double depth = -touch.rows[i].normal.residual;
      if (!(depth > deepest)) continue;
      deepest = depth;
      const auto name = [&](std::size_t outline) {
        return "'" + equations_.name(finder_.outlines()[outline].body) + "'";
      };
      subject = "bodies " + name(touch.pair.a) + " and " + name(touch.pair.b);
    }
  }
  if (subject.empty()) return;
  throw Error(
      Error::Kind::Run, subject, "overlap", shortest(deepest) + " m",
      "their shapes overlap by more than " + shortest(allowed) +
          " m, and no law says how they part: place them apart, or filter the pair out; Realtime parts them");
}

void Contacts::let_go() {
  held_.clear();
  equations_.hold_contacts({});
  stops_.let_go();
  unsettle();
}

void Contacts::settle() {
  const double now = smooth_.time();
  const double own_time = finder_.scale_of_length() / finder_.scale_of_speed();
  const double instant = 4 * std::numeric_limits<double>::epsilon() * std::max(now, own_time);
  events_at_once_ = now - last_event_ <= instant ? events_at_once_ + 1 : 0;
  last_event_ = now;
  if (events_at_once_ > kMostEventsAtOnce)
    throw Error(Error::Kind::Run, "contacts, limits and motors", "events",
                std::to_string(kMostEventsAtOnce) + " and more",
                "they change at one instant without end; Realtime may do");
  equations_.set_window(now, now);
  look_at_states();
  near_ = kTouching * finder_.near(states_);
  record_.impacts = record_.rests = record_.paradox = false;
  record_.struck = 0;
  for (int round = 0;; ++round) {
    std::vector<ContactCandidate> touches = finder_.touches(states_, near_, passing_);
    stops_.find(now, smooth_.state().value(), finder_, states_, touches);
    if (round == 0) record_.touches = touches;
    if (round == 0 && touches.empty() && held_.empty() && stops_.empty()) {  // no event: the motion continues
      touching_.clear();
      settled_ = true;
      return;
    }
    resolve_impacts(touches);
    if (decide(touches) == Decision::Done) break;
    if (round == kMostRounds)
      throw Error(Error::Kind::Run, "contacts", "rounds", std::to_string(round),
                  "no set of contacts lasts at this instant; Realtime may do");
    look_at_states();
  }
  equations_.project(now, smooth_.change());
  smooth_.restart();
  settled_ = true;
}

bool Contacts::is_held(const ContactCandidate& touch, int point) const {
  if (touch.stop) return false;
  for (std::size_t p = 0; p < held_.size(); ++p) {
    if (held_[p] != touch.pair) continue;
    const ActiveContact& patch = equations_.held()[p];
    for (int i = 0; i < patch.count; ++i) {
      if (patch.features[i] == touch.features[point]) return true;
    }
  }
  return false;
}

std::vector<Twist<double>> Contacts::accelerations() {
  equations_.rate(smooth_.time(), smooth_.state().value(), rate_);
  std::vector<Twist<double>> result(states_.size());
  for (std::size_t slot = 0; slot < equations_.bodies().size(); ++slot) {
    const double* rate = rate_.data() + EquationsOfMotion::kPerBody * slot;
    result[equations_.bodies()[slot]] = {{rate[3], rate[4]}, rate[5]};
  }
  return result;
}

/// Returns the acceleration with which each point's gap closes, minus its second derivative, under the held
/// contacts. Points that are held themselves are evaluated without contacts.
std::vector<std::array<double, 2>> Contacts::pulls(std::span<const ContactCandidate> touches) {
  std::vector<std::array<double, 2>> result(touches.size());
  const std::vector<Twist<double>> with = accelerations();
  const std::span<const Twist<double>> without =
      equations_.accelerations_without_contacts(smooth_.time(), smooth_.state().value());
  for (std::size_t t = 0; t < touches.size(); ++t) {
    for (int i = 0; i < touches[t].count; ++i) {
      const Row<double>& row = touches[t].rows[i].normal;
      result[t][static_cast<std::size_t>(i)] =
          -(row.bias_acceleration +
            (is_held(touches[t], i) ? rate_along(row, without) : rate_along(row, with)));
    }
  }
  return result;
}

/// Finds approaches that do not count as impacts. A gap that closes at v and opens with the acceleration a
/// narrows by only v^2 / (2 a). If that is within the rounding of a gap, there is no impact. An example is a
/// corner level with the face on which a disc rolls.
void Contacts::find_grazes(std::vector<ContactCandidate>& touches) {
  const std::vector<Twist<double>> now = accelerations();
  for (ContactCandidate& touch : touches) {
    if (touch.stop) continue;
    double graze = std::numeric_limits<double>::infinity();
    for (int i = 0; i < touch.count; ++i) {
      if (!(touch.closing[i] < -touch.quiet)) continue;
      const Row<double>& row = touch.rows[i].normal;
      const double opening = std::max(rate_along(row, now) + row.bias_acceleration, 0.0);
      graze = std::min(graze, std::sqrt(2 * opening * near_));
    }
    for (int i = 0; i < touch.count; ++i)
      if (touch.closing[i] < -touch.quiet && touch.closing[i] < -graze) graze = 0;
    if (graze == std::numeric_limits<double>::infinity()) continue;
    touch.graze = graze, touch.quiet = std::max(touch.quiet, graze);
  }
}

void Contacts::resolve_impacts(std::vector<ContactCandidate>& touches) {
  if (std::any_of(touches.begin(), touches.end(), closes)) find_grazes(touches);
  if (std::none_of(touches.begin(), touches.end(), closes)) return;
  if (!record_.impacts) record_.touches = touches;
  record_.impacts = true;
  const double now = smooth_.time();
  const std::vector<std::array<double, 2>> pull = pulls(touches);
  const std::vector<ContactCandidate> before = touches;
  const double own_time = finder_.scale_of_length() / finder_.scale_of_speed();
  double limit = 0;
  bool ends = false;
  const auto restitution = [&](const ContactCandidate& touch, int point) {
    const double speed = -touch.closing[point];
    const double e = finder_.restitution_at(touch, point);
    if (e == 0 || e == 1) return e;
    const auto place = std::find_if(before.begin(), before.end(), [&](const ContactCandidate& t) {
      return !t.stop && t.pair == touch.pair;
    });
    const double drawn =
        pull[static_cast<std::size_t>(place - before.begin())][static_cast<std::size_t>(point)];
    if (!(drawn > 0)) return e;
    // A bounce takes 2 v / a, the next one e times as long; the series has this limit. Its impulses add up to
    // those that a persistent contact would exert from now on, within the same time.
    const double left = 2 * e * speed / (drawn * (1 - e)), height = e * e * speed * speed / (2 * drawn);
    if (left > kLeftToBounce * own_time && height > kLowestBounce * near_) return e;
    ends = true;
    limit = std::max(limit, now + left);
    return 0.0;
  };
  const std::int64_t impacts = law_.resolve(now, touches, states_, smooth_.change(), restitution);
  count(ContactEvent::Impact, now, impacts);
  record_.struck += impacts;
  record_.rests = record_.rests || ends;
  if (ends) count(ContactEvent::Rest, limit);
}

/// Decides by Coulomb's law for the accelerations which points with zero gap rate have forces, and which
/// motors at their speed maintain it.
Contacts::Decision Contacts::decide(std::vector<ContactCandidate>& touches) {
  const double now = smooth_.time();
  const std::span<const double> y = smooth_.state().value();
  const std::vector<Brake> brakes = stops_.push(now, y, states_, touches);
  TouchProblem p = TouchProblem::of(
      touches, [&](std::size_t t, int i) { return std::abs(touches[t].closing[i]) <= touches[t].quiet; },
      brakes, equations_, now, y);
  const std::span<const Twist<double>> free = equations_.accelerations_without_contacts(now, y);
  for (std::size_t i = 0; i < p.problem.size(); ++i) {
    const Row<double>& row = p.response.rows[i];
    p.problem.rate.push_back(rate_along(row, free) + row.bias_acceleration);
  }
  for (std::size_t b = 0; b < brakes.size(); ++b)
    p.problem.rate[p.problem.size() - brakes.size() + b] -= stops_.gain_of_speed(brakes[b], now);
  for (std::size_t q = 0; q < p.touches.size(); ++q) {
    const ContactCandidate& touch = touches[p.touches[q]];
    if (std::abs(touch.slip) <= touch.quiet) continue;
    p.problem.patches[q].slip = touch.slip > 0 ? 1 : -1;
    p.problem.patches[q].friction = touch.sliding_friction;
  }
  if (p.problem.size() > 0 &&
      std::none_of(p.problem.response.begin(), p.problem.response.end(), [](double x) { return x != 0; }))
    p.problem.rate.assign(p.problem.size(), 0.0);  // no row can move
  CoulombSolution solution = solve(p.problem, brakes);
  while (solution.solved && start_sliding(touches, p, solution)) solution = solve(p.problem, brakes);
  if (!solution.solved) {
    if (!law_.jamb(now, touches, states_, smooth_.change())) {
      throw Error(Error::Kind::Run, "contacts", "forces", std::to_string(p.problem.points()) + " points",
                  "no forces obey Coulomb's law here, and no impulse either; Realtime may do");
    }
    count(ContactEvent::Paradox, now);
    record_.paradox = true;
    return Decision::Again;
  }
  if (solution.ambiguous) count(ContactEvent::Paradox, now);
  record_.paradox = record_.paradox || solution.ambiguous;
  activate(touches, p, solution);
  act_on_stops(touches, brakes, p, solution);
  return resolve_zeno_contacts(touches) ? Decision::Again : Decision::Done;
}

/// Sets the kinetic friction of patches that begin to slip. It may be less than the static friction that they
/// have overcome. Returns true if any patch begins to slip.
bool Contacts::start_sliding(std::span<const ContactCandidate> touches, TouchProblem& p,
                             const CoulombSolution& solution) {
  bool any = false;
  for (std::size_t q = 0; q < p.touches.size(); ++q) {
    const ContactCandidate& touch = touches[p.touches[q]];
    CoulombProblem::Patch& patch = p.problem.patches[q];
    if (patch.slip != 0 || solution.mode[q] == 0 || touch.sliding_friction == touch.friction) continue;
    patch.slip = solution.mode[q];
    patch.friction = touch.sliding_friction;
    any = true;
  }
  return any;
}

/// Solves the problem with motors that are not far stronger than the other forces, which would otherwise lose
/// their digits: reduces the motors' bounds as long as weaker motors suffice.
CoulombSolution Contacts::solve(CoulombProblem& problem, std::span<const Brake> brakes) {
  constexpr double kStronger = 1e3;
  if (brakes.empty()) return solve_coulomb(problem);
  const std::size_t n = problem.size();
  double strength = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double own = problem.response[i * n + i];
    if (own > 0) strength = std::max(strength, std::abs(problem.rate[i]) / own);
  }
  const std::size_t first_patch = problem.patches.size() - brakes.size();
  for (;;) {
    strength *= kStronger;
    bool weaker = false, is_dynamic = false;
    for (std::size_t b = 0; b < brakes.size(); ++b) {
      double& bound = problem.patches[first_patch + b].bound;
      bound = strength > 0 ? std::min(brakes[b].bound, strength) : brakes[b].bound;
      weaker = weaker || bound < brakes[b].bound;
    }
    const CoulombSolution solution = solve_coulomb(problem);
    for (std::size_t b = 0; b < brakes.size(); ++b)
      is_dynamic = is_dynamic || (solution.mode[first_patch + b] != 0 &&
                                  problem.patches[first_patch + b].bound < brakes[b].bound);
    if (!weaker || (solution.solved && !is_dynamic)) return solution;
  }
}

void Contacts::act_on_stops(std::span<const ContactCandidate> touches, std::span<const Brake> brakes,
                            const TouchProblem& p, const CoulombSolution& solution) {
  double most = 0;
  for (std::size_t i = 0; i < p.problem.points(); ++i) {
    const ContactCandidate& touch = touches[p.touch_of[i]];
    if (!touch.stop || !solution.pushes[i]) continue;
    stops_.hold(*touch.stop);
    most = std::max(most, solution.force[i]);
  }
  for (std::size_t b = 0; b < brakes.size(); ++b) {
    const std::size_t patch = p.touches.size() + b;
    stops_.take(brakes[b], solution.mode[patch]);
    most = std::max(most, std::abs(solution.force[p.problem.points() + patch]));
  }
  stops_.act(most);
}

void Contacts::activate(std::span<const ContactCandidate> touches, const TouchProblem& p,
                        const CoulombSolution& solution) {
  std::vector<ActiveContact> patches;
  const std::vector<OutlinePair> before = held_;
  held_.clear();
  force_scale_ = 0;
  for (std::size_t q = 0; q < p.touches.size(); ++q) {
    const ContactCandidate& touch = touches[p.touches[q]];
    if (touch.stop) continue;
    ActiveContact patch{&finder_.outlines()[touch.pair.a],
                        &finder_.outlines()[touch.pair.b],
                        touch.friction,
                        touch.sliding_friction,
                        solution.mode[q],
                        0,
                        {},
                        {},
                        solution.force[p.problem.points() + q]};
    for (std::size_t i = 0; i < p.problem.points(); ++i) {
      if (p.touch_of[i] != p.touches[q] || !solution.pushes[i]) continue;
      patch.pushes[patch.count] = solution.force[i];
      patch.features[patch.count++] = touch.features[p.index_of[i]];
      force_scale_ = std::max(force_scale_, solution.force[i]);
    }
    assert(patch.count <= 2);
    if (patch.count == 0) continue;
    patches.push_back(patch);
    held_.push_back(touch.pair);
    if (!std::binary_search(before.begin(), before.end(), touch.pair))
      count(ContactEvent::Hold, smooth_.time());
  }
  touching_.clear();
  for (const ContactCandidate& touch : touches) {
    if (!touch.stop && !std::binary_search(held_.begin(), held_.end(), touch.pair))
      touching_.push_back(touch.pair);
  }
  equations_.hold_contacts(std::move(patches));
}

/// Closes points that open but would touch again at once, as do corners that touch alternately. Returns true
/// if there were any.
bool Contacts::resolve_zeno_contacts(std::vector<ContactCandidate>& touches) {
  const double own_time = finder_.scale_of_length() / finder_.scale_of_speed();
  const auto opens = [](const ContactCandidate& touch, int i) {
    return !touch.stop && touch.closing[i] > touch.quiet;
  };
  bool any = false;
  for (const ContactCandidate& touch : touches) {
    for (int i = 0; i < touch.count; ++i) any = any || opens(touch, i);
  }
  if (!any) return false;
  const std::vector<Twist<double>> now = accelerations();
  std::vector<ActiveContact> closed;
  any = false;
  for (const ContactCandidate& touch : touches) {
    if (touch.stop) continue;
    ActiveContact patch{&finder_.outlines()[touch.pair.a], &finder_.outlines()[touch.pair.b]};
    for (int i = 0; i < touch.count; ++i) {
      const Row<double>& row = touch.rows[i].normal;
      const double pull = -(rate_along(row, now) + row.bias_acceleration);
      const double speed = touch.closing[i];
      const bool soon =
          2 * speed < kClatter * own_time * pull || speed * speed < 2 * pull * kLowestBounce * near_;
      const bool returns = opens(touch, i) && pull > 0 && soon;
      if (returns || std::abs(touch.closing[i]) <= touch.quiet)
        patch.features[patch.count++] = touch.features[i];
      any = any || returns;
    }
    if (patch.count > 0) closed.push_back(patch);
  }
  if (!any) return false;
  equations_.hold_contacts(std::move(closed));
  equations_.project(smooth_.time(), smooth_.change());
  held_.clear();
  equations_.hold_contacts({});
  count(ContactEvent::Rest, smooth_.time());
  record_.rests = true;
  return true;
}

}  // namespace plumb::precise
