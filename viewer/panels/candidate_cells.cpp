#include "viewer/panels/candidate_cells.h"

#include <imgui.h>

#include <algorithm>
#include <vector>

#include "viewer/captions.h"
#include "viewer/view_words.h"

namespace vantage {
namespace {

/// The widest text that a column is made for.
const char* widestOf(CandidateColumn column, bool hierarchical) {
  switch (column) {
    case CandidateColumn::Rank:
      return hierarchical ? "999" : "9999";
    case CandidateColumn::Change:
      return "gone";
    case CandidateColumn::Gain:
      return "999 999";
    case CandidateColumn::View:
      return hierarchical ? "9999" : "99999";
    case CandidateColumn::Segment:
      return "99";
    case CandidateColumn::Saliency:
      return "0.99";
    case CandidateColumn::Utility:
      return "0.9999";
    case CandidateColumn::Surface:
    case CandidateColumn::DistanceFactor:
      return "0.999";
    case CandidateColumn::Verdict:
      return hierarchical ? "registration" : "out of reach";
    default:
      return "99 999";
  }
}

/// Arrow and places; thousands as "1k".
ColoredText changeText(const RankChange& change, const Theme& theme) {
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

ColoredText verdictText(const CandidateRow& row, const Theme& theme) {
  if (row.chosen()) return {"◆ chosen", theme.chosen};
  if (row.verdict == ViewVerdict::Unreachable || !row.rank) return {verdictWord(row), theme.faint};
  return {verdictWord(row)};
}

}  // namespace

float columnWidth(const CandidateColumnText& column, bool hierarchical) {
  return std::max(ImGui::CalcTextSize(column.title.data()).x,
                  ImGui::CalcTextSize(widestOf(column.column, hierarchical)).x);
}

std::string columnHelp(const CandidateColumnText& column, bool hierarchical) {
  std::string text = std::string(column.about) + ". Click to sort.";
  if (column.column != CandidateColumn::Verdict) return text;
  using V = ViewVerdict;
  static const std::vector<V> contour = {V::Chosen,         V::Eligible,    V::LaterSegment,
                                         V::BelowThreshold, V::TakenBefore, V::Waiting};
  static const std::vector<V> octree = {V::Chosen,  V::Eligible,    V::NotFree,       V::LittleSurface,
                                        V::Stopped, V::TakenBefore, V::BelowThreshold};
  for (const V verdict : hierarchical ? octree : contour)
    text +=
        "\n" + verdictWord({.verdict = verdict}) + ": " + std::string(verdictMeaning(verdict, hierarchical));
  return text + "\nout of reach, in collision, cut off, no path: " +
         std::string(verdictMeaning(V::Unreachable, hierarchical));
}

ColoredText cellText(const CandidateRow& row, CandidateColumn column, const SceneFrame& frame,
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
  const ColoredText never{"–", theme.faint};
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
      return row.survived() ? ColoredText{fixed(row.score, 4)} : never;
    case CandidateColumn::Unknown:
      return row.cast() || !hierarchical ? ColoredText{whole(row.unknown)} : never;
    case CandidateColumn::Occupied:
      return row.cast() || !hierarchical ? ColoredText{whole(row.occupied)} : never;
    case CandidateColumn::Surface:
      return row.survived() ? ColoredText{fixed(row.surface, 3)} : never;
    case CandidateColumn::DistanceFactor:
      return row.survived() ? ColoredText{fixed(row.distance_factor, 3)} : never;
    default:
      return {fixed(row.distance_m)};
  }
}

bool isNumber(CandidateColumn column) {
  return column != CandidateColumn::Verdict && column != CandidateColumn::Change;
}

}  // namespace vantage
