#include "engine/world/joint_solver/joint_lanes.h"

#include <algorithm>
#include <cstddef>

#include "engine/core/capacity.h"
#include "engine/world/joint_solver/joint_opening.h"

namespace plumb {
namespace {

// Minimum number of joints in a block: fewer cost less when solved one at a time.
constexpr int kMinLanes = 3;
// Maximum number of kinds of joints of a colour for which blocks are filled side by side. Joints of further
// kinds are solved one at a time.
constexpr int kMaxKinds = 8;

// Calls a function that is inlined and compiled for registers of this many bytes.
template <int kBytes>
struct Compiled {
  template <class Run>
  static void run(const Run& run) {
    run();
  }
};
template <>
struct Compiled<32> {
  template <class Run>
  PLUMB_AVX2 static void run(const Run& run) {
    run();
  }
};

/// Calls `act(number, address)` for pairs of a block's number and the function that finds it in a lane.
template <class Joint, class Act>
[[gnu::always_inline]] inline auto in_lanes(Joint* const* from, const Act& act) {
  return [ from, &act ]<class Number, class Value>(Number & x, Value & one) __attribute__((always_inline)) {
    const std::ptrdiff_t offset = reinterpret_cast<char*>(&one) - reinterpret_cast<char*>(from[0]);
    act(
        x, [ from, offset ](int i) __attribute__((always_inline))->Value &
               { return *reinterpret_cast<Value*>(reinterpret_cast<char*>(from[i]) + offset); });
  };
}

/// Returns the properties that joints of a block have in common: the rules' roles, and whether they are
/// isolated.
template <class Joint>
std::uint64_t kind_of_lanes(const Joint& joint) {
  std::uint64_t key = joint.isolated ? 1 : 0;
  const auto add = [&key](const auto& coordinate) {
    key = key << 3 | static_cast<unsigned>(coordinate.count);
    for (int i = 0; i < coordinate.count; ++i)
      key = key << 2 | static_cast<unsigned>(coordinate.rule[i].role);
  };
  if constexpr (Joint::Rows::kAngular) add(joint.angular);
  for (const auto& coordinate : joint.axial) add(coordinate);
  return key;
}

/// Sets the properties that joints of the kind have in common.
template <class Lanes, class Joint>
void copy_kind(Lanes& block, const Joint& from) {
  block.isolated = from.isolated;
  const auto take = [](auto& coordinate, const auto& other) {
    coordinate.count = other.count;
    for (int i = 0; i < other.count; ++i) coordinate.rule[i].role = other.rule[i].role;
  };
  if constexpr (Joint::Rows::kAngular) take(block.angular, from.angular);
  for (int i = 0; i < Joint::kAxial; ++i) take(block.axial[i], from.axial[i]);
}

/// Visits the numbers needed at the start of a step, of a block and of one of its joints.
template <class Lanes, class Joint, class Visit>
[[gnu::always_inline]] inline void visit_inputs(Lanes& block, Joint& one, const Visit& visit) {
  const auto pair = [&](auto& x, auto& y) __attribute__((always_inline)) {
    visit(x.x, y.x), visit(x.y, y.y);
  };
  const auto coordinate = [&](auto& x, auto& y) __attribute__((always_inline)) {
    for (int i = 0; i < x.count; ++i) {
      auto& p = x.rule[i];
      auto& q = y.rule[i];
      visit(p.sign, q.sign), visit(p.origin, q.origin), visit(p.speed, q.speed),
          visit(p.max_impulse, q.max_impulse);
      visit(p.spring.rate, q.spring.rate), visit(p.spring.compliance, q.spring.compliance);
      visit(p.impulse, q.impulse), visit(p.drift, q.drift);
    }
  };
  pair(block.offset, one.offset);
  pair(block.kind.anchor_a, one.kind.anchor_a), pair(block.kind.anchor_b, one.kind.anchor_b);
  if constexpr (requires { one.kind.axis; }) pair(block.kind.axis, one.kind.axis);
  if constexpr (Joint::kAngle != AngleUse::None) visit(block.angle.start, one.angle.start);
  if constexpr (Joint::Rows::kAngular) coordinate(block.angular, one.angular);
  for (int i = 0; i < Joint::kAxial; ++i) coordinate(block.axial[i], one.axial[i]);
  if constexpr (Joint::kBlock > 0)
    for (int i = 0; i < Joint::kBlock; ++i) visit(block.block.impulse[i], one.block.impulse[i]);
  if constexpr (Joint::Rows::kPoint) pair(block.point.impulse, one.point.impulse);
}

template <class Block>
[[gnu::always_inline]] inline void store_results(Block& block) {
  const auto store = [&]<class Number>(Number & x, const auto& lane) __attribute__((always_inline)) {
    Scalar<Number> value[Number::kLanes];
    x.store(value);
    for (int i = 0; i < Number::kLanes; ++i) lane(i) = value[i];
  };
  block.joint.results(*block.from[0], in_lanes(block.from, store));
}

/// The bodies of a block.
template <class Number>
struct LanePairs {
  using Real = Scalar<Number>;
  LaneBodies<Number> a, b;
  JointVelocities<Number> v;

