#include "viewer/panels/file_dialog.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <functional>
#include <system_error>
#include <utility>

#include "viewer/file_kind.h"
#include "viewer/keys.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

constexpr ImGuiWindowFlags kDialog = ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize;
constexpr std::size_t kMostEntries = 50'000;

bool pressed(Key key) {
  return ImGui::IsKeyPressed(static_cast<int>(key), true);
}

bool enterPressed() {
  return pressed(Key::Enter) || pressed(Key::KeypadEnter);
}

bool isHidden(const std::string& name) {
  return name.starts_with('.');
}

std::string endingOf(const std::string& name) {
  std::string ending = fs::path(name).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return std::tolower(c); });
  return ending;
}

std::string sizeText(std::uintmax_t bytes) {
  static constexpr const char* kUnits[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  double size = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; size >= 1024.0 && unit + 1 < std::size(kUnits); ++unit) size /= 1024.0;
  char text[32];
  std::snprintf(text, sizeof text, unit == 0 ? "%.0f %s" : "%.1f %s", size, kUnits[unit]);
  return text;
}

/// Folders first, then by name as a person sorts: without regard to capitals.
bool before(const FileDialog::Entry& a, const FileDialog::Entry& b) {
  if (a.folder != b.folder) return a.folder;
  const auto less = [](unsigned char x, unsigned char y) { return std::tolower(x) < std::tolower(y); };
  if (std::ranges::lexicographical_compare(a.name, b.name, less)) return true;
  return !std::ranges::lexicographical_compare(b.name, a.name, less) && a.name < b.name;
}

/// As it is listed and typed: folders end in /.
std::string nameOf(const FileDialog::Entry& entry) {
  return entry.name + (entry.folder ? "/" : "");
}

/// What a folder holds. \param error why it cannot be read
std::vector<FileDialog::Entry> entriesOf(const fs::path& folder, std::error_code& error) {
  std::vector<FileDialog::Entry> all;
  for (fs::directory_iterator at(folder, error), end; !error && at != end && all.size() < kMostEntries;
       at.increment(error)) {
    std::error_code unreadable;  // of the entry alone: it is listed without a size
    FileDialog::Entry entry{at->path().filename().string(), at->is_directory(unreadable), 0};
    if (!entry.folder && at->is_regular_file(unreadable)) entry.bytes = at->file_size(unreadable);
    if (unreadable) entry.bytes = 0;
    all.push_back(std::move(entry));
  }
  std::ranges::sort(all, before);
  return all;
}

/// What the callbacks of the field work on.
struct FieldKeys {
  std::function<std::string(const std::string&)> complete;
  /// Down or up in the list; gives the name there, or nothing if the list is empty. The field's own text
  /// must not change before the field is done.
  std::function<std::optional<std::string>(int)> step;
};

void replaceText(ImGuiInputTextCallbackData& data, const std::string& text) {
  data.DeleteChars(0, data.BufTextLen);
  data.InsertChars(0, text.c_str());
}

int onFieldKey(ImGuiInputTextCallbackData* data) {
  const auto& field = *static_cast<const FieldKeys*>(data->UserData);
  if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion)
    replaceText(*data, field.complete(data->Buf));
  if (data->EventFlag == ImGuiInputTextFlags_CallbackHistory)
    if (const auto name = field.step(data->EventKey == ImGuiKey_UpArrow ? -1 : 1)) replaceText(*data, *name);
  return 0;
}

}  // namespace

fs::path typedPath(const fs::path& folder, const std::string& typed) {
  const char* home = std::getenv("HOME");
  const bool at_home = typed == "~" || typed.starts_with("~/");
  const fs::path path = at_home && home
                            ? fs::path(home) / typed.substr(std::min<std::size_t>(2, typed.size()))
                            : fs::path(typed);
  const fs::path whole = (path.is_absolute() ? path : folder / path).lexically_normal();
  return whole.has_filename() || whole == whole.root_path() ? whole : whole.parent_path();
}

std::string completedPath(const fs::path& folder, const std::string& typed) {
  const std::size_t slash = typed.rfind('/');
  const std::string lead = slash == std::string::npos ? "" : typed.substr(0, slash + 1);
  const std::string begun = typed.substr(lead.size());
  std::error_code error;
  std::optional<std::string> common;
  for (const FileDialog::Entry& entry : entriesOf(typedPath(folder, lead), error)) {
    if (!entry.name.starts_with(begun) || (isHidden(entry.name) && !isHidden(begun))) continue;
    const std::string name = nameOf(entry);
    if (!common) {
      common = name;
    } else {
      const auto differ = std::ranges::mismatch(*common, name);
      common->erase(differ.in1, common->end());
    }
  }
  return common ? lead + *common : typed;
}

