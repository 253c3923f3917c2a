#include "harness/isolate.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <stdio_ext.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "reference/killed.h"
#include "reference/process_backend.h"

namespace plumb::harness {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongest = 1e9;  // s, small enough for a deadline to stay within the clock's range

struct Pipe {
  int read = -1, write = -1;

  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0) throw Error(Error::Kind::Io, "a pipe", "", "", std::strerror(errno));
    read = ends[0];
    write = ends[1];
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    close_read();
    close_write();
  }
  void close_read() { shut(read); }
  void close_write() { shut(write); }

 private:
  static void shut(int& end) {
    if (end >= 0) close(end);
    end = -1;
  }
};

void write_all(int file, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t count = write(file, text.data() + done, text.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;
    done += static_cast<std::size_t>(count);
  }
}

// Memory is not limited under address sanitizers, which reserve more than there is.
void limit_memory(std::size_t bytes) {
#if !defined(__SANITIZE_ADDRESS__)
  if (bytes == 0) return;
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
#else
  static_cast<void>(bytes);
#endif
}

[[noreturn]] void run_child(const std::function<std::string()>& work, std::size_t memory, const Pipe& answer,
                            const Pipe& output) {
  setpgid(0, 0);
  limit_memory(memory);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  signal(SIGPIPE, SIG_IGN);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  dup2(output.write, STDOUT_FILENO);
  dup2(output.write, STDERR_FILENO);
  __fpurge(stdout);  // drops what the parent has printed and writes itself
  // The first character is the outcome: + for a result, - for an error, ! if the
  // engine's own program was killed.
  try {
    write_all(answer.write, "+" + work());
  } catch (const reference::ProcessError& error) {
    const bool killed = error.fault() == reference::ProcessError::Fault::Killed;
    write_all(answer.write, fmt::format("{}{}", killed ? '!' : '-', error.what()));
  } catch (const std::exception& error) {
    write_all(answer.write, fmt::format("-{}", error.what()));
  } catch (...) {
    write_all(answer.write, "-an exception without a message");
  }
  _exit(0);
}

// Reads the available bytes; false at the end of the file.
bool drain(int file, std::string& text) {
  char buffer[65536];
  const ssize_t count = read(file, buffer, sizeof buffer);
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  text.append(buffer, static_cast<std::size_t>(count));
  return count > 0;
}

bool poll_now(int file) {
  pollfd entry{file, POLLIN, 0};
  return poll(&entry, 1, 0) > 0;
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of(" \r\n\t");
  if (end == std::string::npos) return "";
  const std::size_t start = text.find_last_of('\n', end);
  return text
      .substr(start == std::string::npos ? 0 : start + 1,
              end - (start == std::string::npos ? 0 : start + 1) + 1)
      .substr(0, 200);
}

std::string how_it_died(int status, const std::string& printed) {
  std::string text;
  if (WIFSIGNALED(status)) {
    const int number = WTERMSIG(status);
    const char* name = sigabbrev_np(number);
    text = fmt::format("signal {} (SIG{})", number, name != nullptr ? name : "?");
  } else {
    text = fmt::format("exit code {} without an answer", WEXITSTATUS(status));
  }
  const std::string words = last_line(printed);
  return words.empty() ? text : fmt::format("{}: {}", text, words);
}

/// A forked child at work.
struct Child {
  std::size_t index = 0;
  int attempt = 1;
  pid_t process = -1;
  Pipe answer, output;
  std::string text, printed;
  ChildLimits limits{0};
  Clock::time_point began, deadline;
  std::size_t memory = 0;  // bytes, known once the process has been waited for
  bool open = true;
  bool killed = false;  // from outside

  Child() = default;
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (process > 0) wait();
  }

  // Kills the process and all processes that it has started; returns its status.
  int wait() {
    if (open) kill(-process, SIGKILL);
    int status = 0;
    rusage used{};
    while (wait4(process, &status, 0, &used) < 0 && errno == EINTR) {
    }
    memory = static_cast<std::size_t>(used.ru_maxrss) * 1024;
    kill(-process, SIGKILL);
    process = -1;
    return status;
  }
};

