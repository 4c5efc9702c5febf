#pragma once

#include <optional>
#include <string>

#include "viewer/candidate_table.h"
#include "viewer/panels/theme.h"
#include "viewer/scene_frame.h"

namespace vantage {

struct ColoredText {
  std::string text;
  std::optional<Rgb> color = {};  ///< the theme's ink
};

/// What the table of candidate views writes into a cell; a dash for what was never computed.
ColoredText cellText(const CandidateRow& row, CandidateColumn column, const SceneFrame& frame,
                     const Theme& theme);

/// Numbers stand at the right of their column.
bool isNumber(CandidateColumn column);

/// Of its title and of the widest text that it is made for, in pixels.
float columnWidth(const CandidateColumnText& column, bool hierarchical);

/// What a column means; of verdicts every word.
std::string columnHelp(const CandidateColumnText& column, bool hierarchical);

}  // namespace vantage
