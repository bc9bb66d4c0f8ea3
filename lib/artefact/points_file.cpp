// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>

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
template <typename Vector>
void CheckFinite(const Hdf5File& file, const char* name, const std::vector<Vector>& rows) {
  for (size_t i = 0; i < rows.size(); ++i) {
    for (const double value : rows[i]) {
      if (!std::isfinite(value)) {
        Refuse(file, name, i, fmt::format("{}", value), "a finite number");
      }
    }
  }
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
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> errors;
  std::vector<int> begins = {0}, frames;
  std::vector<Eigen::Vector2d> pixels;
  for (const MapPoint& point : points) {
    positions.push_back(point.position_in_world);
    errors.push_back(point.reprojection_error_px);
    for (const PointObservation& observation : point.observations) {
      frames.push_back(observation.frame_id);
      pixels.push_back(observation.pixel);
    }
    begins.push_back(static_cast<int>(frames.size()));
  }
  Hdf5File file = CreateArtefact(path, kPointsKind, info);
  file.WriteRows(kPosition, positions);
  file.WriteVector(kError, errors);
  file.WriteVector(kBegin, begins);
  file.WriteVector(kFrame, frames);
  file.WriteRows(kPixel, pixels);
  file.Close();
}

std::vector<MapPoint> ReadPoints(const std::filesystem::path& path) {
  const Hdf5File file = OpenArtefact(path, kPointsKind);
  const auto positions = file.ReadRows<Eigen::Vector3d>(kPosition);
  const int count = static_cast<int>(positions.size());
  const auto errors = file.ReadVector<double>(kError, count);
  const auto begins = file.ReadVector<int>(kBegin, count + 1);
  const auto frames = file.ReadVector<int>(kFrame);
  const auto pixels = file.ReadRows<Eigen::Vector2d>(kPixel, static_cast<int>(frames.size()));
  CheckFinite(file, kPosition, positions);
  CheckFinite(file, kPixel, pixels);
  CheckNotNegative(file, kError, errors);
  CheckNotNegative(file, kFrame, frames);
  CheckBegins(file, begins, frames.size());
  std::vector<MapPoint> points;
  for (size_t i = 0; i < positions.size(); ++i) {
    MapPoint& point = points.emplace_back(MapPoint{positions[i], errors[i], {}});
    for (int k = begins[i]; k < begins[i + 1]; ++k) {
      point.observations.push_back({frames[k], pixels[k]});
    }
  }
  return points;
}

}  // namespace soslam
