#include "demos/core/registry.h"
#include "demos/core/world_demo.h"

namespace plumb::demos {
namespace {

const About kAbout{"drop", "a box falls", "Drag the box."};

class Drop final : public WorldDemo {
 public:
  Drop() : WorldDemo(kAbout) {
    add_slider("gravity", "m/s^2", 0.0, 20.0, gravity_, "how fast falling speeds up");
    add_step_controls();
    restart();
  }
  std::vector<Figure> figures() const override { return {{"time", time(), "s"}}; }
  Aabb<double> view() const override { return {{-5, -1}, {5, 6}}; }

 private:
  WorldDefinition definition() const override { return {.gravity = {0, -gravity_}}; }
  void fill() override {
    world_.create_body({.type = BodyType::Static}, {.geometry = Box{10, 1}, .position = {0, -0.5}});
    world_.create_body({.position = {0, 5}}, {.geometry = Box{1, 1}});
  }
  void changed(std::string_view) override { world_.set_gravity({0, -gravity_}); }

  double gravity_ = 9.81;
};

const Register kEntry{100, kAbout, [] { return std::unique_ptr<Demo>(new Drop); }};

}  // namespace
}  // namespace plumb::demos
