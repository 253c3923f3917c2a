#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "reference/backend.h"

/// Laws of real matter that were published, as scenes: an engine's figure beside the published band.
namespace plumb::harness::reality {

/// States of all bodies at one time.
using Sample = std::vector<BodyState>;

struct PublishedLaw {
  std::string name;      ///< "column_collapse[3]"
  std::string quantity;  ///< measured, with its unit
  std::string source;    ///< of the band
  double low = 0, high = 0;
  Scene scene;
  double duration = 1, dt = 1.0 / 120;  ///< s
  /// Returns the quantity from the samples, one a step from the start on.
  std::function<double(std::span<const Sample>)> measure;
};

// A file each.
std::vector<PublishedLaw> bouncing_ball();
std::vector<PublishedLaw> column_collapse();
std::vector<PublishedLaw> dominoes();
std::vector<PublishedLaw> rocking_block();

/// Returns a box that does not move.
Body fixed_box(const char* name, Vec2d at, Box box, double friction);

/// Returns all of them.
std::vector<PublishedLaw> published_laws();

struct PublishedFinding {
  std::string law, quantity, source, engine;
  double low = 0, high = 0, value = 0;
  std::string why_not{};  ///< reason if the engine was not run, or did not finish
  bool inside() const { return why_not.empty() && value >= low && value <= high; }
};

/// Runs every law on every engine.
std::vector<PublishedFinding> examine_published(std::span<const PublishedLaw> laws,
                                                std::span<const reference::Backend* const> engines);

std::string published_csv(std::span<const PublishedFinding> findings);
std::string published_json(std::span<const PublishedFinding> findings);
std::string published_text(std::span<const PublishedFinding> findings);

}  // namespace plumb::harness::reality
