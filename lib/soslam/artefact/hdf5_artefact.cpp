// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/hdf5_artefact.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/image/file_kind.h"

namespace soslam {
namespace {

constexpr const char* kEdgesKind = "edges";
constexpr const char* kFrames = "/frames";

std::string FrameGroup(int frame_id) { return fmt::format("{}/{:06d}", kFrames, frame_id); }

constexpr const char* kSymmetryKind = "symmetry";
constexpr const char* kObservations = "/observations";

// The header as JSON; null where there is none.
nlohmann::json ReadHdf5Header(const Hdf5File& file) {
  if (!file.HasAttribute("/", kHeaderAttribute)) return {};
  std::istringstream text(file.ReadText("/", kHeaderAttribute));
  return ParseJsonText(text,
                       fmt::format("{}: attribute {}", file.path().string(), kHeaderAttribute));
}

}  // namespace

Hdf5File CreateArtefact(const std::filesystem::path& path, const std::string& kind,
                        const ArtefactInfo& info) {
  Hdf5File file = Hdf5File::Create(path);
  file.WriteText("/", kHeaderAttribute, JsonText(ArtefactHeader(kind, info)));
  return file;
}

Hdf5File OpenArtefact(const std::filesystem::path& path, const std::string& kind) {
  Hdf5File file = Hdf5File::Open(path);
  CheckArtefactHeader(ReadHdf5Header(file), kind, path.string());
  return file;
}

bool IsHdf5(const std::filesystem::path& path) { return KindOfFile(path) == "an HDF5 file"; }

nlohmann::json ReadArtefactHeader(const std::filesystem::path& path) {
  nlohmann::json header;
  if (IsHdf5(path)) {
    header = ReadHdf5Header(Hdf5File::Open(path));
  } else {
    const nlohmann::json document = ParseJsonFile(path);
    if (document.is_object()) header = document.value("artefact", nlohmann::json());
  }
  if (!header.is_object() || !header.contains("kind") || !header["kind"].is_string()) {
    throw InputError(path.string() +
                     ": has no artefact header that names its kind; expected what a stage wrote");
  }
  return header;
}

EdgesWriter::EdgesWriter(const std::filesystem::path& path, const ArtefactInfo& info)
    : file_(CreateArtefact(path, kEdgesKind, info)) {}

void EdgesWriter::Write(int frame_id, const EdgeMaps& maps) {
  const std::string group = FrameGroup(frame_id);
  file_.WriteMatrix(group + "/grey", maps.grey);
  file_.WriteMatrix(group + "/edges", maps.edges);
  file_.WriteMatrix(group + "/distance", maps.distance);
  file_.WriteMatrix(group + "/nearest_edge", maps.nearest_edge);
  file_.WriteRows(group + "/corners", maps.corners);
}

EdgesReader::EdgesReader(const std::filesystem::path& path)
    : file_(OpenArtefact(path, kEdgesKind)) {}

bool EdgesReader::Has(int frame_id) const { return file_.Has(FrameGroup(frame_id)); }

std::vector<int> EdgesReader::FrameIds() const {
  std::vector<int> ids;
  if (!file_.Has(kFrames)) return ids;  // no frame has an image
  for (const std::string& name : file_.Children(kFrames)) {
    int id = 0;
    const auto parsed = std::from_chars(name.data(), name.data() + name.size(), id);
    if (parsed.ec != std::errc() || FrameGroup(id) != fmt::format("{}/{}", kFrames, name)) {
      throw InputError(fmt::format("{}: {}/{}: expected the id of a frame with at least six digits",
                                   file_.path().string(), kFrames, name));
    }
    ids.push_back(id);
  }
  std::ranges::sort(ids);
  return ids;
}

EdgeMaps EdgesReader::Read(int frame_id) const {
  const std::string group = FrameGroup(frame_id);
  EdgeMaps maps;
  maps.grey = file_.ReadMatrix(group + "/grey", CV_8UC1);
  const auto read = [&](const char* name, int type) {
    return file_.ReadMatrix(group + name, type, maps.grey.rows, maps.grey.cols);
  };
  maps.edges = read("/edges", CV_8UC1);
  maps.distance = read("/distance", CV_32FC1);
  maps.nearest_edge = read("/nearest_edge", CV_16SC2);
  // These values are used as indices.
  const cv::Rect image(0, 0, maps.nearest_edge.cols, maps.nearest_edge.rows);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto& edge = maps.nearest_edge.at<cv::Vec2s>(y, x);
      const cv::Point pixel(edge[0], edge[1]);
      if (image.contains(pixel) || pixel == cv::Point(-1, -1)) continue;
      throw InputError(
          fmt::format("{}: {}/nearest_edge: found ({}, {}) at ({}, {}); expected a pixel of the "
                      "image or (-1, -1)",
                      file_.path().string(), group, pixel.x, pixel.y, x, y));
    }
  }
  maps.corners = file_.ReadRows<Eigen::Vector2f>(group + "/corners");
  return maps;
}

