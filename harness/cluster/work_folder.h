#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "harness/cluster/machine.h"

/// A folder of work: independent units, done by any number of processes on any number of machines that see
/// the folder. There is no server: all communication is by files that appear and folders that are renamed.
///     plan.json            program, settings
///     units.jsonl          one unit per line
///     claims/00001         exists while a process does unit 1
///     doing/00001.NONCE/   results of the unit under way
///     done/00001/          complete results, and unit.json
///     failed/00001.json    how the last attempt ended
namespace plumb::harness::cluster {

/// One part of the work: an invocation of plumb.
struct Unit {
  int number = 0;                      ///< from 1
  std::vector<std::string> arguments;  ///< without the program and --out; "{folder}" is the folder of work
  double seconds = 0;                  ///< estimated wall time
  bool measured = false;               ///< the estimate is from earlier results
  bool cost = false;                   ///< the unit measures costs and should have a machine to itself
  int repeats = 0;  ///< the unit that this one measures again, because other processes disturbed it; 0: none
  int attempt = 0;  ///< number of measurements of that unit before this one
  std::vector<std::string> avoid{};  ///< hosts on which the measurement was disturbed
  /// Arguments of a unit for the next round, which follows this unit and all others with the same `then`.
  std::vector<std::string> then{};
  double then_seconds = 0;  ///< estimated wall time of the unit `then`
};

/// Program that made a plan; the same program must do its units.
struct Program {
  std::string path, hash, version, commit;
  std::map<std::string, std::string> engines{};  ///< version of each installed engine
};

struct Plan {
  Program program;
  std::string directory;  ///< folder in which the plan was made; engine commands are relative to it
  std::vector<std::vector<std::string>> commands;
  std::vector<Unit> units{};

  const Unit& unit(int number) const;                         ///< throws `Error` (Value)
  bool measures_cost(const std::vector<int>& numbers) const;  ///< true if one of these does
};

/// Facts about a complete unit, besides its results.
struct Done {
  int number = 0;
  double seconds = 0;  ///< wall time
  int code = 0;        ///< exit code, 0 or 1
  Machine machine{};
  Calibration before{}, after{};
  std::string began{}, ended{};                   ///< UTC, by the machine's own clock
  std::map<std::string, std::uintmax_t> bytes{};  ///< size of each file of results
  bool noisy() const { return is_noisy(before, after); }
  double noise() const { return noise_of(before, after); }
};

/// How attempts at a unit failed.
struct Failure {
  int attempts = 0;
  std::string kind;     ///< of the last: "killed by SIGKILL", "disk full", "refused", ...
  std::string message;  ///< last line that the unit wrote
  std::string host;
};

/// Returns the program that runs, with a hash of its file (64 bits, FNV-1a).
Program this_program();

/// Throws `Error` (Value) if `plan` was made with another program than `now`, and says how to proceed.
void require_same_program(const std::string& folder, const Plan& plan, const Program& now);

/// Reads plan.json and units.jsonl. Throws `Error` (Io, Syntax).
Plan read_plan(const std::string& folder);

/// Adds those units that are new (units with identical arguments and the same attempt are not), numbered
/// after the existing ones. Creates the folder, or adds to that of the same program. Returns the number of
/// units added. Throws `Error`.
int add_to_plan(const std::string& folder, Plan plan);

/// Numbers of the units in done/, in claims/ and in failed/.
std::set<int> numbers_in(const std::string& folder, const std::string& part);

std::string name_of_unit(int number);  ///< "00001"
std::string path_in(const std::string& folder, const std::string& part, int number);

/// Reads the facts about a unit. Throws `Error` (Io, Syntax) if the file does not describe a complete unit.
Done read_done(const std::string& folder, int number);
std::string to_json(const Done& done);

std::optional<Failure> read_failure(const std::string& folder, int number);
std::string to_json(const Failure& failure);

/// Formats numbers as ranges, such as "1-4,7", the notation of sbatch.
std::string ranges(const std::vector<int>& numbers);

/// Returns the present time, UTC, ISO 8601.
std::string time_text();

/// Number of attempts after which `next` no longer tries a unit.
inline constexpr int kAttempts = 3;

}  // namespace plumb::harness::cluster
