// g++ would pack pairs of these numbers into vectors, with more shuffles than that saves.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("no-tree-slp-vectorize")
#endif

#include "engine/world/joint_solver/hinge_sweeps.h"

#include <cstddef>
#include <limits>
#include <type_traits>

#include "engine/math/four.h"

namespace plumb {
namespace {

/// Returns a pointer to the numbers of a record, from the byte `offset` on.
template <class Real, class Record>
[[gnu::always_inline]] inline Real* numbers(Record* record, std::size_t offset) {
  using Byte = std::conditional_t<std::is_const_v<Record>, const char, char>;
  return reinterpret_cast<Real*>(reinterpret_cast<Byte*>(record) + offset);
}

/// The bodies a, or the bodies b, of four joints.
template <class Real>
struct FourBodies {
  static constexpr std::size_t kRow = 4 * sizeof(Real);
  BodyMotion<Real>* motion[4];
  BodyMotion<Four<Real>> now;

  [[gnu::always_inline]] FourBodies(const SolverBodies<Real>& bodies, const int (&body)[4])
      : motion{bodies.motion + body[0], bodies.motion + body[1], bodies.motion + body[2],
               bodies.motion + body[3]} {
    static_assert(sizeof(BodyMotion<Real>) == 2 * kRow && offsetof(BodyMotion<Real>, velocity) == 0);
    Four<Real> first[4], last[4];
    load_rows({row(0, 0), row(1, 0), row(2, 0), row(3, 0)}, first);
    load_rows({row(0, kRow), row(1, kRow), row(2, kRow), row(3, kRow)}, last);
    now.velocity = {first[0], first[1]}, now.angular_velocity = first[2];
    now.moved = {first[3], last[0]}, now.turned = last[1];
    now.inverse_mass = last[2], now.inverse_inertia = last[3];
  }

  /// Writes new velocities.
  [[gnu::always_inline]] void store(const Vec2<Four<Real>>& velocity, const Four<Real>& spin) const {
    const Four<Real> columns[4] = {velocity.x, velocity.y, spin, now.moved.x};
    Four<Real> rows[4];
    transpose(columns, rows);
    for (int k = 0; k < 4; ++k) rows[k].store_aligned(row(k, 0));
  }

 private:
  [[gnu::always_inline]] Real* row(int k, std::size_t offset) const {
    return numbers<Real>(motion[k], offset);
  }
};

/// Four joints and their bodies. Numbers are loaded in rows of four, from the first of each row.
template <class Real>
struct FourHinges {
  using Number = Four<Real>;
  using Hinge = HingeConstraint<Real>;
  static constexpr std::size_t kAnchors = offsetof(Hinge, anchor_a), kPull = offsetof(Hinge, impulse),
                               kArms = offsetof(Hinge, arm_a), kMass = offsetof(Hinge, mass),
                               kOffset = offsetof(Hinge, offset), kHalf = 2 * sizeof(Real);
  static_assert(offsetof(Hinge, anchor_b) == kAnchors + kHalf && offsetof(Hinge, gap) == kPull + kHalf);
  static_assert(offsetof(Hinge, arm_b) == kArms + kHalf &&
                offsetof(Hinge, share) == kMass + 3 * sizeof(Real));

  Hinge* hinge;
  FourBodies<Real> a, b;
  JointVelocities<Number> v;

  [[gnu::always_inline]] FourHinges(HingeConstraint<Real>* four, const SolverBodies<Real>& bodies)
      : hinge(four),
        a(bodies, {four[0].a, four[1].a, four[2].a, four[3].a}),
        b(bodies, {four[0].b, four[1].b, four[2].b, four[3].b}),
        v(a.now, b.now) {}

