#include "engine/world/islands/hinge_trees.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <type_traits>

#include "engine/core/union_find.h"
#include "engine/math/trigonometry.h"
#include "engine/world/ablation/ablation.h"
#include "engine/world/state/constants.h"
#include "engine/world/state/contacts.h"
#include "engine/world/state/impulse_memory.h"

namespace plumb {
namespace {

template <class Real>
bool may_use_trees(const WorldData<Real>& w) {
  if (!enabled(Switch::HingeTrees)) return false;
  if (w.joint_set.active_count() == 0 || w.settings.integrator != Integrator::VelocityVerlet) return false;
  return w.settings.solver == Solver::Direct ||
         (w.settings.solver == Solver::SoftSteps && w.settings.direct_islands);
}

// Leaves trees of a few similar links to the iterations, which are accurate enough and cost less.
template <class Real>
void leave_to_iterations(WorldData<Real>& w) {
  Scratch<Real>& s = w.scratch;
  s.islands.island_size.assign(w.bodies.size(), 0);
  s.islands.lightest.assign(w.bodies.size(), std::numeric_limits<Real>::max());
  s.islands.heaviest.assign(w.bodies.size(), 0);
  for (const int body : w.awake) {
    if (!w.is_dynamic(body)) continue;
    const int set = s.islands.tree_root_of[body];
    ++s.islands.island_size[set];
    s.islands.lightest[set] = std::min(s.islands.lightest[set], w.bodies[body].mass);
    s.islands.heaviest[set] = std::max(s.islands.heaviest[set], w.bodies[body].mass);
  }
  for (const int body : w.awake) {
    if (!w.is_dynamic(body) || s.islands.tree_root_of[body] != body) continue;
    const bool similar_masses =
        s.islands.heaviest[body] <= Real(tuning::kDirectMassRatio) * s.islands.lightest[body];
    const int size = s.islands.island_size[body];
    if (similar_masses && size >= tuning::kMinIteratedLinks && size <= tuning::kMaxIteratedLinks &&
        !s.islands.not_a_tree[body])
      s.islands.not_a_tree[body] = kLeftToIterations;
  }
}

// Finds the sets of bodies that joints connect, and marks those that are not hinge trees. Each set is
// represented by its smallest body.
template <class Real>
void find_sets(WorldData<Real>& w) {
  Scratch<Real>& s = w.scratch;
  UnionFind sets(s.islands.tree_root_of, w.bodies.size());
  std::vector<char>&bad = s.islands.not_a_tree, &grounded = s.islands.tree_grounded;
  bad.assign(w.bodies.size(), 0), grounded.assign(w.bodies.size(), 0);
  // Marks the root of the body's set.
  const auto exclude = [&](int body) {
    if (w.is_dynamic(body)) bad[sets.find(body)] = 1;
  };
  w.joints.for_each([&](int, const JointRecord& joint) {
    const bool a = w.is_dynamic(joint.body_a), b = w.is_dynamic(joint.body_b);
    if (!joint.active || !(a || b)) return;
    const int set_a = a ? sets.find(joint.body_a) : kNone, set_b = b ? sets.find(joint.body_b) : kNone;
    if (a && b) {
      const bool excluded =
          set_a == set_b || bad[set_a] || bad[set_b] || (grounded[set_a] && grounded[set_b]);
      const bool anchored = grounded[set_a] || grounded[set_b];
      sets.join(set_a, set_b);
      bad[std::min(set_a, set_b)] = excluded, grounded[std::min(set_a, set_b)] = anchored;
    } else {
      const int set = a ? set_a : set_b;
      if (grounded[set]) bad[set] = 1;
      grounded[set] = 1;
    }
    if (!w.joint_set.is_hinge(joint.slot)) exclude(joint.body_a), exclude(joint.body_b);
    for (const int body : {joint.body_a, joint.body_b})
      if (w.bodies[body].lock_x || w.bodies[body].lock_y) exclude(body);
  });
  w.graph.for_each([&](const ContactConstraint<Real>& c) { exclude(c.body_a), exclude(c.body_b); });
  for (const int body : w.awake)
    if (w.is_dynamic(body)) s.islands.tree_root_of[body] = sets.find(body);
  if (w.settings.solver != Solver::Direct) leave_to_iterations(w);
}

// Builds trees. The root is the non-dynamic body that a hinge connects, or else body a of the first joint.
template <class Real>
class TreeBuilder {
 public:
  explicit TreeBuilder(WorldData<Real>& w)
      : w_(w), trees_(w.scratch.islands.trees), link_index_(w.scratch.islands.link_index) {
    link_index_.assign(w.bodies.size(), kNone);
  }

