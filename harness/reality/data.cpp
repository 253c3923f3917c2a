#include "harness/reality/data.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <string_view>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/text_file.h"

namespace plumb::harness::reality {
namespace {

std::vector<std::string_view> fields_of(std::string_view line) {
  std::vector<std::string_view> out;
  while (true) {
    const std::size_t comma = std::min(line.find(','), line.size());
    out.push_back(line.substr(0, comma));
    if (comma == line.size()) return out;
    line.remove_prefix(comma + 1);
  }
}

/// Calls `take` with the numbers of `columns` of each row.
void read_table(const std::string& path, const std::vector<std::string>& columns,
                const std::function<void(const std::vector<double>&)>& take) {
  const std::string text = read_text(path);
  std::vector<std::size_t> places;
  std::vector<double> values(columns.size());
  int number = 0, rows = 0;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    std::string_view line = std::string_view(text).substr(start, end - start);
    start = end + 1;
    ++number;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    if (line.empty()) continue;
    const std::vector<std::string_view> fields = fields_of(line);
    if (places.empty()) {
      for (const std::string& column : columns) {
        const auto found = std::find(fields.begin(), fields.end(), column);
        if (found == fields.end())
          throw Error(Error::Kind::Syntax, fmt::format("'{}'", path), column, "",
                      "is not a column: the first line names the columns, see docs/reality.md", number);
        places.push_back(static_cast<std::size_t>(found - fields.begin()));
      }
      continue;
    }
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string_view field = places[i] < fields.size() ? fields[places[i]] : std::string_view{};
      const auto [stop, error] = std::from_chars(field.data(), field.data() + field.size(), values[i]);
      if (error != std::errc{} || stop != field.data() + field.size() || !std::isfinite(values[i]))
        throw Error(Error::Kind::Syntax, fmt::format("'{}'", path), columns[i], std::string(field),
                    "must be a number", number);
    }
    take(values);
    ++rows;
  }
  if (rows == 0) throw Error(Error::Kind::Value, fmt::format("'{}'", path), "", "", "has no rows");
}

}  // namespace

std::string missing_file(const std::string& folder) {
  std::error_code code;
  for (const char* name : {kImpactFile, kDropFile})
    if (!std::filesystem::is_regular_file(std::filesystem::path(folder) / name, code)) return name;
  return "";
}

std::vector<MeasuredImpact> read_impacts(const std::string& path) {
  std::vector<MeasuredImpact> out;
  read_table(path, {"x", "vx", "vy", "w", "vx1", "vy1", "w1", "lever_normal", "lever_tangent", "flagged"},
             [&](const std::vector<double>& v) {
               out.push_back({{v[1], v[2]}, {v[4], v[5]}, v[3], v[6], v[7], v[8], v[0] + v[7], v[9] != 0});
             });
  return out;
}

std::vector<MeasuredDrop> read_drops(const std::string& path) {
  std::vector<MeasuredDrop> out;
  read_table(path, {"drop", "x", "y", "angle"}, [&](const std::vector<double>& v) {
    const int number = static_cast<int>(v[0]);
    if (out.empty() || out.back().number != number) out.push_back({number, {}});
    // The file's angles run clockwise. Only with that sign do the impulses at the lowest corner, computed
    // from the change of velocity, explain the square's rotation.
    out.back().frames.push_back({{v[1], v[2]}, -v[3]});
  });
  return out;
}

}  // namespace plumb::harness::reality
