#pragma once

#include <cstdint>
#include <span>

namespace vantage {

// Models of what a Kinect V2 reports where it errs. They are ours: the papers give no numbers, so that only
// relative reductions mean something (evaluation.md, section 8). What is drawn at random belongs to the pixel
// and the seed, not to the frame: faults are systematic, a mean of frames keeps them.

namespace kinect_faults {
/// A pixel that the emitter does not light takes its return from somewhere else. Half of them mix the
/// foreground, i.e. the nearest lit pixel of the row on the emitter's side, with the true background, in a
/// share drawn from 0 to 1; the others, and those without a foreground, are off by 3 to 30 cm to either side.
inline constexpr double kMixedShare = 0.5;
inline constexpr float kLeastBias_m = 0.03f, kMostBias_m = 0.30f;
/// A pixel at a depth step sees both sides: its depth is the mean of a grid of sub-rays across its footprint.
inline constexpr int kSubRays = 3;
/// Neighbours whose depths differ by more than this are a step, metres.
inline constexpr float kStep_m = 0.01f;
}  // namespace kinect_faults

/// Mixes bits well (Steele, Lea & Flood 2014, splitmix64).
std::uint64_t mixedBits(std::uint64_t x);
/// In [0, 1), from the upper bits.
double uniformNumber(std::uint64_t bits);

/// Puts a wrong depth into every pixel of a row that is not lit. \param row true depths, metres, infinity
/// where there is none; as long as `lit` \param lit 0 where the emitter has no sight \param emitter_left it
/// stands on the left of the camera \param row_seed of the row's pixels
void corruptShadow(std::span<float> row, std::span<const std::uint8_t> lit, bool emitter_left,
                   std::uint64_t row_seed);

/// Columns of a row at which it, or the row above or below, steps: whose depth differs from a neighbour's (of
/// four) by more than kStep_m, or that has one while a neighbour has none. \param above, below empty at the
/// image's border
bool isStep(std::span<const float> row, std::span<const float> above, std::span<const float> below,
            std::size_t u);

}  // namespace vantage
