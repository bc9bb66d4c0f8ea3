// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <opencv2/core.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "soslam/appearance/appearance_file.h"
#include "soslam/appearance/head.h"
#include "soslam/appearance/inner_layers.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/base/paths.h"
#include "soslam/base/progress.h"
#include "soslam/image/network.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"
#include "soslam/system/hash.h"

namespace soslam {

namespace fs = std::filesystem;

namespace {

// True for the network of the head in a file of another program.
bool ComputesTheSame(const NetworkFile& network, const Head& head) {
  try {
    InnerLayers layers(network.bytes, network.name, head.Layers(), head.IsRgb());
    return head.KnowsFeatures(layers.Features(ProbeImage(head.Side())));
  } catch (const InputError&) {  // it has no such layers
    return false;
  }
}

}  // namespace

void RunAppearance(const NoOptions& options, const StageFiles& files, int threads) {
  const fs::path& sequence_file = files.at("sequence");
  const Sequence sequence = ReadSequence(sequence_file);
  const Head head(files.at("head"));
  if (!IsFile(files.at("network"))) {
    throw InputError(fmt::format(
        "{}: no such file; expected the network of {}: `./soslam network` fetches YOLOX-nano, and "
        "`--network FILE` is for where it lies",
        files.at("network").string(), files.at("head").string()));
  }
  const NetworkFile network = ReadNetworkFile(files.at("network"));
  const std::string sha256 = Sha256OfText(network.bytes);
  if (sha256 != head.NetworkSha256() && !ComputesTheSame(network, head)) {
    throw InputError(fmt::format(
        "{}: is another network (SHA-256 {}) than that of {} ({}); expected that one, or a head "
        "that was trained on this one (make train-head)",
        network.name, sha256, files.at("head").string(), head.NetworkSha256()));
  }
  const std::vector<FrameImage> images = FrameImages(sequence, files.at("dataset"), sequence_file);
  std::map<int, const FrameImage*> image_of_frame;  // by index
  std::vector<fs::path> inputs = {sequence_file, files.at("network"), files.at("head")};
  for (const FrameImage& image : images) {
    image_of_frame[static_cast<int>(image.frame - sequence.frames.data())] = &image;
    inputs.push_back(image.path);
  }

  // Detections of frames with images and of labels that the head knows, frame by frame.
  std::map<int, std::vector<const Detection*>> by_frame;
  std::set<std::string> unknown;
  for (const Detection& detection : sequence.detections) {
    const std::string& label = sequence.ObjectOf(detection).label;
    if (!head.FindGroup(label)) {
      unknown.insert(label);
    } else if (image_of_frame.contains(detection.frame_index)) {
      by_frame[detection.frame_index].push_back(&detection);
    }
  }
  std::vector<std::vector<const Detection*>> frames;
  size_t count = 0;
  for (auto& [frame, detections] : by_frame) {
    count += detections.size();
    frames.push_back(std::move(detections));
  }

  // Each worker has its own network, which OpenCV runs on one thread, so that the result does not
  // depend on the number of workers.
  const int opencv_threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const FrameImageReader reader(sequence);
  std::vector<std::vector<AppearanceRecord>> records(frames.size());
  Progress progress("boxes", static_cast<int>(count));
  ParallelFor(static_cast<size_t>(threads), threads, [&](size_t worker) {
    if (worker >= frames.size()) return;
    InnerLayers layers(network.bytes, network.name, head.Layers(), head.IsRgb());
    for (size_t i = worker; i < frames.size(); i += static_cast<size_t>(threads)) {
      const cv::Mat image =
          reader.Read(*image_of_frame.at(frames[i].front()->frame_index), cv::IMREAD_COLOR);
      for (const Detection* detection : frames[i]) {
        const Object& object = sequence.ObjectOf(*detection);
        const Crop crop = RenderCrop(image, sequence.CameraOf(*detection), detection->box,
                                     detection->plane_in_camera.normal, head.Side());
        cv::Mat mirrored;
        cv::flip(crop.image, mirrored, /*flipCode=*/1);
        const cv::Mat features = layers.Features(crop.image);
        const cv::Mat of_mirror = layers.Features(mirrored);
        if (!cv::checkRange(features) || !cv::checkRange(of_mirror)) {
          throw InputError(
              fmt::format("{}: gives values that are not finite: a damaged file", network.name));
        }
        if (features.rows != head.Channels()) {
          throw InputError(fmt::format("{}: has {} channels in these layers; {} expects {}",
                                       network.name, features.rows, files.at("head").string(),
                                       head.Channels()));
        }
        records[i].push_back(
            {sequence.FrameOf(*detection).id, object.id,
             head.Appearance(features, of_mirror, crop.direction, *head.FindGroup(object.label)),
             head.Descriptor(features), head.Distance(features)});
        progress.Step();
      }
    }
  });
  cv::setNumThreads(opencv_threads);
  std::vector<AppearanceRecord> all;
  for (const auto& of_frame : records) all.insert(all.end(), of_frame.begin(), of_frame.end());
  WriteAppearance(files.at("output"), all, {OptionsToJson(options), inputs, {}, "appearance"});
  fmt::print("{} of {} boxes{}\n", all.size(), sequence.detections.size(),
             unknown.empty()
                 ? ""
                 : fmt::format("; the head says nothing of {}", fmt::join(unknown, ", ")));
}

}  // namespace soslam
