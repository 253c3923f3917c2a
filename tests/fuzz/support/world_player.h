#pragma once

#include <cstddef>
#include <vector>

#include "engine/world/world.h"
#include "tests/fuzz/support/byte_source.h"

namespace plumb::fuzz {

/// Plays a world: each call is drawn from bytes, with handles of what is there and of what is gone.
template <class Real>
class WorldPlayer {
 public:
  /// Draws the world's definition. A run is one that a game could make, unless `in` is extreme.
  explicit WorldPlayer(ByteSource& in);

  /// Makes one call that may change the world, and checks that it did what calls promise: a refused one
  /// changes nothing. What it says is in require.h.
  void change();
  /// Asks one of the queries.
  void ask();
  /// Takes steps with the checks of world_checks.h; false when the world refused to go on.
  bool step();
  /// Saves, steps, goes back and steps again: the same bits.
  bool repeat();

  /// All of the above, until the bytes are used up; false when the world refused to go on.
  bool play();

  BasicWorld<Real>& world() { return world_; }

 private:
  void create();
  void add_part();
  void remove();
  void push();
  void change_body();
  void change_part();
  void change_world();
  void apply_forces();
  void expect_gone();

  BodyId some_body() { return some(bodies_); }
  template <class Id>
  Id some(const std::vector<Id>& all) {
    return all.empty() ? Id{} : all[static_cast<std::size_t>(in_.byte()) % all.size()];
  }
  void note_push(BodyId body);
  double draw_dt();
  bool is_everyday();

  static constexpr std::size_t kMost = 40;  // bodies: a run takes milliseconds

  ByteSource& in_;
  BasicWorld<Real> world_;
  bool goes_wild_ = false;  // speeds may be any from here on
  // A force that acts in the next step, with the kg and kg m^2 that it was meant for.
  struct Push {
    BodyId body;
    double mass, inertia;
  };
  std::vector<Push> pushes_;
  // Everything that was ever made: what is gone has to be refused.
  std::vector<BodyId> bodies_;
  std::vector<ShapeId> shapes_;
  std::vector<ChainId> chains_;
  std::vector<JointId> joints_;
};

extern template class WorldPlayer<float>;
extern template class WorldPlayer<double>;

}  // namespace plumb::fuzz
