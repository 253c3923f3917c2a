#include "scenarios/truth/rod_chain.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>

#include "scenarios/truth/parts.h"

namespace plumb::scenarios::truth {
namespace {

/// Solves an independent formulation (minimal coordinates, Lagrange) in extended precision. The solution is
/// kept while the program runs, because all engines are compared with it.
class ChainTruth {
 public:
  explicit ChainTruth(int count)
      : chain_(count, 1, kGravity),
        path_(
            Trajectory::State(2 * chain_.count(), 0),
            [this](const Trajectory::State& y, Trajectory::State& rate) { chain_.rates(y, rate); },
            1.0L / 480) {}
  ChainTruth(const ChainTruth&) = delete;
  ChainTruth& operator=(const ChainTruth&) = delete;

  void at(double time, std::span<BodyState> out) const {
    std::ranges::transform(chain_.motions(path_.at(time)), out.begin(), rounded);
  }

  static std::shared_ptr<const ChainTruth> of(int count) {
    static std::map<int, std::shared_ptr<const ChainTruth>> known;
    auto& truth = known[count];
    if (!truth) truth = std::make_shared<const ChainTruth>(count);
    return truth;
  }

 private:
  RodChain chain_;
  Trajectory path_;
};

}  // namespace

RodChain::RodChain(int count, Real length, Real gravity)
    : count_(static_cast<std::size_t>(count)), length_(length), gravity_(gravity) {}

void RodChain::rates(const State& state, State& rate) const {
  const std::size_t n = count_;
  rate.resize(2 * n);
  std::vector<Vec2<Real>> u(n);
  for (std::size_t i = 0; i < n; ++i) {
    u[i] = direction(state[i]);
    rate[i] = state[n + i];
  }
  const auto beyond = [n](std::size_t k) { return static_cast<Real>(n - k) - 0.5L; };  // n_k

  // The right-hand side; sin(t_i - t_j) = u_j x u_i. First the rods nearer to the pivot, then the others.
  std::vector<Real> b(n);
  Vec2<Real> nearer{}, farther{};
  for (std::size_t i = 0; i < n; ++i) {
    b[i] = -beyond(i) * (cross(nearer, u[i]) + gravity_ / length_ * u[i].x);
    nearer += state[n + i] * state[n + i] * u[i];
  }
  for (std::size_t i = n; i-- > 0;) {
    b[i] -= cross(farther, u[i]);
    farther += beyond(i) * state[n + i] * state[n + i] * u[i];
  }

  // M = L D L^T with L_ij = p_i . w_j, p_i = n_i u_i, for i > j. From M_ij = p_i . u_j follow
  // d_j = M_jj - p_j . S_j p_j and w_j = (u_j - S_j p_j)/d_j, where S_j = sum over k < j of d_k w_k w_k^T.
  // The same loop does the forward substitution: y_i = b_i - p_i . z_i, z_i = sum over j < i of w_j y_j.
  std::vector<Vec2<Real>> w(n);
  std::vector<Real> d(n), y(n);
  Real s_xx = 0, s_xy = 0, s_yy = 0;
  Vec2<Real> z{};
  for (std::size_t j = 0; j < n; ++j) {
    const Vec2<Real> p = beyond(j) * u[j];
    const Vec2<Real> sp{s_xx * p.x + s_xy * p.y, s_xy * p.x + s_yy * p.y};
    d[j] = beyond(j) - 1.0L / 6 - dot(p, sp);
    w[j] = 1 / d[j] * (u[j] - sp);
    s_xx += d[j] * w[j].x * w[j].x;
    s_xy += d[j] * w[j].x * w[j].y;
    s_yy += d[j] * w[j].y * w[j].y;
    y[j] = b[j] - dot(p, z);
    z += y[j] * w[j];
  }
  // Back substitution: a_j = y_j/d_j - w_j . v_j, v_j = sum over i > j of p_i a_i.
  Vec2<Real> v{};
  for (std::size_t j = n; j-- > 0;) {
    rate[n + j] = y[j] / d[j] - dot(w[j], v);
    v += rate[n + j] * beyond(j) * u[j];
  }
}

std::vector<Motion> RodChain::motions(const State& state) const {
  std::vector<Motion> motions;
  Motion joint;
  for (std::size_t i = 0; i < count_; ++i) {
    const Vec2<Real> half = length_ / 2 * direction(state[i]);
    const Vec2<Real> half_velocity = cross(state[count_ + i], half);
    motions.push_back({joint.position + half, state[i], joint.velocity + half_velocity, state[count_ + i]});
    joint.position += 2 * half;
    joint.velocity += 2 * half_velocity;
  }
  return motions;
}

Truth rod_chain_truth(int count) {
  return {.source = "Lagrange's equations in absolute angles, long double Runge-Kutta-Fehlberg 7(8)",
          .exact = [truth = ChainTruth::of(count)](double time,
                                                   std::span<BodyState> out) { truth->at(time, out); },
          .kind = TruthKind::Integrated};
}

double rod_chain_digits(int count) {
  if (count == 1) return 1e-9;
  if (count <= 5) return 1e-8;
  const double slope = count <= 20 ? std::log(100) / std::log(4) : std::log(10) / std::log(5);
  return 1e-6 * std::pow(count / 20.0, slope);
}

}  // namespace plumb::scenarios::truth
