#pragma once

#include <string>
#include <string_view>

namespace plumb::harness {

/// Layout of text for people.
struct Style {
  int width = 110;      ///< columns
  bool colour = false;  ///< ANSI colours

  enum class Ink { Plain, Bold, Dim, Green, Yellow, Red };
  std::string paint(std::string_view text, Ink ink) const;

  /// Returns the style for a file: on a terminal its width, at most 110, and colour unless NO_COLOR is set or
  /// TERM is dumb. Else 110 columns without colour.
  static Style of_file(int descriptor);
};

/// Breaks `text` at spaces so that each line has at most `width` columns; lines after the first start with
/// `indent` spaces.
std::string wrap(std::string_view text, int width, int indent);

/// Pads `text` to `width` columns, on the left or on the right.
std::string pad_left(std::string_view text, int width);
std::string pad_right(std::string_view text, int width);

/// Formats a figure for people: "0", "3.1e-15", "0.12" if that is as short.
std::string figure(double value);

/// Formats a time for people: "740 ns", "1.24 us", "3.1 ms".
std::string duration_text(double nanoseconds);

/// Returns "1/60" if 1/dt is a whole number.
std::string dt_text(double dt);

}  // namespace plumb::harness
