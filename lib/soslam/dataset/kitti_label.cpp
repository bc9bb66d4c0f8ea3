// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/kitti_label.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <regex>
#include <span>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/dataset/text_file.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/image/read_image.h"

namespace soslam {
namespace {

RecordingRange ParseRange(const std::string& option, std::string_view text) {
  static const std::regex kRange("([0-9]{1,9})(?:-([0-9]{1,9}))?");
  std::cmatch match;
  if (!std::regex_match(text.begin(), text.end(), match, kRange)) {
    RefuseSetting(option, text, "the number of a recording, or two as in 0003-0005");
  }
  const int first = std::stoi(match[1]);
  const int last = match[2].matched ? std::stoi(match[2]) : first;
  if (last < first) RefuseSetting(option, text, "the lower number first");
  return {first, last};
}

}  // namespace

std::vector<RecordingRange> ParseRecordings(const std::string& option, std::string_view text) {
  std::vector<RecordingRange> ranges;
  for (const std::string_view word : SplitWords(text)) ranges.push_back(ParseRange(option, word));
  return ranges;
}

RecordingValues::RecordingValues(const std::string& option, const std::string& text)
    : option_(option) {
  const auto words = SplitWords(text);
  for (const std::string_view word : words) {
    const size_t colon = word.find(':');
    if (colon != std::string_view::npos) {
      entries_.push_back(
          {ParseRange(option, word.substr(0, colon)), std::string(word.substr(colon + 1))});
    } else if (words.size() == 1) {
      entries_.push_back({{0, std::numeric_limits<int>::max()}, std::string(word)});
    } else {
      RefuseSetting(option, word, "a recording, a colon and its value, as in 0000-0013:1");
    }
  }
}

const std::string& RecordingValues::Of(int recording) const {
  const auto found = std::ranges::find_if(
      entries_, [&](const Entry& entry) { return entry.range.Contains(recording); });
  if (found == entries_.end()) {
    throw SettingsError(fmt::format("{}: says nothing about recording {:04d}; expected a value",
                                    option_, recording));
  }
  return found->value;
}

double RecordingValues::PositiveOf(int recording) const {
  const std::string& text = Of(recording);
  const double number = ParseNumber(text).value_or(0.0);
  if (!(number > 0.0)) RefuseSetting(option_, text, "a number above 0");
  return number;
}

namespace {

namespace fs = std::filesystem;

constexpr const char* kUnlabelledType = "DontCare";

// Columns of both benchmarks, from the type on.
constexpr std::array kKittiColumns = {"type",   "truncated", "occluded", "alpha",  "left",
                                      "top",    "right",     "bottom",   "height", "width",
                                      "length", "x",         "y",        "z",      "rotation_y"};

// `words`: the kKittiColumns of one line, optionally followed by a score.
KittiLabel ParseLabel(std::span<const std::string_view> words, const std::string& place) {
  const auto real = [&](size_t i) { return ParseReal(words[i], place, kKittiColumns[i]); };
  KittiLabel label;
  label.place = place;
  label.type = words[0];
  label.truncated = real(1);
  label.occluded = ParseInteger(words[2], place, kKittiColumns[2]);
  label.box = {real(4), real(5), real(6), real(7)};
  label.size = {real(8), real(9), real(10)};
  label.bottom_centre = {real(11), real(12), real(13)};
  label.rotation_y = real(14);
  if (words.size() > kKittiColumns.size()) label.score = ParseReal(words[15], place, "score");
  if (label.type != kUnlabelledType && !(label.size.minCoeff() > 0.0)) {
    throw InputError(fmt::format("{}: size is {} {} {}; expected height, width and length above 0",
                                 place, words[8], words[9], words[10]));
  }
  return label;
}

}  // namespace

KittiCalibration ReadKittiCalibration(const fs::path& path) {
  for (const TextLine& line : ReadTextLines(path)) {
    const auto words = SplitWords(line.text);
    if (words.front() != "P2:") continue;
    const auto p = ParseMatrix34(std::span(words).subspan(1), line.place);
    const bool is_rectified = p(0, 1) == 0.0 && p(1, 0) == 0.0 &&
                              p.row(2).head<3>() == Eigen::RowVector3d(0.0, 0.0, 1.0) &&
                              p(0, 0) > 0.0 && p(1, 1) > 0.0;
    if (!is_rectified) {
      throw InputError(line.place +
                       ": P2 is not fx 0 cx tx  0 fy cy ty  0 0 1 tz; expected a rectified camera");
    }
    KittiCalibration calibration;
    calibration.camera = {0, 0, p(0, 0), p(1, 1), p(0, 2), p(1, 2)};
    calibration.camera2_from_camera0 = p.leftCols<3>().inverse() * p.col(3);
    return calibration;
  }
  throw InputError(path.string() + ": has no line P2:; expected the projection of camera 2");
}

std::vector<KittiLabel> ReadKittiLabels(const fs::path& path, bool has_tracks) {
  const size_t leading = has_tracks ? 2 : 0;
  std::vector<KittiLabel> labels;
  for (const TextLine& line : ReadTextLines(path)) {
    const auto words = SplitWords(line.text);
    const size_t columns = leading + kKittiColumns.size();
    if (words.size() != columns && words.size() != columns + 1) {
      throw InputError(fmt::format("{}: has {} values; expected {}{} [score]", line.place,
                                   words.size(), has_tracks ? "frame track " : "",
                                   fmt::join(kKittiColumns, " ")));
    }
    KittiLabel label = ParseLabel(std::span(words).subspan(leading), line.place);
    label.frame = has_tracks ? ParseInteger(words[0], line.place, "frame") : 0;
    label.track =
        has_tracks ? ParseInteger(words[1], line.place, "track") : static_cast<int>(labels.size());
    if (label.type != kUnlabelledType) labels.push_back(std::move(label));
  }
  return labels;
}

namespace {

LabelledBox ParseKittiBox(const TextLine& line, const std::string& label) {
  constexpr std::array kNames = {"frame", "x1", "y1", "x2", "y2", "score"};
  const auto fields = SplitFields(line.text);
  if (fields.size() != kNames.size()) {
    throw InputError(fmt::format("{}: has {} fields; expected {}", line.place, fields.size(),
                                 fmt::join(kNames, ",")));
  }
  const auto real = [&](size_t i) { return ParseReal(fields[i], line.place, kNames[i]); };
  const Box box{real(1), real(2), real(3), real(4)};
  if (box.Width() < 0.0 || box.Height() < 0.0) {
    throw InputError(fmt::format("{}: box is {} {} {} {}; expected x1 <= x2 and y1 <= y2",
                                 line.place, box.x_min, box.y_min, box.x_max, box.y_max));
  }
  const int frame = ParseInteger(fields[0], line.place, kNames[0]);
  if (frame < 0)
    throw InputError(fmt::format("{}: frame is {}; expected 0 or more", line.place, frame));
  return {line.place, frame, label, real(5), box};
}

}  // namespace

std::vector<LabelledBox> ReadKittiBoxes(const fs::path& path) {
  const std::string label = fs::absolute(path).parent_path().filename().string();
  return ParseTextLines(path, [&](const TextLine& line) { return ParseKittiBox(line, label); });
}

std::vector<std::optional<size_t>> MatchBoxes(const std::vector<LabelledBox>& found,
                                              const std::vector<Box>& given, double min_overlap) {
  std::vector<size_t> order(found.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order,
                           [&](size_t a, size_t b) { return found[a].score > found[b].score; });
  std::vector<std::optional<size_t>> matches(found.size());
  std::vector<bool> taken(given.size(), false);
  for (const size_t i : order) {
    double best = min_overlap;
    for (size_t k = 0; k < given.size(); ++k) {
      const double overlap = BoxOverlap(found[i].box, given[k]);
      if (taken[k] || overlap < best || (matches[i] && overlap == best)) continue;
      best = overlap;
      matches[i] = k;
    }
    if (matches[i]) taken[*matches[i]] = true;
  }
  return matches;
}

std::vector<NumberedPath> NumberedFiles(const fs::path& folder, const std::string& extension) {
  std::vector<NumberedPath> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() != extension) continue;
    const std::string place = entry.path().string();
    files.push_back({ParseInteger(entry.path().stem().string(), place, "file name"), entry.path()});
  }
  if (files.empty()) {
    throw InputError(
        fmt::format("{}: has no files; expected <number>{}", folder.string(), extension));
  }
  std::ranges::sort(files, {}, &NumberedPath::number);
  return files;
}

