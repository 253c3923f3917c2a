#include "harness/sweep/space.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/style.h"

namespace plumb::harness::sweep {
namespace {

constexpr double kFinestSample = 1.0 / 240;  // s
constexpr int kAdaptiveRungs = 3;

void set(reference::StepSettings& settings, const std::string& name, const std::string& value) {
  if (name == "substeps") {
    settings.substeps = std::atoi(value.c_str());
  } else if (name == "tolerance") {
    settings.tolerance = std::strtod(value.c_str(), nullptr);
  } else {
    settings.options[name] = value;
  }
}

bool has(const reference::StepSettings& settings, const std::string& name, const std::string& value) {
  if (name == "substeps") return settings.substeps && *settings.substeps == std::atoi(value.c_str());
  if (name == "tolerance")
    return settings.tolerance && *settings.tolerance == std::strtod(value.c_str(), nullptr);
  const auto found = settings.options.find(name);
  return found != settings.options.end() && found->second == value;
}

// Returns the index of `value`, or the middle of the list if it is missing.
int index_of(const reference::Knob& knob, std::string_view value) {
  for (std::size_t i = 0; i < knob.values.size(); ++i)
    if (knob.values[i] == value) return static_cast<int>(i);
  return static_cast<int>(knob.values.size()) / 2;
}

std::string default_of(const reference::Backend& backend, const std::string& name) {
  const reference::StepSettings plain;
  if (name == "substeps") return std::to_string(std::lround(plain.dt / backend.method(plain).substep));
  for (const reference::Option& option : backend.options())
    if (option.name == name) return option.fallback;
  return "";
}

}  // namespace

double Ladder::dt(int rung) const { return std::ldexp(coarsest, -rung); }

double sample_interval(double dt) {
  while (dt < kFinestSample * (1 - 1e-9)) dt *= 2;
  return dt;
}

Space::Space(const reference::Backend& backend, const Ladder& ladder)
    : ladder_(ladder),
      adaptive_(backend.method({}).scheme == reference::Scheme::Adaptive),
      knobs_(backend.knobs()) {
  if (adaptive_) ladder_.rungs = std::min(ladder_.rungs, kAdaptiveRungs);
  const long rung = std::lround(std::log2(ladder_.coarsest * 60));
  start_.push_back(static_cast<int>(std::clamp<long>(rung, 0, ladder_.rungs - 1)));
  for (const reference::Knob& knob : knobs_) {
    if (knob.values.empty())
      throw Error(Error::Kind::Value, fmt::format("engine '{}'", backend.name()), knob.name, "",
                  "is a knob without values");
    start_.push_back(index_of(knob, default_of(backend, knob.name)));
  }
}

int Space::size(int axis) const {
  return axis == 0 ? ladder_.rungs
                   : static_cast<int>(knobs_[static_cast<std::size_t>(axis) - 1].values.size());
}

reference::StepSettings Space::settings(const Place& place) const {
  reference::StepSettings out;
  out.dt = ladder_.dt(place[0]);
  for (std::size_t i = 0; i < knobs_.size(); ++i)
    set(out, knobs_[i].name, knobs_[i].values[static_cast<std::size_t>(place[i + 1])]);
  return out;
}

std::optional<Space::Place> Space::find(const reference::StepSettings& settings) const {
  Place place;
  for (int rung = 0; rung < ladder_.rungs && place.empty(); ++rung)
    if (settings.dt == ladder_.dt(rung)) place.push_back(rung);
  if (place.empty()) return {};
  for (const reference::Knob& knob : knobs_) {
    int index = -1;
    for (std::size_t i = 0; i < knob.values.size(); ++i)
      if (has(settings, knob.name, knob.values[i])) index = static_cast<int>(i);
    if (index < 0) return {};
    place.push_back(index);
  }
  return place;
}

Space::Place Space::start() const { return start_; }

std::vector<Space::Place> Space::seeds() const {
  std::vector<Place> out{start_};
  const auto add = [&](int axis, int index) {
    Place place = start_;
    place[static_cast<std::size_t>(axis)] = index;
    if (index >= 0 && index < size(axis) && std::find(out.begin(), out.end(), place) == out.end())
      out.push_back(std::move(place));
  };
  if (adaptive_) {
    for (int axis = 1; axis < axes(); ++axis)
      if (knobs_[static_cast<std::size_t>(axis) - 1].ordered)
        for (int index = 0; index < size(axis); index += 3) add(axis, index);
    add(0, 0);
  } else {
    for (const int rungs : {2, -2, 4, 6}) add(0, start_[0] + rungs);
  }
  return out;
}

double Space::cost_of(int axis, int index) const {
  if (axis == 0) return adaptive_ ? 1 : std::ldexp(1.0, index);
  const reference::Knob& knob = knobs_[static_cast<std::size_t>(axis) - 1];
  if (!knob.ordered || knob.name == "tolerance") return 1;
  const double value = std::strtod(knob.values[static_cast<std::size_t>(index)].c_str(), nullptr);
  return value >= 1 ? value : 1;
}

std::vector<Space::Neighbour> Space::neighbours(const Place& place) const {
  std::vector<Neighbour> out;
  for (int axis = 0; axis < axes(); ++axis) {
    const int here = place[static_cast<std::size_t>(axis)];
    const bool ordered = axis == 0 || knobs_[static_cast<std::size_t>(axis) - 1].ordered;
    for (int index = 0; index < size(axis); ++index) {
      if (index == here || (ordered && std::abs(index - here) != 1)) continue;
      Place next = place;
      next[static_cast<std::size_t>(axis)] = index;
      out.push_back({std::move(next), axis, cost_of(axis, index) / cost_of(axis, here)});
    }
  }
  return out;
}

std::string settings_text(const reference::StepSettings& settings) {
  std::string out = fmt::format("dt {}", dt_text(settings.dt));
  if (settings.substeps) out += fmt::format(", substeps {}", *settings.substeps);
  if (settings.tolerance) out += fmt::format(", tolerance {:g}", *settings.tolerance);
  for (const auto& [name, value] : settings.options) out += fmt::format(", {} {}", name, value);
  return out;
}

}  // namespace plumb::harness::sweep
