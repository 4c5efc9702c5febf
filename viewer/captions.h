#pragma once

#include <string>

#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

/// Whole number with blanks between thousands: 1 234 567.
std::string grouped(std::uint64_t value);

/// Which run and step a picture shows: "tabletop · contour planner · step 2 · stage evaluation".
std::string stepLine(const SceneFrame& frame);

/// A length in the unit that suits it: "4 cm", "5.9 mm", "1.2 m".
std::string lengthText(double metres);

/// A volume in the unit that suits it: "8.64 dm³", "420 cm³", "1.25 m³".
std::string volumeText(double cubic_metres);

// The key figures of a step in one sentence or two, each about one product; never empty. A step whose planner
// makes no such product is told so. The style says which depth or view a picture is about.
using Figures = std::string(const SceneFrame& frame, const LayerStyle& style);
Figures scanFigures;     ///< where the scan was taken and what it returned
Figures filterFigures;   ///< what the depth filters removed of the last image
Figures stateFigures;    ///< how much is known
Figures contourFigures;  ///< contours, points, poses
Figures normalFigures;   ///< how far frontier and surface normals are apart
Figures poseFigures;     ///< the poses of one contour point
Figures segmentFigures;  ///< segments in the order in which they are tried
Figures viewFigures;     ///< why this view was chosen, or why none
Figures octreeFigures;   ///< nodes at one depth of the octree
Figures rayFigures;      ///< what became of the rays of a view
Figures utilityFigures;  ///< the factors of the chosen view, the next best one, and why others fell out

}  // namespace vantage
