#include "harness/sweep/difference.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>

#include "harness/sweep/rank_test.h"
#include "harness/sweep/rows.h"
#include "harness/sweep/space.h"

namespace plumb::harness::sweep {
namespace {

bool same_bits(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return std::bit_cast<std::uint64_t>(*a) == std::bit_cast<std::uint64_t>(*b);
}

Difference named(const Result& row) {
  Difference out;
  out.label = row.label;
  out.engine = row.engine;
  out.settings = settings_text(row.asked);
  return out;
}

void hold_costs(const Result& before, const Result& after, Difference& out) {
  if (before.cost_left_out || after.cost_left_out) out.cost = Verdict::Elsewhere;
  if (!before.cost || !after.cost) return;
  if (!before.machine.empty() && !after.machine.empty() && before.machine != after.machine) {
    out.cost = Verdict::Elsewhere;
    return;
  }
  out.cost_before = before.cost->ns_per_step;
  out.cost_after = after.cost->ns_per_step;
  const std::vector<double>&a = before.cost->each_ns_per_step, &b = after.cost->each_ns_per_step;
  out.repetitions = std::min(a.size(), b.size());
  out.cost = out.repetitions < kEnough ? Verdict::TooFew : Verdict::CannotTell;
  out.chance = rank_test(a, b);
}

Difference difference(const Result& before, const Result& after) {
  Difference out = named(before);
  out.before = before.status;
  out.after = after.status;
  for (const MetricField& metric : kMetricFields) {
    const auto &was = before.metrics.*metric.value, &is = after.metrics.*metric.value;
    if (!same_bits(was, is)) out.errors.push_back({&metric, was, is});
  }
  hold_costs(before, after, out);
  return out;
}

// Applies Holm's procedure: the smallest p-value first, each compared with the remaining chance.
void judge_costs(std::vector<Difference>& rows) {
  std::vector<Difference*> tested;
  for (Difference& row : rows)
    if (row.cost == Verdict::CannotTell) tested.push_back(&row);
  std::stable_sort(tested.begin(), tested.end(),
                   [](const Difference* a, const Difference* b) { return a->chance < b->chance; });
  for (std::size_t i = 0; i < tested.size(); ++i) {
    if (tested[i]->chance > kChance / static_cast<double>(tested.size() - i)) break;
    tested[i]->cost = tested[i]->cost_after < tested[i]->cost_before ? Verdict::Better : Verdict::Worse;
  }
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::Better:
      return "better";
    case Verdict::Worse:
      return "worse";
    case Verdict::CannotTell:
      return "cannot be told from noise";
    case Verdict::TooFew:
      return "too few repetitions";
    case Verdict::Elsewhere:
      return "measured on different kinds of machine";
    case Verdict::Unknown:
      break;
  }
  return "unknown";
}

std::vector<Difference> differences(std::span<const Result> before, std::span<const Result> after) {
  std::map<std::string, const Result*> later;
  for (const Result& row : after) later[key_of(row)] = &row;
  std::vector<Difference> out;
  for (const Result& row : before) {
    const auto match = later.find(key_of(row));
    if (match == later.end()) {
      out.push_back(named(row));
      out.back().before = row.status;
    } else {
      out.push_back(difference(row, *match->second));
      later.erase(match);
    }
  }
  for (const Result& row : after) {
    if (!later.contains(key_of(row))) continue;
    out.push_back(named(row));
    out.back().after = row.status;
  }
  judge_costs(out);
  return out;
}

bool any_worse(std::span<const Difference> rows) {
  return std::any_of(rows.begin(), rows.end(), [](const Difference& row) {
    const bool lost = row.before == Status::Ok && row.after && *row.after != Status::Ok;
    return lost || row.cost == Verdict::Worse ||
           std::any_of(row.errors.begin(), row.errors.end(),
                       [](const auto& error) { return !error.better(); });
  });
}

bool all_same(std::span<const Difference> rows) {
  return std::ranges::all_of(
      rows, [](const Difference& row) { return row.before == row.after && row.errors.empty(); });
}

}  // namespace plumb::harness::sweep
