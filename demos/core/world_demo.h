#pragma once

#include <string_view>

#include "demos/core/demo.h"
#include "engine/world/past_poses.h"

namespace plumb::demos {

/// Common parts of the demos that play in a world.
class WorldDemo : public Demo {
 public:
  void draw(DebugDraw& out, const DrawOptions& options = {}) const override;
  std::uint64_t hash() const override { return world_.hash(); }
  const DemoWorld* world() const override { return &world_; }

 protected:
  explicit WorldDemo(About about) : Demo(std::move(about)) {}
  /// Adds the controls that all worlds have; call it after adding the demo's own.
  void add_step_controls();

  virtual WorldDefinition definition() const { return {}; }
  virtual void fill() = 0;       ///< fills the empty world, from the controls
  virtual void before_step() {}  ///< applies forces for the next step
  virtual void after_step() {}   ///< handles the events of the step
  virtual void draw_over(DebugDraw&) const {}
  /// Returns the demo's own state, beside the world and the controls.
  virtual std::vector<double> own() const { return {}; }
  /// Restores the state that `own` returned; the world has been restored before.
  virtual void set_own(std::span<const double>) {}

  void build() final;
  void step() final;
  void write(ByteWriter& out) const final;
  void read(ByteReader& in) final;

  // A body held by the pointer at a point, as by a rubber band.
  /// Grabs the dynamic body at `point`, or the nearest one within `reach` m; false if there is none.
  /// `strength`: maximum force of the band, in weights of the body.
  bool grab(Vec2d point, double reach, double strength = 100);
  /// Grabs this dynamic body.
  void hold(BodyId body, Vec2d point, double strength = 100);
  void pull(Vec2d point);  ///< moves the target of the band
  void let_go();
  BodyId held() const;  ///< invalid if nothing is held

  /// Returns the drawn position of a body's centre of mass.
  Vec2d drawn_centre(BodyId body) const;
  /// Returns the drawn pose of a body.
  Pose<double> drawn_pose(BodyId body) const;

  DemoWorld world_;
  BodyId frame_{};  ///< static, without shapes: the fixed end of bands and hinges
  int substeps_ = 4;

 private:
  PastPoses<DemoReal> before_;
  JointId band_{};
};

/// Draws an arrow, its head a fifth of its length.
void draw_arrow(DebugDraw& out, Vec2d from, Vec2d to, DrawRole role);

/// Returns a mass as text: "10 kg".
std::string mass_text(double mass);

/// Total momentum and energy of all dynamic bodies: kg m/s, J.
struct Totals {
  Vec2d momentum{};
  double energy = 0;  ///< kinetic: of translation and of rotation
};
Totals totals_of(const DemoWorld& world);

}  // namespace plumb::demos
