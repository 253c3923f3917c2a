#include "demos/window/ghost_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <vector>

#include "harness/isolate.h"

namespace plumb::window {
namespace {

constexpr double kPatience = 20;          // s, time limit of an engine
constexpr std::size_t kMost = 4'000'000;  // poses

std::string settings_text(const reference::Settings& settings) {
  std::string out;
  for (const auto& [name, value] : settings) out += (out.empty() ? "" : ", ") + name + " " + value;
  return out;
}

}  // namespace

GhostRun::GhostRun(const Scene& scene, const reference::Backend& backend,
                   const reference::StepSettings& settings, double duration)
    : motion_(settings.dt, scene.bodies.size()) {
  using Pose = demos::SampledMotion::Pose;
  const std::size_t bodies = scene.bodies.size();
  const reference::Identity identity = backend.identity();
  if (!identity.available) {
    remark_ = identity.reason;
    return;
  }
  const double most = static_cast<double>(kMost) / static_cast<double>(std::max<std::size_t>(bodies, 1));
  const int samples = static_cast<int>(std::min(std::ceil(duration / settings.dt), most));
  const auto work = [&] {
    demos::SampledMotion motion(settings.dt, bodies);
    const auto simulator = backend.create(scene, settings);
    std::vector<BodyState> start(bodies);
    simulator->read(start);
    motion.add(start);
    simulator->record(samples, 1, bodies,
                      [&](double, std::span<const BodyState> states) { motion.add(states); });
    const auto& poses = motion.poses();
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
    std::vector<Pose> poses(outcome.text.size() / sizeof(Pose));
    std::memcpy(poses.data(), outcome.text.data(), poses.size() * sizeof(Pose));
    motion_.assign(std::move(poses));
    remark_ = settings_text(backend.effective_settings(scene, settings));
  } catch (const std::exception& error) {
    remark_ = error.what();
  }
}

}  // namespace plumb::window
