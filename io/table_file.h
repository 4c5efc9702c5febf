#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/pose.h"
#include "core/motion/trajectory.h"
#include "core/perception/contours.h"
#include "core/perception/saliency.h"
#include "core/planners/hierarchical_planner.h"
#include "io/error.h"

namespace vantage {

/// Tables are CSV with a header row, commas, `.` decimals, metres and unit quaternions of T_world_camera;
/// numbers are written so that they read back exactly. A path of "-" is standard output or input. Writers
/// throw InputError if a file cannot be created and std::runtime_error if it cannot be written in full,
/// readers InputError `FILE:LINE: ...`.

/// `i,j,k,x_m,y_m,z_m,nx,ny,nz,group`
void writeContourVoxels(const std::string& path, const GridGeometry& geometry,
                        const std::vector<ContourVoxel>& voxels);

/// `group,x_m,y_m,z_m,nx,ny,nz,voxels`
void writeContourPoints(const std::string& path, const std::vector<ContourPoint>& points);

/// One row of a view table.
struct ViewRow {
  std::uint32_t id = 0;
  Pose T_world_camera = Pose::Identity();
  std::optional<std::uint32_t> group;  ///< contour point; the column is there if any row has one
};

/// `id,x_m,y_m,z_m,qx,qy,qz,qw` and, if any row has one, `group`
void writeViews(const std::string& path, const std::vector<ViewRow>& views);

/// Columns in any order, further ones are ignored. Quaternions off unit length by more than 1e-3 are refused.
std::vector<ViewRow> readViews(const std::string& path);

/// One row of a gain table.
struct GainRow {
  std::uint32_t id = 0;
  std::uint64_t unknown = 0, occupied = 0, rays = 0, visited = 0;
  std::string reject;  ///< empty, `position` or `registration`
};

/// `id,unknown,occupied,rays,visited,reject`
void writeGains(const std::string& path, const std::vector<GainRow>& gains);

/// `segment,points,saliency,isolation,roundness,d1_m,d2_m,d3_m,cx_m,cy_m,cz_m,radius_m`, in the order given
void writeSegments(const std::string& path, const std::vector<Segment>& segments);

/// One ranked view of a plan.
struct PlanRow {
  ViewRow view;
  std::uint32_t segment = 0;  ///< label, 0 = none
  double saliency = 0.0;
  double gain = 0.0;         ///< rays at full resolution
  std::string reachability;  ///< as toString(Reachability)
  bool chosen = false;
};

/// `id,x_m,y_m,z_m,qx,qy,qz,qw,group,segment,saliency,gain,reachability,chosen`
void writePlan(const std::string& path, const std::vector<PlanRow>& rows);

/// `t_s` and a column for each joint, rad or m
void writeJointPath(const std::string& path, const std::vector<std::string>& joints,
                    const JointTrajectory& trajectory);

/// `t_s,x_m,y_m,z_m,qx,qy,qz,qw`
void writePosePath(const std::string& path, const std::vector<double>& times_s,
                   const std::vector<Pose>& poses);

/// The plan of the hierarchical planner: surviving views by decreasing utility, then the rejected ones.
/// `id,x_m,y_m,z_m,qx,qy,qz,qw,reject,unknown,occupied,surface,distance,utility,rays,visited,reachability,chosen`
void writeUtilities(const std::string& path, const UtilitySearch& search);

}  // namespace vantage
