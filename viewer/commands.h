#pragma once

#include <functional>
#include <string>
#include <vector>

#include "viewer/keys.h"

namespace vantage {

/// Something that can be done in the window. Menus, keys, the cheat sheet and the command palette all come
/// from one list of these.
struct Command {
  std::string id;     ///< "timeline.next"; unique
  std::string group;  ///< heading in the cheat sheet: "Timeline"
  std::string title;  ///< "Next step"
  Shortcut keys;      ///< may be none
  std::function<void()> run;
  std::function<bool()> enabled = [] { return true; };
  std::function<bool()> checked = nullptr;  ///< set for switches: whether they are on
  bool repeats = false;                     ///< while its key is held
};

/// All commands, in the order of the cheat sheet.
class Commands {
 public:
  /// The command in the list, until the next one is added. \throws std::logic_error if the id or the keys are
  /// taken.
  Command& add(Command command);
  const std::vector<Command>& all() const { return all_; }
  /// The command runs again and again while its key is held. \throws std::logic_error if there is none.
  void letRepeat(const std::string& id);
  const Command* find(const std::string& id) const;
  /// Runs it if it exists and is enabled; says whether it ran.
  bool run(const std::string& id) const;
  const Command* forKeys(const Shortcut& keys) const;
  /// Commands whose group and title hold the letters of `query` in this order, upper or lower case; those
  /// with a run of letters at the start of a word come first. All of them for an empty query.
  std::vector<const Command*> matching(const std::string& query) const;

 private:
  std::vector<Command> all_;
};

}  // namespace vantage
