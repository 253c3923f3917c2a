// Functions called from JavaScript. Texts and bytes pass through one buffer in each direction. Arguments are
// written to the address that `argument(size)` returns. Answers are at `answer()`, with `answer_size()`
// bytes, until the next call.
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "demos/core/registry.h"
#include "demos/core/source.h"
#include "demos/web/command_buffer.h"
#include "demos/web/json_text.h"
#include "demos/web/viewer.h"
#include "engine/scene/json.h"
#include "engine/world/add_scene.h"

namespace plumb::web {
namespace {

using demos::Control;
using demos::Demo;

std::vector<char> given, answered;
CommandBuffer commands;
std::unique_ptr<Demo> played;
std::unique_ptr<Viewer> viewer;  // set if a scenario is open
Demo* demo = nullptr;            // the open demo or scenario

std::string_view text_of(std::size_t size) { return {given.data(), size}; }

void answer_with(const std::string& text) { answered.assign(text.begin(), text.end()); }

std::string keys_of(const demos::About& about) {
  JsonList keys;
  for (const demos::Key& key : about.keys)
    keys.add(JsonObject().add("key", std::string(1, key.key)).add("about", key.about).text());
  return keys.text();
}

std::string text_of(const Control& control) {
  JsonList choices;
  for (const std::string& choice : control.choices) choices.add(json_text(choice));
  constexpr const char* kKinds[] = {"slider", "choice", "switch"};
  return JsonObject()
      .add("name", control.name)
      .add("kind", kKinds[static_cast<int>(control.kind)])
      .add("unit", control.unit)
      .add("low", control.low)
      .add("high", control.high)
      .add("whole", control.whole ? 1.0 : 0.0)
      .add("value", control.value)
      .add("about", control.about)
      .add_json("choices", choices.text())
      .text();
}

}  // namespace
}  // namespace plumb::web

using namespace plumb::web;

#define PLUMB_EXPORT(name) __attribute__((export_name(name)))

