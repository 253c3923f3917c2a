#pragma once

#include <memory>
#include <string>
#include <vector>

#include "demos/compared/sampled_motion.h"
#include "demos/compared/scene_truth.h"
#include "demos/core/view_scene.h"
#include "demos/web/command_buffer.h"
#include "reference/backend.h"

namespace plumb::web {

/// A scenario in the page: plumb's world as a demo, and over it the truth and plumb's other engines. These
/// run in the page too, and advance with the demo step by step.
class Viewer {
 public:
  explicit Viewer(const scenarios::Instance& instance);

  demos::SceneDemo& demo() { return demo_; }

  struct Ghost {
    std::string name;
    bool shown = false;
    std::string remark{};  ///< its source, or the reason for its absence
  };
  const std::vector<Ghost>& ghosts() const { return ghosts_; }
  /// Shows or hides a ghost. An engine that is shown runs from the start with the demo's present step.
  void show(std::size_t ghost, bool shown);

  /// Returns the demo's own figures, energy, and errors against the truth. Throws any exception of a shown
  /// engine.
  std::vector<demos::Figure> figures();
  /// Draws the outlines of the shown ghosts.
  void draw(CommandBuffer& out);

 private:
  struct Run {
    std::unique_ptr<reference::Simulator> simulator;
    demos::SampledMotion motion;
  };
  bool at(std::size_t ghost, double time, std::span<BodyState> out);
  void start(std::size_t ghost);
  void follow_step();

  demos::SceneTruth truth_;
  demos::SceneDemo demo_;
  std::vector<BodyState> states_;
  std::vector<Ghost> ghosts_;                        // the truth, then engines
  std::vector<const reference::Backend*> backends_;  // one per ghost; null for the truth
  std::vector<std::unique_ptr<Run>> runs_;           // one per ghost; null if it is not shown
  std::vector<std::string> error_names_;             // one per ghost
  double dt_;                                        // s, of the runs
};

}  // namespace plumb::web
