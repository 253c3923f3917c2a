#include "harness/isolate.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <exception>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "engine/scene/error.h"
#include "harness/interrupt.h"

namespace plumb::harness {
namespace {

using Clock = std::chrono::steady_clock;

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

[[noreturn]] void run_child(const std::function<std::string()>& work, const Pipe& answer,
                            const Pipe& output) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
  signal(SIGPIPE, SIG_IGN);
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing >= 0) dup2(nothing, STDIN_FILENO);
  dup2(output.write, STDOUT_FILENO);
  dup2(output.write, STDERR_FILENO);
  // The first character says how it ended.
  try {
    write_all(answer.write, "+" + work());
  } catch (const std::exception& error) {
    write_all(answer.write, fmt::format("-{}", error.what()));
  } catch (...) {
    write_all(answer.write, "-an exception without a message");
  }
  _exit(0);
}

// Reads what is there; false at the end of the file.
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

}  // namespace

Outcome isolate(const std::function<std::string()>& work, double seconds) {
  if (interrupted()) return {Outcome::Kind::Interrupted, ""};
  Pipe answer, output;
  const pid_t child = fork();
  if (child < 0) throw Error(Error::Kind::Io, "a process", "", "", std::strerror(errno));
  if (child == 0) run_child(work, answer, output);
  setpgid(child, child);
  answer.close_write();
  output.close_write();

  std::string text, printed;
  const auto deadline = Clock::now() + std::chrono::duration<double>(seconds);
  bool open = true, late = false;
  while (open && !interrupted() && !late) {
    pollfd files[] = {{answer.read, POLLIN, 0}, {output.read, POLLIN, 0}};
    poll(files, 2, 100);
    if (files[1].revents != 0 && !drain(output.read, printed)) output.close_read();
    if (printed.size() > 65536) printed.erase(0, printed.size() - 4096);
    if (files[0].revents != 0) open = drain(answer.read, text);
    late = Clock::now() > deadline;
  }
  if (open) kill(-child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  kill(-child, SIGKILL);  // what the child itself has started
  if (open && interrupted()) return {Outcome::Kind::Interrupted, ""};
  if (open) return {Outcome::Kind::Timeout, fmt::format("no end within {:g} s", seconds)};
  while (output.read >= 0 && poll_now(output.read) && drain(output.read, printed)) {
  }
  if (text.empty()) return {Outcome::Kind::Crashed, how_it_died(status, printed)};
  const bool failed = text.front() == '-';
  return {failed ? Outcome::Kind::Failed : Outcome::Kind::Done, text.substr(1)};
}

}  // namespace plumb::harness
