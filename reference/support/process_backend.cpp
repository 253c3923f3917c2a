#include "reference/process_backend.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "engine/core/text.h"
#include "engine/scene/json.h"
#include "reference/killed.h"
#include "reference/support/process.h"
#include "reference/support/protocol.h"
#include "reference/support/settings.h"

namespace plumb::reference {
namespace {

using Json = nlohmann::ordered_json;
using Fault = ProcessError::Fault;
using protocol::Loaded;

/// Command that starts a program, and the name of its engine.
struct Launch {
  std::string engine;
  std::vector<std::string> command;
  ProcessLimits limits;
};

/// Returns the result of `question`; asks again if the program was killed from outside.
template <class Question>
auto ask_again(const Question& question) {
  for (int attempt = 1;; ++attempt) {
    try {
      return question();
    } catch (const ProcessError& error) {
      if (error.fault() != Fault::Killed || attempt == kAttempts) throw;
    }
  }
}

/// One running program and the conversation with it.
class Session {
 public:
  explicit Session(const Launch& launch)
      : engine_(launch.engine),
        limits_(launch.limits),
        process_(launch.engine, launch.command, launch.limits) {
    process_.write_line(Json{{"request", "hello"}, {"protocol", protocol::kVersion}}.dump(), "hello");
    read_answer(limits_.answer_bytes,
                [this](const Json& answer) { hello_ = protocol::hello_from_json(answer); });
  }

  ~Session() {
    if (!owned()) return;
    try {
      process_.write_line(Json{{"request", "quit"}}.dump(), "quit");
    } catch (const Error&) {
      // Ignored: the program may have ended already.
    }
  }

  const protocol::Hello& hello() const { return hello_; }
  bool owned() const { return process_.owned(); }

  /// `request` is a whole "load" message.
  Loaded load(const std::string& request) {
    Loaded out;
    process_.write_line(request, "load");
    read_answer(limits_.answer_bytes, [&](const Json& answer) { out = protocol::loaded_from_json(answer); });
    return out;
  }

  /// Runs `samples` times `every` steps of `dt` from `start`; returns the engine's ns.
  double run(int samples, int every, double start, double dt, std::span<BodyState> states,
             const Simulator::Sink& sink) {
    process_.write_line(Json{{"request", "run"}, {"samples", samples}, {"every", every}}.dump(), "run");
    for (int sample = 1; sample <= samples; ++sample) {
      const double due = start + static_cast<double>(sample) * every * dt;
      read_answer(limits_.line_bytes, [&](const Json& answer) {
        const double time = protocol::sample_from_json(answer, states);
        if (!(std::abs(time - due) <= dt / 2)) {
          throw process_.fail(Fault::Time, "its answer is wrong: its \"t\" is " + shortest(time) + " where " +
                                               shortest(due) + " is due");
        }
      });
      sink(due, states);
    }
    double nanoseconds = 0;
    read_answer(limits_.answer_bytes,
                [&](const Json& answer) { nanoseconds = protocol::done_from_json(answer); });
    return nanoseconds;
  }

 private:
  /// Passes the next answer, of at most `most` bytes, to `take`. Throws an error about this engine if the
  /// answer is invalid, or reports an error.
  template <class Take>
  void read_answer(std::size_t most, const Take& take) {
    const std::string line = process_.read_line(most);
    try {
      const Json answer = protocol::parse_line(line);
      if (answer.contains("error")) throw protocol::error_from_json(answer["error"], engine_);
      take(answer);
    } catch (const protocol::Malformed& problem) {
      throw process_.fail(Fault::Protocol, "its answer is wrong: " + std::string(problem.what()));
    } catch (const protocol::NotFinite& problem) {
      throw process_.fail(Fault::Diverged, problem.what());
    }
  }

  std::string engine_;
  ProcessLimits limits_;
  Process process_;
  protocol::Hello hello_;
};

class ProcessSimulator final : public Simulator {
 public:
  ProcessSimulator(const Launch& launch, const std::string& request, const Scene& scene, double dt)
      : session_(launch), dt_(dt) {
    const Loaded loaded = session_.load(request);
    if (!loaded.unsupported.empty()) {
      throw Error(Error::Kind::Unsupported, "engine '" + launch.engine + "'", "", "", loaded.unsupported);
    }
    for (const Body& body : scene.bodies) states_.push_back(initial_state(body));
  }

  double advance(int steps) override {
    return record(1, steps, states_.size(), [](double, std::span<const BodyState>) {});
  }
  double time() const override { return static_cast<double>(steps_) * dt_; }
  void read(std::span<BodyState> out) const override {
    std::copy(states_.begin(), states_.end(), out.begin());
  }

  /// All samples in one message.
  double record(int samples, int every, std::size_t, const Sink& sink) override {
    if (samples <= 0) return 0;
    const double nanoseconds = session_.run(samples, every, time(), dt_, states_, sink);
    steps_ += static_cast<std::int64_t>(samples) * every;
    return nanoseconds;
  }

