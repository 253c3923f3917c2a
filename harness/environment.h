#pragma once

#include <string>
#include <string_view>

namespace plumb::harness {

/// Where a figure was measured.
struct Environment {
  std::string plumb_version;
  std::string commit;    ///< "unknown" outside a git checkout; "+" is appended where files were changed
  std::string compiler;  ///< "GNU 12.2.0"
  std::string flags;
  std::string build_type;  ///< "Release"
  std::string cpu;
  std::string os;
  std::string date;  ///< UTC, ISO 8601
};

/// That of this program on this machine now.
Environment environment();

std::string_view version();  ///< of plumb

}  // namespace plumb::harness
