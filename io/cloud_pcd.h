#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

namespace vantage {

/// Points of a PCD file as they stand in it, also those that are not finite.
struct PcdPoints {
  std::vector<Eigen::Vector3f> points;
  std::vector<Eigen::Vector3f> normals;  ///< empty if the file has none
  Eigen::Vector3f sensor_origin = Eigen::Vector3f::Zero();
};

/// Internal to readCloud(). \throws InputError naming file and, in the header and ASCII data, line.
PcdPoints parsePcd(std::string_view bytes, const std::string& path);

}  // namespace vantage
