#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/hunt/finding.h"
#include "harness/hunt/idiom.h"
#include "harness/hunt/motion.h"

namespace plumb::harness::hunt {

struct HuntOptions {
  std::vector<const Idiom*> families{};  ///< structures to draw from; none: all
  std::vector<Engine> engines{};
  std::uint64_t seed = 1;
  double seconds = 60;       ///< of wall time; 0: no limit
  std::uint64_t scenes = 0;  ///< 0: as many as there is time for
  int jobs = 1;
  std::string folder = "hunt";
  int shrinks = 3;  ///< findings of one judge, engine and structure that are made smaller
};

/// Findings that show the same fault.
struct Kind {
  std::string name;  ///< judge, and what the smallest scene is made of
  std::vector<std::string> engines{};
  std::vector<std::string> idioms{};  ///< structures that showed it
  std::uint64_t first = 0;            ///< scenes drawn until it appeared
  std::uint64_t count = 0;            ///< findings
  Finding smallest{};
  std::string file{};  ///< of the smallest, in the folder
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

/// Draws scenes, runs and judges them, and makes smaller what fails. Goes on where an earlier run in the
/// folder stopped. Throws `Error` (Io), also where the folder holds a hunt of another seed, engines or
/// families.
Hunted hunt(const HuntOptions& options, const HuntEvents& events);

/// Writes the finding's case, its picture and how to replay it to `folder`/`name`.json and .svg.
void write_finding(const Finding& finding, const std::string& folder, const std::string& name);

/// The kinds as a table for people.
std::string kinds_text(const Hunted& hunted);
/// As a JSON list.
std::string kinds_json(const Hunted& hunted);

}  // namespace plumb::harness::hunt
