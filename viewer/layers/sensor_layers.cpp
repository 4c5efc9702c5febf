// The sensor where the last scan was taken, and what it measured.
#include <vtkActor.h>
#include <vtkProperty.h>

#include <span>

#include "viewer/depth_picture.h"
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

/// Every so many pixels of an image that were kept are drawn in space.
constexpr int kKeptEvery = 3;

/// Pixels in the workspace: those that were removed, in their filter's colour, and a thin choice of the
/// others.
void addPixels(const DepthFrame& frame, const PinholeCamera& camera, const Box& workspace,
               std::span<const std::uint8_t> mask, const LayerStyle& style, LayerContent& content) {
  std::vector<Eigen::Vector3d> kept, removed;
  std::vector<Rgb> colors;
  for (int v = 0; v < frame.depth.height; ++v)
    for (int u = 0; u < frame.depth.width; ++u) {
      const float z = frame.depth.at(u, v);
      if (!DepthImage::valid(z)) continue;
      const auto color = removedColor(mask[static_cast<std::size_t>(v) * frame.depth.width + u]);
      if (!color && (u % kKeptEvery != 0 || v % kKeptEvery != 0)) continue;
      const Eigen::Vector3d p_world = frame.T_world_camera * (camera.ray(u, v) * z);
      if (!workspace.contains(p_world)) continue;  // a far wall says nothing and hides much
      (color ? removed : kept).push_back(p_world);
      if (color) colors.push_back(*color);
    }
  content.props.push_back(dotActor(kept, {}, palette::kSurface, 2.0 * style.line_scale));
  content.props.push_back(dotActor(removed, colors, palette::kInk, 3.0 * style.line_scale));
  content.legend.push_back(
      {Mark::Dot, palette::kSurface, 1.0, "pixels that were kept, one of nine, in the workspace"});
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

LayerContent filteredDepthLayer(const SceneFrame& frame, const LayerStyle& style) {
  LayerContent content;
  const StepRecord& record = frame.record;
  if (!record.depth || !record.filtered || record.filtered->mask.size() != record.depth->depth.depth_m.size())
    return content;
  const DepthImage& measured = record.depth->depth;
  const std::vector<std::uint8_t>& mask = record.filtered->mask;
  const auto [low, high] = depthRange(measured);
  const ColorMap map = mapOf(style, ColorMap::Cividis);
  content.inset = Inset{"last depth image, filtered", filteredPicture(measured, mask, map, low, high),
                        ColorScale{map, "depth, m", low, high, true}};
  if (frame.header.camera.width == measured.width && frame.header.camera.height == measured.height)
    addPixels(*record.depth, frame.header.camera, frame.header.workspace, mask, style, content);
  for (LegendEntry& entry : removedLegend(countMask(mask))) content.legend.push_back(std::move(entry));
  return content;
}

}  // namespace vantage
