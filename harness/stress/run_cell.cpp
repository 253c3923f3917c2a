#include "harness/stress/run_cell.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

#include <fmt/format.h>
#include <sys/mman.h>

#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "engine/scene/validate.h"
#include "reference/process_backend.h"

namespace plumb::harness::stress {
namespace {

using reference::ProcessError;

// Thrown to end a run that needs no further samples.
struct Enough {};

Finding plain(Verdict verdict, std::string reason) {
  Finding out;
  out.verdict = verdict;
  out.reason = std::move(reason);
  return out;
}

Verdict verdict_of_fault(ProcessError::Fault fault) {
  switch (fault) {
    case ProcessError::Fault::Timeout:
      return Verdict::Timeout;
    case ProcessError::Fault::Diverged:
      return Verdict::NotFinite;
    case ProcessError::Fault::Start:
    case ProcessError::Fault::Crash:
    case ProcessError::Fault::Killed:
    case ProcessError::Fault::Time:
    case ProcessError::Fault::Protocol:
      break;
  }
  return Verdict::Crashed;
}

bool is_finite(const BodyState& state) {
  return std::isfinite(state.position.x) && std::isfinite(state.position.y) && std::isfinite(state.angle) &&
         std::isfinite(state.velocity.x) && std::isfinite(state.velocity.y) &&
         std::isfinite(state.angular_velocity);
}

// Returns why the engine rejects the scene, or an empty finding: Refused if it has reached a limit, Skipped
// if it lacks a feature altogether.
Finding turned_away(const Task& task, const Trial& trial, const reference::StepSettings& settings) {
  const std::string why = task.backend->unsupported(trial.scene, settings);
  if (why.empty()) return {};
  const Trial usual = task.family->build(task.family->usual);
  const bool ever = task.backend->unsupported(usual.scene, task.setting.with(usual.dt)).empty();
  return plain(ever ? Verdict::Refused : Verdict::Skipped, why);
}

/// Passes the samples of a run to its judge.
class Watch {
 public:
  Watch(const Scene& scene, Judge& judge, Cell& cell, const Witness& witness)
      : scene_(scene), judge_(judge), cell_(cell), witness_(witness) {}

  void see(std::span<const BodyState> states) {
    const double time = static_cast<double>(cell_.steps) * cell_.dt;
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (is_finite(states[i])) continue;
      cell_.finding = plain(Verdict::NotFinite,
                            fmt::format("body '{}' is not finite at {:.4g} s", scene_.bodies[i].name, time));
      throw Enough();
    }
    witness_(cell_);
    const bool on = judge_.see(time, states);
    cell_.finding = judge_.finding();
    if (!on) throw Enough();
  }

 private:
  const Scene& scene_;
  Judge& judge_;
  Cell& cell_;
  const Witness& witness_;
};

void play(const Task& task, const Trial& trial, const reference::StepSettings& settings,
          const Witness& witness, Cell& cell) {
  const auto simulator = task.backend->create(trial.scene, settings);
  const auto judge = trial.judge(trial.scene);
  Watch watch(trial.scene, *judge, cell, witness);
  std::vector<BodyState> start(trial.scene.bodies.size());
  simulator->read(start);
  watch.see(start);
  for (const Stretch& stretch : trial.stretches) {
    const auto sink = [&](double, std::span<const BodyState> states) {
      cell.steps += stretch.every;
      watch.see(states);
    };
    cell.engine_seconds +=
        1e-9 * simulator->record(stretch.samples, stretch.every, trial.scene.bodies.size(), sink);
  }
}

void run(const Task& task, const Witness& witness, Cell& cell) {
  const reference::Identity identity = task.backend->identity();
  if (!identity.available) {
    cell.finding = plain(Verdict::Skipped, fmt::format("not installed: {}", identity.reason));
    return;
  }
  const Trial trial = task.family->build(task.value);
  validate(trial.scene);
  cell.dt = trial.dt;
  const reference::StepSettings settings = task.setting.with(trial.dt);
  task.backend->method(settings);  // throws for settings that the engine rejects
  cell.finding = turned_away(task, trial, settings);
  if (cell.finding.verdict != Verdict::Ok) return;
  cell.settings = task.backend->effective_settings(trial.scene, settings);
  witness(cell);
  play(task, trial, settings, witness, cell);
}

/// Memory shared by a child and its parent. It keeps the facts of a cell whose process died.
class Notes {
 public:
  explicit Notes(std::size_t count) : bytes_(std::max<std::size_t>(1, count) * kBytes) {
    void* place =
        mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (place == MAP_FAILED) throw Error(Error::Kind::Io, "shared memory", "", "", std::strerror(errno));
    first_ = static_cast<char*>(place);
  }
  Notes(const Notes&) = delete;
  Notes& operator=(const Notes&) = delete;
  ~Notes() { munmap(first_, bytes_); }

