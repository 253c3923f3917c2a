#include "reference/simulator.h"

#include <vector>

#include "engine/scene/error.h"

namespace plumb::reference {

Reactions Simulator::forces() const {
  throw Error(Error::Kind::Unsupported, "the engine", "forces", "",
              "it has none to show; 'plumb-precise' has those of joints and contacts");
}

double Simulator::record(int samples, int every, std::size_t bodies, const Sink& sink) {
  std::vector<BodyState> states(bodies);
  double nanoseconds = 0;
  for (int sample = 0; sample < samples; ++sample) {
    nanoseconds += advance(every);
    read(states);
    sink(time(), states);
  }
  return nanoseconds;
}

}  // namespace plumb::reference
