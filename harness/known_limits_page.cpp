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

Every run is checked against bounds that follow from the engine's method: its order in the step, its precision
and the motion itself ([formats](formats.md#checks)). Where an engine is known to miss a bound at the default
settings (dt = 1/60 s), the miss is declared in `harness/known_limits.cpp` and listed here. `plumb compare` and
the tests fail if an undeclared miss appears or a declared one disappears. At other steps a declared miss is
permitted, not required.

`plumb list --known-limits` generates this page; a test compares it with the declarations.
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
