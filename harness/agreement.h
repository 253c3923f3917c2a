#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/result.h"
#include "harness/style.h"

namespace plumb::harness {

/// A check that one engine missed in one case.
struct Miss {
  std::string check;  ///< "position_error"
  double value = 0;   ///< measured
  double bound = 0;   ///< derived

  /// Returns value/bound; infinity for a bound of zero or a value that is not a number.
  double times() const;
};

/// Formats a miss as a multiple of its bound: "12 x".
std::string times_text(const Miss& miss);

/// An engine that ran a case and missed checks.
struct Dissent {
  std::string engine;
  std::vector<Miss> misses;  ///< the largest multiple of its bound first
  std::string reason;        ///< the declared reasons, joined; says so if none is declared
};

/// An engine without a motion to judge in a case.
struct Absence {
  std::string engine, why;
  bool broke = false;  ///< failed, crashed or took too long; false: does not support the scene
};

/// Engines that agree on one case, all at the same settings.
struct Agreement {
  std::string label, truth;
  std::vector<std::string> versions{};  ///< "box2d 2.4.1": of the engines that ran
  std::vector<std::string> agree;       ///< with the truth: every check is within its bound
  std::vector<Dissent> dissents;
  std::vector<Absence> absent;
  /// Largest sets of two or more engines in which each pair differs by at most the sum of its bounds.
  std::vector<std::vector<std::string>> groups;

  std::size_t ran() const { return agree.size() + dissents.size(); }

  /// Returns the engines that are in a group with `engine`.
  std::vector<std::string> partners(std::string_view engine) const;
};

/// Derives the agreement of every case in `results`, in the order of the cases. Takes the last result of each
/// engine for a case at the default settings. If no engine has a result at these settings, takes the settings
/// of the first result.
std::vector<Agreement> agreements(std::span<const Result> results);

enum class AgreementDetail {
  Brief,  ///< how many engines agree on each case, and which miss by how much
  Full,   ///< also the names of the engines that agree, with the truth and with each other
};

/// Formats agreements for people: cases with misses one by one, the other cases together, each reason once.
std::string agreement_text(std::span<const Agreement> cases, AgreementDetail detail, const Style& style);

/// Formats a case as one line of JSON. `agreement_from_json` reads it back; it throws `Error` (Syntax).
std::string agreement_json(const Agreement& one);
Agreement agreement_from_json(std::string_view text);

/// Reads a file of such lines. Throws `Error` (Io, Syntax).
std::vector<Agreement> read_agreements(const std::string& path);

/// Formats cases as CSV: a line per case, engine and missed check.
std::string agreement_csv(std::span<const Agreement> cases);

}  // namespace plumb::harness
