#include "demos/compared/scene_truth.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "demos/core/view_scene.h"
#include "harness/energy.h"

namespace plumb::demos {
namespace {

constexpr double kLeast = 10;  // s, minimum duration of other engines' runs
constexpr int kSamples = 120;  // samples of the truth from which the view is computed
constexpr double kRounding = 1e-12;

bool finite(const BodyState& state) {
  return std::isfinite(state.position.x) && std::isfinite(state.position.y) && std::isfinite(state.angle);
}

double largest_turn(std::span<const BodyState> a, std::span<const BodyState> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i].angle - b[i].angle));
  return largest;
}

}  // namespace

double largest_distance(std::span<const BodyState> a, std::span<const BodyState> b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Vec2d apart = a[i].position - b[i].position;
    largest = std::max(largest, std::hypot(apart.x, apart.y));
  }
  return largest;
}

SceneTruth::SceneTruth(scenarios::Problem problem) : problem_(std::move(problem)) {
  std::vector<BodyState> states;
  for (const Body& body : scene().bodies) states.push_back(initial_state(body));
  start_ = energy_of(states);
  for (int i = 0; i <= kSamples; ++i)
    if (at(problem_.duration * i / kSamples, states))
      energy_scale_ = std::max(energy_scale_, harness::mechanics(scene(), states).kinetic);
}

double SceneTruth::end() const { return std::max(problem_.duration, kLeast); }

bool SceneTruth::at(double time, std::span<BodyState> out) const {
  if (!known() || time > problem_.duration * (1 + kRounding)) return false;
  problem_.truth.exact(time, out);
  return std::ranges::all_of(out, finite);
}

double SceneTruth::energy_of(std::span<const BodyState> states) const {
  const harness::Mechanics now = harness::mechanics(scene(), states);
  return now.kinetic + now.potential;
}

std::vector<Figure> SceneTruth::figures(double time, std::span<const BodyState> states) const {
  const double energy = energy_of(states);
  std::vector<Figure> out{{"energy", energy, "J"}};
  if (problem_.conserved.energy && energy_scale_ > 0)
    out.push_back({"energy drift", (energy - start_) / energy_scale_, ""});
  std::vector<BodyState> exact(states.size());
  if (at(time, exact)) {
    out.push_back({"position error", largest_distance(states, exact), "m"});
    out.push_back({"angle error", largest_turn(states, exact), "rad"});
  }
  return out;
}

void SceneTruth::draw_paths(DebugDraw& out) const {
  constexpr int kPathSamples = 400;
  constexpr std::size_t kMostPaths = 3;  // with more bodies, paths would hide the picture
  if (!known()) return;
  if (paths_.empty()) {
    std::vector<BodyState> states(scene().bodies.size());
    std::vector<std::size_t> moving;
    for (std::size_t i = 0; i < states.size(); ++i)
      if (scene().bodies[i].type == BodyType::Dynamic) moving.push_back(i);
    if (moving.size() > kMostPaths) moving.clear();
    paths_.resize(std::max<std::size_t>(moving.size(), 1));
    for (int k = 0; k <= kPathSamples; ++k) {
      if (!at(problem_.duration * k / kPathSamples, states)) break;
      for (std::size_t i = 0; i < moving.size(); ++i) paths_[i].push_back(states[moving[i]].position);
    }
  }
  for (const std::vector<Vec2d>& path : paths_)
    for (std::size_t k = 1; k < path.size(); ++k) out.segment(path[k - 1], path[k], DrawRole::Trail);
}

std::optional<Aabb<double>> SceneTruth::view() const {
  if (!known()) return {};
  std::vector<BodyState> states(scene().bodies.size());
  std::optional<Aabb<double>> box;
  for (int i = 0; i <= kSamples; ++i) {
    problem_.truth.exact(problem_.duration * i / kSamples, states);
    const Aabb<double> now = bounds_of(scene(), states);
    if (!std::isfinite(now.half_perimeter())) return {};
    box = box ? merged(*box, now) : now;
  }
  constexpr double kSpecks = 20;
  for (std::size_t i = 0; i < states.size(); ++i) states[i] = initial_state(scene().bodies[i]);
  if (box->half_perimeter() > kSpecks * bounds_of(scene(), states).half_perimeter()) return {};
  return box->grown(0.05 * box->half_perimeter());
}

}  // namespace plumb::demos
