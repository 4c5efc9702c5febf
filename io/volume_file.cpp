#include "io/volume_file.h"

#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkDataObject.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkLogger.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnsignedShortArray.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLImageDataWriter.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <mutex>
#include <stdexcept>

#include "io/text_file.h"

namespace vantage {
namespace {

namespace fs = std::filesystem;

/// Keeps what VTK would print.
class MessageWindow : public vtkOutputWindow {
 public:
  static MessageWindow* New();
  vtkTypeMacro(MessageWindow, vtkOutputWindow);
  void DisplayText(const char* text) override { append(text); }
  void DisplayErrorText(const char* text) override { append(text); }
  void DisplayWarningText(const char* text) override { append(text); }
  void DisplayGenericWarningText(const char* text) override { append(text); }
  void DisplayDebugText(const char*) override {}

  /// The first message on one line, without VTK's place in the source.
  std::string firstLine() const {
    std::string line = text_;
    if (const auto place = line.find("): "); place != std::string::npos) line = line.substr(place + 3);
    if (const auto end = line.find('\n'); end != std::string::npos) line = line.substr(0, end);
    return line.substr(0, 200);
  }
  bool silent() const { return text_.empty(); }

 private:
  void append(const char* text) {
    const std::lock_guard lock(mutex_);
    if (text && text_.size() < 4096) text_ += text;
  }
  std::mutex mutex_;
  std::string text_;
};
vtkStandardNewMacro(MessageWindow);

/// Turns VTK's output window into a collector while it lives. One at a time.
class QuietVtk {
 public:
  QuietVtk()
      : lock_(guard()),
        previous_(vtkOutputWindow::GetInstance()),
        verbosity_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~QuietVtk() {
    vtkLogger::SetStderrVerbosity(verbosity_);
    vtkOutputWindow::SetInstance(previous_);
  }
  QuietVtk(const QuietVtk&) = delete;
  const MessageWindow& messages() const { return *window_.Get(); }

