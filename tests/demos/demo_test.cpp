#include "demos/core/demo.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "demos/core/source.h"
#include "engine/scene/error.h"
#include "engine/scene/json.h"
#include "engine/scene/validate.h"
#include "tests/demos/play.h"

// Checks that hold for every demo.
namespace plumb::demos {
namespace {

INSTANTIATE_TEST_SUITE_P(Demos, EveryDemo, testing::ValuesIn(names()),
                         [](const auto& each) { return each.param; });

// Clicks all over: some of them set something going.
void stir(Demo& demo) {
  const Aabb<double> view = demo.view();
  const Vec2d size = view.upper - view.lower;
  for (int i = 0; i < 63; ++i) {
    const Vec2d point = view.lower + Vec2d{(0.5 + i % 9) / 9 * size.x, (0.5 + i / 9) / 7 * size.y};
    demo.press(point);
    demo.release(point);
  }
}

// Frames of any length, even and uneven, take the same steps.
TEST_P(EveryDemo, SameOnAnyFrameRate) {
  constexpr int kSteps = 60;
  stir(*demo_);
  for (int i = 0; i < kSteps; ++i) demo_->step_once();
  const std::uint64_t expected = demo_->hash();
  const std::vector<std::vector<double>> frames = {
      {1.0 / 60}, {1.0 / 30}, {1.0 / 144}, {0.003, 0.031, 0.0, 0.017}};
  for (const std::vector<double>& pattern : frames) {
    const std::unique_ptr<Demo> other = make(GetParam());
    stir(*other);
    double passed = 0;
    for (std::size_t i = 0; i < 2000 && other->step_count() < kSteps; ++i) {
      const double left = (kSteps + 0.5) * other->dt() - passed;  // the last frame ends between two steps
      const double frame = std::min(pattern[i % pattern.size()], left);
      other->advance(frame);
      passed += frame;
    }
    EXPECT_EQ(other->step_count(), kSteps);
    EXPECT_EQ(other->hash(), expected) << "frames of " << pattern[0] << " s";
  }
}

TEST_P(EveryDemo, LongFramesDoNotPileUp) {
  const int most = static_cast<int>(Demo::kLongestFrame / demo_->dt()) + 1;
  EXPECT_LE(demo_->advance(10), most);
  EXPECT_LE(demo_->advance(1e-6), 1);
}

// A restored demo goes on as one that was never stopped.
TEST_P(EveryDemo, ComesBack) {
  stir(*demo_);
  for (int i = 0; i < 40; ++i) demo_->step_once();
  const std::vector<std::byte> saved = demo_->save();
  const std::uint64_t then = demo_->hash();
  for (int i = 0; i < 40; ++i) demo_->step_once();
  const std::uint64_t later = demo_->hash();
  EXPECT_NE(later, then);
  demo_->restore(saved);
  EXPECT_EQ(demo_->hash(), then);
  EXPECT_EQ(demo_->step_count(), 40);
  for (int i = 0; i < 40; ++i) demo_->step_once();
  EXPECT_EQ(demo_->hash(), later);
  const std::unique_ptr<Demo> other = make(GetParam());
  other->restore(saved);
  EXPECT_EQ(other->hash(), then);
  for (int i = 0; i < 40; ++i) other->step_once();
  EXPECT_EQ(other->hash(), later);
}

TEST_P(EveryDemo, RefusesDamagedBytes) {
  std::vector<std::byte> saved = demo_->save();
  for (int i = 0; i < 10; ++i) demo_->step_once();
  const std::uint64_t before = demo_->hash();
  for (std::size_t i = 0; i < saved.size(); i += 1 + saved.size() / 50) {
    std::vector<std::byte> damaged = saved;
    damaged[i] ^= std::byte{0x10};
    EXPECT_THROW(demo_->restore(damaged), Error) << "byte " << i;
  }
  saved.resize(saved.size() - 9);
  EXPECT_THROW(demo_->restore(saved), Error);
  EXPECT_THROW(demo_->restore({}), Error);
  EXPECT_EQ(demo_->hash(), before);
}

TEST_P(EveryDemo, Restarts) {
  const std::uint64_t start = demo_->hash();
  stir(*demo_);
  for (int i = 0; i < 30; ++i) demo_->step_once();
  EXPECT_NE(demo_->hash(), start);
  demo_->restart();
  EXPECT_EQ(demo_->hash(), start);
  EXPECT_EQ(demo_->time(), 0);
}

// Every control goes from end to end while the demo runs.
TEST_P(EveryDemo, ControlsMayBeSetAtAnyTime) {
  const std::vector<Control> controls = demo_->controls();
  EXPECT_FALSE(controls.empty());
  for (const Control& control : controls) {
    SCOPED_TRACE(control.name);
    EXPECT_FALSE(control.about.empty());
    EXPECT_LE(control.low, control.value);
    EXPECT_LE(control.value, control.high);
    for (const double value : {control.low, control.high, control.initial}) {
      demo_->set(control.name, value);
      EXPECT_EQ(demo_->control(control.name).value, value);
      for (int i = 0; i < 5; ++i) demo_->step_once();
    }
    EXPECT_THROW(demo_->set(control.name, control.high + 1), Error);
    EXPECT_THROW(demo_->set(control.name, std::nan("")), Error);
    EXPECT_THROW(demo_->set(control.name, "no such choice"), Error);
    EXPECT_EQ(demo_->control(control.name).value, control.initial);
  }
}

// A pointer that runs wild, and keys, harm nothing.
TEST_P(EveryDemo, BearsAnyInput) {
  const Aabb<double> view = demo_->view();
  const Vec2d size = view.upper - view.lower;
  std::uint32_t seed = 1;
  const auto random = [&] { return (seed = seed * 1664525u + 1013904223u) >> 8; };
  const auto point = [&] {
    const double x = random() % 1000 / 900.0 - 0.05;
    const double y = random() % 1000 / 900.0 - 0.05;
    return view.lower + Vec2d{x * size.x, y * size.y};
  };
  for (int i = 0; i < 60; ++i) {
    demo_->hover(point());
    demo_->press(point());
    for (int k = 0; k < 4; ++k) {
      demo_->drag(point());
      demo_->step_once();
    }
    demo_->release(point());
    for (const Key& key : demo_->about().keys) {
      if (random() % 8 == 0) demo_->key(key.key);
    }
    demo_->advance(0.02);
  }
  for (const Figure& figure : demo_->figures()) EXPECT_TRUE(std::isfinite(figure.value)) << figure.name;
}

// Drawn places are finite, and lie between the last two steps: at their ends it is one and the other.
class Counter : public DebugDraw {
 public:
  void polygon(std::span<const Vec2d> corners, double, DrawRole) override {
    for (const Vec2d corner : corners) add(corner);
  }
  void circle(Vec2d centre, double, Vec2d, DrawRole) override { add(centre); }
  void capsule(Vec2d start, Vec2d end, double, DrawRole) override { add(start), add(end); }
  void segment(Vec2d start, Vec2d end, DrawRole) override { add(start), add(end); }
  void point(Vec2d point, DrawRole) override { add(point); }
  void text(Vec2d point, std::string_view, DrawRole) override { add(point); }
  std::vector<Vec2d> points;

