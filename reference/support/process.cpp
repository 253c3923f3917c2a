#include "reference/support/process.h"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <thread>

#include "engine/core/text.h"
#include "reference/killed.h"
#include "reference/support/supervisor.h"

namespace plumb::reference {
namespace {

using std::chrono::milliseconds;
using Fault = ProcessError::Fault;

constexpr milliseconds kGrace{500};         ///< s for a program to end by itself once its input is closed
constexpr std::size_t kStderrBytes = 4096;  ///< bytes of stderr that are kept
constexpr std::size_t kStderrLines = 5;     ///< bytes of stderr that an error shows

struct Pipe {
  FileDescriptor read{}, write{};
};

/// Creates a pipe that other programs do not inherit. Avoids the descriptors 0 to 2, which become a child's
/// standard streams.
Pipe make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) return Pipe{};
  Pipe out{FileDescriptor(ends[0]), FileDescriptor(ends[1])};
  for (FileDescriptor* end : {&out.read, &out.write}) {
    if (end->get() <= STDERR_FILENO) *end = FileDescriptor(fcntl(end->get(), F_DUPFD_CLOEXEC, 3));
  }
  return out;
}

void set_nonblocking(const FileDescriptor& file) {
  fcntl(file.get(), F_SETFL, fcntl(file.get(), F_GETFL) | O_NONBLOCK);
}

/// Returns the path of the worker called `name`: see `make_process_backend`.
std::string locate(const std::string& name) {
  namespace fs = std::filesystem;
  if (name.find('/') != std::string::npos) return name;
  std::vector<fs::path> folders;
  if (const char* given = std::getenv("PLUMB_WORKER_PATH")) {
    std::string_view rest = given;
    while (!rest.empty()) {
      const std::size_t colon = std::min(rest.find(':'), rest.size());
      folders.emplace_back(rest.substr(0, colon));
      rest.remove_prefix(std::min(colon + 1, rest.size()));
    }
  }
  std::error_code unreadable;
  const fs::path program = fs::read_symlink("/proc/self/exe", unreadable);
  if (!unreadable) {
    folders.push_back(program.parent_path());
    folders.push_back(program.parent_path().parent_path() / "bin");
  }
  for (const fs::path& folder : folders) {
    const fs::path candidate = folder / name;
    if (!folder.empty() && access(candidate.c_str(), X_OK) == 0) return candidate.string();
  }
  return name;  // execvp looks in PATH
}

/// Starts `command` under a supervisor, whose process id is stored in `pid`, with its standard streams on the
/// given pipe ends. Returns 0 or an errno.
int spawn(const std::vector<std::string>& command, const std::array<int, 3>& streams, pid_t& pid) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const std::string program = locate(command[0]);
  Pipe problem = make_pipe();
  if (!problem.write.open()) return errno;

  // Blocks all signals, so that no handler of the host runs in the child.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child == 0) supervise({program.c_str(), arguments.data(), streams}, parent, problem.write.get());
  const int fork_problem = errno;
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  if (child < 0) return fork_problem;

  problem.write.close();
  int number = 0;
  ssize_t count = 0;
  while ((count = read(problem.read.get(), &number, sizeof number)) < 0 && errno == EINTR) {
  }
  if (count == 0) {  // closed when the program has been executed
    pid = child;
    return 0;
  }
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
  }
  return number;
}

/// Calls write(2) on a pipe whose reader may be gone: fails with EPIPE instead of raising SIGPIPE.
ssize_t write_without_signal(int file, std::string_view bytes) {
  sigset_t piped, before, pending;
  sigemptyset(&piped);
  sigaddset(&piped, SIGPIPE);
  sigpending(&pending);
  const bool was_pending = sigismember(&pending, SIGPIPE) == 1;
  pthread_sigmask(SIG_BLOCK, &piped, &before);
  const ssize_t written = write(file, bytes.data(), bytes.size());
  const int problem = errno;
  if (written < 0 && problem == EPIPE && !was_pending) {
    const timespec at_once{};
    while (sigtimedwait(&piped, nullptr, &at_once) < 0 && errno == EINTR) {
    }
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = problem;
  return written;
}

}  // namespace

void FileDescriptor::close() {
  if (number_ >= 0) ::close(number_);
  number_ = -1;
}

Process::Process(std::string engine, std::vector<std::string> command, ProcessLimits limits)
    : engine_(std::move(engine)), limits_(limits), request_("start"), owner_(getpid()) {
  if (command.empty() || command[0].empty()) {
    throw ProcessError(Fault::Start, engine_, "command", "no program is given");
  }
  Pipe input = make_pipe(), output = make_pipe(), errors = make_pipe();
  int problem = errno;
  if (input.write.open() && output.write.open() && errors.write.open()) {
    problem = spawn(command, {input.read.get(), output.write.get(), errors.write.get()}, pid_);
  }
  if (pid_ < 0 || problem != 0) {
    pid_ = -1;
    throw ProcessError(Fault::Start, engine_, "command",
                       plumb::quoted(command[0]) + " cannot be started: " + std::strerror(problem));
  }
  input_ = std::move(input.write);
  output_ = std::move(output.read);
  errors_ = std::move(errors.read);
  for (const FileDescriptor* file : {&input_, &output_, &errors_}) set_nonblocking(*file);
}

Process::~Process() {
  if (!owned()) return;
  input_.close();
  if (pid_ > 0) wait_for_end(kGrace);
  kill_and_reap();
}

bool Process::owned() const { return getpid() == owner_; }

