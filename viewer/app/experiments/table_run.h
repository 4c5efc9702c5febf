#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/exploration/explorer.h"
#include "io/config_file.h"
#include "viewer/app/experiments/candidate_truth.h"
#include "viewer/app/experiments/objects.h"

namespace vantage::experiments {

/// One object of one size on the table, ready to be explored (evaluation.md, A1).
struct TableSetup {
  std::string object;
  double size_m = 0.0;
  SceneFile scene;
  Settings settings;
  double table_top_m = 0.0;  ///< sensors below it are hidden by the table
  std::unique_ptr<CandidateTruth> truth;
};

/// Settings of a scene on the table. \param steps most planning steps \param tune changes the settings after
/// everything else; may be empty \throws InputError for settings that don't go together
Settings tableSettings(const SceneFile& scene, int steps, const std::function<void(Settings&)>& tune);

/// \param steps most planning steps \param tune changes the settings after everything else; may be empty
TableSetup setUpTable(const ObjectSource& source, double size_m, int steps,
                      const std::function<void(Settings&)>& tune);

/// Object's box of the experiments: the object's extent and 5 cm on each side, from the table's top up.
Box objectBox(const SceneFile& scene);

/// How views are evaluated in a run.
struct RunSpec {
  int coarse_levels = 0;  ///< m; 0 = uniform ray tracing
  ChildStart start = ChildStart::Resume;
  InnerRule inner = InnerRule::Max;
  bool repeat_views = false;    ///< views that were taken may be chosen again, as the paper has it
  double min_overlap = 0.0;     ///< share of known surface instead of h_oc (D-A15), 0 = off
  bool refine_unknown = false;  ///< coarse unknown nodes are refined as well (D-A4)
  std::string label() const;    ///< "m=2 resume"
  /// Runs with other rules than the specification's own are printed, not graded.
  bool graded() const { return !repeat_views && min_overlap == 0.0 && !refine_unknown; }
};

/// What one planning step did.
struct IterationResult {
  double nbv_s = 0.0;  ///< candidates, cascade and choice, without motion planning
  double cpu_s = 0.0;  ///< CPU time of cascade and choice, all threads
  std::uint64_t candidates = 0, scored = 0, survivors = 0, rays = 0, finest_rays = 0, visits = 0;
  std::uint64_t rejected_registration = 0;
  std::uint64_t occupied_rays = 0, unknown_rays = 0;  ///< over all views
  std::uint64_t unknown_voxels = 0;                   ///< in the object's box, after the scan
  std::int64_t chosen = -1;                           ///< id of the next view, -1 = none
  double gain = 0.0;
  bool literal_stop = false;
  bool operator==(const IterationResult&) const = default;
};

/// Cost of the views that the table hides, on the map after the first scan.
struct HiddenViews {
  std::size_t views = 0;
  std::uint64_t visits = 0;
  double seconds = 0.0;
};

struct RunResult {
  RunSpec spec;
  std::vector<IterationResult> iterations;
  std::vector<double> unknown_per_scan;
  int scans = 0;
  std::string stop_reason;  ///< in words (stopWords())
  bool cut_off = false;     ///< the steps were used up before the stop rule fired: ends don't compare
  int literal_stop = 0;     ///< iteration at which the literal rule would have stopped, 0 = never (D-A18)
  std::optional<double> coverage;  ///< share in [0,1]; none if no candidate sees any of the object
  std::optional<double> accuracy_mean_m, accuracy_95_m;  ///< none without an occupied voxel in the box
  HiddenViews hidden;
  std::uint64_t rays_per_view = 0;           ///< of the whole finest bundle
  std::uint64_t different_from_uniform = 0;  ///< m = 0: views whose counts the hierarchical caster disputes
  std::uint64_t compared_with_uniform = 0;
  std::uint64_t wrong_labels = 0;     ///< voxels and nodes of the pyramid that the octree labels otherwise
  std::uint64_t compared_labels = 0;  ///< of so many,
  int compared_steps = 0;             ///< over all steps at which they were compared
  double meanNbv_s() const;
  double totalNbv_s() const;
  double meanCpu_s() const;
  double secondsPerCandidate() const;
};

/// The whole loop for one object, measured. Phases shorter than a second are repeated `repeats` times on the
/// inputs of the step; the median counts.
RunResult runOnTable(const TableSetup& setup, const RunSpec& spec, int repeats, const RunControl& control);

}  // namespace vantage::experiments
