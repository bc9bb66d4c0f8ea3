// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/trajectories.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "soslam/base/error.h"
#include "soslam/dataset/text_file.h"

namespace soslam {

Eigen::Quaterniond UnitQuaternion(const Eigen::Vector4d& xyzw, const std::string& place) {
  constexpr double kTolerance = 1e-2;
  if (!(std::abs(xyzw.norm() - 1.0) <= kTolerance)) {
    throw InputError(fmt::format("{}: quaternion has norm {:.6g}; expected 1", place, xyzw.norm()));
  }
  return Eigen::Quaterniond(xyzw).normalized();
}

Eigen::Quaterniond NearestRotation(const Eigen::Matrix3d& matrix, const std::string& place) {
  constexpr double kTolerance = 1e-3;  // of each entry of R R^T: three digits were kept at least
  const double deviation =
      (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kTolerance)) {
    throw InputError(
        fmt::format("{}: rotation is not orthonormal, R R^T is off by {:.3g}; expected at most {}",
                    place, deviation, kTolerance));
  }
  if (matrix.determinant() < 0.0) {
    throw InputError(place +
                     ": rotation has determinant -1; expected 1, a matrix without mirroring");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose()))
      .normalized();
}

Rigid3d RigidMotion(const Eigen::Matrix4d& matrix, const std::string& place) {
  constexpr double kTolerance = 1e-6;
  const Eigen::RowVector4d last = matrix.row(3);
  if (!((last - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() <= kTolerance)) {
    throw InputError(fmt::format(
        "{}: last row of the 4 x 4 matrix is {} {} {} {}; expected 0 0 0 1: is it transposed?",
        place, last[0], last[1], last[2], last[3]));
  }
  return {NearestRotation(matrix.topLeftCorner<3, 3>(), place), matrix.topRightCorner<3, 1>()};
}

namespace {

TimedPose ParseTumPose(const TextLine& line) {
  constexpr std::array kFields = {"timestamp", "tx", "ty", "tz", "qx", "qy", "qz", "qw"};
  const auto words = SplitWords(line.text);
  const bool has_commas = line.text.find(',') != line.text.npos;
  const auto ends_with_comma = [](std::string_view word) { return word.ends_with(','); };
  if (words.size() != kFields.size() || std::ranges::any_of(words, ends_with_comma)) {
    throw InputError(fmt::format(
        "{}: has {} {}; expected {}{}", line.place, words.size(),
        has_commas ? "words, with commas" : "numbers", fmt::join(kFields, " "),
        has_commas ? ", with blanks between (rows of EuRoC have commas, nanoseconds and qw first: "
                     "trajectory_format euroc)"
                   : ""));
  }
  const auto [t, x, y, z, qx, qy, qz, qw] = ParseReals(words, line.place, kFields);
  return {t, {UnitQuaternion({qx, qy, qz, qw}, line.place), {x, y, z}}};
}

TimedPose ParseEurocPose(const TextLine& line) {
  constexpr double kSecondsPerUnit = 1e-9;
  constexpr std::array kFields = {"timestamp", "x", "y", "z", "qw", "qx", "qy", "qz"};
  const auto fields = SplitFields(line.text);
  if (fields.size() < kFields.size()) {
    throw InputError(fmt::format("{}: has {} fields; expected {}", line.place, fields.size(),
                                 fmt::join(kFields, ",")));
  }
  const auto [t, x, y, z, qw, qx, qy, qz] = ParseReals(fields, line.place, kFields);
  if (t != std::floor(t)) {
    throw InputError(fmt::format("{}: timestamp is {}; expected nanoseconds, an integer",
                                 line.place, fields[0]));
  }
  return {t * kSecondsPerUnit, {UnitQuaternion({qx, qy, qz, qw}, line.place), {x, y, z}}};
}

// Final step of a trajectory reader: sorts, removes duplicates, checks.
std::vector<TimedPose> SortedTrajectory(std::vector<TimedPose> trajectory,
                                        const std::filesystem::path& path) {
  // No more than a camera moves within the resolution of a timestamp.
  constexpr double kMetres = 0.01;
  constexpr double kRadians = 0.02;
  if (trajectory.empty()) throw InputError(path.string() + ": has no pose");
  std::ranges::stable_sort(trajectory, {}, &TimedPose::timestamp);
  const auto differ = [](const TimedPose& a, const TimedPose& b) {
    const Rigid3d &from = a.world_from_camera, &to = b.world_from_camera;
    const bool is_same = (from.translation - to.translation).norm() <= kMetres &&
                         from.rotation.angularDistance(to.rotation) <= kRadians;
    return a.timestamp == b.timestamp && !is_same;
  };
  const auto twice = std::ranges::adjacent_find(trajectory, differ);
  if (twice != trajectory.end()) {
    throw InputError(fmt::format("{}: timestamp {} twice with different poses; expected one pose",
                                 path.string(), twice->timestamp));
  }
  const auto is_repeated = [](const TimedPose& a, const TimedPose& b) {
    return a.timestamp == b.timestamp;
  };
  trajectory.erase(std::unique(trajectory.begin(), trajectory.end(), is_repeated),
                   trajectory.end());
  return trajectory;
}

}  // namespace

std::vector<ListedImage> ReadImageList(const std::filesystem::path& path) {
  constexpr double kSecondsPerUnit = 1e-9;
  const auto is_word = [](std::string_view field) { return SplitWords(field).size() == 1; };
  std::vector<ListedImage> images;
  for (const TextLine& line : ReadTextLines(path)) {
    // Rows of EuRoC, "timestamp,filename"; others may have commas in numbers or file names.
    const auto fields = SplitFields(line.text);
    if (fields.size() == 2 && std::ranges::all_of(fields, is_word)) {
      const double timestamp = ParseReal(fields[0], line.place, "timestamp");
      if (timestamp != std::floor(timestamp)) {
        throw InputError(
            fmt::format("{}: timestamp is {}; expected nanoseconds, an integer, before a "
                        "comma, or seconds before a blank",
                        line.place, fields[0]));
      }
      images.push_back({timestamp * kSecondsPerUnit, std::string(fields[1])});
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

std::string TrajectoryLine(const TimedPose& pose) {
  return fmt::format("{} {} {}\n", pose.timestamp,
                     fmt::join(pose.world_from_camera.translation, " "),
                     fmt::join(pose.world_from_camera.rotation.coeffs(), " "));
}

std::vector<TimedPose> ReadTrajectory(const std::filesystem::path& path) {
  return SortedTrajectory(ParseTextLines(path, &ParseTumPose), path);
}

std::optional<TimedPose> NearestPose(const std::vector<TimedPose>& trajectory, double timestamp,
                                     double max_difference_s) {
  const auto difference = [&](const TimedPose& pose) {
    return std::abs(pose.timestamp - timestamp);
  };
  const auto after = std::ranges::lower_bound(trajectory, timestamp, {}, &TimedPose::timestamp);
  const auto from = after == trajectory.begin() ? after : after - 1;
  const auto to = after == trajectory.end() ? after : after + 1;
  const auto nearest = std::ranges::min_element(from, to, {}, difference);
  if (nearest == to || difference(*nearest) > max_difference_s) return std::nullopt;
  return *nearest;
}

std::vector<TimedPose> ReadEurocTrajectory(const std::filesystem::path& path) {
  return SortedTrajectory(ParseTextLines(path, &ParseEurocPose), path);
}

Eigen::Matrix<double, 3, 4> ParseMatrix34(std::span<const std::string_view> words,
                                          const std::string& place) {
  if (words.size() != 12) {
    throw InputError(fmt::format("{}: has {} numbers; expected 12, a 3 x 4 matrix by rows", place,
                                 words.size()));
  }
  Eigen::Matrix<double, 3, 4> matrix;
  for (size_t i = 0; i < words.size(); ++i) {
    matrix(static_cast<int>(i / 4), static_cast<int>(i % 4)) =
        ParseReal(words[i], place, fmt::format("number {}", i + 1));
  }
  return matrix;
}

std::vector<Rigid3d> ReadKittiTrajectory(const std::filesystem::path& path) {
  std::vector<Rigid3d> poses = ParseTextLines(path, [](const TextLine& line) {
    const Eigen::Matrix<double, 3, 4> pose = ParseMatrix34(SplitWords(line.text), line.place);
    return Rigid3d{NearestRotation(pose.leftCols<3>(), line.place), pose.col(3)};
  });
  if (poses.empty()) throw InputError(path.string() + ": has no pose");
  return poses;
}

Rigid3d MirroredInY(const Rigid3d& world_from_camera) {
  // With S = diag(1, -1, 1), S R S rotates about the mirrored axis by the opposite angle.
  const Eigen::Quaterniond& q = world_from_camera.rotation;
  const Eigen::Vector3d& t = world_from_camera.translation;
  return {Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), {t.x(), -t.y(), t.z()}};
}

}  // namespace soslam
