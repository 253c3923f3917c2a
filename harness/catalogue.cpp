#include "harness/catalogue.h"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace plumb::harness {
namespace {

using scenarios::Problem;
using scenarios::TruthKind;

Topic topic_of(const Problem& problem) {
  if (problem.truth.kind == TruthKind::Equilibrium) return Topic::Equilibrium;
  if (!problem.scene.joints.empty()) return Topic::Joints;
  if (problem.truth.contacts_last) return Topic::LastingContacts;
  if (!problem.truth.impacts.empty()) return Topic::Impacts;
  return problem.scene.forces.empty() ? Topic::FreeMotion : Topic::Forces;
}

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

// Escapes `text` for a cell of a table.
std::string in_cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2))
    text.insert(at, "\\");
  return text;
}

bool passes(const CatalogueEntry& entry, const CatalogueFilter& filter) {
  if (!filter.truth.empty() && filter.truth != name_of(entry.kind)) return false;
  const std::string all =
      entry.instance.label() + "\n" + entry.instance.scenario->summary + "\n" + entry.source;
  return lower(all).find(lower(filter.text)) != std::string::npos;
}

}  // namespace

std::string_view name_of(TruthKind kind) {
  constexpr std::string_view kNames[] = {"closed_form", "integrated", "equilibrium"};
  return kNames[static_cast<int>(kind)];
}

std::string_view name_of(Topic topic) {
  constexpr std::string_view kNames[] = {"free motion", "forces",           "joints",
                                         "impacts",     "lasting contacts", "equilibrium"};
  return kNames[static_cast<int>(topic)];
}

std::vector<CatalogueEntry> catalogue(const CatalogueFilter& filter) {
  std::vector<CatalogueEntry> entries;
  for (const scenarios::Scenario& scenario : scenarios::all()) {
    for (const scenarios::Instance& instance : scenarios::select(scenario.name)) {
      const Problem problem = instance.build();
      CatalogueEntry entry{instance, topic_of(problem), problem.truth.kind, problem.truth.source};
      if (passes(entry, filter)) entries.push_back(std::move(entry));
    }
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const CatalogueEntry& a, const CatalogueEntry& b) { return a.topic < b.topic; });
  return entries;
}

std::string catalogue_page() {
  const std::vector<CatalogueEntry> entries = catalogue();
  std::string page = fmt::format(R"(# Scenarios

{} cases in {} files, each with an answer that no engine computed. `plumb compare NAME` runs one on every engine;
`plumb list --filter TEXT --truth KIND` searches them. The truth is a `closed_form`, the equations of motion in
independent coordinates, `integrated` to about 15 digits, or an `equilibrium` by statics.

`plumb list --page` generates this page; a test compares it with the scenarios.
)",
                                 entries.size(), scenarios::all().size());
  const CatalogueEntry* before = nullptr;
  for (const CatalogueEntry& entry : entries) {
    if (before == nullptr || before->topic != entry.topic) {
      std::string heading(name_of(entry.topic));
      heading[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(heading[0])));
      page += fmt::format("\n## {}\n\n| case | what | truth | source |\n|---|---|---|---|\n", heading);
    }
    page += fmt::format("| `{}` | {} | {} | {} |\n", entry.instance.label(), entry.instance.scenario->summary,
                        name_of(entry.kind), in_cell(entry.source));
    before = &entry;
  }
  return page;
}

}  // namespace plumb::harness
