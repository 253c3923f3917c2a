#include "demos/window/ghost_run.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <exception>

#include "harness/isolate.h"

namespace plumb::window {
namespace {

constexpr double kPatience = 20;          // s, that an engine may take
constexpr std::size_t kMost = 4'000'000;  // poses

std::string settings_text(const reference::Settings& settings) {
  std::string out;
  for (const auto& [name, value] : settings) out += (out.empty() ? "" : ", ") + name + " " + value;
  return out;
}

}  // namespace

GhostRun::GhostRun(const Scene& scene, const reference::Backend& backend,
                   const reference::StepSettings& settings, double duration)
    : dt_(settings.dt), bodies_(scene.bodies.size()) {
  const reference::Identity identity = backend.identity();
  if (!identity.available) {
    remark_ = identity.reason;
    return;
  }
  const double most = static_cast<double>(kMost) / static_cast<double>(std::max<std::size_t>(bodies_, 1));
  const int samples = static_cast<int>(std::min(std::ceil(duration / dt_), most));
  const auto work = [&] {
    std::vector<Pose> poses;
    const auto sink = [&](double, std::span<const BodyState> states) {
      for (const BodyState& state : states)
        poses.push_back({state.position.x, state.position.y, state.angle});
    };
    const auto simulator = backend.create(scene, settings);
    std::vector<BodyState> start(bodies_);
    simulator->read(start);
    sink(0, start);
    simulator->record(samples, 1, bodies_, sink);
    return std::string(reinterpret_cast<const char*>(poses.data()), poses.size() * sizeof(Pose));
  };
  try {
    remark_ = backend.unsupported(scene, settings);
    if (!remark_.empty()) return;
    const harness::Outcome outcome = harness::isolate(work, kPatience);
    if (outcome.kind != harness::Outcome::Kind::Done) {
      remark_ = outcome.text;
      return;
    }
    poses_.resize(outcome.text.size() / sizeof(Pose));
    std::memcpy(poses_.data(), outcome.text.data(), poses_.size() * sizeof(Pose));
    remark_ = settings_text(backend.effective_settings(scene, settings));
  } catch (const std::exception& error) {
    remark_ = error.what();
  }
}

double GhostRun::end() const {
  return bodies_ == 0 || poses_.empty() ? 0 : static_cast<double>(poses_.size() / bodies_ - 1) * dt_;
}

bool GhostRun::at(double time, std::span<BodyState> out) const {
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

}  // namespace plumb::window
