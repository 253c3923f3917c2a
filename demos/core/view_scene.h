#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "demos/core/world_demo.h"
#include "engine/scene/scene.h"
#include "engine/world/scene/scene_drives.h"
#include "engine/world/scene/scene_forces.h"

namespace plumb::demos {

/// Any scene as a demo: bodies can be dragged, and the step, the substeps and the solver chosen. Sleep is
/// off. Until a body is dragged, the motion is to the bit that of a Simulation (Realtime, float) with the
/// same settings.
class SceneDemo final : public WorldDemo {
 public:
  /// `view`: the part to show, m; by default the dynamic and kinematic bodies at the start. Throws Error as
  /// `add_scene`.
  SceneDemo(const Scene& scene, const std::string& summary, std::optional<Aabb<double>> view = {});

  const Scene& start() const { return scene_; }
  std::optional<Scene> scene() const override;  ///< the same scene in its present state
  /// Reads the state of every body, in the scene's order.
  void read_states(std::span<BodyState> out) const;

  std::vector<Figure> figures() const override;
  Aabb<double> view() const override { return view_; }

 private:
  double reach() const override;
  bool grab_else(Vec2d point) override;
  WorldDefinition definition() const override;
  void fill() override;
  bool frame_last() const override { return true; }
  void advance_world() override;
  void changed(std::string_view control) override;
  void draw_over(DebugDraw& out) const override;

  Scene scene_;
  SceneParts parts_;
  std::optional<SceneForces<DemoReal>> forces_;
  std::optional<SceneDrives<DemoReal>> drives_;
  Aabb<double> view_{};
  int solver_ = 0, iterations_ = 10;
};

/// Returns the box around a scene's bodies that are not static (around all if there are none) in these states
/// (in the scene's order), m.
Aabb<double> bounds_of(const Scene& scene, std::span<const BodyState> states);

/// Draws the connections between a scene's bodies in these states: springs, sticks, ropes over pulleys, and
/// fixed centres of attraction, as discs with a radius of a hundredth of `size` m.
void draw_connections(const Scene& scene, std::span<const BodyState> states, double size, DebugDraw& out);

/// Draws the shapes of one body of a scene in a state.
void draw_body(const Body& body, const BodyState& state, DebugDraw& out, DrawRole role);

}  // namespace plumb::demos
