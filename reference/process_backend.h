#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "engine/scene/error.h"
#include "reference/backend.h"

/// Engines that run as programs of their own, in any language: docs/protocol.md.
namespace plumb::reference {

/// Limits on an engine's program.
struct ProcessLimits {
  double seconds = 30;  ///< for each line of an answer, and for the program to accept a request
  std::size_t line_bytes = 64u << 20;  ///< longest line of a run, whose states grow with the number of bodies
  /// Longest line of any other answer. Hello and settings take a few thousand bytes, and their content is
  /// printed.
  std::size_t answer_bytes = 1u << 20;
};

/// A program's violation of the protocol. `what()` names the engine, the request, the problem and the last
/// lines of its stderr.
class ProcessError : public Error {
 public:
  enum class Fault {
    Start,     ///< it cannot be started (kind Io)
    Timeout,   ///< it did not answer in time
    Crash,     ///< it ended by a signal or an exit while an answer was expected
    Killed,    ///< it was ended by a signal from outside, which says nothing about the program
    Time,      ///< the time of a sample is not the expected one
    Protocol,  ///< its answer violates docs/protocol.md
    Diverged,  ///< a state that is not finite
  };

  ProcessError(Fault fault, const std::string& engine, const std::string& request, const std::string& problem)
      : Error(fault == Fault::Start ? Kind::Io : Kind::Run, "engine '" + engine + "'", request, "", problem),
        fault_(fault) {}

  Fault fault() const { return fault_; }

 private:
  Fault fault_;
};

/// Creates an adapter for the program `command` (its name, then its arguments; no shell is involved). A name
/// without a slash is searched in the folders of PLUMB_WORKER_PATH, in the folder of the running program, in
/// `../bin` from there, then in PATH. The program is started on the first query, once for all questions, and
/// once for each simulator. If a program cannot be started, or answers wrongly, the adapter is unavailable,
/// with the reason.
std::unique_ptr<Backend> make_process_backend(std::string name, std::vector<std::string> command,
                                              std::string summary = "", ProcessLimits limits = {});

}  // namespace plumb::reference
