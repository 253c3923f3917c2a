#pragma once

#include <string>
#include <string_view>

namespace plumb::harness {

/// Build and machine that a figure was measured with.
struct Environment {
  std::string plumb_version;
  std::string commit;    ///< "unknown" outside a git checkout; "+" is appended if files were changed
  std::string compiler;  ///< "GNU 12.2.0"
  std::string flags;
  std::string build_type;  ///< "Release"
  std::string cpu;
  std::string os;
  std::string date;  ///< UTC, ISO 8601
};

/// Returns the environment of this program on this machine, with the present time.
Environment environment();

std::string_view version();  ///< of plumb

}  // namespace plumb::harness
