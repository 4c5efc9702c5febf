#include "viewer/keys.h"

#include <array>
#include <utility>

namespace vantage {
namespace {

std::string nameOf(Key key) {
  static constexpr std::array<std::pair<Key, const char*>, 17> kNames = {{{Key::Space, "Space"},
                                                                          {Key::Escape, "Esc"},
                                                                          {Key::Enter, "Enter"},
                                                                          {Key::Tab, "Tab"},
                                                                          {Key::Backspace, "Backspace"},
                                                                          {Key::Insert, "Insert"},
                                                                          {Key::Delete, "Delete"},
                                                                          {Key::Right, "Right"},
                                                                          {Key::Left, "Left"},
                                                                          {Key::Down, "Down"},
                                                                          {Key::Up, "Up"},
                                                                          {Key::PageUp, "Page up"},
                                                                          {Key::PageDown, "Page down"},
                                                                          {Key::Home, "Home"},
                                                                          {Key::End, "End"},
                                                                          {Key::KeypadEnter, "Enter"},
                                                                          {Key::Equal, "+"}}};
  for (const auto& [known, name] : kNames)
    if (known == key) return name;
  const int code = static_cast<int>(key);
  const int f1 = static_cast<int>(Key::F1);
  if (code >= f1 && code < f1 + 12) return "F" + std::to_string(code - f1 + 1);
  return std::string(1, static_cast<char>(code));
}

}  // namespace

bool belongsToField(const Shortcut& shortcut) {
  if (shortcut.key >= functionKey(1) && shortcut.key <= functionKey(12)) return false;
  if (!shortcut.ctrl || shortcut.key >= Key::Escape) return true;
  return std::string("ACVXZY").find(static_cast<char>(shortcut.key)) != std::string::npos;
}

bool walksPanels(Key key) {
  return key == Key::Space || (key >= Key::Escape && key <= Key::End) || key == Key::KeypadEnter;
}

std::string textOf(const Shortcut& shortcut) {
  if (shortcut.key == Key::None) return "";
  return std::string(shortcut.ctrl ? "Ctrl+" : "") + (shortcut.shift ? "Shift+" : "") + nameOf(shortcut.key);
}

}  // namespace vantage
