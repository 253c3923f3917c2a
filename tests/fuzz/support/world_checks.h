#pragma once

#include <vector>

#include "engine/world/world.h"

namespace plumb::fuzz {

/// Checks what holds for every world, at any time between two steps: its lists fit together, its counts
/// agree, its handles are valid and its numbers finite.
template <class Real>
void check_world(const BasicWorld<Real>& world);

/// Checks what a step may not do to bodies.
template <class Real>
class StepCheck {
 public:
  explicit StepCheck(const BasicWorld<Real>& before);
  /// Static bodies and locked axes are where they were. With `everyday` worlds, also that nothing has got a
  /// speed or a spin that no game ever sees.
  void check(const BasicWorld<Real>& after, bool everyday) const;

 private:
  struct Held {
    BodyId body{};
    BodyState state{};
    bool x = false, y = false, rotation = false;
  };
  std::vector<Held> held_;
};

extern template class StepCheck<float>;
extern template class StepCheck<double>;

}  // namespace plumb::fuzz
