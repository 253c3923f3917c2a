#include "demos/compared/sampled_motion.h"

#include <algorithm>
#include <cmath>

namespace plumb::demos {

void SampledMotion::add(std::span<const BodyState> states) {
  for (const BodyState& state : states) poses_.push_back({state.position.x, state.position.y, state.angle});
}

double SampledMotion::end() const {
  return bodies_ == 0 || poses_.empty() ? 0 : static_cast<double>(poses_.size() / bodies_ - 1) * dt_;
}

bool SampledMotion::at(double time, std::span<BodyState> out) const {
  if (poses_.empty() || !(time >= 0 && time <= end())) return false;
  const auto before = static_cast<std::size_t>(std::floor(time / dt_));
  const std::size_t after = std::min(before + 1, poses_.size() / bodies_ - 1);
  const double share = time / dt_ - static_cast<double>(before);
  for (std::size_t i = 0; i < bodies_; ++i) {
    const Pose &p = poses_[before * bodies_ + i], &q = poses_[after * bodies_ + i];
    out[i] = {.position = {p.x + share * (q.x - p.x), p.y + share * (q.y - p.y)},
              .angle = p.angle + share * (q.angle - p.angle)};
  }
  return true;
}

}  // namespace plumb::demos