  void write(std::size_t index, const Cell& cell) {
    char* const note = first_ + index * kBytes;
    std::memcpy(note, &cell.steps, sizeof cell.steps);
    if (note[sizeof cell.steps] != 0) return;
    const std::string text = to_json(cell);
    if (text.size() + sizeof cell.steps < kBytes)
      std::memcpy(note + sizeof cell.steps, text.data(), text.size());
  }

  /// Copies the noted facts into `cell`.
  void read(std::size_t index, Cell& cell) const {
    const char* const note = first_ + index * kBytes;
    if (note[sizeof cell.steps] == 0) return;
    const Cell noted = cell_from_json(note + sizeof cell.steps);
    cell.dt = noted.dt;
    cell.settings = noted.settings;
    std::memcpy(&cell.steps, note, sizeof cell.steps);
  }

 private:
  static constexpr std::size_t kBytes = 8192;
  std::size_t bytes_;
  char* first_;
};

Cell ended(const Task& task, const Outcome& outcome, const Notes& notes, std::size_t index) {
  Cell cell = blank(task);
  if (outcome.kind == Outcome::Kind::Done) {
    cell = cell_from_json(outcome.text);
  } else {
    notes.read(index, cell);
    const bool late = outcome.kind == Outcome::Kind::Timeout;
    cell.finding =
        plain(late ? Verdict::Timeout : Verdict::Crashed,
              cell.steps > 0 ? fmt::format("{}, after {} steps", outcome.text, cell.steps) : outcome.text);
  }
  cell.memory = outcome.memory;
  cell.seconds = outcome.seconds;
  return cell;
}

}  // namespace

Cell blank(const Task& task) {
  Cell cell{.family = task.family->name,
            .title = task.family->title,
            .axis = task.family->axis,
            .unit = task.family->unit,
            .value = task.value,
            .engine = std::string(task.backend->name()),
            .setting = task.setting.name};
  const reference::StepSettings asked = task.setting.with(0);
  if (asked.substeps) cell.settings.emplace_back("substeps", std::to_string(*asked.substeps));
  if (asked.tolerance) cell.settings.emplace_back("tolerance", shortest(*asked.tolerance));
  for (const auto& [name, value] : asked.options) cell.settings.emplace_back(name, value);
  return cell;
}

Cell run_cell(const Task& task, const Witness& witness) {
  Cell cell = blank(task);
  try {
    run(task, witness, cell);
  } catch (const Enough&) {
  } catch (const ProcessError& error) {
    if (error.fault() == ProcessError::Fault::Killed) throw;
    cell.finding = plain(verdict_of_fault(error.fault()), error.what());
  } catch (const Error& error) {
    cell.finding = plain(Verdict::Refused, error.what());
  } catch (const std::bad_alloc&) {
    cell.finding = plain(Verdict::Crashed, "out of memory");
  } catch (const std::exception& error) {
    cell.finding = plain(Verdict::Crashed, fmt::format("an exception: {}", error.what()));
  }
  return cell;
}

void run_cells(const std::vector<Task>& tasks, int jobs, const ChildLimits& limits,
               const std::function<void(std::size_t, const Cell&)>& done) {
  Notes notes(tasks.size());
  const auto limits_of = [&](std::size_t i) {
    return ChildLimits(limits.seconds * tasks[i].family->patience, limits.memory);
  };
  const auto work = [&](std::size_t i) {
    return to_json(run_cell(tasks[i], [&](const Cell& so_far) { notes.write(i, so_far); }));
  };
  isolate_all(tasks.size(), jobs, limits_of, work, [&](std::size_t i, const Outcome& outcome) {
    if (outcome.kind == Outcome::Kind::Interrupted) return;
    done(i, ended(tasks[i], outcome, notes, i));
  });
}

}  // namespace plumb::harness::stress
