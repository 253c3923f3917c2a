#include "bench/field/scenes/scenes.h"

namespace plumb::field {

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all{
      large_pyramid(), many_pyramids(), joint_grid(), tumbler(),      smash(),        spinner(),
      washer(),        rain(),          junkyard(),   compounds(),    empty(),        one_free_body(),
      chain_10(),      pyramid_10(),    free_10000(), free_1000000(), stacks_10000(), stacks_1000000()};
  return all;
}

}  // namespace plumb::field
