#include "harness/text_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <fmt/format.h>
#include <unistd.h>

#include "engine/scene/error.h"

namespace plumb::harness {
namespace {

constexpr std::size_t kLargest = std::size_t{1} << 30;  // bytes

[[noreturn]] void fail(const std::string& subject, const std::string& problem) {
  throw Error(Error::Kind::Io, subject, "", "", problem);
}

std::string named(const std::string& path) { return fmt::format("file '{}'", path); }

/// Returns an empty string if everything was written, otherwise the error.
std::string write_to(const std::string& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  if (file) file << text;
  file.close();
  return file ? "" : std::strerror(errno);
}

}  // namespace

std::ifstream open_text(const std::string& path, const std::string& advice) {
  std::error_code code;
  const std::string then = advice.empty() ? "" : "; " + advice;
  if (std::filesystem::is_directory(path, code)) fail(named(path), "is a directory" + then);
  std::ifstream file(path, std::ios::binary);
  if (!file) fail(named(path), fmt::format("cannot be read: {}{}", std::strerror(errno), then));
  return file;
}

std::string read_text(const std::string& path, const std::string& advice) {
  std::ifstream file = open_text(path, advice);
  return read_text(file, named(path));
}

std::string read_text(std::istream& in, const std::string& subject) {
  std::string text;
  char buffer[65536];
  errno = 0;
  while (in.read(buffer, sizeof buffer) || in.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(in.gcount()));
    if (text.size() > kLargest) fail(subject, "has more than 1 GiB");
  }
  // Standard input is read through stdio, whose errors the stream does not report.
  if (in.bad() || (&in == &std::cin && std::ferror(stdin) != 0))
    fail(subject, fmt::format("cannot be read completely: {}", std::strerror(errno)));
  return text;
}

void make_folder(const std::string& folder, const char* advice) {
  std::error_code code;
  std::filesystem::create_directories(folder, code);
  if (code)
    fail(fmt::format("folder '{}'", folder),
         fmt::format("cannot be created: {}; {}", code.message(), advice));
}

void write_whole(const std::string& path, const std::string& text) {
  std::error_code code;
  const std::filesystem::file_status there = std::filesystem::status(path, code);
  const bool replaced = !std::filesystem::exists(there) || std::filesystem::is_regular_file(there);
  // Writes to a link's target, so that the link is kept.
  std::filesystem::path place = path;
  if (replaced) place = std::filesystem::weakly_canonical(path, code);
  const std::string target = code ? path : place.string();
  const std::string written = replaced ? fmt::format("{}.{}.new", target, getpid()) : target;
  std::string problem = write_to(written, text);
  if (problem.empty() && replaced) {
    std::filesystem::rename(written, target, code);
    if (code) problem = code.message();
  }
  if (problem.empty()) return;
  if (replaced) std::filesystem::remove(written, code);
  fail(named(path), "cannot be written: " + problem);
}

}  // namespace plumb::harness
