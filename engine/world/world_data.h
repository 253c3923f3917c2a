#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory_resource>
#include <string>
#include <vector>

#include "engine/collision/broad_phase/dynamic_tree.h"
#include "engine/collision/broad_phase/pair_set.h"
#include "engine/core/block_lists.h"
#include "engine/core/lazy_array.h"
#include "engine/core/locked_pool.h"
#include "engine/core/loop_scheduler.h"
#include "engine/core/slot_map.h"
#include "engine/linear_algebra/bounded_rows.h"
#include "engine/world/contact_solver/contact_graph.h"
#include "engine/world/contact_solver/impact_propagation.h"
#include "engine/world/contact_solver/soft_contacts.h"
#include "engine/world/contact_solver/solver_body.h"
#include "engine/world/definitions.h"
#include "engine/world/events.h"
#include "engine/world/joint_solver/direct_rows.h"
#include "engine/world/joint_solver/hinge_tree.h"
#include "engine/world/joint_solver/joint_set.h"
#include "engine/world/profile.h"
#include "engine/world/state/corner_pool.h"
#include "engine/world/state/swept_body.h"

/// The data of a world. Bodies, shapes, contacts and joints are in slots with stable indices; solver data are
/// in separate arrays. Lists through the slots (a body's shapes, contacts, joints) are linked by index, -1 at
/// the ends.
namespace plumb {

inline constexpr int kNone = -1;

/// Body data that solvers do not need: read at most once per step. A cache line in float.
template <class Real>
struct BodyRecord {
  BodyType type = BodyType::Dynamic;
  bool awake = false;  ///< in the list of awake bodies; never a static one
  bool may_sleep = true;
  bool lock_x = false, lock_y = false, lock_rotation = false;
  bool mass_given = false;
  bool quarantined = false;  ///< while so, its type is Static
  int awake_index = kNone;
  int first_shape = kNone, first_contact = kNone,
      first_joint = kNone;     ///< contact and joint: edge = 2 index + side
  int constraints = 0;         ///< contacts with points, and joints; 0: free flight
  int uncommon = kNone;        ///< index of its BodyExtras
  Real mass = 0, inertia = 0;  ///< kg, kg m^2 about the centre of mass; negative: unknown, for a static body
  Vec2<Real> centre{};         ///< m, centre of rotation in the body's frame: mass.h
  Real half_width = 0;         ///< m, smallest half width of its shapes; negative if in `mass_changed_bodies`
  Real sleep_time = 0;         ///< s, sleep timer
  double angle = 0;            ///< rad, whole turns counted

