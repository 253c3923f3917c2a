#include "engine/world/joint_solver/hinge_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/trigonometry.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/joint_solver/hinge_tree_energy.h"

namespace plumb {
namespace {

// Maximum rotation of a body in a substep, rad, by its spin or as a pendulum. The energy error is about an
// eighth of its square.
constexpr double kMaxRotation = 0.125;
constexpr int kMaxSubdivisions = 64;
// Tolerance of closing hinges, as a fraction of the arms, and the maximum number of Newton steps for it.
constexpr double kGapTolerance = 1e-11;
constexpr int kMaxNewtonSteps = 16;
// Gap, as a fraction of the arms, above which the Newton steps have failed. Where they converge, they leave
// less than a thousandth of it; where they fail, more than a hundred times as much.
constexpr double kFailedGap = 1e-6;
// Maximum closing speed of a gap that existed before, in arms per second. A scene that starts with its joints
// open is pulled together without a burst.
constexpr double kGapSpeed = 4;
// Ratio of required to current inertia above which a link's inertia is raised within a substep.
constexpr double kMinInertiaRatio = 1.01;
// Growth of the gap in a Newton step above which the iteration diverges.
constexpr double kDivergence = 2;

// ---- Motion

// Returns the velocity after a fraction of a substep, a power of two up to 1, in which forces and damping
// make v to factor v + increment. A half does half of both: factor^(1/2) and increment / (1 + factor^(1/2)),
// which applied twice give the whole.
template <class Value>
Value after_forces(Value velocity, Value increment, double factor, double fraction) {
  if (factor == 1) return velocity + fraction * increment;
  for (; fraction < 1; fraction *= 2) factor = std::sqrt(factor), increment *= 1 / (1 + factor);
  return factor * velocity + increment;
}

// Applies a fraction of the forces and the damping of a substep.
void apply_forces(std::span<ArticulatedLink> tree, double fraction) {
  if (fraction == 0) return;
  for (ArticulatedLink& link : tree) {
    if (!link.is_dynamic) continue;
    link.velocity = after_forces(link.velocity, link.velocity_increment, link.damping_factor, fraction);
    link.spin = after_forces(link.spin, link.spin_increment, link.spin_damping_factor, fraction);
  }
}

// Computes sine and cosine - 1 of a rotation.
void set_rotation(ArticulatedLink& link, double x) {
  if (std::abs(x) > kMaxRotation) {
    const Rotation<double> rotation = rotation_of(x);
    link.sine = rotation.s, link.cosine_minus_one = rotation.c - 1;
    return;
  }
  const double y = x * x;
  link.sine = x * (1 - y / 6 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72))));
  link.cosine_minus_one = -0.5 * y * (1 - y / 12 * (1 - y / 30 * (1 - y / 56)));
}

Vec2d arm_displacement(const ArticulatedLink& link, Vec2d arm) {
  return link.cosine_minus_one * arm + link.sine * perpendicular(arm);
}

// Predicts the hinges' gaps after h. Returns the square of the largest deviation from the target gap, as a
// fraction of the arms.
double predict_gaps(std::span<ArticulatedLink> tree, double h) {
  double max_gap = 0;
  set_rotation(tree[0], h * tree[0].spin);
  for (std::size_t i = 1; i < tree.size(); ++i) {
    ArticulatedLink& link = tree[i];
    const ArticulatedLink& parent = tree[link.parent];
    set_rotation(link, h * link.spin);
    link.predicted_gap = link.gap + h * (link.velocity - parent.velocity) +
                         (arm_displacement(link, link.arm) - arm_displacement(parent, link.parent_arm));
    const double error = length_squared(link.target_gap - link.predicted_gap) / link.arm_scale_squared;
    // Also true for NaN, for which no gap counts as closed.
    if (!(error <= max_gap)) max_gap = error;
  }
  return max_gap;
}

