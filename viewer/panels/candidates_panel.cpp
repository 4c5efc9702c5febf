// Table of the candidate views, and which of them it lists.
#include <imgui.h>

#include <algorithm>
#include <utility>

#include "viewer/captions.h"
#include "viewer/panels/candidate_cells.h"
#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

void cell(const ColoredText& cell, bool to_the_right) {
  if (to_the_right) {
    const float free = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(cell.text.c_str()).x;
    if (free > 0.0f) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + free);
  }
  if (cell.color) ImGui::PushStyleColor(ImGuiCol_Text, packed(*cell.color));
  ImGui::TextUnformatted(cell.text.c_str());
  if (cell.color) ImGui::PopStyleColor();
}

class Table {
 public:
  explicit Table(PanelContext& context)
      : context_(context),
        state_(context.candidates),
        columns_(candidateColumns(state_.table.hierarchical())),
        frame_(context.model.shown().frame()),
        explained_(context.model.explainedView()) {}

  void draw() {
    if (state_.table.listed().empty()) {
      faintText(context_.theme, "No view passes the filter.");
      context_.widgets.note("candidates/nothing");
      return;
    }
    // Borders in the head alone: in the body they would take clicks on rows.
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY | ImGuiTableFlags_RowBg |
        ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_NoBordersInBody | ImGuiTableFlags_Resizable |
        ImGuiTableFlags_Hideable | ImGuiTableFlags_Sortable | ImGuiTableFlags_NoSavedSettings;
    const char* id = state_.table.hierarchical() ? "views by utility" : "views by gain";
    ImGui::PushStyleVar(ImGuiStyleVar_CellPadding,
                        {ImGui::GetFontSize() * 0.2f, ImGui::GetStyle().CellPadding.y});
    const bool open = ImGui::BeginTable(id, static_cast<int>(columns_.size()), kFlags);
    ImGui::PopStyleVar();
    if (!open) return;
    head();
    sort();
    scrollToSelected();
    const std::vector<std::uint32_t>& listed = state_.table.listed();
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(listed.size()), rowHeight());
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) row(state_.table.rows()[listed[i]]);
    ImGui::EndTable();
  }

 private:
  static float rowHeight() { return ImGui::GetTextLineHeight() + 2 * ImGui::GetStyle().CellPadding.y; }

  void head() {
    ImGui::TableSetupScrollFreeze(1, 1);
    for (const CandidateColumnText& column : columns_) {
      ImGuiTableColumnFlags flags = ImGuiTableColumnFlags_WidthFixed;
      if (column.largest_first) flags |= ImGuiTableColumnFlags_PreferSortDescending;
      if (column.column == CandidateColumn::Rank)
        flags |= ImGuiTableColumnFlags_DefaultSort | ImGuiTableColumnFlags_NoHide;
      ImGui::TableSetupColumn(column.name.data(), flags, columnWidth(column, state_.table.hierarchical()));
    }
    for (int i = 0; i < static_cast<int>(columns_.size()); ++i)
      if (columns_[i].column == CandidateColumn::Change)
        ImGui::TableSetColumnEnabled(i, state_.table.compares());
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (int i = 0; i < static_cast<int>(columns_.size()); ++i) {
      if (!ImGui::TableSetColumnIndex(i)) continue;
      headerCell(columns_[i]);
      tip(columnHelp(columns_[i], state_.table.hierarchical()));
    }
  }

  /// The title takes the whole cell: Dear ImGui would keep room for an arrow in every one.
  void headerCell(const CandidateColumnText& column) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::TableHeader(("##" + std::string(column.name)).c_str());
    context_.widgets.note("candidates/column " + std::string(column.name));
    ImGui::GetWindowDrawList()->AddText(at, ImGui::GetColorU32(ImGuiCol_Text), column.title.data());
  }

  void sort() {
    ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
    if (!specs || specs->SpecsCount < 1) return;
    specs->SpecsDirty = false;
    const ImGuiTableColumnSortSpecs& first = specs->Specs[0];
    sorted_ = state_.table.sortBy(columns_[first.ColumnIndex].column,
                                  first.SortDirection == ImGuiSortDirection_Descending);
  }

  /// Brings the selected view into the table's window when it has moved; another order, and what is typed,
  /// are looked at from the top.
  void scrollToSelected() {
    const CandidateState::Scrolled now = place(explained_), before = std::exchange(state_.scrolled, now);
    const bool typed = now.filter != before.filter && !now.filter.text.empty();
    if (sorted_ || typed) {
      ImGui::SetScrollY(0.0f);
    } else if (now != before && now.place) {
      const float middle =
          (static_cast<float>(*now.place) + 2.0f) * rowHeight() - ImGui::GetWindowHeight() / 2.0f;
      ImGui::SetScrollY(std::max(0.0f, middle));
    }
  }

  CandidateState::Scrolled place(std::optional<std::uint32_t> view) {
    return {view, view ? state_.table.placeOf(*view) : std::nullopt, state_.table.filter()};
  }

  void row(const CandidateRow& row) {
    ImGui::TableNextRow();
    ImGui::TableSetColumnIndex(0);
    ImGui::PushID(row.pending() ? -1 - static_cast<int>(row.group) : static_cast<int>(row.id));
    const bool selected = !row.pending() && row.id == explained_;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::BeginDisabled(row.pending());
    if (ImGui::Selectable("##row", selected, ImGuiSelectableFlags_SpanAllColumns)) select(row.id);
    ImGui::EndDisabled();
    noteRow(row);
    if (row.pending()) tip(plural(row.poses, "view") + " of this segment, not scored yet");
    if (!row.pending() && overVerdict()) tip(verdictTip(row));
    if (row.chosen()) markChosen(at);
    ImGui::SetCursorScreenPos(at);
    for (int i = 0; i < static_cast<int>(columns_.size()); ++i) {
      if (!ImGui::TableSetColumnIndex(i)) continue;
      const CandidateColumn column = columns_[i].column;
      cell(cellText(row, column, frame_, context_.theme), isNumber(column));
    }
    ImGui::PopID();
  }

  bool overVerdict() const {
    const auto verdict = std::ranges::find(columns_, CandidateColumn::Verdict, &CandidateColumnText::column);
    return ImGui::TableGetColumnFlags(static_cast<int>(verdict - columns_.begin())) &
           ImGuiTableColumnFlags_IsHovered;
  }

  std::string verdictTip(const CandidateRow& row) const {
    const bool known = row.verdict == ViewVerdict::Unreachable;
    return verdictWord(row) + ": " +
           std::string(known ? toString(row.reachability)
                             : verdictMeaning(row.verdict, state_.table.hierarchical()));
  }

  /// Names what of the row's whole length can be seen.
  void noteRow(const CandidateRow& row) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    const float left = ImGui::GetWindowPos().x, right = left + ImGui::GetWindowWidth();
    const WidgetBox box{.left = std::max(low.x, left),
                        .top = low.y,
                        .right = std::min(high.x, right),
                        .bottom = high.y,
                        .visible = ImGui::IsItemVisible(),
                        .enabled = !row.pending()};
    context_.widgets.note(row.pending() ? "candidates/pending " + std::to_string(row.group + 1)
                                        : "candidates/row " + std::to_string(row.id),
                          box);
  }

  void select(std::uint32_t id) {
    context_.model.selected_view = id;
    state_.scrolled = place(id);  // it is under the mouse
  }

  void markChosen(ImVec2 at) {
    const float left = at.x - ImGui::GetStyle().CellPadding.x;
    ImGui::GetWindowDrawList()->AddRectFilled({left, at.y}, {left + 3.0f, at.y + ImGui::GetTextLineHeight()},
                                              packed(context_.theme.chosen));
  }

  PanelContext& context_;
  CandidateState& state_;
  const std::vector<CandidateColumnText>& columns_;
  SceneFrame frame_;
  std::optional<std::uint32_t> explained_;
  bool sorted_ = false;  ///< anew in this frame
};

