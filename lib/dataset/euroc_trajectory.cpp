// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/euroc_trajectory.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>

#include "base/error.h"
#include "dataset/text_file.h"
#include "dataset/unit_quaternion.h"

namespace soslam {
namespace {

TimedPose ParsePose(const TextLine& line) {
  constexpr double kSecondsPerUnit = 1e-9;
  constexpr std::array kFields = {"timestamp", "x", "y", "z", "qw", "qx", "qy", "qz"};
  const auto fields = SplitFields(line.text);
  if (fields.size() < kFields.size()) {
    throw InputError(fmt::format("{}: has {} fields; expected {}", line.place, fields.size(),
                                 fmt::join(kFields, ",")));
  }
  std::array<double, kFields.size()> v;
  for (size_t i = 0; i < v.size(); ++i) v[i] = ParseReal(fields[i], line.place, kFields[i]);
  if (v[0] != std::floor(v[0])) {
    throw InputError(fmt::format("{}: timestamp is {}; expected nanoseconds, an integer",
                                 line.place, fields[0]));
  }
  return {v[0] * kSecondsPerUnit,
          {UnitQuaternion({v[5], v[6], v[7], v[4]}, line.place), {v[1], v[2], v[3]}}};
}

}  // namespace

std::vector<TimedPose> ReadEurocTrajectory(const std::filesystem::path& path) {
  std::vector<TimedPose> trajectory;
  for (const TextLine& line : ReadTextLines(path)) trajectory.push_back(ParsePose(line));
  return SortedTrajectory(std::move(trajectory), path);
}

}  // namespace soslam
