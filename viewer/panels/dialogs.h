#pragma once

#include <string>

#include "viewer/panels/panel.h"

namespace vantage {

/// Command palette: type a few letters of a command, Enter runs the first match.
class CommandPalette {
 public:
  void open();
  void draw(PanelContext& context);

 private:
  bool open_ = false;
  bool focus_ = false;
  int selected_ = 0;
  std::string query_;
};

/// All commands with their keys, and what the mouse does.
class CheatSheet {
 public:
  void toggle() { open_ = !open_; }
  void draw(PanelContext& context);

 private:
  bool open_ = false;
};

/// Messages for the person at the window, at the lower edge of the 3-D view. \param right, bottom pixels
void drawNotices(PanelContext& context, double left, double right, double bottom);

}  // namespace vantage
