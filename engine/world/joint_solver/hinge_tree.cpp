#include "engine/world/joint_solver/hinge_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/trigonometry.h"
#include "engine/world/joint_solver/hinge_tree_energy.h"

namespace plumb {
namespace {

// Maximum rotation of a body in a substep, rad, by its spin or as a pendulum. The energy error is about an
// eighth of its square.
constexpr double kTurn = 0.125;
constexpr int kMostParts = 64;
// Tolerance of closing hinges, as a fraction of the arms, and the maximum number of Newton steps for it.
constexpr double kClosed = 1e-11;
constexpr int kMostNewtonSteps = 16;
// Gap, as a fraction of the arms, above which the Newton steps have failed. Where they converge, they leave
// less than a thousandth of it; where they fail, more than a hundred times as much.
constexpr double kOpen = 1e-6;
// Maximum closing speed of a gap that existed before, in arms per second. A scene that starts with its joints
// open is pulled together without a burst.
constexpr double kGapSpeed = 4;
// Ratio of demanded to current inertia above which a link's inertia is raised within a substep.
constexpr double kHeavier = 1.01;
// Growth of the gap in a Newton step above which the iteration diverges.
constexpr double kDiverges = 2;

// ---- Motion

// Returns `keep` to the power of `share`, a power of two up to 1.
double kept(double keep, double share) {
  for (; share < 1 && keep != 1; share *= 2) keep = std::sqrt(keep);
  return keep;
}

// Applies a share of the forces and the damping of a substep.
void kick(std::span<TreeLink> tree, double share) {
  if (share == 0) return;
  for (TreeLink& link : tree) {
    if (!link.moves) continue;
    link.velocity += share * link.kick;
    link.spin += share * link.spin_kick;
    link.velocity *= kept(link.keep, share);
    link.spin *= kept(link.keep_spin, share);
  }
}

// Computes sine and cosine - 1 of a rotation.
void find_turn(TreeLink& link, double x) {
  if (std::abs(x) > kTurn) {
    const Rotation<double> turn = rotation_of(x);
    link.sine = turn.s, link.less_cosine = turn.c - 1;
    return;
  }
  const double y = x * x;
  link.sine = x * (1 - y / 6 * (1 - y / 20 * (1 - y / 42 * (1 - y / 72))));
  link.less_cosine = -0.5 * y * (1 - y / 12 * (1 - y / 30 * (1 - y / 56)));
}

Vec2d turn_of(const TreeLink& link, Vec2d arm) {
  return link.less_cosine * arm + link.sine * perpendicular(arm);
}

// Predicts the hinges' gaps after h. Returns the square of the largest deviation from the target gap, as a
// fraction of the arms.
double predict(std::span<TreeLink> tree, double h) {
  double widest = 0;
  find_turn(tree[0], h * tree[0].spin);
  for (std::size_t i = 1; i < tree.size(); ++i) {
    TreeLink& link = tree[i];
    const TreeLink& parent = tree[link.parent];
    find_turn(link, h * link.spin);
    link.next_gap = link.gap + h * (link.velocity - parent.velocity) +
                    (turn_of(link, link.arm) - turn_of(parent, link.parent_arm));
    const double share = length_squared(link.open - link.next_gap) / link.span_squared;
    // Also true for NaN: nothing is closed then.
    if (!(share <= widest)) widest = share;
  }
  return widest;
}

void place(std::span<TreeLink> tree) {
  for (TreeLink& link : tree) {
    if (link.joint < 0) continue;
    const TreeLink& parent = tree[link.parent];
    link.arm = link.rotation * link.anchor;
    link.parent_arm = parent.rotation * link.parent_anchor;
    const Vec2d half = 0.5 * link.gap;
    link.lever = link.arm - half;
    link.parent_lever = link.parent_arm + half;
    link.from_parent = link.parent_lever - parent.lever;
  }
}

void move(std::span<TreeLink> tree, double h) {
  for (TreeLink& link : tree) {
    link.moved += h * link.velocity;
    link.turned += h * link.spin;
    const Rotation<double> q = link.rotation;
    link.rotation = {q.c + (link.less_cosine * q.c - link.sine * q.s),
                     q.s + (link.less_cosine * q.s + link.sine * q.c)};
    link.gap = link.next_gap;
  }
  place(tree);
}

// ---- The system

// Computes articulated inertias from the ends to the root: M of a link at its hinge, with the spin left free,
//     mass = M_vv - M_vw M_vw^T / M_ww.
// Raises links' inertia to what loads demand; returns true if any is raised.
bool assemble(std::span<TreeLink> tree) {
  bool loaded = false;
  for (TreeLink& link : tree) {
    const double m = link.moves ? 1 / link.inverse_mass : 0;
    link.mass = {m, 0, m};
    link.coupling = -m * perpendicular(link.lever);
    link.inertia = 1 / link.inverse_inertia;  // infinite if it does not rotate
    link.excess = 0;
    if (link.demand > link.inertia) {
      link.excess = 1 - link.inertia / link.demand;
      link.inertia = link.demand;
      loaded = true;
    }
    link.turning = link.inertia + m * length_squared(link.lever);
  }
  for (std::size_t i = tree.size(); i-- > 0;) {
    TreeLink& link = tree[i];
    if (!link.moves) break;
    // About a fixed hinge the whole subtree rotates, so the load's part of that inertia is smaller.
    if (!tree[link.parent].moves) link.excess *= link.inertia / link.turning;
    link.turning = link.inverse_inertia > 0 ? 1 / link.turning : 0;
    const Vec2d c = link.coupling, share = link.turning * c;
    link.mass = {link.mass.xx - share.x * c.x, link.mass.xy - share.x * c.y, link.mass.yy - share.y * c.y};
    if (i == 0) break;
    TreeLink& parent = tree[link.parent];
    const Vec2d p = perpendicular(link.from_parent), momentum = link.mass.times(p);
    parent.mass = {parent.mass.xx + link.mass.xx, parent.mass.xy + link.mass.xy,
                   parent.mass.yy + link.mass.yy};
    parent.coupling += momentum;
    parent.turning += dot(p, momentum);
  }
  return loaded;
}

// Returns the velocity change of a free root.
Vec2d free_change(const TreeLink& root, Vec2d pull) {
  const HingeMass& m = root.mass;
  const double inverse = 1 / (m.xx * m.yy - m.xy * m.xy);
  return -inverse * Vec2d{m.yy * pull.x - m.xy * pull.y, m.xx * pull.y - m.xy * pull.x};
}

// Solves for the impulses that change the hinge velocities by `rate`, and applies them.
void solve(std::span<TreeLink> tree) {
  for (TreeLink& link : tree) link.pull = {}, link.twist = 0;
  for (std::size_t i = tree.size(); i-- > 1;) {
    TreeLink& link = tree[i];
    link.pull -= (link.twist * link.turning) * link.coupling;
    const Vec2d pull = link.mass.times(link.rate) + link.pull;
    TreeLink& parent = tree[link.parent];
    parent.pull += pull;
    parent.twist += dot(perpendicular(link.from_parent), pull);
  }
  TreeLink& root = tree[0];
  root.change = {}, root.spin_change = 0;
  if (root.moves) {
    root.change = free_change(root, root.pull - (root.twist * root.turning) * root.coupling);
    root.spin_change = -root.turning * (root.twist + dot(root.coupling, root.change));
    root.velocity += root.change;
    root.spin += root.spin_change;
  }
  for (std::size_t i = 1; i < tree.size(); ++i) {
    TreeLink& link = tree[i];
    const TreeLink& parent = tree[link.parent];
    link.change = parent.change + cross(parent.spin_change, link.from_parent) + link.rate;
    link.spin_change = -link.turning * (link.twist + dot(link.coupling, link.change));
    link.change_impulse = link.mass.times(link.change) + link.pull;
    link.found += link.change_impulse;
    link.velocity += link.change - cross(link.spin_change, link.lever);
    link.spin += link.spin_change;
  }
}

// Undoes the last `solve`.
void undo(std::span<TreeLink> tree) {
  for (TreeLink& link : tree) {
    link.found -= link.change_impulse;
    link.velocity -= link.change - cross(link.spin_change, link.lever);
    link.spin -= link.spin_change;
  }
}

// ---- Loads. h^2 k is the inertia that a substep needs to follow the stiffness k.

// Computes the inertia that the impulses of `share` of a substep demand of each link. Returns true if any
// link has less.
bool find_demands(std::span<TreeLink> tree, double h, double share, Vec2d TreeLink::*impulse) {
  for (TreeLink& link : tree) link.demand = 0;
  const double scale = h / share;
  bool heavier = false;
  for (std::size_t i = tree.size(); i-- > 0;) {
    TreeLink& link = tree[i];
    if (i > 0) {
      const Vec2d by = scale * link.*impulse;
      tree[link.parent].demand -= dot(link.parent_lever, by);
      link.demand += dot(link.lever, by);
    }
    heavier = heavier || (link.moves && link.demand > kHeavier * link.inertia);
  }
  return heavier;
}

// Damps relative rotation of two bodies, by the fraction of their inertia that loads added.
void damp(std::span<TreeLink> tree) {
  for (std::size_t i = 1; i < tree.size(); ++i) {
    TreeLink &link = tree[i], &parent = tree[link.parent];
    if (!parent.moves || link.inverse_inertia == 0 || parent.inverse_inertia == 0) continue;
    const double a = 1 / parent.inertia, b = 1 / link.inertia;
    const double twist = std::max(link.excess, parent.excess) * (link.spin - parent.spin) / (a + b);
    parent.spin += a * twist;
    link.spin -= b * twist;
  }
}

// ---- A substep

struct Held {
  bool heavier = false;  // the impulses raised the inertia of links
  bool closed = false;
};

// Solves for velocities that close the hinges at the end of the motion. `share` of the motion's forces act
// before.
Held hold(std::span<TreeLink> tree, double h, double share) {
  constexpr double kEnough = kClosed * kClosed, kFails = kOpen * kOpen;
  bool heavier = false;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kMostNewtonSteps; ++i) {
    const double gap = predict(tree, h);
    if (gap <= kEnough || i == kMostNewtonSteps) return {heavier, gap <= kFails};
    if (i > 0 && !(gap < before)) {
      if (gap <= kDiverges * before) return {heavier, gap <= kFails};
      undo(tree);
      predict(tree, h);
      return {heavier, before <= kFails};
    }
    for (TreeLink& link : tree) link.rate = (1 / h) * (link.open - link.next_gap);
    solve(tree);
    if (i == 0 && find_demands(tree, h, share, &TreeLink::found)) {
      heavier = true;
      undo(tree);
      assemble(tree);
      solve(tree);
    }
    before = gap;
  }
  return {heavier, false};
}

// Solves for velocities that keep the hinges closed.
void fit(std::span<TreeLink> tree) {
  for (std::size_t i = 1; i < tree.size(); ++i) {
    TreeLink& link = tree[i];
    const TreeLink& parent = tree[link.parent];
    link.rate = (parent.velocity + cross(parent.spin, link.parent_lever)) -
                (link.velocity + cross(link.spin, link.lever));
  }
  solve(tree);
}

// Sets the part of each gap that stays open, because it is too large to close in one substep. No warm start:
// when a light link under a heavy load has rotated a little, the old impulse would spin it up.
void begin(std::span<TreeLink> tree, double h) {
  for (std::size_t i = 1; i < tree.size(); ++i) {
    TreeLink& link = tree[i];
    link.found = {}, link.open = {};
    const double gap = length_squared(link.gap), most = kGapSpeed * h;
    if (gap > most * most * link.span_squared)
      link.open = (1 - most * std::sqrt(link.span_squared / gap)) * link.gap;
  }
}

// Returns the number of parts that a substep is divided into: a power of two.
int parts_of(std::span<const TreeLink> tree, double h) {
  double fastest = 0;  // rad/s, squared
  for (const TreeLink& link : tree) {
    if (!link.moves || link.reach_squared == 0) continue;
    const double swing = std::sqrt(link.reach_squared * length_squared(link.kick)) /
                         (h * (link.reach_squared + link.inverse_mass / link.inverse_inertia));
    fastest = std::max({fastest, link.spin * link.spin, swing});
  }
  const double turn = h * std::sqrt(fastest);
  int parts = 1;
  while (parts < kMostParts && turn > parts * kTurn) parts *= 2;
  return parts;
}

// A tree on its way through a step.
class Passage {
 public:
  Passage(std::span<TreeLink> tree, double h)
      : tree_(tree),
        h_(h),
        frame_(velocity_of_hold(tree)),
        most_(energy_of(tree, frame_)),
        driven_(!tree[0].moves && (tree[0].velocity != Vec2d{} || tree[0].spin != 0)) {
    double widest = 0, momentum = 0;
    for (const TreeLink& link : tree) {
      widest = std::max(widest, length_squared(link.gap));
      momentum += mass_of(link) * std::sqrt(length_squared(link.kick));
      spare_ += 0.5 * (mass_of(link) * length_squared(link.kick) +
                       inertia_of(link) * link.spin_kick * link.spin_kick);
    }
    // Closing a hinge that was open may lift bodies.
    spare_ += momentum / h * std::sqrt(widest);
  }

