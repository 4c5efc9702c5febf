#include "viewer/app/experiments/b1_segments.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace vantage::experiments {
namespace {

constexpr double kOnObject_m = 0.02;
/// Groups with fewer contour points are not graded (criterion 5).
constexpr std::size_t kGradedPoints = 6;

/// Object on which a point lies, -1 for none.
int objectUnder(const Eigen::Vector3d& p, const SceneTruth& truth, const SceneRays& others) {
  const int object = truth.objectAt(p, kOnObject_m);
  return object >= 0 && truth.objectDistance(p) <= others.distance(p) ? object : -1;
}

}  // namespace

std::uint64_t SegmentObjects::Points::onObjects() const {
  return std::accumulate(of_object.begin(), of_object.end(), std::uint64_t{0});
}

SegmentObjects::SegmentObjects(const StepRecord& record, const SceneTruth& truth, const SceneRays& others)
    : record_(record), truth_(truth) {
  const std::vector<Eigen::Vector3f>& points = record.surface->points;
  std::vector<int> object(points.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i)
                        object[i] = objectUnder(points[i].cast<double>(), truth, others);
                    });
  by_label_.assign(record.labels->count + 1,
                   Points{0, std::vector<std::uint64_t>(truth.objectNames().size(), 0)});
  for (std::size_t i = 0; i < points.size(); ++i) {
    Points& segment = by_label_[record.labels->of_point[i]];
    ++segment.all;
    if (object[i] >= 0) ++segment.of_object[static_cast<std::size_t>(object[i])];
  }
}

std::uint32_t SegmentObjects::labelOf(const SegmentSearch& search) const {
  return search.segment < 0 ? 0 : record_.saliency->segments[static_cast<std::size_t>(search.segment)].label;
}

bool SegmentObjects::isObject(const SegmentSearch& search) const {
  const std::uint32_t label = labelOf(search);
  return label > 0 && 2 * by_label_[label].onObjects() > by_label_[label].all;
}

std::vector<SegmentRow> SegmentObjects::rows() const {
  std::vector<SegmentRow> rows;
  for (const SegmentSearch& search : record_.search->segments) {
    SegmentRow row{search.saliency, search.poses_generated, search.contour_points.size(), ""};
    if (isObject(search)) {
      const auto& of_object = by_label_[labelOf(search)].of_object;
      const auto most = std::ranges::max_element(of_object) - of_object.begin();
      row.object = truth_.objectNames()[static_cast<std::size_t>(most)];
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

SaliencyCheck SegmentObjects::check() const {
  SaliencyCheck check;
  double lowest_object = std::numeric_limits<double>::infinity(), highest_other = 0.0;
  std::uint64_t poses = 0, object_poses = 0;
  for (const SegmentSearch& search : record_.search->segments) {
    const bool object = isObject(search);
    poses += search.poses_generated;
    if (object) object_poses += search.poses_generated;
    if (object && search.contour_points.size() >= kGradedPoints)
      lowest_object = std::min(lowest_object, search.saliency);
    if (!object) highest_other = std::max(highest_other, search.saliency);
  }
  std::uint64_t on_objects = 0, in_object_segments = 0;
  for (std::size_t label = 0; label < by_label_.size(); ++label) {
    const Points& segment = by_label_[label];
    on_objects += segment.onObjects();
    if (label > 0 && 2 * segment.onObjects() > segment.all) in_object_segments += segment.onObjects();
  }
  const auto share = [](std::uint64_t part, std::uint64_t all) {
    return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
  };
  check.objects_first = std::isfinite(lowest_object) && lowest_object > highest_other;
  check.object_share = share(in_object_segments, on_objects);
  check.object_pose_share = share(object_poses, poses);
  return check;
}

SaliencyEnds saliencyEnds(const std::vector<SegmentRow>& rows) {
  std::map<std::string, double> best;  // of each object
  SaliencyEnds ends;
  for (const SegmentRow& row : rows) {
    double& highest = row.object.empty() ? ends.other : best[row.object];
    highest = std::max(highest, row.saliency);
  }
  if (best.empty()) return ends;
  const auto saliency = [](const auto& object) { return object.second; };
  ends.object = saliency(*std::ranges::min_element(best, {}, saliency));
  return ends;
}

TriangleMesh meshOfOthers(const SceneFile& scene) {
  TriangleMesh mesh;
  for (const Solid& solid : scene.solids)
    if (solid.role() != SolidRole::Object) appendMesh(solid.mesh(), mesh);
  return mesh;
}

}  // namespace vantage::experiments
