#include "harness/hunt/examine.h"

#include "harness/hunt/relations.h"

namespace plumb::harness::hunt {

std::vector<std::string> judge_names() {
  std::vector<std::string> out;
  for (const Law& law : laws()) out.push_back(law.name);
  for (const Relation& relation : relations()) out.push_back(relation.name);
  return out;
}

Examined examine(const Engine& engine, const Case& one, const std::string& law) {
  Examined out;
  out.skipped = unsupported(engine, one);
  if (!out.skipped.empty()) return out;
  const Motion motion = run(engine, one);
  if (motion.samples.empty() && motion.failure.empty()) {
    out.skipped = motion.stopped.empty() ? "it takes too long" : motion.stopped;
    return out;
  }
  for (const Law& each : laws()) {
    if (!law.empty() && each.name != law) continue;
    Verdict verdict = each.judge(one, engine, motion);
    if (!verdict) continue;
    verdict->law = each.name;
    out.objections.push_back(std::move(*verdict));
    // A run that broke off is not checked against the other laws.
    if (each.name == "finite") return out;
  }
  // Check two of the relations per scene, in turn, because each costs a run or more. A run that broke a law
  // is already known to be wrong.
  const std::size_t count = relations().size();
  for (std::size_t i = 0; i < count; ++i) {
    const Relation& each = relations()[i];
    const bool due = law.empty() && out.objections.empty() &&
                     (i == one.index % count || i == (one.index / count + one.index + 1) % count);
    if (!(due || each.name == law) || !each.applies(one, engine)) continue;
    if (Verdict verdict = each.judge(one, engine, motion)) out.objections.push_back(std::move(*verdict));
  }
  return out;
}

}  // namespace plumb::harness::hunt
