#include "engine/precise/events/coulomb.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "engine/linear_algebra/complementarity.h"

namespace plumb {
namespace {

/// The problem in scaled quantities, force = scale * scaled force, as a standard complementarity problem.
/// With tau = s - m its unknowns z are lambda, s and the negative part of b, and w are a, the positive part
/// of b and 2 m - s (Ch. Glocker, Set-Valued Force Laws, 2001, ch. 9, in the plane).
class Pivoting {
 public:
  explicit Pivoting(const CoulombProblem& problem)
      : problem_(problem), n_(problem.points()), size_(problem.size()), scale_(size_, 1.0) {
    assert(problem.response.size() == size_ * size_ && problem.rate.size() == size_);
    assert(std::all_of(problem.patch_of.begin(), problem.patch_of.end(), [&](int patch) {
      return patch >= 0 && patch < static_cast<int>(problem.patches.size());
    }));
    for (std::size_t i = 0; i < size_; ++i) {
      const double own = problem.response[i * size_ + i];
      if (own > 0) scale_[i] = 1 / std::sqrt(own);
    }
    for (std::size_t p = 0; p < problem.patches.size(); ++p) {
      const std::size_t t = n_ + p;
      const bool may_stick = problem.patches[p].slip_direction == 0 &&
                             (problem.patches[p].friction > 0 || problem.patches[p].bound > 0) &&
                             problem.response[t * size_ + t] > 0;
      sticking_index_.push_back(may_stick ? static_cast<int>(sticking_.size()) : -1);
      if (may_stick) sticking_.push_back(p);
    }
  }

  CoulombSolution solve() {
    assemble();
    const ComplementaritySolution found = solve_complementarity(matrix_, q_);
    CoulombSolution out = empty_solution();
    out.solved = found.status == ComplementaritySolution::Status::Solved;
    if (!out.solved && !sticking_.empty()) return solve_split();
    if (out.solved) take(found, out);
    return out;
  }

 private:
  double response(std::size_t i, std::size_t j) const {
    return scale_[i] * problem_.response[i * size_ + j] * scale_[j];
  }
  /// Returns mu of a point in scaled forces.
  double cone(std::size_t point) const {
    const int p = problem_.patch_of[point];
    return problem_.patches[p].friction * scale_[point] / scale_[n_ + p];
  }
  /// Returns the tangential force per unit normal force, at s = 0.
  double friction_ratio(std::size_t point) const {
    const int p = problem_.patch_of[point];
    if (sticking_index_[p] >= 0) return -cone(point);
    return -problem_.patches[p].slip_direction * cone(point);
  }

  /// Returns m0 in scaled forces. `fixed_force` returns the tangential force at zero normal force and s = 0.
  double bound(std::size_t patch) const { return problem_.patches[patch].bound / scale_[n_ + patch]; }
  double fixed_force(std::size_t patch) const {
    return sticking_index_[patch] >= 0 ? -bound(patch)
                                       : -problem_.patches[patch].slip_direction * bound(patch);
  }

  /// Solves the same problem with other unknowns: tau = p - m with parts p, m >= 0, and the slip's magnitude
  /// g (M. Anitescu, F. A. Potra, Nonlinear Dynamics 14, 1997). This has one more unknown per patch, but is
  /// copositive: Lemke's method reaches a solution if all patches may stick, for any width of the cone.
  CoulombSolution solve_split() {
    const std::size_t f = sticking_.size(), size = n_ + 3 * f;
    std::vector<double> matrix(size * size, 0.0), q(size, 0.0);
    const auto fill = [&](std::size_t row, std::size_t of, double sign) {
      for (std::size_t j = 0; j < n_; ++j) {
        const auto patch = static_cast<std::size_t>(problem_.patch_of[j]);
        const double own = sticking_index_[patch] >= 0 ? 0 : friction_ratio(j);
        matrix[row * size + j] = sign * (response(of, j) + own * response(of, n_ + patch));
      }
      for (std::size_t k = 0; k < f; ++k) {
        matrix[row * size + n_ + k] = sign * response(of, n_ + sticking_[k]);
        matrix[row * size + n_ + f + k] = -sign * response(of, n_ + sticking_[k]);
      }
      q[row] = scale_[of] * problem_.rate[of];
      for (std::size_t p = 0; p < sticking_index_.size(); ++p)
        q[row] += sticking_index_[p] < 0 ? fixed_force(p) * response(of, n_ + p) : 0;
      q[row] *= sign;
    };
    for (std::size_t i = 0; i < n_; ++i) fill(i, i, 1);
    for (std::size_t k = 0; k < f; ++k) {
      const std::size_t plus = n_ + k, minus = n_ + f + k, slip = n_ + 2 * f + k;
      fill(plus, n_ + sticking_[k], 1);
      fill(minus, n_ + sticking_[k], -1);
      matrix[plus * size + slip] = matrix[minus * size + slip] = 1;
      matrix[slip * size + plus] = matrix[slip * size + minus] = -1;
      q[slip] = bound(sticking_[k]);
      for (std::size_t j = 0; j < n_; ++j) {
        if (problem_.patch_of[j] == static_cast<int>(sticking_[k])) matrix[slip * size + j] = cone(j);
      }
    }
    unit_ = 0;
    for (const double x : q) unit_ = std::max(unit_, std::abs(x));
    for (double& x : q) x /= unit_;
    const ComplementaritySolution found = solve_complementarity(matrix, q);
    CoulombSolution out = empty_solution();
    out.solved = found.status == ComplementaritySolution::Status::Solved;
    if (!out.solved) return out;
    std::vector<double> scaled(size_, 0.0);
    for (std::size_t i = 0; i < n_; ++i) {
      const auto patch = static_cast<std::size_t>(problem_.patch_of[i]);
      scaled[i] = found.z[i];
      if (sticking_index_[patch] < 0) scaled[n_ + patch] += friction_ratio(i) * found.z[i];
      out.active[i] = found.basic[i];
    }
    for (std::size_t p = 0; p < sticking_index_.size(); ++p) {
      out.mode[p] = problem_.patches[p].slip_direction;
      if (sticking_index_[p] < 0) {
        scaled[n_ + p] += fixed_force(p) / unit_;
        continue;
      }
      const std::size_t k = static_cast<std::size_t>(sticking_index_[p]), slip = n_ + 2 * f + k;
      scaled[n_ + p] += found.z[n_ + k] - found.z[n_ + f + k];
      out.mode[p] = !(found.z[slip] > 0) ? 0 : scaled[n_ + p] > 0 ? -1 : 1;
    }
    finish(scaled, out);
    return out;
  }

