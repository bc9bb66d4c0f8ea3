// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"

namespace soslam {
namespace {

constexpr const char* kPointsKind = "points";
constexpr const char* kMatchesKind = "matches";
constexpr const char* kPosition = "/position";
constexpr const char* kError = "/reprojection_error_px";
constexpr const char* kBegin = "/observation_begin";
constexpr const char* kFrame = "/observation_frame";
constexpr const char* kPixel = "/observation_pixel";
constexpr const char* kColours = "/colours";

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

void CheckNotNegative(const Hdf5File& file, const char* name, const auto& values) {
  for (size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= 0 && values[i] <= std::numeric_limits<int>::max()) continue;
    Refuse(file, name, i, fmt::format("{}", values[i]), "a number of at least 0");
  }
}

// Writes the observations of points or of tracks.
void WriteObservations(const auto& points, Hdf5File* file) {
  std::vector<int> begins = {0}, frames;
  std::vector<Eigen::Vector2d> pixels;
  for (const auto& point : points) {
    for (const PointObservation& observation : point.observations) {
      frames.push_back(observation.frame_id);
      pixels.push_back(observation.pixel);
    }
    begins.push_back(static_cast<int>(frames.size()));
  }
  file->WriteVector(kBegin, begins);
  file->WriteVector(kFrame, frames);
  file->WriteRows(kPixel, pixels);
}

// The observations of this many points, or of all.
std::vector<std::vector<PointObservation>> ReadObservations(const Hdf5File& file,
                                                            int points = Hdf5File::kAny) {
  const int rows = points == Hdf5File::kAny ? Hdf5File::kAny : points + 1;
  const auto begins = file.ReadVector<int>(kBegin, rows);
  const auto frames = file.ReadVector<int>(kFrame);
  const auto pixels = file.ReadRows<Eigen::Vector2d>(kPixel, static_cast<int>(frames.size()));
  CheckFinite(file, kPixel, pixels);
  CheckNotNegative(file, kFrame, frames);
  if (begins.empty() || begins.front() != 0) {
    Refuse(file, kBegin, 0, begins.empty() ? "none" : std::to_string(begins.front()), "0");
  }
  for (size_t i = 1; i < begins.size(); ++i) {
    if (begins[i] >= begins[i - 1]) continue;
    Refuse(file, kBegin, i, std::to_string(begins[i]), "at least the index above it");
  }
  if (static_cast<size_t>(begins.back()) != frames.size()) {
    Refuse(file, kBegin, begins.size() - 1, std::to_string(begins.back()),
           "the number of rows of observation_frame");
  }
  std::vector<std::vector<PointObservation>> observations(begins.size() - 1);
  for (size_t i = 0; i + 1 < begins.size(); ++i) {
    for (int k = begins[i]; k < begins[i + 1]; ++k) {
      observations[i].push_back({frames[k], pixels[k]});
    }
  }
  return observations;
}

}  // namespace

void WritePoints(const std::filesystem::path& path, const std::vector<MapPoint>& points,
                 const ArtefactInfo& info) {
  std::vector<Eigen::Vector3d> positions;
  std::vector<double> errors;
  for (const MapPoint& point : points) {
    positions.push_back(point.position_in_world);
    errors.push_back(point.reprojection_error_px);
  }
  Hdf5File file = CreateArtefact(path, kPointsKind, info);
  file.WriteRows(kPosition, positions);
  file.WriteVector(kError, errors);
  WriteObservations(points, &file);
  file.Close();
}

std::vector<MapPoint> ReadPoints(const std::filesystem::path& path) {
  const Hdf5File file = OpenArtefact(path, kPointsKind);
  const auto positions = file.ReadRows<Eigen::Vector3d>(kPosition);
  const int count = static_cast<int>(positions.size());
  const auto errors = file.ReadVector<double>(kError, count);
  CheckFinite(file, kPosition, positions);
  CheckNotNegative(file, kError, errors);
  auto observations = ReadObservations(file, count);
  std::vector<MapPoint> points;
  for (size_t i = 0; i < positions.size(); ++i) {
    points.push_back({positions[i], errors[i], std::move(observations[i])});
  }
  return points;
}

void WriteMatches(const std::filesystem::path& path, const ImageMatches& matches,
                  const ArtefactInfo& info) {
  Hdf5File file = CreateArtefact(path, kMatchesKind, info);
  WriteObservations(matches.tracks, &file);
  file.WriteRows(kColours, matches.colours);
  file.Close();
}

ImageMatches ReadMatches(const std::filesystem::path& path) {
  const Hdf5File file = OpenArtefact(path, kMatchesKind);
  ImageMatches matches{{}, file.ReadRows<BoxColours>(kColours)};
  std::vector<PointTrack>& tracks = matches.tracks;
  size_t row = 0;
  for (auto& observations : ReadObservations(file)) {
    if (observations.size() < 2) {
      Refuse(file, kBegin, tracks.size() + 1, std::to_string(row + observations.size()),
             "at least two more than the index above it");
    }
    for (size_t k = 1; k < observations.size(); ++k) {
      if (observations[k].frame_id > observations[k - 1].frame_id) continue;
      Refuse(file, kFrame, row + k, std::to_string(observations[k].frame_id),
             "more than the id above it, which is of the same track");
    }
    row += observations.size();
    tracks.push_back({std::move(observations)});
  }
  return matches;
}

}  // namespace soslam
