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

/// Quality of the fit of a mistake to a check.
struct Fit {
  std::string name, says;
  Planted planted;
  double off = 0;  ///< distance of the paths over the mistake's distance from the correct paths
  // Number of other checks of the chapter for which it predicts another verdict, or other readings.
  int verdicts = 0, readings = 0;
  double elsewhere = 0;       ///< largest `off` in the other failed checks
  bool generated = false;     ///< one of a family
  bool exact = false;         ///< its figures equal the engine's, and its paths fit as well
  bool refuted = false;       ///< it would clearly fail another check, which the tested engine passes
  bool contradicted = false;  ///< it changes the paths of a check in which the engine moves as a correct one
  int signs = 0;  ///< number of checks that detect a mistake in its motion, but not in the tested engine's
};

/// Runs each check at most once for each mistake.
class Predictions {
 public:
  Predictions(const Lab& lab, const std::vector<Outcome>& chapter);

  /// Returns nullopt if the check throws.
  const std::optional<Attempt>& of(const Planted& planted, std::size_t check);

  /// Does the same, but also returns nullopt if the paths are too far from the tested engine's for `near`.
  /// Stops such a run as soon as that is certain: for most mistakes, early in the first scene. With
  /// `exactly`, also returns nullopt if they are too far for `exactly` below.
  const std::optional<Attempt>& nearby(const Planted& planted, std::size_t check, bool exactly);

  /// Returns the fraction of an overlap that a step removes.
  double share(std::size_t manner) const { return manners_[manner].after_move ? 1 : manners_[manner].share; }

  double dt() const { return lab_.dt(); }

  /// Returns the number of steps that the learner's engine has taken so far. It measures the time of a search
  /// in the same way on every machine.
  long steps() const { return steps_; }

  std::size_t manners() const { return manners_.size(); }

  /// Returns the designs that fit the tested engine about as well as the best one, in the checks that it
  /// passes. First come those that give its paths in each of these checks in which some design does.
  const std::vector<std::size_t>& likely() const { return likely_; }

  /// Returns true if a correct engine of a likely design gives the tested engine's paths in all checks that
  /// it passes. A mistake must then give its paths in the checks that it fails.
  bool design_known() const { return known_; }

  /// Returns true if the tested engine's paths are those of a mistake, up to differences due to iterations.
  bool exactly(std::size_t check, std::size_t manner, const std::vector<Recorded>& wrong);

  /// Returns true if the learner's engine fails a check in the same way without a mistake, in a design: then
  /// the declared method or the design itself causes the motion, and no mistake has to explain it.
  bool fails_without_mistake(std::size_t check, std::size_t manner);

  /// Returns the property of the engine's design that spoils a check: a correct engine of that design fails
  /// it in the same way, and passes it with the course's value of the property.
  std::optional<Fit> cause_in_design(std::size_t check);

  /// Counts the other checks for which a mistake predicts another verdict, or other wrong readings.
  void refute(const Planted& planted, std::size_t check, Fit& fit);

  /// Returns true if the tested engine moves exactly as a correct one in a check that it passes, of this or
  /// an earlier chapter, and the mistake would change the paths there.
  bool contradicts(const Planted& planted, const Outcome& passed);

  /// Returns the distance of the tested engine's paths from those of a mistake, divided by the distance of
  /// the mistake's paths from the correct ones. Returns 0 if only velocities are wrong: then only readings
  /// decide.
  double off(std::size_t check, std::size_t manner, const std::vector<Recorded>& wrong);

  /// Returns true if the tested engine's paths equal those of a mistake. If its figures are exactly equal,
  /// paths may differ by more: by the differences between correct engines, and by the correction of overlaps
  /// that only the mistake causes.
  bool near(std::size_t check, std::size_t manner, const Attempt& wrong);

  /// Selects among several mistakes by further scenes (experiments.h): keeps those that give exactly the
  /// tested engine's paths there, if in some scene only some of the mistakes do. Without contacts and joints,
  /// engines of every design move in the same way, so a mistake that gives another motion there is always
  /// dropped.
  void tell_apart(std::vector<Fit>& found);

  /// Returns the factor with which the learner's engine is nearest to the tested engine's paths; nullopt if
  /// it is not near with any factor.
  std::optional<double> factor(const std::string& quantity, std::size_t manner, std::size_t check);

 private:
  bool screened_out(const Planted& planted, std::size_t check, double limit);
  const std::optional<Recorded>& seen_in(std::size_t experiment);
  std::optional<double> far_in(std::size_t experiment, const Planted& planted);
  bool sees_another(std::size_t check, const Finding& predicted) const;
  double spread(std::size_t check);
  double farthest(std::size_t check, std::size_t manner);
  double exact_limit(std::size_t check, std::size_t manner);
  std::vector<std::vector<double>> misfits();
  std::optional<Attempt> attempt(const Planted& planted, std::size_t check, Lab::Watcher watcher);
  std::optional<Attempt> attempt(const Planted& planted, const Check& check, Lab::Watcher watcher);
  std::optional<Attempt> attempt(const std::string& mistake, const Manner& manner, const Check& check,
                                 Lab::Watcher watcher);
  std::optional<Fit> cause_in(const Manner& own, std::size_t check);
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
  std::map<std::pair<std::size_t, std::string>, std::optional<Attempt>> right_earlier_;
  std::set<std::pair<Planted, std::size_t>> too_far_;
  std::map<std::size_t, double> spreads_;
  std::map<std::pair<std::size_t, std::size_t>, double> farthest_, exact_limits_;  ///< by check and manner
};

}  // namespace plumb::course
