#include "app/compare_results.h"

#include <algorithm>

#include <fmt/format.h>
#include <unistd.h>

#include "app/exit_codes.h"
#include "app/output.h"
#include "app/selection.h"
#include "app/usage.h"
#include "engine/scene/error.h"
#include "harness/sweep/difference.h"
#include "harness/sweep/rows.h"
#include "scenarios/scenario.h"

namespace plumb::app {
namespace {

bool is_scenario(const std::string& name) {
  try {
    scenarios::select(name);
    return true;
  } catch (const Error&) {
    return false;
  }
}

// Returns true if `name` can only be a path.
bool looks_like_a_path(const std::string& name) {
  return name.starts_with("/") || name.starts_with("./") || name.starts_with("../") || name.ends_with("/") ||
         name.ends_with(".jsonl");
}

bool are_results(const std::string& name) {
  if (!case_files(name).empty()) return false;
  if (looks_like_a_path(name)) return true;
  if (!harness::sweep::holds_rows(name)) return false;
  if (is_scenario(name))
    throw UsageError(
        fmt::format("'{0}' is both a scenario and a folder of results; './{0}' means the folder", name));
  return true;
}

}  // namespace

bool mean_results(const std::vector<std::string>& names) {
  const auto count = std::count_if(names.begin(), names.end(), are_results);
  if (count == 0) return false;
  if (count == 2 && names.size() == 2) return true;
  std::string others;
  for (const std::string& name : names)
    if (!are_results(name)) others += fmt::format("{}'{}'", others.empty() ? "" : ", ", name);
  throw UsageError(fmt::format(
      "compare takes either scenarios or two sets of results (folders with a results.jsonl), not {}",
      others.empty() ? std::to_string(count) : "one; no results are in " + others));
}

int compare_results(const std::string& before, const std::string& after, const std::string& format) {
  namespace sweep = harness::sweep;
  const std::vector<harness::Result> old_rows = sweep::read_rows(before), new_rows = sweep::read_rows(after);
  const std::vector<sweep::Difference> rows = sweep::differences(old_rows, new_rows);
  if (format == "json") {
    print(sweep::difference_json(rows));
  } else if (format == "csv") {
    print(sweep::difference_csv(rows));
  } else {
    print(sweep::difference_table(rows, harness::Style::of_file(STDOUT_FILENO)));
  }
  return sweep::any_worse(rows) ? kCheckFailed : kOk;
}

}  // namespace plumb::app
