#include "harness/check.h"

#include <limits>
#include <utility>

namespace plumb::harness {

void WorstRatio::add(double value, double tolerance) {
  const bool pass = value <= tolerance;  // false for NaN as well
  double ratio = value > 0 ? value / tolerance : 0;
  if (!pass && !(ratio > 1)) ratio = std::numeric_limits<double>::infinity();  // NaN, or a tolerance of zero
  if (!any_ || ratio > ratio_) {
    ratio_ = ratio;
    value_ = value;
    tolerance_ = tolerance;
  }
  any_ = true;
  pass_ = pass_ && pass;
}

Check WorstRatio::check(std::string name, Oracle oracle) const {
  return {std::move(name), oracle, value_, tolerance_, pass_, {}};
}

}  // namespace plumb::harness
