#include "reference/support/serve.h"

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "engine/scene/names.h"
#include "reference/support/protocol.h"

namespace plumb::reference {
namespace {

using Json = nlohmann::ordered_json;
using Clock = std::chrono::steady_clock;

/// Writes lines to the host. Answers are flushed at once; samples are flushed if the last flush was more than
/// 100 ms ago.
class Output {
 public:
  explicit Output(std::FILE* file) : file_(file) {}

  void sample(const std::string& line) {
    write(line);
    if (Clock::now() - flushed_ > std::chrono::milliseconds(100)) flush();
  }
  void answer(const Json& message) {
    write(message.dump());
    flush();
  }

 private:
  void write(const std::string& line) {
    std::fwrite(line.data(), 1, line.size(), file_);
    std::fputc('\n', file_);
  }
  void flush() {
    std::fflush(file_);
    flushed_ = Clock::now();
  }

  std::FILE* file_;
  Clock::time_point flushed_ = Clock::now();
};

class Server {
 public:
  Server(const Backend& backend, std::FILE* answers) : backend_(backend), output_(answers) {}

  /// Handles one request. Returns false for "quit".
  bool handle(const std::string& line) {
    const Json message = protocol::parse_line(line);
    const std::string request = message.value("request", "");
    if (request == "quit") return false;
    if (request == "hello") {
      hello();
    } else if (request == "load") {
      load(message);
    } else if (request == "run") {
      run(message);
    } else {
      throw Error(Error::Kind::Name, "request", "", request, "is not hello, load, run or quit");
    }
    return true;
  }

  void report(const Error& error) { output_.answer({{"error", protocol::to_json(error)}}); }
  void report_divergence(const char* problem) {
    output_.answer({{"error", {{"kind", protocol::kDiverged}, {"problem", problem}}}});
  }

 private:
  void hello() {
    const Identity identity = backend_.identity();
    protocol::Hello out;
    out.name = backend_.name();
    out.version = identity.version;
    out.precision = identity.precision;
    out.summary = backend_.summary();
    out.method = backend_.method({.dt = 1});
    out.substeps = substeps_of(out.method);
    out.methods = methods_by_option(out.method);
    // Lists everything that a scene can contain; the backend's `unsupported` decides for each scene.
    out.shapes.assign(kGeometryNames.begin(), kGeometryNames.end());
    out.joints.assign(kJointNames.begin(), kJointNames.end());
    out.forces.assign(kForceNames.begin(), kForceNames.end());
    out.features = {"contacts", "filters", "kinematic", "fixed_rotation"};
    out.options = backend_.options();
    out.knobs = backend_.knobs();
    output_.answer(protocol::to_json(out));
  }

  /// Returns the number of substeps; `method` is that for a step of 1 s.
  static int substeps_of(const Method& method) { return static_cast<int>(std::lround(1 / method.substep)); }

  /// Returns the values of options that a sweep tries and that change the method.
  std::vector<protocol::OptionMethod> methods_by_option(const Method& plain) const {
    std::vector<protocol::OptionMethod> out;
    for (const Knob& knob : backend_.knobs()) {
      if (knob.name == "substeps" || knob.name == "tolerance") continue;
      for (const std::string& value : knob.values) {
        const Method method = backend_.method({.dt = 1, .options = {{knob.name, value}}});
        if (method.scheme != plain.scheme || method.order != plain.order || method.epsilon != plain.epsilon ||
            method.substep != plain.substep) {
          out.push_back({knob.name, value, method, substeps_of(method)});
        }
      }
    }
    return out;
  }

  void load(const Json& message) {
    simulator_.reset();
    const Scene scene = scene_from_json(message.at("scene").dump());
    const StepSettings settings = protocol::settings_from_json(message.at("settings"));
    const std::string reason = backend_.unsupported(scene, settings);
    if (!reason.empty()) {
      output_.answer({{"unsupported", reason}});
      return;
    }
    const Settings effective = backend_.effective_settings(scene, settings);
    simulator_ = backend_.create(scene, settings);
    bodies_ = scene.bodies.size();
    output_.answer({{"effective_settings", protocol::to_json(effective)}});
  }

  void run(const Json& message) {
    if (!simulator_) throw Error(Error::Kind::Run, "request", "run", "", "no scene is loaded");
    const int samples = protocol::whole_number(message, "samples");
    const int every = protocol::whole_number(message, "every");
    if (samples < 0 || every < 1)
      throw Error(Error::Kind::Value, "request", "run", "",
                  "must ask for samples >= 0, each after steps >= 1");
    const double nanoseconds =
        simulator_->record(samples, every, bodies_, [this](double time, std::span<const BodyState> states) {
          output_.sample(protocol::sample_line(time, states));
        });
    output_.answer({{"done", true}, {"ns", nanoseconds}});
  }

  const Backend& backend_;
  Output output_;
  std::unique_ptr<Simulator> simulator_;
  std::size_t bodies_ = 0;
};

}  // namespace

int serve(const Backend& backend) {
  // Engines print banners, so standard output is redirected to standard error; the protocol uses a duplicate.
  std::FILE* answers = fdopen(dup(STDOUT_FILENO), "w");
  dup2(STDERR_FILENO, STDOUT_FILENO);
  const int code = serve(backend, std::cin, answers);
  if (answers != nullptr) std::fclose(answers);
  return code;
}

int serve(const Backend& backend, std::istream& requests, std::FILE* answers) {
  Server server(backend, answers);
  std::string line;
  while (std::getline(requests, line)) {
    try {
      if (!server.handle(line)) break;
    } catch (const Error& error) {
      server.report(error);
    } catch (const protocol::NotFinite& error) {
      server.report_divergence(error.what());
    } catch (const std::exception& error) {
      const std::string subject = "engine '" + std::string(backend.name()) + "'";
      server.report(Error(Error::Kind::Run, subject, "", "", error.what()));
    }
  }
  return 0;
}

}  // namespace plumb::reference
