#include "viewer/panels/file_dialog.h"

#include <gmock/gmock.h>
#include <imgui.h>

#include <cstdlib>

#include "tests/support/process.h"
#include "viewer/keys.h"

namespace vantage::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Dear ImGui without anything to draw on, and a dialog in it, driven by keys, letters and the mouse.
class FileDialogTest : public ::testing::Test {
 protected:
  FileDialogTest() : ui_(ImGui::CreateContext()) {
    ImGui::SetCurrentContext(ui_);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = {900.0f, 700.0f};
    unsigned char* pixels = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
    io.KeyMap[ImGuiKey_A] = static_cast<int>(keyOf('A'));
    io.KeyMap[ImGuiKey_Tab] = static_cast<int>(Key::Tab);
    io.KeyMap[ImGuiKey_UpArrow] = static_cast<int>(Key::Up);
    io.KeyMap[ImGuiKey_DownArrow] = static_cast<int>(Key::Down);
    io.KeyMap[ImGuiKey_Backspace] = static_cast<int>(Key::Backspace);
    io.KeyMap[ImGuiKey_Enter] = static_cast<int>(Key::Enter);
    io.KeyMap[ImGuiKey_Escape] = static_cast<int>(Key::Escape);
    fs::create_directories(folder_ / "data");
    for (const char* name : {"b.vantage", "a.vti", "notes.txt", ".hidden.csv", "Zoo.toml", "data/c.pcd"})
      writeFile(folder_ / name, "x");
  }
  ~FileDialogTest() override { ImGui::DestroyContext(ui_); }

  void open(FileDialog::Mode mode = FileDialog::Mode::Open, const std::string& name = "") {
    dialog_.open(mode, folder_.path(), name);
    frames(3);
  }

  void frames(int count = 1) {
    for (int i = 0; i < count; ++i) {
      ImGui::GetIO().DeltaTime = 1.0f / 60.0f;
      ImGui::NewFrame();
      widgets_.beginFrame();
      if (auto path = dialog_.draw(widgets_)) result_ = path;
      ImGui::Render();
    }
  }

  void press(Key key) {
    bool& down = ImGui::GetIO().KeysDown[static_cast<int>(key)];
    down = true;
    frames();
    down = false;
    frames(2);
  }

  void type(const std::string& text) {
    ImGui::GetIO().AddInputCharactersUTF8(text.c_str());
    frames(2);
  }

  void click(const std::string& name, int times = 1) {
    const WidgetBox* box = widgets_.find(name);
    ASSERT_NE(box, nullptr) << name;
    ImGuiIO& io = ImGui::GetIO();
    io.MousePos = {static_cast<float>(box->x()), static_cast<float>(box->y())};
    frames();
    for (int i = 0; i < times; ++i) {
      io.MouseDown[0] = true;
      frames();
      io.MouseDown[0] = false;
      frames();
    }
    frames();
  }

  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const FileDialog::Entry& entry : dialog_.entries()) all.push_back(entry.name);
    return all;
  }

  TemporaryFolder folder_;
  ImGuiContext* ui_;
  Widgets widgets_;
  FileDialog dialog_;
  std::optional<fs::path> result_;
};

TEST_F(FileDialogTest, ListsFoldersThenKnownFilesAndTheRestOnRequest) {
  open();
  EXPECT_THAT(names(), ElementsAre("data", "a.vti", "b.vantage", "Zoo.toml"));
  click("file/all");
  EXPECT_THAT(names(), ElementsAre("data", "a.vti", "b.vantage", "notes.txt", "Zoo.toml"));
  click("file/hidden");
  EXPECT_THAT(names(), ElementsAre("data", ".hidden.csv", "a.vti", "b.vantage", "notes.txt", "Zoo.toml"));
}

TEST_F(FileDialogTest, AClickAndTheButtonOpenAFile) {
  open();
  click("file/entry b.vantage");
  EXPECT_FALSE(result_);
  click("file/accept");
  EXPECT_EQ(result_, fs::path(folder_ / "b.vantage"));
  EXPECT_FALSE(dialog_.isOpen());
}

