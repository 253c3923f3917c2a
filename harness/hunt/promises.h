#pragma once

#include <vector>

#include "harness/hunt/relations.h"

namespace plumb::harness::hunt {

/// Returns the promises that the engine's interface makes of any scene: runs in a guise that keep every bit.
/// Judged like relations.
const std::vector<Relation>& promises();

// Random calls between the steps of a world.
Verdict life(const Case& one, const Engine& engine, const Motion& motion);
Verdict twins(const Case& one, const Engine& engine, const Motion& motion);

// Wind on each shape, of a World.
Verdict wind(const Case& one, const Engine& engine, const Motion& motion);

// Formulas, of any engine that has them.
Verdict formulas(const Case& one, const Engine& engine, const Motion& motion);

// The promises of Simulations; those of Worlds are guises.
Verdict simulation_restored(const Case& one, const Engine& engine, const Motion& motion);
Verdict simulation_stages(const Case& one, const Engine& engine, const Motion& motion);
Verdict simulation_stops(const Case& one, const Engine& engine, const Motion& motion);
Verdict simulation_overrun(const Case& one, const Engine& engine, const Motion& motion);

}  // namespace plumb::harness::hunt
