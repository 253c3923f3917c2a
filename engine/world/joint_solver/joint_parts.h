#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/world/joint_solver/joint_lanes.h"
#include "engine/world/joint_solver/joint_lists.h"
#include "engine/world/joint_solver/joint_set.h"

namespace plumb {

/// Description of a joint, not used in the solver's passes.
struct JointSlot {
  JointKind definition{};
  int a = -1, b = -1;  ///< bodies
  Vec2d centre_a{}, centre_b{};
  JointReference reference{};
  bool used = false, dynamic_a = false, dynamic_b = false, active = false;
  JointForm form = kHinge;
  int colour = 0, index = 0;  ///< colour and index of its constraint
  double carry = 1;           ///< fraction of its impulses that iterations start from if they take it over

  /// A mouse joint does not move body a.
  bool moves_a() const { return dynamic_a && form != kMouse; }
  /// Returns the mobilities of its springs for bodies of these masses.
  template <class Real>
  SpringMobility springs(Vec2d at_a, Vec2d at_b, const PairMobility<Real>& p) const {
    return spring_mobility(definition, reference, at_a, at_b,
                           {static_cast<double>(p.m_a), static_cast<double>(p.i_a),
                            static_cast<double>(p.m_b), static_cast<double>(p.i_b)});
  }
};

/// The active joints of a dynamic body.
struct BodyJoints {
  std::uint32_t colours = 0;  ///< one bit each
  std::int32_t count = 0;

  bool operator==(const BodyJoints&) const = default;
};

/// A non-empty list of joints to solve.
struct JointRun {
  JointForm form;
  int colour;
  bool sorted = false;  ///< split into blocks and single joints, from `first` to `last`
  JointCounts first{}, last{};
};

/// Numbers of joints, and of blocks of joints, that a thread takes at a time: 1 to 2 us of work. A thread
/// needs 0.3 us to join a loop, so smaller tasks would cost more than they save.
inline constexpr int kJointsPerTask = 16, kBlocksPerTask = 8;

/// Joints side by side, of the forms that have them.
template <class Real, template <class> class... Kinds>
using BlocksOfKinds = std::tuple<JointBlocks<JointConstraint<Real, Kinds>>...>;
template <class Real>
using JointLaneStore = std::conditional_t<
    kNarrowLanes<Real> || kWideLanes<Real>,
    BlocksOfKinds<Real, HingeRows, DistanceRows, RevoluteRows, PrismaticRows, WeldRows, WheelRows>,
    std::tuple<>>;
template <class Constraint, class... Blocks>
constexpr bool has_blocks(const std::tuple<Blocks...>*) {
  return (std::is_same_v<JointBlocks<Constraint>, Blocks> || ...);
}
template <class Constraint>
inline constexpr bool kHasLanes = has_blocks<Constraint>(
    static_cast<const JointLaneStore<Scalar<decltype(Constraint::under_relaxation)>>*>(nullptr));

/// Functions that take their visitor by address, so that they are compiled once, not for each form and pass.
using VisitRange = void (*)(const void* it, int first, int last);
using VisitCounts = void (*)(const void* it, JointCounts first, JointCounts last);
void share_range(int count, int grain, LoopScheduler* scheduler, VisitRange visit, const void* it);
void share_run(const JointRun& run, int count, LoopScheduler* scheduler, VisitRange visit, const void* it);
void share_blocks(const JointRun& run, LoopScheduler* scheduler, VisitCounts visit, const void* it);

/// Calls `visit(first, last)` for ranges of joints or blocks of them, shared among threads.
template <class Visit>
void share_range(int count, int grain, LoopScheduler* scheduler, const Visit& visit) {
  const auto call = [](const void* it, int first, int last) {
    (*static_cast<const Visit*>(it))(first, last);
  };
  share_range(count, grain, scheduler, call, &visit);
}

/// Calls `visit(first, last)` for ranges of a run's joints: in turn, or shared among threads if they have a
/// colour.
template <class Visit>
void share_run(const JointRun& run, int count, LoopScheduler* scheduler, const Visit& visit) {
  const auto call = [](const void* it, int first, int last) {
    (*static_cast<const Visit*>(it))(first, last);
  };
  share_run(run, count, scheduler, call, &visit);
}

/// Calls `visit(first, last)` for ranges of a sorted run's blocks and of its single joints.
template <class Visit>
void share_blocks(const JointRun& run, LoopScheduler* scheduler, const Visit& visit) {
  const auto call = [](const void* it, JointCounts first, JointCounts last) {
    (*static_cast<const Visit*>(it))(first, last);
  };
  share_blocks(run, scheduler, call, &visit);
}

template <class Real>
struct JointSet<Real>::Parts {
  std::vector<JointSlot> slots;
  std::vector<int> free;
  std::vector<BodyJoints> body_joints;  ///< by body: its active joints and their colours
  std::vector<JointRun> runs;           ///< in the order of solving
  JointStore<Real> store;
  JointLaneStore<Real> lanes;
  int count = 0, active = 0;

  const JointSlot& slot(int joint) const { return slots[static_cast<std::size_t>(joint)]; }
  JointSlot& slot(int joint) { return slots[static_cast<std::size_t>(joint)]; }

  /// Calls f with the lists of a form.
  template <class F>
  decltype(auto) with(JointForm form, F&& f) {
    return dispatch(store, form, std::forward<F>(f));
  }
  template <class F>
  decltype(auto) with(JointForm form, F&& f) const {
    return dispatch(store, form, std::forward<F>(f));
  }
  /// Calls f with the constraint of a joint.
  template <class F>
  decltype(auto) at(int joint, F&& f) const {
    const JointSlot& s = slot(joint);
    return with(s.form, [&](const auto& lists) -> decltype(auto) { return f(lists[s.colour][s.index]); });
  }
  template <class F>
  decltype(auto) at(int joint, F&& f) {
    const JointSlot& s = slot(joint);
    return with(s.form, [&](auto& lists) -> decltype(auto) { return f(lists[s.colour][s.index]); });
  }

  /// Visits active joints in the order of solving.
  template <class F>
  void for_each_active(F&& f) {
    for (const JointRun& run : runs) {
      with(run.form, [&](auto& lists) {
        for (auto& constraint : lists[run.colour]) f(constraint);
      });
    }
  }

  /// Returns the first colour that no joint of its dynamic bodies has.
  int free_colour(const JointSlot& s) const;
  /// Sets or clears the joint's colour at its dynamic bodies.
  void mark_colour(const JointSlot& s, bool used);
  /// Creates a constraint from the slot's definition.
  void create(int joint);
  /// Removes the joint's constraint from its list.
  void erase_constraint(int joint);
  /// Reserves memory for the constraint of a joint whose colour is not marked, so that adding it does not
  /// allocate.
  void reserve_constraint(JointForm form, const JointSlot& s);
  /// Adds a constraint at the slot's colour.
  template <class Constraint>
  void insert_constraint(int joint, const Constraint& constraint);
  /// Sets the slot's state, and moves the constraint to the list that follows from it. Changes nothing if
  /// memory runs out.
  void relocate(int joint, bool is_active, bool dynamic_a, bool dynamic_b);
  void rebuild_runs();

 private:
  template <int kForm = 0, class Store, class F>
  static decltype(auto) dispatch(Store& store, JointForm form, F&& f) {
    if constexpr (kForm + 1 < kForms)
      if (form != kForm) return dispatch<kForm + 1>(store, form, std::forward<F>(f));
    return f(std::get<kForm>(store));
  }
};

}  // namespace plumb
