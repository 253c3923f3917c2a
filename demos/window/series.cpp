#include "demos/window/series.h"

#include <algorithm>

namespace plumb::window {

void Series::add(double time, double value) {
  const auto later =
      std::ranges::find_if(samples_, [&](const Sample& sample) { return sample.time >= time; });
  samples_.erase(later, samples_.end());
  samples_.push_back({time, value});
  if (samples_.size() > kMost) samples_.erase(samples_.begin());
}

std::vector<float> Series::values() const {
  std::vector<float> out;
  for (const Sample& sample : samples_) out.push_back(static_cast<float>(sample.value));
  return out;
}

}  // namespace plumb::window