  template <class Block>
  [[gnu::always_inline]] LanePairs(const Block& block, const SolverBodies<Real>& bodies, bool moves)
      : a(bodies.motion, block.offset_a, block.inverse_mass_a, block.inverse_inertia_a, moves),
        b(bodies.motion, block.offset_b, block.inverse_mass_b, block.inverse_inertia_b, moves),
        v(a, b) {}

  [[gnu::always_inline]] JointMotion<Number> motion(const SolverBodies<Real>& bodies) const {
    const auto rotation = [&](const std::uint32_t(&offset)[Number::kLanes]) __attribute__((always_inline)) {
      const auto at = [&](int i) __attribute__((always_inline))->const Rotation<Real>& {
        return bodies.rotation[offset[i] / kOffsetUnits<Real>];
      };
      return Rotation<Number>{Number::of([&](int i) __attribute__((always_inline)) { return at(i).c; }),
                              Number::of([&](int i) __attribute__((always_inline)) { return at(i).s; })};
    };
    return {a.delta_position, b.delta_position,   a.delta_angle,
            b.delta_angle,    rotation(a.offset), rotation(b.offset)};
  }
  template <class Block>
  [[gnu::always_inline]] void store(const Block& block) const {
    if (block.dynamic_a) a.store(v.v_a, v.w_a);
    if (block.dynamic_b) b.store(v.v_b, v.w_b);
  }
};

}  // namespace

template <class Joint>
void JointBlocks<Joint>::begin(VectorWidth width) {
  width_ = !kNarrow && width == VectorWidth::Bytes16 ? VectorWidth::None : width;
  count_ = narrow_ = 0, singles_.clear(), places_.clear();
}

template <class Joint>
void JointBlocks<Joint>::sort(std::vector<Joint>& joints, const SolverBody<Real>* motion,
                              const std::vector<char>& excluded) {
  ensure_capacity(singles_, singles_.size() + joints.size());
  if constexpr (kWide)
    if (width_ == VectorWidth::Bytes32) return sort_into<32>(joints, motion, excluded);
  if constexpr (kNarrow)
    if (width_ == VectorWidth::Bytes16) return sort_into<16>(joints, motion, excluded);
  for (Joint& joint : joints) singles_.push_back(&joint);
}

template <class Joint>
template <int kBytes>
void JointBlocks<Joint>::add_block(std::vector<Block<kBytes>>& blocks, int place, Joint* const* joints,
                                   int count, std::uint64_t kind) {
  if (place == static_cast<int>(blocks.size())) {
    ensure_capacity(blocks, blocks.size() + 1);
    blocks.emplace_back();
  }
  Block<kBytes>& block = blocks[place];
  for (int i = 0; i < block.kLanes; ++i) block.from[i] = joints[std::min(i, count - 1)];
  block.dynamic_a = (kind & 1) != 0, block.dynamic_b = (kind & 2) != 0;
  ++count_;
}

template <class Joint>
template <int kBytes>
void JointBlocks<Joint>::sort_into(std::vector<Joint>& joints, const SolverBody<Real>* motion,
                                   const std::vector<char>& excluded) {
  constexpr int kLanes = Block<kBytes>::kLanes;
  struct PartialBlock {
    std::uint64_t kind;
    int count = 0;
    Joint* joint[kLanes];
  } partial[kMaxKinds];
  int kinds = 0;
  const auto add = [&](const PartialBlock& from) {
    if constexpr (kNarrow) {
      if (from.count <= Block<16>::kLanes) {
        append(places_, -1 - narrow_);
        return add_block<16>(blocks16_, narrow_++, from.joint, from.count, from.kind);
      }
    }
    if constexpr (kWide) {
      append(places_, count_ - narrow_);
      add_block<32>(blocks32_, count_ - narrow_, from.joint, from.count, from.kind);
    }
  };
  for (Joint& joint : joints) {
    if constexpr (Joint::kPlainHinge)
      if (joint.external) continue;
    if (!excluded.empty() && excluded[joint.joint]) {
      singles_.push_back(&joint);
      continue;
    }
    const std::uint64_t kind = kind_of_lanes(joint) << 2 | std::uint64_t{is_dynamic(motion[joint.b])} << 1 |
                               std::uint64_t{is_dynamic(motion[joint.a])};
    int place = 0;
    while (place < kinds && partial[place].kind != kind) ++place;
    if (place == kMaxKinds) {
      singles_.push_back(&joint);
      continue;
    }
    PartialBlock& of_kind = partial[place];
    if (place == kinds) ++kinds, of_kind.kind = kind;
    of_kind.joint[of_kind.count++] = &joint;
    if (of_kind.count == kLanes) add(of_kind), of_kind.count = 0;
  }
  for (int place = 0; place < kinds; ++place) {
    const PartialBlock& rest = partial[place];
    if (rest.count >= kMinLanes) {
      add(rest);
    } else {
      singles_.insert(singles_.end(), rest.joint, rest.joint + rest.count);
    }
  }
}

template <class Joint>
template <class Run>
[[gnu::always_inline]] inline void JointBlocks<Joint>::for_each(int first, int last, const Run& run) {
  if constexpr (kWide) {
    if (width_ == VectorWidth::Bytes32)
      return Compiled<32>::run([&]() __attribute__((always_inline)) {
        for (int i = first; i < last; ++i) {
          const int place = places_[i];
          if constexpr (kNarrow) {
            if (place < 0) {
              run(blocks16_[-1 - place]);
              continue;
            }
          }
          run(blocks32_[place]);
        }
      });
  }
  if constexpr (kNarrow)
    Compiled<16>::run([&]() __attribute__((always_inline)) {
      for (int i = first; i < last; ++i) run(blocks16_[-1 - places_[i]]);
    });
}

template <class Joint>
void JointBlocks<Joint>::prepare(int first, int last, const SolverBodies<Real>& bodies,
                                 const JointStep<Real>& step, FactorOf factor_of, const void* data) {
  for_each(
      first, last, [&]<class Number>(LanesOfJoints<Joint, Number> & block) __attribute__((always_inline)) {
        for (int i = 0; i < block.kLanes; ++i) {
          block.offset_a[i] = kOffsetUnits<Real> * static_cast<std::uint32_t>(block.from[i]->a);
          block.offset_b[i] = kOffsetUnits<Real> * static_cast<std::uint32_t>(block.from[i]->b);
        }
        load_masses(bodies.motion, block.offset_a, block.inverse_mass_a, block.inverse_inertia_a);
        load_masses(bodies.motion, block.offset_b, block.inverse_mass_b, block.inverse_inertia_b);
        copy_kind(block.joint, *block.from[0]);
        const auto load = [&](Number & x, const auto& lane) __attribute__((always_inline)) {
          x = Number::of([&](int i) __attribute__((always_inline)) { return static_cast<Real>(lane(i)); });
        };
        visit_inputs(block.joint, *block.from[0], in_lanes(block.from, load));
        block.joint.under_relaxation = 1;
        block.joint.clear_load();
        const LanePairs<Number> pairs(block, bodies, true);
        const JointMotion<Number> motion = pairs.motion(bodies);
        // Evaluates twice if the joints are under-relaxed: the factor follows from their rows, and their
        // effective masses from the factor. A loop keeps the code small.
        for (bool has_factor = false;; has_factor = true) {
          block.joint.evaluate(motion, pairs.v, step, JointTime::StepStarts);
          if (has_factor) return;
          plumb::store_results(block);
          bool all = true;
          for (int i = 0; i < block.kLanes; ++i) {
            block.from[i]->under_relaxation = factor_of(data, *block.from[i]);
            all = all && block.from[i]->under_relaxation == 1;
          }
          if (all) return;
          block.joint.under_relaxation = Number::of([&](int i) __attribute__((always_inline)) {
            return block.from[i]->under_relaxation;
          });
        }
      });
}

template <class Joint>
void JointBlocks<Joint>::run_stage(JointStage stage, int first, int last, const SolverBodies<Real>& of,
                                   const JointStep<Real>& settings) {
  const SolverBodies<Real> bodies = of;  // local copies: no pointer can change them
  const JointStep<Real> step = settings;
  switch (stage) {
    case JointStage::WarmStart:
      return for_each(
          first,
          last, [&]<class Number>(LanesOfJoints<Joint, Number> & block) __attribute__((always_inline)) {
            LanePairs<Number> pairs(block, bodies, false);
            block.joint.warm_start(pairs.v);
            pairs.store(block);
          });
    case JointStage::Solve:
      return for_each(
          first,
          last, [&]<class Number>(LanesOfJoints<Joint, Number> & block) __attribute__((always_inline)) {
            LanePairs<Number> pairs(block, bodies, false);
            block.joint.solve(pairs.v, step);
            pairs.store(block);
          });
    case JointStage::Relax:
      return for_each(
          first,
          last, [&]<class Number>(LanesOfJoints<Joint, Number> & block) __attribute__((always_inline)) {
            LanePairs<Number> pairs(block, bodies, true);
            block.joint.relax(pairs.motion(bodies), pairs.v, step);
            pairs.store(block);
          });
  }
}

template <class Joint>
void JointBlocks<Joint>::beyond_limits(int first, int last, SolverBody<Real>* motion, Real slack, Visit visit,
                                       const void* data) {
  for_each(
      first, last, [&]<class Number>(LanesOfJoints<Joint, Number> & block) __attribute__((always_inline)) {
        if constexpr (requires { block.joint.angular.rule; }) {
          const LaneBodies<Number> a(motion, block.offset_a, block.inverse_mass_a, block.inverse_inertia_a,
                                     true);
          const LaneBodies<Number> b(motion, block.offset_b, block.inverse_mass_b, block.inverse_inertia_b,
                                     true);
          const Number beyond = block.joint.limit_opening(b.delta_angle - a.delta_angle, slack);
          if (!any(beyond < Number(0))) return;
          for (int i = 0; i < block.kLanes; ++i)
            if (i == 0 || block.from[i] != block.from[i - 1]) visit(data, *block.from[i]);
        }
      });
}

template <class Joint>
void JointBlocks<Joint>::open(int first, int last, Real tolerance, Visit visit, const void* data) {
  for_each(
      first, last, [&]<class Number>(LanesOfJoints<Joint, Number> & block) __attribute__((always_inline)) {
        const Number opening = joint_opening(
            block.joint,
            {block.inverse_mass_a, block.inverse_inertia_a, block.inverse_mass_b, block.inverse_inertia_b},
            tolerance);
        if (!any(opening > Number(0))) return;
        Real value[Number::kLanes];
        opening.store(value);
        for (int i = 0; i < block.kLanes; ++i)
          if (value[i] > 0) visit(data, *block.from[i]);
      });
}

template <class Joint>
void JointBlocks<Joint>::store_results(int first, int last) {
  for_each(
      first, last, [&]<class Number>(LanesOfJoints<Joint, Number> & block) __attribute__((always_inline)) {
        plumb::store_results(block);
      });
}

template <class Joint>
void JointBlocks<Joint>::end_step(int first, int last, const SolverBodies<Real>& bodies) {
  for_each(
      first, last, [&]<class Number>(LanesOfJoints<Joint, Number> & block) __attribute__((always_inline)) {
        for (int i = 0; i < block.kLanes; ++i) block.from[i]->end_step(bodies);
      });
}

#define PLUMB_FOR(Real)                                             \
  template class JointBlocks<JointConstraint<Real, HingeRows>>;     \
  template class JointBlocks<JointConstraint<Real, DistanceRows>>;  \
  template class JointBlocks<JointConstraint<Real, RevoluteRows>>;  \
  template class JointBlocks<JointConstraint<Real, PrismaticRows>>; \
  template class JointBlocks<JointConstraint<Real, WeldRows>>;      \
  template class JointBlocks<JointConstraint<Real, WheelRows>>;
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
