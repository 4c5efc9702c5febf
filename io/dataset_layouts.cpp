#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "io/dataset_parts.h"
#include "io/text_file.h"

namespace vantage::dataset {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFrames = 200000;
constexpr double kTimeTolerance_s = 0.02;
constexpr const char* kDepthPattern = "frame-{number}.depth.png";

/// "folder/frame-{number}.depth.png" in its parts.
struct Pattern {
  fs::path folder;
  std::string before, after;

  fs::path name(const std::string& digits) const { return folder / (before + digits + after); }
  /// The digits of a file name that fits, else empty.
  std::string digitsOf(const std::string& file) const {
    if (file.size() <= before.size() + after.size() || !file.starts_with(before) || !file.ends_with(after))
      return {};
    std::string digits = file.substr(before.size(), file.size() - before.size() - after.size());
    const bool numeric = digits.size() <= 9 && std::all_of(digits.begin(), digits.end(),
                                                           [](char c) { return c >= '0' && c <= '9'; });
    return numeric ? digits : std::string();
  }
};

Pattern makePattern(const fs::path& root, const std::string& text) {
  constexpr std::string_view kPlace = "{number}";
  const fs::path whole(text);
  const std::string file = whole.filename().string();
  const auto place = file.find(kPlace);
  if (place == std::string::npos)
    throw InputError(root.string(), "the pattern '" + text +
                                        "' has no {number} in its file name; write e.g. " +
                                        std::string(kDepthPattern));
  return {root / whole.parent_path(), file.substr(0, place), file.substr(place + kPlace.size())};
}

/// Digits by frame number.
std::map<int, std::string> listNumbers(const Pattern& pattern) {
  std::error_code error;
  fs::directory_iterator entries(pattern.folder, error);
  if (error) throw InputError(pattern.folder.string(), "the folder cannot be read");
  std::map<int, std::string> numbers;
  for (const fs::directory_entry& entry : entries) {
    const std::string digits = pattern.digitsOf(entry.path().filename().string());
    if (digits.empty()) continue;
    if (!numbers.emplace(std::stoi(digits), digits).second)
      throw InputError(entry.path().string(), "there are two frames of this number; remove one");
    if (numbers.size() > kMostFrames) throw InputError(pattern.folder.string(), "more than 200000 frames");
  }
  return numbers;
}

/// Time stamps and the rest of the words, in file order.
struct Stamped {
  double time_s;
  TextLine line;
};

std::vector<Stamped> readStamped(const fs::path& path, std::string_view text, std::size_t words) {
  std::vector<Stamped> entries;
  for (TextLine& line : splitLines(text)) {
    const auto time = parseNumber(line.words.front());
    if (!time || line.words.size() < words)
      throw InputError(atLine(path, line.number),
                       "expected a time stamp and " + std::to_string(words - 1) + " more entries");
    if (entries.size() == kMostFrames)
      throw InputError(atLine(path, line.number), "more than 200000 entries");
    entries.push_back({*time, std::move(line)});
  }
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Stamped& a, const Stamped& b) { return a.time_s < b.time_s; });
  return entries;
}

/// Nearest entry in time, or null if none is within the tolerance.
const Stamped* nearestInTime(const std::vector<Stamped>& sorted, double time_s) {
  const auto after = std::lower_bound(sorted.begin(), sorted.end(), time_s,
                                      [](const Stamped& entry, double t) { return entry.time_s < t; });
  const Stamped* best = nullptr;
  for (auto it = after == sorted.begin() ? after : after - 1; it != sorted.end() && it <= after; ++it)
    if (!best || std::abs(it->time_s - time_s) < std::abs(best->time_s - time_s)) best = &*it;
  return best && std::abs(best->time_s - time_s) <= kTimeTolerance_s ? best : nullptr;
}

/// time tx ty tz qx qy qz qw
Pose trajectoryPose(const fs::path& path, const TextLine& line) {
  double v[7];
  for (int i = 0; i < 7; ++i) {
    const auto number = parseNumber(line.words[i + 1]);
    if (!number)
      throw InputError(atLine(path, line.number),
                       "'" + std::string(line.words[i + 1]) + "' is not a finite number");
    v[i] = *number;
  }
  const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (!(std::abs(q.norm() - 1.0) <= 1e-3))
    throw InputError(atLine(path, line.number),
                     "the quaternion has length " + shortestNumber(q.norm()) + "; allowed: 1 within 0.001");
  return makePose({v[0], v[1], v[2]}, q);
}

}  // namespace

Pose readPoseFile(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error))
    throw InputError(path.string(), "the pose of this frame is missing; every depth image needs one");
  const std::string text = readTextFile(path, 1 << 16);
  const std::vector<double> v = parseNumbers(text, path, 16);
  if (v.size() != 16)
    throw InputError(path.string(), std::to_string(v.size()) + " numbers; a pose is a 4x4 matrix of 16");
  const Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(v.data());
  if (!isRigid(matrix))
    throw InputError(path.string(),
                     "the matrix is not a rigid transform; rotation orthonormal within 0.001 and last row 0 "
                     "0 0 1 are wanted");
  return makePose(matrix.topRightCorner<3, 1>(),
                  Eigen::Quaterniond(Eigen::Matrix3d(matrix.topLeftCorner<3, 3>())));
}

