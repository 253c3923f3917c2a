#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory_resource>
#include <string>
#include <vector>

#include "engine/collide/dynamic_tree.h"
#include "engine/collide/pair_set.h"
#include "engine/solve/body_motion.h"
#include "engine/solve/bounce_crowds.h"
#include "engine/solve/bounded_rows.h"
#include "engine/solve/contact_graph.h"
#include "engine/solve/direct_rows.h"
#include "engine/solve/hinge_tree.h"
#include "engine/solve/joint_set.h"
#include "engine/world/burst_list.h"
#include "engine/world/corner_pool.h"
#include "engine/world/definitions.h"
#include "engine/world/events.h"
#include "engine/world/flight.h"
#include "engine/world/slots.h"
#include "engine/world/used_list.h"

/// What a world consists of. Bodies, shapes, contacts and joints live in slots that never move; what the
/// solver works on lies in arrays of its own. Lists that run through the slots (a body's shapes, contacts,
/// joints) are links of indices, -1 at their ends.
namespace plumb {

inline constexpr int kNone = -1;

/// What solvers do not need of a body: read once a step at most. A cache line in float.
template <class Real>
struct BodyRecord {
  BodyType type = BodyType::Dynamic;
  bool awake = false;  ///< in the list of awake bodies; never a static one
  bool may_sleep = true;
  bool lock_x = false, lock_y = false, lock_rotation = false;
  bool mass_given = false;
  bool quarantined = false;  ///< out of the motion; its type is Static meanwhile
  int awake_index = kNone;
  int first_shape = kNone, first_contact = kNone,
      first_joint = kNone;     ///< contact and joint: edge = 2 index + side
  int constraints = 0;         ///< contacts with points, and joints: 0 is free flight
  int uncommon = kNone;        ///< its UncommonBody
  Real mass = 0, inertia = 0;  ///< kg, kg m^2 about the centre of mass; negative: not known of a static body
  Vec2<Real> centre{};         ///< m, of what it turns about, in the body's frame: mass.h
  Real half_width = 0;         ///< m, smallest half width of its shapes; negative: in `unsettled`
  Real still_for = 0;          ///< s
  double angle = 0;            ///< rad, whole turns counted

  BodyLocks locks() const { return {lock_x, lock_y, lock_rotation}; }
};
static_assert(sizeof(BodyRecord<float>) == 64);

/// What few bodies have: a name, damping, a gravity of their own.
template <class Real>
struct UncommonBody {
  std::string name{};
  Real gravity_scale = 1, linear_damping = 0, angular_damping = 0;
  Vec2<Real> mass_centre{};  ///< m, in the body's frame, when its mass was given
};

/// What the user applies to a body until the end of the next step.
template <class Real>
struct Load {
  Vec2<Real> force{};  ///< N
  Real torque = 0;     ///< N m
};

/// What collision reads of a shape, in the frame of its body's centre of mass.
template <class Real>
struct ShapeForm {
  int corner = 0;  ///< first in the pool; a chain's segment has its neighbours before and after
  std::uint16_t count = 0;
  bool chain = false, sensor = false;
  Real radius = 0;  ///< m, of rounding
  Real extent = 0;  ///< m, half the size of the shape
  /// Corners in the pool.
  int stored() const { return count + (chain ? 2 : 0); }
};

template <class Real>
struct ShapeRecord {
  int body = 0;
  int next = kNone, previous = kNone;  ///< of the same body
  int proxy = kNone;
  int chain = kNone;   ///< that it is a segment of
  bool moved = false;  ///< in the list of boxes to search pairs for
  bool hit_events = false, pre_solve = false;
  Filter filter{};
  float friction = 0, restitution = 0, rolling_resistance = 0, surface_speed = 0;
  Real density = 0;  ///< kg/m^2
};

enum class ContactHome : std::uint8_t {
  Near,    ///< awake, boxes overlap, no points
  Graph,   ///< awake, with points: in the constraint graph
  Parked,  ///< with points, all its bodies asleep
  Idle,    ///< without points, all its bodies asleep
};

struct ContactRecord {
  int shape_a = 0, shape_b = 0;
  int body_a = 0, body_b = 0;
  int previous[2] = {kNone, kNone}, next[2] = {kNone, kNone};  ///< edges in the two bodies' lists
  ContactHome home = ContactHome::Near;
  std::int8_t colour = 0;
  bool touching = false;  ///< as events tell it
  bool pre_solve = false, hit_events = false;
  int index = 0;  ///< in its home
};

struct JointRecord {
  int body_a = 0, body_b = 0;
  int previous[2] = {kNone, kNone}, next[2] = {kNone, kNone};
  int slot = 0;  ///< in the joint set
  bool collide = false, active = false;
  double break_force = 0, break_torque = 0;  ///< N, N m; 0: never
  std::uint64_t user_data = 0;
};

struct SensorRecord {
  int shape = 0;
  std::vector<ShapeId> visitors{};  ///< that overlapped it after the last step, by index
};

struct ChainRecord {
  int body = 0;
  std::vector<int> shapes{};
};

/// A body that went bad, and what it was.
struct QuarantinedBody {
  int body = 0;
  BodyType type = BodyType::Dynamic;  ///< that it has when it is released
  QuarantineEvent why{};
};

/// A velocity.
template <class Real>
struct BodyVelocity {
  Vec2<Real> velocity{};      ///< m/s
  Real angular_velocity = 0;  ///< rad/s
};

/// How a body's velocity changes in a substep of its own accord.
template <class Real>
struct Kick {
  int body = 0;
  Vec2<Real> velocity{};         ///< m/s
  Real spin = 0;                 ///< rad/s
  Real keep = 1, keep_spin = 1;  ///< what damping leaves
  bool locked_x = false, locked_y = false;
  bool in_tree = false;          ///< moved with its mechanism
  Vec2<Real> velocity_before{};  ///< m/s, after the kick, before contacts press in this substep
  Real spin_before = 0;          ///< rad/s
};

/// A body whose way in a step is searched for impacts: it moved far for its size, or an impact that bounces
/// is `expected`. `covered`: its stored boxes held it all the way, so that it can only have met what it has a
/// contact with.
struct FastBody {
  int body = 0;
  bool covered = false;
  bool expected = false;
};

/// A contact whose shapes are going to meet in this step, in free flight, and bounce.
template <class Real>
struct ExpectedImpact {
  ContactConstraint<Real> constraint;
  bool in_graph = false;  ///< the contact had points before; else it gets them when the solver takes it
  bool left = false;      ///< to the solver
};

/// A small island of contacts, solved all at once.
template <class Real>
struct DirectIsland {
  explicit DirectIsland(std::pmr::memory_resource* room) : contacts(room), system(room) {}

