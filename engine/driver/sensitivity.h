#pragma once

#include <string>
#include <string_view>

#include "engine/scene/error.h"

namespace plumb {

/// Reasons why a state has no derivative by a parameter, from some time of the run on.
enum class NoDerivative {
  Grazing,       ///< shapes touched without approaching: a slight change decides whether they touch at all
  Simultaneous,  ///< simultaneous events that a change of the parameter would separate: their order then
                 ///< matters
  Zeno,          ///< bounces were brought to their limit, an infinite number at once
  Start,         ///< the parameter opens a contact that exists at the start, or makes it penetrate
  Kink,          ///< an impact or a force law has a kink here: it sticks on one side and slips on the other
  Paradox,       ///< Painleve's paradox: no force satisfies the laws, or several do
  Singular,      ///< a linkage crossed a kinematic singularity or has redundant joints, or the derivative is
                 ///< not finite
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
