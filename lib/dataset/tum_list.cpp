// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/tum_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "dataset/text_file.h"
#include "dataset/unit_quaternion.h"

namespace soslam {
namespace {

TimedPose ParsePose(const TextLine& line) {
  constexpr std::array kFields = {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  const auto words = SplitWords(line.text);
  if (words.size() != kFields.size()) {
    throw InputError(fmt::format("{}: has {} numbers; expected {}", line.place, words.size(),
                                 fmt::join(kFields, " ")));
  }
  std::array<double, kFields.size()> v;
  for (size_t i = 0; i < v.size(); ++i) v[i] = ParseReal(words[i], line.place, kFields[i]);
  return {v[0], {UnitQuaternion({v[4], v[5], v[6], v[7]}, line.place), {v[1], v[2], v[3]}}};
}

// True if the poses differ by no more than a camera moves within the resolution of a timestamp.
bool IsSamePose(const Rigid3d& a, const Rigid3d& b) {
  constexpr double kMetres = 0.01;
  constexpr double kRadians = 0.02;
  return (a.translation - b.translation).norm() <= kMetres &&
         a.rotation.angularDistance(b.rotation) <= kRadians;
}

// Parses a row "timestamp,filename"; none for other rows, including those with commas in numbers or
// file names.
std::optional<ListedImage> EurocImage(const TextLine& line) {
  constexpr double kSecondsPerUnit = 1e-9;
  const auto fields = SplitFields(line.text);
  const auto is_word = [](std::string_view field) { return SplitWords(field).size() == 1; };
  if (fields.size() != 2 || !std::ranges::all_of(fields, is_word)) return std::nullopt;
  const double timestamp = ParseReal(fields[0], line.place, "timestamp");
  if (timestamp != std::floor(timestamp)) {
    throw InputError(
        fmt::format("{}: timestamp is {}; expected nanoseconds, an integer, before a "
                    "comma, or seconds before a blank",
                    line.place, fields[0]));
  }
  return ListedImage{timestamp * kSecondsPerUnit, std::string(fields[1])};
}

}  // namespace

std::vector<ListedImage> ReadImageList(const std::filesystem::path& path) {
  std::vector<ListedImage> images;
  for (const TextLine& line : ReadTextLines(path)) {
    if (const auto image = EurocImage(line)) {
      images.push_back(*image);
      continue;
    }
    const std::string_view timestamp = SplitWords(line.text).front();
    const std::string_view image = Trimmed(std::string_view(line.text).substr(timestamp.size()));
    const double seconds = ParseReal(timestamp, line.place, "timestamp");
    if (image.empty()) {
      throw InputError(line.place + ": has no file name; expected timestamp filename");
    }
    images.push_back({seconds, std::string(image)});
  }
  if (images.empty()) throw InputError(path.string() + ": lists no image");
  return images;
}

std::vector<ListedImage> ReadPairedImageList(const std::filesystem::path& path, PairOrder order) {
  std::vector<ListedImage> images;
  for (const TextLine& line : ReadTextLines(path)) {
    const auto words = SplitWords(line.text);
    if (words.size() != 2 && words.size() != 4) {
      throw InputError(
          fmt::format("{}: has {} words; expected timestamp filename [timestamp filename]",
                      line.place, words.size()));
    }
    const size_t first = words.size() == 4 && order == PairOrder::kImageSecond ? 2 : 0;
    images.push_back(
        {ParseReal(words[first], line.place, "timestamp"), std::string(words[first + 1])});
  }
  if (images.empty()) throw InputError(path.string() + ": lists no image");
  return images;
}

std::vector<TimedPose> ReadTrajectory(const std::filesystem::path& path) {
  std::vector<TimedPose> trajectory;
  for (const TextLine& line : ReadTextLines(path)) trajectory.push_back(ParsePose(line));
  return SortedTrajectory(std::move(trajectory), path);
}

std::vector<TimedPose> SortedTrajectory(std::vector<TimedPose> trajectory,
                                        const std::filesystem::path& path) {
  if (trajectory.empty()) throw InputError(path.string() + ": has no pose");
  std::stable_sort(
      trajectory.begin(), trajectory.end(),
      [](const TimedPose& a, const TimedPose& b) { return a.timestamp < b.timestamp; });
  const auto same_time = [](const TimedPose& a, const TimedPose& b) {
    return a.timestamp == b.timestamp;
  };
  const auto twice = std::adjacent_find(
      trajectory.begin(), trajectory.end(), [&](const TimedPose& a, const TimedPose& b) {
        return same_time(a, b) && !IsSamePose(a.world_from_camera, b.world_from_camera);
      });
  if (twice != trajectory.end()) {
    throw InputError(fmt::format("{}: timestamp {} twice with different poses; expected one pose",
                                 path.string(), twice->timestamp));
  }
  trajectory.erase(std::unique(trajectory.begin(), trajectory.end(), same_time), trajectory.end());
  return trajectory;
}

std::optional<TimedPose> NearestPose(const std::vector<TimedPose>& trajectory, double timestamp,
                                     double max_difference_s) {
  const auto difference = [&](const TimedPose& pose) {
    return std::abs(pose.timestamp - timestamp);
  };
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), timestamp,
                       [](const TimedPose& pose, double time) { return pose.timestamp < time; });
  auto nearest = after;
  if (after == trajectory.end() ||
      (after != trajectory.begin() && difference(*std::prev(after)) <= difference(*after))) {
    if (after == trajectory.begin()) return std::nullopt;
    nearest = std::prev(after);
  }
  if (difference(*nearest) > max_difference_s) return std::nullopt;
  return *nearest;
}

}  // namespace soslam
