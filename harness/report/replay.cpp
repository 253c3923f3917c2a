#include "harness/report/replay.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/energy.h"
#include "harness/interrupt.h"
#include "harness/isolate.h"
#include "harness/run.h"
#include "harness/sweep/rows.h"
#include "harness/text_file.h"

namespace plumb::harness::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSamples = 240;          // samples of a replay
constexpr std::size_t kPoses = 10000;  // poses of a replay: a hundred bodies are shown at a hundred times

// Formats a number for drawing: six digits; null if non-finite.
std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null"; }

std::string list(const std::vector<std::string>& parts) { return fmt::format("[{}]", fmt::join(parts, ",")); }

// Records a run: every `stride`-th sample's poses, and the largest error and drift since the one before.
class Recorder {
 public:
  explicit Recorder(const Case& scene_case)
      : case_(scene_case),
        drifts_(case_.problem, conservation_scale(case_.problem.scene, case_.truth)),
        stride_(stride_of(case_.truth.steps(), case_.problem.scene.bodies.size())) {}

  void add(int sample, std::span<const BodyState> states) {
    if (case_.truth.known()) {
      const auto truth = case_.truth.at(sample);
      for (std::size_t i = 0; i < states.size(); ++i) {
        const Vec2d off = states[i].position - truth[i].position;
        error_ = std::max(error_, std::hypot(off.x, off.y));
      }
    }
    if (const auto energy = drifts_.drift(states).energy) drift_ = std::max(drift_.value_or(0), *energy);
    if (sample % stride_ == 0 || sample == case_.truth.steps()) keep(sample, states);
  }

  std::string json() const {
    return fmt::format(R"({{"times":{},"poses":{},"errors":{},"energies":{}}})", list(times_), list(poses_),
                       list(errors_), list(energies_));
  }

 private:
  static int stride_of(int steps, std::size_t bodies) {
    const std::size_t room = std::max<std::size_t>(2, kPoses / std::max<std::size_t>(1, bodies));
    const int samples = static_cast<int>(std::min<std::size_t>(kSamples, room));
    return std::max(1, (steps + samples - 1) / samples);
  }

  void keep(int sample, std::span<const BodyState> states) {
    std::vector<std::string> pose;
    for (const BodyState& s : states)
      for (const double value : {s.position.x, s.position.y, s.angle}) pose.push_back(number(value));
    times_.push_back(number(sample * case_.truth.dt()));
    poses_.push_back(list(pose));
    errors_.push_back(case_.truth.known() ? number(error_) : "null");
    energies_.push_back(drift_ ? number(*drift_) : "null");
    error_ = 0;
    drift_.reset();
  }

  const Case& case_;
  DriftMeter drifts_;
  int stride_;
  double error_ = 0;
  std::optional<double> drift_;
  std::vector<std::string> times_, poses_, errors_, energies_;
};

std::string record(const Case& scene_case, const reference::Backend& backend,
                   const reference::StepSettings& settings) {
  const Scene& scene = scene_case.problem.scene;
  Recorder recorder(scene_case);
  const auto simulator = backend.create(scene, settings);
  std::vector<BodyState> start(scene.bodies.size());
  simulator->read(start);
  recorder.add(0, start);
  int sample = 0;
  simulator->record(scene_case.truth.steps(), 1, scene.bodies.size(),
                    [&](double, std::span<const BodyState> states) { recorder.add(++sample, states); });
  return recorder.json();
}

double octaves_off(const Result& row) { return std::abs(std::log2(row.asked.dt * 60)); }

// Returns each engine's run with the step nearest to 1/60 s; if several, the first.
std::vector<const Result*> replayed(std::span<const Result> scene) {
  std::vector<const Result*> out;
  for (const std::string& engine : sweep::engines_of(scene)) {
    const Result* best = nullptr;
    for (const Result& row : scene)
      if (row.engine == engine && row.ran() && (best == nullptr || octaves_off(row) < octaves_off(*best)))
        best = &row;
    if (best != nullptr) out.push_back(best);
  }
  return out;
}

// Returns figures that identify a run. They change with the build.
std::string figures_of(const Result& row) {
  std::string out = row.engine_version;
  for (const MetricField& field : kMetricFields)
    if (const auto& value = row.metrics.*field.value) out += fmt::format(" {}", *value);
  return out;
}

