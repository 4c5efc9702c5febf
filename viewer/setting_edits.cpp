#include "viewer/setting_edits.h"

#include <exception>
#include <optional>
#include <stdexcept>

#include "core/geometry/check.h"
#include "viewer/parameter_text.h"
#include "viewer/parameters.h"

namespace vantage {
namespace {

const config::Field& fieldOf(const std::string& key) {
  const config::Field* field = config::find(key);
  if (!field) throw std::logic_error("no setting '" + key + "'");
  return *field;
}

/// Typed as numbers; others are typed as TOML values.
bool holdsNumbers(const config::Field& field) {
  using config::Kind;
  return field.kind == Kind::Number || field.kind == Kind::Integer || field.kind == Kind::Numbers ||
         field.kind == Kind::Integers;
}

/// The range behind an error of Settings::validate(), if it is about one.
std::optional<OutOfRange> rangeBehind(const std::exception& error) {
  try {
    std::rethrow_if_nested(error);
  } catch (const OutOfRange& refused) {
    return refused;
  } catch (const std::exception&) {
  }
  return std::nullopt;
}

}  // namespace

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
    const auto range = rangeBehind(e);
    errors_[key] = range ? refusalText(key, *range) : e.what();
    return false;
  }
  wanted_ = std::move(tried);
  errors_.erase(key);
  return true;
}

void SettingEdits::remember(Change change) {
  edits_.resize(done_);
  if (open_ && done_ > 0 && edits_.back().front().key == change.key) {
    edits_.back().front().after = std::move(change.after);
  } else {
    edits_.push_back({std::move(change)});
    ++done_;
  }
  open_ = true;
}

bool SettingEdits::changeTo(const Settings& settings) {
  finishEdit();
  Edit edit;
  for (const config::Field& field : config::fields()) {
    const config::Value before = field.get(wanted_), after = field.get(settings);
    if (before != after) edit.push_back({field.key, before, after});
  }
  if (edit.empty()) return false;
  for (const Change& change : edit) fieldOf(change.key).set(wanted_, change.after);
  edits_.resize(done_);
  edits_.push_back(std::move(edit));
  ++done_;
  return true;
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
  if (holdsNumbers(field)) {
    try {
      taken = set(key, typedValue(field, text));
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
  errors_.clear();
  return changeTo(recorded_);
}

bool SettingEdits::undo() {
  if (!canUndo()) return false;
  finishEdit();
  for (const Change& change : edits_[--done_]) fieldOf(change.key).set(wanted_, change.before);
  errors_.clear();
  return true;
}

bool SettingEdits::redo() {
  if (!canRedo()) return false;
  finishEdit();
  for (const Change& change : edits_[done_++]) fieldOf(change.key).set(wanted_, change.after);
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

std::string SettingEdits::summary() const {
  std::string text;
  for (const config::Field& field : config::fields())
    if (changed(field.key))
      text += (text.empty() ? "" : ", ") + field.key + " = " + config::toToml(value(field.key), field.kind);
  return text;
}

std::vector<std::string> SettingEdits::load(const std::string& toml, const std::string& origin,
                                            PlannerKind planner) {
  Settings set = wanted_, tried = wanted_;
  applyToml(set, toml, origin);
  std::vector<std::string> others;
  for (const config::Field& field : config::fields()) {
    const config::Value value = field.get(set);
    if (value == field.get(wanted_)) continue;
    if (isParameterOf(planner, field.key))
      field.set(tried, value);
    else
      others.push_back(field.key);
  }
  tried.validate();
  changeTo(tried);
  return others;
}

}  // namespace vantage
