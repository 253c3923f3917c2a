#include <algorithm>

#include <fmt/format.h>

#include "harness/report/extremes.h"
#include "harness/report/markup.h"

namespace plumb::harness::report {
namespace {

// px
constexpr int kLeft = 250, kTop = 150, kWide = 58, kHigh = 22, kGap = 2, kBottom = 30;

// Colours by fraction survived, as in the page's maps. Every cell also has a number, so that nothing is shown
// by colour alone.
constexpr const char* kStyle = R"(
  text { font: 12px system-ui, sans-serif; fill: #1c1c1a; }
  .all { fill: #bfe3d0; } .most { fill: #f3e3a1; } .some { fill: #f0b48a; } .few { fill: #8c2d19; } .none { fill: #e3e3de; }
  .back { fill: #ffffff; } text.on-few { fill: #ffffff; } text.soft { fill: #5c5c57; }
  @media (prefers-color-scheme: dark) {
    text { fill: #ecebe6; } .back { fill: #16181a; } text.soft { fill: #a9a9a2; }
    .all { fill: #1f5a41; } .most { fill: #6b5a14; } .some { fill: #8a4a1f; } .few { fill: #ffb199; } .none { fill: #303438; }
    text.on-few { fill: #16181a; }
  }
)";

const char* class_of(const Count& count) {
  if (count.total == 0) return "none";
  if (count.survived == count.total) return "all";
  const double share = static_cast<double>(count.survived) / count.total;
  return share >= 0.8 ? "most" : share >= 0.5 ? "some" : "few";
}

std::string cell_svg(int x, int y, const Count& count) {
  const char* kind = class_of(count);
  const std::string text =
      count.total == 0 ? std::string("\u2013") : fmt::format("{}/{}", count.survived, count.total);
  return fmt::format(
      "<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>"
      "<text class=\"on-{}\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
      kind, x, y, kWide - kGap, kHigh - kGap, kind, x + kWide / 2 - 1, y + 15, text);
}

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return escaped(name);
}

}  // namespace

std::string extremes_picture(const std::vector<stress::Cell>& cells) {
  const auto families = families_of(cells);
  const std::vector<Endurance> rows = endurances(cells);
  // Leave room on the right for the slanted headings.
  const int width = kLeft + kWide * (static_cast<int>(families.size()) + 1) + 130;
  const int height = kTop + kHigh * static_cast<int>(rows.size()) + kBottom;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "role=\"img\">\n"
      "<title>Cells survived, by engine and family</title>\n<style>{2}</style>\n"
      "<rect class=\"back\" width=\"{0}\" height=\"{1}\"/>\n",
      width, height, kStyle);
  const auto heading = [&](int column, const std::string& text) {
    out += fmt::format("<text transform=\"translate({} {}) rotate(-40)\">{}</text>\n",
                       kLeft + kWide * column + kWide / 2, kTop - 8, text);
  };
  heading(0, "all");
  for (std::size_t i = 0; i < families.size(); ++i) heading(static_cast<int>(i) + 1, in_words(families[i]));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const int y = kTop + kHigh * static_cast<int>(k);
    out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>\n", kLeft - 8, y + 15,
                       escaped(fmt::format("{}, {}", rows[k].engine, rows[k].setting)));
    out += cell_svg(kLeft, y, rows[k].all);
    for (std::size_t i = 0; i < families.size(); ++i) {
      const auto found = rows[k].families.find(families[i]);
      out += cell_svg(kLeft + kWide * (static_cast<int>(i) + 1), y,
                      found == rows[k].families.end() ? Count{} : found->second);
    }
  }
  out += fmt::format(
      "<text class=\"soft\" x=\"{}\" y=\"{}\">cells survived of those run; \u2013: the engine lacks a "
      "feature that the family needs</text>\n",
      8, height - 10);
  return out + "</svg>\n";
}

}  // namespace plumb::harness::report