  std::pmr::vector<ContactConstraint<Real>*> contacts;
  DirectRows<Real> system;
  int root = kNone;  ///< the body that stands for it
};

/// A body of a jointed island: what it has on its way through a substep, in double.
struct JointedLink {
  int body = kNone;
  Vec2d before{}, velocity{}, way{};           ///< m/s: at the start; without impulses, then with; the mean
  double spin_before = 0, spin = 0, turn = 0;  ///< rad/s, likewise
  Vec2d moved{};                               ///< m, since the step's start
  double turned = 0, rotation_c = 1, rotation_s = 0;  ///< likewise
};

/// What a row of a jointed island belongs to.
template <class Real>
struct RowTie {
  Real* impulse = nullptr;  ///< N s, in the joint or contact
  Real most = 0;            ///< N s, of a pair of rows
  bool pair = false;
  int first = -1, count = 0;  ///< rows whose impulses bound this one
  double friction = 0;        ///< times their sum; m for torques
};

/// An island with joints, solved all at once.
template <class Real>
struct JointedIsland {
  explicit JointedIsland(std::pmr::memory_resource* room)
      : contacts(room),
        joints(room),
        links(room),
        blocks(room),
        sizes(room),
        ties(room),
        impulses(room),
        system(room) {}

  std::pmr::vector<ContactConstraint<Real>*> contacts;
  std::pmr::vector<int> joints;  ///< slots in the joint set
  std::pmr::vector<JointedLink> links;
  std::pmr::vector<std::pair<int, int>> blocks;  ///< links of each joint, then of each contact
  std::pmr::vector<int> sizes;
  std::pmr::vector<RowTie<Real>> ties;  ///< of the system's rows
  std::pmr::vector<double> impulses;    ///< N s, of the rows in this substep
  BoundedRows system;
  int root = kNone;     ///< the body that stands for it
  int contact_row = 0;  ///< the first row of a contact
  bool solved = false;  ///< false: left to the sweeps
};

/// Mechanisms that are moved as such: kept while no tie changes.
template <class Real>
struct HingeTrees {
  std::vector<TreeLink> links;        ///< of one tree after another, parents first
  std::vector<Vec2<Real>*> impulses;  ///< of the links' hinges, in the joint set; the roots have none
  std::vector<int> firsts;            ///< the trees' roots, and the end
  std::vector<char> holds;            ///< by body: a link
  int hinges = 0;