void update_arms(std::span<ArticulatedLink> tree) {
  for (ArticulatedLink& link : tree) {
    if (link.joint < 0) continue;
    const ArticulatedLink& parent = tree[link.parent];
    link.arm = link.rotation * link.anchor;
    link.parent_arm = parent.rotation * link.parent_anchor;
    const Vec2d half = 0.5 * link.gap;
    link.lever = link.arm - half;
    link.parent_lever = link.parent_arm + half;
    link.from_parent = link.parent_lever - parent.lever;
  }
}

void integrate_positions(std::span<ArticulatedLink> tree, double h) {
  for (ArticulatedLink& link : tree) {
    link.delta_position += h * link.velocity;
    link.delta_angle += h * link.spin;
    const Rotation<double> q = link.rotation;
    link.rotation = {q.c + (link.cosine_minus_one * q.c - link.sine * q.s),
                     q.s + (link.cosine_minus_one * q.s + link.sine * q.c)};
    link.gap = link.predicted_gap;
  }
  update_arms(tree);
}

// ---- The system

// Computes articulated inertias from the ends to the root: M of a link at its hinge, with the spin left free,
//     mass = M_vv - M_vw M_vw^T / M_ww.
// Raises the inertia of links to the required one; returns true if any is raised.
bool compute_articulated_inertia(std::span<ArticulatedLink> tree) {
  bool loaded = false;
  for (ArticulatedLink& link : tree) {
    const double m = link.is_dynamic ? 1 / link.inverse_mass : 0;
    link.mass = {m, 0, m};
    link.coupling = -m * perpendicular(link.lever);
    link.inertia = 1 / link.inverse_inertia;  // infinite if it does not rotate
    link.added_fraction = 0;
    if (link.required_inertia > link.inertia) {
      link.added_fraction = 1 - link.inertia / link.required_inertia;
      link.inertia = link.required_inertia;
      loaded = true;
    }
    link.hinge_inertia = link.inertia + m * length_squared(link.lever);
  }
  for (std::size_t i = tree.size(); i-- > 0;) {
    ArticulatedLink& link = tree[i];
    if (!link.is_dynamic) break;
    // The whole subtree rotates about a fixed hinge, so the added fraction of that inertia is smaller.
    if (!tree[link.parent].is_dynamic) link.added_fraction *= link.inertia / link.hinge_inertia;
    link.hinge_inertia = link.inverse_inertia > 0 ? 1 / link.hinge_inertia : 0;
    const Vec2d c = link.coupling, scaled = link.hinge_inertia * c;
    link.mass = {link.mass.xx - scaled.x * c.x, link.mass.xy - scaled.x * c.y, link.mass.yy - scaled.y * c.y};
    if (i == 0) break;
    ArticulatedLink& parent = tree[link.parent];
    const Vec2d p = perpendicular(link.from_parent), momentum = link.mass.times(p);
    parent.mass = {parent.mass.xx + link.mass.xx, parent.mass.xy + link.mass.xy,
                   parent.mass.yy + link.mass.yy};
    parent.coupling += momentum;
    parent.hinge_inertia += dot(p, momentum);
  }
  return loaded;
}

// Returns the velocity change of a free root.
Vec2d free_root_change(const ArticulatedLink& root, Vec2d impulse) {
  const ArticulatedMass& m = root.mass;
  const double inverse = 1 / (m.xx * m.yy - m.xy * m.xy);
  return -inverse * Vec2d{m.yy * impulse.x - m.xy * impulse.y, m.xx * impulse.y - m.xy * impulse.x};
}

