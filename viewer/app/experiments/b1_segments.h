#pragma once

#include <vector>

#include "core/exploration/step_record.h"
#include "io/scene_rays.h"
#include "io/scene_truth.h"
#include "viewer/app/experiments/b1_runs.h"

namespace vantage::experiments {

/// Which true objects the segments of a step lie on: a segment is that of the object on which most of its
/// points lie. A point lies on an object that is within 2 cm of it and nearer than table, panel and room.
class SegmentObjects {
 public:
  /// \pre the record holds surface, labels, saliency and search of the contour planner
  /// \param others all that is no object
  SegmentObjects(const StepRecord& record, const SceneTruth& truth, const SceneRays& others);

  /// In the order in which they are tried.
  std::vector<SegmentRow> rows() const;
  SaliencyCheck check() const;

 private:
  struct Points {
    std::uint64_t all = 0;
    std::vector<std::uint64_t> of_object;
    std::uint64_t onObjects() const;
  };
  bool isObject(const SegmentSearch& search) const;
  /// Label of a group of contour points, 0 = those without a segment.
  std::uint32_t labelOf(const SegmentSearch& search) const;

  const StepRecord& record_;
  const SceneTruth& truth_;
  std::vector<Points> by_label_;  ///< index 0 = points without a segment
};

/// How far objects and everything else are apart.
struct SaliencyEnds {
  double other = 0.0;   ///< of the most salient segment that is no object
  double object = 0.0;  ///< of the least salient object, which is as salient as its best segment
};
/// Both 0 where there is no such segment.
SaliencyEnds saliencyEnds(const std::vector<SegmentRow>& rows);

/// Table, panel, room of a scene: all that is no object.
TriangleMesh meshOfOthers(const SceneFile& scene);

}  // namespace vantage::experiments
