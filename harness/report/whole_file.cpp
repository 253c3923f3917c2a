#include "harness/report/whole_file.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>
#include <unistd.h>

#include "engine/scene/error.h"

namespace plumb::harness::report {
namespace {

[[noreturn]] void cannot_write(const std::string& path, const std::string& why) {
  throw Error(Error::Kind::Io, fmt::format("file '{}'", path), "", "",
              fmt::format("cannot be written: {}", why));
}

}  // namespace

void write_whole(const std::string& path, const std::string& text) {
  const std::string fresh = fmt::format("{}.{}.new", path, getpid());
  std::error_code code;
  std::ofstream file(fresh, std::ios::binary);
  if (!file) cannot_write(path, std::strerror(errno));
  file << text;
  file.close();
  if (!file) {
    const std::string why = std::strerror(errno);
    std::filesystem::remove(fresh, code);
    cannot_write(path, why);
  }
  std::filesystem::rename(fresh, path, code);
  if (!code) return;
  std::error_code ignored;
  std::filesystem::remove(fresh, ignored);
  cannot_write(path, code.message());
}

}  // namespace plumb::harness::report
