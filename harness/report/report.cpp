#include "harness/report/report.h"

#include <filesystem>
#include <map>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/report/environments.h"
#include "harness/report/extremes.h"
#include "harness/report/replay.h"
#include "harness/report/report_data.h"
#include "harness/sweep/rows.h"
#include "harness/text_file.h"

namespace plumb::harness::report {
namespace {

std::filesystem::path folder_of(const std::string& folder_or_file) {
  std::error_code code;
  const std::filesystem::path path(folder_or_file);
  if (std::filesystem::is_directory(path, code)) return path;
  return path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
}

}  // namespace

std::string default_report_path(const std::string& folder_or_file) {
  return (folder_of(folder_or_file) / "report.html").string();
}

bool write_report(const std::string& folder_or_file, const std::string& out,
                  std::span<const reference::Backend* const> engines) {
  std::error_code code;
  const bool is_folder = std::filesystem::is_directory(folder_or_file, code);
  const Extremes extremes = is_folder ? read_extremes(folder_or_file) : Extremes{};
  std::map<std::string, std::string> replays;
  std::vector<Result> rows;
  if (extremes.empty() || sweep::holds_rows(folder_or_file)) {
    replays = replays_of(rows_to_replay(folder_or_file), engines, folder_of(folder_or_file).string());
    if (interrupted()) return false;
    rows = sweep::read_rows(folder_or_file);
  }
  if (rows.empty() && extremes.empty())
    throw Error(
        Error::Kind::Value, fmt::format("'{}'", folder_or_file), "", "",
        "has no results: `plumb compare --out DIR`, `plumb sweep --out DIR` or `plumb stress --out DIR` "
        "writes some");
  const std::string title = std::filesystem::weakly_canonical(folder_or_file).filename().string();
  if (interrupted()) return false;
  const std::string data = report_data(title, rows, read_environments(folder_or_file), replays, extremes);
  write_whole(out, report_page(title, data));
  return true;
}

void write_extremes_picture(const std::string& folder, const std::string& out) {
  const Extremes extremes = read_extremes(folder);
  if (extremes.cells.empty())
    throw Error(Error::Kind::Value, fmt::format("'{}'", folder), "", "",
                "has no stress.jsonl: `plumb stress --out DIR` writes one");
  write_whole(out, extremes_picture(extremes.cells));
}

}  // namespace plumb::harness::report
