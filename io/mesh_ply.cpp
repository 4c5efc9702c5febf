#include "io/mesh_ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <vector>

#include "io/error.h"
#include "io/mesh_text.h"

namespace vantage {
namespace {

enum class Type { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
enum class Format { Ascii, LittleEndian, BigEndian };

struct Property {
  std::string name;
  Type type = Type::Float32;
  bool list = false;
  Type count_type = Type::Uint8;
};
struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

std::optional<Type> typeOf(std::string_view name) {
  constexpr std::array<std::string_view, 8> names = {"char", "uchar", "short", "ushort",
                                                     "int",  "uint",  "float", "double"};
  constexpr std::array<std::string_view, 8> sized = {"int8",  "uint8",  "int16",   "uint16",
                                                     "int32", "uint32", "float32", "float64"};
  for (std::size_t i = 0; i < names.size(); ++i)
    if (name == names[i] || name == sized[i]) return static_cast<Type>(i);
  return std::nullopt;
}

std::size_t sizeOf(Type type) {
  constexpr std::array<std::size_t, 8> sizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

struct Header {
  Format format = Format::Ascii;
  std::vector<Element> elements;
};

void readProperty(mesh_text::Cursor& cursor, Header& header) {
  if (header.elements.empty()) cursor.fail("a property stands before any element");
  Property property;
  std::string_view word = cursor.word();
  const auto type = [&](std::string_view name) {
    const std::optional<Type> found = typeOf(name);
    if (!found) cursor.fail("unknown type '" + std::string(name.substr(0, 40)) + "'");
    return *found;
  };
  if (word == "list") {
    property.list = true;
    property.count_type = type(cursor.word());
    word = cursor.word();
  }
  property.type = type(word);
  property.name = cursor.word();
  header.elements.back().properties.push_back(property);
}

Header readHeader(mesh_text::Cursor& cursor) {
  Header header;
  bool format = false;
  if (!cursor.nextLine() || cursor.word() != "ply") cursor.fail("is no PLY file");
  while (cursor.nextLine()) {
    const std::string_view word = cursor.word();
    if (word == "end_header") {
      if (!format) cursor.fail("the header names no format");
      return header;
    }
    if (word == "format") {
      const std::string_view name = cursor.word();
      format = true;
      if (name == "ascii")
        header.format = Format::Ascii;
      else if (name == "binary_little_endian")
        header.format = Format::LittleEndian;
      else if (name == "binary_big_endian")
        header.format = Format::BigEndian;
      else
        cursor.fail("unknown format '" + std::string(name.substr(0, 40)) + "'");
    } else if (word == "element") {
      Element element;
      element.name = cursor.word();
      element.count = cursor.number<std::uint64_t>("element count");
      header.elements.push_back(element);
    } else if (word == "property") {
      readProperty(cursor, header);
    } else if (!word.empty() && word != "comment" && word != "obj_info") {
      cursor.fail("unknown header line '" + std::string(word.substr(0, 40)) + "'");
    }
  }
  cursor.fail("the header has no end");
}

/// Serves the values of the body one after the other.
class Body {
 public:
  Body(mesh_text::Cursor cursor, Format format, const std::string& path)
      : cursor_(std::move(cursor)), bytes_(cursor_.rest()), format_(format), path_(path) {}

  void beginItem() {
    if (format_ == Format::Ascii && !cursor_.nextLine()) cursor_.fail("the file ends too early");
  }
  double value(Type type) {
    if (format_ == Format::Ascii) return cursor_.number<double>("value");
    const std::size_t size = sizeOf(type);
    if (bytes_.size() < size) throw InputError(path_, "the file ends too early");
    std::array<char, 8> raw = {};
    std::copy_n(bytes_.data(), size, raw.begin());
    bytes_.remove_prefix(size);
    if ((format_ == Format::BigEndian) != (std::endian::native == std::endian::big))
      std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    switch (type) {
      case Type::Int8:
        return as<std::int8_t>(raw);
      case Type::Uint8:
        return as<std::uint8_t>(raw);
      case Type::Int16:
        return as<std::int16_t>(raw);
      case Type::Uint16:
        return as<std::uint16_t>(raw);
      case Type::Int32:
        return as<std::int32_t>(raw);
      case Type::Uint32:
        return as<std::uint32_t>(raw);
      case Type::Float32:
        return static_cast<double>(as<float>(raw));
      case Type::Float64:
        return as<double>(raw);
    }
    return 0.0;
  }
  [[noreturn]] void fail(const std::string& message) const {
    if (format_ == Format::Ascii) cursor_.fail(message);
    throw InputError(path_, message);
  }
  /// Values of a list; its length is checked against what the file can hold.
  void list(const Property& property, std::vector<double>& values) {
    const double count = value(property.count_type);
    const double most =
        static_cast<double>(format_ == Format::Ascii ? cursor_.rest().size() + 100000 : bytes_.size());
    if (!(count >= 0 && count <= most)) fail("a list has an impossible length");
    values.clear();
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i)
      values.push_back(value(property.type));
  }

 private:
  template <class T>
  static T as(const std::array<char, 8>& raw) {
    T result;
    std::memcpy(&result, raw.data(), sizeof(T));
    return result;
  }

  mesh_text::Cursor cursor_;
  std::string_view bytes_;
  Format format_;
  std::string path_;
};

/// Number of the normal's component, -1 for other properties.
int normalAxis(std::string_view name) {
  constexpr std::array<std::string_view, 6> names = {"nx", "ny", "nz", "normal_x", "normal_y", "normal_z"};
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>((found - names.begin()) % 3);
}

void addVertex(const Element& element, Body& body, TriangleMesh& mesh, std::vector<double>& scratch,
               std::vector<Eigen::Vector3f>* normals) {
  Eigen::Vector3f vertex = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  Eigen::Vector3f normal = vertex;
  bool has_normal = false;
  for (const Property& property : element.properties) {
    if (property.list) {
      body.list(property, scratch);
      continue;
    }
    const double value = body.value(property.type);
    if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z')
      vertex[property.name[0] - 'x'] = static_cast<float>(value);
    if (const int axis = normalAxis(property.name); axis >= 0) {
      normal[axis] = static_cast<float>(value);
      has_normal = true;
    }
  }
  if (!vertex.allFinite()) body.fail("a vertex has a missing coordinate or one that is not finite");
  mesh.vertices.push_back(vertex);
  if (normals && has_normal) normals->push_back(normal);
}

void addFace(const Element& element, Body& body, std::uint64_t vertices, TriangleMesh& mesh,
             std::vector<double>& scratch) {
  for (const Property& property : element.properties) {
    if (!property.list) {
      body.value(property.type);
      continue;
    }
    body.list(property, scratch);
    if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
    for (const double index : scratch)
      if (!(index >= 0 && index < static_cast<double>(vertices)) || index != std::floor(index))
        body.fail("a face names a vertex that does not exist");
    for (std::size_t i = 2; i < scratch.size(); ++i)
      mesh.triangles.push_back({static_cast<std::uint32_t>(scratch[0]),
                                static_cast<std::uint32_t>(scratch[i - 1]),
                                static_cast<std::uint32_t>(scratch[i])});
  }
}

}  // namespace

TriangleMesh parsePly(std::string_view bytes, const std::string& path,
                      std::vector<Eigen::Vector3f>* normals) {
  mesh_text::Cursor cursor(bytes, path);
  const Header header = readHeader(cursor);
  std::uint64_t vertices = 0;
  for (const Element& element : header.elements) {
    // Every item takes at least one byte.
    if (element.count > bytes.size())
      throw InputError(path, "announces " + std::to_string(element.count) + " items of '" + element.name +
                                 "', more than it can hold");
    if (element.properties.empty() && element.count > 0)
      throw InputError(path, "element '" + element.name + "' has no properties");
    if (element.name == "vertex") vertices = element.count;
  }
  Body body(cursor, header.format, path);
  TriangleMesh mesh;
  std::vector<double> scratch;
  for (const Element& element : header.elements)
    for (std::uint64_t i = 0; i < element.count; ++i) {
      body.beginItem();
      if (element.name == "vertex")
        addVertex(element, body, mesh, scratch, normals);
      else
        addFace(element, body, element.name == "face" ? vertices : 0, mesh, scratch);
    }
  return mesh;
}

}  // namespace vantage
