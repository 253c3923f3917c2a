#include "harness/hunt/workers.h"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <exception>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/scene/error.h"
#include "harness/hunt/processor_time.h"
#include "harness/interrupt.h"
#include "reference/killed.h"

namespace plumb::harness::hunt {
namespace {

using Clock = std::chrono::steady_clock;

bool write_all(int file, const char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t count = write(file, data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    data += count, size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool read_all(int file, char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t count = read(file, data, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    data += count, size -= static_cast<std::size_t>(count);
  }
  return true;
}

// Reads tasks and writes answers, each preceded by its length, until the other end is closed.
[[noreturn]] void serve(int tasks, int answers, const Workers::Work& work) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  if (const int nothing = open("/dev/null", O_RDWR); nothing >= 0)
    for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, file);
  for (std::uint64_t task = 0; read_all(tasks, reinterpret_cast<char*>(&task), sizeof task);) {
    std::string text;
    try {
      text = work(task);
    } catch (const std::exception& error) {
      text = fmt::format("!{}", error.what());
    }
    const std::uint64_t size = text.size();
    if (!write_all(answers, reinterpret_cast<const char*>(&size), sizeof size) ||
        !write_all(answers, text.data(), text.size()))
      break;
  }
  _exit(0);
}

// Returns the processor time of another process, s; 0 if it has ended.
double processor_seconds_of(pid_t process) {
  clockid_t clock{};
  timespec now{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &now) != 0) return 0;
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

std::string how_it_died(int status) {
  if (!WIFSIGNALED(status)) return fmt::format("its process ended with {}", WEXITSTATUS(status));
  const char* name = sigabbrev_np(WTERMSIG(status));
  return fmt::format("its process died of signal {} (SIG{})", WTERMSIG(status), name != nullptr ? name : "?");
}

}  // namespace

struct Workers::Worker {
  pid_t process = -1;
  int tasks = -1, answers = -1;
  bool at_work = false;
  std::uint64_t task = 0;
  int attempt = 1;
  Clock::time_point deadline;
  double began = 0;  // s, processor time
  std::string received;
};

Workers::Workers(int count, double seconds, Work work) : seconds_(seconds), work_(std::move(work)) {
  for (int i = 0; i < std::max(1, count); ++i) workers_.push_back(std::make_unique<Worker>());
}

Workers::~Workers() {
  for (auto& worker : workers_) end(*worker);
}

void Workers::end(Worker& worker) {
  if (worker.process <= 0) return;
  kill(-worker.process, SIGKILL);
  kill(worker.process, SIGKILL);
  while (waitpid(worker.process, nullptr, 0) < 0 && errno == EINTR) {
  }
  close(worker.tasks), close(worker.answers);
  worker = {};
}

void Workers::fork_anew(Worker& worker) {
  int tasks[2], answers[2];
  if (pipe2(tasks, O_CLOEXEC) != 0 || pipe2(answers, O_CLOEXEC) != 0)
    throw Error(Error::Kind::Io, "a pipe", "", "", std::strerror(errno));
  worker.process = fork();
  if (worker.process < 0) throw Error(Error::Kind::Io, "a process", "", "", std::strerror(errno));
  if (worker.process == 0) {
    close(tasks[1]), close(answers[0]);
    for (const auto& other : workers_)
      if (other->tasks >= 0) close(other->tasks), close(other->answers);
    serve(tasks[0], answers[1], work_);
  }
  setpgid(worker.process, worker.process);
  close(tasks[0]), close(answers[1]);
  worker.tasks = tasks[1], worker.answers = answers[0];
  worker.received.clear();
}

int Workers::idle() const {
  return static_cast<int>(
      std::count_if(workers_.begin(), workers_.end(), [](const auto& w) { return !w->at_work; }));
}

bool Workers::busy() const { return idle() < static_cast<int>(workers_.size()); }

void Workers::start(std::uint64_t task) {
  const auto idle =
      std::find_if(workers_.begin(), workers_.end(), [](const auto& worker) { return !worker->at_work; });
  if (idle != workers_.end()) give(**idle, task, 1);
}

void Workers::give(Worker& worker, std::uint64_t task, int attempt) {
  if (worker.process <= 0) fork_anew(worker);
  worker.at_work = true, worker.task = task, worker.attempt = attempt;
  worker.began = processor_seconds_of(worker.process);
  worker.deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(kPatience * seconds_));
  // If this fails the worker has died, which `wait` detects.
  write_all(worker.tasks, reinterpret_cast<const char*>(&task), sizeof task);
}

std::vector<Answer> Workers::wait() {
  std::vector<pollfd> files;
  for (const auto& worker : workers_) files.push_back({worker->at_work ? worker->answers : -1, POLLIN, 0});
  poll(files.data(), files.size(), 100);
  std::vector<Answer> out;
  for (std::size_t i = 0; i < workers_.size(); ++i) {
    Worker& worker = *workers_[i];
    if (!worker.at_work) continue;
    bool open = true;
    if (files[i].revents != 0) {
      char buffer[65536];
      const ssize_t count = read(worker.answers, buffer, sizeof buffer);
      if (count > 0) worker.received.append(buffer, static_cast<std::size_t>(count));
      open = count > 0 || (count < 0 && errno == EINTR);
    }
    std::uint64_t size = 0;
    if (worker.received.size() >= sizeof size) std::memcpy(&size, worker.received.data(), sizeof size);
    if (worker.received.size() >= sizeof size && worker.received.size() - sizeof size >= size) {
      out.push_back({worker.task, Answer::Kind::Done, worker.received.substr(sizeof size, size)});
      worker.received.clear();
      worker.at_work = false;
    } else if (!open) {
      int status = 0;
      while (waitpid(worker.process, &status, 0) < 0 && errno == EINTR) {
      }
      const Answer answer{worker.task, Answer::Kind::Died, how_it_died(status)};
      const int attempt = worker.attempt;
      const bool killed = WIFSIGNALED(status) && reference::comes_from_outside(WTERMSIG(status));
      close(worker.tasks), close(worker.answers);
      worker = {};
      if (killed && attempt < reference::kAttempts && !interrupted())
        give(worker, answer.task, attempt + 1);
      else
        out.push_back(answer);
    } else if (Clock::now() > worker.deadline ||
               processor_seconds_of(worker.process) - worker.began > seconds_) {
      out.push_back({worker.task, Answer::Kind::Hung, fmt::format("no end within {:g} s", seconds_)});
      end(worker);
    }
  }
  return out;
}

}  // namespace plumb::harness::hunt
