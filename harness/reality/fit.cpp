#include "harness/reality/fit.h"

#include <algorithm>

namespace plumb::harness::reality {
namespace {

/// Relative spread of the simplex's losses below which it is done.
constexpr double kDone = 1e-7;

constexpr int kStarts = 4;

class Simplex {
 public:
  Simplex(std::span<const Parameter> parameters, int evaluations,
          const std::function<double(std::span<const double>)>& loss)
      : parameters_(parameters), left_(evaluations), loss_(loss) {}

  Fit search(const std::vector<double>& start, double scale) {
    std::vector<Fit> corners{evaluate(start)};
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      std::vector<double> corner = start;
      const double step = scale * parameters_[i].step;
      const bool inside = corner[i] + step <= parameters_[i].high && corner[i] + step >= parameters_[i].low;
      corner[i] += inside ? step : -step;
      corners.push_back(evaluate(corner));
    }
    const auto better = [](const Fit& a, const Fit& b) { return a.loss < b.loss; };
    for (;;) {
      std::stable_sort(corners.begin(), corners.end(), better);
      Fit& worst = corners.back();
      if (left_ <= 0 || worst.loss - corners[0].loss <= kDone * corners[0].loss) return corners[0];
      const Fit reflected = beyond(corners, 1);
      if (reflected.loss < corners[0].loss) {
        const Fit expanded = beyond(corners, 2);
        worst = better(expanded, reflected) ? expanded : reflected;
      } else if (reflected.loss < corners[corners.size() - 2].loss) {
        worst = reflected;
      } else {
        const Fit contracted = beyond(corners, reflected.loss < worst.loss ? 0.5 : -0.5);
        if (contracted.loss < std::min(reflected.loss, worst.loss)) {
          worst = contracted;
        } else {
          for (std::size_t i = 1; i < corners.size(); ++i) {
            for (std::size_t j = 0; j < parameters_.size(); ++j)
              corners[i].values[j] = (corners[i].values[j] + corners[0].values[j]) / 2;
            corners[i] = evaluate(corners[i].values);
          }
        }
      }
    }
  }

 private:
  /// Evaluates middle + factor (middle - worst), with the worst corner and the middle of the others.
  Fit beyond(const std::vector<Fit>& corners, double factor) {
    std::vector<double> point(parameters_.size());
    const double others = static_cast<double>(corners.size() - 1);
    for (std::size_t j = 0; j < point.size(); ++j) {
      double middle = 0;
      for (std::size_t i = 0; i + 1 < corners.size(); ++i) middle += corners[i].values[j] / others;
      point[j] = middle + factor * (middle - corners.back().values[j]);
    }
    return evaluate(std::move(point));
  }

  Fit evaluate(std::vector<double> point) {
    for (std::size_t j = 0; j < point.size(); ++j)
      point[j] = std::clamp(point[j], parameters_[j].low, parameters_[j].high);
    --left_;
    const double loss = loss_(point);
    return {std::move(point), loss};
  }

  std::span<const Parameter> parameters_;
  int left_;
  const std::function<double(std::span<const double>)>& loss_;
};

}  // namespace

Fit minimise(std::span<const Parameter> parameters, int evaluations,
             const std::function<double(std::span<const double>)>& loss) {
  std::vector<double> start;
  for (const Parameter& parameter : parameters) start.push_back(parameter.start);
  Fit best;
  for (int i = 0; i < kStarts; ++i) {
    // Each new simplex is smaller than the previous one, and points in the opposite direction.
    const double scale = (i % 2 == 0 ? 1.0 : -1.0) / (1 << (i / 2));
    const Fit found =
        Simplex(parameters, evaluations / kStarts, loss).search(i == 0 ? start : best.values, scale);
    if (i == 0 || found.loss < best.loss) best = found;
  }
  return best;
}

}  // namespace plumb::harness::reality
