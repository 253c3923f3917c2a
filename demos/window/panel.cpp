#include "demos/window/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cstdio>
#include <string>

#include "demos/window/rasteriser.h"

namespace plumb::window {
namespace {

// Adds a tooltip to the previous item.
void tip(const std::string& text) {
  if (!text.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
}

// Returns the position (px) of a value: in the column of values, or as far to the left as a long value needs.
float value_place(const char* text) {
  constexpr float kColumn = 244;
  const float right = ImGui::GetWindowContentRegionMax().x;
  return std::min(kColumn, right - ImGui::CalcTextSize(text).x);
}

void draw_list(Player& player) {
  const std::size_t place = player.place();
  std::size_t chosen = place;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##list", player.items()[place].name.c_str(), ImGuiComboFlags_HeightLarge)) {
    for (std::size_t i = 0; i < player.items().size(); ++i) {
      if (ImGui::Selectable(player.items()[i].name.c_str(), i == place)) chosen = i;
      tip(player.items()[i].summary);
    }
    ImGui::EndCombo();
  }
  if (chosen != place) player.choose(chosen);
}

void draw_time(Player& player) {
  const auto button = [&](const char* label, std::string_view key, const char* about) {
    if (ImGui::Button(label)) player.key(key);
    tip(about);
    ImGui::SameLine();
  };
  button("|<", "r", "restart (R)");
  button("<", "b", "one step back (B)");
  button(player.paused ? "go on" : "pause", "p", "P");
  button(">", "o", "one step (O)");
  ImGui::Checkbox("slow", &player.slow);
  tip("slow motion (S)");
  ImGui::SameLine();
  char time[32];
  std::snprintf(time, sizeof time, "t = %.2f s", player.demo().time());
  ImGui::SetCursorPosX(value_place(time));
  ImGui::TextUnformatted(time);
  tip("simulated time; " + std::to_string(player.remembered() - 1) + " states back are remembered");
}

void draw_control(Player& player, const demos::Control& control) {
  const std::string label =
      control.name + (control.unit.empty() ? "" : " (" + control.unit + ")") + "##" + control.name;
  ImGui::SetNextItemWidth(150);
  switch (control.kind) {
    case demos::Control::Kind::Switch: {
      bool on = control.value != 0;
      if (ImGui::Checkbox(label.c_str(), &on)) player.set(control.name, on ? 1 : 0);
      break;
    }
    case demos::Control::Kind::Choice: {
      const auto now = static_cast<std::size_t>(control.value);
      std::size_t chosen = now;
      if (ImGui::BeginCombo(label.c_str(), control.choices[now].c_str())) {
        for (std::size_t i = 0; i < control.choices.size(); ++i)
          if (ImGui::Selectable(control.choices[i].c_str(), i == now)) chosen = i;
        ImGui::EndCombo();
      }
      if (chosen != now) player.set(control.name, static_cast<double>(chosen));
      break;
    }
    case demos::Control::Kind::Slider: {
      double value = control.value;
      const char* format = control.whole ? "%.0f" : control.high < 0.2 ? "%.4f" : "%.3g";
      if (ImGui::SliderScalar(label.c_str(), ImGuiDataType_Double, &value, &control.low, &control.high,
                              format, ImGuiSliderFlags_AlwaysClamp) &&
          value != control.value)
        player.set(control.name, control.whole ? static_cast<double>(static_cast<long>(value)) : value);
      break;
    }
  }
  tip(control.about);
}

void draw_figures(const Player& player) {
  for (const Series& series : player.series()) {
    if (series.name() == "time") continue;  // shown at the top
    char text[64];
    std::snprintf(text, sizeof text, "%.4g %s", series.last(), series.unit().c_str());
    const std::vector<float> values = series.values();
    ImGui::PlotLines(("##" + series.name()).c_str(), values.data(), static_cast<int>(values.size()), 0,
                     nullptr, FLT_MAX, FLT_MAX, {58, 20});
    ImGui::SameLine();
    ImGui::Text("%s", series.name().c_str());
    ImGui::SameLine(value_place(text));
    ImGui::TextUnformatted(text);
  }
  if (player.frame_ms > 0) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f ms", player.frame_ms);
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 66);  // below the names of the figures
    ImGui::TextUnformatted("time of a frame");
    tip("to step and draw");
    ImGui::SameLine(value_place(text));
    ImGui::TextUnformatted(text);
  }
}

