#include "harness/cluster/work.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/scene/error.h"
#include "harness/cluster/claim.h"
#include "harness/interrupt.h"
#include "harness/packed_file.h"
#include "harness/text_file.h"

namespace plumb::harness::cluster {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kMessages = "messages.txt";
constexpr int kInterruptedCode = 130;
constexpr std::size_t kLookedAt = 16;  // number of claims that are checked; some may be of dead processes

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Returns the arguments for the program: "{folder}" replaced by this folder, and --out added.
std::vector<std::string> arguments_of(const Unit& unit, const std::string& folder, const std::string& out) {
  constexpr std::string_view kFolder = "{folder}/";
  std::vector<std::string> words{"plumb"};
  for (const std::string& word : unit.arguments)
    words.push_back(word.starts_with(kFolder) ? folder + "/" + word.substr(kFolder.size()) : word);
  words.insert(words.end(), {"--out", out});
  return words;
}

[[noreturn]] void become(std::vector<std::string> words, const std::string& out,
                         const std::string& directory) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int nothing = open("/dev/null", O_RDWR);
  const int messages = open((out + "/" + kMessages).c_str(), O_WRONLY | O_CREAT, 0644);
  if (nothing < 0 || messages < 0) _exit(126);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  dup2(messages, STDERR_FILENO);
  if (chdir(directory.c_str()) != 0)
    errno = 0;  // this machine lacks the folder; engine commands may fail with their own error
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  execv("/proc/self/exe", pointers.data());
  _exit(127);
}

// Waits for the child, renews the claim meanwhile and forwards an interrupt. Returns the status of waitpid.
int wait_for(pid_t child, const Claim& claim, double expiry) {
  Clock::time_point renewed = Clock::now();
  bool passed_on = false;
  int status = 0;
  for (int pause = 1000;; pause = std::min(2 * pause, 50'000)) {  // us
    if (waitpid(child, &status, WNOHANG) == child) return status;
    if (interrupted() && !passed_on) {
      kill(child, SIGINT);
      passed_on = true;
    }
    if (seconds_since(renewed) > expiry / 4) {
      claim.renew();
      renewed = Clock::now();
    }
    usleep(static_cast<useconds_t>(pause));
  }
}

std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return last;
}

std::string kind_of(int status, const std::string& message) {
  if (WIFSIGNALED(status)) {
    const char* name = sigabbrev_np(WTERMSIG(status));
    return fmt::format("killed by SIG{}", name != nullptr ? name : "?");
  }
  for (const int full : {ENOSPC, EFBIG, EDQUOT})
    if (message.find(std::strerror(full)) != std::string::npos) return "disk full";
  if (WEXITSTATUS(status) == 2) return "refused";
  if (WEXITSTATUS(status) >= 126) return "not started";
  return fmt::format("exit code {}", WEXITSTATUS(status));
}

void note_failure(const std::string& folder, int number, const std::string& kind,
                  const std::string& message) {
  Failure failure = read_failure(folder, number).value_or(Failure{});
  ++failure.attempts;
  failure.kind = kind;
  failure.message = message;
  failure.host = this_machine().host;
  // Throws if the disk is full: a worker that cannot record its failure would retry for ever.
  write_whole(path_in(folder, "failed", number) + ".json", to_json(failure));
}

void sync(const std::string& path, int flags) {
  const int file = open(path.c_str(), flags | O_CLOEXEC);
  if (file < 0) return;
  const bool lost = fsync(file) != 0 && errno != EINVAL && errno != EROFS;
  const int why = errno;
  close(file);
  if (lost)
    throw Error(Error::Kind::Io, fmt::format("file '{}'", path), "", "",
                fmt::format("cannot be written: {}", std::strerror(why)));
}

// Flushes a folder's files to the disk; returns the sizes of the results.
std::map<std::string, std::uintmax_t> keep_files(const fs::path& folder) {
  std::map<std::string, std::uintmax_t> out;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    sync(entry.path().string(), entry.is_directory() ? O_RDONLY | O_DIRECTORY : O_RDONLY);
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && name != kMessages) out[name] = entry.file_size();
  }
  return out;
}

// Moves complete results into place. If another process's results are there already, keeps those and returns
// false.
bool put_in_place(const std::string& from, const std::string& to, bool replace) {
  if (rename(from.c_str(), to.c_str()) == 0) return true;
  if (errno != ENOTEMPTY && errno != EEXIST)
    throw Error(Error::Kind::Io, fmt::format("folder '{}'", to), "", "",
                fmt::format("cannot be written: {}", std::strerror(errno)));
  if (!replace) return false;
  // One call exchanges the two, so that results exist at every instant.
  return renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_EXCHANGE) == 0;
}