TEST_F(FileDialogTest, ADoubleClickOpensAFileAndEntersAFolder) {
  open();
  click("file/entry data", 2);
  EXPECT_EQ(dialog_.folder(), fs::path(folder_ / "data"));
  frames(60);  // a third click is no double click
  click("file/entry c.pcd", 2);
  EXPECT_EQ(result_, fs::path(folder_ / "data/c.pcd"));
}

TEST_F(FileDialogTest, TheKeyboardAloneIsEnough) {
  const std::string longer = "a run with a long name.vantage";  // than strings hold without an allocation
  ASSERT_EQ(longer.size(), 30u);
  writeFile(folder_ / longer, "x");
  open();
  press(Key::Down);  // data
  press(Key::Enter);
  EXPECT_EQ(dialog_.folder(), fs::path(folder_ / "data"));
  press(Key::Backspace);
  EXPECT_EQ(dialog_.folder(), folder_.path());
  press(Key::Down);
  press(Key::Down);
  press(Key::Down);
  press(Key::Down);
  press(Key::Up);
  press(Key::Enter);
  EXPECT_EQ(result_, fs::path(folder_ / "a.vti"));
  open();
  press(Key::Down);
  press(Key::Down);
  press(Key::Enter);
  EXPECT_EQ(result_, fs::path(folder_ / longer));
}

TEST_F(FileDialogTest, EscapeAndCancelCloseWithoutAFile) {
  open();
  press(Key::Escape);
  EXPECT_FALSE(dialog_.isOpen());
  open();
  click("file/cancel");
  EXPECT_FALSE(dialog_.isOpen());
  EXPECT_FALSE(result_);
}

TEST_F(FileDialogTest, TypedPathsAreCompletedAndOpened) {
  open();
  type("da");
  press(Key::Tab);
  type("c");
  press(Key::Tab);
  press(Key::Enter);
  EXPECT_EQ(result_, fs::path(folder_ / "data/c.pcd"));
  open();
  type(folder_ / "b.vantage");
  press(Key::Enter);
  EXPECT_EQ(result_, fs::path(folder_ / "b.vantage"));
}

TEST_F(FileDialogTest, DeletingTheLastLetterDoesNotLeaveTheFolder) {
  open();
  type("x");
  press(Key::Backspace);
  EXPECT_EQ(dialog_.folder(), folder_.path());
  press(Key::Backspace);
  EXPECT_EQ(dialog_.folder(), folder_.path().parent_path());
}

TEST_F(FileDialogTest, WhatIsNotThereStaysInTheDialogWithALine) {
  open();
  press(Key::Enter);
  EXPECT_THAT(dialog_.problem(), HasSubstr("choose a file"));
  type("none.vantage");
  press(Key::Enter);
  EXPECT_THAT(dialog_.problem(), HasSubstr("none.vantage does not exist"));
  EXPECT_TRUE(dialog_.isOpen());
}

TEST_F(FileDialogTest, SavingAsksBeforeItReplaces) {
  open(FileDialog::Mode::Save, "b.vantage");
  press(Key::Enter);
  EXPECT_FALSE(result_);
  click("file/keep");
  EXPECT_FALSE(result_);
  EXPECT_TRUE(dialog_.isOpen());
  click("file/accept");
  press(keyOf('Y'));
  EXPECT_EQ(result_, fs::path(folder_ / "b.vantage"));
}

TEST_F(FileDialogTest, SavingListsFoldersAndFilesOfItsKindAlone) {
  open(FileDialog::Mode::Save, "config.toml");
  EXPECT_THAT(names(), ElementsAre("data", "Zoo.toml"));
  click("file/all");
  EXPECT_THAT(names(), ElementsAre("data", "a.vti", "b.vantage", "notes.txt", "Zoo.toml"));
}

TEST_F(FileDialogTest, EnterOnAFolderOpensItAndTheNameStays) {
  for (const bool by_mouse : {false, true}) {
    open(FileDialog::Mode::Save, "config.toml");
    if (by_mouse)
      click("file/entry data");
    else
      press(Key::Down);
    press(Key::Enter);
    EXPECT_EQ(dialog_.folder(), fs::path(folder_ / "data"));
    EXPECT_FALSE(result_);
    press(Key::Enter);
    EXPECT_EQ(result_, fs::path(folder_ / "data/config.toml"));
    result_.reset();
  }
}

