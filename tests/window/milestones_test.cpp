// The course's milestones in the demos, played by a mouse: SDL's events go through the window to the demo.
// SDL's driver `dummy` shows nothing and needs no display, and frames of a sixtieth of a second make the runs
// repeatable.
#include <SDL.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "demos/core/registry.h"
#include "demos/window/run.h"

namespace plumb::window {
namespace {

constexpr int kWidth = 800, kHeight = 600;  // px
constexpr double kGravity = 9.81;

// Holds the deeds of the hand, by frame.
struct Plan {
  int frame = 0;
  std::multimap<int, std::function<void()>> deeds;
  std::function<void()> after_each;  // looks on
};

// Is asked to draw once a frame, and then moves the mouse: the window gets the events before the next frame.
class Hand final : public Companion {
 public:
  explicit Hand(std::shared_ptr<Plan> plan) : plan_(std::move(plan)) {}
  std::string about() const override { return ""; }
  std::vector<demos::Figure> figures(const demos::Demo&) override { return {}; }
  const std::vector<Ghost>& ghosts() const override { return none_; }
  void show_ghost(std::size_t, bool) override {}
  void draw(Painter&, const demos::Demo&) override {
    const auto [first, last] = plan_->deeds.equal_range(plan_->frame++);
    std::for_each(first, last, [](const auto& deed) { deed.second(); });
    if (plan_->after_each) plan_->after_each();
  }

 private:
  std::shared_ptr<Plan> plan_;
  std::vector<Ghost> none_;
};

class Milestones : public testing::Test {
 protected:
  void SetUp() override { setenv("SDL_VIDEODRIVER", "dummy", 1); }
  void TearDown() override { unsetenv("SDL_VIDEODRIVER"); }

  void open(const std::string& demo, const std::map<std::string, double>& controls = {}) {
    plan_ = std::make_shared<Plan>();
    player_ = std::make_unique<Player>(
        std::vector<Item>{{demo, "",
                           [&, demo] {
                             return Show{demos::make(demo), std::make_unique<Hand>(plan_)};
                           }}},
        0);
    player_->panel = false;
    player_->strict = true;
    for (const auto& [name, value] : controls) player_->demo().set(name, value);
    player_->restart();
  }
  void choose(const std::string& control, const std::string& choice) { player_->demo().set(control, choice); }

  void at(int frame, std::function<void()> deed) { plan_->deeds.emplace(frame, std::move(deed)); }
  void move(int frame, Vec2d point) {
    at(frame, [this, point] { send_motion(point); });
  }
  void press(int frame, Vec2d point) {
    at(frame, [this, point] { send_button(point, SDL_MOUSEBUTTONDOWN); });
  }
  void release(int frame, Vec2d point) {
    at(frame, [this, point] { send_button(point, SDL_MOUSEBUTTONUP); });
  }
  void click(int frame, Vec2d point) { press(frame, point), release(frame + 1, point); }
  // Drags from one point to another in so many frames, and lets go.
  void drag(int frame, Vec2d from, Vec2d to, int frames = 10, int held = 0) {
    press(frame, from);
    for (int i = 1; i <= frames; ++i) move(frame + i, from + (1.0 * i / frames) * (to - from));
    release(frame + frames + held + 1, to);
  }
  void key(int frame, char key) {
    at(frame, [key] {
      SDL_Event event{};
      event.type = SDL_TEXTINPUT;
      event.text.text[0] = key;
      SDL_PushEvent(&event);
    });
  }
  void each(std::function<void()> look) { plan_->after_each = std::move(look); }
  void run(int frames) {
    run_in_window(*player_, {.width = kWidth, .height = kHeight, .measured_frames = frames});
  }