struct Kept {
  std::string figures, replay;
};

std::map<std::string, Kept> read_kept(const std::string& path) {
  std::map<std::string, Kept> out;
  std::ifstream file(path, std::ios::binary);
  for (std::string line; std::getline(file, line);) {
    const Json json = Json::parse(line, nullptr, false);
    if (!json.is_object() || !json.contains("run") || !json.contains("figures") || !json.contains("replay"))
      continue;
    out[json["run"].get<std::string>()] = {json["figures"].get<std::string>(), json["replay"].dump()};
  }
  return out;
}

class Replays {
 public:
  Replays(std::span<const reference::Backend* const> engines, std::map<std::string, Kept> kept,
          double seconds)
      : engines_(engines), kept_(std::move(kept)), seconds_(seconds) {}

  void add(std::span<const Result> scene) {
    std::map<double, std::unique_ptr<Case>> cases;
    for (const Result* row : replayed(scene)) {
      const std::string key = sweep::key_of(*row), figures = figures_of(*row);
      if (const auto found = kept_.find(key); found != kept_.end() && found->second.figures == figures) {
        out_[key] = found->second;
      } else if (const auto text = run(*row, cases)) {
        out_[key] = {figures, *text};
        fresh_ = true;
      }
    }
  }

  const std::map<std::string, Kept>& all() const { return out_; }
  bool fresh() const { return fresh_; }

 private:
  std::optional<std::string> run(const Result& row, std::map<double, std::unique_ptr<Case>>& cases) {
    const auto engine =
        std::find_if(engines_.begin(), engines_.end(), [&](const reference::Backend* backend) {
          return backend->name() == row.engine && backend->identity().available;
        });
    if (engine == engines_.end() || interrupted()) return {};
    std::unique_ptr<Case>& scene_case = cases[row.asked.dt];
    try {
      const std::vector<scenarios::Instance> found = scenarios::select(row.label);
      if (found.size() != 1 || found.front().label() != row.label) return {};
      if (!scene_case) scene_case = std::make_unique<Case>(found.front(), row.asked.dt);
    } catch (const Error&) {
      return {};  // a scene of the user's own, or the answer cannot be computed
    }
    const Outcome outcome = isolate([&] { return record(*scene_case, **engine, row.asked); }, seconds_);
    if (outcome.kind != Outcome::Kind::Done || !Json::accept(outcome.text)) return {};
    return outcome.text;
  }

  std::span<const reference::Backend* const> engines_;
  std::map<std::string, Kept> kept_, out_;
  double seconds_;
  bool fresh_ = false;
};

}  // namespace

std::vector<Result> rows_to_replay(const std::string& folder_or_file) {
  std::map<std::pair<std::string, std::string>, std::size_t> places;
  std::vector<Result> out;
  sweep::for_each_row(folder_or_file, [&](Result row) {
    if (!row.ran()) return;
    const auto [place, fresh] = places.try_emplace({row.label, row.engine}, out.size());
    if (fresh) {
      out.push_back(std::move(row));
    } else if (Result& best = out[place->second];
               octaves_off(row) < octaves_off(best) || sweep::key_of(row) == sweep::key_of(best)) {
      best = std::move(row);
    }
  });
  return out;
}

std::map<std::string, std::string> replays_of(std::span<const Result> rows,
                                              std::span<const reference::Backend* const> engines,
                                              const std::string& folder, double seconds) {
  const std::string path = (std::filesystem::path(folder) / "replays.jsonl").string();
  Replays replays(engines, read_kept(path), seconds);
  for (const std::vector<Result>& scene : sweep::by_label(rows)) replays.add(scene);
  std::map<std::string, std::string> out;
  std::string text;
  for (const auto& [key, kept] : replays.all()) {
    out[key] = kept.replay;
    text += fmt::format(R"({{"run":{},"figures":{},"replay":{}}})", Json(key).dump(),
                        Json(kept.figures).dump(), kept.replay) +
            "\n";
  }
  if (replays.fresh()) write_whole(path, text);
  return out;
}

}  // namespace plumb::harness::report