 private:
  void add(Vec2d point) {
    EXPECT_TRUE(std::isfinite(point.x) && std::isfinite(point.y));
    points.push_back(point);
  }
};

TEST_P(EveryDemo, DrawsItself) {
  stir(*demo_);
  for (int i = 0; i < 20; ++i) demo_->step_once();
  const DrawOptions everything{true, true, true, true, true, true, true, true};
  Counter all, shapes;
  demo_->draw(all, everything);
  demo_->draw(shapes);
  EXPECT_GT(shapes.points.size(), 4u);
  EXPECT_GE(all.points.size(), shapes.points.size());
  const Aabb<double> view = demo_->view();
  const auto inside = [&](Vec2d p) { return view.contains({p, p}); };
  EXPECT_GT(std::ranges::count_if(shapes.points, inside), 4);
}

TEST_P(EveryDemo, HasASceneThatIsValid) {
  steps(*demo_, 20);
  const std::optional<Scene> scene = demo_->scene();
  ASSERT_TRUE(scene.has_value());
  validate(*scene);
  EXPECT_EQ(scene_from_json(to_json(*scene)), *scene);
}

TEST_P(EveryDemo, ShowsItsCode) {
  if (GetParam() == "drop") GTEST_SKIP() << "its source is a test's";
  // Of a whole file a failure would print all.
  EXPECT_NE(source_of(GetParam()).find('"' + GetParam() + '"'), std::string_view::npos);
}

TEST_P(EveryDemo, SaysWhatItIs) {
  EXPECT_EQ(demo_->about().name, GetParam());
  EXPECT_FALSE(demo_->about().summary.empty());
  EXPECT_FALSE(demo_->about().play.empty());
  EXPECT_FALSE(demo_->figures().empty());
  // Keys that windows have for themselves.
  for (const Key& key : demo_->about().keys)
    EXPECT_EQ(std::string("por[]bs\t").find(key.key), std::string::npos);
}

TEST(Registry, NamesTheNearest) {
  try {
    make("bouncing_bal");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::Name);
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'bouncing_ball'"));
  }
}

TEST(Control, NamesTheNearest) {
  const std::unique_ptr<Demo> demo = make("bouncing_ball");
  try {
    demo->set("gravty", 1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("did you mean 'gravity'"));
  }
}

}  // namespace
}  // namespace plumb::demos
