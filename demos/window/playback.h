#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "demos/compared/sampled_motion.h"
#include "demos/core/demo.h"
#include "engine/scene/scene.h"

namespace plumb::window {

/// Plays back the motion of a scene that an engine has computed; nothing can be dragged. After the end of the
/// run the bodies stay where they are.
class PlaybackDemo final : public demos::Demo {
 public:
  /// `motion` has a sample every `dt` s, from 0 on.
  PlaybackDemo(demos::About about, Scene scene, demos::SampledMotion motion, double dt,
               std::optional<Aabb<double>> view = {});

  /// Reads the state of every body at the present time, in the scene's order. Velocities are 0.
  void read_states(std::span<BodyState> out) const { at(time(), out); }

  void draw(DebugDraw& out, const DrawOptions& options) const override;
  std::vector<demos::Figure> figures() const override;
  std::vector<demos::Moving> moving() const override;
  double gravity() const override;
  std::optional<Scene> scene() const override;  ///< as it begins
  Aabb<double> view() const override { return view_; }
  std::uint64_t hash() const override;

 private:
  void build() override {}
  void step() override {}
  void write(Encoder&) const override {}
  void read(Decoder&) override {}
  void at(double time, std::span<BodyState> out) const;

  Scene scene_;
  demos::SampledMotion motion_;
  Aabb<double> view_{};
};

}  // namespace plumb::window
