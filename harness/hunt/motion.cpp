#include "harness/hunt/motion.h"

#include <cmath>
#include <cstring>
#include <exception>
#include <stdexcept>

#include "engine/scene/error.h"
#include "harness/hunt/processor_time.h"
#include "harness/hunt/world_run.h"
#include "reference/process_backend.h"

namespace plumb::harness::hunt {
namespace {

bool finite(const BodyState& s) {
  return std::isfinite(s.position.x) && std::isfinite(s.position.y) && std::isfinite(s.angle) &&
         std::isfinite(s.velocity.x) && std::isfinite(s.velocity.y) && std::isfinite(s.angular_velocity);
}

reference::StepSettings settings_of(const Case& one, const Engine& engine, const RunOptions& options = {}) {
  reference::StepSettings out{.dt = one.dt / options.refine, .tolerance = options.tolerance};
  if (engine.kind != Engine::Kind::Precise) out.substeps = one.substeps;
  return out;
}

Motion run_backend(const Engine& engine, const Case& one, const RunOptions& options) {
  Motion out{.dt = one.dt};
  const std::size_t count = one.scene.bodies.size();
  const double begin = processor_seconds();
  try {
    const auto simulator = engine.backend->create(one.scene, settings_of(one, engine, options));
    for (int step = 0; step <= one.steps; ++step) {
      if (step > 0) simulator->advance(options.refine);
      Sample sample{std::vector<BodyState>(count), std::vector<bool>(count, true),
                    std::vector<bool>(count, false)};
      simulator->read(sample.states);
      for (const BodyState& state : sample.states)
        if (!finite(state)) throw std::runtime_error("a state is not finite");
      out.samples.push_back(std::move(sample));
      if (processor_seconds() - begin > options.seconds) break;
    }
  } catch (const reference::ProcessError& error) {
    out.failure = error.what();
  } catch (const Error& error) {
    (error.kind() == Error::Kind::Run ? out.stopped : out.failure) = error.what();
  } catch (const std::exception& error) {
    out.failure = error.what();
  }
  return out;
}

// Writes the texts, each preceded by its length, then the states.
std::string as_bytes(const Motion& motion) {
  std::string out;
  for (const std::string& text : {motion.failure, motion.stopped}) {
    const std::uint64_t size = text.size();
    out.append(reinterpret_cast<const char*>(&size), sizeof size).append(text);
  }
  for (const Sample& sample : motion.samples)
    out.append(reinterpret_cast<const char*>(sample.states.data()), sample.states.size() * sizeof(BodyState));
  return out;
}

Motion from_bytes(const std::string& bytes, const Case& one) {
  Motion out{.dt = one.dt};
  std::size_t at = 0;
  for (std::string* text : {&out.failure, &out.stopped}) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + at, sizeof size);
    *text = bytes.substr(at + sizeof size, size);
    at += sizeof size + size;
  }
  const std::size_t bodies = one.scene.bodies.size(), size = bodies * sizeof(BodyState);
  for (; size > 0 && at + size <= bytes.size(); at += size) {
    Sample sample{std::vector<BodyState>(bodies), std::vector<bool>(bodies, true),
                  std::vector<bool>(bodies, false)};
    std::memcpy(sample.states.data(), bytes.data() + at, size);
    out.samples.push_back(std::move(sample));
  }
  return out;
}

Motion run_guarded(const Engine& engine, const Case& one, const RunOptions& options) {
  const Outcome outcome =
      isolate_within(options.seconds + 1, [&] { return as_bytes(run_backend(engine, one, options)); });
  if (outcome.kind == Outcome::Kind::Done) return from_bytes(outcome.text, one);
  const bool slow = outcome.kind != Outcome::Kind::Crashed || outcome.text.find("XCPU") != std::string::npos;
  return {.dt = one.dt, .samples = {}, .failure = slow ? "" : outcome.text};
}

Engine::Kind kind_of(const std::string_view name) {
  if (name == "plumb-float") return Engine::Kind::World;
  if (name == "plumb") return Engine::Kind::DoubleWorld;
  if (name == "plumb-precise") return Engine::Kind::Precise;
  return Engine::Kind::Other;
}

}  // namespace

Engine::Engine(const reference::Backend& of) : backend(&of), kind(kind_of(of.name())) {}

double Engine::epsilon() const { return kind == Kind::DoubleWorld || kind == Kind::Precise ? 1.2e-16 : 6e-8; }

std::string unsupported(const Engine& engine, const Case& one) {
  if (engine.is_world()) return engine.backend->unsupported(one.scene, settings_of(one, engine));
  if (one.world_only()) return "the case has actions while it runs";
  return engine.backend->unsupported(one.scene, settings_of(one, engine));
}

Motion run(const Engine& engine, const Case& one, const RunOptions& options) {
  if (engine.kind == Engine::Kind::World) return run_world<float>(one, options);
  if (engine.kind == Engine::Kind::DoubleWorld) return run_world<double>(one, options);
  if (engine.kind == Engine::Kind::Precise) return run_guarded(engine, one, options);
  return run_backend(engine, one, options);
}

}  // namespace plumb::harness::hunt
