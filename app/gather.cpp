#include "harness/cluster/gather.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/exit_codes.h"
#include "app/output.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/cluster/work.h"
#include "harness/interrupt.h"
#include "harness/report/report.h"
#include "harness/style.h"
#include "reference/backend.h"

namespace plumb::app {
namespace {

namespace cluster = harness::cluster;
using Ink = harness::Style::Ink;

struct GatherOptions {
  std::string folder, out = "results", format = "console", expiry;
  bool no_report = false;
};

double expiry_of(const GatherOptions& options) {
  return options.expiry.empty() ? cluster::WorkOptions{}.expiry : parse_positive("--expiry", options.expiry);
}

std::string time_text(double seconds) {
  if (seconds < 120) return fmt::format("{:.0f} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

std::string plural(std::size_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

std::string bar(double share, int width) {
  const int full = static_cast<int>(share * width);
  return "[" + std::string(static_cast<std::size_t>(full), '#') +
         std::string(static_cast<std::size_t>(width - full), '.') + "]";
}

// Lists the units that are not done, by kind, with advice.
std::string missing_text(const std::string& folder, const cluster::Survey& survey,
                         const harness::Style& style) {
  std::string out;
  const auto line = [&](const std::string& text, Ink ink) {
    out += style.paint(harness::wrap(text, style.width, 2), ink) + "\n";
  };
  if (!survey.free.empty()) line(fmt::format("not started: {}", cluster::ranges(survey.free)), Ink::Yellow);
  if (!survey.running.empty())
    line(fmt::format("under way: {}", cluster::ranges(survey.running)), Ink::Plain);
  for (const auto& [kind, numbers] : survey.failed) {
    const cluster::Failure failure =
        cluster::read_failure(folder, numbers.front()).value_or(cluster::Failure{});
    line(fmt::format("failed, {}: {}{}", kind, cluster::ranges(numbers),
                     failure.message.empty() ? "" : fmt::format(" ({})", failure.message)),
         Ink::Red);
  }
  for (const auto& [number, why] : survey.damaged)
    line(fmt::format("damaged: {} ({}); `plumb work {} --unit {} --again` repeats it", number, why, folder,
                     number),
         Ink::Red);
  if (!survey.noisy.empty())
    line(fmt::format("disturbed by other programs: {}; `plumb plan {} --next` plans further measurements, at "
                     "most two, on other machines if there are any",
                     cluster::ranges(survey.noisy), folder),
         Ink::Yellow);
  return out;
}

std::string machines_text(const cluster::Survey& survey) {
  std::string out;
  for (const auto& [kind, use] : survey.machines)
    out += fmt::format("{} on {}: {}, calibration {:.2f} to {:.2f} ms\n",
                       plural(static_cast<std::size_t>(use.units), "unit"), kind,
                       plural(use.hosts.size(), "host"), use.fastest_ms, use.slowest_ms);
  return out;
}

int status(const GatherOptions& options) {
  const cluster::Plan plan = cluster::read_plan(options.folder);
  const cluster::Survey survey = cluster::survey(options.folder, plan, expiry_of(options));
  if (options.format == "json") {
    print(cluster::to_json(plan, survey));
    return kOk;
  }
  const harness::Style style = harness::Style::of_file(STDOUT_FILENO);
  const double share = plan.units.empty()
                           ? 1
                           : static_cast<double>(survey.done.size()) / static_cast<double>(plan.units.size());
  print(fmt::format("{} {} of {} units, {} of computing done", bar(share, 40), survey.done.size(),
                    plan.units.size(), time_text(survey.seconds_done)));
  if (survey.seconds_left > 0) {
    const std::size_t workers = std::max<std::size_t>(1, survey.running.size());
    print(fmt::format(", about {} left", time_text(survey.seconds_left)));
    if (workers > 1)
      print(fmt::format(": {} with the {} workers that run",
                        time_text(survey.seconds_left / static_cast<double>(workers)), workers));
  }
  print("\n" + machines_text(survey) + missing_text(options.folder, survey, style));
  return kOk;
}

std::string lines_text(const cluster::Gathered& gathered, const std::string& out) {
  std::string text;
  for (const auto& [file, count] : gathered.lines)
    text += fmt::format("{} in {}/{}\n", plural(count, "line"), out, file);
  std::string statuses;
  for (const auto& [status, count] : gathered.statuses)
    statuses += fmt::format("{}{} {}", statuses.empty() ? "" : ", ", count, status);
  if (!statuses.empty()) text += statuses + "\n";
  if (gathered.cut_short > 0)
    text += fmt::format("{} incomplete, left out\n", plural(gathered.cut_short, "last line"));
  if (gathered.twice > 0) text += fmt::format("{} done twice, counted once\n", plural(gathered.twice, "run"));
  if (!gathered.differ.empty())
    text += fmt::format("{} of these differ, the first is {}: the machines do not compute the same results\n",
                        gathered.differ.size(), gathered.differ.front());
  return text;
}

int gather(const GatherOptions& options) {
  const cluster::Plan plan = cluster::read_plan(options.folder);
  const cluster::Gathered gathered = cluster::gather(options.folder, plan, options.out, expiry_of(options));
  const harness::Style style = harness::Style::of_file(STDOUT_FILENO);
  const std::vector<int> missing = gathered.survey.missing();
  if (options.format == "json") {
    print(cluster::to_json(plan, gathered));
  } else {
    if (gathered.hunted) print(harness::hunt::kinds_text(gathered.hunt));
    print(lines_text(gathered, options.out) + machines_text(gathered.survey));
    print(missing_text(options.folder, gathered.survey, style));
    print(fmt::format(
        "{} of {} units are done{}\n", gathered.survey.done.size(), plan.units.size(),
        missing.empty() ? "" : fmt::format("; `plumb submit {} --on ...` runs the rest", options.folder)));
  }
  flush();
  int code = missing.empty() && gathered.survey.damaged.empty() ? kOk : kCheckFailed;
  if (options.no_report || gathered.lines.empty()) return code;
  harness::catch_interrupts();
  const std::string path = harness::report::default_report_path(options.out);
  if (!harness::report::write_report(options.out, path, reference::backends())) {
    notice(fmt::format("interrupted; the results are complete, `plumb report {}` writes the report",
                       options.out));
    return kInterrupted;
  }
  if (options.format == "console") print(fmt::format("the report is in {}\n", path));
  return code;
}

void add_common(CLI::App& command, GatherOptions& options) {
  command.add_option("folder", options.folder, "folder of work")->required()->type_name("FOLDER");
  command.add_option("--format", options.format, "console or json")
      ->check(CLI::IsMember({"console", "json"}));
  command
      .add_option("--expiry", options.expiry,
                  "age in s at which a claim that is not renewed expires, because its machine is taken for "
                  "dead (default 300)")
      ->type_name("T");
}

}  // namespace

void add_gather(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "gather", "merge the results of the finished units, write the report, and list the missing units");
  auto options = std::make_shared<GatherOptions>();
  add_common(*command, *options);
  command
      ->add_option("--out", options->out,
                   "folder for the results; existing results are replaced (default results)")
      ->check(problem_with_path)
      ->type_name("DIR");
  command->add_flag("--no-report", options->no_report, "leave report.html out; `plumb report DIR` writes it");
  command->footer(
      "Examples:\n  plumb gather work\n  plumb gather work --out night --no-report\nIt may be run at any "
      "time, also several times at once. See docs/cluster.md. Exit codes: 0 all units are there, 1\nsome are "
      "missing, 2 usage.");
  command->callback([&chosen, options] { chosen = [options] { return gather(*options); }; });
}

void add_status(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand(
      "status", "show the progress of a folder of work, failed units, and the remaining time");
  auto options = std::make_shared<GatherOptions>();
  add_common(*command, *options);
  command->footer("Examples:\n  plumb status work\n  plumb status work --format json");
  command->callback([&chosen, options] { chosen = [options] { return status(*options); }; });
}

}  // namespace plumb::app
