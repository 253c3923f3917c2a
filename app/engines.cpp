#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/npm.h"
#include "app/output.h"
#include "harness/style.h"
#include "reference/backend.h"
#include "reference/guests.h"
#include "reference/node_engines.h"

namespace plumb::app {
namespace {

using harness::Style;
using reference::Backend;

// Returns the engines that are linked in, and those from npm, installed or not.
std::vector<const Backend*> listed() {
  std::vector<const Backend*> all = reference::backends();
  for (const Backend* guest : reference::linked_guests())
    if (!guest->name().ends_with("-default")) all.push_back(guest);
  for (const reference::NodeEngine& engine : reference::node_engines())
    all.push_back(reference::find_guest(engine.name));
  return all;
}

// Lists the installed versions of an engine from npm, and the other names under which it can be requested.
std::string versions_of(const Backend& backend) {
  for (const reference::NodeEngine& engine : reference::node_engines()) {
    if (engine.name != backend.name()) continue;
    std::string out;
    for (const std::string& version : reference::installed_versions(engine))
      out += " " + engine.name + "@" + version;
    return out.empty() ? "" : fmt::format("also{}, and {}-default", out, engine.name);
  }
  return "";
}

std::string as_text(const Style& style) {
  std::string out;
  for (const Backend* backend : listed()) {
    const reference::Identity identity = backend->identity();
    out += style.paint(fmt::format("{:<15}", backend->name()), Style::Ink::Bold);
    if (identity.available) {
      out += fmt::format(" {:<8} {:<7} installed\n", identity.version, identity.precision);
    } else {
      const std::string text = fmt::format(" not installed: {}", identity.reason);
      out += style.paint(harness::wrap(text, style.width - 15, 17), Style::Ink::Yellow) + "\n";
    }
    out += "  " + harness::wrap(std::string(backend->summary()), style.width - 2, 2) + "\n";
    if (identity.foreign_cost)
      out += "  " +
             harness::wrap(
                 "its costs are those of WebAssembly or JavaScript and are not ranked with native engines; " +
                     versions_of(*backend),
                 style.width - 2, 2) +
             "\n";
    for (const reference::Option& option : backend->options()) {
      const std::string text = fmt::format("--set {}={}  {}", option.name, option.fallback, option.help);
      out += "    " + style.paint(harness::wrap(text, style.width - 4, 10), Style::Ink::Dim) + "\n";
    }
  }
  return out;
}

std::string as_json() {
  using Json = nlohmann::ordered_json;
  Json out = Json::array();
  for (const Backend* backend : listed()) {
    const reference::Identity identity = backend->identity();
    Json options = Json::array();
    for (const reference::Option& option : backend->options())
      options.push_back({{"name", option.name}, {"default", option.fallback}, {"help", option.help}});
    out.push_back({{"name", backend->name()},
                   {"summary", backend->summary()},
                   {"version", identity.version},
                   {"precision", identity.precision},
                   {"installed", identity.available},
                   {"reason", identity.reason},
                   {"foreign_cost", identity.foreign_cost},
                   {"limits", identity.limits},
                   {"options", options}});
  }
  return out.dump(2) + "\n";
}

}  // namespace

void add_engines(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "engines", "list the engines with version, precision and options, and why one is missing");
  auto format = std::make_shared<std::string>("console");
  command->add_option("--format", *format, "console or json")->check(CLI::IsMember({"console", "json"}));
  auto wanted = std::make_shared<std::vector<std::string>>();
  command
      ->add_option("--install", *wanted,
                   "instead: install an engine from npm, optionally in a version; may be repeated")
      ->allow_extra_args(false)
      ->type_name("NAME[@VERSION]");
  command->footer(
      "Examples:\n  plumb engines\n  plumb engines --format json\n  plumb engines --install rapier --install "
      "rapier@0.21.0\n"
      "Engines from npm go to PLUMB_ENGINES, by default plumb/engines in XDG_DATA_HOME or ~/.local/share.");
  command->callback([&chosen, format, wanted] {
    chosen = [format, wanted] {
      for (const std::string& name : *wanted) {
        const NamedVersion version = named_version(name);
        install(version);
        print(fmt::format("{}@{} is in {}\n", version.engine.name, version.version,
                          reference::folder_of(version.engine, version.version)));
      }
      if (!wanted->empty()) return kOk;
      print(*format == "json" ? as_json() : as_text(Style::of_file(STDOUT_FILENO)));
      return kOk;
    };
  });
}

}  // namespace plumb::app
