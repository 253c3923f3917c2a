#include "harness/hunt/examine.h"

#include <set>

#include "harness/hunt/case_seeds.h"
#include "harness/hunt/promises.h"
#include "harness/hunt/relations.h"

namespace plumb::harness::hunt {

namespace {

// Returns true for judges that run on every scene to which they apply, because they cost no more than the run
// itself or because these scenes were drawn for them.
bool is_always_due(const std::string& name) {
  static const std::set<std::string> cheap{"life",        "twins",   "collisions",  "integrated", "formulas",
                                           "wind",        "systems", "as_formulas", "damaged",    "loops",
                                           "integrators", "strikes", "monitors",    "queries",    "blows"};
  return cheap.contains(name);
}

// Checks the relations that are due in every scene, and two of the others in turn, because each costs a run
// or more. If `law` names one, checks only that.
void check_some(const std::vector<Relation>& relations, const Engine& engine, const Case& one,
                const std::string& law, const Motion& motion, Examined& out) {
  std::vector<const Relation*> apply;
  for (const Relation& each : relations) {
    if ((!law.empty() && each.name != law) || !each.applies(one, engine)) continue;
    if (law.empty() && is_always_due(each.name)) {
      if (Verdict verdict = each.judge(one, engine, motion)) out.objections.push_back(std::move(*verdict));
    } else {
      apply.push_back(&each);
    }
  }
  const std::size_t count = apply.size();
  for (std::size_t i = 0; i < count; ++i) {
    const bool due = i == one.index % count || i == (one.index / count + one.index + 1) % count;
    if (!due && law.empty()) continue;
    if (Verdict verdict = apply[i]->judge(one, engine, motion)) out.objections.push_back(std::move(*verdict));
  }
}

}  // namespace

std::vector<std::string> judge_names() {
  std::vector<std::string> out{"case_file"};
  for (const Law& law : laws()) out.push_back(law.name);
  for (const auto* list : {&relations(), &promises()})
    for (const Relation& relation : *list) out.push_back(relation.name);
  return out;
}

Examined examine(const Engine& engine, const Case& one, const std::string& law) {
  Examined out;
  out.skipped = unsupported(engine, one);
  if (!out.skipped.empty()) return out;
  if (law.empty() || law == "case_file")
    if (Verdict verdict = case_file_verdict(one, engine)) out.objections.push_back(std::move(*verdict));
  if (law == "case_file") return out;
  const Motion motion = run(engine, one);
  if (motion.samples.empty() && motion.failure.empty()) {
    out.skipped = motion.stopped.empty() ? "it exceeded the time limit" : motion.stopped;
    return out;
  }
  for (const Law& each : laws()) {
    if (!law.empty() && each.name != law) continue;
    Verdict verdict = each.judge(one, engine, motion);
    if (!verdict) continue;
    verdict->law = each.name;
    out.objections.push_back(std::move(*verdict));
    // A run that ended early is not checked against the other laws.
    if (each.name == "finite") return out;
  }
  // A run that broke a law is already known to be wrong, so the relations are not checked. Promises must hold
  // for wrong motions as well.
  if (!law.empty() || out.objections.empty()) check_some(relations(), engine, one, law, motion, out);
  check_some(promises(), engine, one, law, motion, out);
  return out;
}

}  // namespace plumb::harness::hunt
