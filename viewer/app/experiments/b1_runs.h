#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/run_control.h"
#include "io/config_file.h"
#include "io/scene_file.h"

namespace vantage::experiments {

inline constexpr int kNbvs = 5;  ///< of a run (Table 1)

/// What is simulated beside the scene (evaluation.md, section 4).
enum class Series {
  Core,      ///< panel, ideal pre-processing, noise; the graded one
  Open,      ///< without the panel
  Filtered,  ///< a sensor with faults and the filters behind it
  Exact,     ///< no noise
  Unseen,    ///< as the core, on scenes by somebody who had not seen the defaults
  Arm,       ///< as the core, the camera in the hand of the paper's arm
};
/// `core`, `open`, `filtered`, `exact`, `unseen`, `arm`.
std::string_view toString(Series series);

/// One run of B1.
struct RunOf {
  std::string scene;  ///< with its panel, e.g. "tabletop"
  Series series = Series::Core;
  bool proposed = true;  ///< false: the standard baseline (D-B16)
  std::uint64_t seed = 1;
  std::string variant = "";                ///< of B2, e.g. "no isolation"; empty: as it is
  std::vector<std::string> settings = {};  ///< what makes the variant, "key=value"
  std::string method() const { return proposed ? "proposed" : "standard"; }
  /// "tabletop core proposed seed 1", and the variant.
  std::string text() const;
};

/// Wall-clock seconds of one NBV or summed over a run.
struct NbvSeconds {
  double segmentation = 0.0;  ///< surface, segments and saliency; 0 for the baseline
  double generation = 0.0;    ///< contours and view poses
  double evaluation = 0.0;
  double map_update = 0.0;  ///< fusion and the planner's collision map
  double motion_planning = 0.0;
  double motion = 0.0;  ///< modelled
  double nbv() const { return segmentation + generation + evaluation; }
  double total() const { return nbv() + map_update + motion_planning + motion; }
};

/// A segment as the third NBV of Table 2 lists them.
struct SegmentRow {
  double saliency = 0.0;
  std::uint64_t poses = 0, contour_points = 0;
  std::string object;  ///< true object of most of its points; "" = table, panel or nothing within 2 cm
};

/// What criterion 5 needs of one segmented cloud.
struct SaliencyCheck {
  /// All object segments with more than 5 contour points are above all others (table, panel, and points
  /// without a segment); false if there is none.
  bool objects_first = false;
  double object_share = 0.0;       ///< of the object points, those in object segments
  double object_pose_share = 0.0;  ///< of all poses, those of object segments
};

/// One next best view, or why there was none.
struct NbvResult {
  bool chosen = false;
  bool toward_object = false;  ///< the tick
  double saliency = 0.0;       ///< of the segment; 0 for the baseline
  double gain = 0.0;           ///< pixels
  std::uint64_t gain_voxels = 0, realised_voxels = 0;
  std::uint64_t generated = 0, scored = 0, unreachable = 0, rays = 0, visited = 0;
  std::uint32_t rank = 0;  ///< of the chosen pose in its group, from 0
  NbvSeconds seconds;
  std::vector<SegmentRow> segments;  ///< proposed alone, in the order in which they are tried
  std::optional<SaliencyCheck> saliency_check;
};

/// One run: five NBVs and the unknown near objects after each scan.
struct ExplorationRun {
  RunOf run;
  std::vector<NbvResult> nbvs;  ///< kNbvs of them; those that were not planned have chosen = false
  std::vector<double> unknown_near_objects;  ///< U_tau after the initial scan and each NBV, kNbvs + 1
  std::vector<double> unknown_in_boxes;      ///< U_box, the same
  double coverage = 0.0;
  std::string stop_reason;

  int ticks() const;
  /// No NBV with a tick comes after one without.
  bool ticksFirst() const;
  /// Area under U_tau by the trapezoidal rule, voxels x NBV.
  double area() const;
  NbvSeconds seconds() const;  ///< summed
};

/// Settings of a run; `tune` is the command line's part and may be empty. \throws InputError
Settings settingsOf(const RunOf& run, const SceneFile& scene, const std::function<void(Settings&)>& tune);
/// The scene of a run.
SceneFile sceneOf(const RunOf& run);

/// Runs it. \throws Cancelled
ExplorationRun runExploration(const RunOf& run, const std::function<void(Settings&)>& tune,
                              const RunControl& control);

/// Results that were kept in a folder, by run; a kept result counts only for the same program, scene,
/// settings and number of threads.
class KeptRuns {
 public:
  /// \param folder empty: nothing is kept \param program version and commit
  KeptRuns(std::filesystem::path folder, std::string program);
  std::optional<ExplorationRun> find(const RunOf& run, const std::function<void(Settings&)>& tune) const;
  void keep(const ExplorationRun& result, const std::function<void(Settings&)>& tune) const;

 private:
  std::filesystem::path fileOf(const RunOf& run) const;
  std::string setup(const RunOf& run, const std::function<void(Settings&)>& tune) const;
  std::filesystem::path folder_;
  std::string program_;
};

}  // namespace vantage::experiments