fs::path RequiredFile(const fs::path& path) {
  if (!IsFile(path)) throw InputError(path.string() + ": is missing");
  return path;
}

Camera WithImageSize(Camera camera, const std::optional<fs::path>& image,
                     ImageOrientation orientation, const RecordingValues& image_size,
                     int recording) {
  if (image) {
    const cv::Mat pixels = ReadImage(*image, cv::IMREAD_GRAYSCALE, orientation);
    camera.width = pixels.cols;
    camera.height = pixels.rows;
    return camera;
  }
  static const std::regex kSize("([0-9]{1,9})x([0-9]{1,9})");
  const std::string& text = image_size.Of(recording);
  std::smatch match;
  const bool is_size = std::regex_match(text, match, kSize);
  camera.width = is_size ? std::stoi(match[1]) : 0;
  camera.height = is_size ? std::stoi(match[2]) : 0;
  if (!IsImageSize(camera.width, camera.height)) {
    RefuseSetting("image_size", text, "width and height, as in 1242x375");
  }
  return camera;
}

Eigen::Quaterniond UprightRotation(const Eigen::Vector3d& front, const Eigen::Vector3d& up) {
  Eigen::Matrix3d rotation;
  rotation << front, up.cross(front), up;
  return Eigen::Quaterniond(rotation).normalized();
}

