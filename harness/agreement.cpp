#include "harness/agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "harness/compare.h"
#include "harness/verdict.h"

namespace plumb::harness {
namespace {

constexpr std::string_view kNoReason = "no reason is declared";

bool same(const reference::StepSettings& a, const reference::StepSettings& b) {
  return a.dt == b.dt && a.substeps == b.substeps && a.tolerance == b.tolerance && a.options == b.options;
}

// Returns the results of one case that are compared with each other, one per engine.
std::vector<const Result*> comparable(const std::vector<const Result*>& all) {
  const auto standard = std::ranges::find_if(all, [](const Result* r) { return is_default(r->asked); });
  const Result* like = standard == all.end() ? all.front() : *standard;
  std::vector<const Result*> out;
  for (const Result* result : all) {
    if (!same(result->asked, like->asked)) continue;
    const auto before =
        std::ranges::find_if(out, [&](const Result* other) { return other->engine == result->engine; });
    if (before == out.end()) {
      out.push_back(result);
    } else {
      *before = result;
    }
  }
  return out;
}

Dissent dissent_of(const Result& result) {
  Dissent out{.engine = result.engine, .misses = {}, .reason = {}};
  std::vector<std::string> reasons;
  for (const Check& check : result.checks) {
    if (check.pass) continue;
    out.misses.push_back({check.name, check.value, check.tolerance});
    const std::string reason = check.known_limit.empty() ? std::string(kNoReason) : check.known_limit;
    if (std::ranges::find(reasons, reason) == reasons.end()) reasons.push_back(reason);
  }
  std::ranges::stable_sort(out.misses, [](const Miss& a, const Miss& b) { return a.times() > b.times(); });
  if (out.misses.empty()) reasons.push_back("it diverged: " + result.reason);
  for (const std::string& reason : reasons) out.reason += (out.reason.empty() ? "" : " ") + reason;
  return out;
}

/// Finds the maximal cliques of a graph. Source: Bron and Kerbosch 1973, algorithm 2, with Tomita's pivot; a
/// case has few engines.
class Cliques {
 public:
  explicit Cliques(const std::map<std::string, std::set<std::string>>& neighbours) : neighbours_(neighbours) {
    std::set<std::string> all;
    for (const auto& [name, others] : neighbours) all.insert(name);
    expand({}, std::move(all), {});
  }

  std::vector<std::set<std::string>> found;

 private:
  using Set = std::set<std::string>;

  Set shared(const Set& of, const std::string& name) const {
    Set out;
    for (const std::string& other : of)
      if (neighbours_.at(name).contains(other)) out.insert(other);
    return out;
  }

  void expand(const Set& clique, Set candidates, Set done) {
    if (candidates.empty() && done.empty()) {
      if (clique.size() >= 2) found.push_back(clique);
      return;
    }
    std::string pivot;
    std::size_t most = 0;
    for (const Set* set : {&candidates, &done})
      for (const std::string& name : *set)
        if (const std::size_t count = shared(candidates, name).size(); pivot.empty() || count > most)
          pivot = name, most = count;
    const Set tried = candidates;
    for (const std::string& name : tried) {
      if (neighbours_.at(pivot).contains(name)) continue;
      Set larger = clique;
      larger.insert(name);
      expand(larger, shared(candidates, name), shared(done, name));
      candidates.erase(name);
      done.insert(name);
    }
  }

  const std::map<std::string, Set>& neighbours_;
};

// Returns the largest sets of engines that agree with each other, the largest first, names as in `runs`.
std::vector<std::vector<std::string>> groups_of(const std::vector<const Result*>& runs) {
  std::map<std::string, std::set<std::string>> neighbours;
  for (const Result* run : runs) neighbours[run->engine];
  for (const Result* run : runs)
    for (const std::string& other : run->agrees_with)
      if (neighbours.contains(other))
        neighbours[run->engine].insert(other), neighbours[other].insert(run->engine);
  std::vector<std::vector<std::string>> out;
  for (const std::set<std::string>& clique : Cliques(neighbours).found) {
    std::vector<std::string>& names = out.emplace_back();
    for (const Result* run : runs)
      if (clique.contains(run->engine)) names.push_back(run->engine);
  }
  std::ranges::stable_sort(out, [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return out;
}

}  // namespace

double Miss::times() const {
  const double ratio = value / bound;
  return std::isfinite(ratio) ? ratio : std::numeric_limits<double>::infinity();
}

std::vector<std::string> Agreement::partners(std::string_view engine) const {
  std::vector<std::string> out;
  for (const std::vector<std::string>& group : groups) {
    if (std::ranges::find(group, engine) == group.end()) continue;
    for (const std::string& other : group)
      if (other != engine && std::ranges::find(out, other) == out.end()) out.push_back(other);
  }
  return out;
}

std::vector<Agreement> agreements(std::span<const Result> results) {
  std::vector<std::string> labels;
  std::map<std::string, std::vector<const Result*>> cases;
  for (const Result& result : results) {
    std::vector<const Result*>& list = cases[result.label];
    if (list.empty()) labels.push_back(result.label);
    list.push_back(&result);
  }
  std::vector<Agreement> out;
  for (const std::string& label : labels) {
    Agreement one{
        .label = label, .truth = "", .versions = {}, .agree = {}, .dissents = {}, .absent = {}, .groups = {}};
    std::vector<const Result*> ran;
    for (const Result* result : comparable(cases[label])) {
      if (one.truth.empty()) one.truth = result->truth;
      switch (ruling_on(*result)) {
        case Ruling::Agrees:
          one.agree.push_back(result->engine);
          ran.push_back(result);
          break;
        case Ruling::Misses:
          one.dissents.push_back(dissent_of(*result));
          ran.push_back(result);
          break;
        case Ruling::Broke:
          one.absent.push_back({result->engine, result->reason, true});
          break;
        case Ruling::Unsupported:
        case Ruling::NotReached:
          one.absent.push_back({result->engine, result->reason, false});
          break;
      }
    }
    one.groups = groups_of(ran);
    for (const Result* result : ran) one.versions.push_back(result->engine + " " + result->engine_version);
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace plumb::harness
