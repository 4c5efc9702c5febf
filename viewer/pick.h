#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/planners/nearest_point.h"
#include "viewer/eye.h"
#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

enum class PickedKind : std::uint8_t {
  Frustum,       ///< a ranked view or a candidate
  ContourPoint,  ///< its normal's foot or tip
  Segment,       ///< surface with a segment
  Voxel,         ///< a voxel without one, or of a slice
};

/// What is under a point of the picture.
struct Picked {
  PickedKind kind = PickedKind::Voxel;
  Eigen::Vector3d p_world = Eigen::Vector3d::Zero();  ///< apex, contour point, or where the ray enters
  double distance_m = 0.0;                            ///< from the eye
  std::uint32_t id = 0;  ///< candidate id, index of the contour point, label of the segment (1..); else 0
  // Of a segment or voxel.
  Eigen::Vector3i voxel = Eigen::Vector3i::Zero();  ///< in the frame's states
  VoxelState state = VoxelState::Unknown;
};

/// A voxel that a ray meets first.
struct VoxelPick {
  Eigen::Vector3i voxel;
  VoxelState state;
  double distance_m;  ///< to where the ray enters it, or to the slice
};

/// The first voxel along a ray that the settings draw: occupied ones if they or a surface are shown, unknown
/// ones behind free ones if the frontier is, any on a slice; all of it within workspace, grid and clip box.
/// The origin may lie outside the grid.
std::optional<VoxelPick> pickVoxel(const SceneFrame& frame, const ViewSettings& settings, const EyeRay& ray);

/// Finds what is under the mouse, on the CPU and from the data alone. Keeps a search structure per surface.
class Picker {
 public:
  static constexpr double kFrustumRadius_px = 10.0, kContourRadius_px = 7.0, kEdgeRadius_px = 4.0;

  /// The nearest thing that the settings show: frusta (by their apexes, else by the lines that are drawn) and
  /// contour points by nearness in the picture unless something solid stands before them, else what the ray
  /// through the pixel meets. Nothing over the background.
  std::optional<Picked> at(const SceneFrame& frame, const ViewSettings& settings, const Eye& eye,
                           const Eigen::Vector2d& at_px, const PictureSize& picture);

 private:
  std::optional<std::uint32_t> labelNear(const SceneFrame& frame, const Eigen::Vector3d& p_world);

  std::shared_ptr<const SurfaceCloud> surface_;
  std::unique_ptr<NearestPoint> nearest_;
};

}  // namespace vantage
