#include "demos/window/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>

#include "demos/window/picture.h"
#include "engine/scene/json.h"
#include "harness/text_file.h"

namespace plumb::window {

Stage::Stage(Player& player, const Options& options)
    : canvas(options.width, options.height), player_(player), options_(options) {
  player.resize(options.width, options.height, Ui::kPanelWidth);
}

bool Stage::follow_script(double time) {
  constexpr double kRounding = 1e-9;
  for (; next_deed_ < options_.script.size(); ++next_deed_) {
    const Deed& deed = options_.script[next_deed_];
    if (deed.time > time + kRounding) break;
    if (deed.kind == Deed::Kind::Picture) {
      frame({});
      frame({});
      take_picture(deed.text);
    } else if (deed.kind == Deed::Kind::Scene) {
      write_scene(deed.text);
    } else if (carry_out(act(player_, deed))) {
      return true;
    }
  }
  return false;
}

void Stage::take_picture(const std::string& file) {
  std::string name = file;
  while (name.empty() || (file.empty() && std::filesystem::exists(name)))
    name = fmt::format("plumb-{:03}.png", ++pictures_);
  write_png(
      options_.colours > 0 ? with_few_colours(canvas, static_cast<std::size_t>(options_.colours)) : canvas,
      name);
  player_.message = "written: " + name;
}

void Stage::write_scene(const std::string& file) {
  const std::optional<Scene> scene = player_.demo().scene();
  if (!scene) {
    player_.message = "this demo has no scene";
    return;
  }
  std::string name = file;
  while (name.empty() || (file.empty() && std::filesystem::exists(name)))
    name = fmt::format("{}-{:03}.json", player_.demo().about().name, ++scenes_);
  harness::write_whole(name, to_json(*scene) + "\n");
  player_.message = fmt::format("written: {}; `plumb run {}` runs it", name, name);
}

bool Stage::carry_out(std::optional<Command> command) {
  if (command == Command::Picture) take_picture();
  if (command == Command::Scene) write_scene();
  return command == Command::Quit;
}

std::string FrameTimes::report() const {
  if (frames_.empty()) return "no frames\n";
  std::string out = fmt::format("{} frames; ms      median     p99\n", frames_.size());
  const auto line = [&](const char* name, auto&& part) {
    std::vector<double> sorted;
    for (const Frame& frame : frames_) sorted.push_back(part(frame));
    std::ranges::sort(sorted);
    const auto quantile = [&](double q) {
      return sorted[std::min(static_cast<std::size_t>(q * static_cast<double>(sorted.size())),
                             sorted.size() - 1)];
    };
    out += fmt::format("{:<14}{:>12.2f}{:>8.2f}\n", name, quantile(0.5), quantile(0.99));
  };
  line("steps", [](const Frame& f) { return f.steps; });
  line("drawing", [](const Frame& f) { return f.drawing; });
  line("showing", [](const Frame& f) { return f.showing; });
  line("frame", [](const Frame& f) { return f.steps + f.drawing + f.showing; });
  line("processor", [](const Frame& f) { return f.processor; });
  return out;
}

double processor_ms() { return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double now_ms() {
  using Milliseconds = std::chrono::duration<double, std::milli>;
  return Milliseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string report(const Player& player) {
  std::string out =
      fmt::format("demo   {}\ntime   {:.6g} s\nsteps  {}\nhash   {:016x}\n", player.demo().about().name,
                  player.demo().time(), player.demo().step_count(), player.demo().hash());
  for (const Series& series : player.series())
    if (series.name() != "time")
      out += fmt::format("{}: {:.6g}{}{}\n", series.name(), series.last(), series.unit().empty() ? "" : " ",
                         series.unit());
  return out;
}

}  // namespace plumb::window
