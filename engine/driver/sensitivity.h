#pragma once

#include <string>
#include <string_view>

#include "engine/scene/error.h"

namespace plumb {

/// Reasons why a state has no derivative by a parameter, from some time of the run on.
enum class NoDerivative {
  Grazing,       ///< shapes met without approaching: a slight change decides whether they meet at all
  Simultaneous,  ///< events at one instant that the parameter separates in time: their order decides
  Zeno,          ///< bounces were brought to their limit, an infinite number at once
  Start,         ///< the parameter opens a contact of the start, or presses it together
  Kink,          ///< an impact or a force law has a kink here: it sticks on one side and slips on the other
  Paradox,       ///< Painleve's paradox: no force, or several, obey the laws
  Singular,      ///< a linkage crossed a kinematic singularity or has redundant joints, or no derivative is
                 ///< finite
};
std::string_view name_of(NoDerivative reason);  ///< "grazing", "simultaneous", ...

/// Thrown when a derivative that does not exist is requested: `Error` (Run) with the reason and the time.
class NotDifferentiable final : public Error {
 public:
  NotDifferentiable(const std::string& parameter, NoDerivative reason, double time);

  NoDerivative reason() const { return reason_; }
  double time() const { return time_; }  ///< s, of the event

 private:
  NoDerivative reason_;
  double time_;
};

}  // namespace plumb
