#pragma once

#include <string>
#include <vector>

#include "app/selection.h"

namespace plumb::app {

struct AgainRequest {
  std::string results;  ///< folder or file of results
  std::vector<std::string>
      names;  ///< scenes; none: all that the results are of, as far as they are scenarios
  int size = 0;
  EngineOptions engines{};  ///< none: all that the results are of
  std::string out, format;
  int jobs = 1;
  double seconds_a_run = 300;
};

/// Runs `compare --again RESULTS`: makes the runs of a set of results again, each with its own settings, and
/// prints what differs. Goes on from what is in `out`. Runs that were stopped for their time are left out.
int compare_again(const AgainRequest& request);

}  // namespace plumb::app
