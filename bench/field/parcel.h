#pragma once

#include <string>

#include "bench/field/measure.h"

namespace plumb::field {

/// What one run found, to be carried from the process that ran it. `first` says whether that was all, or the
/// time alone.
std::string pack(const Measurement& found, bool first);

/// Adds what `text`, which `pack` wrote, holds to `out`.
void unpack(const std::string& text, Measurement& out);

}  // namespace plumb::field
