#include "snapshots/contact_sheet.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "viewer/legend.h"
#include "viewer/page.h"
#include "viewer/step_data.h"

namespace vantage {
namespace {

// Pixels.
constexpr int kTileWidth = 480, kTileHeight = 330, kCaption = 142, kGap = 14, kMargin = 20;
constexpr int kHead = 104, kRowHead = 74, kLegendLine = 27;
constexpr int kInsetWidth = 118, kScaleWidth = 170;

TextStyle textOf(int size_px, bool bold = false, Rgb color = palette::kInk) {
  TextStyle style;
  style.size_px = size_px;
  style.bold = bold;
  style.color = color;
  return style;
}

/// Puts a picture, shrunk to `width`, into the upper right corner of another.
void placeInset(RgbImage& image, const RgbImage& inset, int width) {
  const int height = width * inset.height / std::max(1, inset.width);
  const int left = image.width - width - 8, top = 8;
  for (int y = -1; y <= height; ++y) {
    for (int x = -1; x <= width; ++x) {
      const bool border = x < 0 || y < 0 || x == width || y == height;
      const auto color =
          border ? palette::kFaintInk.bytes() : inset.at(x * inset.width / width, y * inset.height / height);
      image.set(left + x, top + y, color);
    }
  }
}

std::vector<ContactSheet::Column> columnsOf(const std::vector<Recipe>& recipes) {
  std::vector<ContactSheet::Column> columns;
  for (const Recipe& recipe : recipes) columns.push_back({recipe.title, recipe, ""});
  return columns;
}

}  // namespace

ContactSheet::ContactSheet(std::string title, std::vector<Column> columns)
    : title_(std::move(title)), columns_(std::move(columns)) {
  if (columns_.empty()) throw std::invalid_argument("contact sheet: it needs at least one recipe");
}

ContactSheet::ContactSheet(std::string title, const std::vector<Recipe>& columns)
    : ContactSheet(std::move(title), columnsOf(columns)) {}

std::string ContactSheet::labelOf(const StepRecord& record) {
  return record.closing ? "end" : std::to_string(record.step);
}

void ContactSheet::addRow(Scene& scene, OffscreenRenderer& renderer, const SceneFrame& frame) {
  beginRow(labelOf(frame.record));
  for (std::size_t c = 0; c < columns_.size(); ++c) setTile(c, scene, renderer, frame);
}

void ContactSheet::beginRow(const std::string& label) {
  rows_.push_back({label, std::vector<Tile>(columns_.size())});
}

void ContactSheet::setTile(std::size_t column, Scene& scene, OffscreenRenderer& renderer,
                           const SceneFrame& frame) {
  const Recipe& recipe = columns_.at(column).recipe;
  Tile& tile = rows_.back().tiles.at(column);
  if (frame.record.closing && recipe.planning()) return;
  if (!recipe.fits(plannerKindOf(frame.header, frame.record))) return;
  scene.show(viewFor(recipe, frame), {}, PageStyle::ViewOnly, kTileWidth, kTileHeight);
  tile.image = renderer.render(scene.renderers(), kTileWidth, kTileHeight);
  tile.caption = recipe.figures(frame, recipe.view.style);
  for (const LayerNotes* notes : scene.shownNotes()) {
    if (notes->scale) tile.scales.push_back(*notes->scale);
    if (notes->inset) placeInset(tile.image, notes->inset->image, kInsetWidth);
    tile.legend.insert(tile.legend.end(), notes->legend.begin(), notes->legend.end());
  }
}

int ContactSheet::legendHeight() const {
  std::size_t most = 0;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    std::set<std::string> texts;
    for (const Row& row : rows_) {
      for (const LegendEntry& entry : row.tiles[c].legend) texts.insert(entry.text);
    }
    most = std::max(most, texts.size());
  }
  return static_cast<int>(most + 1) * kLegendLine;  // one of them may take two lines
}

RgbImage ContactSheet::draw(OffscreenRenderer& renderer) const {
  const int columns = static_cast<int>(columns_.size());
  const int width = kMargin * 2 + kRowHead + columns * kTileWidth + (columns - 1) * kGap;
  const int row_height = kTileHeight + kCaption;
  const int legend_height = legendHeight();
  const int height = kHead + rows() * row_height + legend_height + kMargin;
  Page page(width, height);
  page.text(kMargin, 18, title_, textOf(28, true));
  for (int c = 0; c < columns; ++c) {
    const double x = kMargin + kRowHead + c * (kTileWidth + kGap);
    page.text(x, columns_[c].note.empty() ? 66 : 58, columns_[c].heading, textOf(18, true));
    page.text(x, 80, columns_[c].note, textOf(14, false, palette::kFaintInk));
    // The legend of a column holds what any of its tiles shows.
    LayerNotes legend;
    for (int r = 0; r < rows(); ++r) {
      const Tile& tile = rows_[r].tiles[c];
      legend.legend.insert(legend.legend.end(), tile.legend.begin(), tile.legend.end());
      const double y = kHead + r * row_height;
      if (tile.image.empty()) continue;
      page.picture(x, y, kTileWidth, kTileHeight, tile.image);
      page.frame(x, y, kTileWidth, kTileHeight, palette::kRule);
      const double text_width = tile.scales.empty() ? kTileWidth : kTileWidth - kScaleWidth - 20;
      page.paragraph(x, y + kTileHeight + 6, text_width, tile.caption, textOf(13));
      if (!tile.scales.empty()) {
        drawScale(page, x + kTileWidth - kScaleWidth, y + kTileHeight + 6, kScaleWidth, tile.scales.front(),
                  0.85);
      }
    }
    const LayerNotes* contents[] = {&legend};
    const double legend_y = kHead + rows() * row_height + 10.0;
    drawLegend(page, {x, legend_y, static_cast<double>(kTileWidth), static_cast<double>(legend_height)},
               contents, 0.95);
  }
  for (int r = 0; r < rows(); ++r) {
    const double y = kHead + r * row_height;
    const bool number = rows_[r].label != "end";
    page.text(kMargin, y, number ? "step" : "after", textOf(15, false, palette::kFaintInk));
    page.text(kMargin, y + 19, number ? rows_[r].label : "all", textOf(number ? 38 : 24, true));
  }
  vtkRenderer* renderers[] = {page.renderer()};
  return renderer.render(renderers, width, height);
}

}  // namespace vantage
