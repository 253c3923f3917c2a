// Handles know when what they name is gone; misuse throws an error that says what was wrong.
#include <cstdio>

#include "engine/scene/error.h"
#include "engine/world/world.h"

int main() {
  using namespace plumb;
  World world;
  const BodyId old = world.create_body({.name = "crate", .user_data = 42}, {.geometry = Box{1, 1}});
  world.destroy(old);
  const BodyId next = world.create_body({.name = "barrel"}, {.geometry = Circle{0.5}});
  std::printf("same place: %s, old handle valid: %s, new one: %s\n", old.index == next.index ? "yes" : "no",
              world.valid(old) ? "yes" : "no", world.valid(next) ? "yes" : "no");
  try {
    world.apply_impulse(old, {1, 0});
  } catch (const Error& error) {
    std::printf("%s\n", error.what());
  }
  try {
    world.create_shape(next, {.geometry = Circle{-1}});
  } catch (const Error& error) {
    const bool value = error.kind() == Error::Kind::Value;
    std::printf("%s of a %s, %s: %s\n", error.field().c_str(), error.subject().c_str(),
                value ? "bad value" : "other", error.value().c_str());
  }
  return world.shapes(next).size() == 1 ? 0 : 1;  // nothing has changed
}
