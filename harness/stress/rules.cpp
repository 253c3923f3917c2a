#include "harness/stress/rules.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "harness/energy.h"
#include "harness/joint_gap.h"
#include "harness/penetration.h"
#include "harness/style.h"

namespace plumb::harness::stress {
namespace {

constexpr double kSane = 10;  // limit of Inaccurate, in units of the bound

double norm(Vec2d v) { return std::hypot(v.x, v.y); }

double of(const Mechanics& mechanics) { return mechanics.kinetic + mechanics.potential; }

std::vector<BodyState> start_of(const Scene& scene) {
  std::vector<BodyState> out;
  for (const Body& body : scene.bodies) out.push_back(initial_state(body));
  return out;
}

double start_energy(const Scene& scene) { return of(mechanics(scene, start_of(scene))); }

double ratio(const Rule& rule, double figure) {
  return figure <= 0 ? 0 : figure / std::max(rule.bound, std::numeric_limits<double>::min());
}

class RuleJudge final : public Judge {
 public:
  explicit RuleJudge(std::vector<Rule> rules) : rules_(std::move(rules)), worst_(rules_.size(), 0.0) {}

  bool see(double time, std::span<const BodyState> states) override {
    bool on = true;
    for (std::size_t i = 0; i < rules_.size(); ++i) {
      const double figure = rules_[i].figure(time, states);
      if (!(figure <= worst_[i])) worst_[i] = figure;
      on = on && grade(rules_[i], worst_[i]) != Verdict::Explodes;
    }
    return on;
  }

  Finding finding() const override {
    std::size_t worst = 0;
    const auto rank = [&](std::size_t i) {
      return std::pair(grade(rules_[i], worst_[i]), ratio(rules_[i], worst_[i]));
    };
    for (std::size_t i = 1; i < rules_.size(); ++i)
      if (rank(worst) < rank(i)) worst = i;
    const Rule& rule = rules_[worst];
    Finding out{rank(worst).first, rule.measure, worst_[worst], rule.unit, rule.bound, ""};
    if (out.verdict != Verdict::Ok)
      out.reason = fmt::format("{} is {}{}, limit {}{}", rule.measure, harness::figure(out.figure),
                               rule.unit.empty() ? "" : " " + rule.unit, harness::figure(rule.bound),
                               rule.unit.empty() ? "" : " " + rule.unit);
    return out;
  }

 private:
  std::vector<Rule> rules_;
  std::vector<double> worst_;
};

}  // namespace

Verdict grade(const Rule& rule, double figure) {
  if (std::isnan(figure)) return Verdict::Explodes;  // finite states whose squares overflow
  if (figure <= rule.bound) return Verdict::Ok;
  if (figure >= rule.explodes) return Verdict::Explodes;
  return figure <= (std::isnan(rule.sane) ? kSane * rule.bound : rule.sane) ? Verdict::Inaccurate
                                                                            : rule.beyond;
}

std::unique_ptr<Judge> judge_by(std::vector<Rule> rules) {
  return std::make_unique<RuleJudge>(std::move(rules));
}

Rule deepest_overlap(const Scene& scene, double bound) {
  Rule rule{.measure = "deepest overlap", .unit = "m", .bound = bound, .beyond = Verdict::Sinks};
  rule.figure = [meter = std::make_shared<PenetrationMeter>(scene)](
                    double, std::span<const BodyState> states) { return meter->deepest(states); };
  return rule;
}

Rule farthest_from_start(const Scene& scene, double bound, double explodes) {
  Rule rule{.measure = "displacement from the start", .unit = "m", .bound = bound, .explodes = explodes};
  rule.figure = [start = start_of(scene)](double, std::span<const BodyState> states) {
    double out = 0;
    for (std::size_t i = 0; i < states.size(); ++i)
      out = std::max(out, norm(states[i].position - start[i].position));
    return out;
  };
  return rule;
}

Rule sum_of_gaps(const Scene& scene, double bound, double explodes) {
  Rule rule{.measure = "sum of the joint gaps",
            .unit = "m",
            .bound = bound,
            .beyond = Verdict::Stretches,
            .explodes = explodes};
  rule.figure = [gaps = JointGaps(scene)](double, std::span<const BodyState> states) {
    double out = 0;
    for (std::size_t i = 0; i < gaps.size(); ++i) out += gaps.gap(i, states);
    return out;
  };
  return rule;
}

Rule energy_gained(const Scene& scene, double scale, double bound) {
  Rule rule{.measure = "relative energy gain", .bound = bound, .explodes = 10};
  rule.figure = [&scene, scale, start = start_energy(scene)](double, std::span<const BodyState> states) {
    return (of(mechanics(scene, states)) - start) / scale;
  };
  return rule;
}

Rule energy_lost(const Scene& scene, double scale, double bound) {
  Rule rule{.measure = "relative energy loss", .bound = bound, .beyond = Verdict::Freezes};
  rule.figure = [&scene, scale, start = start_energy(scene)](double, std::span<const BodyState> states) {
    return (start - of(mechanics(scene, states))) / scale;
  };
  return rule;
}

Rule off_the_path(const Scene& scene, const Motion& exact, double bound, double explodes) {
  Rule rule{.measure = "position error", .unit = "m", .bound = bound, .explodes = explodes};
  rule.figure = [exact, right = start_of(scene)](double time, std::span<const BodyState> states) mutable {
    exact(time, right);
    double out = 0;
    for (std::size_t i = 0; i < states.size(); ++i)
      out = std::max(out, norm(states[i].position - right[i].position));
    return out;
  };
  return rule;
}

Rule path_not_covered(const Scene& scene, const Motion& exact, double least) {
  struct Path {
    std::vector<BodyState> right;
    Vec2d last_right, last;
    double made = 0, exact = 0;
  };
  Path path{start_of(scene), {}, {}};
  path.last_right = path.last = path.right.front().position;
  Rule rule{
      .measure = "fraction of the path not covered", .bound = 0.5, .beyond = Verdict::Freezes, .sane = 0.5};
  rule.figure = [exact, least, path](double time, std::span<const BodyState> states) mutable {
    exact(time, path.right);
    path.made += norm(states.front().position - path.last);
    path.exact += norm(path.right.front().position - path.last_right);
    path.last = states.front().position;
    path.last_right = path.right.front().position;
    return path.exact < least ? 0 : 1 - path.made / path.exact;
  };
  return rule;
}

Rule wrong_angular_velocity(std::size_t body, double rate, double bound) {
  Rule rule{.measure = "relative error of the angular velocity",
            .bound = bound,
            .beyond = Verdict::Freezes,
            .explodes = 10};
  rule.figure = [=](double, std::span<const BodyState> states) {
    return std::abs(states[body].angular_velocity - rate) / std::abs(rate);
  };
  return rule;
}

}  // namespace plumb::harness::stress