void Process::write_line(std::string_view line, const std::string& request) {
  request_ = request;
  if (pid_ < 0) throw ProcessError(Fault::Crash, engine_, request_, "the program has ended before");
  const auto deadline = next_deadline();
  std::string message(line);
  message += '\n';
  std::string_view rest = message;
  while (!rest.empty()) {
    const ssize_t written = write_without_signal(input_.get(), rest);
    if (written >= 0) {
      rest.remove_prefix(static_cast<std::size_t>(written));
    } else if (errno == EAGAIN || errno == EINTR) {
      if (!wait_for_pipes(deadline, true)) throw timed_out();
      if (!read_output()) throw ended();
      if (received_.size() > limits_.line_bytes) throw too_long(limits_.line_bytes);
    } else {
      throw ended();
    }
  }
}

std::string Process::read_line(std::size_t most) {
  const auto deadline = next_deadline();
  while (true) {
    const std::size_t newline = received_.find('\n', scanned_);
    if (newline != std::string::npos) {
      std::string line = received_.substr(0, newline);
      received_.erase(0, newline + 1);
      scanned_ = 0;
      if (line.size() > most) break;
      return line;
    }
    scanned_ = received_.size();
    if (received_.size() > most) break;
    if (pid_ < 0 || !output_.open()) throw ended();
    if (!wait_for_pipes(deadline, false)) throw timed_out();
    if (!read_output()) throw ended();
  }
  throw too_long(most);
}

Process::Clock::time_point Process::next_deadline() const {
  return Clock::now() +
         std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits_.seconds));
}

/// Waits for output (or, when `writing`, for room for input) and reads stderr meanwhile. Returns false if the
/// deadline passes first.
bool Process::wait_for_pipes(Clock::time_point deadline, bool writing) {
  while (true) {
    const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now()).count();
    if (left <= 0) return false;
    std::array<pollfd, 3> files{pollfd{output_.get(), POLLIN, 0}, pollfd{errors_.get(), POLLIN, 0},
                                pollfd{writing ? input_.get() : -1, POLLOUT, 0}};
    poll(files.data(), files.size(), static_cast<int>(std::min<long long>(left, 60'000)));
    if (files[1].revents != 0) read_errors();
    if (files[0].revents != 0 || files[2].revents != 0) return true;
  }
}

/// Reads available output. Returns false at its end.
bool Process::read_output() {
  std::array<char, 65536> chunk;
  const ssize_t count = read(output_.get(), chunk.data(), chunk.size());
  if (count > 0) received_.append(chunk.data(), static_cast<std::size_t>(count));
  return count > 0 || (count < 0 && (errno == EAGAIN || errno == EINTR));
}

void Process::read_errors() {
  std::array<char, 4096> chunk;
  while (errors_.open()) {
    const ssize_t count = read(errors_.get(), chunk.data(), chunk.size());
    if (count > 0) {
      stderr_tail_.append(chunk.data(), static_cast<std::size_t>(count));
      if (stderr_tail_.size() > kStderrBytes) stderr_tail_.erase(0, stderr_tail_.size() - kStderrBytes);
    } else if (count == 0) {
      errors_.close();
    } else if (errno != EINTR) {
      return;
    }
  }
}

ProcessError Process::fail(Fault fault, std::string problem) {
  kill_and_reap();
  return {fault, engine_, request_, problem + last_words()};
}

ProcessError Process::timed_out() {
  return fail(Fault::Timeout, "it did not answer within " + shortest(limits_.seconds) + " s");
}

ProcessError Process::too_long(std::size_t most) {
  return fail(Fault::Protocol, "it sent a line of more than " + std::to_string(most) + " bytes");
}

ProcessError Process::ended() {
  const bool torn = !received_.empty();
  std::string problem = status_when_ended();
  if (torn) problem += ", in the middle of a line";
  const bool killed = pid_ <= 0 && WIFSIGNALED(status_) && comes_from_outside(WTERMSIG(status_));
  return fail(killed ? Fault::Killed : Fault::Crash, std::move(problem));
}

/// Returns a description, for an error, of how a program ended that closed a pipe. Waits at most `kGrace` for
/// its end.
std::string Process::status_when_ended() {
  if (pid_ > 0 && !wait_for_end(kGrace)) return "it closed its output";
  kill_and_reap();
  if (WIFSIGNALED(status_)) {
    const int number = WTERMSIG(status_);
    return "it was killed by signal " + std::to_string(number) + " (" + strsignal(number) + ")";
  }
  return "it ended with exit code " + std::to_string(WEXITSTATUS(status_));
}

/// Returns the last lines of the program's stderr, to be appended to an error.
std::string Process::last_words() {
  read_errors();
  std::vector<std::string> lines;
  std::size_t start = 0;
  while (start < stderr_tail_.size()) {
    const std::size_t end = std::min(stderr_tail_.find('\n', start), stderr_tail_.size());
    if (end > start) lines.push_back(printable(stderr_tail_.substr(start, end - start), 200));
    start = end + 1;
  }
  std::string out;
  for (std::size_t i = lines.size() - std::min(lines.size(), kStderrLines); i < lines.size(); ++i) {
    out += (out.empty() ? "; its stderr: " : " | ") + lines[i];
  }
  return out;
}

/// Waits at most `limit` and returns true if the program has ended. Does not reap it.
bool Process::wait_for_end(milliseconds limit) const {
  const auto deadline = Clock::now() + limit;
  while (true) {
    siginfo_t info{};
    if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0) {
      return true;
    }
    if (Clock::now() >= deadline) return false;
    std::this_thread::sleep_for(milliseconds(1));
  }
}

void Process::kill_and_reap() {
  if (pid_ <= 0 || !owned()) return;
  kill(pid_, SIGTERM);
  while (waitpid(pid_, &status_, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  input_.close();
  output_.close();
}

}  // namespace plumb::reference