 private:
  Session session_;
  double dt_;
  std::vector<BodyState> states_;
  std::int64_t steps_ = 0;
};

class ProcessBackend final : public Backend {
 public:
  ProcessBackend(Launch launch, std::string summary)
      : launch_(std::move(launch)), summary_(std::move(summary)) {
    if (summary_.empty())
      summary_ = "runs as the program " + plumb::quoted(launch_.command.empty() ? "" : launch_.command[0]);
  }

  std::string_view name() const override { return launch_.engine; }
  std::string_view summary() const override { return summary_; }

  Identity identity() const override {
    const Known& known = ask_once();
    if (!known.hello) return {.available = false, .reason = known.reason};
    return {.version = known.hello->version,
            .precision = known.hello->precision,
            .own_name = known.hello->name,
            .limits = known.hello->limits};
  }

  std::vector<Option> options() const override {
    const Known& known = ask_once();
    return known.hello ? known.hello->options : std::vector<Option>{};
  }

  std::vector<Knob> knobs() const override {
    const Known& known = ask_once();
    return known.hello ? known.hello->knobs : std::vector<Knob>{};
  }

  Method method(const StepSettings& settings) const override {
    const protocol::Hello& hello = checked(settings);
    Method out = hello.method;
    int substeps = hello.substeps;
    for (const protocol::OptionMethod& each : hello.methods) {
      const auto chosen = settings.options.find(each.option);
      if (chosen == settings.options.end() || chosen->second != each.value) continue;
      out = each.method;
      substeps = each.substeps;
    }
    out.substep = settings.dt / settings.substeps.value_or(substeps);
    return out;
  }

  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    const Known& known = ask_once();
    if (!known.hello) return known.reason;
    const std::string missing = protocol::missing_capability(scene, checked(settings));
    return missing.empty() ? ask(scene, settings).unsupported : missing;
  }

  Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    checked(settings);
    return ask(scene, settings).effective;
  }

  std::unique_ptr<Simulator> create(const Scene& scene, const StepSettings& settings) const override {
    checked(settings);
    return std::make_unique<ProcessSimulator>(launch_, load_request(scene, settings), scene, settings.dt);
  }

 private:
  /// The program's answer to "hello", or the reason why there is no answer.
  struct Known {
    std::optional<protocol::Hello> hello;
    std::string reason;
  };

  const Known& ask_once() const {
    const std::lock_guard lock(mutex_);
    if (!known_) {
      known_.emplace();
      try {
        session_ = ask_again([&] { return std::make_unique<Session>(launch_); });
        known_->hello = session_->hello();
      } catch (const Error& error) {
        known_->reason = error.what();
      }
    }
    return *known_;
  }

  /// Returns the engine's hello. Throws `Error` for settings that it cannot take.
  const protocol::Hello& checked(const StepSettings& settings) const {
    const Known& known = ask_once();
    if (!known.hello) {
      throw Error(Error::Kind::Unsupported, "engine '" + launch_.engine + "'", "", "", known.reason);
    }
    const bool adaptive = known.hello->method.scheme == Scheme::Adaptive;
    check_steps(launch_.engine, settings, adaptive ? Stepping::Adaptive : Stepping::Fixed);
    OptionReader(launch_.engine, settings, known.hello->options);
    return *known.hello;
  }

  /// Returns the kept program's answer to "load". Restarts the program if it has failed.
  Loaded ask(const Scene& scene, const StepSettings& settings) const {
    const std::string request = load_request(scene, settings);
    const std::lock_guard lock(mutex_);
    if (request == asked_) return answer_;
    asked_.clear();
    answer_ = ask_again([&] {
      // A session inherited through a fork belongs to the parent, so start another.
      if (!session_ || !session_->owned()) session_ = std::make_unique<Session>(launch_);
      try {
        return session_->load(request);
      } catch (const Error&) {
        session_.reset();
        throw;
      }
    });
    asked_ = request;
    return answer_;
  }

  static std::string load_request(const Scene& scene, const StepSettings& settings) {
    return "{\"request\":\"load\",\"scene\":" + plumb::to_json(scene, -1) +
           ",\"settings\":" + protocol::to_json(settings).dump() + "}";
  }

  Launch launch_;
  std::string summary_;
  // The program that answers "hello" and "load": started once, its last answer cached.
  mutable std::mutex mutex_;
  mutable std::optional<Known> known_;
  mutable std::unique_ptr<Session> session_;
  mutable std::string asked_;
  mutable Loaded answer_;
};

}  // namespace

std::unique_ptr<Backend> make_process_backend(std::string name, std::vector<std::string> command,
                                              std::string summary, ProcessLimits limits) {
  return std::make_unique<ProcessBackend>(Launch{std::move(name), std::move(command), limits},
                                          std::move(summary));
}

}  // namespace plumb::reference
