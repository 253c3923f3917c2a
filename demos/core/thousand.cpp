#include <cmath>
#include <memory>

#include "demos/core/registry.h"
#include "demos/core/world_demo.h"

namespace plumb::demos {
namespace {

constexpr double kHalfWidth = 16, kHeight = 30;  // m, of the basin
constexpr double kSize = 0.7;                    // m, of the bodies
constexpr double kApart = 0.9;                   // m, initial distance
constexpr int kColumns = 32;

const About kAbout{"thousand", "a thousand circles, boxes and triangles rain into a basin",
                   "Drag any body. How long does a frame take?"};

class Thousand final : public WorldDemo {
 public:
  Thousand() : WorldDemo(kAbout) {
    add_slider("bodies", "", 100, 3000, count_, "how many; starts anew");
    add_slider("gravity", "m/s^2", 0.0, 20.0, gravity_, "how fast falling speeds up");
    add_step_controls();
    restart();
  }

  std::vector<Figure> figures() const override {
    const WorldCounts counts = world_.counts();
    return {{"time", time(), "s"},
            {"bodies", static_cast<double>(count_), ""},
            {"awake", static_cast<double>(counts.awake), ""},
            {"contacts", static_cast<double>(counts.touching), ""},
            {"kinetic energy", totals_of(world_).energy, "J"}};
  }

  Aabb<double> view() const override { return {{-kHalfWidth - 1, -1}, {kHalfWidth + 1, kHeight}}; }

 private:
  WorldDefinition definition() const override { return {.gravity = {0, -gravity_}}; }

  void fill() override {
    const auto wall = [](Vec2d middle, double width, double height, double angle = 0) {
      return ShapeDefinition{.geometry = Box{width, height}, .position = middle, .angle = angle};
    };
    const ShapeDefinition walls[] = {
        wall({0, -0.5}, 2 * kHalfWidth + 2, 1), wall({-kHalfWidth - 0.5, 60}, 1, 122),
        wall({kHalfWidth + 0.5, 60}, 1, 122), wall({-kHalfWidth + 2.3, 3}, 6, 0.5, -0.6),
        wall({kHalfWidth - 2.3, 3}, 6, 0.5, 0.6)};
    world_.create_body({.name = "basin", .type = BodyType::Static}, walls);
    for (int i = 0; i < count_; ++i) {
      const int column = i % kColumns, row = i / kColumns;
      const double shift = row % 2 == 0 ? -0.2 : 0.2;  // m
      const Vec2d place{(column - 0.5 * (kColumns - 1)) * kApart + shift, 6 + row * kApart};
      world_.create_body({.position = place}, {.geometry = form(i + row), .material = {.friction = 0.4}});
    }
  }

  static ShapeGeometry form(int i) {
    constexpr double kHalf = kSize / 2;
    if (i % 3 == 0) return Circle{kHalf};
    if (i % 3 == 1) return Box{kSize, kSize};
    return Polygon{.points = {{-kHalf, -kHalf / 2}, {kHalf, -kHalf / 2}, {0, kHalf}}};
  }

  void changed(std::string_view control) override {
    if (control == "bodies") return restart();
    world_.set_gravity({0, -gravity_});
  }

  int count_ = 1000;
  double gravity_ = 9.81;
};

const Register kEntry{6, kAbout, [] { return std::unique_ptr<Demo>(new Thousand); }};

}  // namespace
}  // namespace plumb::demos
