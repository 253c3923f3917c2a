#pragma once

#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

namespace plumb::harness::hunt {

/// Draws numbers that are the same on every machine: it uses no distribution of the standard library and no
/// function of libm.
class Random {
 public:
  /// Starts the stream of one scene: `seed` of the hunt, `index` of the scene.
  Random(std::uint64_t seed, std::uint64_t index);

  double unit();                           ///< 0 <= x < 1
  double within(double low, double high);  ///< uniform, on a grid of 1/1000 of the range
  int whole(int low, int high);            ///< both included
  bool chance(double probability);

  /// Draws from 1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.3, 8 and their multiples by powers of ten, all equally
  /// likely.
  double ladder(double low, double high);

  template <class T>
  T pick(std::initializer_list<T> values) {
    return *(values.begin() + whole(0, static_cast<int>(values.size()) - 1));
  }
  template <class T>
  const T& pick(const std::vector<T>& values) {
    return values[static_cast<std::size_t>(whole(0, static_cast<int>(values.size()) - 1))];
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace plumb::harness::hunt
