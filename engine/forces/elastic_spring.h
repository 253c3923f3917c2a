#pragma once

namespace plumb {

/// Hooke's law with viscous damping along the line between two points.
struct ElasticSpring {
  double stiffness = 100;   ///< N/m, >= 0
  double damping = 0;       ///< N s/m, >= 0
  double rest_length = 1;   ///< m, >= 0
  bool pulls_only = false;  ///< a rubber band: slack below its rest length
};

}  // namespace plumb
