#include <memory>
#include <string>

#include <fmt/format.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "harness/style.h"
#include "reference/backend.h"

namespace plumb::app {
namespace {

using harness::Style;
using reference::Backend;

std::string as_text(const Style& style) {
  std::string out;
  for (const Backend* backend : reference::backends()) {
    const reference::Identity identity = backend->identity();
    out += style.paint(fmt::format("{:<15}", backend->name()), Style::Ink::Bold);
    if (identity.available) {
      out += fmt::format(" {:<8} {:<7} installed\n", identity.version, identity.precision);
    } else {
      const std::string text = fmt::format(" not installed: {}", identity.reason);
      out += style.paint(harness::wrap(text, style.width - 15, 17), Style::Ink::Yellow) + "\n";
    }
    out += "  " + harness::wrap(std::string(backend->summary()), style.width - 2, 2) + "\n";
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
  for (const Backend* backend : reference::backends()) {
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
                   {"options", options}});
  }
  return out.dump(2) + "\n";
}

}  // namespace

void add_engines(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("engines", "the engines: version, precision, options, and why one is missing");
  auto format = std::make_shared<std::string>("console");
  command->add_option("--format", *format, "console or json")->check(CLI::IsMember({"console", "json"}));
  command->footer("Examples:\n  plumb engines\n  plumb engines --format json");
  command->callback([&chosen, format] {
    chosen = [format] {
      print(*format == "json" ? as_json() : as_text(Style::of_file(STDOUT_FILENO)));
      return kOk;
    };
  });
}

}  // namespace plumb::app
