#include "harness/cluster/next_round.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

namespace plumb::harness::cluster {
namespace {

/// Collects the results of a unit and its repetitions.
struct Attempts {
  std::vector<const Done*> done;
  int planned = 0;  ///< repetitions
};

std::map<int, Attempts> attempts_of(const Plan& plan, const Survey& survey) {
  std::map<int, const Done*> done;
  for (const Done& one : survey.done) done[one.number] = &one;
  std::map<int, Attempts> out;
  for (const Unit& unit : plan.units) {
    Attempts& attempts = out[unit.repeats > 0 ? unit.repeats : unit.number];
    if (unit.repeats > 0) ++attempts.planned;
    if (const auto found = done.find(unit.number); found != done.end())
      attempts.done.push_back(found->second);
  }
  return out;
}

const Done* quietest(const std::vector<const Done*>& done) {
  const Done* best = nullptr;
  for (const Done* one : done) {
    if (!one->noisy()) return one;
    if (best == nullptr || one->noise() < best->noise()) best = one;
  }
  return best;
}

// Adds the units that were disturbed each time.
void add_repetitions(const Plan& plan, const Survey& survey, NextRound& out) {
  for (const auto& [number, attempts] : attempts_of(plan, survey)) {
    const Unit& unit = plan.unit(number);
    const Done* best = quietest(attempts.done);
    const bool all_done = static_cast<int>(attempts.done.size()) == attempts.planned + 1;
    if (!unit.cost || !all_done || !best->noisy() || attempts.planned + 1 >= kAttempts) continue;
    Unit again = unit;
    again.number = 0;
    again.repeats = number;
    again.attempt = attempts.planned + 1;
    again.seconds = best->seconds;
    again.measured = true;
    std::set<std::string> hosts;
    for (const Done* one : attempts.done) hosts.insert(one->machine.host);
    again.avoid.assign(hosts.begin(), hosts.end());
    out.units.push_back(std::move(again));
    ++out.again;
  }
}

std::set<int> given_up(const std::string& folder, const Survey& survey) {
  std::set<int> out;
  for (const auto& [kind, numbers] : survey.failed)
    for (const int number : numbers)
      if (read_failure(folder, number).value_or(Failure{}).attempts >= kAttempts) out.insert(number);
  return out;
}

// Adds the units whose predecessors have all ended.
void add_further(const std::string& folder, const Plan& plan, const Survey& survey, NextRound& out) {
  std::set<int> done, over = given_up(folder, survey);
  for (const Done& one : survey.done) done.insert(one.number);
  over.insert(done.begin(), done.end());
  std::vector<std::vector<std::string>> order;
  std::map<std::vector<std::string>, std::vector<const Unit*>> groups;
  for (const Unit& unit : plan.units) {
    if (unit.then.empty() || unit.repeats > 0) continue;
    if (!groups.contains(unit.then)) order.push_back(unit.then);
    groups[unit.then].push_back(&unit);
  }
  std::set<std::vector<std::string>> there;
  for (const Unit& unit : plan.units) there.insert(unit.arguments);
  for (const std::vector<std::string>& then : order) {
    const std::vector<const Unit*>& units = groups[then];
    if (!std::all_of(units.begin(), units.end(),
                     [&](const Unit* unit) { return over.contains(unit->number); }))
      continue;
    Unit next{.number = 0,
              .arguments = then,
              .seconds = units.front()->then_seconds,
              .measured = false,
              .cost = true};
    for (const Unit* unit : units) {
      if (done.contains(unit->number))
        next.arguments.insert(next.arguments.end(),
                              {"--from", "{folder}/done/" + name_of_unit(unit->number)});
    }
    if (there.contains(next.arguments)) continue;
    out.units.push_back(std::move(next));
    ++out.further;
  }
}

}  // namespace

NextRound next_round(const std::string& folder, const Plan& plan, const Survey& survey) {
  NextRound out;
  add_further(folder, plan, survey, out);
  add_repetitions(plan, survey, out);
  return out;
}

std::map<int, const Done*> least_disturbed(const Plan& plan, const Survey& survey) {
  std::map<int, const Done*> out;
  for (const auto& [number, attempts] : attempts_of(plan, survey))
    if (const Done* best = quietest(attempts.done); best != nullptr) out[number] = best;
  return out;
}

}  // namespace plumb::harness::cluster