  BodyLocks locks() const { return {lock_x, lock_y, lock_rotation}; }
};
static_assert(sizeof(BodyRecord<float>) == 64);

/// Optional data of a body: name, damping, gravity scale, continuous collision.
template <class Real>
struct BodyExtras {
  std::string name{};
  Real gravity_scale = 1, linear_damping = 0, angular_damping = 0;
  Vec2<Real> mass_centre{};  ///< m, in the body's frame, if its mass was given
  bool continuous = true;
};

/// Force and torque that the user applies to a body until the end of the next step.
template <class Real>
struct Load {
  Vec2<Real> force{};  ///< N
  Real torque = 0;     ///< N m
};

/// Displacement of a body since its period of rest began: sleeping.h. In single precision, because it is
/// small.
struct RestDisplacement {
  Vec2<float> translation{};  ///< m
  float rotation = 0;         ///< rad
};

/// Motion of a body at the start of a step: step_rollback.h.
template <class Real>
struct BodyMotion {
  int body = kNone;
  SolverBody<Real> motion{};
  Rotation<Real> rotation{};
  Vec2d position{}, compensation{};  ///< m
  double angle = 0;                  ///< rad
  Real sleep_time = 0;               ///< s
  RestDisplacement rest_displacement{};
  Load<Real> load{};
};

/// Collision data of a shape, in the frame of its body's centre of mass.
template <class Real>
struct ShapeForm {
  int corner = 0;  ///< first in the pool; for a chain's segment, that of the neighbour before it
  std::uint16_t count = 0;
  bool chain = false, sensor = false;
  Real radius = 0;  ///< m, of rounding
  Real extent = 0;  ///< m, half the size of the shape
  /// Returns the number of its corners in the pool.
  int stored() const { return count + (chain ? 2 : 0); }
};

template <class Real>
struct ShapeRecord {
  int body = 0;
  int next = kNone, previous = kNone;  ///< of the same body
  int proxy = kNone;
  int chain = kNone;   ///< index of its chain
  bool moved = false;  ///< in the move buffer
  bool hit_events = false, pre_solve = false;
  Filter filter{};
  Real friction = 0, restitution = 0, rolling_resistance = 0, surface_speed = 0;
  Real density = 0;  ///< kg/m^2
};

enum class ContactHome : std::uint8_t {
  NonTouching,          ///< awake, fat AABBs overlap, no points
  Graph,                ///< awake, with points: in the constraint graph
  Sleeping,             ///< with points, all its bodies asleep
  SleepingNonTouching,  ///< without points, all its bodies asleep
};

struct ContactRecord {
  int shape_a = 0, shape_b = 0;
  int body_a = 0, body_b = 0;
  int previous[2] = {kNone, kNone}, next[2] = {kNone, kNone};  ///< edges in the two bodies' lists
  ContactHome home = ContactHome::NonTouching;
  std::int8_t colour = 0;
  bool touching = false;  ///< as reported by events
  bool pre_solve = false, hit_events = false;
  int index = 0;  ///< index in its home
};

struct JointRecord {
  int body_a = 0, body_b = 0;
  int previous[2] = {kNone, kNone}, next[2] = {kNone, kNone};
  int slot = 0;  ///< in the joint set
  bool collide = false, active = false;
  double break_force = 0, break_torque = 0;    ///< N, N m; 0: unbreakable
  double report_force = 0, report_torque = 0;  ///< N, N m; 0: never
  std::uint64_t user_data = 0;
};

struct SensorRecord {
  int shape = 0;
  std::vector<ShapeId> visitors{};  ///< shapes that overlapped it after the last step, by index
};

struct ChainRecord {
  int body = 0;
  std::vector<int> shapes{};
};

/// A body in quarantine, and its previous type.
struct QuarantinedBody {
  int body = 0;
  BodyType type = BodyType::Dynamic;  ///< restored at release
  QuarantineEvent why{};
};

/// Linear and angular velocity of a body.
template <class Real>
struct BodyVelocity {
  Vec2<Real> velocity{};      ///< m/s
  Real angular_velocity = 0;  ///< rad/s
};

/// External velocity change of a body in a substep, by forces and damping: v' = damping_factor v + velocity.
template <class Real>
struct VelocityIncrement {
  int body = 0;
  Vec2<Real> velocity{};                             ///< m/s, by forces, as far as damping leaves it
  Real spin = 0;                                     ///< rad/s, the same
  Real damping_factor = 1, spin_damping_factor = 1;  ///< of the velocities before
  bool locked_x = false, locked_y = false;
  bool in_tree = false;          ///< moved as part of its articulated body
  Vec2<Real> velocity_before{};  ///< m/s, after forces, before contact impulses of this substep. Before the
                                 ///< first: m, the displacement of the last step
  Real spin_before = 0;          ///< rad/s, the same; rad
};

/// A body whose motion in a step is tested for impacts, because it moved far for its size, or because a
/// bounce is `expected`. `covered`: its fat AABBs contained the whole motion, so only its contacts need
/// testing.
struct FastBody {
  int body = 0;
  bool covered = false;
  bool expected = false;
};

/// A contact with a predicted impact in free flight in this step, with restitution.
template <class Real>
struct ExpectedImpact {
  ContactConstraint<Real> constraint;
  bool in_graph = false;  ///< it had points before; else it gets them if the solver takes it
  bool left_to_solver = false;
};

/// A shape that has left its fat AABB, with its next fat AABB.
template <class Real>
struct ProxyUpdate {
  int shape = 0;
  Aabb<Real> box{};
};

/// A contact that has got its first points in this step.
template <class Real>
struct BegunContact {
  ContactConstraint<Real> constraint{};
  bool bounces = false;          ///< it is one of the `bouncing`
  bool loaded = false;           ///< it will be under load in this step
  bool needs_pre_solve = false;  ///< the user's pre-solve hook is to be called for it
  bool disabled = false;         ///< it was disabled
};

/// Contacts of one colour that are contiguous in the graph, updated by one thread.
template <class Real>
struct ContactRun {
  ContactConstraint<Real>* first = nullptr;
  int count = 0;
  int first_index = 0;  ///< of the first, among all contacts that are updated
};

/// A small island of contacts, solved directly.
template <class Real>
struct DirectIsland {
  explicit DirectIsland(std::pmr::memory_resource* memory) : contacts(memory), system(memory) {}

