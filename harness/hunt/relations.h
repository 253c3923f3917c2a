#pragma once

#include <string>
#include <vector>

#include "harness/hunt/objection.h"

namespace plumb::harness::hunt {

/// A second run that must agree with the first: the scene transformed, or another engine.
struct Relation {
  std::string name{};
  bool (*applies)(const Case& one, const Engine& engine);
  Verdict (*judge)(const Case& one, const Engine& engine, const Motion& motion);
};

const std::vector<Relation>& relations();

Verdict precise_relation(const Case& one, const Engine& engine, const Motion& motion);
Verdict jury_relation(const Case& one, const Engine& engine, const Motion& motion);
Verdict integrated_relation(const Case& one, const Engine& engine, const Motion& motion);
Verdict collisions_relation(const Case& one, const Engine& engine, const Motion& motion);

/// Returns true if the harness itself can integrate the motion up to the first contact: there are forces,
/// but no joints or locks.
bool integrable(const Case& one);

Verdict as_formulas_relation(const Case& one, const Engine& engine, const Motion& motion);
/// Returns true if all force laws of a case can be written as formulas, and there are some.
bool has_laws_as_formulas(const Case& one, const Engine& engine);

/// Returns true if the harness can compute the collisions of the bodies: discs without friction or gravity.
bool are_smooth_discs(const Case& one);

/// Returns the distance of two motions at each sample, m: that of the dynamic body that is farthest off,
/// including its rotation times its extent.
std::vector<double> apart(const Case& one, const Motion& a, const Motion& b);

/// Returns the effect of perturbations up to each sample, m: the largest of three (two of 1e-6 and one of
/// 3e-5 of the sizes) and of all samples before. Shorter if a run broke off.
std::vector<double> growth(const Case& one, const Engine& engine, const Motion& motion);

}  // namespace plumb::harness::hunt
