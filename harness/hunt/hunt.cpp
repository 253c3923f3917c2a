#include "harness/hunt/hunt.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/scene/error.h"
#include "harness/hunt/examine.h"
#include "harness/hunt/kinds.h"
#include "harness/hunt/processor_time.h"
#include "harness/hunt/shrink.h"
#include "harness/hunt/workers.h"
#include "harness/interrupt.h"
#include "harness/sweep/journal.h"

namespace plumb::harness::hunt {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

// Processor time limits for a scene, and for a run.
constexpr double kSceneSeconds = 60, kRunSeconds = 10;
constexpr double kMoreSeconds = 30;  // after the time limit, for shrinking findings
// Replaces the law in a task whose scene's process died: each engine is then examined separately.
constexpr std::uint64_t kCrashed = 0xFF;

/// A task packed into a number: a scene, or one finding in it to be shrunk.
struct Task {
  bool shrinks = false;
  std::uint64_t engine = 0, law = 0, scene = 0;

  std::uint64_t packed() const {
    return (shrinks ? std::uint64_t{1} << 63 : 0) | engine << 56 | law << 48 | scene;
  }
  static Task of(std::uint64_t number) {
    return {(number >> 63) != 0, number >> 56 & 0x7F, number >> 48 & 0xFF,
            number & ((std::uint64_t{1} << 48) - 1)};
  }
};

/// Work of the worker processes.
class Workshop {
 public:
  explicit Workshop(const HuntOptions& options) : options_(options) {}

  std::string work(std::uint64_t number) const {
    const Task task = Task::of(number);
    const Case one = draw(options_, task.scene);
    if (!task.shrinks) return examined(one);
    return task.law == kCrashed ? shrunk_crash(one, task) : shrunk(one, task);
  }

 private:
  std::string examined(const Case& one) const {
    Json out{{"runs", 0}, {"skipped", 0}, {"findings", Json::array()}};
    for (std::size_t i = 0; i < options_.engines.size(); ++i) {
      const Examined seen = examine(options_.engines[i], one);
      out[seen.skipped.empty() ? "runs" : "skipped"] =
          out[seen.skipped.empty() ? "runs" : "skipped"].get<int>() + 1;
      for (const Objection& objection : seen.objections)
        out["findings"].push_back(Json::parse(to_json(finding(i, one, objection))));
    }
    return out.dump();
  }

  Finding finding(std::size_t engine, const Case& one, const Objection& objection) const {
    Finding out{.engine = options_.engines[engine].name(), .objection = objection, .smallest = one};
    out.kind = objection.judge + ": " + made_of(one, objection.law);
    return out;
  }

  std::string shrunk(const Case& one, const Task& task) const {
    const Engine& engine = options_.engines[task.engine];
    const std::string law = judge_names()[task.law];
    const Examined first = examine(engine, one, law);
    if (first.objections.empty()) return "{}";
    const std::string judge = first.objections.front().judge;
    Objection last = first.objections.front();
    const Case smallest = shrink(one, [&](const Case& candidate) {
      const Examined seen = examine(engine, candidate, law);
      if (seen.objections.empty() || seen.objections.front().judge != judge) return false;
      last = seen.objections.front();
      return true;
    });
    Finding out = finding(task.engine, smallest, last);
    out.shrunk = true;
    return to_json(out);
  }

  // Runs each candidate in a process of its own, because it may crash again.
  std::string shrunk_crash(const Case& one, const Task& task) const {
    const Engine& engine = options_.engines[task.engine];
    std::string how;
    const auto fails = [&](const Case& candidate) {
      const Outcome outcome = isolate_within(kRunSeconds, [&] {
        examine(engine, candidate);
        return std::string();
      });
      if (outcome.kind != Outcome::Kind::Crashed && outcome.kind != Outcome::Kind::Timeout) return false;
      how = outcome.text;
      return true;
    };
    if (!fails(one)) return "{}";
    const Case smallest = shrink(one, fails, 100, 30);
    Objection objection{
        .law = "crash", .judge = "crash", .what = how, .right = "a run ends, and its process lives"};
    Finding out = finding(task.engine, smallest, objection);
    out.shrunk = true;
    return to_json(out);
  }

  const HuntOptions& options_;
};

std::string header_of(const HuntOptions& options) {
  Json out{{"plumb_hunt_log", 1}, {"seed", options.seed}};
  for (const Engine& engine : options.engines) out["engines"].push_back(engine.name());
  for (const CaseSeed& seed : options.cases) out["cases"].push_back(seed.path);
  out["families"] = Json::array();
  for (const Idiom* family : options.families) out["families"].push_back(family->name);
  return out.dump();
}

/// The hunt in the parent process.
class Hunt {
 public:
  Hunt(const HuntOptions& options, const HuntEvents& events)
      : options_(options), events_(events), journal_(options.folder + "/hunt.jsonl"), workshop_(options) {
    read();
  }

