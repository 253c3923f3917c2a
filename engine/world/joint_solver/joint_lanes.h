#pragma once

#include <algorithm>
#include <vector>

#include "engine/math/vector_width.h"
#include "engine/math/widest_register.h"
#include "engine/world/contact_solver/lane_bodies.h"
#include "engine/world/joint_solver/joint_lists.h"

namespace plumb {

/// A block of joints, one per lane, for the time of a step: joints of one colour, form and kind. It has the
/// same type as a single joint, with Lanes as numbers. Unused lanes repeat the last joint: they get the same
/// results, which are stored twice.
template <class Joint, class Number>
struct JointLanes;
template <class Real, class Number, template <class> class Kind>
struct JointLanes<JointConstraint<Real, Kind>, Number> {
  using Type = JointConstraint<Number, Kind>;
};
template <class Joint, class Number>
struct LanesOfJoints {
  static constexpr int kLanes = Number::kLanes;

  std::uint32_t offset_a[kLanes], offset_b[kLanes];  ///< see kOffsetUnits
  Number inverse_mass_a, inverse_inertia_a, inverse_mass_b, inverse_inertia_b;
  bool dynamic_a, dynamic_b;  ///< impulses change the velocities of the bodies a, b
  Joint* from[kLanes];
  typename JointLanes<Joint, Number>::Type joint;
};

/// Registers used for joints side by side, by precision, on this target. A narrow register holds two doubles:
/// moving them costs more than the block saves.
template <class Real>
inline constexpr bool kNarrowLanes = kWidestRegister >= 16 && sizeof(Real) == 4;
template <class Real>
inline constexpr bool kWideLanes = kWidestRegister >= 32;

/// The passes over joints: apply the last impulses; solve with a bias; evaluate and solve without.
enum class JointStage { WarmStart, Solve, Relax };

/// Numbers of single joints and of blocks.
struct JointCounts {
  int blocks = 0, singles = 0;
};

/// The blocks of joints of one form. Between steps only the memory is kept.
template <class Joint>
class JointBlocks {
 public:
  using Real = Scalar<decltype(Joint::under_relaxation)>;

  JointBlocks() = default;
  JointBlocks(const JointBlocks&) {}
  JointBlocks& operator=(const JointBlocks&) { return *this; }

  /// Begins a step with no joints.
  void begin(VectorWidth width);
  /// Sorts joints of a colour, whose step has begun, into blocks and single joints. Joints stay single if
  /// there are few of their kind, or if they are marked in `excluded` (by slot) because other code reads or
  /// changes them until `finish`.
  void sort(std::vector<Joint>& joints, const SolverBody<Real>* motion, const std::vector<char>& excluded);
  /// Returns how many there are now.
  JointCounts counts() const { return {count_, static_cast<int>(singles_.size())}; }
  Joint& single(int place) const { return *singles_[place]; }
  /// Returns the addresses of its single joints, from index `place` on.
  Joint* const* singles_from(int place) const { return singles_.data() + place; }

  /// Fills blocks and evaluates their joints. `factor_of(joint)` returns the under-relaxation factor of an
  /// evaluated joint.
  template <class Factor>
  void prepare(int first, int last, const SolverBodies<Real>& bodies, const JointStep<Real>& step,
               const Factor& factor_of) {
    const auto call = [](const void* it, const Joint& joint) {
      return (*static_cast<const Factor*>(it))(joint);
    };
    prepare(first, last, bodies, step, call, &factor_of);
  }
  void run_stage(JointStage stage, int first, int last, const SolverBodies<Real>& bodies,
                 const JointStep<Real>& step);
  /// Calls `act(joint)` for each joint of a block in which some joint is rotated beyond a limit by more than
  /// `slack`.
  template <class Act>
  void beyond_limits(int first, int last, SolverBody<Real>* motion, Real slack, const Act& act) {
    const auto call = [](const void* it, Joint& joint) { (*static_cast<const Act*>(it))(joint); };
    beyond_limits(first, last, motion, slack, call, &act);
  }
  /// Calls `act(joint)` for the joints of blocks that are open (joint_opening.h); some are visited twice.
  template <class Act>
  void open(int first, int last, Real tolerance, const Act& act) {
    const auto call = [](const void* it, Joint& joint) { (*static_cast<const Act*>(it))(joint); };
    open(first, last, tolerance, call, &act);
  }
  /// Writes the results back to the joints.
  void store_results(int first, int last);
  void end_step(int first, int last, const SolverBodies<Real>& bodies);

 private:
  static constexpr bool kNarrow = kNarrowLanes<Real>, kWide = kWideLanes<Real>;
  /// As many numbers as a register of `kBytes` holds, but at least four (two registers if necessary): records
  /// of bodies are loaded four numbers at a time.
  template <int kBytes>
  using Number = Lanes<Real, std::max(4, static_cast<int>(kBytes / sizeof(Real))), kBytes>;
  template <int kBytes>
  using Block = LanesOfJoints<Joint, Number<kBytes>>;
  using FactorOf = Real (*)(const void*, const Joint&);
  using Visit = void (*)(const void*, Joint&);

  /// Sorts joints into blocks of `kBytes`; the rest of a kind into narrow blocks if it fits into one.
  template <int kBytes>
  void sort_into(std::vector<Joint>& joints, const SolverBody<Real>* motion,
                 const std::vector<char>& excluded);
  template <int kBytes>
  void add_block(std::vector<Block<kBytes>>& blocks, int place, Joint* const* joints, int count,
                 std::uint64_t kind);
  void prepare(int first, int last, const SolverBodies<Real>& bodies, const JointStep<Real>& step,
               FactorOf factor_of, const void* data);
  void beyond_limits(int first, int last, SolverBody<Real>* motion, Real slack, Visit visit,
                     const void* data);
  void open(int first, int last, Real tolerance, Visit visit, const void* data);
  /// Calls `run(block)` for the blocks from first to last, compiled for their registers.
  template <class Run>
  void for_each(int first, int last, const Run& run);

  VectorWidth width_ = VectorWidth::None;
  int count_ = 0, narrow_ = 0;  ///< number of blocks; of these, blocks of 16 bytes
  std::vector<Joint*> singles_;
  std::vector<int> places_;  ///< by block: i >= 0 for blocks32_[i], -1 - i for blocks16_[i]
  std::vector<Block<16>> blocks16_;
  std::vector<Block<32>> blocks32_;
};

}  // namespace plumb
