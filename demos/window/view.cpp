#include "demos/window/view.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "demos/compared/scene_truth.h"
#include "demos/core/view_scene.h"
#include "demos/window/ghost_run.h"
#include "demos/window/playback.h"
#include "engine/scene/error.h"
#include "reference/backend.h"

namespace plumb::window {
namespace {

using demos::SceneDemo;

constexpr std::size_t kTruth = 0;  // index of the truth among the ghosts

// Compares plumb's motion with the truth and other engines.
class Comparison final : public Companion {
 public:
  Comparison(scenarios::Problem problem, const Engines& engines)
      : truth_(std::move(problem)), states_(scene().bodies.size()) {
    ghosts_.push_back(
        {.name = "truth", .shown = truth_.known(), .remark = truth_.known() ? "" : "no answer is known"});
    std::vector<const reference::Backend*> all = reference::backends();
    all.insert(all.end(), engines.more.begin(), engines.more.end());
    for (const reference::Backend* backend : all) {
      backends_.push_back(backend);
      ghosts_.push_back({.name = std::string(backend->name())});
    }
  }

  const demos::SceneTruth& truth() const { return truth_; }

  std::string about() const override {
    return truth_.source().empty() ? "Other engines, as outlines:" : "Truth: " + truth_.source();
  }
  const std::vector<Ghost>& ghosts() const override { return ghosts_; }

  // Shows the right motion as computed by the most accurate engine: `plumb-precise`, or the world if that
  // does not run the scene.
  void show_right_motion(const demos::Demo& demo) {
    for (const std::string_view name : {"plumb-precise", "plumb"}) {
      const auto ghost = std::ranges::find(ghosts_, name, &Ghost::name);
      show_ghost(static_cast<std::size_t>(ghost - ghosts_.begin()), true);
      run_ghosts(demo);
      if (ghost->shown) return;
    }
  }

  void show_ghost(std::size_t ghost, bool shown) override {
    ghosts_[ghost].shown = shown && (ghost != kTruth || truth_.known());
    stale_ = true;
  }

  std::vector<demos::Figure> figures(const demos::Demo& demo) override {
    // Other engines run with the step that the player has chosen, from that choice or from the start.
    run_ghosts(demo);
    if (const auto* live = dynamic_cast<const SceneDemo*>(&demo)) {
      live->read_states(states_);
    } else {
      static_cast<const PlaybackDemo&>(demo).read_states(states_);
    }
    std::vector<demos::Figure> out = truth_.figures(demo.time(), states_);
    // A motion that is played back has only positions.
    if (dynamic_cast<const PlaybackDemo*>(&demo) != nullptr)
      std::erase_if(out, [](const demos::Figure& figure) { return figure.name.starts_with("energy"); });
    std::vector<BodyState> exact(states_.size());
    if (!truth_.at(demo.time(), exact)) return out;
    std::vector<BodyState> other(states_.size());
    for (std::size_t i = kTruth + 1; i < ghosts_.size(); ++i) {
      const auto run = runs_.find(i);
      if (ghosts_[i].shown && run != runs_.end() && run->second.motion().at(demo.time(), other))
        out.push_back({error_name(i), demos::largest_distance(other, exact), "m"});
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
      const bool there = i == kTruth
                             ? truth_.at(std::max(time, 0.0), states)
                             : run != runs_.end() && run->second.motion().at(std::max(time, 0.0), states);
      if (there) draw_ghost(out, states, static_cast<int>(i));
    }
    out.outline.a = 0;
    if (ghosts_[kTruth].shown) truth_.draw_paths(out);
  }

 private:
  const Scene& scene() const { return truth_.scene(); }

  // Names must live as long as this object: figures refer to them.
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
      const GhostRun run(scene(), *backends_[i - 1], {.dt = dt_}, truth_.end());
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

  demos::SceneTruth truth_;
  std::vector<BodyState> states_;
  std::vector<Ghost> ghosts_;
  std::vector<const reference::Backend*> backends_;  // one for each ghost after the truth
  std::map<std::size_t, GhostRun> runs_;             // keyed by ghost
  std::map<std::size_t, std::string> error_names_;
  double dt_ = 0;
  bool stale_ = true;
};

Show show_of(scenarios::Problem problem, const std::string& summary, const Engines& engines) {
  Show show;
  auto companion = std::make_unique<Comparison>(std::move(problem), engines);
  const demos::SceneTruth& truth = companion->truth();
  if (engines.shown == nullptr) {
    show.demo = std::make_unique<SceneDemo>(truth.scene(), summary, truth.view());
  } else {
    const GhostRun run(truth.scene(), *engines.shown, {.dt = engines.dt}, truth.end());
    if (!run.known())
      throw Error(Error::Kind::Run, fmt::format("engine '{}'", engines.shown->name()), "", "", run.remark());
    demos::About about{.name = truth.scene().name,
                       .summary = summary,
                       .play = fmt::format("{}{}Moved by {}.", demos::sentence_of(summary),
                                           summary.empty() ? "" : " ", engines.shown->name())};
    show.demo = std::make_unique<PlaybackDemo>(about, truth.scene(), run.motion(), engines.dt, truth.view());
  }
  show.companion = std::move(companion);
  return show;
}

}  // namespace

Item scenario_item(const scenarios::Instance& instance, const Engines& engines) {
  return {instance.label(), instance.scenario->summary,
          [instance, engines] { return show_of(instance.build(), instance.scenario->summary, engines); }};
}

std::vector<Item> scenario_items(const Engines& engines) {
  std::vector<Item> items;
  for (const scenarios::Scenario& scenario : scenarios::all())
    for (const scenarios::Instance& instance : scenarios::select(scenario.name))
      items.push_back(scenario_item(instance, engines));
  return items;
}

Item scene_item(const Scene& scene, double duration, const Engines& engines) {
  return {scene.name, "", [scene, duration, engines] {
            return show_of({.scene = scene, .duration = duration}, "", engines);
          }};
}

Item motion_item(const demos::About& about, const Scene& scene, const demos::SampledMotion& motion,
                 const Engines& engines) {
  return {about.name, about.summary, [about, scene, motion, engines] {
            Show show;
            auto companion = std::make_unique<Comparison>(
                scenarios::Problem{.scene = scene, .duration = motion.end()}, engines);
            auto demo = std::make_unique<PlaybackDemo>(about, scene, motion, engines.dt);
            companion->show_right_motion(*demo);
            show.demo = std::move(demo);
            show.companion = std::move(companion);
            return show;
          }};
}

}  // namespace plumb::window
