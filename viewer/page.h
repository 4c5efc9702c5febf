#pragma once

#include <vtkSmartPointer.h>

#include <span>
#include <string>
#include <vector>

#include "viewer/color.h"
#include "viewer/image.h"

class vtkRenderer;

namespace vantage {

enum class HorizontalAlign { Left, Center, Right };
enum class VerticalAlign { Top, Middle, Baseline };

struct TextStyle {
  int size_px = 15;
  bool bold = false;
  Rgb color = palette::kInk;
  HorizontalAlign horizontal = HorizontalAlign::Left;
  VerticalAlign vertical = VerticalAlign::Top;
};

/// Flat page of text, marks and pictures in pixels, y down from the top: captions, legends, colour bars and
/// contact sheets. One renderer over the whole window.
class Page {
 public:
  Page(int width, int height, Rgb background = palette::kPaper);
  ~Page();
  Page(const Page&) = delete;
  Page& operator=(const Page&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  vtkRenderer* renderer() const;

  void text(double x, double y, const std::string& utf8, const TextStyle& style);
  /// Breaks at spaces to fit `width_px`; returns the y below the last line.
  double paragraph(double x, double y, double width_px, const std::string& utf8, const TextStyle& style);
  void rectangle(double x, double y, double w, double h, Rgb color, double opacity = 1.0);
  /// Around the given rectangle. Marks must not overlap: what lies above is not defined.
  void frame(double x, double y, double w, double h, Rgb color, double width_px = 1.0);
  void line(double x0, double y0, double x1, double y1, Rgb color, double width_px = 1.0);
  void disc(double x, double y, double radius, Rgb color);
  /// Horizontal strip of a colour map, low values left.
  void colorStrip(double x, double y, double w, double h, ColorMap map);
  /// The picture, stretched to w x h.
  void picture(double x, double y, double w, double h, const RgbImage& image);

 private:
  void polygon(std::span<const double> xy, Rgb color, double opacity);

  int width_, height_;
  vtkSmartPointer<vtkRenderer> renderer_;
};

/// Width of one line of text in pixels.
double textWidth(const std::string& utf8, const TextStyle& style);

/// Lines of at most `width_px`, broken at spaces; a longer word stands alone.
std::vector<std::string> wrapText(const std::string& utf8, double width_px, const TextStyle& style);

}  // namespace vantage
