#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "demos/core/control.h"
#include "engine/encoding/encoding.h"
#include "engine/geometry/aabb.h"
#include "engine/scene/scene.h"
#include "engine/world/debug_draw.h"
#include "engine/world/world.h"

namespace plumb {
class Simulation;
}

/// The demos, without a window: the player's actions come in as calls, and drawings go out through DebugDraw.
/// They depend on the engine alone. SI units, y up.
namespace plumb::demos {

/// World used by the demos: the same as in games.
using DemoReal = float;
using DemoWorld = BasicWorld<DemoReal>;

/// A key that a demo reacts to, and its effect.
struct Key {
  char key = 0;
  std::string about;
};

/// Name and description of a demo.
struct About {
  std::string name;     ///< as on the command line
  std::string summary;  ///< one line
  std::string play;     ///< how to play, in a few sentences
  std::vector<Key> keys{};
};

/// Returns a summary as a sentence, with a capital letter and a full stop; an empty one stays empty.
std::string sentence_of(std::string_view summary);

/// A figure to display.
struct Figure {
  std::string_view name;
  double value = 0;
  std::string_view unit;  ///< "" if there is none
};

/// A body that moves, as it is drawn.
struct Moving {
  Aabb<double> box{};  ///< m, around its shapes
  Vec2d centre{};      ///< m, centre of mass
  Vec2d velocity{};    ///< m/s
  Vec2d force{};       ///< N, sum of all forces: mass times change of velocity, by the last step
  double mass = 0;     ///< kg
  bool awake = true;
  bool labelled = false;  ///< true if the demo itself labels it with its mass
};

/// Drawings of the motion of bodies, over those of DrawOptions.
struct MotionOptions {
  bool velocities = false;  ///< arrows
  bool forces = false;      ///< arrows of the sum of all forces on a body
  bool masses = false;      ///< labels
  double length = 1;        ///< length of the arrows, relative to the usual one
};

/// An interactive demo. Time advances in fixed steps at any frame rate: the same calls between the same steps
/// give the same bits. Neither copied nor moved, because controls point into it.
class Demo {
 public:
  explicit Demo(About about) : about_(std::move(about)) {}
  virtual ~Demo() = default;
  Demo(const Demo&) = delete;
  Demo& operator=(const Demo&) = delete;

  const About& about() const { return about_; }

  // Settings.
  const std::vector<Control>& controls() const { return controls_; }
  const Control& control(std::string_view name) const;  ///< throws Error (Name) with the nearest name
  /// Throws Error (Name) for an unknown control, and Error (Value) for a number out of range or an invalid
  /// choice; then nothing has changed.
  void set(std::string_view name, double value);
  void set(std::string_view name, std::string_view choice);

  // Actions of the player; points in m. A press is followed by drags and one release.
  virtual void press(Vec2d) {}
  virtual void drag(Vec2d) {}
  virtual void release(Vec2d) {}
  virtual void hover(Vec2d) {}  ///< the pointer moved with no button down
  virtual void key(char) {}     ///< one of about().keys; others are ignored

  // Time.
  /// Advances by `seconds` of real time: makes the due steps, keeps the rest for the next call, and returns
  /// the number of steps. A call counts for at most `kLongestFrame` s: if steps are slower than real time,
  /// the demo slows down instead of accumulating steps.
  int advance(double seconds);
  void step_once();
  /// Resets the demo to its start, with the present values of the controls.
  void restart();
  double dt() const { return dt_; }  ///< s, of a step; a control of each demo
  std::int64_t step_count() const { return steps_; }
  double time() const { return time_; }  ///< s
  /// Returns the time since the last step as a fraction of a step, 0..1. Drawings interpolate between the
  /// last two steps by it.
  double fraction() const;

  // Output.
  virtual void draw(DebugDraw& out, const DrawOptions& options = {}) const = 0;
  virtual std::vector<Figure> figures() const = 0;
  virtual Aabb<double> view() const = 0;  ///< m, the part of the world to show as long as no body leaves it
  /// Returns the bodies that can move, in their present state. Empty if the demo does not provide them.
  virtual std::vector<Moving> moving() const { return {}; }
  virtual double gravity() const { return 0; }  ///< m/s^2
  /// Returns the part of the world to show now, m. It is `view`, enlarged up to twice to contain the awake
  /// bodies; if that is not enough, it moves with them.
  Aabb<double> shown() const;
  /// Draws arrows and masses of moving bodies. The scales of the arrows are fixed and follow from the view.
  /// The velocity of a body that has fallen through the view has an arrow of a third of the view; the largest
  /// weight has one of a tenth. Without gravity, the scales are those for a gravity of one view length per
  /// second squared.
  void draw_motion(DebugDraw& out, const MotionOptions& options) const;
  /// Returns the present state as a scene; nullopt if the demo has none. Forces by the player are left out.
  virtual std::optional<Scene> scene() const { return {}; }

  // State.
  /// Returns 64 bits of every body's state: equal on every platform for the same calls.
  virtual std::uint64_t hash() const = 0;
  /// Saves everything on which the future depends, controls included.
  std::vector<std::byte> save() const;
  /// Throws Error (Value) for bytes that are damaged or of another demo; then nothing has changed. Releases
  /// the body that the pointer held.
  void restore(std::span<const std::byte> bytes);

  /// For inspection; null if the demo has none.
  virtual const DemoWorld* world() const { return nullptr; }
  virtual const Simulation* simulation() const { return nullptr; }

  static constexpr double kLongestFrame = 0.1;  ///< s

 protected:
  /// Adds a control for a member of the demo, starting with its value.
  void add_slider(std::string name, std::string unit, double low, double high, double& target,
                  std::string about);
  void add_slider(std::string name, std::string unit, int low, int high, int& target, std::string about);
  void add_choice(std::string name, std::vector<std::string> choices, int& target, std::string about);
  void add_switch(std::string name, bool& target, std::string about);
  /// Called after the member got its new value.
  virtual void changed(std::string_view /*control*/) {}

  virtual void build() = 0;  ///< builds the scene's start from the controls
  virtual void step() = 0;   ///< advances by dt()
  virtual void write(Encoder& out) const = 0;
  /// Reads the data of `write`. Controls already have the values saved with it. Changes nothing if it throws.
  virtual void read(Decoder& in) = 0;

  double dt_ = 1.0 / 60;  ///< s

 private:
  using Target = std::variant<double*, int*, bool*>;
  void add(Control control, Target target);
  std::size_t place_of(std::string_view name) const;
  void put(std::size_t place, double value);

  About about_;
  std::vector<Control> controls_;
  std::vector<Target> targets_;  // one per control
  double waiting_ = 0;           // s, elapsed but not yet stepped
  double time_ = 0;
  std::int64_t steps_ = 0;
};

}  // namespace plumb::demos
