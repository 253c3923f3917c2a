#include "harness/reality/reality.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/selection.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/reality/published/published_law.h"
#include "harness/text_file.h"

namespace plumb::app {
namespace {

namespace reality = harness::reality;

struct RealityOptions {
  std::string data = "impacts", out, format = "console";
  EngineOptions engines;
  int seed = 1;
  bool published = false;
};

void write_files(const std::string& folder, const reality::Findings& findings) {
  harness::make_folder(folder);
  const std::filesystem::path path(folder);
  harness::write_whole((path / "reality.html").string(), reality::page_of(findings));
  harness::write_whole((path / "ellipse.svg").string(), reality::ellipse_picture(findings));
  harness::write_whole((path / "engines.svg").string(), reality::engine_picture(findings));
  harness::write_whole((path / "reality.json").string(), reality::to_json(findings));
}

int run_published(const std::vector<const reference::Backend*>& engines, const RealityOptions& options) {
  const std::string& format = options.format;
  harness::catch_interrupts();
  const std::vector<reality::PublishedFinding> findings =
      reality::examine_published(reality::published_laws(), engines);
  if (!options.out.empty() && !harness::interrupted()) {
    harness::make_folder(options.out);
    harness::write_whole((std::filesystem::path(options.out) / "published.json").string(),
                         reality::published_json(findings));
  }
  print(format == "json"  ? reality::published_json(findings)
        : format == "csv" ? reality::published_csv(findings)
                          : reality::published_text(findings));
  flush();
  return harness::interrupted() ? kInterrupted : kOk;
}

int start_reality(const RealityOptions& options) {
  std::vector<std::unique_ptr<reference::Backend>> programs;
  const std::vector<const reference::Backend*> engines = chosen_engines(options.engines, programs);
  if (options.published) return run_published(engines, options);
  if (const std::string missing = reality::missing_file(options.data); !missing.empty()) {
    notice(
        fmt::format("there is no '{}' in '{}'; the measurements are not part of plumb. docs/reality.md says "
                    "where to get them; give their folder with --data",
                    missing, options.data));
    return kNoData;
  }
  harness::catch_interrupts();
  const reality::Findings findings =
      reality::examine(options.data, engines, static_cast<std::uint64_t>(options.seed));
  if (harness::interrupted()) {
    notice("interrupted; nothing was written");
    return kInterrupted;
  }
  if (!options.out.empty()) write_files(options.out, findings);
  if (options.format == "json") {
    print(reality::to_json(findings));
  } else if (options.format == "csv") {
    print(reality::to_csv(findings));
  } else {
    print(reality::to_text(findings, harness::Style::of_file(STDOUT_FILENO)));
    if (!options.out.empty()) print(fmt::format("\nThe page is {}/reality.html.\n", options.out));
  }
  flush();
  return kOk;
}

}  // namespace

void add_reality(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("reality",
                                         "compare engines and laws of impact with measured motions, and "
                                         "separate the law's error from the numerical one");
  auto options = std::make_shared<RealityOptions>();
  command
      ->add_option(
          "--data", options->data,
          "folder with ellipse_impacts.csv and square_drops.csv; see docs/reality.md (default impacts)")
      ->check(problem_with_path)
      ->type_name("DIR");
  options->engines.add_to(*command);
  command
      ->add_option(
          "--out", options->out,
          "folder for the page reality.html, two plots and reality.json, or published.json (default: none)")
      ->check(problem_with_path)
      ->type_name("DIR");
  command->add_option("--format", options->format, "console, json or csv")
      ->check(CLI::IsMember({"console", "json", "csv"}));
  command->add_option("--seed", options->seed, "seed of the random halves (default 1)")
      ->check(whole_number(0, std::numeric_limits<int>::max()))
      ->type_name("N");
  command->add_flag("--published", options->published,
                    "compare with published laws instead, which need no measurements: bouncing balls, column "
                    "collapse, dominoes, rocking block");
  command->footer(
      "Examples:\n  plumb reality --data ~/impacts --out reality\n  plumb reality --engine plumb,box2d "
      "--format csv\n"
      "Exit code 4: the measurements are not there.");
  command->callback([&chosen, options] { chosen = [options] { return start_reality(*options); }; });
}

}  // namespace plumb::app
