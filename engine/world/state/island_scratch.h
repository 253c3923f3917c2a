#pragma once

#include <memory_resource>
#include <utility>
#include <vector>

#include "engine/linear_algebra/bounded_rows.h"
#include "engine/world/contact_solver/contact_constraint.h"
#include "engine/world/joint_solver/direct_rows.h"
#include "engine/world/joint_solver/hinge_tree.h"
#include "engine/world/joint_solver/joint_set.h"
#include "engine/world/state/records.h"

namespace plumb {

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
  int joint_group = 0;  ///< lowest link to which joints connect it; all static and kinematic bodies are one
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
  int first = 0, count = 0;                ///< rows
  double friction = 0;                     ///< coefficient
  double slip = 0;                         ///< m/s, along the tangent: the slip for which the rows were made
  double gain = 1;                         ///< factor of the next change of `slip`
  double last_missing = 0, last_step = 0;  ///< m/s: what `slip` missed before its last change; that change
  bool guided = false;                     ///< joints connect the bodies, by way of others or the ground
  bool released = false;                   ///< has no impulse, to find the slip without it
  double held_slip = 0;                    ///< m/s, before it was released
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

/// Energies of the contact impulses of an island in a substep, J (islands/contact_gains.h).
struct ContactEnergy {
  double work = 0;      ///< of the impulses on the velocities before them
  double own = 0;       ///< twice the energy of the velocities that they cause
  double allowed = 0;   ///< by which the island's energy may grow
  double fraction = 1;  ///< of the impulses, that is kept
};

/// Islands, which are kept while no contact or joint changes, and data of their solution within a step.
template <class Real>
struct IslandScratch {
  explicit IslandScratch(std::pmr::memory_resource* memory) : open_mechanism(memory) {}

  std::vector<int> island_of, island_size, island_index, max_island_rows, near_rows, near_contacts;
  std::vector<int> link_of;  ///< by body: index among the links of its island
  std::vector<Real> lightest, heaviest;
  std::vector<int> island_joints, island_bounded_rows;
  std::vector<DirectIsland<Real>> direct_islands;  ///< `direct_count` are in use
  int direct_count = 0;
  std::vector<JointedIsland<Real>> jointed_islands;  ///< `jointed_count` are in use
  int jointed_count = 0;
  std::vector<char> open_joints;       ///< by slot of the joint: joint_gaps.cpp
  JointedIsland<Real> open_mechanism;  ///< a mechanism whose gaps are being closed
  bool islands_known = false;          ///< `island_of` and `island_size` are up to date
  bool has_direct_islands = false, has_crowded_islands = false;  ///< direct_islands.cpp
  HingeTrees<Real> trees;
  std::vector<int> tree_root_of, link_index;    ///< by body, while trees are found and loaded
  std::vector<char> not_a_tree, tree_grounded;  ///< the same, by representative of a set
  std::vector<char> joints_in_islands;          ///< by the joint's slot: solved with its island
  std::vector<double> contact_gains;            ///< by root: J, twice what a substep's contacts gave too much
  std::vector<ContactEnergy> contact_energy;    ///< by root
  std::vector<char> is_driven;                  ///< by root: gets energy from others than its contacts
  bool driven_known = false;                    ///< `is_driven` is up to date
  bool bounds_gains = false;                    ///< contact_gains.h: something moves in this step
};

}  // namespace plumb
