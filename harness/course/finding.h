#pragma once

#include <limits>
#include <string>
#include <vector>

namespace plumb::course {

/// One figure of a check: the engine's value and the expected one.
struct Reading {
  std::string what, unit;
  double measured = 0, expected = 0, tolerance = 0;

  bool good() const;
};

enum class Verdict {
  Pass,
  Fail,
  NotYet,  ///< the engine declares that it does not support such scenes
  Broken,  ///< the engine crashed, hung, or returned invalid or non-finite data
};

/// Result of a check.
struct Finding {
  Verdict verdict = Verdict::Pass;
  std::vector<Reading> readings;
  std::string mistake;    ///< name of a mistake with such figures: "explicit_euler"; empty if none is known
  std::string says;       ///< the diagnosis, the reason or the error, for people
  std::string symptom;    ///< another observed sign, which may have several causes; may be empty
  bool observed = false;  ///< `mistake` was recognised by an observation other than its figures
  bool proven = false;    ///< an experiment or a direct measurement excludes every other cause
  bool certain = false;   ///< `mistake` gives every wrong figure, within the tolerance of the right one
  bool exact = false;     ///< the motion of `mistake` was computed, and its figures are exactly the engine's
  bool computed = false;  ///< the motion of `mistake` was computed, and equals the engine's
  bool diverged =
      false;            ///< broken by numbers that grow without end; the motion until then may show the cause
  std::string follows;  ///< name of a mistake found in an earlier check that may also explain this failure
};

/// Returns a sentence about the first reading that is wrong, without a cause, and about other observations.
std::string describe(const Finding& finding);

/// Stands for a figure that a mistake leaves undetermined.
inline constexpr double kAny = std::numeric_limits<double>::quiet_NaN();

/// Compares readings with their expected values and, if they are wrong, with the figures of known mistakes. A
/// mistake matches if every reading is near the mistake's figure, within the reading's tolerance clamped to 3
/// % to 10 % of the distance between right and wrong. A mistake without figures for the wrong readings does
/// not match. Of several matches the nearest is named.
class Judgement {
 public:
  Judgement& read(std::string what, std::string unit, double measured, double expected, double tolerance);

  /// `gives` has the mistake's figure for each reading, in the order of `read`; `kAny` if undetermined.
  Judgement& mistake(std::string name, std::vector<double> gives, std::string says);

  /// Adds a mistake that evidence other than the readings proves: a direct measurement of its effect, or an
  /// experiment that no other cause explains. It takes precedence over all others.
  Judgement& proven_if(bool seen, std::string name, std::string says);

  /// Adds a mistake that evidence other than the readings suggests. It takes precedence over mistakes
  /// identified by figures, and is named only if the motion that it gives equals the engine's (prediction.h).
  Judgement& mistake_if(bool seen, std::string name, std::string says);

  /// Adds a mistake that evidence other than the readings proves. It is named only if nothing else matches.
  Judgement& otherwise_if(bool seen, std::string name, std::string says);

  /// Adds a symptom with several possible causes. If nothing else matches it is reported, and no mistake is
  /// named.
  Judgement& symptom_if(bool seen, std::string says);

  /// Returns true if every reading is within its tolerance.
  bool good() const;

  Finding finding() const;

 private:
  struct Mistake {
    std::string name, says;
    std::vector<double> gives;
    bool proven = false;
  };

  double miss(const Mistake& mistake) const;
  bool certain(const Mistake& mistake) const;

  std::vector<Reading> readings_;
  std::vector<Mistake> mistakes_;
  std::vector<Mistake> proven_, seen_, otherwise_, symptoms_;
};

}  // namespace plumb::course
