#pragma once

#include <string>
#include <vector>

namespace plumb::demos {

/// A setting that the player can change while a demo runs. Its value is a number for every kind.
struct Control {
  enum class Kind {
    Slider,  ///< any number from low to high; integers if `whole`
    Choice,  ///< index into `choices`
    Switch,  ///< 0 or 1
  };
  std::string name{};
  Kind kind = Kind::Slider;
  std::string unit{};  ///< "" if there is none
  double low = 0, high = 1;
  bool whole = false;
  double value = 0;
  double initial = 0;  ///< initial value
  std::vector<std::string> choices{};
  std::string about{};  ///< one line
};

}  // namespace plumb::demos
