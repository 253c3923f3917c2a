#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "engine/world/world.h"

namespace plumb::harness::hunt {

/// Checks what a world says of itself after each step: each answer against another, or against the shapes'
/// outlines.
template <class Real>
class StateWatch {
 public:
  explicit StateWatch(const BasicWorld<Real>& world);

  /// Call it before a step, after the calls that precede it.
  void before_step();

  /// Returns what is wrong after a step of `dt` s, or an empty text.
  std::string after_step(double dt);

 private:
  using Key = std::pair<std::uint32_t, std::uint32_t>;
  using Pair = std::pair<Key, Key>;
  struct Before {
    Vec2d position{}, velocity{};
    double angle = 0, spin = 0;
    bool awake = false, dynamic = false;
    double mass = 0;
    Vec2d force{};  // N, applied
    Pair only{};    // of its contact, where it has a single one
  };

  std::string counts() const;
  std::string moved() const;
  std::string sleep_events() const;
  std::string touches();
  std::string distances(double dt);
  bool is_held(BodyId one, BodyId other) const;
  std::string islands() const;
  std::string sensors() const;
  std::string joints() const;
  std::string boxes() const;
  std::string impulses(double dt) const;
  std::string limits() const;

  const BasicWorld<Real>& world_;
  std::map<Key, Before> before_;
  std::set<Pair> open_;
  std::set<Key> whirled_;      // that have turned too far in a step for their angle to be known
  std::map<Pair, int> wrong_;  // steps on end
};

extern template class StateWatch<float>;
extern template class StateWatch<double>;

}  // namespace plumb::harness::hunt
