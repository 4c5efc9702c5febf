#pragma once

#include <vtkActor.h>
#include <vtkSmartPointer.h>

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/camera_model.h"
#include "core/geometry/pose.h"
#include "viewer/color.h"
#include "viewer/eye.h"
#include "viewer/merged_faces.h"

namespace vantage {

/// Straight pieces in world coordinates, metres, with a colour for each if they differ.
struct LineSet {
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> pieces;
  std::vector<Rgb> colors;  ///< one per piece, or empty

  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { pieces.emplace_back(a, b); }
  void add(const Eigen::Vector3d& a, const Eigen::Vector3d& b, Rgb color) {
    pieces.emplace_back(a, b);
    colors.push_back(color);
  }
  /// Dashes and gaps of `dash_m` each.
  void addDashed(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double dash_m);
  /// Closed circle about `axis`.
  void addCircle(const Eigen::Vector3d& center, double radius_m, const Eigen::Vector3d& axis);
};

/// The twelve edges of a box.
void addBox(LineSet& lines, const Box& box);

/// Every edge of the faces once.
void addEdges(LineSet& lines, const FaceMesh& faces);

/// Unlit lines.
vtkSmartPointer<vtkActor> lineActor(const LineSet& lines, Rgb color, double width_px, double opacity = 1.0);

/// Unlit round points; one colour each, or `color` for all if `colors` is empty.
vtkSmartPointer<vtkActor> dotActor(const std::vector<Eigen::Vector3d>& points, const std::vector<Rgb>& colors,
                                   Rgb color, double size_px);

/// Tube along a polyline.
vtkSmartPointer<vtkActor> tubeActor(const std::vector<Eigen::Vector3d>& line, double radius_m, Rgb color);

vtkSmartPointer<vtkActor> ballActor(const Eigen::Vector3d& center, double radius_m, Rgb color);

/// Flat-shaded quads.
vtkSmartPointer<vtkActor> faceActor(const FaceMesh& faces, Rgb color, double opacity);
/// The same of merged faces.
vtkSmartPointer<vtkActor> faceActor(const MergedFaces& faces, Rgb color, double opacity);

/// Flat-shaded quads with diagonal stripes on all axis-aligned faces, drawn before a surface that lies about
/// a voxel before them. \param period_m of a stripe and a gap, along an axis
vtkSmartPointer<vtkActor> hatchedActor(const FaceMesh& faces, Rgb color, double period_m);

/// Smooth-shaded triangles; `normals` one a point or empty (flat), `colors` one a point, one a triangle, or
/// empty.
vtkSmartPointer<vtkActor> triangleActor(const std::vector<Eigen::Vector3f>& points,
                                        const std::vector<Eigen::Vector3f>& normals,
                                        const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                        const std::vector<std::array<std::uint8_t, 3>>& colors, Rgb color,
                                        double opacity);

/// Which way a face must look to be drawn.
enum class FaceSide { Both, TowardEye, AwayFromEye };

/// Unlit triangles in the exact colours of a scale, one a triangle; counter-clockwise seen from their
/// outside.
vtkSmartPointer<vtkActor> flatTriangleActor(const std::vector<Eigen::Vector3f>& points,
                                            const std::vector<std::array<std::uint32_t, 3>>& triangles,
                                            const std::vector<Rgb>& colors, FaceSide side, double opacity);

/// Text that faces the eye and is hidden by what stands before it.
vtkSmartPointer<vtkProp> labelProp(const Eigen::Vector3d& at, const std::string& utf8, double size_px,
                                   Rgb color);

/// Text on a white plate over everything else. Later ones cover earlier ones.
vtkSmartPointer<vtkProp> plateProp(const Eigen::Vector3d& at, const std::string& utf8, double size_px,
                                   Rgb color);

/// The eight edges of a frustum.
void addFrustum(LineSet& lines, const PinholeCamera& camera, const Pose& T_world_camera, double depth_m);

}  // namespace vantage
