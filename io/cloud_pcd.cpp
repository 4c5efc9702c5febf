#include "io/cloud_pcd.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>

#include "io/error.h"
#include "io/mesh_text.h"

namespace vantage {
namespace {

static_assert(std::endian::native == std::endian::little, "PCD data are little-endian");

struct Field {
  std::string name;
  std::size_t size = 4, count = 1;
  char type = 'F';
  std::size_t offset = 0;  ///< in a record, bytes
  std::size_t column = 0;  ///< in an ASCII row
};

struct Header {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  bool has_points = false;
  Eigen::Vector3f sensor_origin = Eigen::Vector3f::Zero();
  std::string data;
  std::size_t record = 0;   ///< bytes of a point
  std::size_t columns = 0;  ///< words of an ASCII row
};

void readFieldLine(mesh_text::Cursor& cursor, std::string_view key, Header& header) {
  for (Field& field : header.fields) {
    if (key == "TYPE") {
      const std::string_view type = cursor.word();
      if (type != "F" && type != "U" && type != "I") cursor.fail("a TYPE is none of F, U, I");
      field.type = type[0];
      continue;
    }
    const auto value = cursor.number<std::uint32_t>(key);
    const bool allowed =
        key == "COUNT" ? value >= 1 && value <= 4096 : value == 1 || value == 2 || value == 4 || value == 8;
    if (!allowed) cursor.fail(std::string(key) + " " + std::to_string(value) + " is not usable");
    (key == "COUNT" ? field.count : field.size) = value;
  }
}

void readHeaderLine(mesh_text::Cursor& cursor, std::string_view key, Header& header) {
  if (key == "FIELDS" || key == "COLUMNS") {
    for (std::string_view name = cursor.word(); !name.empty(); name = cursor.word())
      header.fields.push_back({std::string(name)});
    if (header.fields.size() > 256) cursor.fail("more than 256 fields");
  } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
    readFieldLine(cursor, key, header);
  } else if (key == "POINTS") {
    header.points = cursor.number<std::uint64_t>("POINTS");
    header.has_points = true;
  } else if (key == "WIDTH" || key == "HEIGHT") {
    const auto value = cursor.number<std::uint32_t>(key);
    if (!header.has_points) header.points = key == "WIDTH" ? value : header.points * value;
  } else if (key == "VIEWPOINT") {
    for (int a = 0; a < 3; ++a) header.sensor_origin[a] = cursor.coordinate();
  } else if (key == "DATA") {
    header.data = cursor.word();
  } else if (key != "VERSION") {
    cursor.fail("is no PCD header line: '" + std::string(key.substr(0, 40)) + "'");
  }
}

Header readHeader(mesh_text::Cursor& cursor) {
  Header header;
  while (header.data.empty()) {
    if (!cursor.nextLine()) cursor.fail("is not a PCD file: the header has no DATA line");
    const std::string_view key = cursor.word();
    if (!key.empty() && key[0] != '#') readHeaderLine(cursor, key, header);
  }
  for (Field& field : header.fields) {
    field.offset = header.record;
    field.column = header.columns;
    header.record += field.size * field.count;
    header.columns += field.count;
  }
  if (header.record == 0) cursor.fail("the header has no FIELDS");
  return header;
}

const Field* floatField(const Header& header, std::string_view name, const std::string& path) {
  for (const Field& field : header.fields) {
    if (field.name != name) continue;
    if (field.type != 'F' || field.size < 4 || field.count != 1)
      throw InputError(path, "the field " + field.name + " is not one float");
    return &field;
  }
  return nullptr;
}

/// x, y, z or the normal.
using Triple = std::array<const Field*, 3>;

std::optional<Triple> triple(const Header& header, const std::array<std::string_view, 3>& names,
                             const std::string& path) {
  Triple fields;
  for (int a = 0; a < 3; ++a) {
    fields[a] = floatField(header, names[a], path);
    if (!fields[a]) return std::nullopt;
  }
  return fields;
}

float floatAt(const char* bytes, std::size_t size) {
  if (size == 8) {
    double value;
    std::memcpy(&value, bytes, 8);
    return static_cast<float>(value);
  }
  float value;
  std::memcpy(&value, bytes, 4);
  return value;
}

/// LZF (Marc Lehmann): literal runs and back references. Empty if the data do not fill `size` bytes exactly.
std::vector<char> expandLzf(std::string_view in, std::size_t size) {
  std::vector<char> out;
  out.reserve(size);
  std::size_t at = 0;
  while (at < in.size()) {
    const auto control = static_cast<unsigned char>(in[at++]);
    if (control < 32) {
      const std::size_t length = control + 1u;
      if (at + length > in.size() || out.size() + length > size) return {};
      out.insert(out.end(), in.begin() + static_cast<std::ptrdiff_t>(at),
                 in.begin() + static_cast<std::ptrdiff_t>(at + length));
      at += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (at >= in.size()) return {};
      length += static_cast<unsigned char>(in[at++]);
    }
    if (at >= in.size()) return {};
    const std::size_t back = ((control & 31u) << 8 | static_cast<unsigned char>(in[at++])) + 1u;
    length += 2;
    if (back > out.size() || out.size() + length > size) return {};
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - back]);
  }
  return out.size() == size ? out : std::vector<char>();
}

