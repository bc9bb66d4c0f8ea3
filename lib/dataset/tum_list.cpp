// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/tum_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace

std::vector<ListedImage> ReadImageList(const std::filesystem::path& path) {
  std::vector<ListedImage> images;
  for (const TextLine& line : ReadTextLines(path)) {
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

std::vector<TimedPose> ReadTrajectory(const std::filesystem::path& path) {
  std::vector<TimedPose> trajectory;
  for (const TextLine& line : ReadTextLines(path)) trajectory.push_back(ParsePose(line));
  if (trajectory.empty()) throw InputError(path.string() + ": has no pose");
  std::sort(trajectory.begin(), trajectory.end(),
            [](const TimedPose& a, const TimedPose& b) { return a.timestamp < b.timestamp; });
  const auto twice = std::adjacent_find(
      trajectory.begin(), trajectory.end(),
      [](const TimedPose& a, const TimedPose& b) { return a.timestamp == b.timestamp; });
  if (twice != trajectory.end()) {
    throw InputError(fmt::format("{}: timestamp {} twice; expected one pose each", path.string(),
                                 twice->timestamp));
  }
  return trajectory;
}

std::optional<Rigid3d> NearestPose(const std::vector<TimedPose>& trajectory, double timestamp,
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
  return nearest->world_from_camera;
}

}  // namespace soslam