  CoulombSolution empty_solution() const {
    CoulombSolution out;
    out.force.assign(size_, 0.0);
    out.rate = problem_.rate;
    out.active.assign(n_, 0);
    out.mode.assign(problem_.patches.size(), 0);
    out.ambiguous = ambiguous_;
    return out;
  }

  void finish(const std::vector<double>& scaled, CoulombSolution& out) const {
    for (std::size_t i = 0; i < size_; ++i) out.force[i] = unit_ * scale_[i] * scaled[i];
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j) out.rate[i] += problem_.response[i * size_ + j] * out.force[j];
    }
  }

  void assemble() {
    const std::size_t f = sticking_.size(), size = n_ + 2 * f;
    matrix_.assign(size * size, 0.0);
    q_.assign(size, 0.0);
    const auto fill = [&](std::size_t row, std::size_t of) {
      for (std::size_t j = 0; j < n_; ++j) {
        matrix_[row * size + j] =
            response(of, j) + friction_ratio(j) * response(of, n_ + problem_.patch_of[j]);
      }
      for (std::size_t k = 0; k < f; ++k) matrix_[row * size + n_ + k] = response(of, n_ + sticking_[k]);
      q_[row] = scale_[of] * problem_.rate[of];
      for (std::size_t p = 0; p < sticking_index_.size(); ++p)
        q_[row] += fixed_force(p) * response(of, n_ + p);
    };
    for (std::size_t i = 0; i < n_; ++i) {
      fill(i, i);
      ambiguous_ = ambiguous_ ||
                   (problem_.patches[problem_.patch_of[i]].slip_direction != 0 && matrix_[i * size + i] < 0);
    }
    for (std::size_t k = 0; k < f; ++k) {
      fill(n_ + k, n_ + sticking_[k]);
      matrix_[(n_ + k) * size + n_ + f + k] = 1;
      matrix_[(n_ + f + k) * size + n_ + k] = -1;
      q_[n_ + f + k] = 2 * bound(sticking_[k]);
      for (std::size_t j = 0; j < n_; ++j) {
        if (problem_.patch_of[j] == static_cast<int>(sticking_[k]))
          matrix_[(n_ + f + k) * size + j] = 2 * cone(j);
      }
    }
    // With wide cones s grows in proportion to their width: scale s and its row by it.
    width_.assign(f, 1.0);
    for (std::size_t k = 0; k < f; ++k) {
      for (std::size_t j = 0; j < n_; ++j) {
        if (problem_.patch_of[j] == static_cast<int>(sticking_[k])) width_[k] = std::max(width_[k], cone(j));
      }
      for (const std::size_t at : {n_ + k, n_ + f + k}) {
        for (std::size_t i = 0; i < size; ++i) matrix_[i * size + at] *= width_[k];
        for (std::size_t j = 0; j < size; ++j) matrix_[at * size + j] /= width_[k];
        q_[at] /= width_[k];
      }
    }
    for (const double x : q_) unit_ = std::max(unit_, std::abs(x));
    if (unit_ > 0) {
      for (double& x : q_) x /= unit_;
    }
  }

  void take(const ComplementaritySolution& found, CoulombSolution& out) const {
    const std::size_t f = sticking_.size();
    std::vector<double> scaled(size_, 0.0);
    for (std::size_t i = 0; i < n_; ++i) {
      scaled[i] = found.z[i];
      scaled[n_ + problem_.patch_of[i]] += friction_ratio(i) * found.z[i];
      out.active[i] = found.basic[i];
    }
    for (std::size_t k = 0; k < f; ++k) scaled[n_ + sticking_[k]] += width_[k] * found.z[n_ + k];
    for (std::size_t p = 0; unit_ > 0 && p < sticking_index_.size(); ++p)
      scaled[n_ + p] += fixed_force(p) / unit_;
    for (std::size_t p = 0; p < sticking_index_.size(); ++p) {
      out.mode[p] = problem_.patches[p].slip_direction;
      if (sticking_index_[p] < 0) continue;
      const std::size_t s = n_ + static_cast<std::size_t>(sticking_index_[p]);
      out.mode[p] = found.basic[s + f] ? -1 : found.basic[s] ? 0 : 1;
    }
    finish(scaled, out);
  }

  const CoulombProblem& problem_;
  std::size_t n_, size_;
  std::vector<double> scale_;
  std::vector<std::size_t> sticking_;  // patches that may stick
  std::vector<int> sticking_index_;    // by patch: its index among these, or -1
  std::vector<double> matrix_, q_, width_;
  double unit_ = 0;
  bool ambiguous_ = false;
};

}  // namespace

CoulombSolution solve_coulomb(const CoulombProblem& problem) { return Pivoting(problem).solve(); }

}  // namespace plumb
