#include "engine/solve/coulomb.h"

#include <algorithm>
#include <cmath>

#include "engine/solve/complementarity.h"

namespace plumb {
namespace {

/// The problem in scaled quantities, force = scale * scaled force, as a standard complementarity problem.
/// With tau = s - m its unknowns z are lambda, s and the negative part of b, and w are a, the positive part
/// of b and 2 m - s (Ch. Glocker, Set-Valued Force Laws, 2001, ch. 9, in the plane).
class Pivoting {
 public:
  explicit Pivoting(const CoulombProblem& problem)
      : problem_(problem), n_(problem.points()), size_(problem.size()), scale_(size_, 1.0) {
    for (std::size_t i = 0; i < size_; ++i) {
      const double own = problem.response[i * size_ + i];
      if (own > 0) scale_[i] = 1 / std::sqrt(own);
    }
    for (std::size_t p = 0; p < problem.patches.size(); ++p) {
      const std::size_t t = n_ + p;
      const bool may_stick = problem.patches[p].slip == 0 &&
                             (problem.patches[p].friction > 0 || problem.patches[p].bound > 0) &&
                             problem.response[t * size_ + t] > 0;
      place_.push_back(may_stick ? static_cast<int>(free_.size()) : -1);
      if (may_stick) free_.push_back(p);
    }
  }

  CoulombSolution solve() {
    assemble();
    const ComplementaritySolution found = solve_complementarity(matrix_, q_);
    CoulombSolution out;
    out.solved = found.status == ComplementaritySolution::Status::Solved;
    out.force.assign(size_, 0.0);
    out.rate = problem_.rate;
    out.pushes.assign(n_, 0);
    out.mode.assign(problem_.patches.size(), 0);
    out.ambiguous = ambiguous_;
    if (out.solved) take(found, out);
    return out;
  }

 private:
  double response(std::size_t i, std::size_t j) const {
    return scale_[i] * problem_.response[i * size_ + j] * scale_[j];
  }
  /// mu of a point in scaled forces.
  double cone(std::size_t point) const {
    const int p = problem_.patch_of[point];
    return problem_.patches[p].friction * scale_[point] / scale_[n_ + p];
  }
  /// The tangential force that comes with a unit normal force, before s.
  double drawn(std::size_t point) const {
    const int p = problem_.patch_of[point];
    if (place_[p] >= 0) return -cone(point);
    return -problem_.patches[p].slip * cone(point);
  }

  /// m0 in scaled forces, and the tangential force without any normal force, before s.
  double bound(std::size_t patch) const { return problem_.patches[patch].bound / scale_[n_ + patch]; }
  double set(std::size_t patch) const {
    return place_[patch] >= 0 ? -bound(patch) : -problem_.patches[patch].slip * bound(patch);
  }

  void assemble() {
    const std::size_t f = free_.size(), size = n_ + 2 * f;
    matrix_.assign(size * size, 0.0);
    q_.assign(size, 0.0);
    const auto fill = [&](std::size_t row, std::size_t of) {
      for (std::size_t j = 0; j < n_; ++j) {
        matrix_[row * size + j] = response(of, j) + drawn(j) * response(of, n_ + problem_.patch_of[j]);
      }
      for (std::size_t k = 0; k < f; ++k) matrix_[row * size + n_ + k] = response(of, n_ + free_[k]);
      q_[row] = scale_[of] * problem_.rate[of];
      for (std::size_t p = 0; p < place_.size(); ++p) q_[row] += set(p) * response(of, n_ + p);
    };
    for (std::size_t i = 0; i < n_; ++i) {
      fill(i, i);
      ambiguous_ =
          ambiguous_ || (problem_.patches[problem_.patch_of[i]].slip != 0 && matrix_[i * size + i] < 0);
    }
    for (std::size_t k = 0; k < f; ++k) {
      fill(n_ + k, n_ + free_[k]);
      matrix_[(n_ + k) * size + n_ + f + k] = 1;
      matrix_[(n_ + f + k) * size + n_ + k] = -1;
      q_[n_ + f + k] = 2 * bound(free_[k]);
      for (std::size_t j = 0; j < n_; ++j) {
        if (problem_.patch_of[j] == static_cast<int>(free_[k]))
          matrix_[(n_ + f + k) * size + j] = 2 * cone(j);
      }
    }
    // Wide cones: s is as large as they are. It is counted in units of them, and its row with it.
    wide_.assign(f, 1.0);
    for (std::size_t k = 0; k < f; ++k) {
      for (std::size_t j = 0; j < n_; ++j) {
        if (problem_.patch_of[j] == static_cast<int>(free_[k])) wide_[k] = std::max(wide_[k], cone(j));
      }
      for (const std::size_t at : {n_ + k, n_ + f + k}) {
        for (std::size_t i = 0; i < size; ++i) matrix_[i * size + at] *= wide_[k];
        for (std::size_t j = 0; j < size; ++j) matrix_[at * size + j] /= wide_[k];
        q_[at] /= wide_[k];
      }
    }
    for (const double x : q_) unit_ = std::max(unit_, std::abs(x));
    if (unit_ > 0) {
      for (double& x : q_) x /= unit_;
    }
  }

  void take(const ComplementaritySolution& found, CoulombSolution& out) const {
    const std::size_t f = free_.size();
    std::vector<double> scaled(size_, 0.0);
    for (std::size_t i = 0; i < n_; ++i) {
      scaled[i] = found.z[i];
      scaled[n_ + problem_.patch_of[i]] += drawn(i) * found.z[i];
      out.pushes[i] = found.basic[i];
    }
    for (std::size_t k = 0; k < f; ++k) scaled[n_ + free_[k]] += wide_[k] * found.z[n_ + k];
    for (std::size_t p = 0; unit_ > 0 && p < place_.size(); ++p) scaled[n_ + p] += set(p) / unit_;
    for (std::size_t i = 0; i < size_; ++i) out.force[i] = unit_ * scale_[i] * scaled[i];
    for (std::size_t p = 0; p < place_.size(); ++p) {
      out.mode[p] = problem_.patches[p].slip;
      if (place_[p] < 0) continue;
      const std::size_t s = n_ + static_cast<std::size_t>(place_[p]);
      out.mode[p] = found.basic[s + f] ? -1 : found.basic[s] ? 0 : 1;
    }
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j) out.rate[i] += problem_.response[i * size_ + j] * out.force[j];
    }
  }

  const CoulombProblem& problem_;
  std::size_t n_, size_;
  std::vector<double> scale_;
  std::vector<std::size_t> free_;  // patches that may stick
  std::vector<int> place_;         // by patch: its place among those, or -1
  std::vector<double> matrix_, q_, wide_;
  double unit_ = 0;
  bool ambiguous_ = false;
};

}  // namespace

CoulombSolution solve_coulomb(const CoulombProblem& problem) { return Pivoting(problem).solve(); }

}  // namespace plumb
