#include "harness/report/shown_rows.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "harness/sweep/front.h"
#include "harness/sweep/rows.h"

namespace plumb::harness::report {
namespace {

using Places = std::vector<std::size_t>;

// Reorders so that the first n of any n are spread evenly: both ends, the middle, the quarters, ...
Places spread(const Places& places) {
  if (places.size() < 3) return places;
  Places out{places.front(), places.back()};
  std::vector<bool> taken(places.size(), false);
  taken.front() = taken.back() = true;
  for (std::size_t parts = 2; out.size() < places.size(); parts *= 2) {
    for (std::size_t part = 1; part < parts; part += 2) {
      const std::size_t place = part * (places.size() - 1) / parts;
      if (taken[place]) continue;
      taken[place] = true;
      out.push_back(places[place]);
    }
    if (parts <= places.size()) continue;
    for (std::size_t place = 0; place < places.size(); ++place)
      if (!taken[place]) out.push_back(places[place]);
  }
  return out;
}

std::string series_of(const Result& row) {
  reference::StepSettings others = row.asked;
  others.dt = 0;
  Result alike;
  alike.asked = others;
  return sweep::key_of(alike);
}

// Returns the rows of the longest series that differs in dt alone, from coarse to fine.
Places longest_series(std::span<const Result> scene, const Places& own) {
  std::map<std::string, Places> series;
  for (const std::size_t place : own)
    if (scene[place].status == Status::Ok) series[series_of(scene[place])].push_back(place);
  Places out;
  for (auto& [name, places] : series)
    if (places.size() > out.size()) out = std::move(places);
  std::stable_sort(out.begin(), out.end(),
                   [&](std::size_t a, std::size_t b) { return scene[a].dt > scene[b].dt; });
  return out;
}

Places front(std::span<const Result> scene, const Places& own, const MetricField& metric) {
  std::vector<sweep::Point> points;
  for (const std::size_t place : own) {
    const std::vector<sweep::Point> one = sweep::points_of(scene.subspan(place, 1), metric);
    points.insert(points.end(), one.begin(), one.end());
  }
  Places out;
  for (const sweep::Point& point : sweep::front_of(std::move(points)))
    out.push_back(static_cast<std::size_t>(point.row - scene.data()));
  return out;
}

// Returns one row of each reason for which runs ended early or were not as expected, and of each missed
// check.
Places troubles(std::span<const Result> scene, const Places& own) {
  std::set<std::string> seen;
  Places out;
  for (const std::size_t place : own) {
    const Result& row = scene[place];
    bool fresh =
        row.status != Status::Ok && seen.insert(std::string(name_of(row.status)) + row.reason).second;
    for (const std::string& sentence : row.unexpected) fresh = seen.insert(sentence).second || fresh;
    for (const Check& check : row.checks)
      if (!check.pass) fresh = seen.insert("missed " + check.name).second || fresh;
    if (fresh) out.push_back(place);
  }
  return out;
}

// Returns the row with the least value of a metric, if there is one.
Places least(std::span<const Result> scene, const Places& own, const MetricField& metric) {
  Places out;
  for (const std::size_t place : own) {
    const auto& value = scene[place].metrics.*metric.value;
    if (scene[place].status != Status::Ok || !value || !std::isfinite(*value)) continue;
    if (out.empty() || *value < *(scene[out.front()].metrics.*metric.value)) out = {place};
  }
  return out;
}

// Chooses up to `most` of one engine's rows.
void choose(std::span<const Result> scene, const Places& own, const MetricField& metric,
            const std::vector<bool>& kept, std::size_t most, std::vector<bool>& chosen) {
  std::size_t count = 0;
  const auto take = [&](std::size_t place) {
    if (count >= most || chosen[place]) return;
    chosen[place] = true;
    ++count;
  };
  for (const std::size_t place : own)
    if (kept[place]) take(place);
  for (const std::size_t place : least(scene, own, kMetricFields[0])) take(place);
  for (const std::size_t place : least(scene, own, metric)) take(place);
  const Places turns[] = {spread(front(scene, own, metric)), spread(longest_series(scene, own)),
                          spread(troubles(scene, own))};
  std::size_t longest = 0;
  for (const Places& places : turns) longest = std::max(longest, places.size());
  for (std::size_t i = 0; i < longest && count < most; ++i)
    for (const Places& places : turns)
      if (i < places.size()) take(places[i]);
  if (count < most)
    for (const std::size_t place : spread(own)) take(place);
}

}  // namespace

std::size_t fair_share(std::vector<std::size_t> counts, std::size_t room, std::size_t least) {
  std::sort(counts.begin(), counts.end());
  std::size_t left = room;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const std::size_t share = left / (counts.size() - i);
    if (counts[i] > share) return std::max(share, least);
    left -= counts[i];
  }
  return counts.empty() ? least : std::max(counts.back(), least);
}

std::vector<std::size_t> shown_rows(std::span<const Result> scene, const MetricField& metric,
                                    const std::vector<bool>& kept, std::size_t most) {
  std::map<std::string, Places> engines;
  for (std::size_t i = 0; i < scene.size(); ++i) engines[scene[i].engine].push_back(i);
  std::vector<bool> chosen(scene.size(), false);
  for (const auto& [engine, own] : engines) {
    if (own.size() <= most) {
      for (const std::size_t place : own) chosen[place] = true;
    } else {
      choose(scene, own, metric, kept, most, chosen);
    }
  }
  Places out;
  for (std::size_t i = 0; i < scene.size(); ++i)
    if (chosen[i]) out.push_back(i);
  return out;
}

}  // namespace plumb::harness::report
