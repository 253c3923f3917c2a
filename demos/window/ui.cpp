#include "demos/window/ui.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "demos/window/panel.h"
#include "demos/window/rasteriser.h"

namespace plumb::window {
namespace {

struct EditKey {
  std::string_view name;
  ImGuiKey key;
};
constexpr std::array kEditKeys = {
    EditKey{"enter", ImGuiKey_Enter},
    EditKey{"escape", ImGuiKey_Escape},
    EditKey{"backspace", ImGuiKey_Backspace},
    EditKey{"delete", ImGuiKey_Delete},
    EditKey{"left", ImGuiKey_LeftArrow},
    EditKey{"right", ImGuiKey_RightArrow},
    EditKey{"home", ImGuiKey_Home},
    EditKey{"end", ImGuiKey_End},
    EditKey{"tab", ImGuiKey_Tab},
};

static_assert(kEditKeys.size() <= 16);

void set_style(bool dark) {
  if (dark) {
    ImGui::StyleColorsDark();
  } else {
    ImGui::StyleColorsLight();
  }
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = style.FrameRounding = style.GrabRounding = 3;
  style.FrameBorderSize = dark ? 0.0f : 1.0f;  // white boxes on white need a border
  style.AntiAliasedLinesUseTex = false;
  style.Colors[ImGuiCol_WindowBg].w = 0.94f;
  // A slider's number may be behind its knob, so the knob is half transparent.
  style.Colors[ImGuiCol_SliderGrab].w = style.Colors[ImGuiCol_SliderGrabActive].w = 0.5f;
}

// Draws a text with its middle above a point, with an outline in the background's colour, so that it is
// readable over any body.
void draw_label(const Label& label, Colour ground) {
  const ImVec2 size = ImGui::CalcTextSize(label.text.c_str());
  const auto whole = [](double pixel) { return static_cast<float>(std::floor(pixel)); };
  const ImVec2 corner{whole(label.pixel.x - size.x / 2), whole(label.pixel.y - size.y)};
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  for (const ImVec2 way : {ImVec2{-1, 0}, ImVec2{1, 0}, ImVec2{0, -1}, ImVec2{0, 1}})
    list.AddText({corner.x + way.x, corner.y + way.y}, imgui_colour(ground), label.text.c_str());
  list.AddText(corner, imgui_colour(label.colour), label.text.c_str());
}

}  // namespace

Ui::Ui() : context_(ImGui::CreateContext()) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  for (std::size_t i = 0; i < kEditKeys.size(); ++i) io.KeyMap[kEditKeys[i].key] = static_cast<int>(i);
  unsigned char* alpha = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsAlpha8(&alpha, &width, &height);
  set_style(dark_);
}

Ui::~Ui() { ImGui::DestroyContext(context_); }

bool Ui::wants_keys() const { return ImGui::GetIO().WantTextInput; }

void Ui::edit_key(std::string_view name, bool down) {
  for (std::size_t i = 0; i < kEditKeys.size(); ++i) {
    if (kEditKeys[i].name != name) continue;
    // A press that ended before this frame counts for this frame.
    if (down) {
      ImGui::GetIO().KeysDown[i] = true;
      unseen_.set(i);
    } else if (unseen_[i]) {
      over_.set(i);
    } else {
      ImGui::GetIO().KeysDown[i] = false;
    }
  }
}

void Ui::frame(Player& player, const PanelInput& input, Canvas& canvas) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(canvas.width()), static_cast<float>(canvas.height())};
  io.DeltaTime = static_cast<float>(std::max(input.seconds, 1e-4));
  io.MousePos = {static_cast<float>(input.pointer.x), static_cast<float>(input.pointer.y)};
  io.MouseDown[0] = input.left;
  io.MouseDown[1] = input.right;
  io.KeyCtrl = input.control_key;
  io.KeyMods = input.control_key ? ImGuiKeyModFlags_Ctrl : ImGuiKeyModFlags_None;
  io.MouseWheel += static_cast<float>(input.wheel);
  for (const char c : input.text) io.AddInputCharacter(static_cast<unsigned char>(c));
  if (player.theme.dark != dark_) set_style(dark_ = player.theme.dark);

  ImGui::NewFrame();
  player.resize(canvas.width(), canvas.height(), kPanelWidth, code_width(canvas.width()));
  if (player.panel) draw_panel(player, kPanelWidth);
  if (player.code) draw_code(player, code_width(canvas.width()));
  draw_message(player);

  canvas.clear(player.theme.ground());
  Painter painter(canvas, player.camera, player.theme);
  painter.sleep_shows = player.sleep_shows;
  painter.grid();
  DrawOptions options = player.options;
  options.normal_length = 24 / player.camera.scale();
  player.demo().draw(painter, options);
  player.demo().draw_motion(painter, player.motion);
  if (player.companion() != nullptr) player.companion()->draw(painter, player.demo());
  painter.scale_bar(player.code ? code_width(canvas.width()) : 0);
  const ImVec2 character = ImGui::CalcTextSize("0");  // all characters of the font have the same width
  const Vec2d picture{static_cast<double>(canvas.width()), static_cast<double>(canvas.height())};
  for (const Label& label : placed(painter.labels(), {character.x, character.y}, picture))
    draw_label(label, player.theme.ground());
  ImGui::Render();
  for (std::size_t i = 0; i < kEditKeys.size(); ++i)
    if (over_[i]) io.KeysDown[i] = false;
  unseen_.reset();
  over_.reset();
  rasterise(*ImGui::GetDrawData(), *io.Fonts, canvas);
}

}  // namespace plumb::window
