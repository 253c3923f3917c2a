#include "bench/field/scenes/scenes.h"

namespace plumb::field {

const std::vector<Scene>& scenes() {
  static const std::vector<Scene> all{large_pyramid(), many_pyramids(), joint_grid(), tumbler(),
                                      smash(),         spinner(),       washer(),     rain(),
                                      junkyard(),      compounds(),     empty(),      one_free_body(),
                                      chain_10(),      pyramid_10(),    free_10000()};
  return all;
}

}  // namespace plumb::field
