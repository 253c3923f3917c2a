#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace plumb::harness::hunt {

/// Outcome of a task.
struct Answer {
  std::uint64_t task = 0;
  enum class Kind { Done, Died, Hung } kind = Kind::Done;
  std::string text;  ///< the returned text, or how the process died
};

/// Forked processes that execute one task after the other, without a fork for each. A process that dies or
/// exceeds its time limit is replaced; the task of a process that was killed from outside is repeated. Call
/// this without threads running.
class Workers {
 public:
  using Work = std::function<std::string(std::uint64_t task)>;

  /// `seconds`: processor time limit of a task; the limit of wall time is 20 times that.
  Workers(int count, double seconds, Work work);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();

  int idle() const;
  bool busy() const;
  /// Gives `task` to an idle worker.
  void start(std::uint64_t task);
  /// Waits for at most 0.1 s and returns the tasks that have ended.
  std::vector<Answer> wait();

 private:
  struct Worker;
  void fork_anew(Worker& worker);
  void give(Worker& worker, std::uint64_t task, int attempt);
  void end(Worker& worker);

  double seconds_;
  Work work_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace plumb::harness::hunt
