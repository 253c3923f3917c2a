#include "demos/core/demo.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "demos/core/arrow.h"
#include "engine/core/suggest.h"
#include "engine/core/text.h"
#include "engine/scene/error.h"
#include "engine/world/checksum.h"

namespace plumb::demos {
namespace {

std::string subject_of(const Control& control) { return "control " + quoted(control.name); }

double value_of(const std::variant<double*, int*, bool*>& target) {
  return std::visit([](const auto* member) { return static_cast<double>(*member); }, target);
}

// Throws unless the control accepts the value.
void check(const Control& control, double value) {
  const bool in_range = value >= control.low && value <= control.high;
  const bool whole = !control.whole || value == std::floor(value);
  if (in_range && whole) return;
  throw Error(Error::Kind::Value, subject_of(control), "value", shortest(value),
              std::string("must be ") + (control.whole ? "a whole number" : "a number") + " from " +
                  shortest(control.low) + " to " + shortest(control.high));
}

}  // namespace

std::string sentence_of(std::string_view summary) {
  if (summary.empty()) return {};
  std::string out(summary);
  if (out.front() >= 'a' && out.front() <= 'z') out.front() = static_cast<char>(out.front() - 'a' + 'A');
  return out + ".";
}

void Demo::add(Control control, Target target) {
  control.value = control.initial = value_of(target);
  controls_.push_back(std::move(control));
  targets_.push_back(target);
}

void Demo::add_slider(std::string name, std::string unit, double low, double high, double& target,
                      std::string about) {
  add({.name = std::move(name), .unit = std::move(unit), .low = low, .high = high, .about = std::move(about)},
      &target);
}

void Demo::add_slider(std::string name, std::string unit, int low, int high, int& target, std::string about) {
  add({.name = std::move(name),
       .unit = std::move(unit),
       .low = static_cast<double>(low),
       .high = static_cast<double>(high),
       .whole = true,
       .about = std::move(about)},
      &target);
}

void Demo::add_choice(std::string name, std::vector<std::string> choices, int& target, std::string about) {
  const double last = static_cast<double>(choices.size()) - 1;
  add({.name = std::move(name),
       .kind = Control::Kind::Choice,
       .high = last,
       .whole = true,
       .choices = std::move(choices),
       .about = std::move(about)},
      &target);
}

void Demo::add_switch(std::string name, bool& target, std::string about) {
  add({.name = std::move(name), .kind = Control::Kind::Switch, .whole = true, .about = std::move(about)},
      &target);
}

std::size_t Demo::place_of(std::string_view name) const {
  const auto found = std::ranges::find(controls_, name, &Control::name);
  if (found != controls_.end()) return static_cast<std::size_t>(found - controls_.begin());
  std::vector<std::string> names;
  for (const Control& each : controls_) names.push_back(each.name);
  throw Error(Error::Kind::Name, "demo " + quoted(about_.name), "control", std::string(name),
              "is not a control of this demo" + did_you_mean(name, names));
}

const Control& Demo::control(std::string_view name) const { return controls_[place_of(name)]; }

void Demo::put(std::size_t place, double value) {
  controls_[place].value = value;
  std::visit(
      [&](auto* member) {
        using Member = std::remove_pointer_t<decltype(member)>;
        if constexpr (std::is_same_v<Member, bool>) {
          *member = value != 0;
        } else {
          *member = static_cast<Member>(value);
        }
      },
      targets_[place]);
}

void Demo::set(std::string_view name, double value) {
  const std::size_t place = place_of(name);
  check(controls_[place], value);
  const double before = controls_[place].value;
  put(place, value);
  try {
    changed(controls_[place].name);
  } catch (...) {
    put(place, before);
    throw;
  }
}

void Demo::set(std::string_view name, std::string_view choice) {
  const Control& control = controls_[place_of(name)];
  const auto found = std::ranges::find(control.choices, choice);
  if (found == control.choices.end()) {
    throw Error(Error::Kind::Value, subject_of(control), "choice", std::string(choice),
                control.choices.empty() ? "is given, but the control takes a number"
                                        : "is none of its choices" + did_you_mean(choice, control.choices));
  }
  set(name, static_cast<double>(found - control.choices.begin()));
}

int Demo::advance(double seconds) {
  if (!(seconds > 0)) return 0;
  waiting_ += std::min(seconds, kLongestFrame);
  // Frames that sum to a step up to rounding count as a step.
  constexpr double kRounding = 1e-9;
  int taken = 0;
  for (; waiting_ >= dt_ * (1 - kRounding); ++taken) {
    waiting_ -= dt_;
    step_once();
  }
  return taken;
}

void Demo::step_once() {
  step();
  ++steps_;
  time_ += dt_;
}

void Demo::restart() {
  waiting_ = time_ = 0;
  steps_ = 0;
  build();
}

double Demo::fraction() const { return std::clamp(waiting_ / dt_, 0.0, 1.0); }

namespace {

struct Interval {
  double low, high;
};

// Returns the interval to show. It is `home` together with `moving` if that is at most twice as long as
// `home`. Otherwise it is the part at the far end of `moving`; if `moving` is longer than that, the end that
// is nearer to home.
Interval shown_of(Interval home, Interval moving) {
  const double most = 2 * (home.high - home.low);
  const Interval both{std::min(home.low, moving.low), std::max(home.high, moving.high)};
  if (both.high - both.low <= most) return both;
  // Longest interval that is shown, in lengths of home. Larger would not be worth it for one body that flies
  // off.
  constexpr double kLongest = 4;
  const double wanted = std::min(moving.high - moving.low, kLongest * (home.high - home.low));
  const double length = std::max(most, wanted);
  const bool beyond_high = moving.high - home.high > home.low - moving.low;
  if (moving.high - moving.low > length)
    return beyond_high
               ? Interval{std::max(moving.low, home.low), std::max(moving.low, home.low) + length}
               : Interval{std::min(moving.high, home.high) - length, std::min(moving.high, home.high)};
  return beyond_high ? Interval{both.high - length, both.high} : Interval{both.low, both.low + length};
}

}  // namespace

Aabb<double> Demo::shown() const {
  const Aabb<double> home = view();
  std::vector<Moving> all = moving();
  std::erase_if(all, [](const Moving& each) { return !each.awake; });
  if (all.empty()) return home;
  // A camera that takes some time to move would lag behind a body that leaves the view, so it aims ahead.
  constexpr double kAhead = 0.25;  // s
  Aabb<double> box = all.front().box;
  for (const Moving& each : all) {
    box = merged(box, each.box);
    if (home.contains(each.box)) continue;
    const Vec2d way = kAhead * each.velocity;
    box = merged(box, {each.box.lower + way, each.box.upper + way});
  }
  const Interval x = shown_of({home.lower.x, home.upper.x}, {box.lower.x, box.upper.x});
  const Interval y = shown_of({home.lower.y, home.upper.y}, {box.lower.y, box.upper.y});
  return {{x.low, y.low}, {x.high, y.high}};
}

void Demo::draw_motion(DebugDraw& out, const MotionOptions& options) const {
  if (!options.velocities && !options.forces && !options.masses) return;
  constexpr double kFallen = 1.0 / 3;  // of the view: arrow of a body that has fallen through it
  constexpr double kHeaviest = 0.1;    // of the view: arrow of the largest weight
  constexpr double kLongest = 0.5;     // of the view: a longer arrow shows no more
  const std::vector<Moving> all = moving();
  const double size = view().half_perimeter() / 2;
  double heaviest = 0;
  for (const Moving& each : all) heaviest = std::max(heaviest, each.mass);
  const double usual = gravity() > 0 ? gravity() : size;                                   // m/s^2
  const double for_speed = options.length * kFallen * size / std::sqrt(2 * usual * size);  // s
  const double for_force = options.length * kHeaviest * size / (usual * heaviest);         // m/N
  constexpr double kAside = 0.03;  // of the view: from a centre to the mass if an arrow starts there
  const auto arrow = [&](Vec2d from, Vec2d way, DrawRole role) -> Vec2d {
    const double length = std::sqrt(length_squared(way));
    if (!(length > 1e-3 * size)) return {};
    draw_arrow(out, from, from + std::min(1.0, kLongest * size / length) * way, role);
    return (1 / length) * way;
  };
  for (const Moving& each : all) {
    Vec2d along{};  // the arrows' common direction, which the mass must not cover
    if (options.velocities) along += arrow(each.centre, for_speed * each.velocity, DrawRole::Velocity);
    if (options.forces && each.mass > 0) along += arrow(each.centre, for_force * each.force, DrawRole::Force);
    const double length = std::sqrt(length_squared(along));
    const Vec2d aside = length > 0 ? (-kAside * size / length) * along : Vec2d{};
    if (options.masses && each.mass > 0 && !each.labelled)
      out.text(each.centre + aside, mass_text(each.mass), DrawRole::Name);
  }
}

std::vector<std::byte> Demo::save() const {
  std::vector<std::byte> bytes;
  Encoder out(bytes);
  out.put(about_.name);
  out.put(static_cast<std::uint64_t>(controls_.size()));
  for (const Control& control : controls_) out.put(control.value);
  out.put(time_);
  out.put(steps_);
  write(out);
  out.put(checksum(bytes));
  return bytes;
}

void Demo::restore(std::span<const std::byte> bytes) {
  std::uint64_t sum = 0;
  require(bytes.size() > sizeof(sum), "snapshot", "demo", "is cut off");
  const std::span<const std::byte> content = bytes.first(bytes.size() - sizeof(sum));
  std::memcpy(&sum, bytes.data() + content.size(), sizeof(sum));
  require(sum == checksum(content), "snapshot", "demo", "is damaged");
  Decoder in(content, "snapshot");
  in.require(in.get<std::string>("demo") == about_.name, "demo", "is another one");
  in.require(in.get<std::uint64_t>("controls") == controls_.size(), "controls", "are others");
  std::vector<double> values, before;
  for (const Control& control : controls_) {
    values.push_back(in.get<double>("controls"));
    before.push_back(control.value);
    check(control, values.back());
  }
  const auto time = in.get<double>("time");
  const auto steps = in.get<std::int64_t>("steps");
  const auto put_all = [&](const std::vector<double>& all) {
    for (std::size_t i = 0; i < all.size(); ++i) put(i, all[i]);
  };
  put_all(values);
  try {
    read(in);
  } catch (...) {
    put_all(before);
    throw;
  }
  time_ = time, steps_ = steps, waiting_ = 0;
}

}  // namespace plumb::demos
