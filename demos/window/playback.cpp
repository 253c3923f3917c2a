#include "demos/window/playback.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "demos/core/view_scene.h"
#include "engine/encoding/encoding.h"
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
  constexpr int kSamples = 60;  // shows how far a body moves
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
  demos::draw_connections(scene_, states, view_.half_perimeter(), out);
}

// Velocities are differences of positions over a step; forces are differences of velocities.
std::vector<demos::Moving> PlaybackDemo::moving() const {
  const std::size_t count = scene_.bodies.size();
  std::vector<BodyState> now(count), before(count), earlier(count);
  const double drawn = time() - (1 - fraction()) * dt();
  at(drawn, now), at(drawn - dt(), before), at(drawn - 2 * dt(), earlier);
  std::vector<demos::Moving> out;
  for (std::size_t i = 0; i < count; ++i) {
    const Body& body = scene_.bodies[i];
    if (body.type == BodyType::Static) continue;
    const Vec2d velocity = 1 / dt() * (now[i].position - before[i].position);
    const Vec2d then = 1 / dt() * (before[i].position - earlier[i].position);
    const double mass = body.type == BodyType::Dynamic ? body.mass : 0;
    const bool known = drawn >= 2 * dt();
    const Vec2d force = known ? mass / dt() * (velocity - then) : Vec2d{};
    const Aabb<double> box{now[i].position, now[i].position};  // a point, within the view
    out.push_back({box, now[i].position, velocity, force, mass});
  }
  return out;
}

double PlaybackDemo::gravity() const { return std::sqrt(length_squared(scene_.gravity)); }

std::optional<Scene> PlaybackDemo::scene() const { return scene_; }

std::vector<demos::Figure> PlaybackDemo::figures() const {
  return {{"time", time(), "s"}, {"end of the run", motion_.end(), "s"}};
}

std::uint64_t PlaybackDemo::hash() const {
  std::vector<BodyState> states(scene_.bodies.size());
  read_states(states);
  std::vector<std::byte> bytes;
  Encoder out(bytes);
  for (const BodyState& state : states) {
    out.put(state.position.x);
    out.put(state.position.y);
    out.put(state.angle);
  }
  return checksum(bytes);
}

}  // namespace plumb::window
