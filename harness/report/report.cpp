#include "harness/report/report.h"

#include <filesystem>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/report/environments.h"
#include "harness/report/replay.h"
#include "harness/report/report_data.h"
#include "harness/report/whole_file.h"
#include "harness/sweep/rows.h"

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
  const std::vector<Result> rows = sweep::read_rows(folder_or_file);
  if (rows.empty())
    throw Error(Error::Kind::Value, fmt::format("'{}'", folder_or_file), "", "",
                "has no results: `plumb compare --out DIR` or `plumb sweep --out DIR` writes some");
  const std::string title = std::filesystem::weakly_canonical(folder_or_file).filename().string();
  const auto replays = replays_of(rows, engines, folder_of(folder_or_file).string());
  if (interrupted()) return false;
  const std::string data = report_data(title, rows, read_environments(folder_or_file), replays);
  write_whole(out, report_page(title, data));
  return true;
}

}  // namespace plumb::harness::report