/// Where point i's field lies in `data`.
using Place = std::size_t (*)(const Header&, const Field&, std::uint64_t point);

std::vector<Eigen::Vector3f> gather(const Header& header, const Triple& fields, const char* data,
                                    Place place) {
  std::vector<Eigen::Vector3f> result(header.points);
  for (std::uint64_t i = 0; i < header.points; ++i)
    for (int a = 0; a < 3; ++a) result[i][a] = floatAt(data + place(header, *fields[a], i), fields[a]->size);
  return result;
}

std::vector<char> decompressed(const Header& header, std::string_view rest, const std::string& path) {
  std::uint32_t sizes[2] = {};
  if (rest.size() >= 8) std::memcpy(sizes, rest.data(), 8);
  if (rest.size() < 8 || sizes[0] > rest.size() - 8) throw InputError(path, "the file ends too early");
  if (sizes[1] != header.points * header.record || sizes[1] / 100 > sizes[0])
    throw InputError(path, "damaged: the compressed data do not hold the " + std::to_string(header.points) +
                               " points announced");
  std::vector<char> data = expandLzf(rest.substr(8, sizes[0]), sizes[1]);
  if (data.empty() && sizes[1] > 0) throw InputError(path, "damaged: the compressed data cannot be expanded");
  return data;
}

float asciiNumber(std::string_view word, const mesh_text::Cursor& cursor) {
  if (word.starts_with('+')) word.remove_prefix(1);
  float value = 0.0f;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (word.empty() || error != std::errc() || end != word.data() + word.size())
    cursor.fail(std::string(word.substr(0, 40)).append(" is no number"));
  return value;
}

void readAscii(mesh_text::Cursor& cursor, const Header& header, const Triple& xyz,
               const std::optional<Triple>& normal, PcdPoints& result) {
  std::vector<std::string_view> words(header.columns);
  for (std::uint64_t i = 0; i < header.points; ++i) {
    if (!cursor.nextLine())
      cursor.fail("the file ends after " + std::to_string(i) + " of " + std::to_string(header.points) +
                  " points");
    for (std::string_view& word : words) word = cursor.word();
    const auto read = [&](const Triple& fields) {
      return Eigen::Vector3f(asciiNumber(words[fields[0]->column], cursor),
                             asciiNumber(words[fields[1]->column], cursor),
                             asciiNumber(words[fields[2]->column], cursor));
    };
    result.points.push_back(read(xyz));
    if (normal) result.normals.push_back(read(*normal));
  }
}

}  // namespace

PcdPoints parsePcd(std::string_view bytes, const std::string& path) {
  mesh_text::Cursor cursor(bytes, path);
  const Header header = readHeader(cursor);
  const auto xyz = triple(header, {"x", "y", "z"}, path);
  const auto normal = triple(header, {"normal_x", "normal_y", "normal_z"}, path);
  if (!xyz) throw InputError(path, "has no fields x, y, z");
  if (header.points > bytes.size() * 100)
    throw InputError(path, "announces " + std::to_string(header.points) + " points, more than it can hold");
  PcdPoints result;
  result.sensor_origin = header.sensor_origin;
  if (header.data == "ascii") {
    readAscii(cursor, header, *xyz, normal, result);
    return result;
  }
  if (header.data != "binary" && header.data != "binary_compressed")
    throw InputError(
        path, "DATA is '" + header.data.substr(0, 40) + "'; allowed: ascii | binary | binary_compressed");
  const bool compressed = header.data == "binary_compressed";
  const std::vector<char> expanded =
      compressed ? decompressed(header, cursor.rest(), path) : std::vector<char>();
  if (!compressed && header.points * header.record > cursor.rest().size())
    throw InputError(path, "the file ends too early");
  const char* data = compressed ? expanded.data() : cursor.rest().data();
  const Place by_field = [](const Header& h, const Field& f, std::uint64_t i) {
    return f.offset * h.points + i * f.size;
  };
  const Place by_point = [](const Header& h, const Field& f, std::uint64_t i) {
    return i * h.record + f.offset;
  };
  result.points = gather(header, *xyz, data, compressed ? by_field : by_point);
  if (normal) result.normals = gather(header, *normal, data, compressed ? by_field : by_point);
  return result;
}

}  // namespace vantage