void draw_ghosts(Player& player, Companion& companion) {
  ImGui::TextWrapped("%s", companion.about().c_str());
  for (std::size_t i = 0; i < companion.ghosts().size(); ++i) {
    const Ghost& ghost = companion.ghosts()[i];
    bool shown = ghost.shown;
    const Colour colour = player.theme.ghost(static_cast<int>(i));
    ImGui::PushStyleColor(ImGuiCol_CheckMark, imgui_colour(colour));
    if (ImGui::Checkbox(ghost.name.c_str(), &shown)) companion.show_ghost(i, shown);
    ImGui::PopStyleColor();
    tip(ghost.remark);
    // Settings are shown in the tooltip; the reason why an outline is missing is shown as text.
    if (ghost.remark.empty() || ghost.shown) continue;
    ImGui::PushStyleColor(ImGuiCol_Text, ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled));
    ImGui::Indent();
    ImGui::TextWrapped("%s", ghost.remark.c_str());
    ImGui::Unindent();
    ImGui::PopStyleColor();
  }
}

void draw_options(Player& player) {
  struct Box {
    const char* label;
    bool* value;
  };
  DrawOptions& options = player.options;
  const Box boxes[] = {{"contacts", &options.contacts},
                       {"normals", &options.normals},
                       {"impulses", &options.impulses},
                       {"boxes", &options.boxes},
                       {"centres", &options.centres},
                       {"joints", &options.joints},
                       {"names", &options.names},
                       {"velocities", &player.motion.velocities},
                       {"forces", &player.motion.forces},
                       {"masses", &player.motion.masses},
                       {"sleep", &player.sleep_shows},
                       {"dark", &player.theme.dark},
                       {"code", &player.code}};
  int column = 0;
  for (const Box& box : boxes) {
    if (column % 3 != 0) ImGui::SameLine(8 + 112.0f * static_cast<float>(column % 3));
    ImGui::Checkbox(box.label, box.value);
    ++column;
  }
  if (player.motion.velocities || player.motion.forces) {
    ImGui::SetNextItemWidth(150);
    const double low = 0.1, high = 10;
    ImGui::SliderScalar("length of arrows", ImGuiDataType_Double, &player.motion.length, &low, &high, "%.3g",
                        ImGuiSliderFlags_Logarithmic);
  }
  if (options.impulses) {
    ImGui::SetNextItemWidth(150);
    const double low = 1e-3, high = 10;
    ImGui::SliderScalar("m for 1 N s", ImGuiDataType_Double, &options.impulse_length, &low, &high, "%.3g",
                        ImGuiSliderFlags_Logarithmic);
  }
}

void draw_keys(const Player& player) {
  const auto line = [](std::string_view key, std::string_view about) {
    ImGui::Text("%-5.*s %.*s", static_cast<int>(key.size()), key.data(), static_cast<int>(about.size()),
                about.data());
  };
  for (const demos::Key& key : player.demo().about().keys) line(std::string(1, key.key), key.about);
  for (const CommandKey& key : command_keys()) line(key.label, key.about);
  line("wheel", "zoom");
  line("right", "drag: move the picture");
}

}  // namespace

void draw_panel(Player& player, double width) {
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({static_cast<float>(width), ImGui::GetIO().DisplaySize.y});
  ImGui::Begin("plumb", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoSavedSettings);
  draw_list(player);
  ImGui::TextWrapped("%s", player.demo().about().play.c_str());
  ImGui::Separator();
  draw_time(player);
  ImGui::Separator();
  for (const demos::Control& control : player.demo().controls()) draw_control(player, control);
  ImGui::Separator();
  draw_figures(player);
  if (player.companion() != nullptr) {
    ImGui::Separator();
    draw_ghosts(player, *player.companion());
  }
  ImGui::Separator();
  draw_options(player);
  if (ImGui::CollapsingHeader("keys")) draw_keys(player);
  ImGui::End();
}

void draw_code(const Player& player, double width) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const auto wide = static_cast<float>(width);
  ImGui::SetNextWindowPos({size.x - wide, 0});
  ImGui::SetNextWindowSize({wide, size.y});
  ImGui::Begin("code", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_HorizontalScrollbar);
  const std::string& text = player.code_text();
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::End();
}

void draw_message(const Player& player) {
  std::string text = player.message;
  if (player.paused) text = text.empty() ? "paused" : "paused: " + text;
  if (text.empty()) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float left = player.panel ? 370 : 12;
  const ImVec2 wide = ImGui::CalcTextSize(text.c_str()), corner{left, size.y - 24};
  ImDrawList& out = *ImGui::GetBackgroundDrawList();
  // Draws a plate behind the text, because bodies and ground lie there.
  Colour plate = player.theme.ground();
  plate.a = kPlateAlpha;
  out.AddRectFilled({corner.x - 6, corner.y - 4}, {corner.x + wide.x + 6, corner.y + wide.y + 4},
                    imgui_colour(plate));
  out.AddText(corner, imgui_colour(player.theme.text()), text.c_str());
}

}  // namespace plumb::window
