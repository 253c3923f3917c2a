#pragma once

#include <string>
#include <vector>

namespace plumb::demos {

/// Something that a player can set while a demo runs. Its value is a number whatever its kind.
struct Control {
  enum class Kind {
    Slider,  ///< any number from low to high; whole numbers where `whole`
    Choice,  ///< the place of one of `choices`
    Switch,  ///< 0 or 1
  };
  std::string name{};
  Kind kind = Kind::Slider;
  std::string unit{};  ///< "" where there is none
  double low = 0, high = 1;
  bool whole = false;
  double value = 0;
  double initial = 0;  ///< what it started with
  std::vector<std::string> choices{};
  std::string about{};  ///< a line
};

}  // namespace plumb::demos