Landmark LandmarkInCamera(const KittiLabel& label, const KittiCalibration& calibration) {
  const Eigen::Vector3d up = -Eigen::Vector3d::UnitY();
  const Eigen::Vector3d front(std::cos(label.rotation_y), 0.0, -std::sin(label.rotation_y));
  Landmark landmark;
  landmark.half_axes = 0.5 * Eigen::Vector3d(label.size[2], label.size[1], label.size[0]);
  landmark.frame_from_object = {
      UprightRotation(front, up),
      label.bottom_centre + calibration.camera2_from_camera0 + landmark.half_axes.z() * up};
  landmark.shape_exponents = kCuboidExponent;
  return landmark;
}

void AddLabelledObject(Object object, int segment, Sequence* sequence) {
  const GroundTruth& truth = *object.ground_truth;
  object.plane_index = static_cast<int>(sequence->planes.size());
  sequence->planes.push_back({object.id, ComputeSupportPlane(truth.landmark_in_world)});
  sequence->true_objects.push_back({object.id, object.label, truth, segment, object.is_static});
  sequence->objects.push_back(std::move(object));
}

DetectionRow RowOfLabel(const KittiLabel& label, const Box& box, double score,
                        const KittiCalibration& calibration, const Camera& camera) {
  const Landmark landmark = LandmarkInCamera(label, calibration);
  DetectionRow row{label.place, 0, 0, LowerCase(label.type), score, box};
  const double right = camera.width - 0.5;
  const double bottom = camera.height - 0.5;
  row.box = {std::clamp(box.x_min, -0.5, right), std::clamp(box.y_min, -0.5, bottom),
             std::clamp(box.x_max, -0.5, right), std::clamp(box.y_max, -0.5, bottom)};
  row.truncation = label.truncated;
  row.occlusion = label.occluded;
  row.plane_in_camera = ComputeSupportPlane(landmark);
  row.true_landmark_in_camera = landmark;
  return row;
}

}  // namespace soslam
