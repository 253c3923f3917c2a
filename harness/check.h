#pragma once

#include <string>
#include <string_view>

namespace plumb::harness {

/// Reference that a check compares a run with. The kinds are never mixed.
enum class Oracle {
  Exact,      ///< exact motion, which no engine computed
  Discrete,   ///< the scheme's own result at this step, to rounding
  Invariant,  ///< a law of physics: conservation, closed joints, no penetration
  Consensus,  ///< the other engines
  Self,       ///< the same engine with other steps
};

constexpr std::string_view name_of(Oracle oracle) {
  constexpr std::string_view kNames[] = {"exact", "discrete", "invariant", "consensus", "self"};
  return kNames[static_cast<int>(oracle)];
}

/// One statement about a run that its figures can refute.
struct Check {
  std::string name;  ///< "position_error"; those of the discrete oracle start with "discrete_"
  Oracle oracle = Oracle::Exact;
  double value = 0;      ///< measured, at the sample with the largest ratio to its tolerance
  double tolerance = 0;  ///< the bound there, derived: see bounds.h
  bool pass = false;
  std::string known_limit{};  ///< the reason for an expected miss; empty if none is declared
};

/// Follows value and tolerance through a run and keeps the sample with their largest ratio. NaN in either
/// counts as the largest ratio and fails.
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
