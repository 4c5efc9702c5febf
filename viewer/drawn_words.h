#pragma once

#include <string>

struct ImDrawData;
struct ImFontAtlas;

namespace vantage {

/// The words of a frame that Dear ImGui drew, found by their glyphs' places in the fonts' texture: what
/// stands on one height beside each other is a line, gaps are a space. Lines come in the order in which they
/// were drawn; what is scrolled away or lies under something else may be among them or not.
std::string drawnWords(const ImDrawData& drawn, const ImFontAtlas& fonts);

}  // namespace vantage
