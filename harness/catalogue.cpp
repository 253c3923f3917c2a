#include "harness/catalogue.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include <fmt/format.h>

#include "harness/needs.h"
#include "harness/scene_picture.h"

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

std::string capitalised(std::string text) {
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

// Escapes `text` for a cell of a table.
std::string in_cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2))
    text.insert(at, "\\");
  return text;
}

// Returns the name of the picture of a case. The picture represents its scenario in its topic.
std::string picture_name(const CatalogueEntry& entry) {
  std::string name = entry.instance.label();
  std::erase(name, ']');
  std::ranges::replace_if(
      name, [](char c) { return c == '/' || c == '['; }, '_');
  return name + ".svg";
}

bool starts_section(const CatalogueEntry* before, const CatalogueEntry& entry) {
  return before == nullptr || before->instance.scenario != entry.instance.scenario ||
         before->topic != entry.topic;
}

/// Notes of a page, numbered in the order of their first use.
struct Notes {
  std::vector<std::string> all{};
  std::size_t number_of(const std::string& text) {
    const auto found = std::ranges::find(all, text);
    if (found != all.end()) return static_cast<std::size_t>(found - all.begin()) + 1;
    all.push_back(text);
    return all.size();
  }
};

std::string agreeing_cell(const Agreement& one) {
  std::string names;
  for (const std::string& engine : one.agree) names += (names.empty() ? ": " : ", ") + engine;
  return fmt::format("{} of {}{}", one.agree.size(), one.ran(), names);
}

// Lists the engines that miss: the check with the largest miss, with how many other engines each agrees, and
// the reason.
std::string missing_cell(const Agreement& one, Notes& reasons) {
  std::string out;
  for (const Dissent& dissent : one.dissents) {
    out += (out.empty() ? "" : "; ") + dissent.engine + ": ";
    out += dissent.misses.empty()
               ? "diverges"
               : fmt::format("{} {} ({})", dissent.misses.front().check, figure(dissent.misses.front().value),
                             times_text(dissent.misses.front()));
    out += fmt::format(", agrees with {} of {} others [{}](#reasons)", one.partners(dissent.engine).size(),
                       one.ran() - 1, reasons.number_of(dissent.reason));
  }
  return out;
}

bool passes(const CatalogueEntry& entry, const CatalogueFilter& filter) {
  if (!filter.truth.empty() && filter.truth != name_of(entry.kind)) return false;
  for (const std::string& need : filter.needs)
    if (std::ranges::find(entry.needs, need) == entry.needs.end()) return false;
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
      CatalogueEntry entry{instance, topic_of(problem), problem.truth.kind, problem.truth.source,
                           needs_of(problem.scene)};
      if (passes(entry, filter)) entries.push_back(std::move(entry));
    }
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const CatalogueEntry& a, const CatalogueEntry& b) { return a.topic < b.topic; });
  return entries;
}

std::map<std::string, std::string> catalogue_pictures() {
  std::map<std::string, std::string> out;
  const std::vector<CatalogueEntry> entries = catalogue();
  const CatalogueEntry* before = nullptr;
  for (const CatalogueEntry& entry : entries) {
    if (starts_section(before, entry))
      out[picture_name(entry)] = scene_picture(entry.instance.build(), entry.instance.label());
    before = &entry;
  }
  return out;
}

std::string catalogue_page(std::span<const Agreement> agreement) {
  std::map<std::string, const Agreement*> by_label;
  std::vector<std::string> versions;
  for (const Agreement& one : agreement) {
    by_label[one.label] = &one;
    for (const std::string& version : one.versions)
      if (std::ranges::find(versions, version) == versions.end()) versions.push_back(version);
  }
  std::string engines;
  for (const std::string& version : versions) engines += (engines.empty() ? "" : ", ") + version;
  const std::vector<CatalogueEntry> entries = catalogue();
  std::string page =
      fmt::format(R"(# Scenarios

{} cases in {} files, each with an answer that no engine computed. `plumb compare NAME` runs one on every engine;
`plumb list --filter TEXT --truth KIND --needs NAME` searches them. The truth is a `closed_form`, the equations of
motion in independent coordinates, `integrated` to about 15 digits, or an `equilibrium` by statics. A picture shows
the start dashed, the end filled, and the true paths between.

An engine *agrees* if each of its checks is within its derived bound ([which](formats.md#checks)), at dt = 1/60 s and
default settings. For every other engine the table lists the check that exceeds its bound by the largest factor, the
number of other engines that it agrees with (within the sum of both bounds), and [the reason](#reasons). The results are
of {}.

`plumb list --page docs/agreement.jsonl` generates this page, and `--pictures docs/pictures/scenarios` its pictures; a
test compares both with the scenarios. Which engines agree comes from the results of these commands:

```sh
plumb compare --engine all --no-cost --out all        # after plumb engines --install, for those from npm
plumb agreement all --without '*-default' --format json > docs/agreement.jsonl
```
)",
                  entries.size(), scenarios::all().size(), engines.empty() ? "no engine" : engines);
  Notes reasons;
  const CatalogueEntry* before = nullptr;
  for (const CatalogueEntry& entry : entries) {
    if (before == nullptr || before->topic != entry.topic) {
      page += fmt::format("\n## {}\n", capitalised(std::string(name_of(entry.topic))));
    }
    if (starts_section(before, entry)) {
      std::set<std::string> needed;
      for (const CatalogueEntry& other : entries)
        if (!starts_section(&entry, other)) needed.insert(other.needs.begin(), other.needs.end());
      std::string needs;
      for (const std::string& name : all_needs())
        if (needed.contains(name)) needs += (needs.empty() ? "" : ", ") + name;
      page += fmt::format(
          "\n### {0}\n\n{4}. Needs: {2}.\n\n![{1}](pictures/scenarios/{3})\n\n"
          "| case | truth | source | engines that agree | engines that miss a bound "
          "|\n|---|---|---|---|---|\n",
          entry.instance.scenario->name, entry.instance.scenario->summary,
          needs.empty() ? "gravity alone" : needs, picture_name(entry),
          capitalised(entry.instance.scenario->summary));
    }
    const auto found = by_label.find(entry.instance.label());
    page += fmt::format("| `{}` | {} | {} | {} | {} |\n", entry.instance.label(), name_of(entry.kind),
                        in_cell(entry.source), found == by_label.end() ? "" : agreeing_cell(*found->second),
                        found == by_label.end() ? "" : in_cell(missing_cell(*found->second, reasons)));
    before = &entry;
  }
  page += "\n## Reasons\n\n";
  for (std::size_t i = 0; i < reasons.all.size(); ++i) page += fmt::format("{}. {}\n", i + 1, reasons.all[i]);
  return page;
}

}  // namespace plumb::harness