  // Moves the tree through a share of a substep, a power of two. If its hinges cannot be closed at the end,
  // as light links would have to rotate too far, or only where the tree has not the energy to go, moves it
  // through the halves instead. Leaves out the smallest part that it has not the energy for.
  void move_by(double share) {
    for (TreeLink& link : tree_) link.velocity_before = link.velocity, link.spin_before = link.spin;
    const double acts = due_ + 0.5 * share, t = share * h_;
    find_demands(tree_, t, 1 / share, &TreeLink::impulse);
    bool loaded = assemble(tree_);
    due_ == 0.5 * share ? kick(tree_, share) : (kick(tree_, due_), kick(tree_, 0.5 * share));
    begin(tree_, t);
    const Held held = hold(tree_, t, acts / share);
    const double work = share * work_of(tree_, frame_);
    const bool lacks = !driven_ && most_ + work < -spare_, last = share * kMostParts <= 1;
    if (lacks || (!held.closed && !last)) {
      for (TreeLink& link : tree_) link.velocity = link.velocity_before, link.spin = link.spin_before;
      finish();
      if (!last) move_by(0.5 * share), move_by(0.5 * share);
      return;
    }
    loaded = loaded || held.heavier;
    move(tree_, t);
    strained_ = strained_ || loaded, loaded_ = loaded;
    for (TreeLink& link : tree_) link.impulse = (1 / acts) * link.found;
    // A hold that turns drives the tree.
    most_ += work + share * dot(tree_[1].impulse, velocity_of_hold(tree_) - frame_);
    due_ = 0.5 * share;
    if (loaded) finish();
  }

