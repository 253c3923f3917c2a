#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/world.h"
#include "harness/hunt/outline.h"

namespace plumb::harness::hunt {

/// Checks what a world reports after each step: each answer against another one, or against the shapes'
/// outlines.
template <class Real>
class StateWatch {
 public:
  explicit StateWatch(const BasicWorld<Real>& world);

  /// Call it before a step, after the calls that precede it.
  void before_step();

  /// Returns the first error after a step of `dt` s, or an empty text.
  std::string after_step(double dt);

  /// Returns the name of the check that objected.
  const std::string& failed() const { return failed_; }

 private:
  using Key = std::pair<std::uint32_t, std::uint32_t>;
  using Pair = std::pair<Key, Key>;
  struct Before {
    Vec2d position{}, velocity{};
    double angle = 0, spin = 0;
    bool awake = false, dynamic = false;
    double mass = 0;
    Vec2d force{};      // N, applied
    double torque = 0;  // N m, applied
    double inertia = 0;
    bool held = false;     // by a joint
    bool touched = false;  // has contacts, or touches that have begun but not ended
    Pair only{};           // the pair of its contact, if it has exactly one
  };

  /// Distance beyond which shapes must be in no contact, as a fraction of their sizes. Contacts of a step are
  /// found before its bodies move, so the displacement of a step is added.
  static constexpr double kApart = 0.02;

  template <class Tag>
  static Key key_of(Handle<Tag> handle) {
    return {handle.index, handle.generation};
  }
  static double size_of(const Outline& outline) { return length(outline.high - outline.low); }

  // Each of these returns an objection, or an empty text.
  std::string counts() const;
  std::string touches();
  std::string distances(double dt);
  bool is_held(BodyId one, BodyId other) const;
  std::string islands() const;
  std::string sensors() const;
  std::string joints() const;
  std::string boxes() const;

  // In state_watch_motion.cpp.
  std::string flights(double dt) const;
  bool meets_something(BodyId body, double way) const;
  std::string locks() const;
  std::string wakings() const;
  std::string impulses(double dt) const;
  std::string limits() const;
  std::string moved() const;
  std::string sleep_events() const;

  const BasicWorld<Real>& world_;
  std::map<Key, Before> before_;
  std::set<Pair> open_;
  std::set<Key> met_;  // pairs of bodies that touched in the last step, or began or ended to touch in it
  std::set<std::pair<Key, Key>> links_;  // pairs of bodies with such a touch
  std::map<Key, BodyId> owners_;         // bodies of all shapes, destroyed shapes included
  std::set<Key> whirled_;  // bodies that have rotated too far in a step for their angle to be known
  std::string failed_;
  std::map<Pair, int> wrong_;  // steps on end
};

extern template class StateWatch<float>;
extern template class StateWatch<double>;

}  // namespace plumb::harness::hunt
