// Table of the candidate views: places, factors, and why a view fell out; what changed against the run.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "viewer/captions.h"
#include "viewer/panels/panel.h"
#include "viewer/panels/plot.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

/// Width of a column in letters.
float widthOf(CandidateColumn column) {
  switch (column) {
    case CandidateColumn::Rank:
      return 2.6f;
    case CandidateColumn::Change:
      return 2.5f;
    case CandidateColumn::View:
      return 3.2f;
    case CandidateColumn::Gain:
    case CandidateColumn::Utility:
      return 3.5f;
    case CandidateColumn::Segment:
      return 2.1f;
    case CandidateColumn::Verdict:
      return 5.6f;
    case CandidateColumn::Unknown:
      return 4.2f;
    default:
      return 4.6f;
  }
}

struct Colored {
  std::string text;
  std::optional<Rgb> color = {};
};

/// Arrow and places; thousands as "1k".
Colored changeText(const RankChange& change, const Theme& theme) {
  const std::string places =
      change.places < 1000 ? std::to_string(change.places) : std::to_string(change.places / 1000) + "k";
  switch (change.kind) {
    case RankChange::Kind::Up:
      return {"▲" + places, theme.second_curve};
    case RankChange::Kind::Down:
      return {"▼" + places, theme.warning};
    case RankChange::Kind::New:
      return {"new", theme.second_curve};
    case RankChange::Kind::Gone:
      return {"gone", theme.warning};
    case RankChange::Kind::Same:
    case RankChange::Kind::None:
      break;
  }
  return {""};
}

Colored verdictText(const CandidateRow& row, const Theme& theme) {
  if (row.chosen()) return {"◆ chosen", theme.chosen};
  if (row.verdict == ViewVerdict::Unreachable || !row.rank) return {verdictWord(row), theme.faint};
  return {verdictWord(row)};
}

/// What was never computed is a dash.
Colored cellText(const CandidateRow& row, CandidateColumn column, const SceneFrame& frame,
                 const Theme& theme) {
  switch (column) {
    case CandidateColumn::Verdict:
      return verdictText(row, theme);
    case CandidateColumn::Segment:
      return {frame.record.search ? segmentName(frame, row.group) : ""};
    case CandidateColumn::Saliency:
      return {fixed(row.saliency)};
    default:
      break;
  }
  if (row.pending()) return {column == CandidateColumn::Rank ? "…" : "", theme.faint};
  const Colored never{"–", theme.faint};
  const bool hierarchical = frame.record.utilities != nullptr;
  switch (column) {
    case CandidateColumn::Rank:
      return {row.rank ? std::to_string(*row.rank) : "–"};
    case CandidateColumn::Change:
      return changeText(row.change, theme);
    case CandidateColumn::View:
      return {std::to_string(row.id)};
    case CandidateColumn::Gain:
      return {whole(row.score)};
    case CandidateColumn::Utility:
      return row.survived() ? Colored{fixed(row.score, 4)} : never;
    case CandidateColumn::Unknown:
      return row.cast() || !hierarchical ? Colored{whole(row.unknown)} : never;
    case CandidateColumn::Occupied:
      return row.cast() || !hierarchical ? Colored{whole(row.occupied)} : never;
    case CandidateColumn::Surface:
      return row.survived() ? Colored{fixed(row.surface, 3)} : never;
    case CandidateColumn::DistanceFactor:
      return row.survived() ? Colored{fixed(row.distance_factor, 3)} : never;
    default:
      return {fixed(row.distance_m)};
  }
}

bool isNumber(CandidateColumn column) {
  return column != CandidateColumn::Verdict && column != CandidateColumn::Change;
}