// Solves for the impulses that change the hinge velocities by `target_rate`, and applies them.
void solve(std::span<ArticulatedLink> tree) {
  for (ArticulatedLink& link : tree) link.bias_impulse = {}, link.angular_bias_impulse = 0;
  for (std::size_t i = tree.size(); i-- > 1;) {
    ArticulatedLink& link = tree[i];
    link.bias_impulse -= (link.angular_bias_impulse * link.hinge_inertia) * link.coupling;
    const Vec2d impulse = link.mass.times(link.target_rate) + link.bias_impulse;
    ArticulatedLink& parent = tree[link.parent];
    parent.bias_impulse += impulse;
    parent.angular_bias_impulse += dot(perpendicular(link.from_parent), impulse);
  }
  ArticulatedLink& root = tree[0];
  root.hinge_change = {}, root.spin_change = 0;
  if (root.is_dynamic) {
    root.hinge_change = free_root_change(
        root, root.bias_impulse - (root.angular_bias_impulse * root.hinge_inertia) * root.coupling);
    root.spin_change =
        -root.hinge_inertia * (root.angular_bias_impulse + dot(root.coupling, root.hinge_change));
    root.velocity += root.hinge_change;
    root.spin += root.spin_change;
  }
  for (std::size_t i = 1; i < tree.size(); ++i) {
    ArticulatedLink& link = tree[i];
    const ArticulatedLink& parent = tree[link.parent];
    link.hinge_change = parent.hinge_change + cross(parent.spin_change, link.from_parent) + link.target_rate;
    link.spin_change =
        -link.hinge_inertia * (link.angular_bias_impulse + dot(link.coupling, link.hinge_change));
    link.impulse_change = link.mass.times(link.hinge_change) + link.bias_impulse;
    link.accumulated_impulse += link.impulse_change;
    link.velocity += link.hinge_change - cross(link.spin_change, link.lever);
    link.spin += link.spin_change;
  }
}

// Undoes the last `solve`.
void undo(std::span<ArticulatedLink> tree) {
  for (ArticulatedLink& link : tree) {
    link.accumulated_impulse -= link.impulse_change;
    link.velocity -= link.hinge_change - cross(link.spin_change, link.lever);
    link.spin -= link.spin_change;
  }
}

// ---- Loads. A substep h follows the geometric stiffness k of a load if the inertia is at least h^2 k.

// Computes the inertia that each link requires for the impulses of a fraction of a substep. Returns true if
// any link has less.
bool find_required_inertias(std::span<ArticulatedLink> tree, double h, double fraction,
                            Vec2d ArticulatedLink::*impulse) {
  for (ArticulatedLink& link : tree) link.required_inertia = 0;
  if (!enabled(Switch::LinkInertia)) return false;
  const double scale = h / fraction;
  bool inertia_raised = false;
  for (std::size_t i = tree.size(); i-- > 0;) {
    ArticulatedLink& link = tree[i];
    if (i > 0) {
      const Vec2d by = scale * link.*impulse;
      tree[link.parent].required_inertia -= dot(link.parent_lever, by);
      link.required_inertia += dot(link.lever, by);
    }
    inertia_raised =
        inertia_raised || (link.is_dynamic && link.required_inertia > kMinInertiaRatio * link.inertia);
  }
  return inertia_raised;
}

// Damps relative rotation of two bodies, by the fraction of their inertia that loads added.
void damp(std::span<ArticulatedLink> tree) {
  for (std::size_t i = 1; i < tree.size(); ++i) {
    ArticulatedLink &link = tree[i], &parent = tree[link.parent];
    if (!parent.is_dynamic || link.inverse_inertia == 0 || parent.inverse_inertia == 0) continue;
    const double a = 1 / parent.inertia, b = 1 / link.inertia;
    const double twist =
        std::max(link.added_fraction, parent.added_fraction) * (link.spin - parent.spin) / (a + b);
    parent.spin += a * twist;
    link.spin -= b * twist;
  }
}

// ---- A substep

struct PositionResult {
  bool inertia_raised = false;  // the impulses raised the inertia of links
  bool closed = false;
};

