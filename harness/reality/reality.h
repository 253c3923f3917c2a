#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "harness/reality/drops.h"
#include "harness/reality/ellipse.h"
#include "harness/style.h"
#include "reference/backend.h"

namespace plumb::harness::reality {

/// Everything that `plumb reality` finds.
struct Findings {
  std::uint64_t seed = 1;  ///< of the halves and of the bootstrap samples
  EllipseFindings ellipse;
  DropFindings drops;
};

/// Examines the two data sets of `folder`. Throws `Error` (Io, Syntax, Value) for files that cannot be read.
Findings examine(const std::string& folder, std::span<const reference::Backend* const> engines,
                 std::uint64_t seed);

/// One figure of the findings, as CSV and JSON have it.
struct Figure {
  std::string_view body;  ///< "ellipse", "square"
  std::string_view law, engine;
  double dt = 0;              ///< s; 0: a formula, or steps to a tolerance
  std::string_view error;     ///< "law": exact motion against measurement; "numerical"; "total"; "share":
                              ///< numerical over law
  double after = 0;           ///< s after the first impact
  std::string_view quantity;  ///< "velocity", "position", "angle"
  std::string_view unit;      ///< "1", "m", "rad"
  int parameters = 0;         ///< fitted on the training half
  Estimate median;
  Estimate ninetieth;  ///< percentile
};
std::vector<Figure> figures_of(const Findings& findings);

std::string to_csv(const Findings& findings);
std::string to_json(const Findings& findings);
std::string to_text(const Findings& findings, const Style& style);

/// Draws the fraction of the ellipse's impacts whose error is below a value, law by law.
std::string ellipse_picture(const Findings& findings);
/// Draws numerical error and the law's error of every engine, 60 ms after the first impact.
std::string engine_picture(const Findings& findings);

/// Returns one HTML file with all tables and both pictures, which loads nothing else.
std::string page_of(const Findings& findings);

}  // namespace plumb::harness::reality