extern "C" {

PLUMB_EXPORT("argument") char* plumb_argument(std::size_t size) {
  given.resize(size);
  return given.data();
}
PLUMB_EXPORT("answer") const char* plumb_answer() { return answered.data(); }
PLUMB_EXPORT("answer_size") std::size_t plumb_answer_size() { return answered.size(); }

/// Lists all demos and then the scenarios that a world can run, as JSON.
PLUMB_EXPORT("list") void plumb_list() {
  JsonList list;
  for (const plumb::demos::Entry& entry : plumb::demos::all()) {
    list.add(JsonObject()
                 .add("kind", std::string("demo"))
                 .add("name", entry.about.name)
                 .add("summary", entry.about.summary)
                 .add("play", entry.about.play)
                 .add_json("keys", keys_of(entry.about))
                 .text());
  }
  for (const plumb::scenarios::Scenario& scenario : plumb::scenarios::all()) {
    for (const plumb::scenarios::Instance& instance : plumb::scenarios::select(scenario.name)) {
      // Few scenes have rules that no world supports.
      if (!plumb::world_unsupported(instance.build().scene).empty()) continue;
      list.add(
          JsonObject()
              .add("kind", std::string("scene"))
              .add("name", instance.label())
              .add("summary", scenario.summary)
              .add("play", plumb::demos::sentence_of(scenario.summary) + " Drag bodies with the pointer.")
              .add_json("keys", JsonList().text())
              .text());
    }
  }
  answer_with(list.text());
}

/// Opens the demo or scenario with the given name and closes the one before; all functions below refer to it.
PLUMB_EXPORT("open") void plumb_open(std::size_t size) {
  const std::string_view name = text_of(size);
  for (const plumb::scenarios::Scenario& scenario : plumb::scenarios::all()) {
    for (const plumb::scenarios::Instance& instance : plumb::scenarios::select(scenario.name)) {
      if (instance.label() != name) continue;
      viewer = std::make_unique<Viewer>(instance);
      demo = &viewer->demo();
      played.reset();
      return;
    }
  }
  played = plumb::demos::make(name);
  demo = played.get();
  viewer.reset();
}

/// Lists the motions that can be drawn over a scenario; empty for a demo.
PLUMB_EXPORT("ghosts") void plumb_ghosts() {
  JsonList list;
  if (viewer) {
    for (const Viewer::Ghost& ghost : viewer->ghosts()) {
      list.add(JsonObject()
                   .add("name", ghost.name)
                   .add("shown", ghost.shown ? 1.0 : 0.0)
                   .add("remark", ghost.remark)
                   .text());
    }
  }
  answer_with(list.text());
}
PLUMB_EXPORT("show_ghost") void plumb_show_ghost(std::size_t ghost, int shown) {
  if (viewer) viewer->show(ghost, shown != 0);
}

PLUMB_EXPORT("controls") void plumb_controls() {
  JsonList list;
  for (const Control& control : demo->controls()) list.add(text_of(control));
  answer_with(list.text());
}
/// Sets the control with the given name.
PLUMB_EXPORT("set") void plumb_set(std::size_t size, double value) { demo->set(text_of(size), value); }

PLUMB_EXPORT("press") void plumb_press(double x, double y) { demo->press({x, y}); }
PLUMB_EXPORT("drag") void plumb_drag(double x, double y) { demo->drag({x, y}); }
PLUMB_EXPORT("release") void plumb_release(double x, double y) { demo->release({x, y}); }
PLUMB_EXPORT("hover") void plumb_hover(double x, double y) { demo->hover({x, y}); }
PLUMB_EXPORT("key") void plumb_key(int key) { demo->key(static_cast<char>(key)); }

PLUMB_EXPORT("advance") int plumb_advance(double seconds) { return demo->advance(seconds); }
PLUMB_EXPORT("step") void plumb_step() { demo->step_once(); }
PLUMB_EXPORT("restart") void plumb_restart() { demo->restart(); }
PLUMB_EXPORT("time") double plumb_time() { return demo->time(); }
PLUMB_EXPORT("hash") std::uint64_t plumb_hash() { return demo->hash(); }

PLUMB_EXPORT("figures") void plumb_figures() {
  JsonList list;
  for (const plumb::demos::Figure& figure : viewer ? viewer->figures() : demo->figures()) {
    list.add(JsonObject()
                 .add("name", std::string(figure.name))
                 .add("value", figure.value)
                 .add("unit", std::string(figure.unit))
                 .text());
  }
  answer_with(list.text());
}

/// Returns [left, lower, right, upper], m, of the part of the world to show now.
PLUMB_EXPORT("view") void plumb_view() {
  const plumb::Aabb<double> view = demo->shown();
  JsonList list;
  for (const double edge : {view.lower.x, view.lower.y, view.upper.x, view.upper.y})
    list.add(json_text(edge));
  answer_with(list.text());
}

/// Fills the buffer of commands, which command_buffer.h describes, and returns its address. `shown` has one
/// bit each for contacts, normals, impulses, boxes, centres, joints, names, velocities, forces, masses.
/// `impulse_length` is the length of an impulse's line, m per N s; `arrow_length` is the length of arrows
/// relative to the usual one.
PLUMB_EXPORT("draw") const double* plumb_draw(unsigned shown, double impulse_length, double arrow_length) {
  const auto bit = [&](int place) { return (shown >> place & 1u) != 0; };
  commands.clear();
  demo->draw(commands, {.joints = bit(5),
                        .contacts = bit(0),
                        .normals = bit(1),
                        .impulses = bit(2),
                        .boxes = bit(3),
                        .centres = bit(4),
                        .names = bit(6),
                        .impulse_length = impulse_length});
  demo->draw_motion(commands,
                    {.velocities = bit(7), .forces = bit(8), .masses = bit(9), .length = arrow_length});
  if (viewer) viewer->draw(commands);
  answer_with(commands.words());
  return commands.numbers().data();
}
/// Returns the number of numbers in the commands; their texts are in the answer.
PLUMB_EXPORT("draw_size") std::size_t plumb_draw_size() { return commands.numbers().size(); }

/// Answers with the C++ of the open demo; empty for a scenario.
PLUMB_EXPORT("code") void plumb_code() {
  answer_with(std::string(plumb::demos::source_of(demo->about().name)));
}
/// Answers with the present state as a scene (JSON).
PLUMB_EXPORT("scene") void plumb_scene() {
  const std::optional<plumb::Scene> scene = demo->scene();
  answer_with(scene ? plumb::to_json(*scene) : "");
}

PLUMB_EXPORT("save") void plumb_save() {
  const std::vector<std::byte> bytes = demo->save();
  const char* first = reinterpret_cast<const char*>(bytes.data());
  answered.assign(first, first + bytes.size());
}
PLUMB_EXPORT("restore") void plumb_restore(std::size_t size) {
  demo->restore(std::as_bytes(std::span(given.data(), size)));
}
}
