#include "harness/thresholds/bisection.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace plumb::harness::thresholds {
namespace {

constexpr int kScan = 7;
constexpr double kBeside[] = {3, 10, 30};  // resolutions

/// A search on a scale from 0, the end that should hold, to 1, the end that should break.
class Search {
 public:
  Search(const SearchRange& range, const std::function<Answer(double)>& ask) : range_(range), ask_(ask) {}

  Crossing run() {
    scan();
    const auto first = std::ranges::find_if(asked_, [](const Asked& a) { return !a.answer.holds; });
    if (first == asked_.end()) return over_range(Ending::Always);
    const bool anywhere = std::ranges::any_of(asked_, [](const Asked& a) { return a.answer.holds; });
    if (!anywhere) return over_range(Ending::Never);
    if (first == asked_.begin()) return mixed(std::numeric_limits<double>::quiet_NaN());
    double holds = std::prev(first)->place, breaks = first->place;
    while (static_cast<int>(asked_.size()) < kMostRuns - kBesides && !narrow(holds, breaks)) {
      const double middle = (holds + breaks) / 2;
      (ask(middle) ? holds : breaks) = middle;
    }
    look_beside(value_at((holds + breaks) / 2));
    return finish(holds, breaks);
  }

 private:
  static constexpr int kBesides = 2 * static_cast<int>(std::size(kBeside));

  struct Asked {
    double place, value;
    Answer answer;
  };

  double value_at(double place) const {
    const double share = range_.holds_below ? place : 1 - place;
    if (share <= 0) return range_.low;
    if (share >= 1) return range_.high;
    if (range_.logarithmic) return range_.low * std::pow(range_.high / range_.low, share);
    return range_.low + share * (range_.high - range_.low);
  }

  double place_of(double value) const {
    const double share = range_.logarithmic
                             ? std::log(value / range_.low) / std::log(range_.high / range_.low)
                             : (value - range_.low) / (range_.high - range_.low);
    return range_.holds_below ? share : 1 - share;
  }

  bool ask(double place) {
    const double value = value_at(place);
    asked_.push_back({place, value, ask_(value)});
    return asked_.back().answer.holds;
  }

  void scan() {
    for (int i = 0; i < kScan; ++i) ask(static_cast<double>(i) / (kScan - 1));
  }

  bool narrow(double holds, double breaks) const {
    const double a = value_at(holds), b = value_at(breaks);
    return std::abs(a - b) <= range_.resolution * std::abs(a + b) / 2;
  }

  void look_beside(double value) {
    for (const double many : kBeside) {
      for (const int side : {-1, 1}) {
        const double place = place_of(value * (1 + side * many * range_.resolution));
        if (place > 0 && place < 1) ask(place);
      }
    }
  }

  const Asked& nearest_break(double place) const {
    const Asked* best = nullptr;
    for (const Asked& a : asked_)
      if (!a.answer.holds && (best == nullptr || std::abs(a.place - place) < std::abs(best->place - place)))
        best = &a;
    return *best;
  }

  Crossing over_range(Ending ending) const {
    const int runs = static_cast<int>(asked_.size());
    const std::string why = ending == Ending::Never ? asked_.front().answer.why : "";
    return {ending, std::numeric_limits<double>::quiet_NaN(), range_.low, range_.high, runs, why};
  }

  Crossing finish(double holds, double breaks) const {
    const double value = (value_at(holds) + value_at(breaks)) / 2;
    for (const Asked& a : asked_)
      if (a.answer.holds == (a.place > holds)) return mixed(value);
    const auto [low, high] = std::minmax({value_at(holds), value_at(breaks)});
    return {
        Ending::Found, value, low, high, static_cast<int>(asked_.size()), nearest_break(breaks).answer.why};
  }

  // Reports mixed answers, from the first value that breaks to the last that holds.
  Crossing mixed(double value) const {
    const Asked *first = nullptr, *last = nullptr;
    for (const Asked& a : asked_) {
      if (!a.answer.holds && (first == nullptr || a.place < first->place)) first = &a;
      if (a.answer.holds && (last == nullptr || a.place > last->place)) last = &a;
    }
    const auto [low, high] = std::minmax({first->value, last->value});
    return {Ending::Unclear,
            value,
            low,
            high,
            static_cast<int>(asked_.size()),
            fmt::format("breaks at {:.4g} ({}), but holds at {:.4g}", first->value, first->answer.why,
                        last->value)};
  }

  SearchRange range_;
  const std::function<Answer(double)>& ask_;
  std::vector<Asked> asked_;
};

}  // namespace

Crossing find_crossing(const SearchRange& range, const std::function<Answer(double)>& ask) {
  return Search(range, ask).run();
}

}  // namespace plumb::harness::thresholds
