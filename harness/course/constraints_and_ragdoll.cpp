// Chapter 5: sticks, hinges, chains and a ragdoll.
#include "harness/course/course.h"
#include "harness/course/hinge_checks.h"
#include "harness/course/ragdoll_checks.h"
#include "harness/course/stick_checks.h"

namespace plumb::course {
namespace {

constexpr const char* kSticks = "\"joints\":[\"distance\"]";
constexpr const char* kHinges = "\"shapes\":[\"circle\",\"box\"] and \"joints\":[\"revolute\"]";
constexpr const char* kChain = "\"joints\":[\"distance\"] and \"features\":[\"contacts\"]";
constexpr const char* kRagdoll =
    "\"shapes\":[\"circle\",\"box\"], \"joints\":[\"revolute\"] and \"features\":[\"contacts\"]";

}  // namespace

Chapter constraints_and_ragdoll() {
  return {
      .number = 5,
      .title = "Constraints and a ragdoll",
      .page = "5-constraints-and-ragdoll.md",
      .checks = {{"stick_keeps_its_length", "two circles on a stick keep their distance", kSticks,
                  stick_keeps_its_length},
                 {"stick_weighs_masses", "a stick moves the light end more", kSticks, stick_weighs_masses},
                 {"pendulum", "a pendulum keeps its period and its swing", kSticks, pendulum},
                 {"hinged_rod", "a rod on a hinge swings as a rod", kHinges, hinged_rod},
                 {"hinge_turns_both", "a hinge turns both of its rods", kHinges, hinge_turns_both},
                 {"chain_swings", "a chain swings like a rope", kChain, chain_swings, false},
                 {"ragdoll_flies", "a ragdoll in the air falls as one", kRagdoll, ragdoll_flies, false},
                 {"ragdoll_drops", "it lands, holds together and settles", kRagdoll, ragdoll_drops, false}}};
}

}  // namespace plumb::course
