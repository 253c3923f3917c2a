#include "engine/scene/limits.h"

namespace plumb {

std::string describe(Limits limits, const std::string& unit) {
  const std::string of = unit.empty() ? "" : " of " + unit;
  switch (limits) {
    case Limits::NonNegative:
      return "must be zero or a positive number" + of;
    case Limits::Positive:
      return "must be a positive number" + of;
    case Limits::ZeroToOne:
      return "must be a number from 0 to 1" + of;
    case Limits::NotZero:
      return "must be a number other than 0" + of;
    case Limits::Any:
      break;
  }
  return "must be a finite number" + of;
}

bool within(Limits limits, double value) {
  switch (limits) {
    case Limits::NonNegative:
      return value >= 0;
    case Limits::Positive:
      return value > 0;
    case Limits::ZeroToOne:
      return value >= 0 && value <= 1;
    case Limits::NotZero:
      return value != 0;
    case Limits::Any:
      break;
  }
  return true;
}

}  // namespace plumb
