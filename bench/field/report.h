#pragma once

#include <span>
#include <string>

#include "bench/field/measure.h"
#include "harness/style.h"

namespace plumb::field {

/// One scene as a table, a row an engine. Columns that say nothing in a scene are left out.
std::string table(std::span<const Measurement> row, const harness::Style& style);

/// What every engine ran with, where and how: below the tables.
std::string settings_text(std::span<const Measurement> all, const harness::Style& style);

/// One line a measurement; the first line names the columns.
std::string csv_header();
std::string csv_row(const Measurement& measurement, const Measurement* yardstick);

/// Everything, with the environment and the settings.
std::string json(std::span<const Measurement> all, const Plan& plan);

/// The engine that ratios are given to, in the same scene; null when it is not among them or failed.
const Measurement* yardstick_of(std::span<const Measurement> all, const Scene& scene);

}  // namespace plumb::field