  bool empty() const { return hinges == 0; }
};

/// What a step makes anew: kept between steps for its room alone, and the islands while no tie changes.
template <class Real>
struct Scratch {
  std::vector<int> queue;
  std::vector<std::pair<int, int>> found_pairs;
  std::vector<char> meets;  ///< by proxy of the moving tree
  std::vector<int> lost_contacts, ended_contacts, touch_changes;
  BurstList<ContactConstraint<Real>> begun_contacts;
  std::vector<Kick<Real>> kicks;           ///< of the awake bodies that move by substeps
  std::vector<BodyVelocity<Real>> starts;  ///< theirs at the step's start
  std::vector<int> bad_bodies;             ///< whose motion in the step is not to be used
  std::vector<int> island_of, island_size, island_place, island_room;
  std::vector<int> link_of;  ///< by body: its place among the links of its island
  std::vector<Real> lightest, heaviest;
  std::vector<int> island_joints;
  std::vector<JointSolverRow<Real>> joint_rows;
  /// What small islands are made of: what one of them gives up when it grows, another one takes.
  std::pmr::unsynchronized_pool_resource room{{.largest_required_pool_block = 1 << 17}};
  std::vector<DirectIsland<Real>> direct;  ///< `direct_count` are in use
  int direct_count = 0;
  std::vector<JointedIsland<Real>> jointed;  ///< `jointed_count` are in use
  int jointed_count = 0;
  bool islands_known = false;  ///< `island_of` and `island_size` are those of the ties as they are
  HingeTrees<Real> trees;
  std::vector<int> tree_of, link_place;         ///< by body, while trees are found and loaded
  std::vector<char> not_a_tree, tree_grounded;  ///< by the body that stands for a set, likewise
  std::vector<int> bouncing;  ///< contacts that have restitution, or may be of discs that approach fast
  std::vector<Bounce<Real>> bounces;
  std::vector<ExpectedImpact<Real>> expected_impacts;
  std::vector<int> pressed_bodies;  ///< that something is going to hold in this step
  std::vector<int> expecting_bodies;
  std::vector<char> pressed, expecting;  ///< by body, what the lists hold; all 0 when these are empty
  CrowdRoom<Real> crowds;
  std::vector<char> restless;
  std::vector<FastBody> fast_bodies;
  std::vector<int> deep_contacts;  ///< that have given way until a core is near
  std::vector<Flight> flights;
  std::vector<Meeting> meetings;   ///< a heap, the first on top
  std::vector<int> flight_places;  ///< by body: its flight, while they are followed
  std::vector<ShapeId> visitors;
};

template <class Real>
struct WorldData {
  WorldDefinition settings;
  double time = 0;
  std::int64_t steps = 0;
  double last_h = 0;  ///< s, substep of the last step

  // Bodies, by index.
  Slots<BodyRecord<Real>> bodies;
  Slots<UncommonBody<Real>> uncommon;
  UsedList<Load<Real>> loads;
  UsedList<std::uint64_t> body_data;  ///< the user's
  std::vector<BodyMotion<Real>> motion;
  std::vector<Rotation<Real>> rotation;
  std::vector<Vec2d> position;  ///< m, of the centres of mass
  UsedList<Vec2d> remainders;   ///< m, what rounding left out of the positions; in double alone
  std::vector<Real> extents;    ///< m, from the centre of mass to the farthest point
  std::vector<char> enlarged;   ///< a shape of it left its stored box in the last step
  std::vector<int> awake;
  std::vector<int> unsettled;  ///< bodies whose shapes have changed: mass.h

  // Shapes, by index.
  Slots<ShapeRecord<Real>> shapes;
  std::vector<ShapeForm<Real>> forms;
  std::vector<Aabb<Real>> boxes;  ///< tight
  CornerPool<Real> corners;
  UsedList<std::uint64_t> shape_data;  ///< the user's
  Slots<ChainRecord> chains;
  std::vector<int> moved_shapes;
  DynamicTree<Real> still_tree, moving_tree;  ///< static; kinematic and dynamic

  // Contacts.
  Slots<ContactRecord> contacts;
  PairSet pairs;
  std::vector<int> near;
  ContactGraph<Real> graph;
  std::vector<ContactConstraint<Real>> parked;

  Slots<JointRecord> joints;
  JointSet<Real> joint_set;

  std::vector<SensorRecord> sensors;
  std::vector<int> breakable;  ///< joints
  std::vector<QuarantinedBody> quarantine;
  Events events;   ///< of the last step
  Events pending;  ///< since then: the next step's
  bool stepping = false;
  mutable std::atomic<int> callers{0};  ///< callbacks of the user's that look at the world now: lock.h
  bool abandoned = false;               ///< whoever had it is gone; the last of these deletes it
  bool reports_hits = false;            ///< some shape wants it
  bool ties_changed =
      true;  ///< since the islands were found: a contact or joint came or went, a body woke or slept
  Scratch<Real> scratch;

  /// Asked about contacts with the shapes that want it, after their manifold was made; false: not in this
  /// step.
  std::function<bool(int contact, ContactConstraint<Real>& constraint)> pre_solve;

  /// The user's own rules, in place of those of the settings.
  CombineFunction friction_rule = nullptr, restitution_rule = nullptr;

  /// Where what happens now is told.
  Events& log() { return stepping ? events : pending; }
  SolverBodies<Real> solver_bodies() { return {motion.data(), rotation.data(), position.data()}; }
  bool gives_way(int body) const { return bodies[body].type == BodyType::Dynamic; }
  const UncommonBody<Real>& uncommon_of(int body) const {
    static const UncommonBody<Real> common;
    const int place = bodies[body].uncommon;
    return place == kNone ? common : uncommon[place];
  }
  Convex<Real> convex(int shape) const {
    const ShapeForm<Real>& form = forms[shape];
    return {corners.data() + form.corner + (form.chain ? 1 : 0), form.count, form.radius};
  }
  DynamicTree<Real>& tree_of(BodyType type) { return type == BodyType::Static ? still_tree : moving_tree; }
};

}  // namespace plumb
