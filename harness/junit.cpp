#include "harness/junit.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "engine/core/text.h"

namespace plumb::harness {
namespace {

// Returns `text` escaped for XML 1.0, which cannot express control characters.
std::string escaped(std::string_view raw) {
  std::string out;
  for (const char c : printable(raw, 4000)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

// Returns the wall time of the steps that the cost's repetitions took, s; 0 without a cost.
double seconds_of(const Result& result) {
  if (!result.cost) return 0;
  return result.cost->ns_per_step * result.cost->steps * result.cost->repetitions / 1e9;
}

std::string test(const Result& result) {
  std::string out = fmt::format(R"(    <testcase classname="{}" name="{}" time="{:.6f}">)",
                                escaped(result.label), escaped(result.engine), seconds_of(result)) +
                    "\n";
  if (!result.unexpected.empty()) {
    out += fmt::format("      <failure message=\"{}\">", escaped(result.unexpected.front()));
    for (const std::string& sentence : result.unexpected) out += escaped(sentence) + "\n";
    out += "</failure>\n";
  } else if (result.status == Status::Skipped) {
    out += fmt::format("      <skipped message=\"{}\"/>\n", escaped(result.reason));
  }
  std::string misses;
  for (const Check& check : result.checks)
    if (!check.pass && !check.known_limit.empty())
      misses += escaped(fmt::format("{} is {:.3g}, its bound is {:.3g}: {}", check.name, check.value,
                                    check.tolerance, check.known_limit)) +
                "\n";
  if (!misses.empty()) out += fmt::format("      <system-out>{}</system-out>\n", misses);
  return out + "    </testcase>\n";
}

}  // namespace

std::string junit(std::span<const Result> results) {
  std::vector<std::string_view> labels;
  for (const Result& result : results)
    if (std::find(labels.begin(), labels.end(), result.label) == labels.end()) labels.push_back(result.label);
  std::string suites;
  std::size_t failed = 0;
  for (const std::string_view label : labels) {
    std::string tests;
    std::size_t count = 0, failures = 0, skipped = 0;
    for (const Result& result : results) {
      if (result.label != label) continue;
      tests += test(result);
      ++count;
      failures += result.unexpected.empty() ? 0 : 1;
      skipped += result.unexpected.empty() && result.status == Status::Skipped ? 1 : 0;
    }
    failed += failures;
    suites += fmt::format(
        "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\">\n{}  "
        "</testsuite>\n",
        escaped(label), count, failures, skipped, tests);
  }
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=\"plumb\" tests=\"{}\" "
      "failures=\"{}\">\n{}"
      "</testsuites>\n",
      results.size(), failed, suites);
}

}  // namespace plumb::harness