/// Part of a view's number, and a button that empties it, as Esc does. True if Enter was pressed.
bool numberField(Widgets& widgets, std::string& text) {
  const auto pressed = [](Key key) { return ImGui::IsKeyPressed(static_cast<int>(key), false); };
  const bool taken = widgets.field("candidates/filter", text, ImGui::GetFontSize() * 4.6, "view no.");
  const bool left = ImGui::IsItemDeactivated();
  if (text.empty()) tip("part of a view's number; Enter selects the first that is listed");
  if (left && pressed(Key::Escape)) text.clear();
  ImGui::SameLine(0.0f, 2.0f);
  if (widgets.button("candidates/clear filter", "×", !text.empty(), "list all numbers again (Esc)"))
    text.clear();
  return taken && (pressed(Key::Enter) || pressed(Key::KeypadEnter));
}

/// Selects the view that is listed first, that whose number was typed say.
void selectFirst(PanelContext& context) {
  CandidateTable& table = context.candidates.table;
  if (table.filter().text.empty() || table.listed().empty()) return;
  context.model.selected_view = table.rows()[table.listed().front()].id;
}

/// Which rows are listed.
void filterLine(PanelContext& context) {
  CandidateTable& table = context.candidates.table;
  CandidateFilter filter = table.filter();
  const bool entered = numberField(context.widgets, filter.text);
  ImGui::SameLine();
  context.widgets.toggle("candidates/ranked only", "ranked", filter.ranked_only);
  tip("only views that are good enough, and segments that are not scored yet");
  sameLineIfFits("reachable", Follows::CheckBox);
  context.widgets.toggle("candidates/reachable only", "reachable", filter.reachable_only);
  tip("without views that the robot was asked for and cannot take; those that it was not asked for stay");
  if (!table.hierarchical()) {
    const auto view = context.model.explainedView();
    const CandidateRow* row = view ? table.find(*view) : nullptr;
    bool only = filter.segment.has_value();
    sameLineIfFits("segment", Follows::CheckBox);
    ImGui::BeginDisabled(!only && !row);
    if (context.widgets.toggle("candidates/segment only", "segment", only)) {
      filter.segment.reset();
      if (only && row) filter.segment = row->segment;
    }
    ImGui::EndDisabled();
    tip("only views of the selected view's segment");
  }
  table.filter(filter);
  if (entered) selectFirst(context);
}

void countsLine(PanelContext& context) {
  CandidateTable& table = context.candidates.table;
  const auto& rows = table.rows();
  const auto ranked = std::ranges::count_if(rows, [](const CandidateRow& r) { return r.rank.has_value(); });
  const auto pending = std::ranges::count_if(rows, &CandidateRow::pending);
  std::string text = grouped(ranked) + " of " + plural(rows.size() - pending, "view") + " ranked";
  if (pending > 0) text += ", " + plural(pending, "segment") + " not scored";
  if (table.listed().size() != rows.size()) text += "; " + grouped(table.listed().size()) + " listed";
  faintText(context.theme, text);
}

}  // namespace

void candidatesPanel(PanelContext& context) {
  CandidateTable& table = context.candidates.table;
  table.show(context.model.recorded(), context.model.shown());
  if (table.rows().empty()) {
    if (context.model.shown().empty())
      emptyText(context, "views", "No step is open.");
    else
      faintText(context.theme, "No views were evaluated here.");
    return;
  }
  filterLine(context);
  countsLine(context);
  Table(context).draw();
}

}  // namespace vantage
