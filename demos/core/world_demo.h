#pragma once

#include <string_view>

#include "demos/core/demo.h"
#include "engine/world/past_poses.h"

namespace plumb::demos {

/// A demo that plays in a world: what those have in common.
class WorldDemo : public Demo {
 public:
  void draw(DebugDraw& out, const DrawOptions& options = {}) const override;
  std::uint64_t hash() const override { return world_.hash(); }
  const DemoWorld* world() const override { return &world_; }

 protected:
  explicit WorldDemo(About about) : Demo(std::move(about)) {}
  /// The controls that all worlds have; to be called after the demo's own.
  void add_step_controls();

  virtual WorldDefinition definition() const { return {}; }
  virtual void fill() = 0;       ///< the empty world, from the controls
  virtual void before_step() {}  ///< forces of the next step
  virtual void after_step() {}   ///< what happened in it
  virtual void draw_over(DebugDraw&) const {}
  /// What the demo itself remembers, beside the world and the controls.
  virtual std::vector<double> own() const { return {}; }
  /// Takes what `own` gave; the world is the one of then.
  virtual void set_own(std::span<const double>) {}

  void build() final;
  void step() final;
  void write(ByteWriter& out) const final;
  void read(ByteReader& in) final;

  // A body that the pointer holds by a point, as by a rubber band.
  /// Takes hold of the dynamic body at `point`, or of the nearest one not farther than `reach` m; false where
  /// there is none. `strength`: the most that the band pulls with, in weights of the body.
  bool grab(Vec2d point, double reach, double strength = 100);
  /// Takes hold of this dynamic body.
  void hold(BodyId body, Vec2d point, double strength = 100);
  void pull(Vec2d point);  ///< the pointer is here now
  void let_go();
  BodyId held() const;  ///< names nothing where nothing is held

  /// Where the centre of a body is drawn.
  Vec2d drawn_centre(BodyId body) const;
  /// The same with its angle as a rotation.
  Pose<double> drawn_pose(BodyId body) const;

  DemoWorld world_;
  BodyId frame_{};  ///< static, without shapes: what bands and hinges are fixed to
  int substeps_ = 4;

 private:
  PastPoses<DemoReal> before_;
  JointId band_{};
};

/// An arrow, its head a tenth of its length.
void draw_arrow(DebugDraw& out, Vec2d from, Vec2d to, DrawRole role);

/// The momentum and energy of all dynamic bodies: kg m/s, J.
struct Totals {
  Vec2d momentum{};
  double energy = 0;  ///< kinetic: of translation and of rotation
};
Totals totals_of(const DemoWorld& world);

}  // namespace plumb::demos
