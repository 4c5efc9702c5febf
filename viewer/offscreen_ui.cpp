#include "viewer/offscreen_ui.h"

#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "io/suggest.h"
#include "viewer/drawn_words.h"
#include "viewer/ui_host.h"

namespace vantage {
namespace {

/// Dear ImGui's own keys by the numbers that we use.
void mapKeys(ImGuiIO& io) {
  const std::pair<ImGuiKey, Key> keys[] = {
      {ImGuiKey_Tab, Key::Tab},           {ImGuiKey_LeftArrow, Key::Left},
      {ImGuiKey_RightArrow, Key::Right},  {ImGuiKey_UpArrow, Key::Up},
      {ImGuiKey_DownArrow, Key::Down},    {ImGuiKey_PageUp, Key::PageUp},
      {ImGuiKey_PageDown, Key::PageDown}, {ImGuiKey_Home, Key::Home},
      {ImGuiKey_End, Key::End},           {ImGuiKey_Insert, Key::Insert},
      {ImGuiKey_Delete, Key::Delete},     {ImGuiKey_Backspace, Key::Backspace},
      {ImGuiKey_Space, Key::Space},       {ImGuiKey_Enter, Key::Enter},
      {ImGuiKey_Escape, Key::Escape},     {ImGuiKey_KeyPadEnter, Key::KeypadEnter},
      {ImGuiKey_A, keyOf('A')},           {ImGuiKey_C, keyOf('C')},
      {ImGuiKey_V, keyOf('V')},           {ImGuiKey_X, keyOf('X')},
      {ImGuiKey_Y, keyOf('Y')},           {ImGuiKey_Z, keyOf('Z')}};
  for (const auto& [ours, key] : keys) io.KeyMap[ours] = static_cast<int>(key);
}

}  // namespace

struct OffscreenUi::State {
  Inspector& inspector;
  int width, height;
  UiHost host;
  UiSurface surface;

  State(GlContext& context, Inspector& inspector_, int width_, int height_)
      : inspector(inspector_),
        width(width_),
        height(height_),
        host(context),
        surface(context, width_, height_) {}