  [[gnu::always_inline]] void load(std::size_t row, Number (&out)[4]) const {
    load_rows({numbers<Real>(hinge, row), numbers<Real>(hinge + 1, row), numbers<Real>(hinge + 2, row),
               numbers<Real>(hinge + 3, row)},
              out);
  }
  [[gnu::always_inline]] void store(std::size_t row, const Number (&in)[4]) const {
    Number rows[4];
    transpose(in, rows);
    for (int k = 0; k < 4; ++k) rows[k].store_aligned(numbers<Real>(hinge + k, row));
  }
  [[gnu::always_inline]] void store_velocities() const {
    a.store(v.v_a, v.w_a);
    b.store(v.v_b, v.w_b);
  }
};

template <class Real>
[[gnu::always_inline]] inline bool warm_start(HingeConstraint<Real>* hinge,
                                              const SolverBodies<Real>& bodies) {
  using Number = Four<Real>;
  FourHinges<Real> four(hinge, bodies);
  Number impulse[4], arm[4];
  four.load(four.kPull, impulse);
  four.load(four.kArms, arm);
  four.v.apply(Vec2<Number>{impulse[0], impulse[1]}, {arm[0], arm[1]}, {arm[2], arm[3]});
  four.store_velocities();
  return true;
}

template <class Real>
[[gnu::always_inline]] inline bool solve(HingeConstraint<Real>* hinge, const SolverBodies<Real>& bodies,
                                         const Softness<Real>& soft) {
  using Number = Four<Real>;
  FourHinges<Real> four(hinge, bodies);
  Number pull[4], arm[4], mass[4];  // impulse and gap; arms a and b; mass and share
  four.load(four.kPull, pull);
  four.load(four.kArms, arm);
  four.load(four.kMass, mass);
  const Vec2<Number> arm_a{arm[0], arm[1]}, arm_b{arm[2], arm[3]}, impulse{pull[0], pull[1]};
  const Vec2<Number> delta = soft_impulse<Number>({mass[0], mass[1], mass[2]}, four.v.at(arm_a, arm_b),
                                                  {pull[2], pull[3]}, impulse, mass[3], soft);
  const Vec2<Number> sum = impulse + delta;
  four.store(four.kPull, {sum.x, sum.y, pull[2], pull[3]});
  four.v.apply(delta, arm_a, arm_b);
  four.store_velocities();
  return true;
}

template <class Real>
[[gnu::always_inline]] inline bool relax(HingeConstraint<Real>* hinge, const SolverBodies<Real>& bodies) {
  using Number = Four<Real>;
  FourHinges<Real> four(hinge, bodies);
  const auto turned = [&](const int(&body)[4], const Number& x, const Number& y) {
    Number q[2];
    const auto pair = [&](int k) { return numbers<const Real>(bodies.rotation + body[k], 0); };
    load_pairs({pair(0), pair(1), pair(2), pair(3)}, q);
    return Rotation<Number>{q[0], q[1]} * Vec2<Number>{x, y};
  };
  Number anchor[4], offset[4], pull[4], mass[4];
  four.load(four.kAnchors, anchor);
  const Vec2<Number> to_a = turned({hinge[0].a, hinge[1].a, hinge[2].a, hinge[3].a}, anchor[0], anchor[1]);
  const Vec2<Number> to_b = turned({hinge[0].b, hinge[1].b, hinge[2].b, hinge[3].b}, anchor[2], anchor[3]);
  four.load(four.kOffset, offset);  // and the field after it
  const HingeArms<Number> arms =
      hinge_arms<Number>({offset[0], offset[1]}, four.a.now.moved, four.b.now.moved, to_a, to_b);
  const PointResponse<Number> k = point_response(four.v, arms.a, arms.b);
  const Number trace = k.xx + k.yy;
  if (!all_greater(k.determinant, Number(std::numeric_limits<Real>::epsilon()) * (trace * trace)))
    return false;
  four.load(four.kMass, mass);
  const Number inverse = mass[3] / k.determinant;
  const Symmetric2<Number> m{inverse * k.yy, -inverse * k.xy, inverse * k.xx};
  four.store(four.kMass, {m.xx, m.xy, m.yy, mass[3]});
  four.store(four.kArms, {arms.a.x, arms.a.y, arms.b.x, arms.b.y});
  const Vec2<Number> delta = -(m * four.v.at(arms.a, arms.b));
  four.load(four.kPull, pull);
  four.store(four.kPull, {pull[0] + delta.x, pull[1] + delta.y, arms.gap.x, arms.gap.y});
  four.v.apply(delta, arms.a, arms.b);
  four.store_velocities();
  return true;
}

/// Single precision only: a register holds two doubles, and moving them there costs more than it saves. The
/// remainder comes first: loading data that was just stored in pieces would stall.
template <class Real, class Each, class FourAtOnce>
[[gnu::always_inline]] inline void sweep(HingeRun<Real> run, Each&& each, FourAtOnce&& four_at_once) {
  HingeConstraint<Real>* hinge = run.first;
  HingeConstraint<Real>* const end = hinge + run.count;
  if constexpr (std::is_same_v<Real, float>) {
    HingeConstraint<Real>* const fours = run.apart ? hinge + run.count % 4 : end;
    for (; hinge != fours; ++hinge) each(*hinge);
    for (; hinge != end; hinge += 4) {
      if (hinge[0].alone | hinge[1].alone | hinge[2].alone | hinge[3].alone || !four_at_once(hinge))
        for (int k = 0; k < 4; ++k) each(hinge[k]);
    }
  }
  for (; hinge != end; ++hinge) each(*hinge);
}

}  // namespace

template <class Real>
void warm_start_hinges(HingeRun<Real> run, const SolverBodies<Real>& bodies) {
  sweep(
      run, [&](const auto& hinge) { hinge.warm_start(bodies); },
      [&](auto* four) { return warm_start(four, bodies); });
}

template <class Real>
void solve_hinges(HingeRun<Real> run, const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
  sweep(
      run, [&](auto& hinge) { hinge.solve(bodies, step); },
      [&](auto* four) { return solve(four, bodies, step.softness); });
}

template <class Real>
void relax_hinges(HingeRun<Real> run, const SolverBodies<Real>& bodies, const JointStep<Real>& step) {
  sweep(
      run, [&](auto& hinge) { hinge.relax(bodies, step); }, [&](auto* four) { return relax(four, bodies); });
}

#define PLUMB_FOR(Real)                                                                          \
  template void warm_start_hinges(HingeRun<Real>, const SolverBodies<Real>&);                    \
  template void solve_hinges(HingeRun<Real>, const SolverBodies<Real>&, const JointStep<Real>&); \
  template void relax_hinges(HingeRun<Real>, const SolverBodies<Real>&, const JointStep<Real>&);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
