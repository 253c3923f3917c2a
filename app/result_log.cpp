#include "app/result_log.h"

#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fmt/format.h>

#include "engine/scene/error.h"

namespace plumb::app {

ResultLog::ResultLog(const std::string& folder)
    : path_((std::filesystem::path(folder) / "results.jsonl").string()) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code)
    throw Error(Error::Kind::Io, fmt::format("folder '{}'", folder), "", "",
                fmt::format("cannot be made: {}; name another with --out", code.message()));
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
