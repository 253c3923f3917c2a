#include "demos/window/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "demos/core/view_scene.h"
#include "demos/window/ghost_run.h"
#include "harness/energy.h"
#include "reference/backend.h"

namespace plumb::window {
namespace {

using demos::SceneDemo;

constexpr double kLeast = 10;      // s, that other engines run, however short the scenario
constexpr int kSamples = 120;      // of the truth, for what to show
constexpr std::size_t kTruth = 0;  // its place among the ghosts

// plumb's motion against the truth and other engines.
class Comparison final : public Companion {
 public:
  Comparison(scenarios::Problem problem) : problem_(std::move(problem)), states_(scene().bodies.size()) {
    const bool known = static_cast<bool>(problem_.truth.exact);
    ghosts_.push_back({.name = "truth", .shown = known, .remark = known ? "" : "no answer is known"});
    for (const reference::Backend* backend : reference::backends()) {
      backends_.push_back(backend);
      ghosts_.push_back({.name = std::string(backend->name())});
    }
    start_ = mechanics_of(problem_.scene);
    energy_scale_ = scale_of_energy();
  }

  std::string about() const override {
    return problem_.truth.source.empty() ? "Other engines, over plumb:" : "Truth: " + problem_.truth.source;
  }
  const std::vector<Ghost>& ghosts() const override { return ghosts_; }

  void show_ghost(std::size_t ghost, bool shown) override {
    ghosts_[ghost].shown = shown && (ghost != kTruth || problem_.truth.exact);
    stale_ = true;
  }

  std::vector<demos::Figure> figures(const demos::Demo& demo) override {
    // The others run with the step that the player has chosen, from when that is chosen or from the start.
    run_ghosts(demo);
    std::vector<demos::Figure> out;
    static_cast<const SceneDemo&>(demo).read_states(states_);
    const harness::Mechanics now = harness::mechanics(scene(), states_);
    out.push_back({"energy", now.kinetic + now.potential, "J"});
    if (problem_.conserved.energy && energy_scale_ > 0)
      out.push_back({"energy drift", (now.kinetic + now.potential - start_) / energy_scale_, ""});
    std::vector<BodyState> exact(states_.size());
    if (!truth_at(demo.time(), exact)) return out;
    out.push_back({"position error", distance(states_, exact), "m"});
    out.push_back({"angle error", turn(states_, exact), "rad"});
    std::vector<BodyState> other(states_.size());
    for (std::size_t i = kTruth + 1; i < ghosts_.size(); ++i) {
      const auto run = runs_.find(i);
      if (ghosts_[i].shown && run != runs_.end() && run->second.at(demo.time(), other))
        out.push_back({error_name(i), distance(other, exact), "m"});
    }
    return out;
  }

  void draw(Painter& out, const demos::Demo& demo) override {
    const double time = demo.time() - (1 - demo.fraction()) * demo.dt();
    run_ghosts(demo);
    std::vector<BodyState> states(states_.size());
    for (std::size_t i = 0; i < ghosts_.size(); ++i) {
      if (!ghosts_[i].shown) continue;
      const auto run = runs_.find(i);
      const bool there = i == kTruth ? truth_at(std::max(time, 0.0), states)
                                     : run != runs_.end() && run->second.at(std::max(time, 0.0), states);
      if (there) draw_ghost(out, states, static_cast<int>(i));
    }
    out.outline.a = 0;
  }

 private:
  const Scene& scene() const { return problem_.scene; }

  static double mechanics_of(const Scene& scene) {
    std::vector<BodyState> states;
    for (const Body& body : scene.bodies)
      states.push_back({body.position, body.angle, body.velocity, body.angular_velocity});
    const harness::Mechanics start = harness::mechanics(scene, states);
    return start.kinetic + start.potential;
  }

  // J, the largest kinetic energy of the truth over the run: what drifts are relative to.
  double scale_of_energy() {
    double largest = 0;
    std::vector<BodyState> states(scene().bodies.size());
    for (int i = 0; i <= kSamples; ++i)
      if (truth_at(problem_.duration * i / kSamples, states))
        largest = std::max(largest, harness::mechanics(scene(), states).kinetic);
    return largest;
  }

