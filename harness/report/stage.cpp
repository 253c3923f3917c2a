#include "harness/report/stage.h"

#include "engine/scene/error.h"

namespace plumb::harness::report {

std::optional<Stage> stage_of(const std::string& label, int frames) {
  Stage out;
  try {
    const std::vector<scenarios::Instance> found = scenarios::select(label);
    if (found.size() != 1 || found.front().label() != label) return {};
    out.summary = found.front().scenario->summary;
    out.problem = found.front().build();
  } catch (const Error&) {
    return {};  // a scene of the user's own, or of another version
  }
  for (int i = 0; i < frames; ++i) out.times.push_back(out.problem.duration * i / (frames - 1));
  if (!out.problem.truth.exact) return out;
  std::vector<BodyState> states(out.problem.scene.bodies.size());
  for (const double time : out.times) {
    out.problem.truth.exact(time, states);
    std::vector<Pose>& poses = out.truth.emplace_back();
    for (const BodyState& s : states) poses.push_back({s.position.x, s.position.y, s.angle});
  }
  return out;
}

}  // namespace plumb::harness::report
