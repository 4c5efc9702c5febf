#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "core/gpu/egl_context.h"
#include "viewer/eye.h"
#include "viewer/inspector.h"
#include "viewer/inspector_model.h"
#include "viewer/offscreen_ui.h"

namespace vantage::testing {

/// A window without a display and whoever sits before it.
struct InspectorDriver {
  EglContext context;
  std::string clipboard;
  std::string picture_title;  ///< what-if of the last picture
  int pictures_taken = 0;     ///< by the port
  ViewSettings recipe;        ///< every recipe file's view
  Inspector inspector;
  OffscreenUi ui;

  explicit InspectorDriver(Preferences preferences = {}, int width = 1280, int height = 800)
      : inspector(context, ports(), std::move(preferences)), ui(context, inspector, width, height) {}

  InspectorModel& model() { return inspector.model(); }
  WhatIf& whatIf() { return model().whatIf(); }
  /// Opens a file and waits until everything that follows from it is done.
  void open(const std::filesystem::path& file) {
    inspector.open({file});
    ui.settle();
  }
  /// Types a parameter's value, in the unit that is shown, and waits for what follows from it.
  void tryValue(const std::string& key, const std::string& text) {
    ui.click("tab/What if");
    ui.enter("what-if/" + key + "/text", text);
    ui.settle();
  }
  std::string notices() {
    std::string text;
    for (const Notice& notice : model().notices()) text += notice.text + "\n";
    return text;
  }
  /// What a widget shows, without its neighbours.
  RgbImage picture(const std::string& widget) {
    const WidgetBox* box = inspector.widgets().find(widget);
    return box ? part(ui.image(), *box) : RgbImage();
  }
  static RgbImage part(const RgbImage& window, const WidgetBox& box) {
    const int left = static_cast<int>(box.left), top = static_cast<int>(box.top);
    RgbImage part(static_cast<int>(box.right) - left, static_cast<int>(box.bottom) - top);
    for (int y = 0; y < part.height; ++y)
      for (int x = 0; x < part.width; ++x) part.set(x, y, window.at(left + x, top + y));
    return part;
  }
  /// Of the 3-D view.
  PictureSize pictureSize() {
    const WidgetBox box = *inspector.widgets().find("view");
    return {static_cast<int>(std::lround(box.right - box.left)),
            static_cast<int>(std::lround(box.bottom - box.top))};
  }
  /// Where a place of the scene is in the window. \pre before the eye
  Eigen::Vector2d inWindow(const Eigen::Vector3d& p_world) {
    const WidgetBox box = *inspector.widgets().find("view");
    return Eigen::Vector2d(box.left, box.top) +
           *pixelOf(*inspector.preferences().eye, p_world, pictureSize());
  }
  /// Colours in the upper part of a widget, without its border: a picture above its words, say.
  std::size_t coloursIn(const std::string& widget, double share = 1.0) {
    const RgbImage image = picture(widget);
    std::set<std::array<std::uint8_t, 3>> colours;
    constexpr int kBorder = 3;
    for (int y = kBorder; y < static_cast<int>(share * image.height) - kBorder; ++y)
      for (int x = kBorder; x < image.width - kBorder; ++x) colours.insert(image.at(x, y));
    return colours.size();
  }
  /// Pixels that differ between two pictures of one size.
  static int differing(const RgbImage& a, const RgbImage& b) {
    int count = 0;
    for (int y = 0; y < a.height; ++y)
      for (int x = 0; x < a.width; ++x) count += a.at(x, y) != b.at(x, y);
    return count;
  }

 private:
  InspectorPorts ports() {
    InspectorPorts ports;
    ports.copy = [this](const std::string& text) { clipboard = text; };
    ports.recipe = [this](const std::filesystem::path&) { return recipe; };
    ports.picture = [this](const SceneFrame&, const ViewSettings& view, const std::string& what_if,
                           GlContext&, int width, int height) {
      picture_title = what_if;
      ++pictures_taken;
      view.validate();
      return RgbImage(width, height);
    };
    return ports;
  }
};

}  // namespace vantage::testing