  void add_tree(int root, int joint) {
    assert(link_index_[root] == kNone || !w_.is_dynamic(root));
    first_ = static_cast<int>(trees_.links.size());
    trees_.offsets.push_back(first_);
    ArticulatedLink link;
    link.body = root;
    link.is_dynamic = w_.is_dynamic(root);
    add(link, {});
    if (link.is_dynamic) {
      link_index_[root] = 0;
    } else {
      const bool at_b = w_.joints[joint].body_a == root;
      add_child(0, joint, at_b ? w_.joints[joint].body_b : w_.joints[joint].body_a);
    }
    for (int next = first_; next < static_cast<int>(trees_.links.size()); ++next) {
      const int body = trees_.links[next].body;
      if (!trees_.links[next].is_dynamic) continue;
      for_each_edge(w_.joints, w_.bodies[body].first_joint, [&](int edge, const JointRecord& record) {
        const int other = (edge & 1) == 0 ? record.body_b : record.body_a;
        if (record.active && w_.is_dynamic(other) && link_index_[other] == kNone)
          add_child(next - first_, edge / 2, other);
      });
    }
    compute_lengths();
  }

 private:
  void add(const ArticulatedLink& link, const HingeResults<Real>& results) {
    trees_.links.push_back(link);
    trees_.results.push_back(results);
    if (link.is_dynamic) trees_.is_link[link.body] = 1;
  }

  void add_child(int parent, int joint, int body) {
    const JointRecord& record = w_.joints[joint];
    const ExternalHinge<Real> hinge = w_.joint_set.set_external(record.slot);
    assert(record.body_a == body || record.body_b == body);
    const bool at_b = record.body_b == body;
    ArticulatedLink link;
    link.body = body;
    link.parent = parent;
    link.joint = joint;
    link.sign = at_b ? 1 : -1;
    link.anchor = at_b ? hinge.anchor_b : hinge.anchor_a;
    link.parent_anchor = at_b ? hinge.anchor_a : hinge.anchor_b;
    link_index_[body] = static_cast<int>(trees_.links.size()) - first_;
    ++trees_.hinge_count;
    add(link, hinge.results);
  }

  // Computes the lengths of the last tree's links.
  void compute_lengths() {
    double largest = 0;
    for (std::size_t i = first_; i < trees_.links.size(); ++i) {
      ArticulatedLink& link = trees_.links[i];
      ArticulatedLink& parent = trees_.links[first_ + link.parent];
      if (link.joint < 0) continue;
      const double own = length_squared(link.anchor), far = length_squared(link.parent_anchor);
      link.radius_squared = std::max(link.radius_squared, own);
      if (parent.is_dynamic) parent.radius_squared = std::max(parent.radius_squared, far);
      // A non-dynamic parent may be arbitrarily far away, so its anchor does not count.
      link.arm_scale_squared = own + (parent.is_dynamic ? far : 0);
      largest = std::max(largest, link.arm_scale_squared);
    }
    if (largest == 0) largest = 1;
    for (std::size_t i = first_; i < trees_.links.size(); ++i)
      if (trees_.links[i].arm_scale_squared == 0) trees_.links[i].arm_scale_squared = largest;
  }

