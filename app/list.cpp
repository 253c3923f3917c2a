#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/selection.h"
#include "app/usage.h"
#include "harness/case_file/case_file.h"
#include "harness/catalogue.h"
#include "harness/known_limits_page.h"
#include "harness/needs.h"
#include "harness/style.h"
#include "harness/text_file.h"
#include "scenarios/scenario.h"

namespace plumb::app {
namespace {

using harness::CatalogueEntry;
using harness::CatalogueFilter;
using harness::Style;
using scenarios::Scenario;

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (const std::string& part : parts) out += (out.empty() ? "" : ", ") + part;
  return out;
}

std::string sizes_text(const Scenario& scenario) {
  std::vector<std::string> sizes;
  for (const int size : scenario.sizes) sizes.push_back(std::to_string(size));
  return joined(sizes);
}

// Lists scenarios by topic, each with its variants and sizes that pass the filter.
std::string as_text(const CatalogueFilter& filter, const Style& style) {
  std::string out;
  const CatalogueEntry* before = nullptr;
  const std::vector<CatalogueEntry> entries = harness::catalogue(filter);
  for (std::size_t i = 0; i < entries.size(); before = &entries[i++]) {
    const CatalogueEntry& entry = entries[i];
    const Scenario& scenario = *entry.instance.scenario;
    if (before != nullptr && before->instance.scenario == &scenario && before->topic == entry.topic) continue;
    if (before == nullptr || before->topic != entry.topic)
      out += fmt::format("{}{}\n", before == nullptr ? "" : "\n",
                         style.paint(harness::name_of(entry.topic), Style::Ink::Dim));
    std::vector<std::string> variants;
    for (std::size_t k = i; k < entries.size() && entries[k].topic == entry.topic; ++k)
      if (entries[k].instance.scenario == &scenario &&
          std::find(variants.begin(), variants.end(), entries[k].instance.variant) == variants.end())
        variants.push_back(entries[k].instance.variant);
    out += style.paint(scenario.name, Style::Ink::Bold) + "\n";
    out += "  " + harness::wrap(scenario.summary, style.width - 2, 2) + "\n";
    if (scenario.variants.size() > 1)
      out += "  " + harness::wrap("variants: " + joined(variants), style.width - 2, 12) + "\n";
    std::vector<std::string> needs;
    for (const std::string& name : harness::all_needs())
      for (std::size_t k = i; k < entries.size() && entries[k].topic == entry.topic; ++k)
        if (entries[k].instance.scenario == &scenario &&
            std::ranges::find(entries[k].needs, name) != entries[k].needs.end()) {
          needs.push_back(name);
          break;
        }
    if (!needs.empty()) out += "  " + harness::wrap("needs: " + joined(needs), style.width - 2, 9) + "\n";
    if (scenario.scales)
      out += "  " + harness::wrap("sizes: " + sizes_text(scenario) + ", or any", style.width - 2, 9) + "\n";
  }
  return out;
}

std::string as_json(const CatalogueFilter& filter) {
  using Json = nlohmann::ordered_json;
  Json out = Json::array();
  const std::vector<CatalogueEntry> entries = harness::catalogue(filter);
  for (const Scenario& scenario : scenarios::all()) {
    Json cases = Json::array();
    for (const CatalogueEntry& entry : entries)
      if (entry.instance.scenario == &scenario)
        cases.push_back({{"label", entry.instance.label()},
                         {"topic", harness::name_of(entry.topic)},
                         {"truth", harness::name_of(entry.kind)},
                         {"source", entry.source},
                         {"needs", entry.needs}});
    if (cases.empty()) continue;
    out.push_back({{"name", scenario.name},
                   {"summary", scenario.summary},
                   {"variants", scenario.variants},
                   {"sizes", scenario.sizes},
                   {"scales", scenario.scales},
                   {"cases", cases}});
  }
  return out.dump(2) + "\n";
}

// Lists case files with their expectations.
std::string cases_as_text(const std::vector<std::string>& names, const Style& style) {
  std::string out;
  for (const std::string& name : names) {
    const std::vector<std::string> files = case_files(name);
    if (files.empty())
      throw UsageError(
          fmt::format("'{}' is neither a case file nor a folder of case files; see docs/cases.md", name));
    for (const std::string& file : files) {
      const harness::case_file::CaseFile read = harness::case_file::read_case(file);
      std::vector<std::string> expected;
      for (const scenarios::Expectation& expectation : read.problem.expected)
        expected.push_back(expectation.name);
      out += style.paint(read.name, Style::Ink::Bold) + "\n";
      for (const std::string& line :
           {read.summary, "expects: " + joined(expected), "source: " + read.problem.truth.source})
        out += "  " + harness::wrap(line, style.width - 2, 4) + "\n";
    }
  }
  return out;
}

}  // namespace

void add_list(CLI::App& app, Action& chosen) {
  struct Options {
    std::string format = "console";
    CatalogueFilter filter{};
    std::vector<std::string> files;
    std::string page, pictures;
    bool limits = false;
  };
  CLI::App* command =
      app.add_subcommand("list", "list the scenarios by topic, with their variants and sizes");
  auto options = std::make_shared<Options>();
  command->add_option("files", options->files, "list these case files and folders of case files instead")
      ->type_name("FILE|DIR");
  command->add_option("--format", options->format, "console or json")
      ->check(CLI::IsMember({"console", "json"}));
  command
      ->add_option("--filter", options->filter.text,
                   "only cases whose name, summary or source contains this text")
      ->type_name("TEXT");
  command->add_option("--truth", options->filter.truth, "only cases whose truth is of this kind")
      ->check(CLI::IsMember({"closed_form", "integrated", "equilibrium"}));
  command
      ->add_option("--needs", options->filter.needs,
                   "only cases that need all of these: kinds of shapes, joints and forces, and features")
      ->delimiter(',')
      ->check(CLI::IsMember(harness::all_needs()))
      ->type_name("NAME,...");
  command->add_flag("--known-limits", options->limits,
                    "print the bounds that engines are known to miss, as in docs/known-limits.md");
  command
      ->add_option("--page", options->page,
                   "print every case with its source and the engines that agree, as in docs/scenarios.md, "
                   "from a\nfile that `plumb agreement --format json` wrote")
      ->check(CLI::ExistingFile)
      ->type_name("FILE");
  command->add_option("--pictures", options->pictures, "draw each scenario as SVG into this folder")
      ->check(CLI::ExistingDirectory)
      ->type_name("DIR");
  command->footer(
      "Examples:\n  plumb list\n  plumb list --filter friction --truth closed_form\n"
      "  plumb list --needs contacts,restitution\n  plumb list --format json\n"
      "  plumb list --page docs/agreement.jsonl > docs/scenarios.md");
  command->callback([&chosen, options] {
    chosen = [options] {
      if (!options->files.empty()) {
        print(cases_as_text(options->files, Style::of_file(STDOUT_FILENO)));
      } else if (options->limits) {
        print(harness::known_limits_page());
      } else if (!options->pictures.empty()) {
        for (const auto& [name, text] : harness::catalogue_pictures())
          harness::write_whole((std::filesystem::path(options->pictures) / name).string(), text);
      } else if (!options->page.empty()) {
        print(harness::catalogue_page(harness::read_agreements(options->page)));
      } else if (options->format == "json") {
        print(as_json(options->filter));
      } else {
        const std::string text = as_text(options->filter, Style::of_file(STDOUT_FILENO));
        if (text.empty()) throw UsageError("no case matches; see `plumb list`");
        print(text);
      }
      return kOk;
    };
  });
}

}  // namespace plumb::app
