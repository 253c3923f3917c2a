#include "app/result_log.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/text_file.h"

namespace plumb::app {
namespace {

// Repairs the last line. Half a record, left by a writer that was stopped or by a full disk, is removed.
// Anything else only lacks its line end, which is added.
void end_last_line(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return;
  std::ifstream file(path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  const std::size_t begin = text.rfind('\n') + 1;  // 0 if there is none
  const std::string last = text.substr(begin);
  if (last.empty()) return;
  if (last.front() == '{' && !nlohmann::json::accept(last)) {
    std::filesystem::resize_file(path, begin, code);
  } else {
    std::ofstream(path, std::ios::binary | std::ios::app) << '\n';
  }
}

}  // namespace

ResultLog::ResultLog(const std::string& folder)
    : path_((std::filesystem::path(folder) / "results.jsonl").string()) {
  harness::make_folder(folder);
  end_last_line(path_);
  file_.reset(std::fopen(path_.c_str(), "a"));
  if (!file_)
    throw Error(Error::Kind::Io, fmt::format("file '{}'", path_), "", "",
                fmt::format("cannot be written: {}; name another folder with --out", std::strerror(errno)));
}

void ResultLog::append(std::span<const harness::Result> results) {
  for (const harness::Result& result : results) {
    const std::string line = harness::to_json_with_environment(result) + "\n";
    if (std::fwrite(line.data(), 1, line.size(), file_.get()) != line.size() || std::fflush(file_.get()) != 0)
      throw Error(Error::Kind::Io, fmt::format("file '{}'", path_), "", "",
                  fmt::format("cannot be written: {}", std::strerror(errno)));
  }
}

}  // namespace plumb::app
