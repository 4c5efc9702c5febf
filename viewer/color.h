#pragma once

#include <array>
#include <cstdint>

namespace vantage {

/// Linear in display values, each in [0, 1].
struct Rgb {
  double r = 0.0, g = 0.0, b = 0.0;
  std::array<std::uint8_t, 3> bytes() const;
  bool operator==(const Rgb&) const = default;
};

/// The colour of an 8-bit triple.
constexpr Rgb rgb(int r, int g, int b) {
  return {r / 255.0, g / 255.0, b / 255.0};
}

/// Colours of everything that has no scale. Neighbours differ in lightness as well as in hue (after Okabe and
/// Ito).
namespace palette {
inline constexpr Rgb kPaper = rgb(250, 250, 248);
inline constexpr Rgb kPanel = rgb(240, 241, 242);
inline constexpr Rgb kInk = rgb(32, 36, 42);
inline constexpr Rgb kFaintInk = rgb(104, 110, 118);
inline constexpr Rgb kRule = rgb(200, 203, 207);
inline constexpr Rgb kOccupied = rgb(122, 138, 158);
inline constexpr Rgb kUnknown = rgb(230, 145, 0);
inline constexpr Rgb kFree = rgb(86, 180, 233);
inline constexpr Rgb kSurface = rgb(176, 180, 186);
inline constexpr Rgb kNoSegment = rgb(150, 150, 150);
inline constexpr Rgb kContour = rgb(0, 96, 160);
inline constexpr Rgb kNormal = rgb(190, 30, 90);
inline constexpr Rgb kSurfaceNormal = rgb(0, 170, 190);
inline constexpr Rgb kChosen = rgb(214, 20, 70);
inline constexpr Rgb kPath = rgb(0, 96, 180);
inline constexpr Rgb kArm = rgb(226, 110, 60);
inline constexpr Rgb kArmGoal = rgb(214, 70, 90);
inline constexpr Rgb kArmGhost = rgb(120, 124, 132);
inline constexpr Rgb kSensor = rgb(40, 44, 52);
inline constexpr Rgb kUnreachable = rgb(70, 70, 74);
inline constexpr Rgb kCandidate = rgb(90, 120, 160);
inline constexpr Rgb kObjectBox = rgb(0, 112, 96);
inline constexpr Rgb kAround = rgb(224, 222, 217);
inline constexpr Rgb kNode = rgb(60, 78, 104);
inline constexpr Rgb kUnknownEdge = rgb(190, 110, 0);
// What a view sees.
inline constexpr Rgb kLit = rgb(255, 214, 40);
inline constexpr Rgb kOccluder = rgb(120, 132, 150);
// Fates of rays.
inline constexpr Rgb kRayMissed = rgb(170, 174, 180);
inline constexpr Rgb kRayRefined = rgb(160, 70, 150);
inline constexpr Rgb kRayOccupied = rgb(0, 70, 130);
// Things that need a colour each, one after the other in use; none is that of surface without a segment.
inline constexpr std::array<Rgb, 12> kDistinct = {rgb(0, 90, 150),    rgb(240, 190, 60),  rgb(150, 40, 90),
                                                  rgb(120, 200, 220), rgb(30, 110, 80),   rgb(235, 150, 190),
                                                  rgb(90, 70, 160),   rgb(200, 220, 130), rgb(170, 80, 20),
                                                  rgb(170, 180, 240), rgb(70, 80, 30),    rgb(250, 190, 150)};
// Views that fell out of the cascade.
inline constexpr Rgb kRejectedPosition = rgb(172, 174, 178);
inline constexpr Rgb kRejectedRegistration = rgb(228, 230, 232);
inline constexpr Rgb kRejectedPath = rgb(200, 202, 206);
inline constexpr Rgb kRejectedExecuted = rgb(186, 188, 192);
}  // namespace palette

/// Perceptually uniform maps, safe for colour-blind readers.
enum class ColorMap { Viridis, Cividis };

/// Colour at `t`, clamped to [0, 1].
Rgb colorAt(ColorMap map, double t);

}  // namespace vantage
