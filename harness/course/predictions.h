#pragma once

#include <compare>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "harness/course/course.h"
#include "harness/course/experiments.h"
#include "harness/course/student/student.h"

/// Runs the checks of a chapter on the learner's engine (student/student.h) with a mistake.
namespace plumb::course {

struct Attempt {
  Finding finding;
  std::vector<Recorded> runs;
};

/// A mistake as the learner's engine makes it, in one of the engine's design variants.
struct Planted {
  std::string mistake;
  std::size_t manner = 0;

  auto operator<=>(const Planted&) const = default;
};

/// How well a mistake fits a check.
struct Fit {
  std::string name, says;
  Planted planted;
  double off = 0;  ///< ratio of the paths' distance to the mistake's distance from the correct paths
  // Other checks of the chapter in which it predicts another verdict, and those in which other readings.
  int verdicts = 0, readings = 0;
  double elsewhere = 0;    ///< largest `off` of the other checks that fail
  bool generated = false;  ///< one of a family
  bool exact = false;      ///< its figures equal the engine's, and its paths fit as well
  bool refuted = false;    ///< another check, which the engine passes, would clearly fail
  int signs = 0;           ///< number of checks that detect a mistake in its motion, but not in the engine's
};

/// Runs each check at most once for each mistake.
class Predictions {
 public:
  Predictions(const Lab& lab, const std::vector<Outcome>& chapter);

  /// Returns nullopt if the check throws.
  const std::optional<Attempt>& of(const Planted& planted, std::size_t check);

  /// Also returns nullopt if the paths are too far from the engine's for `near`. Such a run ends as soon as
  /// that is certain, which for most mistakes is early in the first scene.
  /// `exactly`: also if they are too far for `exactly` below.
  const std::optional<Attempt>& nearby(const Planted& planted, std::size_t check, bool exactly);

  /// Returns the fraction of an overlap that a step removes.
  double share(std::size_t manner) const { return manners_[manner].after_move ? 1 : manners_[manner].share; }

  double dt() const { return lab_.dt(); }

  /// Returns the number of steps that the learner's engine has taken so far: it measures the time of a search
  /// alike on every machine.
  long steps() const { return steps_; }

  std::size_t manners() const { return manners_.size(); }

  /// Returns the designs that are not clearly farther than another from the engine, in the checks that it
  /// passes.
  const std::vector<std::size_t>& likely() const { return likely_; }

  /// Returns true if a correct engine of a likely design gives the engine's paths in all checks that it
  /// passes. A mistake must then give its paths in those that it fails.
  bool design_known() const { return known_; }

  /// Returns true if the engine's paths are those of a mistake, but for what iterations leave.
  bool exactly(std::size_t check, std::size_t manner, const std::vector<Recorded>& wrong);

  /// Counts the other checks of which a mistake predicts another verdict, or other wrong readings.
  void refute(const Planted& planted, std::size_t check, Fit& fit);

  /// Returns the distance of the engine's paths from those of a mistake, divided by the distance of the
  /// mistake's from the correct ones. If only velocities are wrong it is 0: only readings decide then.
  double off(std::size_t check, std::size_t manner, const std::vector<Recorded>& wrong);

  /// Returns true if the engine's paths equal those of a mistake. If its figures are exactly equal, paths may
  /// differ by more: by the differences between correct engines, and by the correction of overlaps that only
  /// the mistake causes.
  bool near(std::size_t check, std::size_t manner, const Attempt& wrong);

  /// Keeps those of several mistakes that give the engine's very paths in further scenes as well
  /// (experiments.h), if any do in a scene in which others do not. Where bodies meet nothing, engines of
  /// every design move alike: a mistake that gives another motion there is dropped in any case.
  void tell_apart(std::vector<Fit>& found);

  /// Returns the factor that brings the learner's engine nearest to the engine's paths, or nullopt if no
  /// factor brings it near.
  std::optional<double> factor(const std::string& quantity, std::size_t manner, std::size_t check);

 private:
  bool screened_out(const Planted& planted, std::size_t check, double limit);
  const std::optional<Recorded>& seen_in(std::size_t experiment);
  std::optional<double> far_in(std::size_t experiment, const Planted& planted);
  bool sees_another(std::size_t check, const Finding& predicted) const;
  double spread(std::size_t check);
  double farthest(std::size_t check, std::size_t manner);
  double exact_limit(std::size_t check, std::size_t manner);
  double misfit(std::size_t manner);
  std::optional<Attempt> attempt(const Planted& planted, std::size_t check, Lab::Watcher watcher);
  std::optional<Attempt> within(const Planted& planted, std::size_t check, double limit);

  const Lab& lab_;
  const std::vector<Outcome>& chapter_;
  std::vector<std::string> seen_;  ///< the mistakes that the checks themselves detected
  std::vector<Manner> manners_;
  std::vector<std::size_t> likely_;
  bool known_ = false;
  long steps_ = 0;
  std::vector<Experiment> experiments_;
  std::map<std::size_t, std::optional<Recorded>> seen_in_;  ///< the engine's runs of the experiments
  // The first run whose paths leave the correct ones by a limit, and the number of states until they do, by
  // check, manner and limit.
  std::map<std::tuple<std::size_t, std::size_t, double>, std::optional<std::pair<std::size_t, std::size_t>>>
      screens_;
  std::map<std::pair<Planted, std::size_t>, std::optional<Attempt>> attempts_;
  std::set<std::pair<Planted, std::size_t>> too_far_;
  std::map<std::size_t, double> spreads_;
  std::map<std::pair<std::size_t, std::size_t>, double> farthest_, exact_limits_;  ///< by check and manner
};

}  // namespace plumb::course
