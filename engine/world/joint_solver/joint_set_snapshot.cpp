#include <algorithm>
#include <memory>
#include <type_traits>

#include "engine/encoding/encoding.h"
#include "engine/joints/definition_members.h"
#include "engine/joints/joint_check.h"
#include "engine/world/joint_solver/joint_parts.h"

/// Saves and restores a set of joints.
namespace plumb {

template <>
inline constexpr int kEnumerators<JointForm> = kForms;
template <>
inline constexpr int kEnumerators<TurnCount> = 3;
PLUMB_MEMBERS(JointReference, offset, rotation)
PLUMB_MEMBERS(JointSlot, definition, a, b, centre_a, centre_b, reference, used, dynamic_a, dynamic_b, active,
              form, colour, index, carry)
PLUMB_MEMBERS(BodyJoints, colours, count)

namespace {

/// Visits the state of a constraint; the rest follows from slots and bodies. Writing and reading use the same
/// list.
template <class Real, template <class> class Kind, class Visit>
void visit_state(JointConstraint<Real, Kind>& c, const Visit& visit) {
  using Constraint = JointConstraint<Real, Kind>;
  if constexpr (Constraint::kAngle != AngleUse::None)
    visit(c.angle.a), visit(c.angle.b), visit(c.angle.count);
  if constexpr (Constraint::kRatchet || Constraint::kPulley) visit(c.memory.value), visit(c.memory.known);
  c.results(c, [&](auto& value, auto&) { visit(value); });
}

/// Returns true if each body has the colours of its joints, and joints of one colour share no body. They are
/// solved side by side.
template <class Parts>
bool is_coloured(const Parts& p) {
  std::vector<BodyJoints> body_joints(p.body_joints.size());
  for (const JointSlot& s : p.slots) {
    if (!s.used || s.colour == kInactiveColour) continue;
    const std::uint32_t bit = s.colour < kJointColours ? std::uint32_t{1} << s.colour : 0;
    for (const auto& [body, moves] : {std::pair{s.a, s.moves_a()}, std::pair{s.b, s.dynamic_b}}) {
      if (!moves) continue;
      if ((body_joints[body].colours & bit) != 0) return false;
      body_joints[body].colours |= bit;
      ++body_joints[body].count;
    }
  }
  return body_joints == p.body_joints;
}

/// Returns true if slots and lists are consistent, as JointSet leaves them; other data must not be solved.
template <class Parts>
bool is_consistent(const Parts& p) {
  std::size_t constraints = 0;
  for (int form = 0; form < kForms; ++form) {
    p.with(static_cast<JointForm>(form), [&](const auto& lists) {
      for (const auto& list : lists) constraints += list.size();
    });
  }
  const int bodies = static_cast<int>(p.body_joints.size()), slots = static_cast<int>(p.slots.size());
  int used = 0, active = 0;
  for (int joint = 0; joint < slots; ++joint) {
    const JointSlot& s = p.slot(joint);
    if (!s.used) continue;
    ++used;
    active += s.active ? 1 : 0;
    const bool placed = s.a >= 0 && s.a < bodies && s.b >= 0 && s.b < bodies && s.a != s.b &&
                        s.form == form_of(s.definition) && s.colour >= 0 && s.colour <= kInactiveColour &&
                        (s.colour == kInactiveColour) != s.active && s.index >= 0;
    const bool found = placed && p.with(s.form, [&](const auto& lists) {
      const auto& list = lists[s.colour];
      return s.index < static_cast<int>(list.size()) && list[s.index].joint == joint;
    });
    if (!found) return false;
  }
  const bool free = std::all_of(p.free.begin(), p.free.end(), [&](int joint) {
    return joint >= 0 && joint < slots && !p.slot(joint).used;
  });
  return free && constraints == static_cast<std::size_t>(used) && used == p.count && active == p.active &&
         used + static_cast<int>(p.free.size()) == slots && is_coloured(p);
}

}  // namespace

template <class Real>
void JointSet<Real>::save(Encoder& out) const {
  Parts& p = *parts_;  // only read from
  out.put(p.count), out.put(p.active), out.put(p.free), out.put(p.body_joints), out.put(p.slots);
  for (int form = 0; form < kForms; ++form) {
    p.with(static_cast<JointForm>(form), [&](auto& lists) {
      for (auto& list : lists) {
        out.put(static_cast<std::uint64_t>(list.size()));
        for (auto& constraint : list) {
          out.put(constraint.joint);
          visit_state(constraint, [&](const auto& value) { out.put(value); });
        }
      }
    });
  }
}

template <class Real>
void JointSet<Real>::restore(Decoder& in) {
  constexpr char kJoints[] = "joints";
  const auto fresh = std::make_unique<Parts>();
  Parts& p = *fresh;
  in.get(p.count, kJoints), in.get(p.active, kJoints), in.get(p.free, kJoints),
      in.get(p.body_joints, kJoints);
  in.get(p.slots, kJoints);
  for (int form = 0; form < kForms; ++form) {
    p.with(static_cast<JointForm>(form), [&](auto& lists) {
      using Constraint = typename std::decay_t<decltype(lists[0])>::value_type;
      for (auto& list : lists) {
        // Each joint has one constraint, so an invalid count does not allocate much.
        const auto count = in.template get<std::uint64_t>(kJoints);
        in.require(count <= p.slots.size(), kJoints, "are fewer than their constraints");
        list.assign(static_cast<std::size_t>(count), Constraint{});
        for (Constraint& constraint : list) {
          in.get(constraint.joint, kJoints);
          in.require(constraint.joint >= 0 && constraint.joint < static_cast<int>(p.slots.size()), kJoints,
                     "name one that there is not");
          const JointSlot& s = p.slot(constraint.joint);
          const auto* definition = std::get_if<typename Constraint::Definition>(&s.definition);
          in.require(definition != nullptr, kJoints, "are of another kind than they say");
          validate(s.definition);
          constraint.a = s.a;
          constraint.b = s.b;
          constraint.load(*definition, s.centre_a, s.centre_b);
          visit_state(constraint, [&](auto& value) { in.get(value, kJoints); });
          constraint.restore_rule();
        }
      }
    });
  }
  in.require(is_consistent(p), kJoints, "contradict each other");
  p.rebuild_runs();
  *parts_ = std::move(p);
}

template void JointSet<float>::save(Encoder&) const;
template void JointSet<float>::restore(Decoder&);
template void JointSet<double>::save(Encoder&) const;
template void JointSet<double>::restore(Decoder&);

}  // namespace plumb
