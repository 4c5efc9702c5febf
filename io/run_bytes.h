#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "core/geometry/grid_geometry.h"
#include "core/geometry/pose.h"

namespace vantage {

// Products of a run file as bytes: little endian, sizes written out. A type's fields are listed once, in a
// function `fields(archive, value)` that calls `archive(value.a, value.b, ...)`; it serves writing and
// reading.
static_assert(std::endian::native == std::endian::little, "run files are little endian");

using Bytes = std::vector<std::uint8_t>;

/// Bytes that are not what a product must be. The reader of the run file turns it into an InputError.
class DamagedBytes : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// T or const T: lets one `fields` serve a writer's const and a reader's mutable values.
template <class T, class U>
concept Like = std::same_as<std::remove_const_t<T>, U>;

/// Number of values of an enumeration that may be stored; those beyond are refused when read.
template <class E>
inline constexpr std::int64_t kEnumCount = 0;

/// Types of a fixed packed size. Vectors of them are stored as byte planes (byte 0 of every element, then
/// byte 1, ...), which compress far better. Structs opt in beside their `fields`.
template <class T>
inline constexpr bool kFlat = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <class S, int R, int C, int O, int MR, int MC>
inline constexpr bool kFlat<Eigen::Matrix<S, R, C, O, MR, MC>> = R > 0 && C > 0;
template <>
inline constexpr bool kFlat<Pose> = true;
template <class T, std::size_t N>
inline constexpr bool kFlat<std::array<T, N>> = kFlat<T>;

/// Byte planes: `to` gets byte p of element i at p * plane + i, for `count` elements; plane >= count.
void toPlanes(const std::uint8_t* from, std::uint8_t* to, std::size_t count, std::size_t stride,
              std::size_t plane);
void fromPlanes(const std::uint8_t* from, std::uint8_t* to, std::size_t count, std::size_t stride,
                std::size_t plane);

namespace detail {
template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};
template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};
template <class T>
struct IsArray : std::false_type {};
template <class T, std::size_t N>
struct IsArray<std::array<T, N>> : std::true_type {};
template <class T>
concept EigenMatrix = requires(const T& m) {
  typename T::Scalar;
  m.data();
  requires T::RowsAtCompileTime >
  0 && T::ColsAtCompileTime > 0;
};
template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// What writing and reading share: how compound types are made of others. `Self` adds scalar(), text(),
/// optional() and vector().
template <class Self>
class Archive {
 public:
  template <class... T>
  void operator()(T&... values) {
    (item(values), ...);
  }

 private:
  Self& self() { return static_cast<Self&>(*this); }

  template <class T>
  void item(T& value) {
    using V = std::remove_const_t<T>;
    if constexpr (Scalar<V>) {
      self().scalar(value);
    } else if constexpr (std::same_as<V, std::string>) {
      self().text(value);
    } else if constexpr (IsOptional<V>::value) {
      self().optional(value);
    } else if constexpr (IsVector<V>::value) {
      self().vector(value);
    } else if constexpr (IsArray<V>::value) {
      for (auto& element : value) item(element);
    } else if constexpr (std::same_as<V, Pose>) {
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 3; ++r) item(value.matrix().coeffRef(r, c));
    } else if constexpr (std::same_as<V, Box>) {
      (*this)(value.min(), value.max());
    } else if constexpr (EigenMatrix<V>) {
      for (int i = 0; i < static_cast<int>(V::SizeAtCompileTime); ++i) item(value.data()[i]);
    } else {
      fields(self(), value);
    }
  }
};

/// Adds up packed sizes without looking at the values.
class SizeCounter : public Archive<SizeCounter> {
 public:
  std::size_t size() const { return size_; }
  template <class T>
  void scalar(const T&) {
    size_ += sizeof(T);
  }

 private:
  std::size_t size_ = 0;
};
}  // namespace detail

/// Packed size of a flat type, bytes.
template <class T>
std::size_t packedSize() {
  static_assert(kFlat<T>);
  if constexpr (detail::Scalar<T>) return sizeof(T);
  T value{};
  detail::SizeCounter counter;
  counter(value);
  return counter.size();
}

