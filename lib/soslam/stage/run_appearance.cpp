// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <string>
#include <vector>

#include "soslam/appearance/head.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/base/paths.h"
#include "soslam/base/progress.h"
#include "soslam/model/occlusion.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"
#include "soslam/system/hash.h"

namespace soslam {
namespace {

NetworkFile ReadNetworkOfHead(const Head& head, const std::filesystem::path& path) {
  if (!IsFile(path)) {
    throw InputError(fmt::format(
        "{}: no such file; expected the network of {}: `./soslam network` fetches YOLOX-nano, and "
        "`--network FILE` is for where it lies",
        path.string(), head.path()));
  }
  NetworkFile network = ReadNetworkFile(path);
  if (!IsNetworkOf(network, head)) {
    throw InputError(fmt::format(
        "{}: is another network (SHA-256 {}) than that of {} ({}); expected that one, or a head "
        "that was trained on this one (make train-head)",
        network.name, Sha256OfText(network.bytes), head.path(), head.NetworkSha256()));
  }
  return network;
}

// An image with the detections in it that are of labels that a head knows.
struct ImageOfDetections {
  const FrameImage* image;
  std::vector<const Detection*> detections;
};

}  // namespace

void RunAppearance(const NoOptions& options, const StageFiles& files, int threads) {
  const std::filesystem::path& sequence_file = files.at("sequence");
  const Sequence sequence = ReadSequence(sequence_file);
  const Head head(files.at("head"));
  const NetworkFile network = ReadNetworkOfHead(head, files.at("network"));
  const std::vector<FrameImage> images = FrameImages(sequence, files.at("dataset"), sequence_file);
  std::vector<std::filesystem::path> inputs = {sequence_file, files.at("network"),
                                               files.at("head")};
  std::set<std::string> unknown;
  for (const Detection& detection : sequence.detections) {
    const std::string& label = sequence.ObjectOf(detection).label;
    if (!head.FindGroup(label)) unknown.insert(label);
  }
  std::vector<ImageOfDetections> frames;
  size_t count = 0;
  for (const FrameImage& image : images) {
    inputs.push_back(image.path);
    ImageOfDetections frame{&image, {}};
    const auto index = static_cast<int>(image.frame - sequence.frames.data());
    for (const Detection& detection : DetectionsIn(sequence, index)) {
      if (!head.FindGroup(sequence.ObjectOf(detection).label)) continue;
      frame.detections.push_back(&detection);
    }
    count += frame.detections.size();
    if (!frame.detections.empty()) frames.push_back(std::move(frame));
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
    InnerLayers layers = LoadLayers(network, head);
    for (size_t i = worker; i < frames.size(); i += static_cast<size_t>(threads)) {
      const cv::Mat image = reader.Read(*frames[i].image, cv::IMREAD_COLOR);
      for (const Detection* detection : frames[i].detections) {
        records[i].push_back(MakeAppearanceRecord(sequence, *detection, image, head, &layers));
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
