#include "harness/known_limits_page.h"

#include <string_view>

#include <fmt/format.h>

#include "harness/known_limits.h"

namespace plumb::harness {
namespace {

// Formats "a|b" as "`a`, `b`".
std::string code_list(std::string_view pattern) {
  std::string out;
  while (true) {
    const std::size_t bar = pattern.find('|');
    out += fmt::format("{}`{}`", out.empty() ? "" : ", ", pattern.substr(0, bar));
    if (bar == std::string_view::npos) return out;
    pattern.remove_prefix(bar + 1);
  }
}

}  // namespace

std::string known_limits_page() {
  std::string page = R"(# Known limits

Every engine's run is held against bounds that are derived from its method: its order in the step, its
precision and the motion itself ([formats](formats.md#checks)). Where an engine is known to miss one at the
default settings (dt = 1/60 s), the miss is declared in `harness/known_limits.cpp` and listed here. A miss that
is not declared fails `plumb compare` and the tests, and so does a declared one that has gone. At other steps a
declared miss may show or not.

This page is written by `plumb list --known-limits`; a test holds it against the declarations.
)";
  if (known_limits().empty()) page += "\nThere are none.\n";
  for (const KnownLimit& limit : known_limits()) {
    page += fmt::format("\n## {} on {}{}\n\n{}\n\nMisses: {}.\n", code_list(limit.engine),
                        code_list(limit.instance), limit.elsewhere_only ? ", at other steps" : "",
                        limit.reason, code_list(limit.check));
  }
  return page;
}

}  // namespace plumb::harness
