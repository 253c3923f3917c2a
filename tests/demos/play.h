#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "demos/core/registry.h"

/// Plays a demo as a player does, and reads off what one sees of it.
namespace plumb::demos {

inline void click(Demo& demo, Vec2d point) {
  demo.press(point);
  demo.release(point);
}

inline void pull(Demo& demo, Vec2d from, Vec2d to) {
  demo.press(from);
  demo.drag(to);
  demo.release(to);
}

inline void steps(Demo& demo, int count) {
  for (int i = 0; i < count; ++i) demo.step_once();
}

inline double figure(const Demo& demo, std::string_view name) {
  for (const Figure& each : demo.figures()) {
    if (each.name == name) return each.value;
  }
  ADD_FAILURE() << "no figure " << name;
  return 0;
}

/// The names of all demos, for tests of each.
inline std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const Entry& entry : all()) out.push_back(entry.about.name);
  return out;
}

class EveryDemo : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Demo> demo_ = make(GetParam());
};

/// The bodies of a name, in the order of their places.
inline std::vector<BodyId> bodies_called(const Demo& demo, std::string_view name) {
  std::vector<BodyId> out;
  for (const BodyId body : demo.world()->bodies()) {
    if (demo.world()->name(body) == name) out.push_back(body);
  }
  return out;
}
inline BodyId body_called(const Demo& demo, std::string_view name) {
  const std::vector<BodyId> all = bodies_called(demo, name);
  EXPECT_FALSE(all.empty()) << name;
  return all.empty() ? BodyId{} : all.front();
}

}  // namespace plumb::demos
