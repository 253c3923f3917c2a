#pragma once

#include <span>
#include <string>

#include "bench/field/measure.h"
#include "harness/style.h"

namespace plumb::field {

/// Formats one scene, one row per engine. Columns without information are left out.
std::string table(std::span<const Measurement> row, const harness::Style& style);

/// Formats every engine's settings, the build and the machine, for the lines below the tables.
std::string settings_text(std::span<const Measurement> all, const harness::Style& style);

/// One line per measurement; the header names the columns.
std::string csv_header();
std::string csv_row(const Measurement& measurement, const Measurement* yardstick);

/// Returns everything, with the environment and the settings.
std::string json(std::span<const Measurement> all, const Plan& plan);

/// Returns the engine of the same scene to which ratios refer; null if it is not measured or failed.
const Measurement* yardstick_of(std::span<const Measurement> all, const Scene& scene);

}  // namespace plumb::field
