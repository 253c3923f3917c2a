#include "harness/cluster/claim.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <set>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/cluster/work_folder.h"
#include "harness/text_file.h"

namespace plumb::harness::cluster {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Resolution of the coarsest clocks of file systems, s.
constexpr double kClock = 2;

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string boot() { return first_line("/proc/sys/kernel/random/boot_id"); }

std::string process_names() {
  std::error_code code;
  return fs::read_symlink("/proc/self/ns/pid", code).string();
}

// Returns the time at which a process began, in clock ticks since the machine started; empty if there is no
// such process.
std::string began(pid_t process) {
  const std::string line = first_line(fmt::format("/proc/{}/stat", process));
  std::size_t at = line.rfind(')');  // the name before it may contain spaces
  for (int field = 2; at != std::string::npos && field < 22; ++field) at = line.find(' ', at + 1);
  return at == std::string::npos ? "" : line.substr(at + 1, line.find(' ', at + 1) - at - 1);
}

std::string new_nonce() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

std::string content(const std::string& nonce, const std::string& host) {
  return Json{{"nonce", nonce},           {"host", host},        {"boot", boot()},
              {"names", process_names()}, {"process", getpid()}, {"began", began(getpid())}}
             .dump(-1, ' ', false, Json::error_handler_t::replace) +
         "\n";
}

std::string text_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string nonce_of(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  return json.is_object() ? json.value("nonce", "") : "";
}

// Returns true if the claim was made by a process of this machine that has ended.
bool is_dead(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("boot", "") != boot() || json.value("names", "") != process_names())
    return false;
  const pid_t process = json.value("process", 0);
  return process > 0 && began(process) != json.value("began", "");
}

std::optional<double> changed(const std::string& path) {
  struct stat seen {};
  if (stat(path.c_str(), &seen) != 0) return {};
  return static_cast<double>(seen.st_mtim.tv_sec) + 1e-9 * static_cast<double>(seen.st_mtim.tv_nsec);
}

void touch(const std::string& path) { utimensat(AT_FDCWD, path.c_str(), nullptr, 0); }

// Creates `path` as a hard link to `own`; returns false if it exists. On file systems without links it is
// created as a file.
bool put(const std::string& own, const std::string& path) {
  if (link(own.c_str(), path.c_str()) == 0) return true;
  if (errno == EEXIST) return false;
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (file < 0 && errno == EEXIST) return false;
  const std::string text = text_of(own);
  const bool written =
      file >= 0 && write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  const int why = errno;
  if (file >= 0) close(file);
  if (!written)
    throw Error(Error::Kind::Io, fmt::format("file '{}'", path), "", "",
                fmt::format("cannot be written: {}", std::strerror(why)));
  return true;
}

// Returns true if the claim in `path`, whose text is `text`, may be taken from its holder. `now` is the file
// system's time. A claim from the future is set to `now`: then its holder renews it, or it expires.
bool is_over(const std::string& path, const std::string& text, double now, double expiry) {
  if (is_dead(text)) return true;
  const std::optional<double> then = changed(path);
  if (!then) return true;
  if (*then > now + kClock) touch(path);
  return now - *then > expiry;
}

}  // namespace

std::unique_ptr<Claim> Claim::take(const std::string& folder, int number, double expiry, bool force,
                                   bool& died) {
  died = false;
  const std::string path = path_in(folder, "claims", number);
  const std::string nonce = new_nonce();
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  const std::string own = fmt::format("{}/doing/{}.claim", folder, nonce);
  write_whole(own, content(nonce, host));
  const double now = changed(own).value_or(0);
  bool taken = put(own, path);
  // Two attempts: when a dead process's claim has been removed, another process may take the unit first.
  for (int i = 0; i < 2 && !taken; ++i) {
    const std::string text = text_of(path);
    const bool over = is_over(path, text, now, expiry);
    if (!over && !force) break;
    const std::string away = fmt::format("{}/doing/{}.expired", folder, nonce);
    if (rename(path.c_str(), away.c_str()) == 0) {
      const bool same = text_of(away) == text;
      if (!same) link(away.c_str(), path.c_str());  // the holder has renewed the claim: give it back
      unlink(away.c_str());
      if (!same && !force) break;
      died = over;
      if (const std::string other = nonce_of(text); over && !other.empty()) {
        std::error_code ignored;
        fs::remove_all(fmt::format("{}.{}", path_in(folder, "doing", number), other), ignored);
      }
    }
    taken = put(own, path);
  }
  unlink(own.c_str());
  if (!taken) return nullptr;
  return std::unique_ptr<Claim>(new Claim(path, nonce));
}

Claim::~Claim() {
  if (nonce_of(text_of(path_)) == nonce_) unlink(path_.c_str());
}

void remove_dead_claims(const std::string& folder, double expiry) {
  const double now =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  std::error_code code;
  const std::set<int> done = numbers_in(folder, "done");
  for (const int number : numbers_in(folder, "claims")) {
    const std::string path = path_in(folder, "claims", number);
    if (done.contains(number) && is_over(path, text_of(path), now, expiry)) unlink(path.c_str());
  }
  for (fs::directory_iterator at(fs::path(folder) / "doing", code), end; !code && at != end;
       at.increment(code)) {
    const std::string path = at->path().string();
    if (!path.ends_with(".claim") && !path.ends_with(".expired")) continue;
    if (is_over(path, text_of(path), now, expiry)) unlink(path.c_str());
  }
}

bool is_claimed(const std::string& folder, int number, double expiry) {
  const std::string path = path_in(folder, "claims", number);
  const std::optional<double> then = changed(path);
  const double now =
      std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
  return then && now - *then < expiry && !is_dead(text_of(path));
}

void Claim::renew() const {
  if (nonce_of(text_of(path_)) == nonce_) touch(path_);
}

}  // namespace plumb::harness::cluster
