#include "viewer/candidate_table.h"

#include <algorithm>
#include <limits>

namespace vantage {
namespace {

constexpr CandidateColumnText kRank{CandidateColumn::Rank, "rank", "#",
                                    "Rank: place in the order in which the views are tried, 1 = first",
                                    false};
constexpr CandidateColumnText kChange{
    CandidateColumn::Change, "change", "±",
    "Change of rank against the run's own decision: ▲ 3 is tried three places earlier, ▼ 3 three later; new "
    "has a rank only now, gone has lost its own. Empty: as in the run"};
constexpr CandidateColumnText kView{CandidateColumn::View, "view", "view", "Number of the candidate", false};
constexpr CandidateColumnText kUnknown{CandidateColumn::Unknown, "unknown", "unknown",
                                       "Rays cast that end on unknown and count"};
constexpr CandidateColumnText kOccupied{CandidateColumn::Occupied, "occupied", "occupied",
                                        "Rays cast that end on known surface and count"};
constexpr CandidateColumnText kDistance{CandidateColumn::Distance, "distance", "away, m",
                                        "Straight distance from where the sensor is, in metres", false};
constexpr CandidateColumnText kVerdict{
    CandidateColumn::Verdict, "verdict", "verdict",
    "What became of the view; select it, and a sentence below the table says more", false};

/// The row's value has no place among the others of its column.
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Places won, lost ones negative; new ones above all that moved, gone ones below.
double sortedChange(const RankChange& change) {
  constexpr double kBeyond = 1e12;
  switch (change.kind) {
    case RankChange::Kind::New:
      return kBeyond;
    case RankChange::Kind::Up:
      return change.places;
    case RankChange::Kind::Same:
      return 0.0;
    case RankChange::Kind::Down:
      return -static_cast<double>(change.places);
    case RankChange::Kind::Gone:
      return -kBeyond;
    case RankChange::Kind::None:
      break;
  }
  return kNone;
}

double valueIn(const CandidateRow& row, CandidateColumn column) {
  if (column == CandidateColumn::Segment) return row.group;
  if (column == CandidateColumn::Saliency) return row.saliency;
  if (column == CandidateColumn::Verdict) return static_cast<double>(row.verdict);
  if (row.pending()) return kNone;
  switch (column) {
    case CandidateColumn::Rank:
      return row.rank ? *row.rank : kNone;
    case CandidateColumn::Change:
      return sortedChange(row.change);
    case CandidateColumn::View:
      return row.id;
    case CandidateColumn::Unknown:
      return row.unknown;
    case CandidateColumn::Occupied:
      return row.occupied;
    case CandidateColumn::Surface:
      return row.surface;
    case CandidateColumn::DistanceFactor:
      return row.distance_factor;
    case CandidateColumn::Distance:
      return row.distance_m;
    default:
      return row.score;
  }
}

bool passes(const CandidateRow& row, const CandidateFilter& filter) {
  if (filter.segment && row.segment != *filter.segment) return false;
  if (filter.ranked_only && !row.rank && !row.pending()) return false;
  if (filter.reachable_only && (isUnreachable(row.reachability) || row.verdict == ViewVerdict::NotFree))
    return false;
  if (filter.text.empty()) return true;
  return !row.pending() && std::to_string(row.id).find(filter.text) != std::string::npos;
}

/// The list's parts, one after the other: the view whose id was typed, rows with a value in the column,
/// pending ones without, others without.
int partOf(const CandidateRow& row, const CandidateFilter& filter, bool without_value) {
  if (!filter.text.empty() && !row.pending() && std::to_string(row.id) == filter.text) return 0;
  if (!without_value) return 1;
  return row.pending() ? 2 : 3;
}

template <class T>
bool isSame(const std::weak_ptr<const T>& known, const std::shared_ptr<const T>& now) {
  return !known.owner_before(now) && !now.owner_before(known);
}

}  // namespace

const std::vector<CandidateColumnText>& candidateColumns(bool hierarchical) {
  static const std::vector<CandidateColumnText> contour = {
      kRank,
      kChange,
      kView,
      {CandidateColumn::Gain, "gain", "gain", "Rays at full resolution that end on unknown and count"},
      {CandidateColumn::Segment, "segment", "seg.",
       "Segment: the label of its segment. Sorted as segments are tried, not by label", false},
      {CandidateColumn::Saliency, "saliency", "sal.",
       "Saliency of its segment: isolation × roundness. Segments are tried by falling saliency"},
      kVerdict,
      kUnknown,
      kOccupied,
      kDistance};
  static const std::vector<CandidateColumnText> octree = {
      kRank,
      kChange,
      kView,
      {CandidateColumn::Utility, "utility", "utility", "Surface factor × distance factor (eq. 1)"},
      {CandidateColumn::Surface, "surface", "surf.",
       "Surface factor: unknown voxels seen per unknown voxel of the object's box (eq. 3)"},
      {CandidateColumn::DistanceFactor, "distance factor", "dist.",
       "Distance factor: 1 where the sensor is, less the farther the way (eq. 5)"},
      kVerdict,
      kUnknown,
      kOccupied,
      kDistance};
  return hierarchical ? octree : contour;
}

std::vector<std::uint32_t> listedRows(const std::vector<CandidateRow>& rows, const CandidateFilter& filter,
                                      CandidateColumn column, bool descending) {
  struct Entry {
    double key;  ///< ascending; kNone never compares
    int part;    ///< see partOf()
    std::uint32_t index;
  };
  std::vector<Entry> entries;
  entries.reserve(rows.size());
  for (std::uint32_t i = 0; i < rows.size(); ++i) {
    if (!passes(rows[i], filter)) continue;
    const double value = valueIn(rows[i], column);
    const bool none = value != value;
    entries.push_back({none ? 0.0 : descending ? -value : value, partOf(rows[i], filter, none), i});
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    if (a.part != b.part) return a.part < b.part;
    return a.key != b.key ? a.key < b.key : a.index < b.index;
  });
  std::vector<std::uint32_t> listed(entries.size());
  std::ranges::transform(entries, listed.begin(), &Entry::index);
  return listed;
}

