#pragma once

#include <cstdint>
#include <string>

#include "viewer/scene_frame.h"

namespace vantage {

// Words that captions, tables and explanations share.

/// "1 view", "1 234 views".
std::string plural(std::uint64_t count, const std::string& noun);
/// A whole number, rounded, with blanks between thousands; 0 if negative.
std::string whole(double value);
/// As many digits as matter: 0.0417 with three of them.
std::string rounded(double value, int digits);
/// So many decimals.
std::string fixed(double value, int decimals = 2);

/// How a group of contour points is called, by its place in the order as the pictures number it: "no. 1
/// (label 7, saliency 0.51)". \pre record.search has it
std::string searchName(const StepRecord& record, std::size_t search);

/// The same, short enough for a column: its label, "none" for contour points without a segment, "all" for the
/// baseline's only group. \pre record.search has it
std::string segmentName(const SceneFrame& frame, std::size_t search);

/// Why a view cannot be taken, in two words: "out of reach", "in collision"; empty if nothing says so.
std::string refusalWord(Reachability verdict);

/// Views of a segment above the threshold that the robot was asked for and cannot take: "7 in collision, 5
/// out of reach"; empty if there are none.
std::string refusals(const SegmentSearch& search, double threshold);

/// What the planner of a step counts: "rays" or "voxels".
std::string countUnit(const RunHeader& header, const StepRecord& record);
std::string countUnit(const SceneFrame& frame);

}  // namespace vantage
