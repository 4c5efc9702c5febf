#include "viewer/candidates.h"

#include <algorithm>
#include <unordered_map>

#include "viewer/view_words.h"

namespace vantage {
namespace {

/// Where the sensor is when the step is planned.
Eigen::Vector3d sensorPosition(const StepRecord& record) {
  if (!record.scan.empty()) return record.scan.back().T_world_camera.translation();
  return record.depth ? Eigen::Vector3d(record.depth->T_world_camera.translation()) : Eigen::Vector3d::Zero();
}

/// Rows of the contour planner and its baseline.
class ContourRows {
 public:
  explicit ContourRows(const SceneFrame& frame)
      : frame_(frame),
        record_(frame.record),
        search_(*frame.record.search),
        threshold_(frame.header.contour_config.gain.gain_threshold),
        sensor_(sensorPosition(frame.record)) {}

  std::vector<CandidateRow> make() {
    std::size_t count = 0;
    for (const SegmentSearch& group : search_.segments)
      count += std::max<std::size_t>(1, group.scores.size());
    rows_.reserve(count);
    for (std::uint32_t g = 0; g < search_.segments.size(); ++g) add(g);
    return std::move(rows_);
  }

 private:
  void add(std::uint32_t g) {
    const SegmentSearch& group = search_.segments[g];
    CandidateRow row{.group = g, .saliency = group.saliency};
    if (group.segment >= 0 && record_.saliency &&
        static_cast<std::size_t>(group.segment) < record_.saliency->segments.size())
      row.segment = record_.saliency->segments[group.segment].label;
    if (!group.scored) {
      row.verdict = ViewVerdict::Pending;
      row.poses = group.poses_generated;
      rows_.push_back(row);
      pending_before_ = true;
      return;
    }
    for (const PoseScore& score : group.scores) add(row, score);
  }

  void add(CandidateRow row, const PoseScore& score) {
    row.id = score.id;
    row.score = score.gain;
    row.unknown = score.unknown;
    row.occupied = score.occupied;
    row.reachability = score.reachability;
    row.distance_m = distance(score.id);
    row.verdict = verdict(row, score);
    if (row.score > threshold_ && !score.executed_before && !pending_before_) row.rank = ++ranked_;
    rows_.push_back(row);
  }

  ViewVerdict verdict(const CandidateRow& row, const PoseScore& score) const {
    if (search_.chosen && search_.chosen->id == score.id) return ViewVerdict::Chosen;
    if (!(score.gain > threshold_)) return ViewVerdict::BelowThreshold;
    if (score.executed_before) return ViewVerdict::TakenBefore;
    if (isUnreachable(score.reachability)) return ViewVerdict::Unreachable;
    if (search_.chosen && row.group > search_.chosen->search) return ViewVerdict::LaterSegment;
    return pending_before_ ? ViewVerdict::Waiting : ViewVerdict::Eligible;
  }

  double distance(std::uint32_t id) const {
    const ViewPosition* position = positionOf(frame_, id);
    return position ? (position->T_world_camera.translation() - sensor_).norm() : 0.0;
  }

