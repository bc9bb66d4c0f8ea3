// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/image/edge_maps.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"

namespace soslam {

namespace fs = std::filesystem;

void RunEdges(const EdgesOptions& options, const StageFiles& files, int threads) {
  options.Check();
  const fs::path& sequence_file = files.at("sequence");
  const Sequence sequence = ReadSequence(sequence_file, PlaneNeed::kNotNeeded);
  const std::vector<FrameImage> images = FrameImages(sequence, files.at("dataset"), sequence_file);
  std::vector<fs::path> inputs = {sequence_file};
  for (const FrameImage& image : images) {
    // Nearest edges are stored as 16-bit coordinates.
    constexpr int kMaxSide = std::numeric_limits<std::int16_t>::max();
    const Camera& camera = sequence.CameraOf(*image.frame);
    if (std::max(camera.width, camera.height) > kMaxSide) {
      throw InputError(fmt::format("{}: camera is {} x {} pixels; expected at most {} a side",
                                   sequence_file.string(), camera.width, camera.height, kMaxSide));
    }
    inputs.push_back(image.path);
  }
  EdgesWriter writer(files.at("output"), {OptionsToJson(options), inputs, {}, "edges"});

  const FrameImageReader reader(sequence);
  MakeInOrder(
      "frames", images.size(), threads,
      [&](size_t i) {
        return ComputeEdgeMaps(reader.Read(images[i], cv::IMREAD_GRAYSCALE), options);
      },
      [&](size_t i, const EdgeMaps& maps) { writer.Write(images[i].frame->id, maps); });
  writer.Commit();
  if (images.size() < sequence.frames.size()) {
    fmt::print("{} of {} frames have an image\n", images.size(), sequence.frames.size());
  }
}

}  // namespace soslam
