#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "reference/backend.h"

namespace plumb::harness::thresholds {

/// Critical value of one engine, with the exact one.
struct Finding {
  enum class Outcome {
    Found,
    Always,   ///< holds over the whole range
    Never,    ///< holds nowhere in the range
    Refused,  ///< the engine lacks a feature that the scene needs, or is not installed
    Unclear,  ///< the answer changes more than once
  };

  std::string name, title, quantity, unit, source, judged;  ///< the threshold's own
  bool holds_below = true;  ///< true if it is the largest value that holds, false if the smallest
  std::optional<double> exact{};
  std::string engine;
  std::string engine_version{};
  std::string setting = "default";  ///< name of the settings
  reference::Settings settings{};   ///< effective settings of the adapter
  int digits = 3;
  Outcome outcome = Outcome::Found;
  std::optional<double> found{};
  double low = 0, high = 0;  ///< as in `Crossing`
  std::string reason{};      ///< failure beyond the value, contradiction if unclear, or reason of a refusal
  int runs = 0;
  double seconds = 0;  ///< wall time of the search

  /// Returns found / exact - 1, if both exist.
  std::optional<double> relative_difference() const;
};

std::string_view name_of(Finding::Outcome outcome);  ///< "found", "always", ...

/// Converts to one line of JSON, docs/formats.md. `finding_from_json` throws `Error` (Syntax).
std::string to_json(const Finding& finding);
Finding finding_from_json(std::string_view text);

/// Formats findings as CSV, one line each; the header names the columns.
std::string finding_csv_header();
std::string to_csv(const Finding& finding);

}  // namespace plumb::harness::thresholds
