#include "harness/hunt/promises.h"

#include <algorithm>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/hunt/processor_time.h"

namespace plumb::harness::hunt {
namespace {

// Number of steps that are compared: later steps cost as much and seldom find more.
constexpr int kMostSteps = 150;

/// Compares a World in a run mode with one in the plain mode, by all of its bits or by the visible ones.
Verdict compare(const Case& one, const Engine& engine, const char* name, const char* right,
                const std::vector<RunMode>& modes, bool whole = true) {
  Case part = one;
  part.steps = std::min(one.steps, kMostSteps);
  const Motion plain = run(engine, part, {.digests = true});
  if (!plain.failure.empty()) return {};
  const auto objection = [&](std::size_t k, double off, std::string what) {
    return Objection{.law = name,
                     .judge = name,
                     .what = std::move(what),
                     .right = right,
                     .figure = off,
                     .unit = "m",
                     .time = static_cast<double>(k) * one.dt};
  };
  for (const RunMode mode : modes) {
    const Motion other = run(engine, part, {.mode = mode, .digests = true});
    if (!other.failure.empty()) return objection(other.samples.size(), 0, other.failure);
    if (!other.broken_promise.empty()) return objection(other.samples.size() - 1, 0, other.broken_promise);
    const std::vector<double> off = apart(part, plain, other);
    const std::size_t count = std::min(plain.digests.size(), other.digests.size());
    for (std::size_t k = 0; k < count; ++k) {
      const bool same =
          whole ? plain.digests[k] == other.digests[k] : plain.digests[k].visible == other.digests[k].visible;
      if (same) continue;
      return objection(
          k + 1, off[k + 1],
          fmt::format("continues with other bits: {:.3g} m off after step {}", off[k + 1], k + 1));
    }
  }
  return {};
}

Verdict restored(const Case& one, const Engine& engine, const Motion&) {
  return compare(one, engine, "restore", "a world that is saved and restored continues with the same bits",
                 {RunMode::Restored});
}
Verdict rolled_back(const Case& one, const Engine& engine, const Motion&) {
  return compare(one, engine, "rollback", "a world that is rolled back continues with the same bits",
                 {RunMode::RolledBack});
}
Verdict threaded(const Case& one, const Engine& engine, const Motion&) {
  return compare(one, engine, "threads", "each number of threads gives the same bits", {RunMode::Threaded});
}
Verdict widths(const Case& one, const Engine& engine, const Motion&) {
  return compare(one, engine, "widths", "each vector width gives the same bits",
                 {RunMode::Scalar, RunMode::Narrow});
}
Verdict observed(const Case& one, const Engine& engine, const Motion&) {
  return compare(one, engine, "observed", "observing a world changes no bits", {RunMode::Observed});
}
Verdict asked(const Case& one, const Engine& engine, const Motion&) {
  return compare(one, engine, "queries",
                 "rays, casts, overlaps and distances agree with the shapes' outlines", {RunMode::Asked});
}
Verdict refused(const Case& one, const Engine& engine, const Motion&) {
  return compare(one, engine, "refused", "calls with numbers out of range are rejected and change nothing",
                 {RunMode::Refused});
}
Verdict labelled(const Case& one, const Engine& engine, const Motion&) {
  return compare(one, engine, "labels", "names, user data and hit events change nothing", {RunMode::Labelled},
                 false);
}
Verdict overrun(const Case& one, const Engine& engine, const Motion&) {
  return compare(one, engine, "overrun",
                 "a body beyond the world's limits is quarantined and reported, and the others continue",
                 {RunMode::Overrun});
}

bool is_world(const Case&, const Engine& engine) { return engine.is_world(); }
bool is_plumb(const Case&, const Engine& engine) { return engine.kind != Engine::Kind::Other; }
bool simulates(const Case& one, const Engine& engine) {
  return !one.world_only() && engine.kind != Engine::Kind::Other;
}
bool simulates_world(const Case& one, const Engine& engine) { return !one.world_only() && engine.is_world(); }

}  // namespace

std::string checked(const std::function<std::string()>& check) {
  try {
    return check();
  } catch (const Error&) {
    return {};
  }
}

std::string checked_apart(const std::function<std::string()>& check) {
  constexpr double kSeconds = 2;
  const Outcome outcome = isolate_within(kSeconds, [&] { return checked(check); });
  return outcome.kind == Outcome::Kind::Done ? outcome.text : std::string();
}

const std::vector<Relation>& promises() {
  static const std::vector<Relation> all{{"restore", is_world, restored},
                                         {"rollback", is_world, rolled_back},
                                         {"threads", is_world, threaded},
                                         {"widths", is_world, widths},
                                         {"observed", is_world, observed},
                                         {"queries", is_world, asked},
                                         {"refused", is_world, refused},
                                         {"labels", is_world, labelled},
                                         {"overrun", is_world, overrun},
                                         {"life", is_world, life},
                                         {"wind", is_world, wind},
                                         {"formulas", is_plumb, formulas},
                                         {"twins", is_world, twins},
                                         {"systems", is_plumb, systems},
                                         {"damaged", is_world, damaged},
                                         {"loops", is_world, loops},
                                         {"monitors", is_world, monitors},
                                         {"integrators", is_world, integrators},
                                         {"strikes", is_world, strikes},
                                         {"forces", on_precise, forces},
                                         {"derivatives", on_precise, derivatives},
                                         {"estimates", on_precise, estimates},
                                         {"starts", on_precise, starts},
                                         {"methods", on_precise, methods},
                                         {"blows", on_precise, blows},
                                         {"simulation_restore", simulates, simulation_restored},
                                         {"simulation_stages", simulates, simulation_stages},
                                         {"simulation_stop", simulates_world, simulation_stops},
                                         {"simulation_overrun", simulates_world, simulation_overrun}};
  return all;
}

}  // namespace plumb::harness::hunt