void CandidateTable::show(const StepData& recorded, const StepData& shown) {
  const bool same_recorded = isSame(recorded_, recorded.record) && isSame(recorded_header_, recorded.header);
  if (same_recorded && isSame(shown_, shown.record) && isSame(shown_header_, shown.header)) return;
  if (!same_recorded)
    recorded_rows_ = recorded.empty() ? std::vector<CandidateRow>() : candidateRows(recorded.frame());
  const std::shared_ptr<const Labels> labels = shown.empty() ? nullptr : shown.record->labels;
  if (!same_recorded || !isSame(shown_labels_, labels)) filter_.segment.reset();
  shown_labels_ = labels;
  recorded_ = recorded.record;
  recorded_header_ = recorded.header;
  shown_ = shown.record;
  shown_header_ = shown.header;
  rows_ = shown.empty() ? std::vector<CandidateRow>() : candidateRows(shown.frame());
  if (!shown.empty()) hierarchical_ = shown.record->utilities != nullptr;
  // Nothing is tried out, but segments that the run did not need may be scored by now: those places count
  // too.
  compares_ = shown.header != recorded.header;
  if (!compares_) recorded_rows_ = rows_;
  if (!recorded.empty() && !shown.empty() && sameCandidates(recorded.frame(), shown.frame()))
    compareRanks(rows_, recorded_rows_);
  stale_ = true;
  ++revision_;
}

bool CandidateTable::sortBy(CandidateColumn column, bool descending) {
  if (column == column_ && descending == descending_) return false;
  column_ = column;
  descending_ = descending;
  stale_ = true;
  return true;
}

void CandidateTable::filter(const CandidateFilter& filter) {
  if (filter == filter_) return;
  filter_ = filter;
  stale_ = true;
}

const std::vector<std::uint32_t>& CandidateTable::listed() {
  if (stale_) listed_ = listedRows(rows_, filter_, column_, descending_);
  stale_ = false;
  return listed_;
}

const CandidateRow* CandidateTable::find(std::uint32_t id) const {
  const auto found =
      std::ranges::find_if(rows_, [&](const CandidateRow& r) { return !r.pending() && r.id == id; });
  return found == rows_.end() ? nullptr : &*found;
}

std::optional<std::size_t> CandidateTable::placeOf(std::uint32_t id) {
  const std::vector<std::uint32_t>& order = listed();
  for (std::size_t i = 0; i < order.size(); ++i)
    if (!rows_[order[i]].pending() && rows_[order[i]].id == id) return i;
  return std::nullopt;
}

std::optional<std::uint32_t> CandidateTable::neighbour(std::optional<std::uint32_t> id, int by) {
  std::vector<std::uint32_t> ids;
  for (const std::uint32_t index : listed())
    if (!rows_[index].pending()) ids.push_back(rows_[index].id);
  if (ids.empty()) return std::nullopt;
  const auto at = id ? std::ranges::find(ids, *id) : ids.end();
  if (at == ids.end()) return ids.front();
  const std::ptrdiff_t place = std::clamp<std::ptrdiff_t>(at - ids.begin() + by, 0, std::ssize(ids) - 1);
  return ids[place];
}

}  // namespace vantage
