#include "bench/field/measure.h"

#include <algorithm>
#include <memory>
#include <stdexcept>

#include <fmt/format.h>

#include "bench/field/heap.h"
#include "bench/field/parcel.h"
#include "harness/isolate.h"

namespace plumb::field {
namespace {

constexpr int kSamples = 10;  // quality samples per run
constexpr int kLarge = 1000;  // number of bodies from which on the cost of reading the clock is negligible

/// Thrown if a run takes too long; `what()` says how far it got.
struct TooSlow : std::runtime_error {
  using std::runtime_error::runtime_error;
};

double wall_seconds() { return seconds_of(CLOCK_MONOTONIC); }
double cpu_seconds() { return seconds_of(CLOCK_PROCESS_CPUTIME_ID); }

/// A world with one scene.
class Run {
 public:
  Run(const Scene& scene, const Engine& engine, const Plan& plan)
      : limit_(plan.limit),
        settings_(settings_of(scene, engine, plan)),
        world_(engine.create(settings_)),
        builder_(*world_, plan.clock) {
    built_ = scene.build(builder_, plan.quick);
    for (const Top& top : built_.tops) heights_.push_back(height_of(top));
    advance(scene.warm_up);
    world_->restart_profile();
  }

  /// Measures the mean time of `steps` steps; calls `sample` after each tenth of them.
  template <class Sample>
  void timed(int steps, const Sample& sample, Measurement& out) {
    const double start = builder_.cost().seconds, wall_start = wall_seconds(), cpu_start = cpu_seconds();
    std::int64_t allocations = 0;
    int counted = 0, done = 0;
    for (int i = 1; i <= kSamples; ++i) {
      const int until = static_cast<int>(static_cast<std::int64_t>(steps) * i / kSamples);
      const std::int64_t before = builder_.cost().allocations;
      advance(until - done);
      if (2 * i > kSamples) {
        allocations += builder_.cost().allocations - before;
        counted += until - done;
      }
      done = until;
      sample();
    }
    allocations_a_step_ = counted == 0 ? 0 : static_cast<double>(allocations) / counted;
    out.step_seconds.push_back((builder_.cost().seconds - start) / steps);
    out.cpu_share.push_back((cpu_seconds() - cpu_start) / (wall_seconds() - wall_start));
  }

  void describe(Measurement& out) {
    out.settings = world_->settings();
    out.counted = world_->counts();
    out.asked = builder_.inventory().counts();
    out.continuous = settings_.continuous;
    out.allocations_a_step = allocations_a_step_;
    out.stages = world_->profile();
    const int bodies = out.asked.bodies;
    if (heap::counted() && bodies > 0) out.bytes_a_body = static_cast<double>(builder_.cost().bytes) / bodies;
    if (!built_.tops.empty()) out.height = least_height();
    out.escaped = escaped();
    const std::vector<BodyState> before = builder_.states();
    builder_.step();
    out.speed = measure_speed(builder_.inventory(), before, builder_.states(), settings_.dt);
  }

  Quality quality() const { return measure_quality(builder_.inventory(), builder_.states()); }

 private:
  static WorldSettings settings_of(const Scene& scene, const Engine& engine, const Plan& plan) {
    WorldSettings out = plan.settings;
    out.solver = engine.solver;
    out.threads = engine.threads;
    out.gravity = scene.gravity;
    out.continuous = plan.continuous.value_or(scene.continuous);
    return out;
  }

  void advance(int steps) {
    const bool one_by_one = built_.before_step || builder_.inventory().bodies.size() >= kLarge;
    while (steps > 0) {
      const int now = one_by_one ? 1 : steps;
      if (built_.before_step) built_.before_step(builder_, taken_);
      builder_.step(now);
      taken_ += now;
      steps -= now;
      const double seconds = builder_.cost().seconds;
      if (seconds > limit_)
        throw TooSlow(fmt::format("stopped after {} steps in {:.3g} s: {:.3g} ms per step", taken_, seconds,
                                  1e3 * seconds / taken_));
    }
  }

  double height_of(const Top& top) const {
    return world_->state(builder_.inventory().bodies[top.body].handle).position.y - top.ground;
  }

  double least_height() const {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < heights_.size(); ++i)
      least = std::min(least, height_of(built_.tops[i]) / heights_[i]);
    return least;
  }