  std::pmr::vector<ContactConstraint<Real>*> contacts;
  DirectRows<Real> system;
  int root = kNone;  ///< body that represents it
};

/// A body of an island with joints: its motion through a substep, in double.
struct JointedLink {
  int body = kNone;
  bool yields = false;     ///< a driver (island_rows.h) whose joints had to yield in this step
  Vec2d start_velocity{};  ///< m/s, at the start of the substep
  Vec2d velocity{};        ///< m/s, without impulses, then with them
  Vec2d mean_velocity{};   ///< m/s, mean of the start and the end: moves the body
  double start_spin = 0, spin = 0, mean_spin = 0;          ///< rad/s, the same for rotation
  Vec2d velocity_increment{};                              ///< m/s, by the forces of the substep
  double spin_increment = 0;                               ///< rad/s, the same
  Vec2d delta_position{};                                  ///< m, since the start of the step
  double delta_angle = 0, rotation_c = 1, rotation_s = 0;  ///< the same for rotation
  int rigid_group = 0;  ///< lowest link to which joints connect it without any freedom
};

/// The source of a row of an island with joints.
template <class Real>
struct RowSource {
  Real* impulse = nullptr;  ///< N s, where the joint or contact stores it
  Real max_impulse = 0;     ///< N s, bound of a pair of rows as a vector
  bool pair = false;
  int first = -1, count = 0;  ///< rows whose impulses bound this one
  double factor = 0;          ///< applied to their sum; m for torques
  Real* tangent = nullptr;    ///< N s, where the contact stores it, if the row is a ray
  double slope = 0;           ///< tangent impulse per impulse of the ray
};

/// The rays of a contact's friction cone, two for each point.
template <class Real>
struct FrictionCone {
  const ContactConstraint<Real>* contact = nullptr;
  int block = 0;
  int first = 0, count = 0;          ///< rows
  double friction = 0;               ///< coefficient
  double slip = 0;                   ///< m/s, along the tangent: the slip for which the rows were made
  double gain = 1, last_change = 0;  ///< factor of the next change of `slip`; m/s, the last change
};

/// Impulses of a contact, N s and N m s.
struct ContactImpulses {
  double normal[2] = {0, 0}, tangent = 0, rolling = 0;
};

/// An island with joints, solved directly.
template <class Real>
struct JointedIsland {
  explicit JointedIsland(std::pmr::memory_resource* memory)
      : contacts(memory),
        joints(memory),
        links(memory),
        blocks(memory),
        block_sizes(memory),
        row_sources(memory),
        cones(memory),
        impulses(memory),
        last_impulses(memory),
        max_gaps(memory),
        saved_links(memory),
        saved_bodies(memory),
        system(memory) {}

  std::pmr::vector<ContactConstraint<Real>*> contacts;
  std::pmr::vector<int> joints;  ///< slots in the joint set
  std::pmr::vector<JointedLink> links;
  std::pmr::vector<std::pair<int, int>> blocks;  ///< links of each joint, then of each contact
  std::pmr::vector<int> block_sizes;
  std::pmr::vector<RowSource<Real>> row_sources;  ///< of the system's rows
  std::pmr::vector<FrictionCone<Real>> cones;
  std::pmr::vector<double> impulses;                ///< N s, of the rows in this substep
  std::pmr::vector<ContactImpulses> last_impulses;  ///< by contact, of the last step
  std::pmr::vector<double> max_gaps;                ///< m or rad, by row: joint_gaps.cpp; else scratch
  std::pmr::vector<JointedLink> saved_links;        ///< at the start of a substep that is divided
  std::pmr::vector<BoundedBody> saved_bodies;       ///< with their own masses, while gaps are closed
  BoundedRows system;
  int root = kNone;           ///< body that represents it
  int first_contact_row = 0;  ///< first row of a contact
  double energy = 0;          ///< J, to which errors of the substep's solutions are relative
};

/// A row whose position error is fed back, see solvers/error_feedback.h.
template <class Real>
struct FeedbackRow {
  int body_a = 0, body_b = 0;
  JointRow<Real> row{};
  Real target_speed = 0;  ///< m/s or rad/s, target along the row
  Real mass = 0, impulse = 0;
  Real compliance = 0;                                                        ///< 1/kg or 1/(kg m^2)
  Real min_impulse = 0, max_impulse = std::numeric_limits<Real>::infinity();  ///< bounds of the impulse
};

/// Articulated bodies that are moved as such; kept until contacts or joints change.
template <class Real>
struct HingeTrees {
  std::vector<ArticulatedLink> links;       ///< tree by tree, parents first
  std::vector<HingeResults<Real>> results;  ///< of the links' hinges, in the joint set; the roots have none
  std::vector<int> offsets;                 ///< first link (root) of each tree, and the end
  std::vector<char> is_link;                ///< by body: it is a link
  int hinge_count = 0;

