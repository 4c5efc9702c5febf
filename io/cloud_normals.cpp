#include <pcl/kdtree/kdtree_flann.h>
#include <pcl/point_types.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "io/cloud_file.h"

namespace vantage {
namespace {

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// Axis of the smallest spread of the points, turned toward the sensor.
Eigen::Vector3f normalOf(const Cloud& cloud, const std::vector<int>& neighbours,
                         const Eigen::Vector3f& toward) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const int i : neighbours) mean += cloud[i].getVector3fMap().cast<double>();
  mean /= static_cast<double>(neighbours.size());
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const int i : neighbours) {
    const Eigen::Vector3d d = cloud[i].getVector3fMap().cast<double>() - mean;
    covariance += d * d.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
  solver.compute(covariance);
  const Eigen::Vector3f normal = solver.eigenvectors().col(0).cast<float>();
  return normal.dot(toward) < 0.0f ? Eigen::Vector3f(-normal) : normal;
}

}  // namespace

std::vector<Eigen::Vector3f> estimateNormals(const std::vector<Eigen::Vector3f>& points,
                                             const Eigen::Vector3f& sensor_origin, int neighbours) {
  std::vector<Eigen::Vector3f> normals(points.size());
  if (points.empty()) return normals;
  const auto cloud = pcl::make_shared<Cloud>();
  for (const Eigen::Vector3f& p : points) cloud->push_back({p.x(), p.y(), p.z()});
  pcl::KdTreeFLANN<pcl::PointXYZ> tree;
  tree.setInputCloud(cloud);
  const int k = std::min(std::max(neighbours, 3), static_cast<int>(points.size()));
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, points.size(), 256), [&](const auto& range) {
    std::vector<int> found;
    std::vector<float> squared;
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      tree.nearestKSearch((*cloud)[i], k, found, squared);
      normals[i] = normalOf(*cloud, found, sensor_origin - points[i]);
    }
  });
  return normals;
}

}  // namespace vantage