  ImGuiIO& io() {
    host.makeCurrent();
    return ImGui::GetIO();
  }
  WidgetBox boxOf(const std::string& name) const;
};

WidgetBox OffscreenUi::State::boxOf(const std::string& name) const {
  const WidgetBox* box = inspector.widgets().find(name);
  if (box) return *box;
  throw std::runtime_error("the window has no widget '" + name + "'" +
                           suggestion(name, inspector.widgets().names()));
}

OffscreenUi::OffscreenUi(GlContext& context, Inspector& inspector, int width, int height)
    : state_(std::make_unique<State>(context, inspector, width, height)) {
  ImGuiIO& io = state_->io();
  mapKeys(io);
  io.MousePos = {-1.0f, -1.0f};
}

OffscreenUi::~OffscreenUi() = default;

void OffscreenUi::frame(double elapsed_s) {
  Inspector& inspector = state_->inspector;
  inspector.update(elapsed_s);
  const Preferences& preferences = inspector.preferences();
  state_->host.setLook(preferences.theme, preferences.font_scale);
  ImGuiIO& io = state_->io();
  io.DisplaySize = {static_cast<float>(state_->width), static_cast<float>(state_->height)};
  io.DeltaTime = static_cast<float>(elapsed_s);
  state_->host.begin();
  inspector.draw(1.0);
  state_->host.end(state_->surface.framebuffer(), state_->width, state_->height);
  state_->surface.finish();
  io.MouseWheel = 0.0f;
}

void OffscreenUi::settle(double limit_s) {
  using Clock = std::chrono::steady_clock;
  constexpr double kPoll_s = 0.004;
  const auto start = Clock::now();
  frame();
  frame();
  while (!state_->inspector.idle()) {
    if (std::chrono::duration<double>(Clock::now() - start).count() > limit_s)
      throw std::runtime_error("the window did not come to rest");
    std::this_thread::sleep_for(std::chrono::duration<double>(kPoll_s));
    if (state_->inspector.update(kPoll_s)) frame();
  }
  frame();
}

void OffscreenUi::moveMouse(double x, double y) {
  state_->io().MousePos = {static_cast<float>(x), static_cast<float>(y)};
  frame();
}

void OffscreenUi::pressMouse(int button) {
  state_->io().MouseDown[button] = true;
  frame();
}

void OffscreenUi::releaseMouse(int button) {
  state_->io().MouseDown[button] = false;
  frame();
}

void OffscreenUi::wheel(double clicks) {
  state_->io().MouseWheel = static_cast<float>(clicks);
  frame();
}

void OffscreenUi::press(const Shortcut& keys) {
  hold(keys);
  release(keys);
}

void OffscreenUi::hold(const Shortcut& keys) {
  ImGuiIO& io = state_->io();
  io.KeyCtrl = keys.ctrl;
  io.KeyShift = keys.shift;
  io.KeysDown[static_cast<int>(keys.key)] = true;
  frame();
}

void OffscreenUi::release(const Shortcut& keys) {
  ImGuiIO& io = state_->io();
  io.KeysDown[static_cast<int>(keys.key)] = false;
  io.KeyCtrl = io.KeyShift = false;
  frame();
}

void OffscreenUi::type(const std::string& utf8) {
  state_->io().AddInputCharactersUTF8(utf8.c_str());
  frame();
}

bool OffscreenUi::has(const std::string& name) const {
  return state_->inspector.widgets().find(name) != nullptr;
}

void OffscreenUi::hover(const std::string& name) {
  WidgetBox box = state_->boxOf(name);
  // A widget outside the visible part of its panel is scrolled into it: the panel's middle takes the wheel.
  for (int turn = 0; turn < 60 && !box.visible; ++turn) {
    const double x = std::clamp(box.x(), 1.0, state_->width - 2.0);
    moveMouse(x, state_->height * 0.4);
    wheel(box.y() > state_->height * 0.4 ? -1.0 : 1.0);
    frame();
    box = state_->boxOf(name);
  }
  moveMouse(box.x(), box.y());
}

void OffscreenUi::click(const std::string& name, int button) {
  hover(name);
  if (!state_->boxOf(name).enabled) throw std::runtime_error("the widget '" + name + "' is disabled");
  pressMouse(button);
  releaseMouse(button);
  frame();
}

void OffscreenUi::doubleClick(const std::string& name) {
  hover(name);
  for (int i = 0; i < 2; ++i) {
    pressMouse();
    releaseMouse();
  }
  frame();
}

void OffscreenUi::drag(const std::string& name, double from_x, double from_y, double to_x, double to_y,
                       int button) {
  hover(name);
  const WidgetBox box = state_->boxOf(name);
  const auto at = [&](double x, double y) {
    moveMouse(box.left + x * (box.right - box.left), box.top + y * (box.bottom - box.top));
  };
  at(from_x, from_y);
  pressMouse(button);
  constexpr int kMoves = 8;
  for (int i = 1; i <= kMoves; ++i) {
    const double t = static_cast<double>(i) / kMoves;
    at(from_x + t * (to_x - from_x), from_y + t * (to_y - from_y));
  }
  releaseMouse(button);
  frame();
}

void OffscreenUi::enter(const std::string& name, const std::string& text) {
  click(name);
  press({keyOf('A'), true});
  type(text);
  press({Key::Enter});
  frame();
}

RgbImage OffscreenUi::image() const {
  return state_->surface.read();
}

std::string OffscreenUi::words() const {
  const ImGuiIO& io = state_->io();
  const ImDrawData* drawn = ImGui::GetDrawData();
  return drawn ? drawnWords(*drawn, *io.Fonts) : "";
}

}  // namespace vantage