/// Appends values.
class ByteWriter : public detail::Archive<ByteWriter> {
 public:
  static constexpr bool kReading = false;
  const Bytes& bytes() const { return bytes_; }
  Bytes take() { return std::move(bytes_); }
  void reserve(std::size_t size) { bytes_.reserve(size); }

  /// Room for `size` raw bytes at the end; valid until the next call.
  std::uint8_t* append(std::size_t size) {
    bytes_.resize(bytes_.size() + size);
    return bytes_.data() + bytes_.size() - size;
  }

  template <class T>
  void scalar(const T& value) {
    std::memcpy(append(sizeof(T)), &value, sizeof(T));
  }
  void text(const std::string& value) {
    scalar(static_cast<std::uint64_t>(value.size()));
    if (!value.empty()) std::memcpy(append(value.size()), value.data(), value.size());
  }
  template <class T>
  void optional(const std::optional<T>& value) {
    scalar(value.has_value());
    if (value) (*this)(*value);
  }
  template <class T>
  void vector(const std::vector<T>& values) {
    scalar(static_cast<std::uint64_t>(values.size()));
    if constexpr (!kFlat<T>) {
      for (const T& value : values) (*this)(value);
    } else if (!values.empty()) {
      ByteWriter packed;
      packed.reserve(values.size() * packedSize<T>());
      for (const T& value : values) packed(value);
      toPlanes(packed.bytes_.data(), append(packed.bytes_.size()), values.size(), packedSize<T>(),
               values.size());
    }
  }

 private:
  Bytes bytes_;
};

/// Takes values from bytes it does not own. Every size is checked against what is there before anything is
/// allocated. \throws DamagedBytes from every call.
class ByteReader : public detail::Archive<ByteReader> {
 public:
  static constexpr bool kReading = true;
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::size_t remaining() const { return bytes_.size(); }
  void requireEnd() const {
    if (!bytes_.empty()) throw DamagedBytes("bytes left over");
  }
  std::span<const std::uint8_t> raw(std::size_t size) {
    if (size > bytes_.size()) throw DamagedBytes("data ends too early");
    const auto taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }

  template <class T>
  void scalar(T& value) {
    const auto from = raw(sizeof(T));
    if constexpr (std::same_as<T, bool>) {
      if (from[0] > 1) throw DamagedBytes("a flag is neither 0 nor 1");
      value = from[0] != 0;
    } else {
      std::memcpy(&value, from.data(), sizeof(T));
    }
    if constexpr (std::is_enum_v<T>) {
      const auto number = static_cast<std::int64_t>(value);
      if (number < 0 || number >= kEnumCount<T>) throw DamagedBytes("a value outside its enumeration");
    }
  }
  void text(std::string& value) {
    const auto from = raw(size(1));
    value.assign(reinterpret_cast<const char*>(from.data()), from.size());
  }
  template <class T>
  void optional(std::optional<T>& value) {
    bool present = false;
    scalar(present);
    value.reset();
    if (present) (*this)(value.emplace());
  }
  template <class T>
  void vector(std::vector<T>& values) {
    values.clear();
    if constexpr (!kFlat<T>) {
      const std::size_t count = size(1);
      for (std::size_t i = 0; i < count; ++i) (*this)(values.emplace_back());
    } else {
      const std::size_t stride = packedSize<T>();
      const std::size_t count = size(stride);
      if (count == 0) return;
      Bytes packed(count * stride);
      fromPlanes(raw(packed.size()).data(), packed.data(), count, stride, count);
      ByteReader elements(packed);
      values.resize(count);
      for (T& value : values) elements(value);
    }
  }

 private:
  /// An element count; each element takes at least `stride` of the bytes that are left.
  std::size_t size(std::size_t stride) {
    std::uint64_t count = 0;
    scalar(count);
    if (count > bytes_.size() / stride) throw DamagedBytes("a size beyond the end of the data");
    return static_cast<std::size_t>(count);
  }

  std::span<const std::uint8_t> bytes_;
};

}  // namespace vantage
