#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/exploration/planner_kind.h"

namespace vantage {

/// A planner's parameter as the window offers it. Meaning, unit, range and the way into the settings are
/// those of the configuration key (io/config_fields.h).
struct Parameter {
  std::string key;        ///< "saliency.isolation_distance_m"
  std::string symbol;     ///< of the paper: "B_th"; may be empty
  std::string label;      ///< short: "isolation distance"
  std::string unit;       ///< as shown: "mm", "deg", "rays"; may be empty
  double per_unit = 1.0;  ///< value of the key for one unit shown: 0.001 for mm
  /// Range of the slider in the key's unit, a part of what is allowed; equal ends: no slider.
  double low = 0.0, high = 0.0;
  double step = 0.0;            ///< the slider moves by whole steps of this from 0; 0 = continuous
  bool logarithmic = false;     ///< equal ways of the slider are equal factors
  std::optional<double> paper;  ///< what the paper states, in the key's unit
};

/// A heading and its parameters.
struct ParameterGroup {
  std::string title;
  std::vector<Parameter> parameters;
};

/// Everything that steers a planner, in the order of its stages; what re-ranks at once comes first. Left out
/// is what concerns other steps than the one that is looked at: views that disappointed (D-B33), and recorded
/// poses as candidates.
const std::vector<ParameterGroup>& parametersOf(PlannerKind planner);

/// The planner has it.
bool isParameterOf(PlannerKind planner, const std::string& key);

/// Null if no planner has it.
const Parameter* parameterOf(const std::string& key);

}  // namespace vantage
