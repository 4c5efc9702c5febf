#include "core/perception/segmentation.h"

#include <pcl/point_types.h>
#include <pcl/segmentation/lccp_segmentation.h>
#include <pcl/segmentation/supervoxel_clustering.h>

#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>

#include "core/geometry/check.h"
#include "core/perception/segment_merging.h"

namespace vantage {

namespace {

using PointT = pcl::PointXYZRGBA;
using Supervoxels = std::map<std::uint32_t, pcl::Supervoxel<PointT>::Ptr>;
using Adjacency = std::multimap<std::uint32_t, std::uint32_t>;

constexpr double kMaxVoxelsPerAxis = 1 << 20;  // beyond it PCL's octree keys are no longer safe

/// LCCP's decision on every link of a supervoxel graph, taken by PCL. Grouping is ours: PCL's recurses once
/// per supervoxel, and its merging of small segments has no bound on its loop.
class LinkClassifier : public pcl::LCCPSegmentation<PointT> {
 public:
  explicit LinkClassifier(const SegmentationConfig& config) {
    setConcavityToleranceThreshold(
        static_cast<float>(config.concavity_tolerance_rad * 180.0 / std::numbers::pi));
    setSmoothnessCheck(config.smoothness_check, static_cast<float>(config.voxel_m),
                       static_cast<float>(config.seed_m), static_cast<float>(config.smoothness));
    setSanityCheck(config.sanity_check);
    setKFactor(static_cast<std::uint32_t>(config.k_convexity));
  }

  /// Links with supervoxel labels; the order is that of PCL's graph and means nothing.
  std::vector<SupervoxelLink> classify(const Supervoxels& supervoxels, const Adjacency& adjacency) {
    setInputSupervoxels(supervoxels, adjacency);
    calculateConvexConnections(sv_adjacency_list_);
    applyKconvexity(k_factor_);
    std::vector<SupervoxelLink> links;
    for (auto [edge, end] = boost::edges(sv_adjacency_list_); edge != end; ++edge) {
      links.push_back({sv_adjacency_list_[boost::source(*edge, sv_adjacency_list_)],
                       sv_adjacency_list_[boost::target(*edge, sv_adjacency_list_)],
                       sv_adjacency_list_[*edge].is_valid});
    }
    return links;
  }
};

/// Points of a cloud that have a position and a normal, in PCL's containers.
struct UsablePoints {
  pcl::PointCloud<PointT>::Ptr points{new pcl::PointCloud<PointT>};
  pcl::PointCloud<pcl::Normal>::Ptr normals{new pcl::PointCloud<pcl::Normal>};
  std::vector<std::size_t> index;  ///< into the original cloud
};

UsablePoints usablePoints(const SurfaceCloud& cloud) {
  UsablePoints usable;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    const Eigen::Vector3f& n = cloud.normals[i];
    if (!p.allFinite() || !n.allFinite() || !(n.squaredNorm() > 0.0f)) continue;
    PointT point;
    point.getVector3fMap() = p;
    point.rgba = 0;
    usable.points->push_back(point);
    usable.normals->push_back(pcl::Normal(n.x(), n.y(), n.z()));
    usable.index.push_back(i);
  }
  return usable;
}

/// \throws std::runtime_error if the points lie too far apart for the supervoxels' octree.
void requireBoundedExtent(const pcl::PointCloud<PointT>& points, double voxel_m) {
  Eigen::AlignedBox3f box;
  for (const PointT& point : points) box.extend(point.getVector3fMap());
  const double extent_m = box.sizes().cast<double>().maxCoeff();
  if (extent_m / voxel_m < kMaxVoxelsPerAxis) return;
  throw std::runtime_error("segmentation: the cloud extends over " + std::to_string(extent_m) +
                           " m, more than " + std::to_string(kMaxVoxelsPerAxis * voxel_m) +
                           " m; remove outliers or enlarge voxel_m");
}

/// Numbers the segments 1..count in the order of their first point.
void writeLabels(const std::vector<std::uint32_t>& segment_of_point, const std::vector<std::size_t>& index,
                 Labels& labels) {
  std::map<std::uint32_t, std::uint32_t> number;
  for (std::size_t k = 0; k < segment_of_point.size(); ++k) {
    if (segment_of_point[k] == kNoSegment) continue;
    const auto [entry, added] = number.try_emplace(segment_of_point[k], labels.count + 1);
    if (added) ++labels.count;
    labels.of_point[index[k]] = entry->second;
  }
}

}  // namespace

