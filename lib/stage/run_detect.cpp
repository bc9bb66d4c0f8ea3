// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_detect.h"

#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <string>
#include <vector>

#include "artefact/atomic_file.h"
#include "artefact/json_file.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "dataset/class_names.h"
#include "dataset/image_path.h"
#include "dataset/labelled_box.h"
#include "dataset/trajectories.h"
#include "image/read_image.h"
#include "image/yolo_detector.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> ImagePaths(const fs::path& dataset) {
  const fs::path list = dataset / "rgb.txt";
  std::vector<fs::path> images;
  for (const ListedImage& image : ReadImageList(list)) {
    images.push_back(ImagePath(dataset, image.image, list.string()));
  }
  return images;
}

// The detections of each image. Each worker has its own network, which OpenCV runs on one thread,
// so that the result does not depend on the number of workers.
std::vector<std::vector<YoloDetection>> DetectAll(const std::vector<fs::path>& images,
                                                  const fs::path& network, int classes,
                                                  const DetectorOptions& options, int threads) {
  const int count = static_cast<int>(images.size());
  const int workers = std::min(threads, count);
  std::vector<std::vector<YoloDetection>> detections(images.size());
  Progress progress("images", count);
  ParallelFor(workers, workers, [&](int worker) {
    YoloDetector detector(network, classes, options);
    for (int i = worker; i < count; i += workers) {
      const auto frame = static_cast<size_t>(i);
      detections[frame] =
          detector.Detect(ReadColourImage(images[frame], options.image_orientation));
      progress.Step();
    }
  });
  return detections;
}

std::vector<LabelledBox> WithLabels(const std::vector<std::vector<YoloDetection>>& detections,
                                    const std::vector<std::string>& labels) {
  std::vector<LabelledBox> boxes;
  for (size_t frame = 0; frame < detections.size(); ++frame) {
    for (const YoloDetection& detection : detections[frame]) {
      boxes.push_back({"", static_cast<int>(frame),
                       labels[static_cast<size_t>(detection.class_index)], detection.score,
                       detection.box});
    }
  }
  return boxes;
}

// The artefact header as comments: one line, then one per input.
std::string Comments(const ArtefactInfo& info) {
  nlohmann::json header = ArtefactHeader("detections", info);
  const nlohmann::json inputs = header["inputs"];
  header.erase("inputs");
  std::string text = fmt::format("# {}\n", header.dump());
  for (const nlohmann::json& input : inputs) text += fmt::format("# input {}\n", input.dump());
  return text;
}

}  // namespace

void RunDetect(const DetectorOptions& options, const StageFiles& files, int threads) {
  const fs::path& dataset = files.at("dataset");
  const fs::path& network = files.at("network");
  const bool has_labels = files.count("labels") > 0;
  const auto labels = has_labels ? ReadLabelFile(files.at("labels")) : CocoLabels();
  const std::vector<fs::path> images = ImagePaths(dataset);
  CheckNetworkRuns(network, static_cast<int>(labels.size()), options);
  const auto boxes = WithLabels(
      DetectAll(images, network, static_cast<int>(labels.size()), options, threads), labels);
  if (boxes.empty()) {
    throw NothingUsableError(fmt::format(
        "{}: nothing was detected in {} images with a score of at least {}; do pixel_values and "
        "the labels suit the network?",
        network.string(), images.size(), options.min_score));
  }
  std::vector<fs::path> inputs = images;
  inputs.insert(inputs.end(), {dataset / "rgb.txt", network});
  if (has_labels) inputs.push_back(files.at("labels"));
  WriteTextFile(files.at("output"),
                Comments({OptionsToJson(options), inputs}) + LabelledBoxesText(boxes));
  fmt::print("{}: {} images, {} detections\n", dataset.string(), images.size(), boxes.size());
}

}  // namespace soslam
