#pragma once

#include <string>
#include <string_view>

namespace plumb::harness {

/// What a check holds a run against. The kinds are never mixed.
enum class Oracle {
  Exact,      ///< the motion that no engine computed
  Discrete,   ///< what the scheme must give at this step, to rounding
  Invariant,  ///< a law of physics: conservation, joints that hold, bodies that do not overlap
  Consensus,  ///< the other engines
  Self,       ///< the same engine at other steps
};

constexpr std::string_view name_of(Oracle oracle) {
  constexpr std::string_view kNames[] = {"exact", "discrete", "invariant", "consensus", "self"};
  return kNames[static_cast<int>(oracle)];
}

/// One statement about a run that can be wrong.
struct Check {
  std::string name;  ///< "position_error"; those of the discrete oracle start with "discrete_"
  Oracle oracle = Oracle::Exact;
  double value = 0;      ///< measured, where it comes nearest to its tolerance (or exceeds it by most)
  double tolerance = 0;  ///< the bound there, derived: see bounds.h
  bool pass = false;
  std::string known_limit{};  ///< why a miss is expected; empty where none is declared
};

/// Follows value and tolerance through a run and keeps the sample with the largest ratio. A value or a
/// tolerance that is NaN does not pass, and has the largest.
class WorstRatio {
 public:
  void add(double value, double tolerance);
  bool any() const { return any_; }
  Check check(std::string name, Oracle oracle) const;

 private:
  bool any_ = false;
  bool pass_ = true;
  double ratio_ = -1, value_ = 0, tolerance_ = 0;
};

}  // namespace plumb::harness