void SegmentationConfig::validate() const {
  requireInRange("segmentation.voxel_m", voxel_m, 1e-5, 10.0);
  requireInRange("segmentation.seed_m", seed_m, voxel_m, 100.0);
  requireInRange("segmentation.spatial_weight", spatial_weight, 0.0, 1e6);
  requireInRange("segmentation.normal_weight", normal_weight, 0.0, 1e6);
  requireInRange("segmentation.concavity_tolerance_rad", concavity_tolerance_rad, 0.0, std::numbers::pi);
  requireInRange("segmentation.smoothness", smoothness, 0.0, 1e6);
  requireInRange("segmentation.k_convexity", k_convexity, 0, 3);
  requireInRange("segmentation.min_segment_supervoxels", min_segment_supervoxels, 0, 1000000);
}

Labels segmentSurface(const SurfaceCloud& cloud, const SegmentationConfig& config) {
  config.validate();
  if (cloud.normals.size() != cloud.points.size()) {
    throw std::invalid_argument("segmentation: " + std::to_string(cloud.points.size()) + " points but " +
                                std::to_string(cloud.normals.size()) + " normals; there must be one each");
  }
  Labels labels;
  labels.of_point.assign(cloud.points.size(), 0);
  const UsablePoints usable = usablePoints(cloud);
  if (usable.index.empty()) return labels;
  requireBoundedExtent(*usable.points, config.voxel_m);

  pcl::SupervoxelClustering<PointT> clustering(static_cast<float>(config.voxel_m),
                                               static_cast<float>(config.seed_m));
  clustering.setUseSingleCameraTransform(false);
  clustering.setInputCloud(usable.points);
  clustering.setNormalCloud(usable.normals);
  clustering.setColorImportance(0.0f);
  clustering.setSpatialImportance(static_cast<float>(config.spatial_weight));
  clustering.setNormalImportance(static_cast<float>(config.normal_weight));
  Supervoxels supervoxels;
  clustering.extract(supervoxels);
  Adjacency adjacency;
  clustering.getSupervoxelAdjacency(adjacency);
  labels.supervoxels = static_cast<std::uint32_t>(supervoxels.size());

  const auto links = LinkClassifier(config).classify(supervoxels, adjacency);
  std::uint32_t highest = 0;
  if (!supervoxels.empty()) highest = supervoxels.rbegin()->first;
  std::vector<std::uint8_t> exists(highest + 1, 0);
  for (const auto& entry : supervoxels) exists[entry.first] = 1;
  const auto segment_of = groupSupervoxels(exists, links, config.min_segment_supervoxels);

  const auto labelled = clustering.getLabeledCloud();
  std::vector<std::uint32_t> segment_of_point;
  segment_of_point.reserve(labelled->size());
  for (const auto& point : *labelled) {
    segment_of_point.push_back(point.label < segment_of.size() ? segment_of[point.label] : kNoSegment);
  }
  writeLabels(segment_of_point, usable.index, labels);
  return labels;
}

bool convexEdge(const Patch& a, const Patch& b, const SegmentationConfig& config) {
  SegmentationConfig pair_config = config;
  pair_config.k_convexity = 0;  // two patches have no common neighbour
  Supervoxels supervoxels;
  for (const auto& [label, patch] : {std::pair{1u, &a}, std::pair{2u, &b}}) {
    auto& supervoxel = supervoxels[label];
    supervoxel.reset(new pcl::Supervoxel<PointT>);
    supervoxel->centroid_.getVector3fMap() = patch->centroid_m;
    supervoxel->normal_.getNormalVector3fMap() = patch->normal;
  }
  return LinkClassifier(pair_config).classify(supervoxels, {{1u, 2u}, {2u, 1u}}).front().convex;
}

}  // namespace vantage
