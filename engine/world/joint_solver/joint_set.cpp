#include "engine/world/joint_solver/joint_set.h"

#include <algorithm>
#include <bit>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/core/capacity.h"
#include "engine/joints/joint_check.h"
#include "engine/scene/error.h"
#include "engine/world/joint_solver/joint_parts.h"

namespace plumb {
namespace {

void check_bodies(const JointKind& definition, int body_a, int body_b) {
  if (body_a == body_b)
    throw Error(Error::Kind::Value, name_of(definition), "body_b", std::to_string(body_b),
                "must not be body_a: a joint needs two bodies");
}

template <class Real>
Pose<double> pose_of(const SolverBodies<Real>& bodies, int body) {
  const Rotation<Real>& q = bodies.rotation[body];
  return {bodies.position[body], {static_cast<double>(q.c), static_cast<double>(q.s)}};
}

/// Loads the slot's definition into the constraint.
template <class Parts>
void reload(Parts& parts, int joint) {
  const JointSlot& s = parts.slot(joint);
  parts.at(joint, [&](auto& constraint) {
    using Definition = typename std::decay_t<decltype(constraint)>::Definition;
    constraint.load(std::get<Definition>(s.definition), s.centre_a, s.centre_b);
  });
}

/// Visits the point impulse and the load of a revolute joint, in either of its forms.
template <class Parts, class F>
void hinge_impulse(Parts& parts, int joint, F&& f) {
  parts.at(joint, [&]<class Constraint>(Constraint& constraint) {
    if constexpr (std::is_same_v<typename Constraint::Definition, RevoluteDefinition>)
      f(constraint.point.impulse, constraint.mean_force);
  });
}

}  // namespace

// ---- Storage of constraints

template <class Real>
int JointSet<Real>::Parts::free_colour(const JointSlot& s) const {
  std::uint32_t used = 0;
  if (s.moves_a()) used |= body_joints[s.a].colours;
  if (s.dynamic_b) used |= body_joints[s.b].colours;
  return std::min(std::countr_one(used), kOverflowColour);
}

template <class Real>
void JointSet<Real>::Parts::mark_colour(const JointSlot& s, bool used) {
  if (s.colour == kInactiveColour) return;
  const std::uint32_t bit = s.colour < kJointColours ? std::uint32_t{1} << s.colour : 0;
  for (const auto& [body, moves] : {std::pair{s.a, s.moves_a()}, std::pair{s.b, s.dynamic_b}}) {
    if (!moves) continue;
    BodyJoints& joints = body_joints[body];
    joints.colours = used ? joints.colours | bit : joints.colours & ~bit;
    joints.count += used ? 1 : -1;
  }
}

template <class Real>
void JointSet<Real>::Parts::create(int joint) {
  JointSlot& s = slot(joint);
  const std::size_t bodies = static_cast<std::size_t>(std::max(s.a, s.b)) + 1;
  if (body_joints.size() < bodies) body_joints.resize(std::max(bodies, 2 * body_joints.size()));
  s.form = form_of(s.definition);
  with(s.form, [&](auto& lists) {
    typename std::decay_t<decltype(lists[0])>::value_type constraint;
    constraint.joint = joint;
    constraint.a = s.a;
    constraint.b = s.b;
    using Definition = typename decltype(constraint)::Definition;
    constraint.load(std::get<Definition>(s.definition), s.centre_a, s.centre_b);
    insert_constraint(joint, constraint);
  });
}

template <class Real>
void JointSet<Real>::Parts::erase_constraint(int joint) {
  const JointSlot& s = slot(joint);
  with(s.form, [&](auto& lists) {
    auto& list = lists[s.colour];
    list[s.index] = list.back();
    slot(list[s.index].joint).index = s.index;
    list.pop_back();
    if (list.empty()) rebuild_runs();
  });
}

template <class Real>
template <class Constraint>
void JointSet<Real>::Parts::insert_constraint(int joint, const Constraint& constraint) {
  JointSlot& s = slot(joint);
  reserve_constraint(s.form, s);
  s.colour = s.active ? free_colour(s) : kInactiveColour;
  mark_colour(s, true);
  auto& list = std::get<JointLists<Constraint>>(store)[s.colour];
  s.index = static_cast<int>(list.size());
  list.push_back(constraint);
  if (list.size() == 1) rebuild_runs();
}

template <class Real>
void JointSet<Real>::Parts::reserve_constraint(JointForm form, const JointSlot& s) {
  const int colour = s.active ? free_colour(s) : kInactiveColour;
  runs.reserve(static_cast<std::size_t>(kForms) * (kOverflowColour + 1));
  with(form, [&](auto& lists) { ensure_capacity(lists[colour], lists[colour].size() + 1); });
}

template <class Real>
void JointSet<Real>::Parts::relocate(int joint, bool is_active, bool dynamic_a, bool dynamic_b) {
  JointSlot& s = slot(joint);
  const std::tuple before(s.active, s.dynamic_a, s.dynamic_b);
  mark_colour(s, false);
  s.active = is_active, s.dynamic_a = dynamic_a, s.dynamic_b = dynamic_b;
  try {
    reserve_constraint(s.form, s);
  } catch (...) {
    std::tie(s.active, s.dynamic_a, s.dynamic_b) = before;
    mark_colour(s, true);
    throw;
  }
  with(s.form, [&](auto& lists) {
    const auto constraint = lists[s.colour][s.index];
    erase_constraint(joint);
    insert_constraint(joint, constraint);
  });
}

template <class Real>
void JointSet<Real>::Parts::rebuild_runs() {
  runs.clear();
  for (int colour = 0; colour <= kOverflowColour; ++colour) {
    for (int form = 0; form < kForms; ++form) {
      const JointForm f = static_cast<JointForm>(form);
      if (with(f, [&](const auto& lists) { return !lists[colour].empty(); })) runs.push_back({f, colour});
    }
  }
}

// ---- Adding and removing joints

template <class Real>
JointSet<Real>::JointSet() : parts_(std::make_unique<Parts>()) {}
template <class Real>
JointSet<Real>::JointSet(const JointSet& other) : parts_(std::make_unique<Parts>(*other.parts_)) {}
template <class Real>
JointSet<Real>::JointSet(JointSet&& other) noexcept = default;
template <class Real>
JointSet<Real>& JointSet<Real>::operator=(JointSet other) noexcept {
  parts_.swap(other.parts_);
  return *this;
}
template <class Real>
JointSet<Real>::~JointSet() = default;

template <class Real>
int JointSet<Real>::add(const JointKind& definition, int body_a, int body_b, Vec2<Real> centre_a,
                        Vec2<Real> centre_b, bool dynamic_a, bool dynamic_b,
                        const SolverBodies<Real>& bodies) {
  validate(definition);
  check_bodies(definition, body_a, body_b);
  Parts& p = *parts_;
  ensure_capacity(p.free, p.slots.size() + 1);  // so that removing a joint does not allocate
  if (p.free.empty()) {
    p.slots.emplace_back();
    p.free.push_back(static_cast<int>(p.slots.size()) - 1);
  }
  const int joint = p.free.back();
  p.free.pop_back();
  const Vec2d arm_a = centre_a.template as<double>(), arm_b = centre_b.template as<double>();
  p.slot(joint) = {.definition = definition,
                   .a = body_a,
                   .b = body_b,
                   .centre_a = arm_a,
                   .centre_b = arm_b,
                   .reference = reference_of(pose_of(bodies, body_a), arm_a, pose_of(bodies, body_b), arm_b),
                   .used = true,
                   .dynamic_a = dynamic_a,
                   .dynamic_b = dynamic_b,
                   .active = dynamic_a || dynamic_b};
  try {
    p.create(joint);
  } catch (...) {
    p.slot(joint) = {};
    p.free.push_back(joint);
    throw;
  }
  ++p.count;
  if (p.slot(joint).active) ++p.active;
  return joint;
}

template <class Real>
void JointSet<Real>::remove(int joint) {
  Parts& p = *parts_;
  ensure_capacity(p.free, p.free.size() + 1);
  p.mark_colour(p.slot(joint), false);
  p.erase_constraint(joint);
  --p.count;
  if (p.slot(joint).active) --p.active;
  p.slot(joint) = {};
  p.free.push_back(joint);
}

template <class Real>
void JointSet<Real>::set_active(int joint, bool active) {
  Parts& p = *parts_;
  const JointSlot& s = p.slot(joint);
  if (s.active == active) return;
  p.relocate(joint, active, s.dynamic_a, s.dynamic_b);
  p.active += active ? 1 : -1;
}

template <class Real>
void JointSet<Real>::set_dynamic(int joint, bool dynamic_a, bool dynamic_b, bool active) {
  Parts& p = *parts_;
  const JointSlot& s = p.slot(joint);
  if (s.dynamic_a == dynamic_a && s.dynamic_b == dynamic_b && s.active == active) return;
  const int before = s.active ? 1 : 0;
  p.relocate(joint, active, dynamic_a, dynamic_b);
  p.active += (active ? 1 : 0) - before;
}

template <class Real>
void JointSet<Real>::change(int joint, const JointKind& definition) {
  Parts& p = *parts_;
  JointSlot& s = p.slot(joint);
  validate(definition);
  if (form_of(definition) == s.form) {
    s.definition = definition;
    reload(p, joint);
    return;
  }
  Vec2<Real> impulse{}, force{};
  hinge_impulse(p, joint,
                [&](const Vec2<Real>& now, const Vec2<Real>& mean) { impulse = now, force = mean; });
  p.mark_colour(s, false);
  try {
    p.reserve_constraint(form_of(definition), s);
  } catch (...) {
    p.mark_colour(s, true);
    throw;
  }
  p.erase_constraint(joint);
  s.definition = definition;
  p.create(joint);
  hinge_impulse(p, joint, [&](Vec2<Real>& now, Vec2<Real>& mean) { now = impulse, mean = force; });
}

template <class Real>
void JointSet<Real>::recentre(int joint, Vec2<Real> centre_a, Vec2<Real> centre_b) {
  JointSlot& s = parts_->slot(joint);
  s.centre_a = centre_a.template as<double>();
  s.centre_b = centre_b.template as<double>();
  reload(*parts_, joint);
}

template <class Real>
void JointSet<Real>::reset(int joint) {
  parts_->at(joint, [](auto& constraint) { constraint.reset(); });
}

template <class Real>
void JointSet<Real>::reset_impulses(int joint) {
  parts_->at(joint, [](auto& constraint) { constraint.reset_impulses(); });
}

template <class Real>
void JointSet<Real>::set_initial_angles(int joint, double angle_a, double angle_b) {
  parts_->at(joint, [=](auto& constraint) { constraint.set_initial_angles(angle_a, angle_b); });
}

template <class Real>
void JointSet<Real>::set_warm_start_fraction(int joint, double fraction) {
  assert(fraction >= 0 && fraction <= 1);
  parts_->slot(joint).carry = fraction;
}

template <class Real>
double JointSet<Real>::warm_start_fraction(int joint) const {
  return parts_->slot(joint).carry;
}

template <class Real>
Real JointSet<Real>::take_over(int joint) {
  double& carry = parts_->slot(joint).carry;
  if (carry == 1) return 1;
  const Real fraction = static_cast<Real>(std::exchange(carry, 1));
  parts_->at(joint, [&](auto& constraint) { constraint.scale(fraction); });
  return fraction;
}

// ---- Reading

template <class Real>
const JointKind& JointSet<Real>::definition(int joint) const {
  return parts_->slot(joint).definition;
}
template <class Real>
int JointSet<Real>::count() const {
  return parts_->count;
}
template <class Real>
int JointSet<Real>::active_count() const {
  return parts_->active;
}
template <class Real>
int JointSet<Real>::slots() const {
  return static_cast<int>(parts_->slots.size());
}
template <class Real>
bool JointSet<Real>::contains(int joint) const {
  return joint >= 0 && joint < slots() && parts_->slot(joint).used;
}
template <class Real>
bool JointSet<Real>::active(int joint) const {
  return parts_->slot(joint).active;
}
template <class Real>
std::pair<int, int> JointSet<Real>::bodies(int joint) const {
  return {parts_->slot(joint).a, parts_->slot(joint).b};
}
template <class Real>
std::pair<bool, bool> JointSet<Real>::dynamic(int joint) const {
  return {parts_->slot(joint).dynamic_a, parts_->slot(joint).dynamic_b};
}
template <class Real>
int JointSet<Real>::colour(int joint) const {
  return parts_->slot(joint).colour;
}
template <class Real>
int JointSet<Real>::colours() {
  return kJointColours + 1;
}

template class JointSet<float>;
template class JointSet<double>;

}  // namespace plumb