  const SceneFrame& frame_;
  const StepRecord& record_;
  const ViewSearch& search_;
  double threshold_;
  Eigen::Vector3d sensor_;
  std::vector<CandidateRow> rows_;
  std::uint32_t ranked_ = 0;
  bool pending_before_ = false;
};

ViewVerdict verdictOf(const ViewUtility& view, const UtilitySearch& search, bool stopped) {
  switch (view.rejection) {
    case ViewRejection::Position:
      return ViewVerdict::NotFree;
    case ViewRejection::Registration:
      return ViewVerdict::LittleSurface;
    case ViewRejection::Executed:
      return ViewVerdict::TakenBefore;
    case ViewRejection::None:
      break;
  }
  if (search.chosen && search.chosen->id == view.id) return ViewVerdict::Chosen;
  if (isUnreachable(view.reachability)) return ViewVerdict::Unreachable;
  if (!(view.utility > 0.0)) return ViewVerdict::BelowThreshold;
  return stopped ? ViewVerdict::Stopped : ViewVerdict::Eligible;
}

std::vector<CandidateRow> utilityRows(const SceneFrame& frame) {
  const UtilitySearch& search = *frame.record.utilities;
  const bool stopped = frame.header.octree &&
                       endOf(search, frame.header.octree->planner.stop_gain) == SearchEnd::LittleUnknown;
  const Eigen::Vector3d sensor = sensorPosition(frame.record);
  std::vector<CandidateRow> rows;
  rows.reserve(search.views.size());
  const auto add = [&](const ViewUtility& view, std::optional<std::uint32_t> rank) {
    rows.push_back({.id = view.id,
                    .rank = rank,
                    .verdict = verdictOf(view, search, stopped),
                    .reachability = view.reachability,
                    .score = view.utility,
                    .unknown = view.unknown,
                    .occupied = view.occupied,
                    .surface = view.surface,
                    .distance_factor = view.distance,
                    .distance_m = (view.T_world_camera.translation() - sensor).norm()});
  };
  std::uint32_t ranked = 0;
  for (const std::uint32_t index : search.ranking) {
    const ViewUtility& view = search.views[index];
    add(view, view.utility > 0.0 ? std::optional(++ranked) : std::nullopt);
  }
  for (const ViewUtility& view : search.views)
    if (view.rejection != ViewRejection::None) add(view, std::nullopt);
  return rows;
}

bool samePositions(const std::vector<ViewPosition>& a, const std::vector<ViewPosition>& b) {
  return std::ranges::equal(a, b, [](const ViewPosition& x, const ViewPosition& y) {
    return x.first_id == y.first_id && x.group == y.group &&
           x.T_world_camera.matrix() == y.T_world_camera.matrix();
  });
}

bool sameViews(const std::vector<ViewUtility>& a, const std::vector<ViewUtility>& b) {
  return std::ranges::equal(a, b, [](const ViewUtility& x, const ViewUtility& y) {
    return x.id == y.id && x.T_world_camera.matrix() == y.T_world_camera.matrix();
  });
}

/// \param had empty = no place is known; `all` places were
RankChange changeTo(std::optional<std::uint32_t> rank, std::optional<std::uint32_t> had, std::uint32_t all) {
  using Kind = RankChange::Kind;
  if (!rank) return {had ? Kind::Gone : Kind::None, 0};
  if (!had) return {*rank <= all ? Kind::New : Kind::None, 0};
  if (*rank == *had) return {Kind::Same, 0};
  return *rank < *had ? RankChange{Kind::Up, *had - *rank} : RankChange{Kind::Down, *rank - *had};
}

/// Contour planners: it passed what a view must pass to have a place.
bool isGoodEnough(const CandidateRow& row) {
  return row.verdict != ViewVerdict::BelowThreshold && row.verdict != ViewVerdict::TakenBefore;
}

}  // namespace

std::vector<CandidateRow> candidateRows(const SceneFrame& frame) {
  if (frame.record.utilities) return utilityRows(frame);
  return frame.record.search ? ContourRows(frame).make() : std::vector<CandidateRow>();
}

bool sameCandidates(const SceneFrame& a, const SceneFrame& b) {
  const StepRecord &x = a.record, &y = b.record;
  if (x.utilities && y.utilities)
    return x.utilities == y.utilities || sameViews(x.utilities->views, y.utilities->views);
  if (!x.positions || !y.positions || x.utilities || y.utilities) return false;
  return a.header.contour_config.views.rolls == b.header.contour_config.views.rolls &&
         (x.positions == y.positions || samePositions(*x.positions, *y.positions));
}

void compareRanks(std::vector<CandidateRow>& current, const std::vector<CandidateRow>& recorded) {
  std::unordered_map<std::uint32_t, std::uint32_t> had;
  had.reserve(recorded.size());
  for (const CandidateRow& row : recorded)
    if (row.rank) had.emplace(row.id, *row.rank);
  bool pending_before = false;
  for (CandidateRow& row : current) {
    pending_before |= row.pending();
    // Its place is not known before that segment is scored.
    const bool waits = !row.rank && pending_before && isGoodEnough(row);
    if (row.pending() || waits) continue;
    const auto found = had.find(row.id);
    row.change = changeTo(row.rank, found == had.end() ? std::nullopt : std::optional(found->second),
                          static_cast<std::uint32_t>(had.size()));
  }
}

std::string verdictWord(const CandidateRow& row) {
  switch (row.verdict) {
    case ViewVerdict::Chosen:
      return "chosen";
    case ViewVerdict::Eligible:
      return "behind";
    case ViewVerdict::LaterSegment:
      return "later seg.";
    case ViewVerdict::Unreachable:
      return row.reachability == Reachability::NoPath          ? "no path"
             : row.reachability == Reachability::NoFrame       ? "no frame"
             : row.reachability == Reachability::NoIk          ? "no joints"
             : row.reachability == Reachability::SelfCollision ? "hits itself"
                                                               : refusalWord(row.reachability);
    case ViewVerdict::BelowThreshold:
      return "little gain";
    case ViewVerdict::TakenBefore:
      return "taken";
    case ViewVerdict::NotFree:
      return "not free";
    case ViewVerdict::LittleSurface:
      return "registration";
    case ViewVerdict::Stopped:
      return "stopped";
    case ViewVerdict::Waiting:
      return "waits";
    case ViewVerdict::Pending:
      return "pending";
  }
  return "";
}

std::string_view verdictMeaning(ViewVerdict verdict, bool hierarchical) {
  switch (verdict) {
    case ViewVerdict::Chosen:
      return "the view that is taken";
    case ViewVerdict::Eligible:
      return "good enough, but the chosen view comes before it";
    case ViewVerdict::LaterSegment:
      return "good enough, but its segment is tried after that of the chosen view";
    case ViewVerdict::Unreachable:
      return "good enough, but the robot cannot take it";
    case ViewVerdict::BelowThreshold:
      return hierarchical ? "it sees nothing unknown" : "it does not gain more than the gain threshold";
    case ViewVerdict::TakenBefore:
      return "too near to a view that was taken before";
    case ViewVerdict::NotFree:
      return "the robot does not fit there";
    case ViewVerdict::LittleSurface:
      return "too little known surface in view to register the scan (h_oc)";
    case ViewVerdict::Stopped:
      return "no view sees enough unknown to go on (h_stop)";
    case ViewVerdict::Waiting:
      return "good enough, but a segment that is tried before its own is not scored yet";
    case ViewVerdict::Pending:
      return "the views of this segment are not scored yet";
  }
  return "";
}

}  // namespace vantage
