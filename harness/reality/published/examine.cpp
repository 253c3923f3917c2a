#include <algorithm>
#include <cmath>

#include "engine/scene/error.h"
#include "harness/interrupt.h"
#include "harness/reality/published/published_law.h"

namespace plumb::harness::reality {
namespace {

/// Bodies that touch for minutes of computation a second of motion in engines that step to a tolerance.
constexpr std::size_t kMostAdaptive = 50;

}  // namespace

Body fixed_box(const char* name, Vec2d at, Box box, double friction) {
  Body body{.name = name, .type = BodyType::Static, .position = at};
  body.shapes = {{.geometry = box, .friction = friction}};
  return body;
}

std::vector<PublishedLaw> published_laws() {
  std::vector<PublishedLaw> out;
  for (const auto laws : {bouncing_ball, column_collapse, dominoes, rocking_block})
    for (PublishedLaw& law : laws()) out.push_back(std::move(law));
  return out;
}

std::vector<PublishedFinding> examine_published(std::span<const reference::Backend* const> engines) {
  std::vector<PublishedFinding> out;
  for (const PublishedLaw& law : published_laws()) {
    for (const reference::Backend* engine : engines) {
      if (interrupted()) return out;
      PublishedFinding finding{law.name, law.quantity, law.source, std::string(engine->name()),
                               law.low,  law.high,     0,          {}};
      const reference::Identity identity = engine->identity();
      finding.why_not = identity.available ? engine->unsupported(law.scene, {.dt = law.dt}) : identity.reason;
      // Each evaluation of a motion to a tolerance involves all contacts at once.
      const bool adaptive =
          finding.why_not.empty() && engine->method({.dt = law.dt}).scheme == reference::Scheme::Adaptive;
      if (adaptive && law.scene.bodies.size() > kMostAdaptive)
        finding.why_not = "too many bodies touch for steps to a tolerance";
      if (finding.why_not.empty()) {
        try {
          const auto simulator = engine->create(law.scene, {.dt = law.dt});
          std::vector<Sample> samples(1, Sample(law.scene.bodies.size()));
          std::transform(law.scene.bodies.begin(), law.scene.bodies.end(), samples[0].begin(), initial_state);
          simulator->record(static_cast<int>(std::lround(law.duration / law.dt)), 1, law.scene.bodies.size(),
                            [&](double, std::span<const BodyState> states) {
                              samples.emplace_back(states.begin(), states.end());
                            });
          finding.value = law.measure(samples);
        } catch (const Error& error) {
          finding.why_not = error.what();
        }
      }
      out.push_back(std::move(finding));
    }
  }
  return out;
}

}  // namespace plumb::harness::reality