void FileDialog::open(Mode mode, const fs::path& folder, const std::string& name) {
  mode_ = mode;
  open_ = appearing_ = focus_field_ = true;
  existing_.reset();
  result_.reset();
  std::error_code error;
  fs::path nearest = fs::absolute(folder.empty() ? fs::path(".") : folder, error).lexically_normal();
  while (!fs::is_directory(nearest, error) && nearest.has_relative_path()) nearest = nearest.parent_path();
  file_ = name;
  ending_ = mode == Mode::Save ? endingOf(name) : "";
  goTo(nearest);
  name_ = name;
}

void FileDialog::close() {
  open_ = false;
  existing_.reset();
}

void FileDialog::goTo(const fs::path& folder) {
  folder_ = folder.has_filename() || folder == folder.root_path() ? folder : folder.parent_path();
  name_ = mode_ == Mode::Save ? file_ : "";
  list();
}

void FileDialog::list() {
  std::error_code error;
  problem_.clear();
  entries_ = entriesOf(folder_, error);
  if (error) problem_ = folder_.string() + " cannot be read: " + error.message();
  std::erase_if(entries_, [&](const Entry& entry) {
    return (!show_hidden_ && isHidden(entry.name)) || (!show_all_ && !entry.folder && !isWanted(entry.name));
  });
  chosen_ = -1;
}

bool FileDialog::isWanted(const std::string& name) const {
  const std::string ending = endingOf(name);
  if (!ending_.empty()) return ending == ending_;
  return std::ranges::find(knownEndings(), ending) != knownEndings().end();
}

bool FileDialog::folderIsChosen() const {
  return chosen_ >= 0 && entries_[chosen_].folder && name_ == nameOf(entries_[chosen_]);
}

int FileDialog::listedIndex(int index) const {
  return std::clamp(index, 0, static_cast<int>(entries_.size()) - 1);
}

void FileDialog::choose(int index) {
  if (entries_.empty()) return;
  chosen_ = listedIndex(index);
  name_ = nameOf(entries_[chosen_]);
  if (!entries_[chosen_].folder) file_ = name_;
  problem_.clear();
  scroll_ = true;
}

void FileDialog::accept() {
  problem_.clear();
  if (name_.empty()) {
    problem_ = mode_ == Mode::Open ? "choose a file, or type its path" : "type a name";
    return;
  }
  std::error_code error;
  fs::path path = typedPath(folder_, name_);
  if (fs::is_directory(path, error)) return goTo(path);
  if (mode_ == Mode::Save && !path.has_extension()) path += ending_;
  const bool there = fs::exists(path, error);
  if (mode_ == Mode::Open && !there) {
    problem_ = path.string() + " does not exist";
  } else if (mode_ == Mode::Save && !fs::is_directory(path.parent_path(), error)) {
    problem_ = path.parent_path().string() + " is no folder; nothing can be saved there";
  } else if (mode_ == Mode::Save && there) {
    existing_ = path;
  } else {
    result_ = path;
  }
}

void FileDialog::drawPlace(Widgets& widgets) {
  if (widgets.button("file/up", "Up", folder_.has_relative_path(), "the folder above (Backspace)"))
    goTo(folder_.parent_path());
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(folder_.string().c_str());
}

std::string FileDialog::question() const {
  return existing_->filename().string() + " exists. Replace it?";
}

/// What is drawn below the list.
float FileDialog::footerHeight() const {
  const float line = ImGui::GetFrameHeightWithSpacing(), gap = ImGui::GetStyle().ItemSpacing.y;
  const std::string text = existing_ ? question() : problem_;
  const float lines = text.empty() ? 0.0f : ImGui::CalcTextSize(inLines(text).c_str()).y + gap;
  return lines + (existing_ ? line : 2.0f * line);
}

void FileDialog::drawEntries(Widgets& widgets) {
  int entered = -1;
  if (ImGui::BeginChild("entries", {0.0f, -footerHeight()}, true)) {
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(entries_.size()));
    if (scroll_ && chosen_ >= 0)
      ImGui::SetScrollFromPosY(ImGui::GetCursorStartPos().y +
                                   static_cast<float>(chosen_) * ImGui::GetTextLineHeightWithSpacing() -
                                   ImGui::GetScrollY(),
                               0.5f);
    scroll_ = false;
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const Entry& entry = entries_[i];
        if (ImGui::Selectable(nameOf(entry).c_str(), i == chosen_, ImGuiSelectableFlags_AllowDoubleClick)) {
          choose(i);
          scroll_ = false;
          if (ImGui::IsMouseDoubleClicked(0)) entered = i;
        }
        widgets.note("file/entry " + entry.name);
        if (entry.folder) continue;
        const std::string size = sizeText(entry.bytes);
        ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(size.c_str()).x);
        ImGui::TextDisabled("%s", size.c_str());
      }
    if (entries_.empty() && show_all_)
      ImGui::TextDisabled("nothing here");
    else if (entries_.empty())
      ImGui::TextDisabled("no folders, and no files %s",
                          ending_.empty() ? "that the program knows" : ("*" + ending_).c_str());
  }
  ImGui::EndChild();
  if (entered >= 0) accept();
}