// Solves for velocities that close the hinges at the end of the motion (RATTLE's position stage). `fraction`
// of the motion's forces act before.
PositionResult solve_positions(std::span<ArticulatedLink> tree, double h, double fraction) {
  constexpr double kTolerance = kGapTolerance * kGapTolerance, kFailed = kFailedGap * kFailedGap;
  bool inertia_raised = false;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kMaxNewtonSteps; ++i) {
    const double gap = predict_gaps(tree, h);
    if (gap <= kTolerance || i == kMaxNewtonSteps) return {inertia_raised, gap <= kFailed};
    if (i > 0 && !(gap < before)) {
      if (gap <= kDivergence * before) return {inertia_raised, gap <= kFailed};
      undo(tree);
      predict_gaps(tree, h);
      return {inertia_raised, before <= kFailed};
    }
    for (ArticulatedLink& link : tree) link.target_rate = (1 / h) * (link.target_gap - link.predicted_gap);
    solve(tree);
    if (i == 0 && find_required_inertias(tree, h, fraction, &ArticulatedLink::accumulated_impulse)) {
      inertia_raised = true;
      undo(tree);
      compute_articulated_inertia(tree);
      solve(tree);
    }
    before = gap;
  }
  return {inertia_raised, false};
}

// Solves for velocities that keep the hinges closed (RATTLE's velocity stage).
void solve_velocities(std::span<ArticulatedLink> tree) {
  for (std::size_t i = 1; i < tree.size(); ++i) {
    ArticulatedLink& link = tree[i];
    const ArticulatedLink& parent = tree[link.parent];
    link.target_rate = (parent.velocity + cross(parent.spin, link.parent_lever)) -
                       (link.velocity + cross(link.spin, link.lever));
  }
  solve(tree);
}

// Sets the part of each gap that stays open, because it is too large to close in one substep. No warm start:
// when a light link under a heavy load has rotated a little, the old impulse would spin it up.
void set_target_gaps(std::span<ArticulatedLink> tree, double h) {
  for (std::size_t i = 1; i < tree.size(); ++i) {
    ArticulatedLink& link = tree[i];
    link.accumulated_impulse = {}, link.target_gap = {};
    const double gap = length_squared(link.gap), most = kGapSpeed * h;
    if (gap > most * most * link.arm_scale_squared)
      link.target_gap = (1 - most * std::sqrt(link.arm_scale_squared / gap)) * link.gap;
  }
}

// Returns the number of parts that a substep is divided into: a power of two.
int subdivisions_of(std::span<const ArticulatedLink> tree, double h) {
  double max_rate_squared = 0;  // rad/s, squared
  for (const ArticulatedLink& link : tree) {
    if (!link.is_dynamic || link.radius_squared == 0) continue;
    const double swing = std::sqrt(link.radius_squared * length_squared(link.velocity_increment)) /
                         (h * (link.radius_squared + link.inverse_mass / link.inverse_inertia));
    max_rate_squared = std::max({max_rate_squared, link.spin * link.spin, swing});
  }
  const double rotation = h * std::sqrt(max_rate_squared);
  int subdivisions = 1;
  while (subdivisions < kMaxSubdivisions && rotation > subdivisions * kMaxRotation) subdivisions *= 2;
  return subdivisions;
}

// Integrates a tree through a step.
class TreeIntegrator {
 public:
  TreeIntegrator(std::span<ArticulatedLink> tree, double h)
      : tree_(tree),
        h_(h),
        frame_(base_velocity(tree)),
        energy_limit_(kinetic_energy(tree, frame_)),
        driven_(!tree[0].is_dynamic && (tree[0].velocity != Vec2d{} || tree[0].spin != 0)) {
    double max_gap = 0, momentum = 0;
    for (const ArticulatedLink& link : tree) {
      max_gap = std::max(max_gap, length_squared(link.gap));
      momentum += mass_of(link) * std::sqrt(length_squared(link.velocity_increment));
      energy_tolerance_ += 0.5 * (mass_of(link) * length_squared(link.velocity_increment) +
                                  inertia_of(link) * link.spin_increment * link.spin_increment);
    }
    // Closing an open hinge may lift bodies.
    energy_tolerance_ += momentum / h * std::sqrt(max_gap);
  }

