#include "scenarios/truth/bob_chain.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "scenarios/truth/set_up.h"

namespace plumb::scenarios::truth {

Scene BobChain::scene(Scene scene) const {
  Vec2d end{};
  for (std::size_t i = 0; i < masses.size(); ++i) {
    end += set_up::turned(angles[i], {0, -1});
    const std::string name = "bob" + std::to_string(i);
    const std::string above = i == 0 ? std::string(kWorld) : scene.bodies.back().name;
    scene.joints.push_back(
        DistanceJoint{.name = "rod" + std::to_string(i), .body_a = above, .body_b = name, .length = 1});
    scene.bodies.push_back(piece(name, end, untouchable(Circle{0.1}), masses[i]));
  }
  return scene;
}

void BobChain::rates(const Trajectory::State& state, Trajectory::State& rate) const {
  const std::size_t n = masses.size();
  std::vector<Real> below(n, masses.back());
  for (std::size_t i = n - 1; i-- > 0;) below[i] = below[i + 1] + masses[i];
  rate.resize(2 * n);
  std::vector<std::vector<Real>> l(n, std::vector<Real>(n));  // M = L L^T, in place
  std::vector<Real> b(n);
  for (std::size_t i = 0; i < n; ++i) {
    rate[i] = state[n + i];
    b[i] = -kGravity * below[i] * std::sin(state[i]);
    for (std::size_t j = 0; j < n; ++j)
      b[i] -= below[std::max(i, j)] * std::sin(state[i] - state[j]) * state[n + j] * state[n + j];
    for (std::size_t j = 0; j <= i; ++j) {
      Real sum = below[i] * std::cos(state[i] - state[j]);
      for (std::size_t k = 0; k < j; ++k) sum -= l[i][k] * l[j][k];
      l[i][j] = i == j ? std::sqrt(sum) : sum / l[j][j];
    }
    for (std::size_t k = 0; k < i; ++k) b[i] -= l[i][k] * b[k];
    b[i] /= l[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= l[k][i] * rate[n + k];
    rate[n + i] = b[i] / l[i][i];
  }
}

Truth BobChain::truth(const Scene& scene) const {
  Trajectory::State start(angles.begin(), angles.end());
  start.resize(2 * angles.size());
  const auto law = [chain = *this](const Trajectory::State& y, Trajectory::State& rate) {
    chain.rates(y, rate);
  };
  const auto path = std::make_shared<const Trajectory>(start, law, 1.0L / 240);
  return integrated(follow(scene,
                           "Lagrange's equations in absolute angles, long double Runge-Kutta-Fehlberg 7(8)",
                           [path](Real time, Moving moving) {
                             const Trajectory::State y = path->at(time);
                             Motion end;
                             for (std::size_t i = 0; i < moving.size(); ++i) {
                               const Vec2<Real> rod = turned(y[i], {0, -1});
                               end.position += rod;
                               end.velocity += cross(y[moving.size() + i], rod);
                               moving[i] = end;
                             }
                           }));
}

double laguerre(int n, double x) {
  double before = 1, now = 1 - x;
  if (n == 0) return before;
  for (int k = 1; k < n; ++k) {
    const double next = ((2 * k + 1 - x) * now - k * before) / (k + 1);
    before = now;
    now = next;
  }
  return now;
}

double smallest_laguerre_zero(int n) {
  double x = 0;  // L_n falls and is convex from here to its first zero; x L_n' = n (L_n - L_(n-1))
  for (int i = 0; i < 100; ++i) {
    const double value = laguerre(n, x);
    const double slope = x == 0 ? -n : n * (value - laguerre(n - 1, x)) / x;
    x -= value / slope;
  }
  return x;
}

}  // namespace plumb::scenarios::truth