TEST_F(FileDialogTest, ANameWithoutAnEndingGetsThatOfTheFileToSave) {
  writeFile(folder_ / "mine.toml", "x");
  open(FileDialog::Mode::Save, "config.toml");
  click("file/name");
  ImGui::GetIO().KeyCtrl = true;
  press(keyOf('A'));
  ImGui::GetIO().KeyCtrl = false;
  type("mine");
  press(Key::Enter);
  EXPECT_FALSE(result_) << "mine.toml is there";
  press(keyOf('Y'));
  EXPECT_EQ(result_, fs::path(folder_ / "mine.toml"));
}

TEST_F(FileDialogTest, TheListTakesAllRoomThatIsLeft) {
  open();
  const ImGuiStyle& style = ImGui::GetStyle();
  const auto strip = [&] {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    const double em = ImGui::GetFontSize(), height = std::min(screen.y - 2 * em, 34 * em);
    return (screen.y + height) / 2 - style.WindowPadding.y - widgets_.find("file/cancel")->bottom;
  };
  EXPECT_NEAR(strip(), 0.0, 2.0);
  press(Key::Enter);
  ASSERT_NE(dialog_.problem(), "");
  EXPECT_GT(strip(), ImGui::GetFontSize() - 1.0) << "the line about the problem is below";
}

TEST_F(FileDialogTest, SavingUnderANewNameNeedsAFolderThatIsThere) {
  open(FileDialog::Mode::Save);
  type("none/new.toml");
  press(Key::Enter);
  EXPECT_THAT(dialog_.problem(), HasSubstr("is no folder"));
  dialog_.close();
  frames();
  open(FileDialog::Mode::Save, "new.toml");
  press(Key::Enter);
  EXPECT_EQ(result_, fs::path(folder_ / "new.toml"));
}

TEST_F(FileDialogTest, BeginsInTheNearestFolderThatIsThere) {
  dialog_.open(FileDialog::Mode::Open, folder_ / "gone/further");
  EXPECT_EQ(dialog_.folder(), folder_.path());
}

TEST_F(FileDialogTest, AFolderThatCannotBeReadIsToldInTheDialog) {
  fs::create_directories(folder_ / "gone");
  dialog_.open(FileDialog::Mode::Open, folder_ / "gone");
  frames(3);
  fs::remove(folder_ / "gone");
  click("file/hidden");  // lists anew
  EXPECT_THAT(dialog_.problem(), HasSubstr("gone cannot be read"));
  EXPECT_TRUE(dialog_.isOpen());
  click("file/up");
  EXPECT_EQ(dialog_.folder(), folder_.path());
  EXPECT_EQ(dialog_.problem(), "");
}

TEST(TypedPath, IsRelativeToTheFolderUnlessItSaysOtherwise) {
  EXPECT_EQ(typedPath("/a/b", "c.vti"), "/a/b/c.vti");
  EXPECT_EQ(typedPath("/a/b", "../c/"), "/a/c");
  EXPECT_EQ(typedPath("/a/b", "/x"), "/x");
  EXPECT_EQ(typedPath("/a/b", "/"), "/");
  EXPECT_EQ(typedPath("/a/b", ""), "/a/b");
  if (const char* home = std::getenv("HOME")) {
    EXPECT_EQ(typedPath("/a", "~/x"), fs::path(home) / "x");
    EXPECT_EQ(typedPath("/a", "~"), fs::path(home).lexically_normal());
  }
}

TEST(CompletedPath, GoesAsFarAsNamesAgree) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "room");
  for (const char* name : {"run one.vantage", "run two.vantage", "room/x", ".rc"})
    writeFile(folder / name, "x");
  EXPECT_EQ(completedPath(folder.path(), "ru"), "run ");
  EXPECT_EQ(completedPath(folder.path(), "run t"), "run two.vantage");
  EXPECT_EQ(completedPath(folder.path(), "ro"), "room/");
  EXPECT_EQ(completedPath(folder.path(), "room/"), "room/x");
  EXPECT_EQ(completedPath(folder.path(), "."), ".rc");
  EXPECT_EQ(completedPath(folder.path(), "z"), "z");
  EXPECT_EQ(completedPath("/", folder / "roo"), folder / "room/");
}

}  // namespace
}  // namespace vantage::test
