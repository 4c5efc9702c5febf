#pragma once

#include <string>

#include "viewer/scene_frame.h"

namespace vantage {

/// Whole number with blanks between thousands: 1 234 567.
std::string grouped(std::uint64_t value);

/// Which run and step a picture shows: "tabletop · contour planner · step 2 · stage evaluation".
std::string stepLine(const SceneFrame& frame);

// The key figures of a step in one sentence or two, each about one product; never empty.
std::string scanFigures(const SceneFrame& frame);     ///< where the scan was taken and what it returned
std::string stateFigures(const SceneFrame& frame);    ///< how much is known
std::string contourFigures(const SceneFrame& frame);  ///< contours, points, poses
std::string segmentFigures(const SceneFrame& frame);  ///< segments in the order in which they are tried
std::string viewFigures(const SceneFrame& frame);     ///< why this view was chosen, or why none

}  // namespace vantage
