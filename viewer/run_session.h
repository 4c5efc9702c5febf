#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/exploration/plan_view.h"
#include "viewer/map_pool.h"
#include "viewer/step_data.h"

namespace vantage {

/// What became of a run file since it was last asked.
struct Followed {
  bool grown = false;     ///< steps, the closing scan or realised gains were added
  bool finished = false;  ///< the run says why it ended; nothing more will come
  bool replaced = false;  ///< another file lies at the path, which is to be opened anew
  bool gone = false;      ///< no file lies at the path
  std::string problem;    ///< why the file cannot be read any more; else empty
  bool operator==(const Followed&) const = default;
};

/// One run file that is looked at, step by step in any order, also while it is written. One thread at a time
/// uses it; what it hands out is immutable and may go anywhere, also after the session is gone. Two maps in
/// memory are enough if whoever shows a step drops the one before.
class RunSession {
 public:
  /// \throws InputError as RunReader does.
  explicit RunSession(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  std::shared_ptr<const RunHeader> header() const { return header_; }
  /// Key figures of all steps and of the closing scan, as of the opening or the last refresh().
  const std::vector<StepSummary>& summaries() const { return summaries_; }
  /// The run says why it ended.
  bool finished() const { return finished_; }

  /// A step, or the closing scan under its number. \throws InputError: no such step, damaged, gone or
  /// replaced while it was being written; std::runtime_error if the map does not fit in memory.
  StepData load(int step);

  /// Brings a map that nobody holds to a step ahead of time, so that load() finds it there. Nothing happens
  /// if that would take a third map, or there is no such step. \throws as load().
  void prepare(int step);

  /// What the steps before leave out in their successors (executed and disappointing views). \throws as
  /// load().
  Exclusions exclusionsBefore(int step);

  /// Looks at the file again; never throws for what may become of it.
  Followed refresh();

 private:
  static constexpr std::size_t kMostMaps = 2;  ///< one that is shown, one for the step that comes next
  struct VolumeMap {
    TsdfVolume volume;
    StateGrid states;
    int step = 0;
  };
  struct OctreeMap {
    OccupancyOctree octree;
    StatePyramid pyramid;
    int step = 0;
  };
  std::shared_ptr<const StepRecord> record(int step) const;
  std::shared_ptr<const VolumeMap> volumeAt(int step);
  std::shared_ptr<const OctreeMap> octreeAt(int step);
  std::shared_ptr<const RayTree> tree();

  std::filesystem::path path_;
  RunReader reader_;
  std::shared_ptr<const RunHeader> header_;
  std::vector<StepSummary> summaries_;
  bool finished_ = false;
  MapPool<VolumeMap> volumes_{kMostMaps};
  MapPool<OctreeMap> octrees_{kMostMaps};
  std::shared_ptr<const RayTree> tree_;
  std::map<int, Exclusions> exclusions_;  ///< by the step before which they hold
};

}  // namespace vantage
