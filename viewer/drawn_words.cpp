#include "viewer/drawn_words.h"

#include <imgui.h>

#include <cmath>
#include <map>
#include <span>
#include <utility>

namespace vantage {
namespace {

using Glyphs = std::map<std::pair<float, float>, const ImFontGlyph*>;

/// By the corner of each in the texture.
Glyphs glyphsOf(const ImFontAtlas& fonts) {
  Glyphs glyphs;
  for (const ImFont* font : fonts.Fonts)
    for (const ImFontGlyph& glyph : font->Glyphs)
      if (glyph.Visible) glyphs[{glyph.U0, glyph.V0}] = &glyph;
  return glyphs;
}

/// A letter of the plane that Dear ImGui's glyphs are from.
void append(std::string& text, unsigned letter) {
  const auto byte = [&](unsigned value) { text += static_cast<char>(value); };
  if (letter < 0x80) {
    byte(letter);
  } else if (letter < 0x800) {
    byte(0xc0 | letter >> 6);
    byte(0x80 | (letter & 0x3f));
  } else {
    byte(0xe0 | letter >> 12);
    byte(0x80 | (letter >> 6 & 0x3f));
    byte(0x80 | (letter & 0x3f));
  }
}

/// Puts letters together again.
class Lines {
 public:
  explicit Lines(const Glyphs& glyphs) : glyphs_(glyphs) {}

  /// Six indices that may be a letter's two triangles; true if they are.
  bool add(std::span<const ImDrawVert> vertices, std::span<const ImDrawIdx> indices) {
    const ImDrawIdx a = indices[0];
    if (indices[1] != a + 1 || indices[2] != a + 2 || indices[3] != a || indices[5] != a + 3) return false;
    const ImDrawVert& corner = vertices[a];
    const auto found = glyphs_.find({corner.uv.x, corner.uv.y});
    if (found == glyphs_.end() || vertices[a + 2].uv.x != found->second->U1) return false;
    add(*found->second, corner.pos, vertices[a + 2].pos);
    return true;
  }

  std::string text;

 private:
  void add(const ImFontGlyph& glyph, const ImVec2& low, const ImVec2& high) {
    constexpr float kSame_px = 1.0f;
    const float scale = (high.y - low.y) / (glyph.Y1 - glyph.Y0);
    const float x = low.x - scale * glyph.X0, y = low.y - scale * glyph.Y0;
    const bool same_line = std::abs(y - y_) < kSame_px && x > next_x_ - kSame_px;
    if (!text.empty() && !same_line) text += '\n';
    if (!text.empty() && same_line && x > next_x_ + kSame_px) text += ' ';
    append(text, glyph.Codepoint);
    y_ = y;
    next_x_ = x + scale * glyph.AdvanceX;
  }

  const Glyphs& glyphs_;
  float next_x_ = 0.0f, y_ = 0.0f;
};

}  // namespace

std::string drawnWords(const ImDrawData& drawn, const ImFontAtlas& fonts) {
  const Glyphs glyphs = glyphsOf(fonts);
  Lines lines(glyphs);
  for (const ImDrawList* list : std::span(drawn.CmdLists, drawn.CmdListsCount))
    for (const ImDrawCmd& command : list->CmdBuffer) {
      if (command.UserCallback || command.TextureId != fonts.TexID) continue;
      const std::span<const ImDrawVert> vertices(list->VtxBuffer.Data + command.VtxOffset,
                                                 list->VtxBuffer.Size - command.VtxOffset);
      std::span<const ImDrawIdx> indices(list->IdxBuffer.Data + command.IdxOffset, command.ElemCount);
      while (indices.size() >= 6) indices = indices.subspan(lines.add(vertices, indices) ? 6 : 3);
    }
  return lines.text;
}

}  // namespace vantage