void FileDialog::drawField(Widgets& widgets) {
  std::optional<int> stepped;
  FieldKeys field{[this](const std::string& typed) { return completedPath(folder_, typed); },
                  [&](int step) -> std::optional<std::string> {
                    if (entries_.empty()) return std::nullopt;
                    stepped = listedIndex(chosen_ + step);
                    return nameOf(entries_[*stepped]);
                  }};
  const bool was_empty = name_.empty();
  if (focus_field_) ImGui::SetKeyboardFocusHere();
  focus_field_ = false;
  ImGui::SetNextItemWidth(-FLT_MIN);
  const bool entered = ImGui::InputTextWithHint(
      "##name", mode_ == Mode::Open ? "path (Tab completes)" : "name (Tab completes)", &name_,
      ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_CallbackCompletion |
          ImGuiInputTextFlags_CallbackHistory,
      onFieldKey, &field);
  if (stepped) choose(*stepped);
  if (ImGui::IsItemEdited() && !folderIsChosen()) file_ = fs::path(name_).filename().string();
  typing_ = ImGui::IsItemActive() && !(was_empty && name_.empty());
  widgets.note("file/name");
  if (entered) {
    accept();
    focus_field_ = !result_ && !existing_;
  }
}

void FileDialog::drawButtons(Widgets& widgets) {
  if (widgets.toggle("file/hidden", "hidden files", show_hidden_)) list();
  ImGui::SameLine();
  if (widgets.toggle("file/all", "all files", show_all_)) list();
  const char* verb = folderIsChosen() ? "Enter" : mode_ == Mode::Open ? "Open" : "Save";
  const float right = ImGui::CalcTextSize(verb).x + ImGui::CalcTextSize("Cancel").x +
                      4 * ImGui::GetStyle().FramePadding.x + ImGui::GetStyle().ItemSpacing.x;
  ImGui::SameLine(ImGui::GetContentRegionMax().x - right);
  if (widgets.button("file/accept", verb)) accept();
  ImGui::SameLine();
  if (widgets.button("file/cancel", "Cancel")) close();
}

void FileDialog::drawQuestion(Widgets& widgets) {
  wrappedText(question());
  const bool replace = widgets.button("file/replace", "Replace (Y)");
  ImGui::SameLine();
  const bool keep = widgets.button("file/keep", "Keep it (N)");
  if (replace || pressed(keyOf('Y'))) {
    result_ = existing_;
  } else if (keep || pressed(keyOf('N')) || pressed(Key::Escape)) {
    existing_.reset();
    focus_field_ = true;
  }
}

void FileDialog::keys() {
  if (pressed(Key::Escape)) return close();
  if (typing_) return;
  const bool in_field = ImGui::GetIO().WantTextInput;  // which knows arrows and Enter itself
  if (!in_field && pressed(Key::Down)) choose(chosen_ + 1);
  if (!in_field && pressed(Key::Up)) choose(chosen_ - 1);
  if (pressed(Key::Backspace) && folder_.has_relative_path()) goTo(folder_.parent_path());
  if (!in_field && enterPressed() && !ImGui::IsAnyItemActive()) accept();
}

std::optional<fs::path> FileDialog::draw(Widgets& widgets) {
  if (!open_) return std::nullopt;
  const char* title = mode_ == Mode::Open ? "Open a file" : "Save as";
  if (appearing_) ImGui::OpenPopup(title);
  appearing_ = false;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float em = ImGui::GetFontSize();
  const ImVec2 wanted(std::min(size.x - 2 * em, 48 * em), std::min(size.y - 2 * em, 34 * em));
  ImGui::SetNextWindowPos({(size.x - wanted.x) / 2, (size.y - wanted.y) / 2});
  ImGui::SetNextWindowSize(wanted);
  if (ImGui::BeginPopupModal(title, nullptr, kDialog)) {
    drawPlace(widgets);
    drawEntries(widgets);
    if (existing_) {
      drawQuestion(widgets);
    } else {
      drawField(widgets);
      drawButtons(widgets);
      if (!problem_.empty()) wrappedText(problem_);
      if (open_ && !result_ && !existing_) keys();
    }
    if (result_) close();
    if (!open_) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  } else {
    close();  // something else has closed the popup
  }
  return std::exchange(result_, std::nullopt);
}

}  // namespace vantage
