#include "io/depth_png.h"

#include <png.h>

#include <algorithm>
#include <cmath>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>

namespace vantage {
namespace {

constexpr int kLargestSide = 8192;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open(const std::filesystem::path& path, const char* mode) {
  return {std::fopen(path.c_str(), mode), [](std::FILE* file) { return std::fclose(file); }};
}

/// Where libpng reports to: the message is kept, nothing is printed.
struct Report {
  std::string message;
  std::jmp_buf jump;
};

void onError(png_structp png, png_const_charp message) {
  auto* report = static_cast<Report*>(png_get_error_ptr(png));
  report->message = message;
  std::longjmp(report->jump, 1);
}

void onWarning(png_structp, png_const_charp) {}

/// libpng's state; freed on every way out.
struct Reader {
  explicit Reader(Report& report)
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &report, onError, onWarning)),
        info(png ? png_create_info_struct(png) : nullptr) {
    if (!info) throw std::bad_alloc();
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  png_structp png;
  png_infop info;
};

struct Writer {
  explicit Writer(Report& report)
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &report, onError, onWarning)),
        info(png ? png_create_info_struct(png) : nullptr) {
    if (!info) throw std::bad_alloc();
  }
  ~Writer() { png_destroy_write_struct(&png, &info); }
  Writer(const Writer&) = delete;
  png_structp png;
  png_infop info;
};

// The functions with setjmp() keep no object with a destructor alive: longjmp() would skip it.

bool readHeader(Reader& reader, Report& report, std::FILE* file) {
  if (setjmp(report.jump)) return false;
  png_set_user_limits(reader.png, kLargestSide, kLargestSide);
  png_init_io(reader.png, file);
  png_read_info(reader.png, reader.info);
  return true;
}

bool readRows(Reader& reader, Report& report, std::span<const png_bytep> rows) {
  if (setjmp(report.jump)) return false;
  png_set_swap(reader.png);  // PNG is big-endian
  png_set_interlace_handling(reader.png);
  png_read_image(reader.png, const_cast<png_bytepp>(rows.data()));
  png_read_end(reader.png, nullptr);
  return true;
}

bool writeRows(Writer& writer, Report& report, std::FILE* file, ImageSize size, int bits,
               std::span<const png_bytep> rows) {
  if (setjmp(report.jump)) return false;
  png_init_io(writer.png, file);
  png_set_IHDR(writer.png, writer.info, size.width, size.height, bits, PNG_COLOR_TYPE_GRAY,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  if (bits == 16) png_set_swap(writer.png);
  png_write_image(writer.png, const_cast<png_bytepp>(rows.data()));
  png_write_end(writer.png, nullptr);
  return true;
}

std::vector<png_bytep> rowPointers(std::uint8_t* data, ImageSize size, int bytes) {
  std::vector<png_bytep> rows(size.height);
  for (int v = 0; v < size.height; ++v) rows[v] = data + static_cast<std::size_t>(v) * size.width * bytes;
  return rows;
}

void requirePng(const std::filesystem::path& path, std::FILE* file) {
  std::uint8_t signature[8] = {};
  if (std::fread(signature, 1, 8, file) != 8 || png_sig_cmp(signature, 0, 8) != 0)
    throw InputError(path.string(), "is not a PNG image; depth is read from 16-bit PNG");
  std::rewind(file);
}

/// Opens the file, reads the header and checks that it is 16-bit grey.
ImageSize begin(Reader& reader, Report& report, const std::filesystem::path& path, std::FILE* file) {
  requirePng(path, file);
  if (!readHeader(reader, report, file))
    throw InputError(path.string(), "damaged PNG image: " + report.message);
  const int bits = png_get_bit_depth(reader.png, reader.info);
  if (png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY || bits != 16)
    throw InputError(path.string(), "is not a depth image: " + std::to_string(bits) + " bit" +
                                        (png_get_channels(reader.png, reader.info) > 1 ? " colour" : "") +
                                        "; a 16-bit grey PNG is wanted");
  return {static_cast<int>(png_get_image_width(reader.png, reader.info)),
          static_cast<int>(png_get_image_height(reader.png, reader.info))};
}

File openForReading(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw InputError(path.string(), "is a folder; a PNG is wanted");
  File file = open(path, "rb");
  if (!file) throw InputError(path.string(), "cannot be read; check that the file exists");
  return file;
}

void write(const std::filesystem::path& path, ImageSize size, int bits, std::uint8_t* data) {
  Report report;
  Writer writer(report);
  File file = open(path, "wb");
  if (!file) throw InputError(path.string(), "cannot be written; check folder and permissions");
  const auto rows = rowPointers(data, size, bits / 8);
  const bool written = writeRows(writer, report, file.get(), size, bits, rows);
  if (!written || std::fflush(file.get()) != 0)
    throw InputError(path.string(),
                     "cannot be written: " + (written ? std::strerror(errno) : report.message));
}

}  // namespace

DepthImage depthOfCounts(ImageSize size, std::span<const std::uint16_t> counts,
                         const DepthPngFormat& format) {
  DepthImage depth(size.width, size.height);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const bool invalid =
        std::find(format.invalid.begin(), format.invalid.end(), counts[i]) != format.invalid.end();
    if (!invalid && counts[i] != 0) depth.depth_m[i] = static_cast<float>(counts[i] * format.unit_m);
  }
  return depth;
}

ImageSize depthPngSize(const std::filesystem::path& path) {
  Report report;
  Reader reader(report);
  const File file = openForReading(path);
  return begin(reader, report, path, file.get());
}

DepthImage readDepthPng(const std::filesystem::path& path, const DepthPngFormat& format) {
  Report report;
  Reader reader(report);
  const File file = openForReading(path);
  const ImageSize size = begin(reader, report, path, file.get());
  std::vector<std::uint16_t> counts(static_cast<std::size_t>(size.width) * size.height);
  const auto rows = rowPointers(reinterpret_cast<std::uint8_t*>(counts.data()), size, 2);
  if (!readRows(reader, report, rows))
    throw InputError(path.string(), "damaged PNG image: " + report.message);
  return depthOfCounts(size, counts, format);
}

void writeDepthPng(const std::filesystem::path& path, const DepthImage& depth) {
  std::vector<std::uint16_t> counts(depth.depth_m.size(), 0);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const float mm = depth.depth_m[i] * 1000.0f;
    if (DepthImage::valid(depth.depth_m[i]) && mm < 65534.5f)
      counts[i] = static_cast<std::uint16_t>(std::lround(mm));
  }
  write(path, {depth.width, depth.height}, 16, reinterpret_cast<std::uint8_t*>(counts.data()));
}

void writeBytePng(const std::filesystem::path& path, int width, int height,
                  const std::vector<std::uint8_t>& values) {
  if (width < 1 || height < 1 || values.size() != static_cast<std::size_t>(width) * height)
    throw std::invalid_argument("writeBytePng: the number of values is not width x height");
  std::vector<std::uint8_t> copy = values;
  write(path, {width, height}, 8, copy.data());
}

}  // namespace vantage
