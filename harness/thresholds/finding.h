#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "reference/backend.h"

namespace plumb::harness::thresholds {

/// One engine's critical value beside the exact one.
struct Finding {
  enum class Outcome {
    Found,
    Always,   ///< holds over the whole range
    Never,    ///< holds nowhere in the range
    Refused,  ///< the engine does not have what the scene needs, or is not installed
    Unclear,  ///< the answer changes more than once
  };

  std::string name, title, quantity, unit, source, judged;  ///< the threshold's own
  bool holds_below = true;  ///< whether it is the largest value that holds, or the smallest
  std::optional<double> exact{};
  std::string engine;
  std::string engine_version{};
  std::string setting = "default";  ///< what the settings are called
  reference::Settings settings{};   ///< what the adapter chose
  int digits = 3;
  Outcome outcome = Outcome::Found;
  std::optional<double> found{};
  double low = 0, high = 0;  ///< as in `Crossing`
  std::string reason{};      ///< what happens beyond, or what is not clear, or why it was refused
  int runs = 0;
  double seconds = 0;  ///< wall time of the search

  /// found / exact - 1, where both are there.
  std::optional<double> relative_difference() const;
};

std::string_view name_of(Finding::Outcome outcome);  ///< "found", "always", ...

/// As one line of JSON, docs/formats.md. `finding_from_json` throws `Error` (Syntax).
std::string to_json(const Finding& finding);
Finding finding_from_json(std::string_view text);

/// One line a finding; the first line names the columns.
std::string finding_csv_header();
std::string to_csv(const Finding& finding);

}  // namespace plumb::harness::thresholds
