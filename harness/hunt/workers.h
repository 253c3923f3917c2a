#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace plumb::harness::hunt {

/// How a piece of work ended.
struct Answer {
  std::uint64_t task = 0;
  enum class Kind { Done, Died, Hung } kind = Kind::Done;
  std::string text;  ///< what the work returned, or how its process died
};

/// Forked processes that do one piece of work after the other, each as fast as a call. One that dies or takes
/// longer than its time is replaced. Call without threads running.
class Workers {
 public:
  using Work = std::function<std::string(std::uint64_t task)>;

  /// `seconds`: of processor time that a piece may take, and a twentieth of the wall time.
  Workers(int count, double seconds, Work work);
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;
  ~Workers();

  int idle() const;
  bool busy() const;
  /// Gives `task` to an idle worker.
  void start(std::uint64_t task);
  /// Waits for at most 0.1 s and returns what has ended.
  std::vector<Answer> wait();

 private:
  struct Worker;
  void fork_anew(Worker& worker);
  void end(Worker& worker);

  double seconds_;
  Work work_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace plumb::harness::hunt
