// Runs that are kept, so that hours of work outlive an interruption.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <nlohmann/json.hpp>

#include "io/error.h"
#include "io/text_file.h"
#include "viewer/app/experiments/b1_runs.h"

namespace vantage::experiments {
namespace {

using Json = nlohmann::json;

constexpr std::pair<const char*, double NbvSeconds::*> kSeconds[] = {
    {"segmentation_s", &NbvSeconds::segmentation},       {"generation_s", &NbvSeconds::generation},
    {"evaluation_s", &NbvSeconds::evaluation},           {"map_update_s", &NbvSeconds::map_update},
    {"motion_planning_s", &NbvSeconds::motion_planning}, {"motion_s", &NbvSeconds::motion}};
constexpr std::pair<const char*, std::uint64_t NbvResult::*> kCounts[] = {
    {"gain_voxels", &NbvResult::gain_voxels},       {"realised_voxels", &NbvResult::realised_voxels},
    {"poses_generated", &NbvResult::generated},     {"poses_scored", &NbvResult::scored},
    {"poses_unreachable", &NbvResult::unreachable}, {"rays", &NbvResult::rays},
    {"voxels_visited", &NbvResult::visited}};

Json toJson(const NbvResult& nbv) {
  Json j{{"chosen", nbv.chosen},
         {"toward_object", nbv.toward_object},
         {"saliency", nbv.saliency},
         {"gain", nbv.gain},
         {"rank", nbv.rank}};
  for (const auto& [name, member] : kCounts) j[name] = nbv.*member;
  for (const auto& [name, member] : kSeconds) j[name] = nbv.seconds.*member;
  j["segments"] = Json::array();
  for (const SegmentRow& s : nbv.segments)
    j["segments"].push_back({{"saliency", s.saliency},
                             {"poses", s.poses},
                             {"contour_points", s.contour_points},
                             {"object", s.object}});
  if (const auto& check = nbv.saliency_check)
    j["saliency_check"] = {{"objects_first", check->objects_first},
                           {"object_share", check->object_share},
                           {"object_pose_share", check->object_pose_share}};
  return j;
}

NbvResult nbvFrom(const Json& j) {
  NbvResult nbv;
  nbv.chosen = j.at("chosen");
  nbv.toward_object = j.at("toward_object");
  nbv.saliency = j.at("saliency");
  nbv.gain = j.at("gain");
  nbv.rank = j.at("rank");
  for (const auto& [name, member] : kCounts) nbv.*member = j.at(name);
  for (const auto& [name, member] : kSeconds) nbv.seconds.*member = j.at(name);
  for (const Json& s : j.at("segments"))
    nbv.segments.push_back({s.at("saliency"), s.at("poses"), s.at("contour_points"), s.at("object")});
  if (j.contains("saliency_check")) {
    const Json& check = j.at("saliency_check");
    nbv.saliency_check = {check.at("objects_first"), check.at("object_share"), check.at("object_pose_share")};
  }
  return nbv;
}

bool isWhole(const ExplorationRun& run) {
  return run.nbvs.size() == kNbvs && run.unknown_near_objects.size() == kNbvs + 1 &&
         run.unknown_in_boxes.size() == kNbvs + 1;
}

ExplorationRun runFrom(const RunOf& run, const Json& j) {
  ExplorationRun result;
  result.run = run;
  for (const Json& nbv : j.at("nbvs")) result.nbvs.push_back(nbvFrom(nbv));
  result.unknown_near_objects = j.at("unknown_near_objects").get<std::vector<double>>();
  result.unknown_in_boxes = j.at("unknown_in_boxes").get<std::vector<double>>();
  result.coverage = j.at("coverage");
  result.stop_reason = j.at("stop_reason");
  return result;
}

}  // namespace

KeptRuns::KeptRuns(std::filesystem::path folder, std::string program)
    : folder_(std::move(folder)), program_(std::move(program)) {}

std::filesystem::path KeptRuns::fileOf(const RunOf& run) const {
  std::string name = fmt::format("{}-{}-{}-{}", run.scene, toString(run.series), run.method(), run.seed);
  if (!run.variant.empty()) name += "-" + run.variant;
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c) && c != '-' && c != '.'; }, '_');
  return folder_ / (name + ".json");
}

/// All that a result depends on, as one number in hexadecimal.
std::string KeptRuns::setup(const RunOf& run, const std::function<void(Settings&)>& tune) const {
  const SceneFile scene = sceneOf(run);
  const std::size_t threads = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  const std::string text = program_ + fmt::format("{} threads", threads) + scene.text +
                           effectiveToml(settingsOf(run, scene, tune));
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return fmt::format("{:016x}", hash);
}

std::optional<ExplorationRun> KeptRuns::find(const RunOf& run,
                                             const std::function<void(Settings&)>& tune) const {
  if (folder_.empty() || !std::filesystem::is_regular_file(fileOf(run))) return std::nullopt;
  try {
    const Json j = Json::parse(readTextFile(fileOf(run)));
    if (j.at("setup") != setup(run, tune)) return std::nullopt;
    ExplorationRun result = runFrom(run, j);
    if (isWhole(result)) return result;
  } catch (const Json::exception&) {
  } catch (const InputError&) {
  }
  return std::nullopt;  // cut short, not readable, or not ours: it is run again
}

void KeptRuns::keep(const ExplorationRun& result, const std::function<void(Settings&)>& tune) const {
  if (folder_.empty()) return;
  Json j{{"run", result.run.text()},
         {"setup", setup(result.run, tune)},
         {"unknown_near_objects", result.unknown_near_objects},
         {"unknown_in_boxes", result.unknown_in_boxes},
         {"coverage", result.coverage},
         {"stop_reason", result.stop_reason},
         {"nbvs", Json::array()}};
  for (const NbvResult& nbv : result.nbvs) j["nbvs"].push_back(toJson(nbv));
  std::filesystem::create_directories(folder_);
  saveFile(fileOf(result.run), j.dump(1) + "\n");
}

}  // namespace vantage::experiments
