#pragma once

#include <string>
#include <vector>

#include "harness/hunt/objection.h"

namespace plumb::harness::hunt {

/// A second run that has to go like the first: as another looks at it, or as another engine runs it.
struct Relation {
  std::string name{};
  bool (*applies)(const Case& one, const Engine& engine);
  Verdict (*judge)(const Case& one, const Engine& engine, const Motion& motion);
};

const std::vector<Relation>& relations();

Verdict precise_relation(const Case& one, const Engine& engine, const Motion& motion);
Verdict jury_relation(const Case& one, const Engine& engine, const Motion& motion);

/// How far two motions are apart at each sample, m: of the dynamic body that is the farthest off, with its
/// turn times its reach.
std::vector<double> apart(const Case& one, const Motion& a, const Motion& b);

/// How far perturbations of 1e-6 have grown by each sample, m: the largest of three and of all samples
/// before. Short where a run broke off.
std::vector<double> growth(const Case& one, const Engine& engine, const Motion& motion);

}  // namespace plumb::harness::hunt