  Hunted go() {
    Workers workers(options_.jobs, kSceneSeconds,
                    [this](std::uint64_t task) { return workshop_.work(task); });
    const auto begin = Clock::now();
    for (;;) {
      const double passed = std::chrono::duration<double>(Clock::now() - begin).count();
      const bool over = options_.seconds > 0 && passed > options_.seconds;
      if (over && passed > options_.seconds + kMoreSeconds) queue_.clear();  // the next hunt shrinks them
      // Shrink findings before drawing new scenes, also after the time limit.
      while (workers.idle() > 0 && !interrupted() && (!queue_.empty() || (!over && next()))) {
        workers.start(queue_.front());
        queue_.erase(queue_.begin());
      }
      if (!workers.busy()) break;
      if (interrupted()) break;
      for (const Answer& answer : workers.wait()) take(answer);
      if (events_.progress) events_.progress(result_.scenes, findings_.size(), passed);
    }
    result_.interrupted = interrupted();
    result_.kinds = kinds_of(findings_);
    return std::move(result_);
  }

 private:
  void read() {
    const std::string header = header_of(options_);
    if (journal_.lines().empty()) {
      journal_.append(header);
      return;
    }
    if (journal_.lines().front() != header)
      throw Error(
          Error::Kind::Io, fmt::format("file '{}'", journal_.path()), "", "",
          "belongs to a hunt with another seed, engines or families; choose another folder with --out");
    for (std::size_t i = 1; i < journal_.lines().size(); ++i) {
      const Json line = Json::parse(journal_.lines()[i], nullptr, false);
      if (line.is_discarded()) continue;
      if (line.contains("scene")) count_scene(line);
      if (line.contains("finding"))
        remember({line.at("scene_of").get<std::uint64_t>(), finding_from_json(line["finding"].dump())});
    }
    // Queues the findings that were not shrunk in time.
    std::set<std::string> small;
    const auto key = [](const Found& found) {
      return fmt::format("{} {} {}", found.scene, found.finding.engine, found.finding.objection.law);
    };
    for (const Found& found : findings_)
      if (found.finding.shrunk) small.insert(key(found));
    for (const Found& found : findings_)
      if (!found.finding.shrunk && !small.contains(key(found))) want_smaller(found.scene, found.finding);
  }

  void count_scene(const Json& line) {
    done_.insert(line.at("scene").get<std::uint64_t>());
    ++result_.scenes;
    result_.runs += line.value("runs", 0);
    result_.skipped += line.value("skipped", 0);
  }

  // Puts the next scene into the queue; false if there is none.
  bool next() {
    while (done_.contains(next_)) ++next_;
    if (options_.scenes > 0 && next_ >= options_.scenes) return false;
    queue_.push_back(Task{.scene = next_++}.packed());
    return true;
  }

  void take(const Answer& answer) {
    const Task task = Task::of(answer.task);
    if (answer.kind != Answer::Kind::Done) {
      if (task.shrinks) return;
      journal_.append(Json{{"scene", task.scene}, {"ended", answer.text}}.dump());
      done_.insert(task.scene);
      ++result_.scenes;
      for (std::size_t i = 0; i < options_.engines.size(); ++i)
        queue_.push_back(Task{true, i, kCrashed, task.scene}.packed());
      return;
    }
    const Json json = Json::parse(answer.text, nullptr, false);
    if (json.is_discarded()) return;
    if (task.shrinks) {
      if (json.contains("kind")) store(task.scene, finding_from_json(answer.text));
      return;
    }
    for (const Json& each : json.at("findings")) {
      const Finding found = finding_from_json(each.dump());
      store(task.scene, found);
      want_smaller(task.scene, found);
    }
    journal_.append(
        Json{{"scene", task.scene}, {"runs", json.at("runs")}, {"skipped", json.at("skipped")}}.dump());
    count_scene(Json{{"scene", task.scene}, {"runs", json.at("runs")}, {"skipped", json.at("skipped")}});
  }

  void store(std::uint64_t scene, const Finding& found) {
    Json line{{"scene_of", scene}};
    line["finding"] = Json::parse(to_json(found));
    journal_.append(line.dump());
    remember({scene, found});
    if (found.shrunk && events_.found) events_.found(found);
  }

  void remember(Found found) {
    if (found.finding.shrunk) ++shrunk_[coarse_key(found.finding)];
    findings_.push_back(std::move(found));
  }

  void want_smaller(std::uint64_t scene, const Finding& found) {
    int& count = asked_[coarse_key(found)];
    if (count + shrunk_[coarse_key(found)] >= options_.shrinks) return;
    const std::vector<std::string> names = judge_names();
    const auto law = std::find(names.begin(), names.end(), found.objection.law);
    for (std::size_t i = 0; i < options_.engines.size() && law != names.end(); ++i)
      if (options_.engines[i].name() == found.engine) {
        ++count;
        queue_.push_back(Task{true, i, static_cast<std::uint64_t>(law - names.begin()), scene}.packed());
      }
  }

  const HuntOptions& options_;
  const HuntEvents& events_;
  sweep::Journal journal_;
  Workshop workshop_;
  Hunted result_;
  std::set<std::uint64_t> done_;
  std::uint64_t next_ = 0;
  std::vector<std::uint64_t> queue_;
  std::vector<Found> findings_;
  std::map<std::string, int> asked_, shrunk_;
};

}  // namespace

Case draw(const HuntOptions& options, std::uint64_t index) {
  if (options.cases.empty()) return compose(options.seed, index, options.families);
  if (options.families.empty()) return vary(options.seed, index, options.cases);
  return index % 2 == 0 ? vary(options.seed, index / 2, options.cases)
                        : compose(options.seed, index, options.families);
}

Hunted hunt(const HuntOptions& options, const HuntEvents& events) { return Hunt(options, events).go(); }

}  // namespace plumb::harness::hunt
