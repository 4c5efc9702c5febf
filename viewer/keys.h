#pragma once

#include <string>

namespace vantage {

/// Keys by the numbers that GLFW gives them; letters and digits are their ASCII capitals.
enum class Key : int {
  None = 0,
  Space = 32,
  Comma = 44,
  Minus = 45,
  Period = 46,
  Digit0 = 48,
  Equal = 61,
  A = 65,
  Z = 90,
  RightBracket = 93,
  Escape = 256,
  Enter = 257,
  Tab = 258,
  Backspace = 259,
  Insert = 260,
  Delete = 261,
  Right = 262,
  Left = 263,
  Down = 264,
  Up = 265,
  PageUp = 266,
  PageDown = 267,
  Home = 268,
  End = 269,
  F1 = 290,
  F11 = 300,
  KeypadEnter = 335,
};
inline constexpr int kKeyCount = 349;

/// The key of a capital letter or digit.
constexpr Key keyOf(char capital) {
  return static_cast<Key>(capital);
}
constexpr Key functionKey(int n) {
  return static_cast<Key>(static_cast<int>(Key::F1) + n - 1);
}

/// A key with modifiers.
struct Shortcut {
  Key key = Key::None;
  bool ctrl = false;
  bool shift = false;
  bool operator==(const Shortcut&) const = default;
};

/// A field that is typed into wants it for itself.
bool belongsToField(const Shortcut& shortcut);
/// It moves inside the panels, where keys do.
bool walksPanels(Key key);

/// For menus and the cheat sheet: "Ctrl+Shift+P"; empty without a key.
std::string textOf(const Shortcut& shortcut);

}  // namespace vantage
