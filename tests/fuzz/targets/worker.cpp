// Lines that a host might send to an engine that plumb serves (reference/support/serve.h): every request is
// answered, with lines that plumb itself takes, or with an error.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "engine/scene/error.h"
#include "reference/backend.h"
#include "reference/support/protocol.h"
#include "reference/support/serve.h"
#include "tests/fuzz/support/require.h"

namespace plumb::fuzz {
namespace {

namespace protocol = reference::protocol;
using reference::StepSettings;

constexpr int kMostSteps = 40, kMostSubsteps = 16;
constexpr std::size_t kMostParts = 30;

/// An engine that does as asked, as long as it is not asked for much: runs take milliseconds.
class Brief final : public reference::Backend {
 public:
  explicit Brief(const reference::Backend& engine) : engine_(engine) {}

  std::string_view name() const override { return engine_.name(); }
  std::string_view summary() const override { return engine_.summary(); }
  reference::Identity identity() const override { return engine_.identity(); }
  std::vector<reference::Option> options() const override { return engine_.options(); }
  std::vector<reference::Knob> knobs() const override { return engine_.knobs(); }
  reference::Method method(const StepSettings& settings) const override { return engine_.method(settings); }
  std::string unsupported(const Scene& scene, const StepSettings& settings) const override {
    const std::string reason = engine_.unsupported(scene, settings);
    const bool large = scene.bodies.size() + scene.joints.size() > kMostParts;
    return large || settings.substeps.value_or(1) > kMostSubsteps ? "too much for a short run" : reason;
  }
  reference::Settings effective_settings(const Scene& scene, const StepSettings& settings) const override {
    return engine_.effective_settings(scene, settings);
  }
  std::unique_ptr<reference::Simulator> create(const Scene& scene,
                                               const StepSettings& settings) const override {
    return std::make_unique<Run>(engine_.create(scene, settings));
  }

 private:
  class Run final : public reference::Simulator {
   public:
    explicit Run(std::unique_ptr<reference::Simulator> run) : run_(std::move(run)) {}
    double advance(int steps) override {
      left_ -= std::max(steps, 0);
      if (left_ < 0) throw Error(Error::Kind::Run, "run", "samples", "", "are too many for a short run");
      return run_->advance(steps);
    }
    double time() const override { return run_->time(); }
    void read(std::span<BodyState> out) const override { run_->read(out); }

   private:
    std::unique_ptr<reference::Simulator> run_;
    std::int64_t left_ = kMostSteps;
  };

  const reference::Backend& engine_;
};

std::string answers_to(const reference::Backend& engine, const std::string& requests) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* answers = open_memstream(&text, &size);
  std::istringstream in(requests);
  require(reference::serve(engine, in, answers) == 0, "the worker ends as it should");
  std::fclose(answers);
  const std::string out(text, size);
  std::free(text);
  return out;
}

// The host takes what the worker writes.
void check_answer(const std::string& line) {
  try {
    const nlohmann::ordered_json answer = protocol::parse_line(line);
    if (answer.contains("error")) {
      protocol::error_from_json(answer["error"], "fuzz");
    } else if (answer.contains("protocol")) {
      protocol::hello_from_json(answer);
    } else if (answer.contains("states")) {
      std::vector<BodyState> states(answer["states"].size());
      protocol::sample_from_json(answer, states);
    } else if (answer.contains("done")) {
      protocol::done_from_json(answer);
    } else {
      protocol::loaded_from_json(answer);
    }
  } catch (const protocol::NotFinite&) {
    // An error that says so.
  } catch (const std::exception& error) {
    fail("the worker's answers are what the host takes", error.what());
  }
}

}  // namespace
}  // namespace plumb::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumb;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const bool first = text.size() % 2 == 0;
  const fuzz::Brief engine(reference::find_backend(first ? "plumb-float" : "plumb"));
  std::istringstream answers(fuzz::answers_to(engine, text));
  for (std::string line; std::getline(answers, line);) fuzz::check_answer(line);
  return 0;
}
