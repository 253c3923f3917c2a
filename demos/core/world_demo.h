#pragma once

#include <cmath>
#include <string_view>

#include "demos/core/arrow.h"
#include "demos/core/demo.h"
#include "engine/world/past_poses.h"

namespace plumb::demos {

/// The key of demos that use the pointer in their own way.
inline const Key kGrabKey{'g', "grab and throw, or the demo's own play"};

/// Common parts of the demos that play in a world. The pointer grabs bodies and throws them. A demo that also
/// uses the pointer in its own way offers a choice between the two, which the key `g` changes.
class WorldDemo : public Demo {
 public:
  void press(Vec2d point) final;
  void drag(Vec2d point) final;
  void release(Vec2d point) final;
  void key(char key) override;
  std::vector<Moving> moving() const override;
  double gravity() const override { return std::sqrt(length_squared(world_.gravity())); }
  std::optional<Scene> scene() const override;
  void draw(DebugDraw& out, const DrawOptions& options = {}) const override;
  std::uint64_t hash() const override { return world_.hash(); }
  const DemoWorld* world() const override { return &world_; }

 protected:
  explicit WorldDemo(About about) : Demo(std::move(about)) {}
  /// Adds the demo's own use of the pointer, called `name`, as the first of two choices. Call it first.
  void add_pointer_play(const char* name);
  // The play of the pointer.
  virtual void begin(Vec2d) {}
  virtual void go_on(Vec2d) {}
  virtual void end(Vec2d) {}
  virtual double reach() const;  ///< m, from the pointer to a body that it grabs
  /// Called when the pointer misses every body; returns true if it holds one nevertheless.
  virtual bool grab_else(Vec2d) { return false; }

  /// Adds the controls that all worlds have; call it after adding the demo's own.
  void add_step_controls();

  virtual WorldDefinition definition() const { return {}; }
  virtual void fill() = 0;  ///< fills the empty world, from the controls
  /// Returns true if the frame comes after what `fill` adds, so that its bodies have the places that they
  /// have in a world of their own, on which the last bits of a motion depend.
  virtual bool frame_last() const { return false; }
  virtual void before_step() {}  ///< applies forces for the next step
  virtual void advance_world() { world_.step(dt_, substeps_); }
  virtual void after_step() {}  ///< handles the events of the step
  virtual void draw_over(DebugDraw&) const {}
  virtual bool labelled(BodyId) const { return false; }  ///< true if draw_over labels it with its mass
  /// Returns the demo's own state, apart from the world and the controls.
  virtual std::vector<double> own() const { return {}; }
  /// Restores the state that `own` returned, after the world was restored.
  virtual void set_own(std::span<const double>) {}

  void build() final;
  void step() final;
  void write(Encoder& out) const final;
  void read(Decoder& in) final;

  // A body held by the pointer at a point, as by a rubber band.
  /// Grabs the dynamic body at `point`, or the nearest one within `reach` m; returns false if there is none.
  /// `strength` is the maximum force of the band, in weights of the body.
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
  struct PastVelocity {
    std::uint32_t generation = 0;
    Vec2d velocity{};  // m/s
  };
  void create_frame();
  void keep_past();

  PastPoses<DemoReal> before_;
  std::vector<PastVelocity> velocities_before_;  // by the body's index
  JointId band_{};
  enum Pointer { kPlays, kGrabs };
  int pointer_ = kGrabs;
};

/// Total momentum and energy of all dynamic bodies: kg m/s, J.
struct Totals {
  Vec2d momentum{};
  double energy = 0;  ///< kinetic: of translation and of rotation
};
Totals totals_of(const DemoWorld& world);

}  // namespace plumb::demos
