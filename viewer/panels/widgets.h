#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Where a widget is, pixels from the top left of the window.
struct WidgetBox {
  double left = 0.0, top = 0.0, right = 0.0, bottom = 0.0;
  bool visible = false;  ///< its middle is; false: scrolled out of its panel
  bool enabled = true;
  double x() const { return (left + right) / 2.0; }
  double y() const { return (top + bottom) / 2.0; }
};

/// Dear ImGui's widgets under names of their own ("layers/occupied"): whoever drives the window without a
/// hand, a test say, finds them by name.
class Widgets {
 public:
  /// Forgets the frame before.
  void beginFrame() { boxes_.clear(); }

  /// Push button; true if it was pressed. `tip` appears under the mouse.
  bool button(const std::string& name, const std::string& label, bool enabled = true,
              const std::string& tip = "");
  /// Check box; true if it was switched.
  bool toggle(const std::string& name, const std::string& label, bool& on);
  /// Radio button.
  bool choice(const std::string& name, const std::string& label, bool active);
  /// Slider, for the mouse alone: numbers are typed into fields; `format` as printf. `width_px` 0: what is
  /// left of the line.
  bool slider(const std::string& name, const std::string& label, double& value, double low, double high,
              const char* format, bool logarithmic = false, double width_px = 0.0);
  /// Line of text that is taken over with Enter or when the field is left; true if it was changed.
  bool field(const std::string& name, std::string& text, double width_px = 0.0, const std::string& hint = "");
  /// Drop-down list; true if another entry was chosen.
  bool combo(const std::string& name, const std::string& label, const std::vector<std::string>& entries,
             int& chosen, double width_px = 0.0);

  /// Gives the item that was submitted last a name.
  void note(const std::string& name, bool enabled = true);
  /// A place that is no item.
  void note(const std::string& name, const WidgetBox& box) { boxes_[name] = box; }

  /// Null if the last frame had no such widget.
  const WidgetBox* find(std::string_view name) const;
  /// All names of the last frame, in alphabetical order.
  std::vector<std::string> names() const;

 private:
  struct Typed {
    std::string name, text;
  };

  std::map<std::string, WidgetBox, std::less<>> boxes_;
  Typed typed_;  ///< the field that is being typed into
};

/// Place of a value on a slider's track: 0 at `low`, 1 at `high`. \pre 0 < low if it is logarithmic
double shareOnTrack(double value, double low, double high, bool logarithmic);

/// The text with new lines where the room to the right ends, broken as brokenAtSpaces() does: Dear ImGui
/// itself tears numbers at their decimal points. \param width_px 0: what is left of the line
std::string inLines(const std::string& text, double width_px = 0.0);
/// Draws it.
void wrappedText(const std::string& text, double width_px = 0.0);

enum class Follows { Button, CheckBox };
/// The button or check box with that label, which comes next, stays on the line if there is room for it.
void sameLineIfFits(const std::string& label, Follows what = Follows::Button);

/// The text in a tooltip if the item that was submitted last is under the mouse for a while.
void tip(const std::string& text);

}  // namespace vantage
