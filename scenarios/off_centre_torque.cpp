#include "scenarios/truth/pushes.h"

// Forces off the centre of mass accelerate and rotate a body; without torque its spin is constant. There is
// no gravity and no contact, so only r x F, the inertia, and the angle used within a step matter.
namespace plumb::scenarios::off_centre_torque {
namespace {
using namespace truth;

Problem build(std::string_view variant, int) {
  Scene scene = scene_of("off_centre_torque", variant, 0);
  if (variant == "corner_force") {
    scene.bodies = {free_box("box", 2, 1, 0.5, {0.5, -0.25})};
    scene.forces = {PointForce{"box", {-2, 2.5}, {0.5, 0.25}, Frame::World, 0, kPush}};
  } else if (variant ==
             "thin_and_square") {  // pushed alike: their centres move alike, the thin one turns faster
    scene.bodies = {free_box("thin", 2, 1, 0.05, {0, 4}), free_box("square", 2, 1, 1, {0, -4})};
    for (const char* name : {"thin", "square"})
      scene.forces.push_back(PointForce{name, {0.5, 2}, {0.5, 0}, Frame::World, 0, kPush});
  } else if (variant == "thruster") {
    scene.bodies = {free_box("rocket", 2, 1, 0.5, {0, 0})};
    scene.forces = {PointForce{"rocket", {4, 0}, {-0.5, -0.25}, Frame::Body}};
    return thrust(std::move(scene));
  } else {
    const double rate = variant == "spin_100" ? 100 : 1;
    scene.bodies = {thrown(free_box("still", 1, 1, 0.25, {0, 0}), {}, rate),
                    thrown(free_box("drifting", 2, 0.5, 0.5, {-1, 2}), {0.75, -0.5}, -rate)};
    return coasting(std::move(scene));
  }
  return pushed(std::move(scene));
}

const Register r{{"off_centre_torque",
                  "off-centre forces, a thruster, and pure spin",
                  {"corner_force", "thruster", "spin_1", "spin_100", "thin_and_square"},
                  {1},
                  false,
                  build}};

}  // namespace
}  // namespace plumb::scenarios::off_centre_torque