  // Integrates a fraction of a substep, a power of two. Integrates its halves instead if the hinges cannot be
  // closed at its end, because light links would have to rotate too far, or if that would need more energy
  // than the tree has. Skips the smallest part if it would need more energy.
  void advance(double fraction) {
    for (ArticulatedLink& link : tree_) link.velocity_before = link.velocity, link.spin_before = link.spin;
    const double force_fraction = velocity_lag_ + 0.5 * fraction, t = fraction * h_;
    find_required_inertias(tree_, t, 1 / fraction, &ArticulatedLink::impulse);
    bool loaded = compute_articulated_inertia(tree_);
    velocity_lag_ == 0.5 * fraction
        ? apply_forces(tree_, fraction)
        : (apply_forces(tree_, velocity_lag_), apply_forces(tree_, 0.5 * fraction));
    set_target_gaps(tree_, t);
    const PositionResult result = solve_positions(tree_, t, force_fraction / fraction);
    const double work = fraction * work_of(tree_, frame_);
    const bool lacks_energy = !driven_ && energy_limit_ + work < -energy_tolerance_,
               last = fraction * kMaxSubdivisions <= 1;
    if (lacks_energy || (!result.closed && !last)) {
      for (ArticulatedLink& link : tree_) link.velocity = link.velocity_before, link.spin = link.spin_before;
      synchronise_velocities();
      if (!last) advance(0.5 * fraction), advance(0.5 * fraction);
      return;
    }
    loaded = loaded || result.inertia_raised;
    integrate_positions(tree_, t);
    energy_unchecked_ = energy_unchecked_ || loaded, inertia_raised_ = loaded;
    for (ArticulatedLink& link : tree_) {
      link.impulse = (1 / force_fraction) * link.accumulated_impulse;
      link.step_impulse += link.accumulated_impulse;
    }
    // A rotating base does work on the tree.
    energy_limit_ += work + fraction * dot(tree_[1].impulse, base_velocity(tree_) - frame_);
    velocity_lag_ = 0.5 * fraction;
    if (loaded) synchronise_velocities();
  }

  // Advances the velocities to the time of the poses.
  void synchronise_velocities() {
    if (velocity_lag_ == 0) return;
    apply_forces(tree_, velocity_lag_);
    compute_articulated_inertia(tree_);
    if (inertia_raised_) damp(tree_);
    for (ArticulatedLink& link : tree_) link.accumulated_impulse = {};
    solve_velocities(tree_);
    if (energy_unchecked_ && enabled(Switch::TreeEnergy))
      limit_energy(tree_, frame_, energy_limit_), energy_limit_ = kinetic_energy(tree_, frame_);
    // Half of the impulse acts before the motion, half after.
    for (ArticulatedLink& link : tree_) {
      link.impulse = 0.5 * link.impulse + (0.5 / velocity_lag_) * link.accumulated_impulse;
      link.step_impulse += link.accumulated_impulse;
    }
    velocity_lag_ = 0, energy_unchecked_ = inertia_raised_ = false;
  }

 private:
  const std::span<ArticulatedLink> tree_;
  const double h_;       // s, a substep
  const Vec2d frame_;    // m/s, in which energy is measured
  double energy_limit_;  // J, initial energy plus the work of forces
  const bool driven_;    // its base moves, and may do work on it
  // J, error of the limit: the energy that forces give to a body at rest in a substep.
  double energy_tolerance_ = 0;
  double velocity_lag_ = 0;        // fraction of a substep by which the velocities lag behind
  bool inertia_raised_ = false;    // in the last motion
  bool energy_unchecked_ = false;  // inertia was raised since the last check
};

}  // namespace

void integrate_tree(std::span<ArticulatedLink> tree, double h, int substeps) {
  const int subdivisions = subdivisions_of(tree, h);
  const double fraction = 1.0 / subdivisions;
  for (ArticulatedLink& link : tree) link.delta_position = {}, link.delta_angle = 0, link.step_impulse = {};
  update_arms(tree);
  TreeIntegrator integrator(tree, h);
  for (int left = subdivisions * substeps; left > 0; --left) integrator.advance(fraction);
  integrator.synchronise_velocities();
}

}  // namespace plumb