void cell(const Colored& cell, bool to_the_right) {
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
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY |
                                       ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV |
                                       ImGuiTableFlags_Resizable | ImGuiTableFlags_Hideable |
                                       ImGuiTableFlags_Sortable | ImGuiTableFlags_NoSavedSettings;
    const char* id = state_.table.hierarchical() ? "views by utility" : "views by gain";
    if (!ImGui::BeginTable(id, static_cast<int>(columns_.size()), kFlags)) return;
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
      ImGui::TableSetupColumn(column.name.data(), flags, widthOf(column.column) * ImGui::GetFontSize());
    }
    for (int i = 0; i < static_cast<int>(columns_.size()); ++i)
      if (columns_[i].column == CandidateColumn::Change)
        ImGui::TableSetColumnEnabled(i, state_.table.compares());
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (int i = 0; i < static_cast<int>(columns_.size()); ++i) {
      if (!ImGui::TableSetColumnIndex(i)) continue;
      headerCell(columns_[i]);
      tip(std::string(columns_[i].about) + ". Click to sort.");
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
    if (specs->SpecsDirty) ImGui::SetScrollY(0.0f);
    specs->SpecsDirty = false;
    const ImGuiTableColumnSortSpecs& first = specs->Specs[0];
    state_.table.sortBy(columns_[first.ColumnIndex].column,
                        first.SortDirection == ImGuiSortDirection_Descending);
  }

  /// A view that was selected elsewhere is brought into the table's window.
  void scrollToSelected() {
    if (explained_ == state_.scrolled_to) return;
    state_.scrolled_to = explained_;
    if (!explained_) return;
    const auto place = state_.table.placeOf(*explained_);
    if (!place) return;
    const float middle = (static_cast<float>(*place) + 2.0f) * rowHeight() - ImGui::GetWindowHeight() / 2.0f;
    ImGui::SetScrollY(std::max(0.0f, middle));
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
    if (row.chosen()) markChosen(at);
    ImGui::SetCursorScreenPos(at);
    for (int i = 0; i < static_cast<int>(columns_.size()); ++i) {
      if (!ImGui::TableSetColumnIndex(i)) continue;
      const CandidateColumn column = columns_[i].column;
      cell(cellText(row, column, frame_, context_.theme), isNumber(column));
    }
    ImGui::PopID();
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
    state_.scrolled_to = id;
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
};

/// Which rows are listed.
void filterLine(PanelContext& context) {
  CandidateTable& table = context.candidates.table;
  CandidateFilter filter = table.filter();
  context.widgets.field("candidates/filter", filter.text, ImGui::GetFontSize() * 5.5, "view no.");
  ImGui::SameLine();
  context.widgets.toggle("candidates/ranked only", "ranked", filter.ranked_only);
  tip("only views that are good enough, and segments that are not scored yet");
  if (!table.hierarchical()) {
    const auto view = context.model.explainedView();
    const CandidateRow* row = view ? table.find(*view) : nullptr;
    bool only = filter.group.has_value();
    ImGui::SameLine();
    ImGui::BeginDisabled(!only && !row);
    if (context.widgets.toggle("candidates/segment only", "its segment", only)) {
      filter.group.reset();
      if (only && row) filter.group = row->group;
    }
    ImGui::EndDisabled();
    tip("only views of the selected view's segment");
  }
  table.filter(filter);
}

void countsLine(PanelContext& context) {
  CandidateTable& table = context.candidates.table;
  const auto& rows = table.rows();
  const auto ranked = std::ranges::count_if(rows, [](const CandidateRow& r) { return r.rank.has_value(); });
  const auto pending = std::ranges::count_if(rows, &CandidateRow::pending);
  std::string text = grouped(ranked) + " of " + plural(rows.size() - pending, "view") + " ranked";
  if (pending > 0) text += ", " + plural(pending, "segment") + " pending";
  if (table.listed().size() != rows.size()) text += "; " + grouped(table.listed().size()) + " listed";
  faintText(context.theme, text);
}

}  // namespace

void candidatesPanel(PanelContext& context) {
  CandidateTable& table = context.candidates.table;
  table.show(context.model.recorded(), context.model.shown());
  if (table.rows().empty()) {
    faintText(context.theme,
              context.model.shown().empty() ? "No step is open." : "No views were evaluated here.");
    return;
  }
  filterLine(context);
  countsLine(context);
  Table(context).draw();
}

}  // namespace vantage
