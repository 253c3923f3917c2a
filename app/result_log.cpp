#include "app/result_log.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "engine/scene/error.h"

namespace plumb::app {
namespace {

// What is left of a writer that was stopped within a line, or of a disk that was full.
void drop_half_a_line(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::is_regular_file(path, code)) return;
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  std::streamoff end = file ? static_cast<std::streamoff>(file.tellg()) : 0;
  const std::streamoff size = end;
  for (; end > 0; --end) {
    file.seekg(end - 1);
    if (file.get() == '\n') break;
  }
  if (end < size) std::filesystem::resize_file(path, static_cast<std::uintmax_t>(end), code);
}

}  // namespace

ResultLog::ResultLog(const std::string& folder)
    : path_((std::filesystem::path(folder) / "results.jsonl").string()) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code)
    throw Error(Error::Kind::Io, fmt::format("folder '{}'", folder), "", "",
                fmt::format("cannot be made: {}; name another with --out", code.message()));
  drop_half_a_line(path_);
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
