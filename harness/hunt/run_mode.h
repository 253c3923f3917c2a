#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/world/world.h"

/// Ways to run a world that must not change its motion, and the digests by which runs are compared.
namespace plumb::harness::hunt {

enum class RunMode : std::uint8_t {
  Plain,
  Restored,    ///< saved, and restored into a world of other settings with other bodies in it
  RolledBack,  ///< repeatedly steps ahead and rolls back
  Threaded,    ///< by two threads, which run all loops in parallel
  Scalar,      ///< without vector registers
  Narrow,      ///< with vector registers of 16 bytes
  Observed,    ///< read, queried, saved and monitored after each step
  Refused,     ///< with calls between the steps that must be refused
  Overrun,     ///< with a body that exceeds the world's limits after half of the steps
  Asked,       ///< with queries whose results are compared with the shapes' outlines
  Labelled,    ///< with other names and user data, and hit events
};

/// Digests of a world after a step.
struct Digest {
  std::uint64_t whole = 0;    ///< of all data in a snapshot
  std::uint64_t visible = 0;  ///< of the bodies' states, and the joints' and contacts' readings
  std::uint64_t events = 0;   ///< of the step
  friend bool operator==(const Digest&, const Digest&) = default;
};

template <class Real>
Digest digest_of(const BasicWorld<Real>& world);

/// Returns settings that all differ from those of `definition`.
WorldDefinition contrary(const WorldDefinition& definition);

/// Puts bodies, a joint and a force into a world and steps it, so that restoring has something to replace.
template <class Real>
void populate(BasicWorld<Real>& world);

/// Makes the calls that only read a world: queries, readings, definitions, snapshots.
template <class Real>
void read_everything(const BasicWorld<Real>& world);

/// Gives bodies and shapes other names and user data, and switches on their hit events.
template <class Real>
void label(BasicWorld<Real>& world);

/// Makes calls with numbers out of range and invalid handles. Returns those that were not rejected with the
/// right kind of error, or that changed the world; empty if there are none.
template <class Real>
std::string not_refused(BasicWorld<Real>& world);

/// Pushes a body beyond the world's largest speed. Returns the resulting error, or an empty text. The world
/// must not be used afterwards.
template <class Real>
std::string overrun(BasicWorld<Real>& world, double dt, int substeps);

}  // namespace plumb::harness::hunt
