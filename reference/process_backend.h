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
  double seconds = 30;                 ///< for each line of an answer, and for the program to take a request
  std::size_t line_bytes = 64u << 20;  ///< longest line of a run, where states grow with the bodies
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
    Killed,    ///< it ended by a signal from outside, which says nothing about it
    Time,      ///< a sample's time is not the one that is due
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

/// An adapter for the program `command` (its name, then its arguments; no shell is involved). A name without
/// a slash is looked for in the folders of PLUMB_WORKER_PATH, beside the running program, in `../bin` from
/// there, then in PATH. The program is started when first asked about, once to answer questions and once more
/// for each simulator; a program that cannot be started, or answers wrongly, makes an adapter that is not
/// available, with the reason.
std::unique_ptr<Backend> make_process_backend(std::string name, std::vector<std::string> command,
                                              std::string summary = "", ProcessLimits limits = {});

}  // namespace plumb::reference
