#pragma once

#include <string>

#include "bench/field/measure.h"

namespace plumb::field {

/// Serialises one run's figures for the pipe from its process. With `first`, all figures; otherwise only the
/// times.
std::string pack(const Measurement& found, bool first);

/// Adds the figures in `text`, written by `pack`, to `out`.
void unpack(const std::string& text, Measurement& out);

}  // namespace plumb::field
