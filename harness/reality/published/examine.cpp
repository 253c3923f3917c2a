#include <algorithm>
#include <cmath>
#include <random>
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

constexpr unsigned kSeed = 1;  // for the starts, and for bootstrap samples of their results
constexpr int kJobs = 2;       // processes at a time

double measure(const reference::Backend& engine, const PublishedLaw& law, const Scene& scene) {
  std::vector<Sample> samples(1, Sample(scene.bodies.size()));
  std::transform(scene.bodies.begin(), scene.bodies.end(), samples[0].begin(), initial_state);
  engine.create(scene, {.dt = law.dt})
      ->record(static_cast<int>(std::lround(law.duration / law.dt)), 1, scene.bodies.size(),
               [&](double, std::span<const BodyState> states) {
                 samples.emplace_back(states.begin(), states.end());
               });
  return law.measure(samples);
}

/// Runs all starts, the first one alone: if it does not finish, the others are not run.
void run_starts(const reference::Backend& engine, const PublishedLaw& law, PublishedFinding& finding) {
  std::vector<double> found;
  const auto run = [&](std::size_t first, std::size_t end) {
    const std::size_t count = found.size();
    found.resize(end);
    isolate_all(
        end - first, kJobs, kLongest,
        [&](std::size_t i) {  // 17 digits keep every bit
          return fmt::format("{:.17g}", measure(engine, law, law.starts[first + i]));
        },
        [&](std::size_t i, const Outcome& outcome) {
          if (outcome.kind == Outcome::Kind::Done)
            found[count + i] = std::stod(outcome.text);
          else
            finding.why_not = outcome.text;
        });
  };
  run(0, 1);
  if (finding.why_not.empty()) run(1, law.starts.size());
  if (!finding.why_not.empty()) return;
  finding.starts = found.size();
  finding.value = estimate(found, 0.5, kSeed);
  const auto [least, most] = std::minmax_element(found.begin(), found.end());
  finding.least = *least;
  finding.most = *most;
}

}  // namespace

std::vector<Scene> starts_of(const std::function<Scene(const std::function<double()>& shift)>& scene_with) {
  std::mt19937 random(kSeed);
  std::vector<Scene> out{scene_with([] { return 0.0; })};
  while (out.size() < kStarts)
    out.push_back(scene_with([&] { return static_cast<double>(random()) / 0x80000000u - 1; }));
  return out;
}

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
      PublishedFinding finding{.law = law.name,
                               .quantity = law.quantity,
                               .source = law.source,
                               .engine = std::string(engine->name()),
                               .low = law.low,
                               .high = law.high};
      const reference::Identity identity = engine->identity();
      finding.why_not =
          identity.available ? engine->unsupported(law.starts.front(), {.dt = law.dt}) : identity.reason;
      if (finding.why_not.empty()) run_starts(*engine, law, finding);
      if (interrupted()) return out;
      out.push_back(std::move(finding));
    }
  }
  return out;
}

}  // namespace plumb::harness::reality