  const demos::Demo& demo() const { return player_->demo(); }
  const demos::DemoWorld& world() const { return *demo().world(); }
  double figure(const std::string& name) const {
    for (const demos::Figure& each : demo().figures())
      if (each.name == name) return each.value;
    ADD_FAILURE() << name;
    return 0;
  }
  std::vector<BodyId> bodies(const std::string& name) const {
    std::vector<BodyId> out;
    for (const BodyId body : world().bodies())
      if (world().name(body) == name) out.push_back(body);
    return out;
  }
  BodyId box_at(Vec2d place) const {
    for (const BodyId body : world().bodies())
      if (world().mass(body) > 0 && length_squared(world().position(body) - place) < 0.01) return body;
    ADD_FAILURE() << place.x << ", " << place.y;
    return {};
  }
  demos::Moving ball() const { return demo().moving().at(0); }
  double pixel() const { return 1 / player_->camera.scale(); }  // m

  std::unique_ptr<Player> player_;
  std::shared_ptr<Plan> plan_;

 private:
  // The nearest pixel, as a mouse has it.
  std::pair<int, int> pixel_of(Vec2d point) const {
    const Vec2d pixel = player_->camera.to_pixel(point);
    return {static_cast<int>(std::lround(pixel.x)), static_cast<int>(std::lround(pixel.y))};
  }
  void send_motion(Vec2d point) const {
    SDL_Event event{};
    event.type = SDL_MOUSEMOTION;
    std::tie(event.motion.x, event.motion.y) = pixel_of(point);
    SDL_PushEvent(&event);
  }
  void send_button(Vec2d point, Uint32 type) const {
    send_motion(point);
    SDL_Event event{};
    event.type = type;
    event.button.button = SDL_BUTTON_LEFT;
    event.button.state = type == SDL_MOUSEBUTTONDOWN ? SDL_PRESSED : SDL_RELEASED;
    std::tie(event.button.x, event.button.y) = pixel_of(point);
    SDL_PushEvent(&event);
  }
};

using BallByMouse = Milestones;
using CannonByMouse = Milestones;
using PoolByMouse = Milestones;
using BoxesByMouse = Milestones;
using RagdollByMouse = Milestones;

// --- 1. A bouncing ball
// ---------------------------------------------------------------------------------------

TEST_F(BallByMouse, AClickMovesItAndItFallsFasterAndFaster) {
  open("bouncing_ball", {{"damping", 0}});
  click(1, {4, 5});
  std::vector<double> speeds;
  Vec2d there{};
  each([&] {
    if (plan_->frame == 3) there = ball().centre;
    if (plan_->frame > 5 && plan_->frame < 40) speeds.push_back(-ball().velocity.y);
  });
  run(60);
  EXPECT_NEAR(there.x, 4, pixel());
  EXPECT_NEAR(there.y, 5, pixel());
  for (std::size_t i = 1; i < speeds.size(); ++i) EXPECT_NEAR(speeds[i] - speeds[i - 1], kGravity / 60, 1e-9);
}

// A step in flight changes the energy of 1 kg by +(g h)^2/2 with explicit Euler and by -(g h)^2/2 with
// semi-implicit Euler: height changes by the velocity of one end of the step, and kinetic energy by the mean
// of both ends. Verlet takes the mean, and keeps the energy.
TEST_F(BallByMouse, EachSchemeGainsLosesOrKeepsEnergyAsItMust) {
  constexpr double kStep = 0.02, kShare = kGravity * kGravity * kStep * kStep / 2;  // s, J
  const double due[] = {kShare, -kShare, 0};
  for (int scheme = 0; scheme < 3; ++scheme) {
    open("bouncing_ball",
         {{"damping", 0}, {"restitution", 1}, {"dt", kStep}, {"integrator", static_cast<double>(scheme)}});
    click(1, {4, 5});
    std::vector<std::pair<std::uint64_t, double>> seen;  // steps, energy
    each([&] {
      if (plan_->frame > 5 && plan_->frame < 50) seen.emplace_back(demo().step_count(), figure("energy"));
    });
    run(60);
    ASSERT_GT(seen.back().first, seen.front().first + 30);
    for (const auto& [steps, energy] : seen) {
      const double n = static_cast<double>(steps - seen.front().first);
      EXPECT_NEAR(energy - seen.front().second, n * due[scheme], 1e-9) << scheme << ", " << n;
    }
  }
}

TEST_F(BallByMouse, ThrownItBouncesOffAllFourEdges) {
  open("bouncing_ball", {{"damping", 0}, {"gravity", 0}, {"restitution", 1}});
  drag(1, {2, 2}, {4, 3.3}, 12);
  double left = 9, right = 0, low = 9, high = 0, speed = 0;
  each([&] {
    if (plan_->frame < 18) return;
    const Vec2d at = ball().centre;
    left = std::min(left, at.x), right = std::max(right, at.x);
    low = std::min(low, at.y), high = std::max(high, at.y);
    speed = std::sqrt(length_squared(ball().velocity));
  });
  run(400);
  EXPECT_GT(speed, 3);
  const double step = speed / 60;  // m, the most that it may be away from a wall in the frame nearest to it
  EXPECT_NEAR(left, 0.3, step);
  EXPECT_NEAR(right, 7.7, step);
  EXPECT_NEAR(low, 0.3, step);
  EXPECT_NEAR(high, 5.7, step);
}

// From rest at h it rises to e^2 h.
TEST_F(BallByMouse, RestitutionReturnsItsShareOfTheHeight) {
  for (const double e : {0.25, 0.5, 1.0}) {
    open("bouncing_ball", {{"damping", 0}, {"restitution", e}});
    click(1, {4, 4.3});
    double risen = 0;
    bool bounced = false;
    each([&] {
      if (plan_->frame < 5) return;
      bounced = bounced || ball().velocity.y > 0;
      if (bounced && ball().velocity.y > 0) risen = std::max(risen, ball().centre.y - 0.3);
    });
    run(1 + 60 * 2);
    EXPECT_NEAR(risen, e * e * 4, 0.03 * 4 + pixel()) << e;
  }
}

TEST_F(BallByMouse, ItSettlesWithDamping) {
  open("bouncing_ball", {{"damping", 1}, {"restitution", 0.6}});
  drag(1, {2, 2}, {5, 4});
  run(60 * 10);
  EXPECT_LT(figure("kinetic energy"), 1e-3);
  EXPECT_NEAR(ball().centre.y, 0.3, 0.01);
}

// Frames of another length take the same steps.
TEST_F(BallByMouse, TheSameOnAnyFrameRate) {
  std::vector<std::uint64_t> hashes;
  for (const double frame : {1.0 / 30, 1.0 / 60, 1.0 / 144}) {
    open("bouncing_ball");
    while (demo().step_count() < 120)
      player_->advance(std::min(frame, (120.5 - static_cast<double>(demo().step_count())) / 60));
    hashes.push_back(demo().hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

// --- 2. Cannonballs
// -------------------------------------------------------------------------------------------

TEST_F(CannonByMouse, TenTimesTheMassATenthOfTheSpeed) {
  for (const char* by : {"force", "impulse"}) {
    open("cannonballs", {{"gravity", 0}});
    choose("fired by", by);
    key(1, '3');
    click(3, {12, 9});
    run(40);
    const auto speed = [&](const char* name) {
      return std::sqrt(length_squared(world().velocity(bodies(name).at(0))));
    };
    EXPECT_GT(speed("light"), 10);
    EXPECT_NEAR(speed("light") / speed("heavy"), 10, 1e-4) << by;
  }
}

// Weight and wind add up: after t of flight v = (F/m, -g) t; the wind acts on 1 kg as ten times on 10 kg,
// gravity on both alike.
TEST_F(CannonByMouse, ForcesAddUpAndAllFallAlike) {
  open("cannonballs", {{"impulse", 0}, {"wind", 5}});
  key(1, '3');
  click(3, {12, 12});
  run(20);
  const Vec2d light = world().velocity(bodies("light").at(0)),
              heavy = world().velocity(bodies("heavy").at(0));
  EXPECT_LT(light.y, -1);
  EXPECT_NEAR(light.y, heavy.y, 1e-5);
  EXPECT_NEAR(light.x / light.y, 5 / -kGravity, 1e-4);
  EXPECT_NEAR(heavy.x / heavy.y, 0.5 / -kGravity, 1e-4);
}

TEST_F(CannonByMouse, AClickFiresTowardsThePointer) {
  for (const Vec2d target : {Vec2d{12, 9}, Vec2d{20, 3}, Vec2d{3, 14}}) {
    open("cannonballs", {{"gravity", 0}});
    key(1, '1');
    click(3, target);
    run(8);
    const Vec2d v = world().velocity(bodies("light").at(0)), way = target - Vec2d{1, 1.5};
    const double sine = cross(v, way) / std::sqrt(length_squared(v) * length_squared(way));
    EXPECT_NEAR(sine, 0, 1.5 * pixel() / std::sqrt(length_squared(way)));
    EXPECT_GT(dot(v, way), 0);
  }
}

// --- 3. Circles that collide
// ----------------------------------------------------------------------------------

// Counts highlighted circles.
struct Lights : DebugDraw {
  int count = 0;
  void polygon(std::span<const Vec2d>, double, DrawRole) override {}
  void circle(Vec2d, double, Vec2d, DrawRole role) override { count += role == DrawRole::Highlight ? 1 : 0; }
  void capsule(Vec2d, Vec2d, double, DrawRole) override {}
  void segment(Vec2d, Vec2d, DrawRole) override {}
  void point(Vec2d, DrawRole) override {}
  void text(Vec2d, std::string_view, DrawRole) override {}
};

// Head-on with masses m1, m2: v1' = (m1 - e m2)/(m1 + m2) v, v2' = (1 + e) m1/(m1 + m2) v; the two light up.
TEST_F(PoolByMouse, ShotHeadOnTheyBounceByMassAndRestitution) {
  constexpr double kMass = 0.17;
  for (const double cue : {kMass, 10 * kMass}) {
    for (const double e : {0.0, 0.5, 1.0}) {
      open("pool_break", {{"balls", 1}, {"cloth", 0}, {"restitution", e}, {"pockets", 0}});
      // `m` goes on from 0.17 kg to 1.7 kg.
      if (cue > kMass) key(1, 'm');
      drag(3, {-0.6, 0}, {-0.4, 0}, 4);
      double before = 0, cue_after = 0, ball_after = 0;
      int lit = 0;
      bool over = false;
      each([&] {
        const double v = world().velocity(bodies("cue").at(0)).x;
        if (figure("collisions") == 0) before = v;
        if (figure("collisions") > 0 && !over) {
          over = true;
          cue_after = v, ball_after = world().velocity(bodies("1").at(0)).x;
        }
        Lights lights;
        demo().draw(lights);
        lit = std::max(lit, lights.count);
      });
      run(70);
      EXPECT_GE(figure("collisions"), 1);
      EXPECT_EQ(lit, 2);
      EXPECT_GT(before, 1);
      const double m1 = cue, m2 = kMass;
      EXPECT_NEAR(cue_after, (m1 - e * m2) / (m1 + m2) * before, 1e-3 * before);
      EXPECT_NEAR(ball_after, (1 + e) * m1 / (m1 + m2) * before, 1e-3 * before);
    }
  }
}

// Until a ball meets a cushion the break keeps the shot's momentum.
TEST_F(PoolByMouse, TheBreakScattersAndKeepsItsMomentum) {
  open("pool_break", {{"cloth", 0}, {"pockets", 0}});
  std::vector<Vec2d> start;
  for (int i = 1; i <= 15; ++i) start.push_back(world().position(bodies(std::to_string(i)).at(0)));
  drag(3, {-0.6, 0}, {0.5, 0}, 4);
  double shot = 0, after = 0;
  bool at_cushion = false;
  each([&] {
    if (figure("collisions") == 0) shot = figure("momentum x");
    double farthest = 0;
    for (const BodyId body : world().bodies())
      if (world().mass(body) > 0) farthest = std::max(farthest, std::abs(world().position(body).x));
    // A frame later the fastest may have met the cushion at 1.24 m.
    at_cushion = at_cushion || farthest > 1.05;
    if (figure("collisions") > 0 && !at_cushion) after = figure("momentum x");
  });
  run(150);
  EXPECT_GT(shot, 0.5);
  EXPECT_NEAR(after, shot, 1e-4 * shot);
  int scattered = 0;
  for (int i = 1; i <= 15; ++i) {
    const Vec2d moved =
        world().position(bodies(std::to_string(i)).at(0)) - start[static_cast<std::size_t>(i - 1)];
    scattered += length_squared(moved) > 0.1 * 0.1 ? 1 : 0;
  }
  EXPECT_GE(scattered, 12);
}

// --- 4. Rotation and boxes
// ------------------------------------------------------------------------------------

constexpr Vec2d kSquare{-3, 0}, kThin{2, 0}, kShortThin{4.9, 0};

TEST_F(BoxesByMouse, APushInTheMiddleDoesNotSpinOneAtACornerDoes) {
  open("spinning_boxes");
  const BodyId still = box_at(kSquare), spun = box_at({-3, -2.5});
  click(1, kSquare);
  click(3, Vec2d{-3, -2.5} + Vec2d{0.46, 0.46});
  run(12);
  EXPECT_GT(world().velocity(still).y, 1);
  EXPECT_EQ(world().angular_velocity(still), 0);
  EXPECT_GT(world().angular_velocity(spun), 1);
}

// The same push, half a metre from the middle of a square and of a thin box of the same mass and long side,
// and a metre from that of a thin one of the same area: w = r F t / I, within what the arm loses as it turns.
TEST_F(BoxesByMouse, AThinBoxIsEasierToSpinThanASquareOfItsLongSide) {
  open("spinning_boxes", {{"push", 5}});
  const BodyId square = box_at(kSquare), thin = box_at(kThin), short_thin = box_at(kShortThin);
  click(1, kSquare + Vec2d{0.46, 0.46});
  click(4, kThin + Vec2d{0.96, 0.1});
  click(7, kShortThin + Vec2d{0.46, 0.1});
  run(20);
  const double w = world().angular_velocity(square);
  EXPECT_NEAR(w, 0.5 * 5 * 0.1 * 6, 0.15);
  EXPECT_NEAR(world().angular_velocity(short_thin) / w, 2 / 1.0625, 0.1);
  EXPECT_NEAR(world().angular_velocity(thin) / 2 / w, 2 / 4.0625, 0.05);
}

// Boxes that do not turn collide along one axis: (1 - e)/2 and (1 + e)/2 of the speed, off-centre too.
TEST_F(BoxesByMouse, BoxesThatDoNotTurnBounceAlongOneAxis) {
  open("spinning_boxes", {{"restitution", 0.5}, {"friction", 0}});
  choose("rotation", "along the axes");
  click(1, {-1, 0.6});
  drag(4, kSquare, {-2, 0}, 5);
  run(80);
  const BodyId square = bodies("square").at(1);
  double struck = 0;
  for (const BodyId body : bodies("square")) struck = std::max(struck, world().velocity(body).x);
  EXPECT_NEAR(world().velocity(square).x, 0.25 * 2, 1e-4);
  EXPECT_NEAR(struck, 0.75 * 2, 1e-4);
  for (const BodyId body : world().bodies()) EXPECT_EQ(world().angle(body), 0);
}

TEST_F(BoxesByMouse, BoxesThatTurnSpinWhenTheyHitOffCentre) {
  open("spinning_boxes", {{"restitution", 0.5}, {"friction", 0}});
  click(1, {-1, 0.6});
  drag(4, kSquare, {-2, 0}, 5);
  run(80);
  int spinning = 0;
  Vec2d momentum{};
  for (const BodyId body : bodies("square")) {
    spinning += std::abs(world().angular_velocity(body)) > 0.1 ? 1 : 0;
    momentum += world().mass(body) * world().velocity(body);
  }
  EXPECT_EQ(spinning, 2);
  EXPECT_NEAR(momentum.x, 2, 1e-4);
}

// --- 5. Constraints and a ragdoll
// -----------------------------------------------------------------------------

constexpr Vec2d kHook{-2.2, 5.5};
constexpr double kLink = 0.3;

TEST_F(RagdollByMouse, CirclesOfTheChainKeepTheirDistanceAndSwing) {
  open("ragdoll");
  const Vec2d end = kHook - Vec2d{0, 10 * kLink};
  drag(1, end, end + Vec2d{0.9, 0.4}, 20, 30);
  double worst = 0;
  int crossings = 0;
  double before = 0;
  each([&] {
    Vec2d last = kHook;
    for (const BodyId bead : bodies("chain")) {
      const Vec2d here = world().centre(bead);
      worst = std::max(worst, std::abs(std::sqrt(length_squared(here - last)) - kLink));
      last = here;
    }
    const double aside = last.x - kHook.x;
    if (plan_->frame > 60 && aside * before < 0) ++crossings;
    before = aside;
  });
  run(60 * 9);
  EXPECT_LT(worst, 0.02);  // m, as Ragdoll's own test of this chain
  // The slowest swing has a period of 3 s (EitherWay.AChainSwingsLikeARope).
  EXPECT_GE(crossings, 4);
  EXPECT_LE(crossings, 8);
}

TEST_F(RagdollByMouse, TheFigureHoldsItsShapeWhenDragged) {
  open("ragdoll");
  const Vec2d torso{1.5, 5.3};
  key(0, 'p');
  press(1, torso);
  key(2, 'p');
  for (int i = 0; i < 120; ++i)
    move(3 + i, torso + Vec2d{-1.2 * std::sin(0.05 * i), 0.4 * std::sin(0.1 * i)});
  double widest = 0, farthest = 0;
  each([&] {
    widest = std::max(widest, figure("widest gap of a joint"));
    const Vec2d away = world().centre(bodies("torso").at(0)) - torso;
    farthest = std::max(farthest, std::sqrt(length_squared(away)));
  });
  run(125);
  EXPECT_LT(widest, 10);  // mm
  EXPECT_GT(farthest, 0.7);
  EXPECT_LT(farthest, 2);
}

TEST_F(RagdollByMouse, ItTumblesWhenDroppedAndFliesWhenFlung) {
  open("ragdoll");
  const Vec2d torso{1.5, 5.3};
  key(0, 'p');
  press(1, torso);
  key(2, 'p');
  for (int i = 0; i <= 30; ++i) move(3 + i, torso + Vec2d{-0.06 * i, 0.01 * i});
  release(34, torso + Vec2d{-1.8, 0.3});
  double flung = 0, least = 9;
  each([&] {
    if (plan_->frame == 37) flung = world().velocity(bodies("torso").at(0)).x;
    if (plan_->frame > 40)
      least =
          std::min(least, world().centre(bodies("head").at(0)).y - world().centre(bodies("shin").at(0)).y);
  });
  run(60 * 9);
  EXPECT_LT(flung, -1.5);  // the hand moves at -3.6 m/s, and arms and legs hang behind
  EXPECT_LT(least, 0.5);   // it turned over
  EXPECT_LT(world().centre(bodies("torso").at(0)).y, 2);
  EXPECT_LT(length_squared(world().velocity(bodies("torso").at(0))), 1);
}

}  // namespace
}  // namespace plumb::window
