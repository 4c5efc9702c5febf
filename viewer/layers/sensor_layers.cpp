// The sensor where the last scan was taken, and what it measured.
#include <vtkActor.h>
#include <vtkProperty.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "viewer/layers/layer.h"
#include "viewer/layers/shapes.h"

namespace vantage {
namespace {

using Mark = LegendEntry::Mark;

std::optional<Pose> sensorPose(const StepRecord& record) {
  if (record.depth) return record.depth->T_world_camera;
  if (!record.scan.empty()) return record.scan.back().T_world_camera;
  return std::nullopt;
}

/// A box in the sensor's frame, metres.
vtkSmartPointer<vtkActor> bodyActor(const Pose& pose) {
  constexpr double kHalf[3] = {0.065, 0.022, 0.022};
  FaceMesh box;
  for (int c = 0; c < 8; ++c) {
    const Eigen::Vector3d corner((c & 1 ? 1 : -1) * kHalf[0], (c & 2 ? 1 : -1) * kHalf[1],
                                 (c & 4 ? 1 : -1) * kHalf[2] - kHalf[2]);
    box.corners.push_back((pose * corner).cast<float>());
  }
  box.quads = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  return faceActor(box, palette::kSensor, 1.0);
}

/// Range of the nearest three quarters of the valid depths, rounded outward to decimetres, so that a far wall
/// doesn't take the whole scale; 0..1 if there are none.
std::pair<double, double> depthRange(const DepthImage& depth) {
  std::vector<float> valid;
  std::copy_if(depth.depth_m.begin(), depth.depth_m.end(), std::back_inserter(valid), DepthImage::valid);
  if (valid.empty()) return {0.0, 1.0};
  const double low = std::floor(*std::min_element(valid.begin(), valid.end()) * 10.0) / 10.0;
  const auto middle = valid.begin() + static_cast<std::ptrdiff_t>(valid.size() * 3 / 4);
  std::nth_element(valid.begin(), middle, valid.end());
  return {low, std::max(std::ceil(*middle * 10.0) / 10.0, low + 0.1)};
}

/// Depth in colours; invalid pixels as a light grid, so that they can't be mistaken for a depth.
RgbImage depthPicture(const DepthImage& depth, ColorMap map, double low, double high) {
  RgbImage image(depth.width, depth.height);
  for (int v = 0; v < depth.height; ++v) {
    for (int u = 0; u < depth.width; ++u) {
      const float d = depth.at(u, v);
      const bool stripe = (u + v) % 12 < 3;
      image.set(u, v,
                DepthImage::valid(d) ? colorAt(map, (d - low) / (high - low)).bytes()
                                     : (stripe ? rgb(205, 207, 210) : rgb(238, 239, 240)).bytes());
    }
  }
  return image;
}

}  // namespace

LayerContent sensorLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const std::optional<Pose> pose = sensorPose(frame.record);
  if (!pose) return content;
  content.props.push_back(bodyActor(*pose));
  for (const double side_m : {-0.07, 0.07})
    content.must_see.push_back(*pose * Eigen::Vector3d(side_m, 0.0, -0.05));
  LineSet frustum;
  addFrustum(frustum, frame.header.camera, *pose, 0.45);
  for (const auto& [from, to] : frustum.pieces) content.must_see.push_back(to);
  content.props.push_back(lineActor(frustum, palette::kSensor, 2.0 * style.line_scale));
  content.legend.push_back({Mark::Line, palette::kSensor, 1.0, "sensor and its field of view (0.45 m)"});
  if (frame.record.scan.size() > 1) {
    std::vector<Eigen::Vector3d> eyes;
    for (const ScanPose& scan : frame.record.scan) eyes.push_back(scan.T_world_camera.translation());
    content.props.push_back(dotActor(eyes, {}, palette::kPath, 5.0 * style.line_scale));
    content.legend.push_back({Mark::Dot, palette::kPath, 1.0, "where the frames of this scan were taken"});
  }
  return content;
}

LayerContent depthImageLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  if (!frame.record.depth || frame.record.depth->depth.empty()) return content;
  const DepthImage& depth = frame.record.depth->depth;
  const auto [low, high] = depthRange(depth);
  const ColorMap map = mapOf(style, ColorMap::Cividis);
  content.inset = Inset{"last depth image (striped: no return)", depthPicture(depth, map, low, high),
                        ColorScale{map, "depth, m", low, high, true}};
  return content;
}

}  // namespace vantage
