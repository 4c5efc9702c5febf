#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "viewer/candidates.h"
#include "viewer/step_data.h"

namespace vantage {

/// What a table of candidates can be sorted by.
enum class CandidateColumn : std::uint8_t {
  Rank,
  Change,
  View,
  Gain,     ///< contour planners
  Utility,  ///< hierarchical planner
  Segment,  ///< place of the segment in the order
  Saliency,
  Unknown,
  Occupied,
  Surface,
  DistanceFactor,
  Distance,
  Verdict,
};

/// How a column is called and what it says.
struct CandidateColumnText {
  CandidateColumn column;
  std::string_view name;   ///< unique: "gain"
  std::string_view title;  ///< short, in the head of the table
  std::string_view about;
  bool largest_first = true;  ///< what a first click sorts by
};

/// Columns for the planner of a step, the important ones first.
const std::vector<CandidateColumnText>& candidateColumns(bool hierarchical);

/// Which rows are listed.
struct CandidateFilter {
  std::string text = {};                      ///< part of the id; empty = any
  bool ranked_only = false;                   ///< only views with a place, and what is pending
  bool reachable_only = false;                ///< none that the robot is known not to be able to take
  std::optional<std::uint32_t> segment = {};  ///< label; places in the order change with every threshold
  bool operator==(const CandidateFilter&) const = default;
};

/// Rows that pass the filter, as indices, sorted, but the view whose id is the filter's text first. Rows
/// without a value in the column come last, pending ones before the others; equal ones keep their order. The
/// same for the same input.
std::vector<std::uint32_t> listedRows(const std::vector<CandidateRow>& rows, const CandidateFilter& filter,
                                      CandidateColumn column, bool descending);

/// The candidates of what is shown, compared with the recorded ones, sorted and filtered. Does work only when
/// something changed.
class CandidateTable {
 public:
  /// Takes over another step or decision; keeps order and filter, but for that by segment if segments are
  /// others. As long as both have the same header, nothing is tried out: what is shown is then what later
  /// decisions are compared with, with more segments scored than recorded maybe.
  void show(const StepData& recorded, const StepData& shown);
  /// True if that is another order than before.
  bool sortBy(CandidateColumn column, bool descending);
  void filter(const CandidateFilter& filter);

  const std::vector<CandidateRow>& rows() const { return rows_; }
  /// Indices into rows() in the order of the table.
  const std::vector<std::uint32_t>& listed();
  const CandidateFilter& filter() const { return filter_; }
  bool hierarchical() const { return hierarchical_; }
  /// Something is tried out, so that places may differ from the recorded ones.
  bool compares() const { return compares_; }
  /// Row of a candidate; null if there is none.
  const CandidateRow* find(std::uint32_t id) const;
  /// Its place in listed(); empty if it is not listed.
  std::optional<std::size_t> placeOf(std::uint32_t id);
  /// The view that is listed `by` places after another one, or before it if negative, pending segments not
  /// counted, at most to the end; the first one listed if it is not listed. Empty if no view is listed.
  std::optional<std::uint32_t> neighbour(std::optional<std::uint32_t> id, int by);
  /// Differs whenever rows() do.
  std::uint64_t revision() const { return revision_; }

 private:
  std::weak_ptr<const StepRecord> recorded_, shown_;  ///< whose rows these are
  std::weak_ptr<const RunHeader> recorded_header_, shown_header_;
  std::weak_ptr<const Labels> shown_labels_;  ///< what the filter by segment is about
  std::vector<CandidateRow> recorded_rows_, rows_;
  std::vector<std::uint32_t> listed_;
  CandidateFilter filter_;
  CandidateColumn column_ = CandidateColumn::Rank;
  bool descending_ = false, hierarchical_ = false, compares_ = false, stale_ = true;
  std::uint64_t revision_ = 0;
};

}  // namespace vantage
