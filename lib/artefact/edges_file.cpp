// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/edges_file.h"

#include <fmt/format.h>

#include <string>

#include "artefact/hdf5_artefact.h"

namespace soslam {
namespace {

constexpr const char* kKind = "edges";

std::string FrameGroup(int frame_id) { return fmt::format("/frames/{:06d}", frame_id); }

}  // namespace

EdgesWriter::EdgesWriter(const std::filesystem::path& path, const ArtefactInfo& info)
    : atomic_(path), file_(Hdf5File::Create(atomic_.TemporaryPath())) {
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
  maps.corners = ReadPixels(file_, group + "/corners");
  return maps;
}

}  // namespace soslam
