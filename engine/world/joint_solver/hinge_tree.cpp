#include "engine/world/joint_solver/hinge_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/math/trigonometry.h"

namespace plumb {
namespace {

// Maximum rotation of a body in a substep, rad, by its spin or as a pendulum. The energy error is about an
// eighth of its square.
constexpr double kTurn = 0.125;
constexpr int kMostParts = 64;
// Tolerance of closing hinges, as a fraction of the arms, and the maximum number of Newton steps for it.
constexpr double kClosed = 1e-11;
constexpr int kMostNewtonSteps = 16;
// Maximum closing speed of a gap that existed before, in arms per second. A scene that starts with its joints
// open is pulled together without a burst.
constexpr double kGapSpeed = 4;
// Ratio of demanded to current inertia above which a link's inertia is raised within a substep.
constexpr double kHeavier = 1.01;
// Growth of the gap in a Newton step above which the iteration diverges.
constexpr double kDiverges = 2;

// ---- Motion

void kick(std::span<TreeLink> tree, double share) {
  for (TreeLink& link : tree) {
    if (!link.moves) continue;
    link.velocity += share * link.kick;
    link.spin += share * link.spin_kick;
    if (link.keep == 1 && link.keep_spin == 1) continue;
    link.velocity *= share == 1 ? link.keep : std::sqrt(link.keep);
    link.spin *= share == 1 ? link.keep_spin : std::sqrt(link.keep_spin);
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

// Solves for velocities that close the hinges at the end of the motion. `share` of a substep's forces act
// before. Returns true if the impulses raised the inertia of links.
bool hold(std::span<TreeLink> tree, double h, double share) {
  constexpr double kEnough = kClosed * kClosed;
  bool heavier = false;
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= kMostNewtonSteps; ++i) {
    const double gap = predict(tree, h);
    if (gap <= kEnough || i == kMostNewtonSteps) return heavier;
    if (i > 0 && !(gap < before)) {
      if (gap <= kDiverges * before) return heavier;
      undo(tree);
      predict(tree, h);
      return heavier;
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
  return heavier;
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

}  // namespace

void move_tree(std::span<TreeLink> tree, double h, int substeps) {
  const int parts = parts_of(tree, h);
  const double part = 1.0 / parts, t = part * h;
  for (TreeLink& link : tree) {
    link.moved = {}, link.turned = 0;
    link.kick *= part, link.spin_kick *= part, link.impulse *= part;
    for (int i = 1; i < parts; i *= 2)
      link.keep = std::sqrt(link.keep), link.keep_spin = std::sqrt(link.keep_spin);
  }
  place(tree);
  bool fits = true;  // velocities and poses are those of the same time
  for (int left = parts * substeps; left > 0; --left) {
    const double share = fits ? 0.5 : 1;
    find_demands(tree, t, 1, &TreeLink::impulse);
    bool loaded = assemble(tree);
    kick(tree, share);
    begin(tree, t);
    loaded = hold(tree, t, share) || loaded;
    move(tree, t);
    fits = left == 1 || loaded;
    for (TreeLink& link : tree) link.impulse = (1 / share) * link.found;
    if (!fits) continue;
    kick(tree, 0.5);
    assemble(tree);
    if (loaded) damp(tree);
    for (TreeLink& link : tree) link.found = {};
    fit(tree);
    // Half of a substep's impulse acts before the motion, half after.
    for (TreeLink& link : tree) link.impulse = 0.5 * link.impulse + link.found;
  }
  for (TreeLink& link : tree) link.impulse *= parts;
}

}  // namespace plumb
