#include "harness/report/report.h"

#include <memory>
#include <string>

#include <fmt/format.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/usage.h"
#include "harness/interrupt.h"
#include "reference/backend.h"

namespace plumb::app {
namespace {

struct ReportOptions {
  std::string folder = "results", out, picture;
};

int start_report(const ReportOptions& options) {
  const std::string out =
      options.out.empty() ? harness::report::default_report_path(options.folder) : options.out;
  harness::catch_interrupts();
  if (!harness::report::write_report(options.folder, out, reference::backends())) {
    notice("interrupted; no report was written");
    return kInterrupted;
  }
  print(fmt::format("the report is in {}\n", out));
  if (!options.picture.empty()) {
    harness::report::write_extremes_picture(options.folder, options.picture);
    print(fmt::format("the picture is in {}\n", options.picture));
  }
  flush();
  return kOk;
}

}  // namespace

void add_report(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("report", "write results as one HTML file with charts, checks and settings");
  auto options = std::make_shared<ReportOptions>();
  command
      ->add_option(
          "results", options->folder,
          "a folder that `plumb compare`, `sweep`, `stress` or `thresholds` wrote, or a results.jsonl "
          "(default results)")
      ->type_name("DIR");
  command->add_option("--out", options->out, "the file to write (default DIR/report.html)")
      ->check(problem_with_path)
      ->type_name("FILE");
  command
      ->add_option("--picture", options->picture,
                   "also draw which engine survives which family of `plumb stress`, as SVG, into this file")
      ->check(problem_with_path)
      ->type_name("FILE");
  command->footer(
      "Examples:\n  plumb report\n  plumb report sweep --out trade.html\n"
      "  plumb report stress --picture stress.svg");
  command->callback([&chosen, options] { chosen = [options] { return start_report(*options); }; });
}

}  // namespace plumb::app