  bool empty() const { return hinge_count == 0; }
};

/// Scratch data of a step. Memory is kept between steps, islands only while no contact or joint changes.
template <class Real>
struct Scratch {
  std::vector<int> queue;
  std::vector<std::pair<int, int>> found_pairs;
  BlockLists<std::pair<int, int>> found_pairs_of;  ///< by block of moved shapes
  std::vector<char> has_overlap;                   ///< by proxy of the dynamic tree
  std::vector<int> separated_contacts, ended_contacts, touch_changes;
  std::vector<int> bounced_contacts;  ///< touched at an impact in flight, and have no points now
  BlockLists<BegunContact<Real>> begun_contacts;
  BlockLists<ExpectedImpact<Real>> found_impacts;
  BlockLists<std::pair<int, int>> found_loaded;         ///< bodies that will be loaded by a contact
  std::vector<ContactConstraint<Real>> solver_impacts;  ///< of contacts without points, left to the solver
  std::vector<ContactRun<Real>> contact_runs;
  std::vector<char> has_contact_load;         ///< by body: a contact presses on it
  std::vector<int> pushers;                   ///< by body: its pusher (step/pushers.h)
  std::vector<std::uint8_t> contact_changes;  ///< by updated contact: nontouching ones, then the graph's
  std::vector<std::uint8_t>
      separating_faces;  ///< by contact without points: the face that separates its shapes
  std::vector<VelocityIncrement<Real>> velocity_increments;  ///< of the awake bodies that move by substeps
  std::vector<BodyVelocity<Real>> start_velocities;          ///< their velocities at the start of the step
  std::vector<int> block_firsts;                             ///< by block of a loop: where its results begin
  std::vector<int> nonfinite_bodies;                         ///< bodies with an invalid motion in this step
  std::vector<int> island_of, island_size, island_index, max_island_rows, near_rows, near_contacts;
  std::vector<int> link_of;  ///< by body: index among the links of its island
  std::vector<Real> lightest, heaviest;
  std::vector<int> island_joints, island_bounded_rows;
  std::vector<Real>
      warm_start_fraction;  ///< by body: fraction of the impulses from which iterations start; empty: 1
  std::vector<JointSolverRow<Real>> joint_rows;
  std::vector<FeedbackRow<Real>> feedback_rows;
  std::vector<BodyVelocity<Real>> feedback;  ///< by body
  /// Memory pool of small islands: islands that grow reuse the memory that others release.
  LockedPool memory{{.largest_required_pool_block = 1 << 17}};
  std::vector<DirectIsland<Real>> direct_islands;  ///< `direct_count` are in use
  int direct_count = 0;
  std::vector<JointedIsland<Real>> jointed_islands;  ///< `jointed_count` are in use
  int jointed_count = 0;
  std::vector<char> open_joints;                ///< by slot of the joint: joint_gaps.cpp
  JointedIsland<Real> open_mechanism{&memory};  ///< a mechanism whose gaps are being closed
  bool islands_known = false;                   ///< `island_of` and `island_size` are up to date
  bool has_direct_islands = false, has_crowded_islands = false;  ///< direct_islands.cpp
  HingeTrees<Real> trees;
  std::vector<int> tree_root_of, link_index;    ///< by body, while trees are found and loaded
  std::vector<char> not_a_tree, tree_grounded;  ///< the same, by representative of a set
  std::vector<int> bounce_candidates;  ///< contacts with restitution, or possibly of discs that approach fast
  std::vector<int> woken_contacts;     ///< contacts of bodies that woke in the step
  BlockLists<int> found_turning;       ///< see next; by block
  std::vector<int> turning_contacts;   ///< contacts whose points change within the step
  std::vector<RestitutionContact<Real>> restitution_contacts;
  std::vector<BodyMotion<Real>> motion_before_step;  ///< of the awake bodies: step_rollback.h
  std::vector<Real> earlier_impulses;                ///< N s, of contacts and joints: state/impulse_memory.h
  std::vector<char> is_scalar;                       ///< by contact: not solved in SIMD lanes
  std::vector<char> joints_in_islands;               ///< by the joint's slot: solved with its island
  SoftContacts<Real> soft_contacts;
  std::vector<ExpectedImpact<Real>> expected_impacts;
  std::vector<int> loaded_bodies;  ///< bodies that contacts or joints will load in this step
  std::vector<int> impact_bodies;
  std::vector<char> is_loaded,
      expects_impact;  ///< by body: true if it is in that list; all 0 if the list is empty
  ImpactScratch<Real> impacts{&memory};
  std::vector<char> cannot_sleep;
  BlockLists<ProxyUpdate<Real>> proxy_updates;  ///< by block of awake bodies, as are the next two
  BlockLists<FastBody> found_fast;
  BlockLists<int> found_nonfinite;
  std::vector<FastBody> fast_bodies;
  std::vector<int> deep_contacts;  ///< contacts with a penetration near the cores
  std::vector<SweptBody> swept_bodies;
  std::vector<int> stopped;          ///< swept bodies that are being stopped together
  std::vector<ToiEvent> toi_events;  ///< a heap, earliest on top
  BlockLists<int> found_deep;
  BlockLists<ToiEvent> found_toi_events;
  std::vector<int> swept_index_of;  ///< by body: index of its swept body, during continuous collision
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
