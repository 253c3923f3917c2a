#pragma once

#include <functional>
#include <string>
#include <vector>

#include "harness/hunt/relations.h"

namespace plumb::harness::hunt {

/// Returns the checks of guarantees of the engine's interface that hold for any scene: run modes in which all
/// results must be bit-identical. They are evaluated like relations.
const std::vector<Relation>& promises();

/// Returns the text of `check`, or an empty one if it throws `Error`: a rejected run is not judged.
std::string checked(const std::function<std::string()>& check);

/// Does the same in a separate process, which Precise needs because it may take arbitrarily long. Returns an
/// empty text after 2 s of processor time.
std::string checked_apart(const std::function<std::string()>& check);

// Judges random calls between the steps of a world.
Verdict life(const Case& one, const Engine& engine, const Motion& motion);
Verdict twins(const Case& one, const Engine& engine, const Motion& motion);

// Judges the wind on each shape of a World.
Verdict wind(const Case& one, const Engine& engine, const Motion& motion);

// Judges formulas, for any engine that supports them.
Verdict formulas(const Case& one, const Engine& engine, const Motion& motion);

// Judges linear systems, for any engine that solves them.
Verdict systems(const Case& one, const Engine& engine, const Motion& motion);

// Parts of a World: tampered snapshots, shared loops, monitors, and methods of integration.
Verdict damaged(const Case& one, const Engine& engine, const Motion& motion);
Verdict loops(const Case& one, const Engine& engine, const Motion& motion);
Verdict monitors(const Case& one, const Engine& engine, const Motion& motion);
Verdict integrators(const Case& one, const Engine& engine, const Motion& motion);

// Promises of Precise beyond its motion.
bool on_precise(const Case& one, const Engine& engine);
Verdict forces(const Case& one, const Engine& engine, const Motion& motion);
Verdict derivatives(const Case& one, const Engine& engine, const Motion& motion);
Verdict estimates(const Case& one, const Engine& engine, const Motion& motion);
Verdict starts(const Case& one, const Engine& engine, const Motion& motion);
Verdict methods(const Case& one, const Engine& engine, const Motion& motion);

// Judges small scenes with impacts, of Precise (also with friction, motors and limits) and of a World.
Verdict blows(const Case& one, const Engine& engine, const Motion& motion);
Verdict strikes(const Case& one, const Engine& engine, const Motion& motion);

// Judges promises of Simulations; those of Worlds are run modes.
Verdict simulation_restored(const Case& one, const Engine& engine, const Motion& motion);
Verdict simulation_stages(const Case& one, const Engine& engine, const Motion& motion);
Verdict simulation_stops(const Case& one, const Engine& engine, const Motion& motion);
Verdict simulation_overrun(const Case& one, const Engine& engine, const Motion& motion);

}  // namespace plumb::harness::hunt
