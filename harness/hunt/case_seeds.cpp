#include "harness/hunt/case_seeds.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/case_file/case_file.h"
#include "harness/hunt/idiom.h"
#include "harness/hunt/processor_time.h"
#include "harness/hunt/subject.h"
#include "harness/hunt/views.h"
#include "harness/run.h"

namespace plumb::harness::hunt {
namespace {

constexpr double kStep = 1.0 / 60;  // s, for the file's own scene
constexpr int kSubsteps = 4;
constexpr std::string_view kPrefix = "expected ";  // of the checks of a file's expectations
constexpr double kLongest = 10;                    // s, of a variation
constexpr double kSeconds = 10;                    // processor time limit of Precise

// Draws steps no longer than the usual one, so that the file's expectations still apply.
void draw_finer_steps(Draft& draft) {
  Case& out = draft.out;
  const double duration = out.steps * out.dt;
  const int finer = draft.random.pick({1, 2, 4});
  out.dt /= finer, out.substeps = draft.random.pick({4, 8, 16});
  out.steps = static_cast<int>(std::ceil(duration / out.dt - 1e-9));
  out.sleeping = draft.random.chance(0.3);
}

// Multiplies masses, and inertias if they are given.
void draw_masses(Draft& draft) {
  const double all = draft.random.ladder(0.01, 100);
  for (Body& body : draft.out.scene.bodies) {
    const double times = all * (draft.random.chance(0.3) ? draft.random.ladder(0.1, 10) : 1);
    body.mass *= times;
    if (body.inertia) *body.inertia *= times;
  }
}

void draw_materials(Draft& draft) {
  const double friction = draft.random.pick({0.0, 0.1, 0.3, 0.6, 1.0}),
               restitution = draft.random.pick({0.0, 0.2, 0.5, 0.8, 1.0});
  const bool rubs = draft.random.chance(0.7), bounces = draft.random.chance(0.5);
  for (Body& body : draft.out.scene.bodies)
    for (Shape& shape : body.shapes) {
      if (rubs) shape.friction = friction;
      if (bounces) shape.restitution = restitution;
    }
}

void draw_disturbance(Draft& draft) {
  std::vector<const Idiom*> some;
  for (const Idiom& idiom : idioms())
    if (idiom.role == Idiom::Role::Disturbance && (!idiom.fits || idiom.fits(draft))) some.push_back(&idiom);
  if (some.empty()) return;
  const Idiom* chosen = draft.random.pick(some);
  draft.idiom = chosen->name;
  draft.out.idioms.push_back(chosen->name);
  chosen->build(draft);
}

void draw_change(Draft& draft) {
  Case& out = draft.out;
  out.dt = draft.random.chance(0.6) ? kStep : 1.0 / draft.random.pick({30, 50, 100, 120, 240});
  out.substeps = draft.random.pick({2, 4, 4, 8});
  out.sleeping = draft.random.chance(0.3);
  for (int count = draft.random.whole(1, 3); count > 0; --count) {
    switch (draft.random.whole(0, 5)) {
      case 0:
        draw_masses(draft);
        break;
      case 1:
        draw_materials(draft);
        break;
      case 2:
        out.scene.gravity = draft.random.pick({0.3, 2.0, -1.0}) * out.scene.gravity;
        break;
      case 3: {
        const double by = draft.random.ladder(1e-4, 0.03);
        out = perturbed(std::move(out), by, draft.random.whole(1, 1000000));
        break;
      }
      default:
        draw_disturbance(draft);
    }
  }
}

/// Returns the instance and the scene of a case file, which is read once.
const scenarios::Instance& instance_of(const std::string& path) {
  static std::map<std::string, scenarios::Instance> read;
  const auto at = read.find(path);
  return at != read.end() ? at->second : read.emplace(path, case_file::case_instance(path)).first->second;
}

// Returns the first check that the engine misses, as an objection; an empty text if there is none.
std::string missed(const Case& one, const reference::Backend& backend, const scenarios::Instance& instance) {
  const harness::Case scene_case(instance, one.dt);
  reference::StepSettings settings{.dt = one.dt};
  if (backend.name() != "plumb-precise") settings.substeps = one.substeps;
  Result result = run(scene_case, backend, settings);
  if (!result.excused.empty() || result.status == Status::Skipped) return {};
  judge(result, false, {});
  for (const Check& check : result.checks)
    if (!check.pass)
      return fmt::format("{}\n{}\n{}",
                         check.name.starts_with(kPrefix) ? check.name.substr(kPrefix.size()) : check.name,
                         check.value, check.tolerance);
  if (!result.unexpected.empty()) return fmt::format("finite\n{}\n", result.unexpected.front());
  return {};
}

}  // namespace

CaseSeed read_seed(const std::string& path) {
  case_file::CaseFile file = case_file::read_case(path);
  return {path, file.name, std::move(file.problem.scene), file.problem.duration};
}

Case vary(std::uint64_t seed, std::uint64_t index, const std::vector<CaseSeed>& seeds) {
  const CaseSeed& from = seeds[index % seeds.size()];
  Draft draft(seed, index);
  Case& out = draft.out;
  out.scene = from.scene;
  out.idioms = {"case", from.name};
  out.dt = kStep, out.substeps = kSubsteps;
  out.case_file = from.path;
  out.steps = std::max(1, static_cast<int>(std::ceil(from.duration / kStep - 1e-9)));
  draft.site = {.kind = Site::Kind::Floor, .width = 20, .height = 20, .level = false};
  draft.size = typical_size(out.scene);
  if (index < seeds.size()) return std::move(draft.out);
  if (draft.random.chance(0.3)) {
    draw_finer_steps(draft);
  } else {
    const double duration = std::min(from.duration, kLongest);
    out.case_file.clear();
    draw_change(draft);
    out.steps = std::max(1, static_cast<int>(std::ceil(duration / out.dt - 1e-9)));
  }
  return std::move(draft.out);
}

Verdict case_file_verdict(const Case& one, const Engine& engine) {
  if (one.case_file.empty() || !one.actions.empty() || !one.sensors.empty()) return {};
  const scenarios::Instance& instance = instance_of(one.case_file);
  const scenarios::Problem problem = instance.build();
  // A shrunk case no longer has the file's scene.
  if (!(problem.scene == one.scene) || one.steps * one.dt < problem.duration - 1e-9) return {};
  std::string what;
  const auto check = [&] { return missed(one, *engine.backend, instance); };
  if (engine.kind == Engine::Kind::Precise) {
    const Outcome outcome = isolate_within(kSeconds, check);
    if (outcome.kind == Outcome::Kind::Done) what = outcome.text;
  } else {
    what = check();
  }
  if (what.empty()) return {};
  const std::size_t first = what.find('\n'), second = what.find('\n', first + 1);
  const std::string name = what.substr(0, first), value = what.substr(first + 1, second - first - 1),
                    bound = what.substr(second + 1);
  return Objection{
      .law = "case_file",
      .judge = "case_file: " + name,
      .what =
          bound.empty() ? value : fmt::format("{} is missed by {}; the tolerance is {}", name, value, bound),
      .right = fmt::format("{} expects it of this engine, also with shorter steps", one.case_file),
      .time = one.steps * one.dt};
}

}  // namespace plumb::harness::hunt
