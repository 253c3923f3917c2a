#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "harness/reality/published/published_law.h"
#include "harness/table.h"

namespace plumb::harness::reality {

std::string published_csv(std::span<const PublishedFinding> findings) {
  std::string out =
      "law,quantity,source,engine,low,high,starts,value,value_low,value_high,least,most,inside,skipped\n";
  for (const PublishedFinding& f : findings) {
    const bool run = f.why_not.empty();
    out += fmt::format(
        "{},{},{},{},{},{},{},{},{},{}\n", csv_field(f.law), csv_field(f.quantity), csv_field(f.source),
        csv_field(f.engine), f.low, f.high, f.starts,
        run ? fmt::format("{},{},{},{},{}", f.value.value, f.value.low, f.value.high, f.least, f.most)
            : ",,,,",
        f.inside() ? "true" : "false", csv_field(f.why_not));
  }
  return out;
}

std::string published_json(std::span<const PublishedFinding> findings) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const PublishedFinding& f : findings) {
    nlohmann::ordered_json row{{"law", f.law},       {"quantity", f.quantity}, {"source", f.source},
                               {"engine", f.engine}, {"low", f.low},           {"high", f.high}};
    if (f.why_not.empty()) {
      row["value"] = f.value.value;
      row["value_low"] = f.value.low;
      row["value_high"] = f.value.high;
      row["starts"] = f.starts;
      row["least"] = f.least;
      row["most"] = f.most;
      row["inside"] = f.inside();
    } else {
      row["skipped"] = f.why_not;
    }
    out.push_back(row);
  }
  return out.dump() + "\n";
}

std::string published_text(std::span<const PublishedFinding> findings) {
  std::string out, last;
  for (const PublishedFinding& f : findings) {
    if (f.law != last)
      out += fmt::format("{}: {}, published {:.3g} to {:.3g} ({})\n", f.law, f.quantity, f.low, f.high,
                         f.source);
    last = f.law;
    if (f.why_not.empty()) {
      out += fmt::format("  {:<18}{:<26}{:<19}{}\n", f.engine,
                         fmt::format("{:.4g} [{:.4g} {:.4g}]", f.value.value, f.value.low, f.value.high),
                         fmt::format("{:.4g} to {:.4g}", f.least, f.most), f.inside() ? "inside" : "outside");
    } else {
      out += fmt::format("  {:<18}{}\n", f.engine, f.why_not);
    }
  }
  return out +
         fmt::format(
             "median of {} starts that differ by a thousandth [95 % of bootstrap samples], and all of them\n",
             kStarts);
}

}  // namespace plumb::harness::reality
