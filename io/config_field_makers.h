#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "io/config_fields.h"

// How the list of fields is written: one call a field.

namespace vantage::config {

inline double radians(double degrees) {
  return degrees * std::numbers::pi / 180.0;
}

/// The degrees that radians() takes back to exactly this angle, if there are any.
inline double degrees(double angle_rad) {
  const double about = angle_rad * 180.0 / std::numbers::pi;
  const double rounded = std::round(about * 1e9) / 1e9;
  if (radians(rounded) == angle_rad) return rounded;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double up = about, down = about;
  for (int i = 0; i < 4; ++i) {
    if (radians(up) == angle_rad) return up;
    if (radians(down) == angle_rad) return down;
    up = std::nextafter(up, kInfinity);
    down = std::nextafter(down, -kInfinity);
  }
  return about;
}

inline Field base(const char* key, const char* doc, Kind kind, double low = 0.0, double high = 0.0) {
  Field field;
  field.key = key;
  field.documentation = doc;
  field.kind = kind;
  field.low = low;
  field.high = high;
  return field;
}

// `ref` is a generic lambda that leads to the value in const and in mutable settings.

template <class Ref>
Field number(const char* key, const char* doc, double low, double high, Ref ref) {
  Field field = base(key, doc, Kind::Number, low, high);
  field.get = [ref](const Settings& s) -> Value { return double{ref(s)}; };
  field.set = [ref](Settings& s, const Value& v) { ref(s) = std::get<double>(v); };
  return field;
}

template <class Ref>
Field angle(const char* key, const char* doc, double low, double high, Ref ref) {
  Field field = base(key, doc, Kind::Number, low, high);
  field.get = [ref](const Settings& s) -> Value { return degrees(ref(s)); };
  field.set = [ref](Settings& s, const Value& v) { ref(s) = radians(std::get<double>(v)); };
  return field;
}

template <class Ref>
Field integer(const char* key, const char* doc, double low, double high, Ref ref) {
  Field field = base(key, doc, Kind::Integer, low, high);
  field.get = [ref](const Settings& s) -> Value { return static_cast<std::int64_t>(ref(s)); };
  field.set = [ref](Settings& s, const Value& v) {
    auto& target = ref(s);
    target = static_cast<std::remove_reference_t<decltype(target)>>(std::get<std::int64_t>(v));
  };
  return field;
}

template <class Ref>
Field flag(const char* key, const char* doc, Ref ref) {
  Field field = base(key, doc, Kind::Boolean);
  field.get = [ref](const Settings& s) -> Value { return bool{ref(s)}; };
  field.set = [ref](Settings& s, const Value& v) { ref(s) = std::get<bool>(v); };
  return field;
}

/// Two or more words for the values of an enumeration or a flag.
template <class T, class Ref>
Field choice(const char* key, const char* doc, std::vector<std::pair<std::string, T>> words, Ref ref) {
  Field field = base(key, doc, Kind::Choice);
  for (const auto& [word, value] : words) field.choices.push_back(word);
  field.get = [ref, words](const Settings& s) -> Value {
    for (const auto& [word, value] : words)
      if (value == ref(s)) return word;
    return words.front().first;
  };
  field.set = [ref, words](Settings& s, const Value& v) {
    for (const auto& [word, value] : words)
      if (word == std::get<std::string>(v)) ref(s) = value;
  };
  return field;
}

/// A vector of three numbers or integers.
template <class Ref>
Field vector3(const char* key, const char* doc, Kind kind, double low, double high, Ref ref) {
  Field field = base(key, doc, kind, low, high);
  field.min_count = field.max_count = 3;
  field.get = [ref](const Settings& s) -> Value {
    const auto& v = ref(s);
    return std::vector<double>{double(v[0]), double(v[1]), double(v[2])};
  };
  field.set = [ref](Settings& s, const Value& value) {
    auto& v = ref(s);
    for (int i = 0; i < 3; ++i)
      v[i] = static_cast<std::remove_reference_t<decltype(v[i])>>(std::get<std::vector<double>>(value)[i]);
  };
  return field;
}

template <class Ref>
Field list(const char* key, const char* doc, double low, double high, int most, Ref ref) {
  Field field = base(key, doc, Kind::Numbers, low, high);
  field.min_count = 1;
  field.max_count = most;
  field.get = [ref](const Settings& s) -> Value { return ref(s); };
  field.set = [ref](Settings& s, const Value& v) { ref(s) = std::get<std::vector<double>>(v); };
  return field;
}

/// A rotation as unit quaternion x, y, z, w.
template <class Ref>
Field quaternion(const char* key, const char* doc, Ref ref) {
  Field field = base(key, doc, Kind::Numbers, -1.0, 1.0);
  field.min_count = field.max_count = 4;
  field.get = [ref](const Settings& s) -> Value {
    const Eigen::Quaterniond& q = ref(s);
    return std::vector<double>{q.x(), q.y(), q.z(), q.w()};
  };
  field.set = [key, ref](Settings& s, const Value& value) {
    const auto& v = std::get<std::vector<double>>(value);
    const Eigen::Quaterniond q(v[3], v[0], v[1], v[2]);
    if (!(std::abs(q.norm() - 1.0) <= 1e-3))
      throw std::invalid_argument(std::string(key) + " is a quaternion of length " +
                                  std::to_string(q.norm()) + "; allowed: 1 within 0.001");
    ref(s) = q;
  };
  return field;
}

// Parts of the list that stand in files of their own.
std::vector<Field> octreeFields();
std::vector<Field> hierarchicalFields();

}  // namespace vantage::config

/// The way to a member of Settings, const and mutable; for the files that list fields.
#define AT(member)       \
  [](auto& s) -> auto& { \
    return s.member;     \
  }