void WriteSymmetry(const std::filesystem::path& path, const std::vector<SymmetryRecord>& records,
                   const ArtefactInfo& info) {
  Hdf5File file = CreateArtefact(path, kSymmetryKind, info);
  file.WriteGroup(kObservations);
  for (const SymmetryRecord& record : records) {
    const std::string group =
        fmt::format("{}/{:06d}_{:06d}", kObservations, record.frame_id, record.object_id);
    file.WriteVector(group + "/yaw", record.yaw);
    file.WriteGroup(group + "/cost");
    for (const auto& [descriptor, cost] : record.cost) {
      file.WriteVector(group + "/cost/" + descriptor, cost);
    }
    file.WriteRows(group + "/samples", record.samples);
    file.WriteRows(group + "/mirrored", record.mirrored);
    file.WriteNumber(group, "frame_id", record.frame_id);
    file.WriteNumber(group, "object_id", record.object_id);
    file.WriteNumber(group, "initial_yaw", record.initial_yaw);
    file.WriteNumber(group, "refined_yaw", record.refined_yaw);
    if (record.yaw_sigma) file.WriteNumber(group, "yaw_sigma", *record.yaw_sigma);
    if (record.mirror_planes) file.WriteNumber(group, "mirror_planes", *record.mirror_planes);
    if (record.true_yaw) file.WriteNumber(group, "true_yaw", *record.true_yaw);
  }
  file.Close();
}

std::vector<SymmetryRecord> ReadSymmetry(const std::filesystem::path& path) {
  const Hdf5File file = OpenArtefact(path, kSymmetryKind);
  std::vector<SymmetryRecord> records;
  for (const std::string& name : file.Children(kObservations)) {
    const std::string group = fmt::format("{}/{}", kObservations, name);
    SymmetryRecord& record = records.emplace_back();
    record.frame_id = static_cast<int>(std::lround(file.ReadNumber(group, "frame_id")));
    record.object_id = static_cast<int>(std::lround(file.ReadNumber(group, "object_id")));
    record.yaw = file.ReadVector<double>(group + "/yaw");
    const int yaws = static_cast<int>(record.yaw.size());
    for (const std::string& descriptor : file.Children(group + "/cost")) {
      record.cost[descriptor] = file.ReadVector<double>(group + "/cost/" + descriptor, yaws);
    }
    record.samples = file.ReadRows<Eigen::Vector2f>(group + "/samples");
    record.mirrored = file.ReadRows<Eigen::Vector2f>(group + "/mirrored",
                                                     static_cast<int>(record.samples.size()));
    record.initial_yaw = file.ReadNumber(group, "initial_yaw");
    record.refined_yaw = file.ReadNumber(group, "refined_yaw");
    if (file.HasAttribute(group, "yaw_sigma")) {
      record.yaw_sigma = file.ReadNumber(group, "yaw_sigma");
    }
    if (file.HasAttribute(group, "mirror_planes")) {
      const double planes = file.ReadNumber(group, "mirror_planes");
      if (planes != 0.0 && planes != 1.0 && planes != 2.0) {
        throw InputError(fmt::format("{}: {}/mirror_planes: found {}; expected 0, 1 or 2",
                                     file.path().string(), group, planes));
      }
      record.mirror_planes = static_cast<int>(planes);
    }
    if (file.HasAttribute(group, "true_yaw")) record.true_yaw = file.ReadNumber(group, "true_yaw");
  }
  const auto key = [](const SymmetryRecord& r) { return std::pair(r.frame_id, r.object_id); };
  std::ranges::sort(records, [&](const auto& a, const auto& b) { return key(a) < key(b); });
  return records;
}

}  // namespace soslam