  int escaped() const {
    if (!built_.region) return 0;
    int out = 0;
    const std::vector<BodyState> states = builder_.states();
    for (std::size_t i = 0; i < states.size(); ++i) {
      const Vec2d p = states[i].position;
      const bool inside = p.x >= built_.region->low.x && p.x <= built_.region->high.x &&
                          p.y >= built_.region->low.y && p.y <= built_.region->high.y;
      out += builder_.inventory().bodies[i].alive && !inside;
    }
    return out;
  }

  double limit_;  // s
  WorldSettings settings_;
  std::unique_ptr<FieldWorld> world_;
  Builder builder_;
  Built built_;
  std::vector<double> heights_;
  double allocations_a_step_ = 0;
  int taken_ = 0;  // steps
};

/// Statistics of depths and joint gaps: the worst of all samples, and the means over them. Other figures are
/// those of the last sample.
class Samples {
 public:
  void add(const Quality& sample) {
    finite_ = finite_ && sample.finite;
    deepest_ = std::max(deepest_, sample.deepest);
    depths_ += sample.mean_depth * sample.overlapping;
    overlapping_ += sample.overlapping;
    worst_joint_ = std::max(worst_joint_, sample.worst_joint);
    joints_ += sample.mean_joint;
    worst_limit_ = std::max(worst_limit_, sample.worst_limit);
    ++count_;
    last_ = sample;
  }

  Quality summary() const {
    Quality out = last_;
    out.finite = finite_;
    out.deepest = deepest_;
    out.mean_depth = overlapping_ == 0 ? 0 : depths_ / overlapping_;
    out.worst_joint = worst_joint_;
    out.mean_joint = count_ == 0 ? 0 : joints_ / count_;
    out.worst_limit = worst_limit_;
    return out;
  }

 private:
  bool finite_ = true;
  double deepest_ = 0, depths_ = 0, worst_joint_ = 0, joints_ = 0, worst_limit_ = 0;
  int overlapping_ = 0, count_ = 0;
  Quality last_;
};

/// Makes one run in this process. Stores its time in `out`, and the other figures of the first run.
void run_here(const Plan& plan, bool first, Measurement& out) {
  Run run(*out.scene, *out.engine, plan);
  if (!first) {
    run.timed(
        out.steps, [] {}, out);
    return;
  }
  Samples samples;
  run.timed(
      out.steps, [&] { samples.add(run.quality()); }, out);
  out.quality = samples.summary();
  if (out.quality.finite) {
    run.describe(out);
  } else {
    out.failure = "a pose or a velocity is not finite";
  }
}

/// Makes one run in a process of its own, so that every engine starts from the same heap and a crash ends no
/// other run. Returns false after an interrupt.
bool run_apart(const Plan& plan, bool first, Measurement& out) {
  const auto work = [&] {
    Measurement found = out;
    found.step_seconds.clear();
    found.cpu_share.clear();
    run_here(plan, first, found);
    return pack(found, first);
  };
  using Kind = harness::Outcome::Kind;
  const harness::Outcome outcome = harness::isolate(work, 2 * plan.limit + 60);
  if (outcome.kind == Kind::Interrupted) return false;
  if (outcome.kind == Kind::Done) {
    unpack(outcome.text, out);
  } else {
    out.failure = outcome.text;
  }
  return true;
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::ranges::sort(values);
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

void measure(const Plan& plan, const std::function<void(const Progress&)>& progress,
             const std::function<void(std::vector<Measurement>&)>& done,
             const std::function<bool()>& interrupted) {
  const int engines = static_cast<int>(plan.engines.size());
  Progress now{0, static_cast<int>(plan.scenes.size()) * engines * plan.repeat, ""};
  for (const Scene* scene : plan.scenes) {
    std::vector<Measurement> row(engines);
    for (int i = 0; i < engines; ++i) {
      row[i].scene = scene;
      row[i].engine = plan.engines[i];
      row[i].steps = plan.steps.value_or(plan.quick ? scene->quick_steps : scene->steps);
    }
    for (int repetition = 0; repetition < plan.repeat; ++repetition) {
      for (int turn = 0; turn < engines; ++turn) {
        if (interrupted()) return;
        Measurement& out = row[(repetition + turn) % engines];
        now.what = scene->name + " on " + out.engine->name;
        progress(now);
        ++now.done;
        if (!out.failure.empty()) continue;
        if (!run_apart(plan, repetition == 0, out)) return;
      }
    }
    done(row);
  }
}

}  // namespace plumb::field
