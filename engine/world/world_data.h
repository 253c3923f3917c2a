#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <vector>

#include "engine/collision/broad_phase/dynamic_tree.h"
#include "engine/collision/broad_phase/pair_set.h"
#include "engine/core/block_lists.h"
#include "engine/core/lazy_array.h"
#include "engine/core/locked_pool.h"
#include "engine/core/loop_scheduler.h"
#include "engine/core/slot_map.h"
#include "engine/world/contact_solver/contact_graph.h"
#include "engine/world/contact_solver/solver_body.h"
#include "engine/world/definitions.h"
#include "engine/world/events.h"
#include "engine/world/joint_solver/joint_set.h"
#include "engine/world/profile.h"
#include "engine/world/state/broad_phase_scratch.h"
#include "engine/world/state/continuous_scratch.h"
#include "engine/world/state/corner_pool.h"
#include "engine/world/state/island_scratch.h"
#include "engine/world/state/narrow_phase_scratch.h"
#include "engine/world/state/records.h"
#include "engine/world/state/solver_scratch.h"

/// The data of a world. Solver data are in arrays of their own, beside the records (state/records.h).
namespace plumb {

/// Scratch data of a step, by stage. Memory is kept between steps.
template <class Real>
struct Scratch {
  /// Memory pool of small islands: islands that grow reuse the memory that others release.
  LockedPool memory{{.largest_required_pool_block = 1 << 17}};
  BroadPhaseScratch<Real> broad_phase;
  NarrowPhaseScratch<Real> narrow_phase;
  SolverScratch<Real> solver{&memory};
  IslandScratch<Real> islands{&memory};
  ContinuousScratch<Real> continuous;
  std::vector<BodyMotion<Real>> motion_before_step;  ///< of the awake bodies: step_rollback.h
  std::vector<int> nonfinite_bodies;                 ///< bodies with an invalid motion in this step
  BlockLists<int> found_nonfinite;                   ///< the same, by block of awake bodies
  std::vector<int> block_firsts;                     ///< by block of a loop: where its results begin
  std::vector<int> queue;                            ///< bodies to visit in a walk over their neighbours
  std::vector<char> cannot_sleep;                    ///< by body; marks of such a walk
  std::vector<ShapeId> visitors;
};

template <class Real>
struct WorldData {
  // Compiled once, in state/world_data.cpp: there are many members.
  WorldData();
  WorldData(const WorldData&) = delete;
  WorldData& operator=(const WorldData&) = delete;
  ~WorldData();

  WorldDefinition settings;
  double time = 0;
  std::int64_t steps = 0;
  double last_h = 0;     ///< s, substep of the last step
  double impulse_h = 0;  ///< s, substep that stored impulses are scaled to (solvers/impulse_memory.h)

  // Bodies, by index.
  SlotMap<BodyRecord<Real>> bodies;
  SlotMap<BodyExtras<Real>> body_extras;
  LazyArray<Load<Real>> loads;
  LazyArray<std::uint64_t> body_data;  ///< user data
  std::vector<SolverBody<Real>> motion;
  std::vector<Rotation<Real>> rotation;
  std::vector<Vec2d> position;                     ///< m, of the centres of mass
  LazyArray<Vec2d> position_compensation;          ///< m, Kahan compensation of the positions; in double only
  LazyArray<RestDisplacement> rest_displacements;  ///< of bodies whose sleep timer runs; unused without sleep
  std::vector<Real> extents;                       ///< m, from the centre of mass to the farthest point
  std::vector<char> enlarged;                      ///< a shape of it left its fat AABB in the last step
  std::vector<int> awake;
  std::vector<int> mass_changed_bodies;  ///< their masses must be updated: mass.h

  // Shapes, by index.
  SlotMap<ShapeRecord<Real>> shapes;
  std::vector<ShapeForm<Real>> forms;
  std::vector<Aabb<Real>> tight_aabbs;
  CornerPool<Real> corners;
  LazyArray<std::uint64_t> shape_data;  ///< user data
  SlotMap<ChainRecord> chains;
  std::vector<int> move_buffer;
  DynamicTree<Real> static_tree, dynamic_tree;  ///< of static bodies; of kinematic and dynamic ones

  // Contacts.
  SlotMap<ContactRecord> contacts;
  PairSet pairs;
  std::vector<int> nontouching_contacts;
  ContactGraph<Real> graph;
  std::vector<ContactConstraint<Real>> sleeping_contacts;

  SlotMap<JointRecord> joints;
  JointSet<Real> joint_set;

  std::vector<SensorRecord> sensors;
  std::vector<int> load_limited_joints;  ///< joints that break, or report their load
  std::vector<QuarantinedBody> quarantine;
  Events events;   ///< of the last step
  Events pending;  ///< since then; reported with the next step
  bool stepping = false;
  bool profiled = false;  ///< stages are timed
  int last_substeps = 0;  ///< of the last step
  WorldProfile profile{};
  LoopScheduler scheduler;  ///< the threads that share a step
  mutable std::atomic<int> active_callbacks{
      0};                        ///< number of the user's callbacks that read the world now: lock.h
  bool abandoned = false;        ///< its owner is destroyed; the last callback deletes it
  bool reports_hits = false;     ///< a shape has hit events
  bool topology_changed = true;  ///< since islands were last found: a contact or joint was added or removed,
                                 ///< or a body woke or fell asleep
  Scratch<Real> scratch;

  /// Called for contacts of shapes with `pre_solve` after their manifold was computed, and for impacts found
  /// by continuous collision alone; false disables one in this step.
  std::function<bool(const ContactRecord& contact, const ContactConstraint<Real>& constraint)> pre_solve;

  /// Called for pairs of shapes whose fat AABBs begin to overlap; false: no contact.
  std::function<bool(int shape_a, int shape_b)> filter;

  /// The user's own combine rules, instead of those of the settings.
  CombineFunction friction_rule = nullptr, restitution_rule = nullptr;

  /// Shapes whose contact the pre-solve hook has disabled in this step, and shapes for whose impact
  /// continuous collision has called it without that. Scratch data of a step.
  PairSet disabled_pairs, enabled_pairs;

  /// Returns true if the user's own code computes coefficients; only the calling thread may call that code.
  bool has_rules() const { return friction_rule != nullptr || restitution_rule != nullptr; }
  /// Returns true if continuous collision may call the user's own code.
  bool calls_user_code() const { return has_rules() || filter; }
  /// Returns the buffer for events that are raised now.
  Events& event_buffer() { return stepping ? events : pending; }
  SolverBodies<Real> solver_bodies() { return {motion.data(), rotation.data(), position.data()}; }
  bool is_dynamic(int body) const { return bodies[body].type == BodyType::Dynamic; }
  const BodyExtras<Real>& extras_of(int body) const {
    static const BodyExtras<Real> common;
    const int place = bodies[body].uncommon;
    return place == kNone ? common : body_extras[place];
  }
  Convex<Real> convex(int shape) const {
    const ShapeForm<Real>& form = forms[shape];
    return {corners.data() + form.corner + (form.chain ? 1 : 0), form.count, form.radius};
  }
  DynamicTree<Real>& tree_of(BodyType type) { return type == BodyType::Static ? static_tree : dynamic_tree; }
};

}  // namespace plumb
