// Prints the hash of every demo's state after 1000 steps, untouched and played, and of every scenario.
// play.mjs plays the same in the program that was compiled for a browser.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "demos/core/registry.h"
#include "demos/core/view_scene.h"
#include "engine/world/add_scene.h"
#include "scenarios/scenario.h"

namespace {

using plumb::Vec2d;
using plumb::demos::Control;
using plumb::demos::Demo;

void print(const std::string& name, const Demo& demo, const char* how, int step) {
  std::printf("%s %s %d %016llx\n", name.c_str(), how, step, static_cast<unsigned long long>(demo.hash()));
}

// A point of the view by its share of width and height.
Vec2d at(const Demo& demo, double across, double up) {
  const plumb::Aabb<double> view = demo.view();
  return {view.lower.x + across * (view.upper.x - view.lower.x),
          view.lower.y + up * (view.upper.y - view.lower.y)};
}

double another(const Control& control) {
  if (control.kind == Control::Kind::Switch) return 1 - control.value;
  if (control.kind == Control::Kind::Choice) return control.high;
  const double value = control.low + 0.4 * (control.high - control.low);
  return control.whole ? std::floor(value) : value;
}

// Actions before a step.
void play(Demo& demo, int step) {
  if (step == 100) demo.press(at(demo, 0.5, 0.6));
  if (step > 100 && step < 160) demo.drag(at(demo, 0.5 + 0.005 * (step - 100), 0.6));
  if (step == 160) demo.release(at(demo, 0.8, 0.6));
  if (step == 200) demo.hover(at(demo, 0.3, 0.7));
  const auto& keys = demo.about().keys;
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (step == 300 + 20 * static_cast<int>(i)) demo.key(keys[i].key);
  for (std::size_t i = 0; i < demo.controls().size(); ++i) {
    const Control control = demo.controls()[i];
    if (step == 500 + 10 * static_cast<int>(i)) demo.set(control.name, another(control));
  }
  if (step == 700) demo.press(at(demo, 0.4, 0.5));
  if (step == 720) demo.release(at(demo, 0.2, 0.5));
}

}  // namespace

int main() {
  for (const plumb::demos::Entry& entry : plumb::demos::all()) {
    const auto untouched = entry.make(), played = entry.make();
    for (int step = 0; step < 1000; ++step) untouched->step_once();
    print(entry.about.name, *untouched, "untouched", 1000);
    for (int step = 0; step < 1000; ++step) {
      play(*played, step);
      played->step_once();
      if (step % 100 == 99) print(entry.about.name, *played, "played", step + 1);
    }
  }
  for (const plumb::scenarios::Scenario& scenario : plumb::scenarios::all()) {
    for (const plumb::scenarios::Instance& instance : plumb::scenarios::select(scenario.name)) {
      const plumb::Scene scene = instance.build().scene;
      if (!plumb::world_unsupported(scene).empty()) continue;
      plumb::demos::SceneDemo demo(scene, "");
      for (int step = 0; step < 1000; ++step) demo.step_once();
      print(instance.label(), demo, "untouched", 1000);
    }
  }
}