  WorldData<Real>& w_;
  HingeTrees<Real>& trees_;
  std::vector<int>& link_index_;
  int first_ = 0;
};

template <class Real>
void make_trees(WorldData<Real>& w) {
  const Scratch<Real>& s = w.scratch;
  TreeBuilder<Real> maker(w);
  const auto needs_tree = [&](int body) {
    return w.is_dynamic(body) && !s.islands.not_a_tree[s.islands.tree_root_of[body]] &&
           !s.islands.trees.is_link[body];
  };
  w.joints.for_each([&](int index, const JointRecord& joint) {
    if (!joint.active) return;
    if (!w.is_dynamic(joint.body_a) && needs_tree(joint.body_b)) maker.add_tree(joint.body_a, index);
    if (!w.is_dynamic(joint.body_b) && needs_tree(joint.body_a)) maker.add_tree(joint.body_b, index);
  });
  w.joints.for_each([&](int, const JointRecord& joint) {
    if (joint.active && needs_tree(joint.body_a) && w.is_dynamic(joint.body_b))
      maker.add_tree(joint.body_a, kNone);
  });
}

// Loads rotation, velocity and inverse masses, in double.
template <class Real>
void load_body(const WorldData<Real>& w, ArticulatedLink& link) {
  const SolverBody<Real>& motion = w.motion[link.body];
  link.velocity = motion.velocity.template as<double>();
  link.spin = static_cast<double>(motion.angular_velocity);
  link.inverse_mass = static_cast<double>(motion.inverse_mass);
  link.inverse_inertia = static_cast<double>(motion.inverse_inertia);
  if constexpr (std::is_same_v<Real, double>) {
    link.rotation = w.rotation[link.body];
  } else {
    link.rotation = rotation_of(w.bodies[link.body].angle);
  }
}

template <class Real>
void load_hinges(WorldData<Real>& w, std::span<ArticulatedLink> tree, const HingeResults<Real>* results,
                 double scale) {
  for (std::size_t i = 0; i < tree.size(); ++i) {
    ArticulatedLink& link = tree[i];
    if (link.joint < 0) continue;
    const ArticulatedLink& parent = tree[link.parent];
    link.gap = (w.position[link.body] - w.position[parent.body]) - parent.rotation * link.parent_anchor +
               link.rotation * link.anchor;
    link.impulse = (scale * link.sign) * results[i].impulse->template as<double>();
  }
}

template <class Real>
void load_increments(WorldData<Real>& w) {
  HingeTrees<Real>& trees = w.scratch.islands.trees;
  std::vector<int>& velocity_increment_of = w.scratch.islands.link_index;
  for (std::size_t i = 0; i < w.scratch.solver.velocity_increments.size(); ++i)
    velocity_increment_of[w.scratch.solver.velocity_increments[i].body] = static_cast<int>(i);
  for (ArticulatedLink& link : trees.links) {
    if (!link.is_dynamic) continue;
    const VelocityIncrement<Real>& increment =
        w.scratch.solver.velocity_increments[velocity_increment_of[link.body]];
    link.velocity_increment = increment.velocity.template as<double>();
    link.spin_increment = static_cast<double>(increment.spin);
    link.damping_factor = static_cast<double>(increment.damping_factor),
    link.spin_damping_factor = static_cast<double>(increment.spin_damping_factor);
  }
}

template <class Real>
void store(WorldData<Real>& w, std::span<const ArticulatedLink> tree, const HingeResults<Real>* results,
           double inverse_dt) {
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const ArticulatedLink& link = tree[i];
    if (link.joint >= 0) {
      *results[i].impulse = (link.sign * link.impulse).template as<Real>();
      *results[i].force = (inverse_dt * link.sign * link.step_impulse).template as<Real>();
    }
    if (!link.is_dynamic) continue;
    SolverBody<Real>& motion = w.motion[link.body];
    motion.velocity = link.velocity.template as<Real>();
    motion.angular_velocity = static_cast<Real>(link.spin);
    motion.delta_position = link.delta_position.template as<Real>();
    motion.delta_angle = static_cast<Real>(link.delta_angle);
    w.rotation[link.body] = {static_cast<Real>(link.rotation.c), static_cast<Real>(link.rotation.s)};
  }
}

}  // namespace

template <class Real>
void find_hinge_trees(WorldData<Real>& w) {
  if (!w.topology_changed) return;
  w.topology_changed = false;
  w.scratch.islands.islands_known = false;
  HingeTrees<Real>& trees = w.scratch.islands.trees;
  trees.links.clear(), trees.results.clear(), trees.offsets.clear();
  trees.is_link.assign(w.bodies.size(), 0);
  trees.hinge_count = 0;
  w.joint_set.clear_external();
  if (!may_use_trees(w)) return;
  find_sets(w);
  make_trees(w);
  trees.offsets.push_back(static_cast<int>(trees.links.size()));
}

template <class Real>
void move_hinge_trees(WorldData<Real>& w, double h, int substeps) {
  HingeTrees<Real>& trees = w.scratch.islands.trees;
  if (trees.empty()) return;
  load_increments(w);
  for (ArticulatedLink& link : trees.links) load_body(w, link);
  const double warm_start = warm_start_ratio(w, h);
  for (std::size_t i = 0; i + 1 < trees.offsets.size(); ++i) {
    const std::span<ArticulatedLink> tree{trees.links.data() + trees.offsets[i],
                                          trees.links.data() + trees.offsets[i + 1]};
    const HingeResults<Real>* results = trees.results.data() + trees.offsets[i];
    load_hinges(w, tree, results, warm_start);
    integrate_tree(tree, h, substeps);
    store<Real>(w, tree, results, 1 / (h * substeps));
  }
}

#define PLUMB_FOR(Real)                             \
  template void find_hinge_trees(WorldData<Real>&); \
  template void move_hinge_trees(WorldData<Real>&, double, int);
PLUMB_FOR(float)
PLUMB_FOR(double)
#undef PLUMB_FOR

}  // namespace plumb