 private:
  static std::mutex& guard() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  vtkSmartPointer<vtkOutputWindow> previous_;
  vtkLogger::Verbosity verbosity_;
  vtkNew<MessageWindow> window_;
};

/// The XML in front of the data, at most 64 KiB of it.
std::string headerText(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) throw InputError(path.string(), "is a folder; a .vti file is wanted");
  std::ifstream file(path, std::ios::binary);
  if (!file.is_open()) throw InputError(path.string(), "cannot be read; check that the file exists");
  std::string text(1 << 16, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

/// Refuses what VTK would take at its word: arrays of many components, and files of another kind.
void checkHeader(const fs::path& path) {
  const std::string text = headerText(path);
  if (text.find("<VTKFile") == std::string::npos || text.find("ImageData") == std::string::npos)
    throw InputError(path.string(),
                     "is not VTK XML image data; a TSDF is a .vti file with arrays tsdf and weight");
  constexpr std::string_view kComponents = "NumberOfComponents=\"";
  for (auto at = text.find(kComponents); at != std::string::npos; at = text.find(kComponents, at + 1)) {
    const std::string count = text.substr(at + kComponents.size(), 12);
    if (std::atoll(count.c_str()) > 16 || std::atoll(count.c_str()) < 0)
      throw InputError(path.string(), "an array with " + count.substr(0, count.find('"')) +
                                          " components; tsdf and weight have one");
  }
}

/// Where the voxels are, from the file's header.
struct Layout {
  GridGeometry geometry;
  bool cell_data = false;
};

GridGeometry geometryOf(const fs::path& path, const int extent[6], const double* origin,
                        const double* spacing, bool cells) {
  GridGeometry geometry;
  double voxels = 1.0;
  for (int a = 0; a < 3; ++a) {
    const double size = double(extent[2 * a + 1]) - extent[2 * a] + (cells ? 0 : 1);
    if (!(size >= 2.0 && size <= 1 << 20))
      throw InputError(path.string(), std::to_string(static_cast<long long>(size)) +
                                          " voxels along an axis; allowed: 2 .. 1048576");
    if (!std::isfinite(origin[a]) || !(std::abs(spacing[a] - spacing[0]) <= 1e-6 * spacing[0]))
      throw InputError(path.string(), "voxels are not cubes: spacing " + std::to_string(spacing[0]) + " " +
                                          std::to_string(spacing[1]) + " " + std::to_string(spacing[2]));
    geometry.size[a] = static_cast<int>(size);
    geometry.origin_m[a] = origin[a] + spacing[a] * (extent[2 * a] + (cells ? 0.5 : 0.0));
    voxels *= size;
  }
  // Deflate shrinks by 1032 at best, and a voxel has at least five bytes.
  std::error_code error;
  const double most = 210.0 * static_cast<double>(fs::file_size(path, error)) + 1e5;
  if (voxels > std::min(most, 2e9))
    throw InputError(path.string(), "announces " + std::to_string(static_cast<long long>(voxels)) +
                                        " voxels, more than the file can hold");
  geometry.voxel_size_m = spacing[0];
  if (!(geometry.voxel_size_m > 0.0 && geometry.voxel_size_m < 1e6))
    throw InputError(path.string(), "the spacing is " + std::to_string(spacing[0]) +
                                        "; a positive voxel size in metres is wanted");
  return geometry;
}

Layout layoutOf(const fs::path& path, vtkXMLImageDataReader* reader) {
  const auto has = [](vtkDataArraySelection* arrays, const char* name) {
    return arrays->ArrayExists(name) != 0;
  };
  vtkDataArraySelection* points = reader->GetPointDataArraySelection();
  vtkDataArraySelection* cells = reader->GetCellDataArraySelection();
  Layout layout;
  layout.cell_data = !has(points, "tsdf") && has(cells, "tsdf");
  vtkDataArraySelection* arrays = layout.cell_data ? cells : points;
  for (const char* name : {"tsdf", "weight"})
    if (!has(arrays, name))
      throw InputError(path.string(), "has no array '" + std::string(name) +
                                          "'; a TSDF has tsdf and weight, both of points or both of cells");
  vtkInformation* info = reader->GetOutputInformation(0);
  if (!info->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()) || !info->Has(vtkDataObject::ORIGIN()) ||
      !info->Has(vtkDataObject::SPACING()))
    throw InputError(path.string(), "states no extent, origin or spacing");
  layout.geometry =
      geometryOf(path, info->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()),
                 info->Get(vtkDataObject::ORIGIN()), info->Get(vtkDataObject::SPACING()), layout.cell_data);
  // Nothing but the two arrays is read.
  points->DisableAllArrays();
  cells->DisableAllArrays();
  for (const char* name : {"tsdf", "weight"}) arrays->EnableArray(name);
  return layout;
}

vtkDataArray* arrayOf(const fs::path& path, vtkImageData* image, const Layout& layout, const char* name) {
  vtkFieldData* data =
      layout.cell_data ? static_cast<vtkFieldData*>(image->GetCellData()) : image->GetPointData();
  vtkDataArray* array = data->GetArray(name);
  if (!array || array->GetNumberOfComponents() != 1 ||
      static_cast<std::size_t>(array->GetNumberOfTuples()) != layout.geometry.count())
    throw InputError(path.string(),
                     "the array '" + std::string(name) + "' does not hold one number per voxel");
  return array;
}

/// What was put right while reading.
struct Repairs {
  std::size_t not_a_number = 0, out_of_range = 0;
};

TsdfVoxel voxelOf(double tsdf, double weight, Repairs& repairs) {
  if (!std::isfinite(tsdf) || std::isnan(weight)) {
    ++repairs.not_a_number;
    return {};
  }
  if (std::abs(tsdf) > 1.0 + 1e-6 || weight < 0.0) ++repairs.out_of_range;
  TsdfVoxel voxel;
  voxel.value = static_cast<std::int16_t>(std::lround(std::clamp(tsdf, -1.0, 1.0) * TsdfVoxel::kScale));
  if (tsdf > 0.0 && voxel.value == 0) voxel.value = 1;  // stays empty
  if (weight > 0.0) voxel.weight = static_cast<std::uint16_t>(std::clamp(std::round(weight), 1.0, 65535.0));
  return voxel;
}

TsdfVolume toVolume(const fs::path& path, vtkImageData* image, const Layout& layout,
                    std::vector<std::string>& warnings) {
  vtkDataArray* tsdf = arrayOf(path, image, layout, "tsdf");
  vtkDataArray* weight = arrayOf(path, image, layout, "weight");
  TsdfVolume volume(layout.geometry);
  const std::span<TsdfVoxel> voxels = volume.voxels();
  Repairs repairs;
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const auto tuple = static_cast<vtkIdType>(i);
    voxels[i] = voxelOf(tsdf->GetComponent(tuple, 0), weight->GetComponent(tuple, 0), repairs);
  }
  if (repairs.not_a_number > 0)
    warnings.push_back(path.string() + ": " + std::to_string(repairs.not_a_number) +
                       " voxels are not a number and count as unknown");
  if (repairs.out_of_range > 0)
    warnings.push_back(path.string() + ": " + std::to_string(repairs.out_of_range) +
                       " voxels lie beyond [-1, 1] or have a negative weight; cut off");
  return volume;
}

