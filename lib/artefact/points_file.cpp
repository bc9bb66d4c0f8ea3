// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <limits>
#include <opencv2/core.hpp>
#include <string>

#include "artefact/atomic_file.h"
#include "artefact/files.h"
#include "artefact/hdf5_artefact.h"
#include "base/error.h"

namespace soslam {
namespace {

constexpr const char* kPointsKind = "points";
constexpr const char* kPosition = "/position";
constexpr const char* kError = "/reprojection_error_px";
constexpr const char* kBegin = "/observation_begin";
constexpr const char* kFrame = "/observation_frame";
constexpr const char* kPixel = "/observation_pixel";

[[noreturn]] void Refuse(const Hdf5File& file, const char* name, size_t row,
                         const std::string& found, const char* expected) {
  throw InputError(fmt::format("{}: {}: row {}: found {}; expected {}", file.path().string(), name,
                               row, found, expected));
}

// Throws InputError unless all values are finite.
void CheckFinite(const Hdf5File& file, const char* name, const cv::Mat& matrix) {
  cv::Point place;
  if (cv::checkRange(matrix, /*quiet=*/true, &place)) return;
  Refuse(file, name, static_cast<size_t>(place.y), fmt::format("{}", matrix.at<double>(place)),
         "a finite number");
}

// Throws InputError unless the indices ascend from 0 to the number of observations.
void CheckBegins(const Hdf5File& file, const std::vector<int>& begins, size_t observations) {
  if (begins.front() != 0) {
    Refuse(file, kBegin, 0, std::to_string(begins.front()), "0");
  }
  for (size_t i = 1; i < begins.size(); ++i) {
    if (begins[i] >= begins[i - 1]) continue;
    Refuse(file, kBegin, i, std::to_string(begins[i]), "at least the index above it");
  }
  if (static_cast<size_t>(begins.back()) != observations) {
    Refuse(file, kBegin, begins.size() - 1, std::to_string(begins.back()),
           "the number of rows of observation_frame");
  }
}

void CheckNotNegative(const Hdf5File& file, const char* name, const auto& values) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= 0 && values[i] <= std::numeric_limits<int>::max()) continue;
    Refuse(file, name, i, fmt::format("{}", values[i]), "a number of at least 0");
  }
}

}  // namespace

void WritePoints(const std::filesystem::path& path, const std::vector<MapPoint>& points,
                 const ArtefactInfo& info) {
  const int count = static_cast<int>(points.size());
  cv::Mat positions(count, 3, CV_64FC1);
  std::vector<double> errors;
  std::vector<int> begins = {0}, frames;
  std::vector<double> pixels;
  for (int i = 0; i < count; ++i) {
    const MapPoint& point = points[i];
    for (int k = 0; k < 3; ++k) positions.at<double>(i, k) = point.position_in_world[k];
    errors.push_back(point.reprojection_error_px);
    for (const PointObservation& observation : point.observations) {
      frames.push_back(observation.frame_id);
      pixels.insert(pixels.end(), {observation.pixel.x(), observation.pixel.y()});
    }
    begins.push_back(static_cast<int>(frames.size()));
  }
  AtomicFile atomic(path);
  Hdf5File file = Hdf5File::Create(atomic.TemporaryPath(), path);
  WriteArtefactHeader(kPointsKind, info, &file);
  file.WriteMatrix(kPosition, positions);
  file.WriteVector(kError, errors);
  file.WriteVector(kBegin, begins);
  file.WriteVector(kFrame, frames);
  file.WriteMatrix(kPixel, cv::Mat(static_cast<int>(frames.size()), 2, CV_64FC1, pixels.data()));
  file.Close();
  atomic.Commit();
}

std::vector<MapPoint> ReadPoints(const std::filesystem::path& path) {
  const Hdf5File file = OpenArtefact(path, kPointsKind);
  const cv::Mat positions = file.ReadMatrix(kPosition, CV_64FC1, Hdf5File::kAny, 3);
  const auto errors = file.ReadVector<double>(kError, positions.rows);
  const auto begins = file.ReadVector<int>(kBegin, positions.rows + 1);
  const auto frames = file.ReadVector<int>(kFrame);
  const cv::Mat pixels = file.ReadMatrix(kPixel, CV_64FC1, static_cast<int>(frames.size()), 2);
  CheckFinite(file, kPosition, positions);
  CheckFinite(file, kPixel, pixels);
  CheckNotNegative(file, kError, errors);
  CheckNotNegative(file, kFrame, frames);
  CheckBegins(file, begins, frames.size());
  std::vector<MapPoint> points(errors.size());
  for (int i = 0; i < positions.rows; ++i) {
    const auto index = static_cast<size_t>(i);
    MapPoint& point = points[index];
    point.position_in_world = {positions.at<double>(i, 0), positions.at<double>(i, 1),
                               positions.at<double>(i, 2)};
    point.reprojection_error_px = errors[index];
    for (int k = begins[index]; k < begins[index + 1]; ++k) {
      point.observations.push_back({frames[k], {pixels.at<double>(k, 0), pixels.at<double>(k, 1)}});
    }
  }
  return points;
}

}  // namespace soslam
