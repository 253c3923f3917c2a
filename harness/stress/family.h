#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/scene/scene.h"
#include "harness/stress/verdict.h"

/// Families of scenes along an axis towards an extreme, which show where an engine breaks.
namespace plumb::harness::stress {

/// Worst deviation of a run.
struct Finding {
  Verdict verdict = Verdict::Ok;
  std::string measure{};  ///< "deepest overlap"
  double figure = 0;
  std::string unit{};
  double bound = 0;      ///< of the figure, in the same unit
  std::string reason{};  ///< one sentence; empty if it is ok
};

/// Watches one run, and decides whether it was accurate enough to use.
class Judge {
 public:
  virtual ~Judge() = default;
  /// Returns false when it needs no further samples. States are finite. `time` in s since the start.
  virtual bool see(double time, std::span<const BodyState> states) = 0;
  virtual Finding finding() const = 0;
};

/// Computes the state of every body at a time, s.
using Motion = std::function<void(double time, std::span<BodyState> out)>;

/// A part of a run that is sampled evenly.
struct Stretch {
  int samples = 0;
  int every = 1;  ///< steps between two samples
};

/// One scene of a family.
struct Trial {
  Scene scene{};
  double dt = 1.0 / 60;  ///< s
  std::vector<Stretch> stretches{};
  std::function<std::unique_ptr<Judge>(const Scene& scene)> judge{};
  /// Exact motion, which no engine computed; empty if there is none.
  Motion exact{};
};

/// A family is one file in extremes/, which registers itself.
struct Family {
  std::string name{};
  std::string title{};  ///< "a heavy box on a light one"
  std::string axis{};   ///< "mass ratio"
  std::string unit{};   ///< unit of the axis; empty for plain numbers
  std::vector<double> values{};
  double usual = 1;     ///< the value in `values` that any engine with the features should survive
  std::string rule{};   ///< the bounds and their reasons, in one line
  double patience = 1;  ///< factor on the time limit of a cell
  std::function<Trial(double value)> build{};
};

/// Returns every family, sorted by name.
const std::vector<Family>& all();

/// Throws `Error` (Name) that suggests the nearest name.
const Family& find_family(std::string_view name);

/// Adds a family: `static const Register r{{.name = ..., .build = ...}};`
struct Register {
  explicit Register(Family family);
};

/// Spreads `steps` steps evenly over at most `samples` samples.
std::vector<Stretch> evenly(long steps, int samples);

}  // namespace plumb::harness::stress