TsdfVolume read(const fs::path& path, const MessageWindow& messages, std::vector<std::string>& warnings) {
  const auto requireSilence = [&] {
    if (!messages.silent()) throw InputError(path.string(), "damaged: " + messages.firstLine());
  };
  vtkNew<vtkXMLImageDataReader> reader;
  reader->SetFileName(path.c_str());
  reader->UpdateInformation();
  requireSilence();
  const Layout layout = layoutOf(path, reader);
  reader->Update();
  requireSilence();
  vtkImageData* image = reader->GetOutput();
  if (!image->GetDirectionMatrix()->IsIdentity())
    throw InputError(path.string(), "has turned axes (Direction); resample it along x, y, z");
  return toVolume(path, image, layout, warnings);
}

}  // namespace

TsdfVolume readVolume(const fs::path& path, std::vector<std::string>& warnings) {
  checkHeader(path);
  const QuietVtk quiet;
  try {
    return read(path, quiet.messages(), warnings);
  } catch (const std::bad_alloc&) {
    throw InputError(path.string(), "damaged, or too large for this machine's memory");
  } catch (const std::length_error&) {
    throw InputError(path.string(), "damaged: an impossible length");
  }
}

void writeVolume(const fs::path& path, const TsdfVolume& volume) {
  requireCreatable(path);
  const GridGeometry& geometry = volume.geometry();
  if (volume.voxels().empty()) throw std::invalid_argument("writeVolume: the volume is empty");
  vtkNew<vtkImageData> image;
  image->SetDimensions(geometry.size.x(), geometry.size.y(), geometry.size.z());
  image->SetOrigin(geometry.origin_m.x(), geometry.origin_m.y(), geometry.origin_m.z());
  image->SetSpacing(geometry.voxel_size_m, geometry.voxel_size_m, geometry.voxel_size_m);
  vtkNew<vtkFloatArray> tsdf;
  vtkNew<vtkUnsignedShortArray> weight;
  tsdf->SetName("tsdf");
  weight->SetName("weight");
  tsdf->SetNumberOfValues(static_cast<vtkIdType>(geometry.count()));
  weight->SetNumberOfValues(static_cast<vtkIdType>(geometry.count()));
  for (std::size_t i = 0; i < geometry.count(); ++i) {
    tsdf->SetValue(static_cast<vtkIdType>(i), volume.voxels()[i].distance());
    weight->SetValue(static_cast<vtkIdType>(i), volume.voxels()[i].weight);
  }
  image->GetPointData()->SetScalars(tsdf);
  image->GetPointData()->AddArray(weight);

  const QuietVtk quiet;
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetFileName(path.c_str());
  writer->SetInputData(image);
  writer->SetDataModeToAppended();
  writer->EncodeAppendedDataOff();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressorTypeToZLib();
  writer->SetCompressionLevel(1);
  if (writer->Write() == 1 && quiet.messages().silent()) return;
  std::error_code error;
  if (fs::is_regular_file(path, error)) fs::remove(path, error);  // no half file
  throw std::runtime_error(path.string() + ": cannot be written in full; check the free space");
}

}  // namespace vantage
