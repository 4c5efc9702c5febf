#include "io/config_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "io/config_fields.h"
#include "io/suggest.h"
#include "io/text_file.h"

namespace vantage {
namespace {

constexpr std::uintmax_t kLargestFile = 16u << 20;

std::string at(const std::string& origin, const toml::source_region& region) {
  return region.begin ? origin + ":" + std::to_string(region.begin.line) : origin;
}

toml::table parse(std::string_view text, const std::string& origin) {
  try {
    return toml::parse(text, origin);
  } catch (const toml::parse_error& error) {
    throw InputError(at(origin, error.source()), std::string(error.description()));
  }
}

[[noreturn]] void refuseKey(const std::string& where, const std::string& key) {
  std::vector<std::string> known;
  for (const config::Field& field : config::fields()) known.push_back(field.key);
  const std::string suggestion = nearest(key, known);
  throw InputError(where, "unknown key '" + key + "'; " +
                              (suggestion.empty() ? "`vantage config` lists all keys"
                                                  : "did you mean '" + suggestion + "'?"));
}

bool isSection(const std::string& path) {
  return std::any_of(config::fields().begin(), config::fields().end(),
                     [&](const config::Field& field) { return field.key.starts_with(path + "."); });
}

std::vector<double> numbersOf(const toml::array& array, const std::string& where, const std::string& key) {
  std::vector<double> numbers;
  for (const toml::node& entry : array) {
    const auto number = entry.is_number() ? entry.value<double>() : std::nullopt;
    if (!number)
      throw InputError(where, key + " holds something that is not a number; an array of numbers is wanted");
    numbers.push_back(*number);
  }
  return numbers;
}

config::Value valueOf(const toml::node& node, const std::string& where, const config::Field& field) {
  if (node.is_boolean()) return *node.value<bool>();
  if (node.is_integer()) return *node.value<std::int64_t>();
  if (node.is_floating_point()) return *node.value<double>();
  if (node.is_string()) return *node.value<std::string>();
  if (node.is_array()) return numbersOf(*node.as_array(), where, field.key);
  throw InputError(where, field.key + " is a table or a date; allowed: " + field.allowed());
}

void assign(Settings& settings, const config::Field& field, const toml::node& node, const std::string& where,
            const std::string& origin) {
  try {
    field.set(settings, config::checked(field, valueOf(node, where, field)));
  } catch (const std::invalid_argument& error) {
    throw InputError(where, error.what());
  }
  settings.origins[field.key] = origin;
}

/// Walks a table; `prefix` is empty or ends with a dot, `label` goes before the line in messages.
void applyTable(Settings& settings, const toml::table& table, const std::string& prefix,
                const std::string& label, const std::string& origin, std::span<const std::string> ignored) {
  for (const auto& [key, node] : table) {
    const std::string path = prefix + std::string(key.str());
    if (prefix.empty() && std::find(ignored.begin(), ignored.end(), path) != ignored.end()) continue;
    const std::string where = at(label, key.source());
    if (const config::Field* field = config::find(path)) {
      assign(settings, *field, node, where, origin);
    } else if (!isSection(path)) {
      refuseKey(where, path);
    } else if (!node.is_table()) {
      throw InputError(where, path + " is a section, not a value; write [" + path + "] and its keys below");
    } else {
      applyTable(settings, *node.as_table(), path + ".", label, origin, {});
    }
  }
}

/// The right side of key=value as a TOML node: `v = TEXT`, and words without quotes as strings.
toml::table parseValue(const config::Field& field, const std::string& text, const std::string& origin) {
  const bool bare_word = (field.kind == config::Kind::Choice || field.kind == config::Kind::Names) &&
                         !text.starts_with('"') && !text.starts_with('\'');
  if (bare_word) return toml::table{{"v", text}};
  try {
    toml::table table = toml::parse("v = " + text);
    if (table.size() == 1) return table;
  } catch (const toml::parse_error&) {
  }
  throw InputError(origin, field.key + " = " + text + " is no TOML value; allowed: " + field.allowed());
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

/// For a comment: one line whatever the origin holds.
std::string oneLine(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

}  // namespace

std::string Settings::planner() const {
  return plannersToText(exploration.planners);
}

std::string Settings::origin(std::string_view key) const {
  if (!config::find(key)) refuseKey("configuration", std::string(key));
  const auto found = origins.find(key);
  return found == origins.end() ? "default" : found->second;
}

std::vector<SettingInfo> listSettings() {
  const Settings defaults;
  std::vector<SettingInfo> list;
  for (const config::Field& field : config::fields())
    list.push_back(
        {field.key, field.documentation, field.allowed(), config::toToml(field.get(defaults), field.kind)});
  return list;
}

void applyToml(Settings& settings, std::string_view text, const std::string& origin,
               std::span<const std::string> ignored) {
  Settings changed = settings;
  applyTable(changed, parse(text, origin), "", origin, origin, ignored);
  settings = std::move(changed);
}

void applyTomlFile(Settings& settings, const std::filesystem::path& path) {
  applyToml(settings, readTextFile(path, kLargestFile), path.string());
}

void applyAssignment(Settings& settings, std::string_view key_value, const std::string& origin) {
  const auto equals = key_value.find('=');
  if (equals == std::string_view::npos)
    throw InputError(origin,
                     "'" + std::string(key_value) + "' has no '='; write key=value, e.g. gain.threshold=500");
  const std::string key = trimmed(key_value.substr(0, equals));
  const config::Field* field = config::find(key);
  if (!field) refuseKey(origin, key);
  const toml::table table = parseValue(*field, oneLine(trimmed(key_value.substr(equals + 1))), origin);
  assign(settings, *field, *table.get("v"), origin, origin);
}

std::string effectiveToml(const Settings& settings) {
  std::string text, section;
  for (const config::Field& field : config::fields()) {
    const auto dot = field.key.find('.');
    if (field.key.substr(0, dot) != section) {
      section = field.key.substr(0, dot);
      text += (text.empty() ? "[" : "\n[") + section + "]\n";
    }
    text += field.key.substr(dot + 1) + " = " + config::toToml(field.get(settings), field.kind) + "  # " +
            oneLine(settings.origin(field.key)) + " | " + field.documentation + " | " + field.allowed() +
            "\n";
  }
  return text;
}

std::filesystem::path userConfigPath() {
  const char* xdg = std::getenv("XDG_CONFIG_HOME");
  if (xdg && *xdg) return std::filesystem::path(xdg) / "vantage" / "config.toml";
  const char* home = std::getenv("HOME");
  if (home && *home) return std::filesystem::path(home) / ".config" / "vantage" / "config.toml";
  return {};
}

void applyUserConfig(Settings& settings) {
  const std::filesystem::path path = userConfigPath();
  std::error_code error;
  if (!path.empty() && std::filesystem::exists(path, error)) applyTomlFile(settings, path);
}

}  // namespace vantage
