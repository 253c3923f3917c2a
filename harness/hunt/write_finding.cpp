#include <filesystem>

#include <fmt/format.h>

#include "engine/scene/error.h"
#include "harness/hunt/hunt.h"
#include "harness/hunt/picture.h"
#include "harness/text_file.h"

namespace plumb::harness::hunt {
namespace {

// Returns an engine to compare with: Precise if it supports the scene, else Box2D or another precision.
std::string second_engine(const Finding& finding) {
  for (const char* name : {"plumb-precise", "box2d", "plumb", "plumb-float"}) {
    if (name == finding.engine) continue;
    const reference::Backend& backend = reference::find_backend(name);
    if (backend.identity().available && unsupported(Engine(backend), finding.smallest).empty()) return name;
  }
  return "";
}

}  // namespace

void write_finding(const Finding& finding, const std::string& folder, const std::string& name) {
  make_folder(folder);
  const std::string path = folder + "/" + name;
  write_whole(path + ".json", to_json(finding) + "\n");
  // A crash has no motion to draw.
  if (finding.objection.law == "crash") return;
  std::vector<Shown> shown;
  for (const std::string& engine : {finding.engine, second_engine(finding)}) {
    if (engine.empty()) continue;
    try {
      shown.push_back(
          {engine, run(Engine(reference::find_backend(engine)), finding.smallest, {.seconds = 2})});
    } catch (const Error&) {  // an engine given by a command
    }
  }
  const std::string caption = fmt::format("{} | right: {} | plumb hunt --replay {}.json",
                                          finding.objection.what, finding.objection.right, name);
  write_whole(path + ".svg", picture(finding.smallest, shown, caption));
}

}  // namespace plumb::harness::hunt
