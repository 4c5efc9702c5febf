#pragma once

#include "core/perception/contours.h"

namespace vantage {

/// Where the normal of a contour point ends in pictures.
inline Eigen::Vector3d normalTip(const ContourPoint& point) {
  constexpr double kNormalLength_m = 0.055;
  return point.position_m + kNormalLength_m * point.normal;
}

}  // namespace vantage
