#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace vantage {

/// Distance of each point to the nearest point with another label, metres, capped at `max_distance_m`. Exact:
/// equal to comparing every pair in single precision. Points without finite coordinates are nobody's
/// neighbour and get the cap. `labels` has one entry per point.
std::vector<float> otherLabelDistances(const std::vector<Eigen::Vector3f>& points,
                                       const std::vector<std::uint32_t>& labels, float max_distance_m);

}  // namespace vantage
