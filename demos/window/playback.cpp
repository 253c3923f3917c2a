#include "demos/window/playback.h"

#include <algorithm>
#include <utility>

#include "demos/core/view_scene.h"
#include "engine/scene/bytes.h"
#include "engine/world/checksum.h"

namespace plumb::window {

PlaybackDemo::PlaybackDemo(demos::About about, Scene scene, demos::SampledMotion motion, double dt,
                           std::optional<Aabb<double>> view)
    : Demo(std::move(about)), scene_(std::move(scene)), motion_(std::move(motion)) {
  dt_ = dt;
  if (view) {
    view_ = *view;
    return;
  }
  constexpr int kSamples = 60;  // enough to see how far a body goes
  std::vector<BodyState> states(scene_.bodies.size());
  at(0, states);
  view_ = demos::bounds_of(scene_, states);
  for (int i = 1; i <= kSamples; ++i) {
    at(motion_.end() * i / kSamples, states);
    view_ = merged(view_, demos::bounds_of(scene_, states));
  }
  view_ = view_.grown(0.15 * view_.half_perimeter());
}

void PlaybackDemo::at(double time, std::span<BodyState> out) const {
  motion_.at(std::clamp(time, 0.0, motion_.end()), out);
}

void PlaybackDemo::draw(DebugDraw& out, const DrawOptions& options) const {
  std::vector<BodyState> states(scene_.bodies.size());
  at(time() - (1 - fraction()) * dt(), states);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const bool fixed = scene_.bodies[i].type == BodyType::Static;
    demos::draw_body(scene_.bodies[i], states[i], out, fixed ? DrawRole::Static : DrawRole::Awake);
    if (options.names) out.text(states[i].position, scene_.bodies[i].name, DrawRole::Name);
  }
  demos::draw_connections(scene_, states, out);
}

std::vector<demos::Figure> PlaybackDemo::figures() const {
  return {{"time", time(), "s"}, {"end of the run", motion_.end(), "s"}};
}

std::uint64_t PlaybackDemo::hash() const {
  std::vector<BodyState> states(scene_.bodies.size());
  read_states(states);
  std::vector<std::byte> bytes;
  ByteWriter out(bytes);
  for (const BodyState& state : states) {
    out.value(state.position.x);
    out.value(state.position.y);
    out.value(state.angle);
  }
  return checksum(bytes);
}

}  // namespace plumb::window
