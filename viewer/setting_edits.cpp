#include "viewer/setting_edits.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "io/text_file.h"
#include "viewer/parameters.h"

namespace vantage {
namespace {

const config::Field& fieldOf(const std::string& key) {
  const config::Field* field = config::find(key);
  if (!field) throw std::logic_error("no setting '" + key + "'");
  return *field;
}

bool isNumber(const config::Field& field) {
  return field.kind == config::Kind::Number || field.kind == config::Kind::Integer;
}

/// Shortest text of a number that has at most nine digits after scaling.
std::string decimal(double value) {
  std::array<char, 40> text;
  std::snprintf(text.data(), text.size(), "%.9g", value);
  return text.data();
}

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// What a person typed as the value of a field. \throws std::invalid_argument
config::Value parsed(const config::Field& field, const std::string& typed) {
  const Parameter* parameter = parameterOf(field.key);
  const double per_unit = parameter ? parameter->per_unit : 1.0;
  std::string text = trimmed(typed);
  if (parameter && !parameter->unit.empty() && text.ends_with(parameter->unit))
    text = trimmed(text.substr(0, text.size() - parameter->unit.size()));
  const auto number = parseNumber(text);
  const std::string unit = parameter && !parameter->unit.empty() ? " " + parameter->unit : "";
  if (!number)
    throw std::invalid_argument("'" + typed + "' is not a number; allowed: " + decimal(field.low / per_unit) +
                                " .. " + decimal(field.high / per_unit) + unit);
  const double value = *number * per_unit;
  if (!(value >= field.low && value <= field.high))
    throw std::invalid_argument(text + unit + " is out of range; allowed: " + decimal(field.low / per_unit) +
                                " .. " + decimal(field.high / per_unit) + unit);
  if (field.kind != config::Kind::Integer) return value;
  if (value != std::floor(value)) throw std::invalid_argument(text + " is not a whole number");
  return static_cast<std::int64_t>(value);
}

}  // namespace

std::string shownText(const std::string& key, const config::Value& value) {
  const config::Field& field = fieldOf(key);
  const Parameter* parameter = parameterOf(key);
  const double per_unit = parameter ? parameter->per_unit : 1.0;
  if (const auto* number = std::get_if<double>(&value)) return decimal(*number / per_unit);
  if (const auto* integer = std::get_if<std::int64_t>(&value)) return std::to_string(*integer);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  return config::toToml(value, field.kind);
}

void SettingEdits::setRecorded(Settings settings) {
  recorded_ = wanted_ = std::move(settings);
  edits_.clear();
  errors_.clear();
  done_ = 0;
  open_ = false;
}

config::Value SettingEdits::value(const std::string& key) const {
  return fieldOf(key).get(wanted_);
}

config::Value SettingEdits::recordedValue(const std::string& key) const {
  return fieldOf(key).get(recorded_);
}

bool SettingEdits::anyChanged() const {
  for (const config::Field& field : config::fields())
    if (field.get(wanted_) != field.get(recorded_)) return true;
  return false;
}

bool SettingEdits::apply(const std::string& key, const config::Value& value) {
  const config::Field& field = fieldOf(key);
  if (field.get(wanted_) == value) {
    errors_.erase(key);
    return false;
  }
  Settings tried = wanted_;
  try {
    field.set(tried, config::checked(field, value));
    tried.validate();
  } catch (const std::exception& e) {
    errors_[key] = e.what();
    return false;
  }
  wanted_ = std::move(tried);
  errors_.erase(key);
  return true;
}

void SettingEdits::remember(Edit edit) {
  edits_.resize(done_);
  if (open_ && done_ > 0 && edits_.back().key == edit.key) {
    edits_.back().after = std::move(edit.after);
  } else {
    edits_.push_back(std::move(edit));
    ++done_;
  }
  open_ = true;
}

bool SettingEdits::set(const std::string& key, const config::Value& value) {
  const config::Value before = this->value(key);
  if (!apply(key, value)) return false;
  remember({key, before, this->value(key)});
  return true;
}

bool SettingEdits::setText(const std::string& key, const std::string& text) {
  const config::Field& field = fieldOf(key);
  finishEdit();
  bool taken = false;
  if (isNumber(field)) {
    try {
      taken = set(key, parsed(field, text));
    } catch (const std::invalid_argument& e) {
      errors_[key] = e.what();
    }
  } else {
    Settings tried = wanted_;
    try {
      applyAssignment(tried, key + "=" + text, "window");
      taken = set(key, field.get(tried));
    } catch (const std::exception& e) {
      errors_[key] = e.what();
    }
  }
  finishEdit();
  return taken;
}

bool SettingEdits::reset(const std::string& key) {
  finishEdit();
  errors_.erase(key);
  const bool changed = set(key, recordedValue(key));
  finishEdit();
  return changed;
}

bool SettingEdits::resetAll() {
  finishEdit();
  errors_.clear();
  bool any = false;
  const Settings recorded = recorded_;
  for (const config::Field& field : config::fields()) {
    const config::Value before = field.get(wanted_), after = field.get(recorded);
    if (before == after) continue;
    field.set(wanted_, after);  // together they are valid, one by one they need not be
    remember({field.key, before, after});
    finishEdit();
    any = true;
  }
  return any;
}

bool SettingEdits::undo() {
  if (!canUndo()) return false;
  finishEdit();
  const Edit& edit = edits_[--done_];
  fieldOf(edit.key).set(wanted_, edit.before);
  errors_.clear();
  return true;
}

bool SettingEdits::redo() {
  if (!canRedo()) return false;
  finishEdit();
  const Edit& edit = edits_[done_++];
  fieldOf(edit.key).set(wanted_, edit.after);
  errors_.clear();
  return true;
}

std::string SettingEdits::error(const std::string& key) const {
  const auto found = errors_.find(key);
  return found == errors_.end() ? "" : found->second;
}

std::string SettingEdits::toml() const {
  std::string text, section;
  for (const config::Field& field : config::fields()) {
    const config::Value now = field.get(wanted_), then = field.get(recorded_);
    if (now == then) continue;
    const std::size_t dot = field.key.find('.');
    if (field.key.substr(0, dot) != section) {
      section = field.key.substr(0, dot);
      text += (text.empty() ? "[" : "\n[") + section + "]\n";
    }
    text += field.key.substr(dot + 1) + " = " + config::toToml(now, field.kind) + "  # was " +
            config::toToml(then, field.kind) + "; " + field.documentation + "\n";
  }
  return text.empty() ? "# no parameter differs from the run's\n" : text;
}

void SettingEdits::load(const std::string& toml, const std::string& origin) {
  Settings tried = wanted_;
  applyToml(tried, toml, origin);
  tried.validate();
  finishEdit();
  for (const config::Field& field : config::fields()) {
    const config::Value before = field.get(wanted_), after = field.get(tried);
    if (before == after) continue;
    field.set(wanted_, after);
    remember({field.key, before, after});
    finishEdit();
  }
}

}  // namespace vantage
