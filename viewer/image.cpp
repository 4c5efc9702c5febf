#include "viewer/image.h"

#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkUnsignedCharArray.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "viewer/vtk_messages.h"

namespace vantage {
namespace {

vtkSmartPointer<vtkImageData> toVtk(const RgbImage& image) {
  auto data = vtkSmartPointer<vtkImageData>::New();
  data->SetDimensions(image.width, image.height, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const std::size_t row = static_cast<std::size_t>(image.width) * 3;
  auto* out = static_cast<std::uint8_t*>(data->GetScalarPointer());
  for (int y = 0; y < image.height; ++y) {
    std::memcpy(out + row * (image.height - 1 - y), image.pixels.data() + row * y, row);
  }
  return data;
}

[[noreturn]] void refuse(const std::filesystem::path& path, int reason) {
  throw std::runtime_error(path.string() + ": the picture could not be written (" +
                           std::generic_category().message(reason) +
                           "); check the folder, its permissions and the free space");
}

}  // namespace

std::string pngBytes(const RgbImage& image) {
  if (image.empty()) throw std::invalid_argument("there is no picture to write");
  silenceVtk();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(toVtk(image));
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* bytes = writer->GetResult();
  if (!bytes || bytes->GetNumberOfValues() == 0) throw std::runtime_error("PNG compression failed");
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)),
          static_cast<std::size_t>(bytes->GetNumberOfValues())};
}

void writePng(const RgbImage& image, const std::filesystem::path& path) {
  if (image.empty()) throw std::invalid_argument(path.string() + ": there is no picture to write");
  std::error_code error;
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (error) refuse(path, error.value());
  // VTK compresses, we write: its own writer doesn't say why a file could not be written.
  const std::string bytes = pngBytes(image);

  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) refuse(path, errno);
  const bool written =
      std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size() && std::fflush(file) == 0;
  int reason = written ? 0 : errno;
  if (std::fclose(file) != 0 && reason == 0) reason = errno;
  if (reason != 0) {
    if (std::filesystem::is_regular_file(path, error)) std::filesystem::remove(path, error);
    refuse(path, reason);
  }
}

}  // namespace vantage
