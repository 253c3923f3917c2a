#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "harness/interrupt.h"
#include "harness/isolate.h"
#include "harness/reality/published/published_law.h"

namespace plumb::harness::reality {
namespace {

/// Time limit of a motion, s. Engines of fixed steps need less than one; those that step to a tolerance need
/// minutes where dozens of bodies touch, since each evaluation involves all contacts at once.
constexpr double kLongest = 10;

double measure(const reference::Backend& engine, const PublishedLaw& law) {
  std::vector<Sample> samples(1, Sample(law.scene.bodies.size()));
  std::transform(law.scene.bodies.begin(), law.scene.bodies.end(), samples[0].begin(), initial_state);
  engine.create(law.scene, {.dt = law.dt})
      ->record(static_cast<int>(std::lround(law.duration / law.dt)), 1, law.scene.bodies.size(),
               [&](double, std::span<const BodyState> states) {
                 samples.emplace_back(states.begin(), states.end());
               });
  return law.measure(samples);
}

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

std::vector<PublishedFinding> examine_published(std::span<const PublishedLaw> laws,
                                                std::span<const reference::Backend* const> engines) {
  std::vector<PublishedFinding> out;
  for (const PublishedLaw& law : laws) {
    for (const reference::Backend* engine : engines) {
      if (interrupted()) return out;
      PublishedFinding finding{law.name, law.quantity, law.source, std::string(engine->name()),
                               law.low,  law.high,     0,          {}};
      const reference::Identity identity = engine->identity();
      finding.why_not = identity.available ? engine->unsupported(law.scene, {.dt = law.dt}) : identity.reason;
      if (finding.why_not.empty()) {
        // 17 digits keep every bit.
        const Outcome outcome =
            isolate([&] { return fmt::format("{:.17g}", measure(*engine, law)); }, kLongest);
        if (outcome.kind == Outcome::Kind::Interrupted) return out;
        if (outcome.kind == Outcome::Kind::Done)
          finding.value = std::stod(outcome.text);
        else
          finding.why_not = outcome.text;
      }
      out.push_back(std::move(finding));
    }
  }
  return out;
}

}  // namespace plumb::harness::reality
