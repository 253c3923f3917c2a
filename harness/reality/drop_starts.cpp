#include <algorithm>
#include <cmath>

#include "harness/reality/drops.h"

namespace plumb::harness::reality {
namespace {

/// m/s^2, measured to three digits at the place of the experiment.
constexpr double kGravity = 9.81;

/// Largest and smallest number of frames before the first impact from which a start is computed.
constexpr int kMostFrames = 8, kLeastFrames = 4;

/// m/s: an impact lies between two frames if the vertical velocity rises by at least this. Free fall lowers
/// it by 0.04 m/s; the slowest first impacts of these drops raise it by 1 m/s.
constexpr double kRise = 0.1;

/// Returns the last frame before the first impact's influence on the measured positions; -1 if there is none.
int last_free_frame(const std::vector<MeasuredPose>& frames) {
  const auto fall = [&](std::size_t i) {
    return (frames[i + 1].position.y - frames[i].position.y) * kFramesPerSecond;
  };
  for (std::size_t i = 1; i + 1 < frames.size(); ++i)
    if (fall(i) - fall(i - 1) > kRise) return static_cast<int>(i) - 1;  // frame i may be smoothed
  return -1;
}

/// Least squares line through values at times 0, -1, -2, ... frames: value and slope at time 0.
struct Line {
  double value = 0, slope = 0;
};

Line line_through(const std::vector<double>& values) {
  double st = 0, stt = 0, sv = 0, stv = 0;
  const double n = static_cast<double>(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = -static_cast<double>(i) / kFramesPerSecond;
    st += t;
    stt += t * t;
    sv += values[i];
    stv += t * values[i];
  }
  const double slope = (n * stv - st * sv) / (n * stt - st * st);
  return {(sv - slope * st) / n, slope};
}

}  // namespace

std::vector<DropStart> starts_of(std::span<const MeasuredDrop> drops) {
  std::vector<DropStart> out;
  for (const MeasuredDrop& drop : drops) {
    const int last = last_free_frame(drop.frames);
    const int count = std::min(last + 1, kMostFrames);
    if (count < kLeastFrames) continue;
    std::vector<double> x, y, angle;
    for (int i = 0; i < count; ++i) {
      const MeasuredPose& frame = drop.frames[static_cast<std::size_t>(last - i)];
      const double t = -i / kFramesPerSecond;
      x.push_back(frame.position.x);
      y.push_back(frame.position.y + kGravity * t * t / 2);
      angle.push_back(frame.angle);
    }
    const Line along_x = line_through(x), along_y = line_through(y), turned = line_through(angle);
    DropStart start{
        drop.number,
        {{along_x.value, along_y.value}, turned.value, {along_x.slope, along_y.slope}, turned.slope},
        {drop.frames.begin() + last, drop.frames.end()}};
    out.push_back(std::move(start));
  }
  return out;
}

Scene scene_of(const DropStart& start, const DropLaw& law, std::span<const double> values) {
  Scene scene;
  scene.name = "drop";
  scene.gravity = {0, -kGravity};
  Body floor{.name = "floor", .type = BodyType::Static, .position = {0, -0.5}};
  floor.shapes = {{.geometry = Box{20, 1}}};
  Body square{.name = "square",
              .position = start.state.position,
              .angle = start.state.angle,
              .velocity = start.state.velocity,
              .angular_velocity = start.state.angular_velocity};
  square.shapes = {{.geometry = Box{2 * values[0], 2 * values[0]}}};
  square.angle += values[2];
  square.inertia = values[3];  // of 1 kg
  scene.bodies = {floor, square};
  law.apply(scene, values);
  return scene;
}

const std::vector<DropLaw>& drop_laws() {
  static const std::vector<Parameter> simple{{"half side", "m", 0.03, 0.0003, 0.025, 0.035},
                                             {"delay", "s", 0, 0.001, -0.008, 0.008},
                                             {"angle offset", "rad", 0, 0.02, -0.1, 0.1},
                                             {"inertia / mass", "m^2", 6e-4, 5e-5, 2e-4, 1.2e-3},
                                             {"friction", "", 0.2, 0.05, 0, 1},
                                             {"restitution", "", 0.5, 0.1, 0, 1}};
  static const auto coefficients = [](Scene& scene, std::span<const double> values) {
    for (Body& body : scene.bodies) {
      for (Shape& shape : body.shapes) {
        shape.friction = values[4];
        // Sets only the restitution of the square: the maximum of two equal coefficients has no derivative by
        // one of them.
        shape.restitution = body.type == BodyType::Dynamic ? values[5] : 0;
      }
    }
  };
  static const auto with_rule = [](ImpactRule rule) {
    return [rule](Scene& scene, std::span<const double> values) {
      coefficients(scene, values);
      scene.contact_rules.impact = rule;
      if (values.size() > 6) scene.contact_rules.friction_after_stop = values[6];
    };
  };
  static const std::vector<Parameter> later = [] {
    std::vector<Parameter> out = simple;
    out.push_back({"friction after the stop", "", 0.9, 0.1, 0, 1});
    return out;
  }();
  // Friction is the geometric mean of two equal coefficients, so a change of one of them counts half.
  static const std::vector<std::vector<ScaledNumber>> numbers{
      {{"bodies.square.shapes.width", 2}, {"bodies.square.shapes.height", 2}},
      {},
      {{"bodies.square.angle"}},
      {{"bodies.square.inertia"}},
      {{"bodies.square.shapes.friction", 2}},
      {{"bodies.square.shapes.restitution"}}};
  static const std::vector<std::vector<ScaledNumber>> later_numbers = [] {
    auto out = numbers;
    out.push_back({{"contact_rules.friction_after_stop"}});
    return out;
  }();
  static const std::vector<DropLaw> laws{
      {"newton", "Newton's restitution, Coulomb's friction for the impulses", simple, coefficients, numbers},
      {"poisson", "Poisson's restitution by Routh's method", simple, with_rule(ImpactRule::Poisson), numbers},
      {"stronge", "Stronge's energetic restitution", simple, with_rule(ImpactRule::Stronge), numbers},
      {"stronge-later", "Stronge's, with less friction after the slip has stopped", later,
       with_rule(ImpactRule::Stronge), later_numbers}};
  return laws;
}

}  // namespace plumb::harness::reality