  bool truth_at(double time, std::span<BodyState> out) const {
    if (!problem_.truth.exact || time > std::max(problem_.duration, kLeast)) return false;
    problem_.truth.exact(time, out);
    return std::ranges::all_of(out, [](const BodyState& s) {
      return std::isfinite(s.position.x) && std::isfinite(s.position.y) && std::isfinite(s.angle);
    });
  }

  static double distance(std::span<const BodyState> a, std::span<const BodyState> b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      const Vec2d apart = a[i].position - b[i].position;
      largest = std::max(largest, std::hypot(apart.x, apart.y));
    }
    return largest;
  }
  static double turn(std::span<const BodyState> a, std::span<const BodyState> b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i].angle - b[i].angle));
    return largest;
  }

  // Names live as long as this: figures hold on to them.
  std::string_view error_name(std::size_t ghost) {
    std::string& name = error_names_[ghost];
    if (name.empty()) name = ghosts_[ghost].name + " error";
    return name;
  }

  void run_ghosts(const demos::Demo& demo) {
    if (demo.step_count() == 0 && demo.dt() != dt_) stale_ = true;
    if (!stale_) return;
    stale_ = false;
    if (demo.dt() != dt_) runs_.clear();
    dt_ = demo.dt();
    for (std::size_t i = kTruth + 1; i < ghosts_.size(); ++i) {
      if (!ghosts_[i].shown || runs_.contains(i)) continue;
      const GhostRun run(scene(), *backends_[i - 1], {.dt = dt_}, std::max(problem_.duration, kLeast));
      ghosts_[i].remark = run.remark();
      ghosts_[i].shown = run.known();
      if (run.known()) runs_.emplace(i, run);
    }
  }

  void draw_ghost(Painter& out, std::span<const BodyState> states, int ghost) const {
    out.outline = out.ghost(ghost);
    for (std::size_t i = 0; i < states.size(); ++i)
      if (scene().bodies[i].type != BodyType::Static)
        demos::draw_body(scene().bodies[i], states[i], out, DrawRole::Awake);
  }

  scenarios::Problem problem_;
  std::vector<BodyState> states_;
  std::vector<Ghost> ghosts_;
  std::vector<const reference::Backend*> backends_;  // of the ghosts after the truth
  std::map<std::size_t, GhostRun> runs_;             // by ghost
  std::map<std::size_t, std::string> error_names_;
  double dt_ = 0, start_ = 0, energy_scale_ = 0;
  bool stale_ = true;
};

// What the truth goes through, with some room around it.
std::optional<Aabb<double>> view_of(const scenarios::Problem& problem) {
  if (!problem.truth.exact) return {};
  std::vector<BodyState> states(problem.scene.bodies.size());
  std::optional<Aabb<double>> box;
  for (int i = 0; i <= kSamples; ++i) {
    problem.truth.exact(problem.duration * i / kSamples, states);
    const Aabb<double> now = demos::bounds_of(problem.scene, states);
    if (!std::isfinite(now.half_perimeter())) return {};
    box = box ? merged(*box, now) : now;
  }
  return box->grown(0.05 * box->half_perimeter());
}

Show show_of(scenarios::Problem problem, const std::string& summary) {
  Show show;
  show.demo = std::make_unique<SceneDemo>(problem.scene, summary, view_of(problem));
  show.companion = std::make_unique<Comparison>(std::move(problem));
  return show;
}

}  // namespace

Item scenario_item(const scenarios::Instance& instance) {
  return {instance.label(), instance.scenario->summary,
          [instance] { return show_of(instance.build(), instance.scenario->summary); }};
}

std::vector<Item> scenario_items() {
  std::vector<Item> items;
  for (const scenarios::Scenario& scenario : scenarios::all())
    for (const scenarios::Instance& instance : scenarios::select(scenario.name))
      items.push_back(scenario_item(instance));
  return items;
}

Item scene_item(const Scene& scene, double duration) {
  return {scene.name, "", [scene, duration] { return show_of({.scene = scene, .duration = duration}, ""); }};
}

}  // namespace plumb::window
