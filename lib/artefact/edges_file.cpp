// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/edges_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string>

#include "artefact/hdf5_artefact.h"
#include "base/error.h"

namespace soslam {
namespace {

constexpr const char* kKind = "edges";

constexpr const char* kFrames = "/frames";

std::string FrameGroup(int frame_id) { return fmt::format("{}/{:06d}", kFrames, frame_id); }

// Checks that all values are pixels of the maps, as they are used as indices.
void CheckNearestEdges(const cv::Mat& nearest_edge, const std::string& where) {
  const cv::Rect image(0, 0, nearest_edge.cols, nearest_edge.rows);
  for (int y = 0; y < nearest_edge.rows; ++y) {
    for (int x = 0; x < nearest_edge.cols; ++x) {
      const auto& edge = nearest_edge.at<cv::Vec2s>(y, x);
      const cv::Point pixel(edge[0], edge[1]);
      if (image.contains(pixel) || pixel == cv::Point(-1, -1)) continue;
      throw InputError(
          fmt::format("{}: found ({}, {}) at ({}, {}); expected a pixel of the image or (-1, -1)",
                      where, pixel.x, pixel.y, x, y));
    }
  }
}

}  // namespace

EdgesWriter::EdgesWriter(const std::filesystem::path& path, const ArtefactInfo& info)
    : atomic_(path), file_(Hdf5File::Create(atomic_.TemporaryPath(), path)) {
  WriteArtefactHeader(kKind, info, &file_);
}

void EdgesWriter::Write(int frame_id, const EdgeMaps& maps) {
  const std::string group = FrameGroup(frame_id);
  file_.WriteMatrix(group + "/grey", maps.grey);
  file_.WriteMatrix(group + "/edges", maps.edges);
  file_.WriteMatrix(group + "/distance", maps.distance);
  file_.WriteMatrix(group + "/nearest_edge", maps.nearest_edge);
  WritePixels(group + "/corners", maps.corners, &file_);
}

void EdgesWriter::Commit() {
  file_.Close();
  atomic_.Commit();
}

EdgesReader::EdgesReader(const std::filesystem::path& path) : file_(OpenArtefact(path, kKind)) {}

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
  CheckNearestEdges(maps.nearest_edge, file_.path().string() + ": " + group + "/nearest_edge");
  maps.corners = ReadPixels(file_, group + "/corners");
  return maps;
}

}  // namespace soslam
