#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "demos/core/control.h"
#include "engine/geometry/aabb.h"
#include "engine/scene/bytes.h"
#include "engine/world/debug_draw.h"
#include "engine/world/world.h"

namespace plumb {
class Simulation;
}

/// The demos, without a window: what a player does comes in as calls, what there is to see goes out through
/// DebugDraw. They need the engine alone. SI units, y up.
namespace plumb::demos {

/// The world that demos play in: the one of games.
using DemoReal = float;
using DemoWorld = BasicWorld<DemoReal>;

/// A key that a demo answers to, and what it does then.
struct Key {
  char key = 0;
  std::string about;
};

/// What a demo is.
struct About {
  std::string name;     ///< as command lines write it
  std::string summary;  ///< a line
  std::string play;     ///< how to play, in a few sentences
  std::vector<Key> keys{};
};

/// A number that is worth watching.
struct Figure {
  std::string_view name;
  double value = 0;
  std::string_view unit;  ///< "" where there is none
};

/// Something to play with. Time passes in fixed steps whatever the frame rate: the same calls between the
/// same steps give the same bits. Neither copied nor moved: controls point into it.
class Demo {
 public:
  explicit Demo(About about) : about_(std::move(about)) {}
  virtual ~Demo() = default;
  Demo(const Demo&) = delete;
  Demo& operator=(const Demo&) = delete;

  const About& about() const { return about_; }

  // What can be set.
  const std::vector<Control>& controls() const { return controls_; }
  const Control& control(std::string_view name) const;  ///< throws Error (Name) that suggests the nearest
  /// Throws Error (Name) for a control that there is not, and Error (Value) for a number out of its range, or
  /// that is no choice; nothing has changed then.
  void set(std::string_view name, double value);
  void set(std::string_view name, std::string_view choice);

  // What a player does; points in m. A press is followed by drags and one release.
  virtual void press(Vec2d) {}
  virtual void drag(Vec2d) {}
  virtual void release(Vec2d) {}
  virtual void hover(Vec2d) {}  ///< the pointer moved with no button down
  virtual void key(char) {}     ///< one of about().keys; others are ignored

  // Time.
  /// Lets `seconds` of real time pass: takes the steps that are due, keeps the rest for the next call, and
  /// returns how many steps it took. Of a call no more than `kLongestFrame` s counts, so that steps which
  /// cost more than they last slow the demo down, and never pile up.
  int advance(double seconds);
  void step_once();
  /// As it began, with the controls as they are.
  void restart();
  double dt() const { return dt_; }  ///< s, of a step; a control of each demo
  std::int64_t step_count() const { return steps_; }
  double time() const { return time_; }  ///< s
  /// How much of a step has passed since the last one, 0..1: what is drawn lies so far between the last two.
  double fraction() const;

  // What there is to see.
  virtual void draw(DebugDraw& out, const DrawOptions& options = {}) const = 0;
  virtual std::vector<Figure> figures() const = 0;
  virtual Aabb<double> view() const = 0;  ///< m, what to show

  // State.
  /// 64 bits of every body's state: equal on every platform for the same calls.
  virtual std::uint64_t hash() const = 0;
  /// All that the future depends on, controls included.
  std::vector<std::byte> save() const;
  /// Throws Error (Value) for bytes that are not of this demo or damaged; nothing has changed then. Whatever
  /// the pointer held is let go.
  void restore(std::span<const std::byte> bytes);

  /// For a look inside; null where the demo has none.
  virtual const DemoWorld* world() const { return nullptr; }
  virtual const Simulation* simulation() const { return nullptr; }

  static constexpr double kLongestFrame = 0.1;  ///< s

 protected:
  /// Controls stand for members of the demo, whose values they start with.
  void add_slider(std::string name, std::string unit, double low, double high, double& target,
                  std::string about);
  void add_slider(std::string name, std::string unit, int low, int high, int& target, std::string about);
  void add_choice(std::string name, std::vector<std::string> choices, int& target, std::string about);
  void add_switch(std::string name, bool& target, std::string about);
  /// The member has its new value.
  virtual void changed(std::string_view /*control*/) {}

  virtual void build() = 0;  ///< the scene's start, from the controls
  virtual void step() = 0;   ///< by dt()
  virtual void write(ByteWriter& out) const = 0;
  /// Reads what `write` wrote. Controls have their values from then. Changes nothing when it throws.
  virtual void read(ByteReader& in) = 0;

  double dt_ = 1.0 / 60;  ///< s

 private:
  using Target = std::variant<double*, int*, bool*>;
  void add(Control control, Target target);
  std::size_t place_of(std::string_view name) const;
  void put(std::size_t place, double value);

  About about_;
  std::vector<Control> controls_;
  std::vector<Target> targets_;  // by control
  double waiting_ = 0;           // s, that have passed but not been stepped
  double time_ = 0;
  std::int64_t steps_ = 0;
};

}  // namespace plumb::demos
