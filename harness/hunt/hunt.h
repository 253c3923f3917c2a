#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/hunt/case_seeds.h"
#include "harness/hunt/finding.h"
#include "harness/hunt/idiom.h"
#include "harness/hunt/motion.h"

namespace plumb::harness::hunt {

struct HuntOptions {
  std::vector<const Idiom*> families{};  ///< structures to draw from; empty: all, unless there are `cases`
  std::vector<CaseSeed> cases{};  ///< case files whose scenes are varied; with families, every second scene
  std::vector<Engine> engines{};
  std::uint64_t seed = 1;
  double seconds = 60;       ///< of wall time; 0: no limit
  std::uint64_t scenes = 0;  ///< 0: unlimited
  int jobs = 1;
  std::string folder = "hunt";
  int shrinks = 3;  ///< number of findings per judge, engine and structure that are shrunk
};

/// Findings that probably have one cause.
struct Kind {
  std::string name;  ///< judge, and the parts of the smallest scene
  std::vector<std::string> engines{};
  std::vector<std::string> idioms{};  ///< structures in which it appeared
  std::uint64_t first = 0;            ///< number of scenes drawn before it appeared
  std::uint64_t count = 0;            ///< number of findings
  Finding smallest{};
  std::string file{};  ///< file of the smallest scene, in the folder
};

struct Hunted {
  std::uint64_t scenes = 0, runs = 0, skipped = 0;
  std::vector<Kind> kinds{};  ///< in the order in which they appeared
  bool interrupted = false;
};

struct HuntEvents {
  std::function<void(std::uint64_t scenes, std::uint64_t findings, double seconds)> progress{};
  std::function<void(const Finding&)> found{};
};

/// Draws case `index` of a hunt, from its families and case files.
Case draw(const HuntOptions& options, std::uint64_t index);

/// Draws scenes, runs and judges them, and shrinks the failing ones. Resumes an earlier hunt in the folder.
/// Throws `Error` (Io), also if the hunt in the folder has another seed, engines or families.
Hunted hunt(const HuntOptions& options, const HuntEvents& events);

/// Writes the finding's case to `folder`/`name`.json, and its picture with the command that replays it to
/// .svg.
void write_finding(const Finding& finding, const std::string& folder, const std::string& name);

/// Formats the kinds as a table for people.
std::string kinds_text(const Hunted& hunted);
/// Formats the kinds as a JSON list.
std::string kinds_json(const Hunted& hunted);

}  // namespace plumb::harness::hunt
