#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "engine/integrate/bernstein.h"

namespace plumb {

/// The polynomial that a state follows over one step, in Newton's form about the start y0 of the step:
///   y(s) - y0 = sum over k of c_k times the product over j < k of (s - n_j),   k from 1, s from 0 to 1.
class StepPolynomial {
 public:
  static constexpr int kMaxTerms = 7;  // also the degree

  explicit StepPolynomial(std::size_t dimension = 0) : dimension_(dimension), terms_(kMaxTerms * dimension) {}

  std::size_t dimension() const { return dimension_; }
  int degree() const { return degree_; }

  /// Sets the degree and the nodes n_0 ... n_(degree - 1); n_0 is 0. The caller fills the terms.
  void set_nodes(std::span<const double> nodes) {
    degree_ = static_cast<int>(nodes.size());
    for (int k = 0; k < degree_; ++k) nodes_[k] = nodes[k];
  }
  std::span<const double> nodes() const { return {nodes_.data(), static_cast<std::size_t>(degree_)}; }

  /// c_k by component, k from 1 to the degree.
  std::span<double> term(int k) { return {terms_.data() + (k - 1) * dimension_, dimension_}; }
  std::span<const double> term(int k) const { return {terms_.data() + (k - 1) * dimension_, dimension_}; }

  /// Returns y(s) - y0 of component i.
  double at(double s, std::size_t i) const {
    double value = 0;
    for (int k = degree_; k >= 1; --k) value = (value + term(k)[i]) * (s - nodes_[k - 1]);
    return value;
  }

  /// Returns dy/ds of component i.
  double slope(double s, std::size_t i) const {
    double value = 0, slope = 0;
    for (int k = degree_; k >= 1; --k) {
      value += term(k)[i];
      slope = slope * (s - nodes_[k - 1]) + value;
      value *= s - nodes_[k - 1];
    }
    return slope;
  }

  /// Returns y(s) - y0 of component i as Bernstein coefficients over the whole step: it lies between the
  /// least and the largest of them.
  Bernstein<kMaxTerms + 1> bernstein(std::size_t i) const {
    Bernstein<kMaxTerms + 1> c{};
    int degree = 0;
    const auto times_factor = [&](double node) {  // c *= s - node, which raises the degree by one
      for (int j = degree + 1; j >= 0; --j) {
        const double own = j <= degree ? (degree + 1 - j) * -node * c[j] : 0;
        const double before = j > 0 ? j * (1 - node) * c[j - 1] : 0;
        c[j] = (own + before) / (degree + 1);
      }
      ++degree;
    };
    for (int k = degree_; k >= 1; --k) {
      for (int j = 0; j <= degree; ++j) c[j] += term(k)[i];
      times_factor(nodes_[k - 1]);
    }
    for (; degree < kMaxTerms; ++degree) {  // raises the degree of the same polynomial
      for (int j = degree + 1; j > 0; --j) {
        const double weight = static_cast<double>(j) / (degree + 1);
        c[j] = weight * c[j - 1] + (1 - weight) * (j <= degree ? c[j] : 0);
      }
    }
    return c;
  }

 private:
  std::size_t dimension_;
  int degree_ = 0;
  std::array<double, kMaxTerms> nodes_{};
  std::vector<double> terms_;  // term after term
};

}  // namespace plumb
