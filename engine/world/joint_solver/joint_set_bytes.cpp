#include <algorithm>
#include <memory>
#include <type_traits>

#include "engine/joints/joint_check.h"
#include "engine/scene/bytes.h"
#include "engine/scene/joint_fields.h"
#include "engine/world/joint_solver/joint_parts.h"

/// Serialises a set of joints. Writing and reading use the same lists of fields.
namespace plumb {
namespace {

struct Write {
  ByteWriter& out;
  template <class T>
  void operator()(T& value) const {
    out.value(value);
  }
  template <class T>
  void optional(std::optional<T>& value) const {
    out.value(value.has_value());
  }
  template <class T>
  void vector(std::vector<T>& all) const {
    out.values(all);
  }
  template <class T>
  void size(std::vector<T>& all) const {
    out.value(static_cast<std::uint64_t>(all.size()));
  }
  void kind(JointKind& kind) const { out.value(static_cast<std::uint64_t>(kind.index())); }
};

struct Read {
  ByteReader& in;
  template <class T>
  void operator()(T& value) const {
    value = in.value<T>("joints");
  }
  template <class T>
  void optional(std::optional<T>& value) const {
    value.reset();
    if (in.value<bool>("joints")) value.emplace();
  }
  template <class T>
  void vector(std::vector<T>& all) const {
    in.values(all, "joints");
  }
  template <class T>
  void size(std::vector<T>& all) const {
    // Each element takes at least a byte, so an invalid count does not allocate much.
    const auto count = in.value<std::uint64_t>("joints");
    ByteReader::require(count <= in.rest().size(), "joints", "are cut off");
    all.assign(static_cast<std::size_t>(count), T{});
  }
  void kind(JointKind& kind) const {
    const auto index = in.value<std::uint64_t>("joints");
    ByteReader::require(index < std::variant_size_v<JointKind>, "joints", "are of a kind that there is not");
    make<0>(kind, static_cast<std::size_t>(index));
  }

