#include "demos/web/viewer.h"

#include <algorithm>

namespace plumb::web {
namespace {

constexpr std::size_t kTruth = 0;  // index of the truth among the ghosts

}  // namespace

Viewer::Viewer(const scenarios::Instance& instance)
    : truth_(instance.build()),
      demo_(truth_.scene(), instance.scenario->summary, truth_.view()),
      states_(truth_.scene().bodies.size()),
      dt_(demo_.dt()) {
  ghosts_.push_back({"truth", truth_.known(), truth_.known() ? truth_.source() : "no answer is known"});
  backends_.push_back(nullptr);
  for (const reference::Backend* backend : reference::backends()) {
    backends_.push_back(backend);
    ghosts_.push_back({std::string(backend->name())});
  }
  runs_.resize(ghosts_.size());
  for (const Ghost& ghost : ghosts_) error_names_.push_back(ghost.name + " error");
}

void Viewer::show(std::size_t ghost, bool shown) {
  if (ghost >= ghosts_.size()) return;
  ghosts_[ghost].shown = shown && (ghost != kTruth || truth_.known());
  if (ghost == kTruth) return;
  runs_[ghost].reset();
  ghosts_[ghost].remark.clear();
  if (shown) start(ghost);
}

void Viewer::start(std::size_t ghost) {
  const reference::Backend& backend = *backends_[ghost];
  const reference::StepSettings settings{.dt = dt_};
  ghosts_[ghost].remark = backend.unsupported(truth_.scene(), settings);
  ghosts_[ghost].shown = ghosts_[ghost].remark.empty();
  if (!ghosts_[ghost].shown) return;
  for (const auto& [name, value] : backend.effective_settings(truth_.scene(), settings))
    ghosts_[ghost].remark += (ghosts_[ghost].remark.empty() ? "" : ", ") + name + " " + value;
  runs_[ghost].reset(
      new Run{backend.create(truth_.scene(), settings), demos::SampledMotion(dt_, states_.size())});
  std::vector<BodyState> states(states_.size());
  runs_[ghost]->simulator->read(states);
  runs_[ghost]->motion.add(states);
}

// Restarts the engines if the step was changed. As for the demo itself, the change takes effect at the next
// start.
void Viewer::follow_step() {
  if (demo_.step_count() != 0 || demo_.dt() == dt_) return;
  dt_ = demo_.dt();
  for (std::size_t i = kTruth + 1; i < ghosts_.size(); ++i)
    if (ghosts_[i].shown) start(i);
}

bool Viewer::at(std::size_t ghost, double time, std::span<BodyState> out) {
  if (!ghosts_[ghost].shown) return false;
  if (ghost == kTruth) return truth_.at(time, out);
  if (time > truth_.end()) return false;
  Run& run = *runs_[ghost];
  std::vector<BodyState> states(states_.size());
  while (run.motion.end() < time) {
    run.simulator->advance(1);
    run.simulator->read(states);
    run.motion.add(states);
  }
  return run.motion.at(time, out);
}

std::vector<demos::Figure> Viewer::figures() {
  follow_step();
  std::vector<demos::Figure> out = demo_.figures();
  demo_.read_states(states_);
  const auto compared = truth_.figures(demo_.time(), states_);
  out.insert(out.end(), compared.begin(), compared.end());
  std::vector<BodyState> exact(states_.size()), other(states_.size());
  if (!truth_.at(demo_.time(), exact)) return out;
  for (std::size_t i = kTruth + 1; i < ghosts_.size(); ++i)
    if (at(i, demo_.time(), other))
      out.push_back({error_names_[i], demos::largest_distance(other, exact), "m"});
  return out;
}

void Viewer::draw(CommandBuffer& out) {
  follow_step();
  if (ghosts_[kTruth].shown) truth_.draw_paths(out);
  const double time = std::max(0.0, demo_.time() - (1 - demo_.fraction()) * demo_.dt());
  std::vector<BodyState> states(states_.size());
  const Scene& scene = truth_.scene();
  for (std::size_t i = 0; i < ghosts_.size(); ++i) {
    if (!at(i, time, states)) continue;
    out.begin_ghost(i);
    for (std::size_t body = 0; body < states.size(); ++body)
      if (scene.bodies[body].type != BodyType::Static)
        demos::draw_body(scene.bodies[body], states[body], out, DrawRole::Awake);
    out.end_ghost();
  }
}

}  // namespace plumb::web
