#include "viewer/commands.h"

#include <gtest/gtest.h>

namespace vantage {
namespace {

Command named(const std::string& id, const std::string& title, Shortcut keys = {}) {
  return {.id = id, .group = "Group", .title = title, .keys = keys, .run = [] {}};
}

TEST(Commands, RunsWhatIsEnabledOnly) {
  Commands commands;
  int runs = 0;
  bool enabled = false;
  Command command = named("a", "A");
  command.run = [&] { ++runs; };
  command.enabled = [&] { return enabled; };
  commands.add(command);
  EXPECT_FALSE(commands.run("a"));
  enabled = true;
  EXPECT_TRUE(commands.run("a"));
  EXPECT_FALSE(commands.run("b"));
  EXPECT_EQ(runs, 1);
}

TEST(Commands, RefusesAnIdOrKeysThatAreTaken) {
  Commands commands;
  commands.add(named("a", "A", {Key::Space}));
  EXPECT_THROW(commands.add(named("a", "Again")), std::logic_error);
  EXPECT_THROW(commands.add(named("b", "B", {Key::Space})), std::logic_error);
  EXPECT_NO_THROW(commands.add(named("c", "C", {Key::Space, true})));
  EXPECT_NO_THROW(commands.add(named("d", "D")));
  EXPECT_NO_THROW(commands.add(named("e", "E")));
}

TEST(Commands, KeysFindTheirCommand) {
  Commands commands;
  commands.add(named("plain", "P", {keyOf('S')}));
  commands.add(named("ctrl", "C", {keyOf('S'), true}));
  EXPECT_EQ(commands.forKeys({keyOf('S'), true})->id, "ctrl");
  EXPECT_EQ(commands.forKeys({keyOf('S')})->id, "plain");
  EXPECT_EQ(commands.forKeys({keyOf('S'), true, true}), nullptr);
  EXPECT_EQ(commands.forKeys({}), nullptr);
}

TEST(Commands, AFewLettersFindACommandAndWordStartsComeFirst) {
  Commands commands;
  commands.add(named("a", "Next stage of the step"));
  commands.add(named("b", "Turn left"));
  commands.add(named("c", "Next step"));
  const auto found = commands.matching("nst");
  ASSERT_GE(found.size(), 2u);
  EXPECT_EQ(found.front()->id, "a");
  EXPECT_EQ(commands.matching("turn").front()->id, "b");
  EXPECT_EQ(commands.matching("LEFT").front()->id, "b");
  EXPECT_EQ(commands.matching("next step").front()->id, "c");
  commands.add(named("d", "Play or pause"));
  commands.add(named("e", "Look from the top"));
  EXPECT_EQ(commands.matching("top").front()->id, "e") << "a whole word comes before scattered letters";
  EXPECT_TRUE(commands.matching("zzz").empty());
  EXPECT_EQ(commands.matching("").size(), 5u);
}

TEST(Keys, ShortcutsReadAsPeopleWriteThem) {
  EXPECT_EQ(textOf({keyOf('P'), true, true}), "Ctrl+Shift+P");
  EXPECT_EQ(textOf({Key::Space}), "Space");
  EXPECT_EQ(textOf({functionKey(11)}), "F11");
  EXPECT_EQ(textOf({Key::PageDown, false, true}), "Shift+Page down");
  EXPECT_EQ(textOf({}), "");
}

TEST(Keys, AFieldTakesLettersAndItsOwnShortcutsOnly) {
  EXPECT_TRUE(belongsToField({keyOf('H')}));
  EXPECT_TRUE(belongsToField({Key::Left}));
  EXPECT_TRUE(belongsToField({Key::Left, true})) << "word by word";
  EXPECT_TRUE(belongsToField({keyOf('Z'), true}));
  EXPECT_FALSE(belongsToField({functionKey(1)}));
  EXPECT_FALSE(belongsToField({keyOf('R'), true}));
}

TEST(Keys, PanelsTakeWhatMovesInThem) {
  for (const Key key : {Key::Up, Key::Tab, Key::Space, Key::Enter, Key::Escape})
    EXPECT_TRUE(walksPanels(key));
  for (const Key key : {keyOf('V'), functionKey(6), Key::Comma}) EXPECT_FALSE(walksPanels(key));
}

}  // namespace
}  // namespace vantage
