#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/reality/sample.h"
#include "reference/backend.h"

/// Published laws of real matter, as scenes: an engine's figure is compared with the published band. A single
/// run of a collapse is not meaningful, because starts that differ by less than anyone could measure end far
/// apart. So each law is run from several starts, and its figure is their median.
namespace plumb::harness::reality {

/// States of all bodies at one time.
using Sample = std::vector<BodyState>;

struct PublishedLaw {
  std::string name;      ///< "column_collapse[3]"
  std::string quantity;  ///< measured, with its unit
  std::string source;    ///< of the band
  double low = 0, high = 0;
  std::vector<Scene> starts;            ///< the first as described; in the others positions differ slightly
  double duration = 1, dt = 1.0 / 120;  ///< s
  /// Returns the quantity from the samples, one a step from the start on.
  std::function<double(std::span<const Sample>)> measure;
};

/// Number of starts of a law: the interval of a median needs 20 to be narrower than the range of the runs.
inline constexpr std::size_t kStarts = 20;

/// Returns `kStarts` scenes of `scene_with(shift)`, where `shift()` is 0 for the first, and for the others a
/// random number between -1 and 1 at each call.
std::vector<Scene> starts_of(const std::function<Scene(const std::function<double()>& shift)>& scene_with);

// The published laws, one file each.
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
  double low = 0, high = 0;    ///< the published band
  Estimate value{};            ///< median of the starts, with the interval of bootstrap samples of them
  double least = 0, most = 0;  ///< of the starts
  std::size_t starts = 0;      ///< that were run
  std::string why_not{};       ///< reason if the engine was not run, or did not finish a start
  bool inside() const { return why_not.empty() && value.value >= low && value.value <= high; }
};

/// Runs every law on every engine, each start in a process of its own, two at a time.
std::vector<PublishedFinding> examine_published(std::span<const PublishedLaw> laws,
                                                std::span<const reference::Backend* const> engines);

std::string published_csv(std::span<const PublishedFinding> findings);
std::string published_json(std::span<const PublishedFinding> findings);
std::string published_text(std::span<const PublishedFinding> findings);

}  // namespace plumb::harness::reality
