#include "viewer/panels/theme.h"

#include <imgui.h>

#include <array>

namespace vantage {
namespace {

constexpr Theme kLight{.paper = palette::kPaper,
                       .panel = rgb(240, 241, 242),
                       .ink = palette::kInk,
                       .faint = palette::kFaintInk,
                       .accent = rgb(0, 96, 180),
                       .chosen = palette::kChosen,
                       .warning = rgb(176, 60, 0),
                       .curve = rgb(190, 110, 0),
                       .second_curve = rgb(0, 112, 96),
                       .third_curve = rgb(0, 96, 180)};
constexpr Theme kDark{.paper = rgb(24, 27, 32),
                      .panel = rgb(37, 41, 48),
                      .ink = rgb(226, 229, 233),
                      .faint = rgb(152, 159, 168),
                      .accent = rgb(86, 170, 240),
                      .chosen = rgb(255, 92, 130),
                      .warning = rgb(255, 170, 90),
                      .curve = rgb(240, 170, 40),
                      .second_curve = rgb(60, 200, 170),
                      .third_curve = rgb(110, 180, 250)};
constexpr Theme kHighContrast{.paper = rgb(0, 0, 0),
                              .panel = rgb(0, 0, 0),
                              .ink = rgb(255, 255, 255),
                              .faint = rgb(220, 220, 220),
                              .accent = rgb(255, 230, 0),
                              .chosen = rgb(255, 100, 150),
                              .warning = rgb(255, 190, 60),
                              .curve = rgb(255, 190, 40),
                              .second_curve = rgb(80, 255, 210),
                              .third_curve = rgb(120, 200, 255)};

ImVec4 vec(Rgb color, double alpha = 1.0) {
  return {static_cast<float>(color.r), static_cast<float>(color.g), static_cast<float>(color.b),
          static_cast<float>(alpha)};
}

Rgb mixed(Rgb a, Rgb b, double t) {
  return {a.r + t * (b.r - a.r), a.g + t * (b.g - a.g), a.b + t * (b.b - a.b)};
}

void setColors(ImGuiStyle& style, const Theme& t, bool high_contrast) {
  ImVec4* c = style.Colors;
  const auto tint = [&](double share) { return vec(mixed(t.panel, t.ink, share)); };
  c[ImGuiCol_Text] = vec(t.ink);
  c[ImGuiCol_TextDisabled] = vec(mixed(t.panel, t.ink, 0.5));
  c[ImGuiCol_WindowBg] = c[ImGuiCol_MenuBarBg] = vec(t.panel);
  c[ImGuiCol_ChildBg] = vec(t.panel, 0.0);
  c[ImGuiCol_PopupBg] = vec(mixed(t.panel, t.paper, 0.5));
  c[ImGuiCol_Border] = c[ImGuiCol_Separator] = tint(high_contrast ? 1.0 : 0.22);
  c[ImGuiCol_FrameBg] = tint(0.14);
  c[ImGuiCol_FrameBgHovered] = tint(0.2);
  c[ImGuiCol_FrameBgActive] = tint(0.26);
  c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgActive] = c[ImGuiCol_TitleBgCollapsed] = tint(0.08);
  c[ImGuiCol_ScrollbarBg] = vec(t.panel, 0.0);
  c[ImGuiCol_ScrollbarGrab] = tint(0.3);
  c[ImGuiCol_ScrollbarGrabHovered] = c[ImGuiCol_ScrollbarGrabActive] = tint(0.45);
  c[ImGuiCol_CheckMark] = c[ImGuiCol_SliderGrab] = vec(t.accent);
  c[ImGuiCol_SliderGrabActive] = vec(mixed(t.accent, t.ink, 0.3));
  c[ImGuiCol_Button] = tint(0.13);
  c[ImGuiCol_ButtonHovered] = tint(0.22);
  c[ImGuiCol_ButtonActive] = vec(mixed(t.panel, t.accent, 0.5));
  c[ImGuiCol_Header] = vec(mixed(t.panel, t.accent, 0.28));
  c[ImGuiCol_HeaderHovered] = vec(mixed(t.panel, t.accent, 0.2));
  c[ImGuiCol_HeaderActive] = vec(mixed(t.panel, t.accent, 0.4));
  c[ImGuiCol_SeparatorHovered] = c[ImGuiCol_SeparatorActive] = vec(t.accent);
  c[ImGuiCol_Tab] = c[ImGuiCol_TabUnfocused] = tint(0.06);
  c[ImGuiCol_TabHovered] = vec(mixed(t.panel, t.accent, 0.35));
  c[ImGuiCol_TabActive] = c[ImGuiCol_TabUnfocusedActive] = vec(mixed(t.panel, t.accent, 0.28));
  c[ImGuiCol_TableHeaderBg] = tint(0.1);
  c[ImGuiCol_TableBorderStrong] = tint(high_contrast ? 1.0 : 0.25);
  c[ImGuiCol_TableBorderLight] = tint(high_contrast ? 0.6 : 0.14);
  c[ImGuiCol_TableRowBgAlt] = vec(t.ink, 0.03);
  c[ImGuiCol_TextSelectedBg] = vec(t.accent, 0.35);
  c[ImGuiCol_NavHighlight] = vec(t.accent);
  c[ImGuiCol_ModalWindowDimBg] = vec(rgb(0, 0, 0), 0.35);
}

}  // namespace

std::string_view nameOf(ThemeName theme) {
  static constexpr std::array<std::string_view, 3> kNames = {"light", "dark", "high-contrast"};
  return kNames[static_cast<std::size_t>(theme)];
}

const std::vector<ThemeName>& themes() {
  static const std::vector<ThemeName> all = {ThemeName::Light, ThemeName::Dark, ThemeName::HighContrast};
  return all;
}

const Theme& themeOf(ThemeName name) {
  if (name == ThemeName::Dark) return kDark;
  return name == ThemeName::Light ? kLight : kHighContrast;
}

void applyTheme(ThemeName name, double font_px) {
  const bool high_contrast = name == ThemeName::HighContrast;
  ImGuiStyle style;
  if (name == ThemeName::Light)
    ImGui::StyleColorsLight(&style);
  else
    ImGui::StyleColorsDark(&style);
  style.WindowBorderSize = style.ChildBorderSize = 1.0f;
  style.FrameBorderSize = high_contrast ? 1.0f : 0.0f;
  style.FrameRounding = style.GrabRounding = style.TabRounding = style.PopupRounding = 3.0f;
  style.WindowPadding = {8.0f, 6.0f};
  style.FramePadding = {6.0f, 3.0f};
  style.ItemSpacing = {6.0f, 4.0f};
  style.ItemInnerSpacing = {5.0f, 4.0f};
  style.CellPadding = {4.0f, 2.0f};
  style.ScrollbarSize = 12.0f;
  style.GrabMinSize = 9.0f;
  style.IndentSpacing = 12.0f;
  constexpr double kDesigned_px = 15.0;
  style.ScaleAllSizes(static_cast<float>(font_px / kDesigned_px));
  setColors(style, themeOf(name), high_contrast);
  ImGui::GetStyle() = style;
}

}  // namespace vantage
