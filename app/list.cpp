#include <algorithm>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "harness/known_limits_page.h"
#include "harness/style.h"
#include "scenarios/scenario.h"

namespace plumb::app {
namespace {

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

std::string as_text(const Style& style) {
  std::string out;
  for (const Scenario& scenario : scenarios::all()) {
    out += style.paint(scenario.name, Style::Ink::Bold) + "\n";
    out += "  " + harness::wrap(scenario.summary, style.width - 2, 2) + "\n";
    if (scenario.variants.size() > 1)
      out += "  " + harness::wrap("variants: " + joined(scenario.variants), style.width - 2, 12) + "\n";
    if (scenario.scales)
      out += "  " + harness::wrap("sizes: " + sizes_text(scenario) + ", or any", style.width - 2, 9) + "\n";
  }
  return out;
}

std::string as_json() {
  using Json = nlohmann::ordered_json;
  Json out = Json::array();
  for (const Scenario& scenario : scenarios::all()) {
    out.push_back({{"name", scenario.name},
                   {"summary", scenario.summary},
                   {"variants", scenario.variants},
                   {"sizes", scenario.sizes},
                   {"scales", scenario.scales}});
  }
  return out.dump(2) + "\n";
}

}  // namespace

void add_list(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("list", "the scenarios, with their variants and sizes");
  auto format = std::make_shared<std::string>("console");
  command->add_option("--format", *format, "console or json")->check(CLI::IsMember({"console", "json"}));
  auto limits = std::make_shared<bool>(false);
  command->add_flag("--known-limits", *limits,
                    "the bounds that engines are known to miss, as docs/known-limits.md");
  command->footer("Examples:\n  plumb list\n  plumb list --format json");
  command->callback([&chosen, format, limits] {
    chosen = [format, limits] {
      if (*limits) {
        print(harness::known_limits_page());
        return kOk;
      }
      print(*format == "json" ? as_json() : as_text(Style::of_file(STDOUT_FILENO)));
      return kOk;
    };
  });
}

}  // namespace plumb::app