std::vector<DatasetFrame> listPatternFrames(const fs::path& folder, const Description& description) {
  const bool detected = description.depth_pattern.empty();
  const fs::path root = detected ? frameFolder(folder) : folder;
  if (root.empty())
    throw InputError(folder.string(),
                     "no frame-NUMBER.depth.png in it or in its frames/; is this the right folder?");
  const Pattern depth = makePattern(root, detected ? kDepthPattern : description.depth_pattern);
  const Pattern pose = description.pose_pattern.empty() ? Pattern{depth.folder, "frame-", ".pose.txt"}
                                                        : makePattern(folder, description.pose_pattern);
  const Pattern color = description.color_pattern.empty() ? Pattern{depth.folder, "frame-", ".color.png"}
                                                          : makePattern(folder, description.color_pattern);
  std::vector<DatasetFrame> frames;
  for (const auto& [number, digits] : listNumbers(depth)) {
    DatasetFrame frame{number, depth.name(digits), color.name(digits), readPoseFile(pose.name(digits))};
    std::error_code error;
    if (!fs::exists(frame.color_path, error)) frame.color_path.clear();
    frames.push_back(std::move(frame));
  }
  if (frames.empty())
    throw InputError(depth.folder.string(),
                     "no file fits " + depth.before + "NUMBER" + depth.after + "; the data set is empty");
  return frames;
}

std::vector<DatasetFrame> listTumFrames(const fs::path& folder, std::vector<std::string>& warnings) {
  const fs::path depth_list = folder / "depth.txt", pose_list = folder / "groundtruth.txt",
                 color_list = folder / "rgb.txt";
  const std::string depth_text = readTextFile(depth_list), pose_text = readTextFile(pose_list);
  std::error_code error;
  const std::string color_text = fs::exists(color_list, error) ? readTextFile(color_list) : std::string();
  const auto poses = readStamped(pose_list, pose_text, 8);
  const auto colors = readStamped(color_list, color_text, 2);
  std::vector<DatasetFrame> frames;
  std::size_t without_pose = 0;
  int number = -1;
  for (const Stamped& entry : readStamped(depth_list, depth_text, 2)) {
    ++number;
    const Stamped* pose = nearestInTime(poses, entry.time_s);
    if (!pose) {
      ++without_pose;
      continue;
    }
    DatasetFrame frame{
        number, folder / std::string(entry.line.words[1]), {}, trajectoryPose(pose_list, pose->line)};
    if (const Stamped* color = nearestInTime(colors, entry.time_s))
      frame.color_path = folder / std::string(color->line.words[1]);
    frames.push_back(std::move(frame));
  }
  if (without_pose > 0)
    warnings.push_back(depth_list.string() + ": " + std::to_string(without_pose) +
                       " frames have no pose within 0.02 s and are left out");
  if (frames.empty())
    throw InputError(depth_list.string(),
                     "no frame has a pose within 0.02 s in groundtruth.txt; the data set is empty");
  return frames;
}

fs::path frameFolder(const fs::path& folder) {
  for (const fs::path& candidate : {folder, folder / "frames"}) {
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(candidate, error)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("frame-") && name.ends_with(".depth.png")) return candidate;
    }
  }
  return {};
}

bool isTum(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "depth.txt", error) && fs::exists(folder / "groundtruth.txt", error);
}

PinholeCamera readIntrinsics(const fs::path& path) {
  const std::vector<double> v = parseNumbers(readTextFile(path, 1 << 16), path, 9);
  PinholeCamera camera;
  if (v.size() == 9) {
    const bool upper = v[1] == 0.0 && v[3] == 0.0 && v[6] == 0.0 && v[7] == 0.0 && v[8] == 1.0;
    if (!upper)
      throw InputError(path.string(), "is not a camera matrix; rows fx 0 cx, 0 fy cy, 0 0 1 are wanted");
    camera.fx = v[0], camera.cx = v[2], camera.fy = v[4], camera.cy = v[5];
  } else if (v.size() == 4) {
    camera.fx = v[0], camera.fy = v[1], camera.cx = v[2], camera.cy = v[3];
  } else {
    throw InputError(path.string(),
                     std::to_string(v.size()) + " numbers; a 3x3 matrix or fx fy cx cy is wanted");
  }
  if (!(camera.fx > 0.0 && camera.fy > 0.0))
    throw InputError(path.string(), "the focal length is " + shortestNumber(std::min(camera.fx, camera.fy)) +
                                        "; above 0 is wanted");
  return camera;
}

}  // namespace vantage::dataset
