#include "harness/sweep/journal.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "engine/scene/error.h"
#include "harness/text_file.h"

namespace plumb::harness::sweep {

namespace {

constexpr int kPatience = 20;  // tenths of a second to wait for the lock

}  // namespace

void Journal::fail(std::string_view what) const {
  throw Error(Error::Kind::Io, fmt::format("file '{}'", path_), "", "",
              fmt::format("{}: {}", what, std::strerror(errno)));
}

Journal::Journal(const std::string& path) : path_(path) {
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) make_folder(folder.string());
  file_ = open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file_ < 0) fail("cannot be written");
  // Children of a killed process release the lock slightly later.
  int locked = flock(file_, LOCK_EX | LOCK_NB);
  for (int i = 0; i < kPatience && locked != 0 && errno == EWOULDBLOCK; ++i) {
    usleep(100'000);
    locked = flock(file_, LOCK_EX | LOCK_NB);
  }
  if (locked != 0) {
    const int why = errno;
    close(file_);
    errno = why;
    if (why == EWOULDBLOCK)
      throw Error(Error::Kind::Io, fmt::format("file '{}'", path_), "", "",
                  "another run uses this folder; choose another with --out");
    fail("cannot be locked");
  }
  std::string text;
  char buffer[65536];
  for (ssize_t count; (count = read(file_, buffer, sizeof buffer)) > 0;)
    text.append(buffer, static_cast<std::size_t>(count));
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1)
    lines_.push_back(text.substr(begin, end - begin));
  if (begin < text.size() && ftruncate(file_, static_cast<off_t>(begin)) != 0) {
    close(file_);
    fail("its last line is incomplete and cannot be removed");
  }
}

Journal::~Journal() { close(file_); }

void Journal::append(std::string_view line) {
  const std::string text = std::string(line) + "\n";
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(file_, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) fail("cannot be written");
    done += static_cast<std::size_t>(count);
  }
}

}  // namespace plumb::harness::sweep
