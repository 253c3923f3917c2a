#pragma once

#include <limits>
#include <string>
#include <vector>

namespace plumb::course {

/// One figure of a check: what the engine gave, and what it should have given.
struct Reading {
  std::string what, unit;
  double measured = 0, expected = 0, tolerance = 0;

  bool good() const;
};

enum class Verdict {
  Pass,
  Fail,
  NotYet,  ///< the engine says that it does not do such scenes
  Broken,  ///< it crashed, hung, lied or lost a number on the way
};

/// What came of a check.
struct Finding {
  Verdict verdict = Verdict::Pass;
  std::vector<Reading> readings;
  std::string mistake;  ///< what gives such figures, by name: "explicit_euler"; empty where none is known
  std::string says;     ///< the diagnosis, the reason or the error, for people
};

/// In place of a figure that a mistake leaves open.
inline constexpr double kAny = std::numeric_limits<double>::quiet_NaN();

/// Holds readings against what they should be, and where they are off, against what known mistakes give. A
/// mistake is recognised when it explains every reading: within the reading's own tolerance, but no more than
/// a tenth of the way between right and wrong, and no less than 3 % of it. Of several the nearest is named.
class Judgement {
 public:
  Judgement& read(std::string what, std::string unit, double measured, double expected, double tolerance);

  /// `gives` has what each reading would be, in the order of `read`; `kAny` where it might be anything.
  Judgement& mistake(std::string name, std::vector<double> gives, std::string says);

  /// A mistake that shows in something else than the readings. It goes before those of figures.
  Judgement& mistake_if(bool seen, std::string name, std::string says);

  /// Likewise, where the figures fit none.
  Judgement& otherwise_if(bool seen, std::string name, std::string says);

  Finding finding() const;

 private:
  struct Mistake {
    std::string name, says;
    std::vector<double> gives;
  };

  double miss(const Mistake& mistake) const;

  std::vector<Reading> readings_;
  std::vector<Mistake> mistakes_;
  std::vector<Mistake> seen_, otherwise_;
};

}  // namespace plumb::course
