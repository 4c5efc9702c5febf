#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

/// Handles and values of everything that layers read from a frame. Holds the products, so that another one
/// can't take the address of one that is gone.
struct LayerInputs {
  explicit LayerInputs(const SceneFrame& frame);

  std::shared_ptr<const void> map;
  std::uint64_t truth;  ///< tells one true scene from another
  int step;
  std::size_t scan_poses;
  std::shared_ptr<const void> depth, contours, surface, labels, saliency, positions, search, utilities,
      joints, trajectory;
  std::string planner;
  std::string arm;  ///< name, empty for the free flyer
  PinholeCamera camera;
  GridGeometry volume;
  Box workspace;
  ContourViewConfig views;
  GainConfig gain;
  SaliencyConfig saliency_config;
  std::optional<HierarchicalPlannerConfig> octree;
  Box object_box;
};

/// A layer built from `before` looks the same built from `after`.
bool stillStands(Layer layer, const LayerInputs& before, const LayerInputs& after);

/// The fields of a style that a layer reads are equal.
bool sameStyle(Layer layer, const LayerStyle& a, const LayerStyle& b);

}  // namespace vantage