std::unique_ptr<Child> start(std::size_t index, int attempt,
                             const std::function<std::string(std::size_t)>& work, const ChildLimits& limits) {
  auto child = std::make_unique<Child>();
  child->index = index;
  child->attempt = attempt;
  child->limits = limits;
  child->began = Clock::now();
  child->process = fork();
  if (child->process < 0) throw Error(Error::Kind::Io, "a process", "", "", std::strerror(errno));
  if (child->process == 0)
    run_child([&] { return work(index); }, limits.memory, child->answer, child->output);
  setpgid(child->process, child->process);
  child->answer.close_write();
  child->output.close_write();
  child->deadline = child->began + std::chrono::duration_cast<Clock::duration>(
                                       std::chrono::duration<double>(std::min(limits.seconds, kLongest)));
  return child;
}

// Waits for output of any of the children and stores it.
void listen(const std::vector<std::unique_ptr<Child>>& children) {
  std::vector<pollfd> files;
  for (const auto& child : children) {
    files.push_back({child->answer.read, POLLIN, 0});
    files.push_back({child->output.read, POLLIN, 0});  // a closed file is -1, which poll skips
  }
  poll(files.data(), files.size(), 100);
  for (std::size_t i = 0; i < children.size(); ++i) {
    Child& child = *children[i];
    if (files[2 * i + 1].revents != 0 && !drain(child.output.read, child.printed)) child.output.close_read();
    if (child.printed.size() > 65536) child.printed.erase(0, child.printed.size() - 4096);
    if (files[2 * i].revents != 0) child.open = drain(child.answer.read, child.text);
  }
}

Outcome how_it_ended(Child& child, int status) {
  if (child.open && interrupted()) return {Outcome::Kind::Interrupted, ""};
  if (child.open) return {Outcome::Kind::Timeout, fmt::format("no end within {:g} s", child.limits.seconds)};
  while (child.output.read >= 0 && poll_now(child.output.read) && drain(child.output.read, child.printed)) {
  }
  const bool engine_killed = child.text.starts_with('!');
  if (child.text.empty() || engine_killed) {
    child.killed = engine_killed || (WIFSIGNALED(status) && reference::comes_from_outside(WTERMSIG(status)));
    std::string text = engine_killed ? child.text.substr(1) : how_it_died(status, child.printed);
    if (child.killed) text += fmt::format(", in each of {} attempts", child.attempt);
    return {Outcome::Kind::Crashed, std::move(text)};
  }
  const bool failed = child.text.front() == '-';
  return {failed ? Outcome::Kind::Failed : Outcome::Kind::Done, child.text.substr(1)};
}

Outcome end(Child& child) {
  const int status = child.wait();
  Outcome outcome = how_it_ended(child, status);
  outcome.seconds = std::chrono::duration<double>(Clock::now() - child.began).count();
  outcome.memory = child.memory;
  return outcome;
}

}  // namespace

void isolate_all(std::size_t count, int jobs, const std::function<ChildLimits(std::size_t)>& limits,
                 const std::function<std::string(std::size_t)>& work,
                 const std::function<void(std::size_t, const Outcome&)>& done) {
  std::vector<std::unique_ptr<Child>> running;
  std::size_t next = 0;
  while (next < count || !running.empty()) {
    while (next < count && running.size() < static_cast<std::size_t>(std::max(1, jobs)) && !interrupted()) {
      running.push_back(start(next, 1, work, limits(next)));
      ++next;
    }
    if (running.empty()) break;  // interrupted
    listen(running);
    for (std::size_t i = 0; i < running.size();) {
      Child& child = *running[i];
      if (child.open && !interrupted() && Clock::now() <= child.deadline) {
        ++i;
        continue;
      }
      const std::size_t index = child.index;
      const Outcome outcome = end(child);
      if (child.killed && child.attempt < reference::kAttempts && !interrupted()) {
        running[i] = start(index, child.attempt + 1, work, limits(index));
        continue;
      }
      running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
      done(index, outcome);
    }
  }
  for (; next < count; ++next) done(next, {Outcome::Kind::Interrupted, ""});
}

void isolate_all(std::size_t count, int jobs, const ChildLimits& limits,
                 const std::function<std::string(std::size_t)>& work,
                 const std::function<void(std::size_t, const Outcome&)>& done) {
  isolate_all(
      count, jobs, [&](std::size_t) { return limits; }, work, done);
}

Outcome isolate(const std::function<std::string()>& work, const ChildLimits& limits) {
  Outcome result;
  isolate_all(
      1, 1, limits, [&](std::size_t) { return work(); },
      [&](std::size_t, const Outcome& outcome) { result = outcome; });
  return result;
}

}  // namespace plumb::harness
