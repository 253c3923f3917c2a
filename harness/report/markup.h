#pragma once

#include <string>
#include <string_view>

namespace plumb::harness::report {

/// Escapes text for HTML and SVG, between tags.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '<') {
      out += "&lt;";
    } else if (c == '&') {
      out += "&amp;";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace plumb::harness::report