  // Brings the velocities to the time of the poses.
  void finish() {
    if (due_ == 0) return;
    kick(tree_, due_);
    assemble(tree_);
    if (loaded_) damp(tree_);
    for (TreeLink& link : tree_) link.found = {};
    fit(tree_);
    if (strained_) limit_energy(tree_, frame_, most_), most_ = energy_of(tree_, frame_);
    // Half of the impulse acts before the motion, half after.
    for (TreeLink& link : tree_) link.impulse = 0.5 * link.impulse + (0.5 / due_) * link.found;
    due_ = 0, strained_ = loaded_ = false;
  }

 private:
  const std::span<TreeLink> tree_;
  const double h_;     // s, a substep
  const Vec2d frame_;  // m/s, in which energy is measured
  double most_;        // J, the energy that forces permit
  const bool driven_;  // its hold moves, and may lift it
  double spare_ = 0;   // J, error of that: the energy that forces give to a body at rest in a substep
  double due_ = 0;     // share of a substep by which the velocities lag behind
  bool loaded_ = false, strained_ = false;  // inertia was raised in the last motion, since the last check
};

}  // namespace

void move_tree(std::span<TreeLink> tree, double h, int substeps) {
  const int parts = parts_of(tree, h);
  const double share = 1.0 / parts;
  for (TreeLink& link : tree) link.moved = {}, link.turned = 0;
  place(tree);
  Passage passage(tree, h);
  for (int left = parts * substeps; left > 0; --left) passage.move_by(share);
  passage.finish();
}

}  // namespace plumb
