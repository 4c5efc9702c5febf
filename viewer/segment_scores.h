#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viewer/scene_frame.h"
#include "viewer/view_settings.h"

namespace vantage {

/// The segments of a step by label, with the saliency that the style asks for: the planner's, or under
/// another isolation distance or by one factor alone (eq. 11-12; segments that are too small keep 0, D-B17).
/// Empty for a step without segments. \throws std::invalid_argument for an isolation distance above the one
/// up to which the run kept distances.
std::vector<Segment> shownSegments(const SceneFrame& frame, const LayerStyle& style);

/// Groups of contour points in the order in which their segments would be tried with that saliency: indices
/// into ViewSearch::segments. As searched if the style asks for nothing else; empty without a search.
std::vector<std::uint32_t> shownOrder(const SceneFrame& frame, const LayerStyle& style);

/// The style asks for a saliency that the planner did not take.
bool asksOtherSaliency(const LayerStyle& style);

/// What the style colours segments by: "saliency", "roundness d_min / d_max", "isolation F, B_th = 5 cm".
std::string saliencyWords(const LayerStyle& style);

}  // namespace vantage
