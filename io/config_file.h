#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/exploration/explorer.h"
#include "core/geometry/camera_model.h"
#include "core/motion/arm_planner.h"
#include "core/motion/path_planner.h"
#include "io/error.h"
#include "io/sensor_config.h"

namespace vantage {

/// Everything that can be configured, with where each value came from. Later sources win: apply them in the
/// order user file, scene (or data set), `--config`, `--set`.
struct Settings {
  Settings();
  ExplorationConfig exploration;  ///< loop, fusion, maps, planner
  FreeFlyerConfig free_flyer;
  ArmConfig arm;  ///< cell, check step, iterations and abort are those of the free flyer, see armConfig()
  ArmErrors arm_errors;  ///< of simulated arms
  PinholeCamera camera;
  SensorNoiseConfig sensor;  ///< of simulated cameras
  /// Placement of a recorded sequence (io/dataset.h): T_world_dataset as position and unit quaternion.
  Eigen::Vector3d dataset_position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond dataset_orientation = Eigen::Quaterniond::Identity();

  /// Key to origin, e.g. "scene tabletop"; keys that are absent have their default.
  std::map<std::string, std::string, std::less<>> origins;

  /// Of an arm, with what `robot.*` says of every robot.
  ArmConfig armConfig() const;
  Pose T_world_dataset() const { return makePose(dataset_position_m, dataset_orientation); }
  /// Name of the planner; of several, with commas between them.
  std::string planner() const;
  /// Where the value of a key came from: "default" unless it was set.
  /// \throws InputError for an unknown key.
  std::string origin(std::string_view key) const;

  /// Checks every configuration struct and how they fit together. \throws InputError naming field, value and
  /// range, with the std::invalid_argument (an OutOfRange mostly) nested in it.
  void validate() const;
};

/// One configurable value as lists and help texts show it.
struct SettingInfo {
  std::string key;            ///< e.g. "fusion.truncation_m"
  std::string documentation;  ///< one line, unit and source included
  std::string allowed;        ///< e.g. "0.0 .. 10.0", "true | false"
  std::string default_value;  ///< as TOML
};

/// All keys in the order in which they are written.
std::vector<SettingInfo> listSettings();

/// Takes over the values of a TOML document. `origin` names it in messages (`ORIGIN:LINE: ...`) and in
/// Settings::origins. Top-level keys in `ignored` belong to somebody else (the geometry in a scene file).
/// On an error `settings` is unchanged.
/// \throws InputError for broken TOML, an unknown key (with the nearest known one), a wrong type, or a value
/// out of
///         range.
void applyToml(Settings& settings, std::string_view text, const std::string& origin,
               std::span<const std::string> ignored = {});

/// applyToml() of a file; its path is the origin. \throws InputError also if the file cannot be read.
void applyTomlFile(Settings& settings, const std::filesystem::path& path);

/// Takes over one `key=value`, the value as in TOML; quotes around words may be left out.
/// \throws InputError as applyToml().
void applyAssignment(Settings& settings, std::string_view key_value, const std::string& origin = "--set");

/// The effective configuration as TOML that applyToml() reads back to equal values; every value carries its
/// origin, meaning and range as a comment.
std::string effectiveToml(const Settings& settings);

/// The user's own configuration: $XDG_CONFIG_HOME/vantage/config.toml, else ~/.config/vantage/config.toml;
/// empty if neither variable is set. The file need not exist.
std::filesystem::path userConfigPath();

/// applyTomlFile() of userConfigPath() if there is such a file.
void applyUserConfig(Settings& settings);

}  // namespace vantage
