#include "harness/course/student/edit.h"

#include <cstdio>

namespace plumb::course {

std::string Edit::text() const {
  std::string out = "edit";
  for (const unsigned part :
       {static_cast<unsigned>(quantity), rows, places, bodies, static_cast<unsigned>(instead)})
    out += ":" + std::to_string(part);
  return out;
}

std::optional<Edit> Edit::read(std::string_view text) {
  int quantity = 0, instead = 0;
  Edit out;
  if (std::sscanf(std::string(text).c_str(), "edit:%d:%u:%u:%u:%d", &quantity, &out.rows, &out.places,
                  &out.bodies, &instead) != 5)
    return std::nullopt;
  out.quantity = static_cast<Quantity>(quantity);
  out.instead = static_cast<Instead>(instead);
  return out;
}

Vec2d Edit::replaced(Vec2d own, Vec2d others, Vec2d raw) const {
  switch (instead) {
    case Instead::Others:
      return others;
    case Instead::Zero:
      return {};
    case Instead::Minus:
      return -own;
    default:
      return raw;
  }
}

double Edit::replaced(double own, double others, double raw) const {
  switch (instead) {
    case Instead::Others:
      return others;
    case Instead::Zero:
      return 0;
    case Instead::Minus:
      return -own;
    case Instead::One:
      return own > 0 ? 1 : 0;
    case Instead::Inverse:
      return own > 0 ? 1 / own : 0;
    case Instead::Finite:
      return own > 0 ? own : 1;
    default:
      return raw;
  }
}

}  // namespace plumb::course
