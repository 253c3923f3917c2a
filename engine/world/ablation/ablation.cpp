#include "engine/world/ablation/ablation.h"

#ifdef PLUMB_ABLATION

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string_view>

namespace plumb {
namespace {

// Names of the mechanisms, in their order.
constexpr std::string_view kMechanisms[] = {
    "slender_islands",   "direct_islands",   "flying_stacks",
    "jointed_islands",   "hinge_trees",      "link_inertia",
    "tree_energy",       "divided_substeps", "kept_impulses",
    "rigid_groups",      "driver_budget",    "yielding_contacts",
    "mass_limits",       "shift_work",       "penetration_corrections",
    "handing_over",      "balanced_breaks",  "joint_gaps",
    "carried_impulses",  "angular_limits",   "contact_gains",
    "load_estimates",    "substep_growth",   "impulse_memory",
    "kinematic_ramps",   "disc_normals",     "kept_closed",
    "turning_contacts",  "riding_contacts",  "lasting_contacts",
    "segments_ahead",    "turned_manifolds", "internal_edges",
    "impacts_in_flight", "landings",         "simultaneous_impacts",
    "separating_faces",  "open_joints",      "self_overlap_pass",
    "shared_searches",   "common_motion",    "lifts",
    "joined_stops",      "remaining_work",   "long_searches",
    "swept_bounds"};
static_assert(std::size(kMechanisms) == static_cast<std::size_t>(Switch::Count));

}  // namespace

std::uint64_t ablated_mechanisms() {
  const char* const text = std::getenv("PLUMB_ABLATE");
  std::uint64_t out = 0;
  for (std::string_view left = text == nullptr ? "" : text; !left.empty();) {
    const std::string_view name = left.substr(0, left.find(','));
    left.remove_prefix(std::min(name.size() + 1, left.size()));
    const auto found = std::find(std::begin(kMechanisms), std::end(kMechanisms), name);
    if (found == std::end(kMechanisms)) {
      std::fprintf(stderr,
                   "PLUMB_ABLATE: there is no mechanism '%.*s'; see engine/world/ablation/ablation.cpp\n",
                   static_cast<int>(name.size()), name.data());
      std::exit(2);
    }
    out |= std::uint64_t{1} << (found - std::begin(kMechanisms));
  }
  return out;
}

}  // namespace plumb

#endif
