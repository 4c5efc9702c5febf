#pragma once

#include <string>
#include <vector>

#include "snapshots/recipe.h"
#include "viewer/layers/layer_notes.h"
#include "viewer/offscreen_renderer.h"

namespace vantage {

/// Steps on one page: a row a step, a column a recipe, captions under the tiles, legends below the columns.
/// Tiles are drawn as the steps come by, so that only pictures are kept. Two runs side by side have columns
/// of their own each.
class ContactSheet {
 public:
  struct Column {
    std::string heading;
    Recipe recipe;
    std::string note = {};  ///< under the heading, e.g. the run
  };

  /// \param title above all; \param columns non-empty.
  ContactSheet(std::string title, std::vector<Column> columns);
  /// Columns under the titles of their recipes.
  ContactSheet(std::string title, const std::vector<Recipe>& columns);

  /// Draws the row of a frame; `scene` must hold the frame already. Recipes whose products the frame lacks
  /// stay blank.
  void addRow(Scene& scene, OffscreenRenderer& renderer, const SceneFrame& frame);

  /// Begins a row with blank tiles. \param label number of the step, or "end"
  void beginRow(const std::string& label);
  /// Draws one tile of the row begun last; as addRow() otherwise.
  void setTile(std::size_t column, Scene& scene, OffscreenRenderer& renderer, const SceneFrame& frame);

  int rows() const { return static_cast<int>(rows_.size()); }
  /// Rows that fit on one page.
  static constexpr int kMostRows = 16;

  RgbImage draw(OffscreenRenderer& renderer) const;

  /// The label of a frame's row.
  static std::string labelOf(const StepRecord& record);

 private:
  struct Tile {
    RgbImage image;
    std::string caption;
    std::vector<ColorScale> scales;
    std::vector<LegendEntry> legend;
  };
  struct Row {
    std::string label;
    std::vector<Tile> tiles;
  };

  int legendHeight() const;

  std::string title_;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

}  // namespace vantage
