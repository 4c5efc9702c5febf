#pragma once

#include "viewer/color.h"

namespace vantage {

/// Colours around a scene and of what has no colour of its own.
struct SceneTheme {
  Rgb background = palette::kPaper;
  Rgb ink = palette::kInk;  ///< lines and letters that would not stand out from the background come near it
  bool operator==(const SceneTheme&) const = default;
};

/// The colour mixed with ink until it stands out from the background as it does from paper, 3:1 at most; one
/// that is faint on paper is mixed with the background until it is faint there too.
Rgb readable(Rgb color, const SceneTheme& theme);

}  // namespace vantage