/// A folder for results under way; removed unless the results were moved away.
class Doing {
 public:
  explicit Doing(std::string path) : path_(std::move(path)) {
    std::error_code code;
    fs::create_directories(path_, code);
    if (code)
      throw Error(Error::Kind::Io, fmt::format("folder '{}'", path_), "", "",
                  fmt::format("cannot be made: {}", code.message()));
  }
  Doing(const Doing&) = delete;
  Doing& operator=(const Doing&) = delete;
  ~Doing() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

Worked run(const std::string& folder, const Plan& plan, const Unit& unit, const WorkOptions& options,
           const Claim& claim) {
  const Doing doing(fmt::format("{}.{}", path_in(folder, "doing", unit.number), claim.nonce()));
  Done done{.number = unit.number, .machine = this_machine(options.kind), .began = time_text()};
  // Times the machine briefly if no cost is measured: three repetitions determine its speed well enough.
  const double calibrated = unit.cost ? options.calibration / 2 : 0;
  done.before = calibrate(calibrated);
  const Clock::time_point start = Clock::now();
  const pid_t child = fork();
  if (child < 0) throw Error(Error::Kind::Io, "a process", "", "", std::strerror(errno));
  if (child == 0) become(arguments_of(unit, folder, doing.path()), doing.path(), plan.directory);
  const int status = wait_for(child, claim, options.expiry);
  done.seconds = seconds_since(start);
  done.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (interrupted() || done.code == kInterruptedCode) return Worked::Interrupted;
  const std::string messages = doing.path() + "/" + kMessages;
  if (done.code != 0 && done.code != 1) {
    const std::string message = last_line(messages);
    note_failure(folder, unit.number, kind_of(status, message), message);
    return Worked::Failed;
  }
  done.after = calibrate(calibrated);
  done.ended = time_text();
  std::error_code ignored;
  if (fs::file_size(messages, ignored) == 0) fs::remove(messages, ignored);
  pack_files(doing.path());
  done.bytes = keep_files(doing.path());
  write_whole(doing.path() + "/unit.json", to_json(done));
  sync(doing.path() + "/unit.json", O_RDONLY);
  sync(doing.path(), O_RDONLY | O_DIRECTORY);
  const bool first = put_in_place(doing.path(), path_in(folder, "done", unit.number), options.again);
  sync(folder + "/done", O_RDONLY | O_DIRECTORY);
  fs::remove(path_in(folder, "failed", unit.number) + ".json", ignored);
  return first ? Worked::Done : Worked::Before;
}

}  // namespace

Worked do_unit(const std::string& folder, const Plan& plan, const Unit& unit, const WorkOptions& options,
               bool force) {
  std::error_code code;
  const std::string there = path_in(folder, "done", unit.number);
  if (!options.again && fs::exists(there, code)) return Worked::Before;
  bool died = false;
  const std::unique_ptr<Claim> claim = Claim::take(folder, unit.number, options.expiry, force, died);
  if (!claim) return Worked::Elsewhere;
  if (!options.again && fs::exists(there, code)) return Worked::Before;  // finished meanwhile
  if (died) note_failure(folder, unit.number, "its worker died", "");
  try {
    return run(folder, plan, unit, options, *claim);
  } catch (const std::exception& error) {
    note_failure(folder, unit.number, kind_of(1 << 8, error.what()), error.what());
    throw;
  }
}

Queue::Queue(const std::string& folder, const Plan& plan, const WorkOptions& options)
    : folder_(folder), plan_(plan), options_(options), host_(this_machine().host) {
  for (const Unit& unit : plan.units) open_.push_back(&unit);
  std::stable_sort(open_.begin(), open_.end(),
                   [](const Unit* a, const Unit* b) { return a->seconds > b->seconds; });
}

// Leaves out the units that are done, and those that have failed too often.
void Queue::leave_out_closed() {
  const std::set<int> done = numbers_in(folder_, "done"), failed = numbers_in(folder_, "failed");
  std::erase_if(open_, [&](const Unit* unit) {
    if (done.contains(unit->number)) return true;
    if (!failed.contains(unit->number)) return false;
    const std::optional<Failure> failure = read_failure(folder_, unit->number);
    return failure && failure->attempts >= options_.attempts;
  });
}

bool Queue::attempt(const Unit& unit, Worked& worked) const {
  worked = do_unit(folder_, plan_, unit, options_, false);
  return worked != Worked::Elsewhere && worked != Worked::Before;
}

std::optional<int> Queue::next(Worked& worked) {
  leave_out_closed();
  const std::set<int> claims = numbers_in(folder_, "claims");
  std::vector<const Unit*> claimed;
  for (const Unit* unit : open_) {
    if (interrupted()) return {};
    // Leaves a unit that should run on another host to other processes while there are any.
    const bool elsewhere = std::find(unit->avoid.begin(), unit->avoid.end(), host_) != unit->avoid.end();
    if (elsewhere && !claims.empty()) continue;
    if (claims.contains(unit->number)) {
      claimed.push_back(unit);
    } else if (attempt(*unit, worked)) {
      return unit->number;
    }
  }
  // Checks a few claims chosen at random, because a thousand waiting workers would otherwise all check all of
  // them.
  std::shuffle(claimed.begin(), claimed.end(), random_);
  claimed.resize(std::min(claimed.size(), kLookedAt));
  for (const Unit* unit : claimed) {
    if (interrupted()) return {};
    if (attempt(*unit, worked)) return unit->number;
  }
  remove_dead_claims(folder_, options_.expiry);
  leave_out_closed();
  return {};
}

}  // namespace plumb::harness::cluster
