#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "engine/core/block_lists.h"
#include "engine/world/contact_solver/contact_constraint.h"

namespace plumb {

/// A contact with a predicted impact in free flight in this step, with restitution.
template <class Real>
struct ExpectedImpact {
  ContactConstraint<Real> constraint;
  bool in_graph = false;  ///< it had points before; else it gets them if the solver takes it
  bool left_to_solver = false;
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

/// Data of the update of contacts within a step.
template <class Real>
struct NarrowPhaseScratch {
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
      separating_faces;                ///< by contact without points: the face that separates its shapes
  std::vector<int> bounce_candidates;  ///< contacts with restitution, or possibly of discs that approach fast
  std::vector<int> woken_contacts;     ///< contacts of bodies that woke in the step
  BlockLists<int> found_turning;       ///< see next; by block
  std::vector<int> turning_contacts;   ///< contacts whose points change within the step
  std::vector<ExpectedImpact<Real>> expected_impacts;
  std::vector<int> loaded_bodies;  ///< bodies that contacts or joints will load in this step
  std::vector<int> impact_bodies;
  std::vector<char> is_loaded,
      expects_impact;  ///< by body: true if it is in that list; all 0 if the list is empty
};

}  // namespace plumb