 private:
  template <std::size_t I>
  static void make(JointKind& kind, std::size_t index) {
    if constexpr (I < std::variant_size_v<JointKind>) {
      if (index == I) {
        kind.emplace<I>();
      } else {
        make<I + 1>(kind, index);
      }
    }
  }
};

// ---- Definitions

template <class A>
void fields(const A& ar, double& v) {
  ar(v);
}
template <class A>
void fields(const A& ar, Vec2d& v) {
  ar(v);
}
template <class A>
void fields(const A& ar, Spring& v) {
  ar(v.hertz), ar(v.damping_ratio);
}
template <class A>
void fields(const A& ar, Range& v) {
  ar(v.lower), ar(v.upper);
}
template <class A>
void fields(const A& ar, Motor& v) {
  ar(v.speed), ar(v.max_force);
}
template <class A, class T>
void fields(const A& ar, std::optional<T>& v) {
  ar.optional(v);
  if (v) fields(ar, *v);
}

/// Compiled once for both precisions.
template <class A>
[[gnu::noinline]] void fields(const A& ar, JointSlot& s) {
  ar.kind(s.definition);
  std::visit(
      [&](auto& definition) {
        const auto field = [&](const char*, auto& value, const FieldRule&) { fields(ar, value); };
        anchor_fields(definition, field);
        own_fields(definition, field);
      },
      s.definition);
  ar(s.a), ar(s.b), ar(s.centre_a), ar(s.centre_b);
  ar(s.used), ar(s.dynamic_a), ar(s.dynamic_b), ar(s.active);
  ar(s.form), ar(s.colour), ar(s.index), ar(s.carry);
}

// ---- State of constraints; the rest follows from slots and bodies

template <class A, class Real, template <class> class Kind>
void fields(const A& ar, JointConstraint<Real, Kind>& c) {
  using Constraint = JointConstraint<Real, Kind>;
  if constexpr (Constraint::kAngle != AngleUse::None) ar(c.angle.a), ar(c.angle.b), ar(c.angle.count);
  if constexpr (Constraint::kRatchet || Constraint::kPulley) ar(c.memory.value), ar(c.memory.known);
  c.results(c, [&](auto& value, auto&) { ar(value); });
}

/// Returns true if each body has the colours of its joints, and joints of one colour share no body. They are
/// solved side by side.
template <class Parts>
bool is_coloured(const Parts& p) {
  std::vector<BodyJoints> taken(p.taken.size());
  for (const JointSlot& s : p.slots) {
    if (!s.used || s.colour == kParked) continue;
    const std::uint32_t bit = s.colour < kJointColours ? std::uint32_t{1} << s.colour : 0;
    for (const auto& [body, moves] : {std::pair{s.a, s.moves_a()}, std::pair{s.b, s.dynamic_b}}) {
      if (!moves) continue;
      if ((taken[body].colours & bit) != 0) return false;
      taken[body].colours |= bit;
      ++taken[body].count;
    }
  }
  return taken == p.taken;
}

/// Returns true if slots and lists are consistent, as JointSet leaves them; other data must not be solved.
template <class Parts>
bool is_whole(const Parts& p) {
  std::size_t constraints = 0;
  for (int form = 0; form < kForms; ++form) {
    p.with(static_cast<JointForm>(form), [&](const auto& lists) {
      for (const auto& list : lists) constraints += list.size();
    });
  }
  const int bodies = static_cast<int>(p.taken.size()), slots = static_cast<int>(p.slots.size());
  int used = 0, active = 0;
  for (int joint = 0; joint < slots; ++joint) {
    const JointSlot& s = p.slot(joint);
    if (!s.used) continue;
    ++used;
    active += s.active ? 1 : 0;
    const bool placed = s.a >= 0 && s.a < bodies && s.b >= 0 && s.b < bodies && s.a != s.b &&
                        s.form == form_of(s.definition) && s.colour >= 0 && s.colour <= kParked &&
                        (s.colour == kParked) != s.active && s.index >= 0;
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
void JointSet<Real>::save(ByteWriter& out) const {
  const Write write{out};
  Parts& p = *parts_;  // only read from
  write(p.count), write(p.active);
  write.vector(p.free), write.vector(p.taken);
  write.size(p.slots);
  for (JointSlot& slot : p.slots) fields(write, slot);
  for (int form = 0; form < kForms; ++form) {
    p.with(static_cast<JointForm>(form), [&](auto& lists) {
      for (auto& list : lists) {
        write.size(list);
        for (auto& constraint : list) write(constraint.joint), fields(write, constraint);
      }
    });
  }
}

template <class Real>
void JointSet<Real>::restore(ByteReader& in) {
  const Read read{in};
  const auto fresh = std::make_unique<Parts>();
  Parts& p = *fresh;
  read(p.count), read(p.active);
  read.vector(p.free), read.vector(p.taken);
  read.size(p.slots);
  for (JointSlot& slot : p.slots) fields(read, slot);
  for (int form = 0; form < kForms; ++form) {
    p.with(static_cast<JointForm>(form), [&](auto& lists) {
      for (auto& list : lists) {
        read.size(list);
        for (auto& constraint : list) {
          read(constraint.joint);
          ByteReader::require(constraint.joint >= 0 && constraint.joint < static_cast<int>(p.slots.size()),
                              "joints", "name one that there is not");
          const JointSlot& s = p.slot(constraint.joint);
          using Definition = typename std::decay_t<decltype(constraint)>::Definition;
          const Definition* definition = std::get_if<Definition>(&s.definition);
          ByteReader::require(definition != nullptr, "joints", "are of another kind than they say");
          validate(s.definition);
          constraint.a = s.a;
          constraint.b = s.b;
          constraint.load(*definition, s.centre_a, s.centre_b);
          fields(read, constraint);
          constraint.recall();
        }
      }
    });
  }
  ByteReader::require(is_whole(p), "joints", "contradict each other");
  p.find_runs();
  *parts_ = std::move(p);
}

template void JointSet<float>::save(ByteWriter&) const;
template void JointSet<float>::restore(ByteReader&);
template void JointSet<double>::save(ByteWriter&) const;
template void JointSet<double>::restore(ByteReader&);

}  // namespace plumb
