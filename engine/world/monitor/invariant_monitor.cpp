#include "engine/world/invariant_monitor.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <type_traits>

#include "engine/core/text.h"
#include "engine/world/state/naming.h"
#include "engine/world/world_data.h"

namespace plumb {
namespace {

/// Number of position roundings in a step that the energy balance must tolerate.
constexpr double kRoundings = 64;

/// An overlap or gap counts as shrinking, and not as a violation, if it is at most this fraction of its value
/// in the step before.
constexpr double kShrinking = 0.998;

void validate(const MonitorBounds& bounds) {
  const auto require_bound = [](const char* field, double value) {
    if (value >= 0) return;  // infinity: never missed
    throw Error(Error::Kind::Value, "monitor", field, shortest(value), "must be a number from 0");
  };
  require_bound("joint_gap", bounds.joint_gap), require_bound("overlap", bounds.overlap);
  require_bound("energy", bounds.energy);
  if (bounds.lasting < 1) {
    throw Error(Error::Kind::Value, "monitor", "lasting", std::to_string(bounds.lasting),
                "must be at least 1 step");
  }
}

template <class Kind>
constexpr bool kHasSpring = requires(const Kind& kind) {
  kind.spring.has_value();
};

/// Returns true if a joint stores energy or does work.
bool is_drive(const JointKind& kind) {
  return std::visit(
      [](const auto& k) {
        using Kind = std::decay_t<decltype(k)>;
        if constexpr (std::is_same_v<Kind, MotorDefinition> || std::is_same_v<Kind, MouseDefinition>)
          return true;
        if constexpr (std::is_same_v<Kind, WeldDefinition>)
          return k.linear_spring.has_value() || k.angular_spring.has_value();
        bool drives = false;
        if constexpr (kHasSpring<Kind>) drives = k.spring.has_value();
        if constexpr (requires { k.motor->speed; }) drives = drives || (k.motor && k.motor->speed != 0);
        return drives;
      },
      kind);
}

}  // namespace

template <class Real>
InvariantMonitor<Real>::InvariantMonitor(const BasicWorld<Real>& world, const MonitorBounds& bounds)
    : world_(&world), bounds_(bounds) {
  validate(bounds);
}

template <class Real>
void InvariantMonitor<Real>::reset() {
  gaps_.clear(), overlaps_.clear();
  energy_gain_ = max_kinetic_energy_ = 0;
  energy_violation_steps_ = 0;
}

template <class Real>
void InvariantMonitor<Real>::begin_step() {
  const WorldData<Real>& w = world_->data();
  in_step_ = true;
  before_.assign(static_cast<std::size_t>(w.bodies.size()), State{});
  for (const int body : w.awake) {
    const BodyRecord<Real>& record = w.bodies[body];
    const SolverBody<Real>& motion = w.motion[body];
    State& state = before_[static_cast<std::size_t>(body)];
    state.position = w.position[body], state.angle = record.angle;
    state.velocity = motion.velocity.template as<double>();
    state.angular_velocity = static_cast<double>(motion.angular_velocity);
    state.is_dynamic = record.type == BodyType::Dynamic;
    if (!state.is_dynamic) continue;
    const Load<Real> load = w.loads.get(body);
    state.mass = static_cast<double>(record.mass), state.inertia = static_cast<double>(record.inertia);
    if (motion.inverse_inertia == 0) state.inertia = 0;
    state.weight = state.mass * static_cast<double>(w.extras_of(body).gravity_scale) * w.settings.gravity;
    state.force = load.force.template as<double>(), state.torque = static_cast<double>(load.torque);
  }
}

template <class Real>
std::optional<Error> InvariantMonitor<Real>::end_step() {
  if (!in_step_) {
    throw Error(Error::Kind::Unsupported, "monitor", "", "",
                "cannot end a step that it has not begun; begin it before each step");
  }
  in_step_ = false;
  if (auto error = check_joints()) return error;
  if (auto error = check_overlaps()) return error;
  return check_energy();
}

/// Returns true if a joint or contact has exceeded its bound for enough steps.
template <class Real>
bool InvariantMonitor<Real>::is_persistent(std::vector<Violation>& now, const std::vector<Violation>& before,
                                           std::uint64_t key, double size, double bound) const {
  if (!(size > bound)) return false;
  const auto known =
      std::lower_bound(before.begin(), before.end(), key,
                       [](const Violation& violation, std::uint64_t of) { return violation.key < of; });
  Violation violation{key, size, 1};
  if (known != before.end() && known->key == key)
    violation.steps = size < kShrinking * known->size ? known->steps : known->steps + 1;
  now.push_back(violation);
  return violation.steps >= bounds_.lasting;
}

template <class Real>
double InvariantMonitor<Real>::gap_scale(int joint) const {
  const WorldData<Real>& w = world_->data();
  const JointRecord& record = w.joints[joint];
  const JointId id{static_cast<std::uint32_t>(joint), w.joints.generation(joint)};
  return std::visit(
      [&](const auto& kind) {
        double scale = 0;
        const auto add = [&](int body, Vec2d anchor) {
          if (!w.is_dynamic(body)) return;
          const Vec2d arm = anchor - w.bodies[body].centre.template as<double>();
          scale = std::max({scale, std::sqrt(length_squared(arm)), static_cast<double>(w.extents[body])});
        };
        if constexpr (requires { kind.anchor_a; }) add(record.body_a, kind.anchor_a);
        if constexpr (requires { kind.anchor_b; }) add(record.body_b, kind.anchor_b);
        if constexpr (requires { kind.length + 1; }) scale = std::max(scale, kind.length);
        return scale;
      },
      world_->kind(id));
}

template <class Real>
std::optional<Error> InvariantMonitor<Real>::check_joints() {
  const WorldData<Real>& w = world_->data();
  previous_.swap(gaps_), gaps_.clear();
  for (int joint = 0; joint < w.joints.size(); ++joint) {
    if (!w.joints.used(joint) || !w.joints[joint].active) continue;
    const double gap =
        world_->read({static_cast<std::uint32_t>(joint), w.joints.generation(joint)}).linear_error;
    const double bound = bounds_.joint_gap * gap_scale(joint);
    if (!(bound > 0) || !is_persistent(gaps_, previous_, static_cast<std::uint64_t>(joint), gap, bound))
      continue;
    const JointRecord& record = w.joints[joint];
    return Error(Error::Kind::Run,
                 "joint of " + body_subject(w, record.body_a) + " and " + body_subject(w, record.body_b),
                 "gap", shortest(gap),
                 "is above " + shortest(bound) + " m; more substeps or solver = direct hold joints better");
  }
  return {};
}

template <class Real>
std::optional<Error> InvariantMonitor<Real>::check_overlaps() {
  const WorldData<Real>& w = world_->data();
  previous_.swap(overlaps_), overlaps_.clear();
  for (int contact = 0; contact < w.contacts.size(); ++contact) {
    if (!w.contacts.used(contact) || w.contacts[contact].home != ContactHome::Graph) continue;
    const ContactRecord& record = w.contacts[contact];
    const ContactConstraint<Real>& c = w.graph.at({record.colour, record.index});
    const double depth =
        -static_cast<double>(std::min(c.separation[0], c.count == 2 ? c.separation[1] : c.separation[0]));
    const double bound = bounds_.overlap * static_cast<double>(std::min(w.forms[record.shape_a].extent,
                                                                        w.forms[record.shape_b].extent));
    if (!is_persistent(overlaps_, previous_, static_cast<std::uint64_t>(contact), depth, bound)) continue;
    return Error(Error::Kind::Run, body_subject(w, record.body_a) + " and " + body_subject(w, record.body_b),
                 "overlap", shortest(depth),
                 "is above " + shortest(bound) + " m; more substeps hold contacts better");
  }
  return {};
}

template <class Real>
bool InvariantMonitor<Real>::is_driven() const {
  const WorldData<Real>& w = world_->data();
  for (const int body : w.awake) {
    const SolverBody<Real>& motion = w.motion[body];
    if (!w.is_dynamic(body) && (motion.velocity != Vec2<Real>{} || motion.angular_velocity != 0)) return true;
  }
  for (int joint = 0; joint < w.joints.size(); ++joint) {
    if (!w.joints.used(joint) || !w.joints[joint].active) continue;
    if (is_drive(world_->kind({static_cast<std::uint32_t>(joint), w.joints.generation(joint)}))) return true;
  }
  for (int contact = 0; contact < w.contacts.size(); ++contact) {
    if (!w.contacts.used(contact) || w.contacts[contact].home != ContactHome::Graph) continue;
    if (w.graph.at({w.contacts[contact].colour, w.contacts[contact].index}).surface_speed != 0) return true;
  }
  return false;
}

template <class Real>
std::optional<Error> InvariantMonitor<Real>::check_energy() {
  const WorldData<Real>& w = world_->data();
  // The solver corrects gaps and overlaps beyond their bounds, which may lift bodies.
  if (is_driven() || !gaps_.empty() || !overlaps_.empty()) {
    energy_gain_ = 0, energy_violation_steps_ = 0;
    return {};
  }
  double balance = 0, kinetic = 0, rounding = 0, largest_gain = 0, weight_times_extent = 0;
  int fastest = kNone;
  for (const int body : w.awake) {
    const auto i = static_cast<std::size_t>(body);
    if (i >= before_.size() || !before_[i].is_dynamic || !w.is_dynamic(body)) continue;
    const State& old = before_[i];
    const SolverBody<Real>& motion = w.motion[body];
    const Vec2d velocity = motion.velocity.template as<double>();
    const double angular_velocity = static_cast<double>(motion.angular_velocity);
    const double kinetic_now =
        (old.mass * length_squared(velocity) + old.inertia * angular_velocity * angular_velocity) / 2;
    const double kinetic_before = (old.mass * length_squared(old.velocity) +
                                   old.inertia * old.angular_velocity * old.angular_velocity) /
                                  2;
    const Vec2d displacement = w.position[body] - old.position;
    balance += kinetic_now - kinetic_before - dot(old.weight + old.force, displacement) -
               old.torque * (w.bodies[body].angle - old.angle);
    kinetic += kinetic_now;
    weight_times_extent += std::sqrt(length_squared(old.weight)) * static_cast<double>(w.extents[body]);
    rounding += kRoundings * static_cast<double>(std::numeric_limits<Real>::epsilon()) *
                (kinetic_now + kinetic_before +
                 std::sqrt(length_squared(old.weight)) * std::sqrt(length_squared(displacement)));
    if (kinetic_now - kinetic_before > largest_gain)
      largest_gain = kinetic_now - kinetic_before, fastest = body;
  }
  max_kinetic_energy_ = std::max(max_kinetic_energy_, kinetic);
  if (std::abs(balance) > rounding) energy_gain_ = std::max(energy_gain_ + balance, 0.0);
  // Bodies that have sunk within the penetration bound may rise again.
  const double bound = bounds_.energy * max_kinetic_energy_ + 2 * bounds_.overlap * weight_times_extent;
  energy_violation_steps_ = energy_gain_ > bound ? energy_violation_steps_ + 1 : 0;
  if (energy_violation_steps_ < bounds_.lasting) return {};
  return Error(Error::Kind::Run, fastest == kNone ? std::string("world") : body_subject(w, fastest), "energy",
               shortest(energy_gain_),
               "is gained without a drive, above " + shortest(bound) +
                   " J; a shorter step or more substeps may follow the motion");
}

template class InvariantMonitor<float>;
template class InvariantMonitor<double>;

}  // namespace plumb
