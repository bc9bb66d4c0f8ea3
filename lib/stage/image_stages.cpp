// SPDX-License-Identifier: BSD-3-Clause
#include "stage/image_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <string>
#include <vector>

#include "artefact/atomic_file.h"
#include "artefact/hdf5_artefact.h"
#include "artefact/json_file.h"
#include "artefact/sequence_file.h"
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

std::vector<FrameImage> FrameImages(const Sequence& sequence, const StageFiles& files) {
  std::vector<FrameImage> images;
  for (const Frame& frame : sequence.frames) {
    if (frame.image.empty()) continue;
    images.push_back(
        {&frame, ImagePath(files.at("dataset"), frame.image,
                           fmt::format("{}: frame {}", files.at("sequence").string(), frame.id))});
  }
  if (images.empty()) {
    throw NothingUsableError(
        fmt::format("{}: none of its {} frames has an image; expected at least one",
                    files.at("sequence").string(), sequence.frames.size()));
  }
  return images;
}

FrameImageReader::FrameImageReader(const Sequence& sequence) : sequence_(sequence) {
  if (sequence.image_distortion) undistorter_.emplace(sequence.camera, *sequence.image_distortion);
}

cv::Mat FrameImageReader::ReadGrey(const FrameImage& image) const {
  const Camera& camera = sequence_.CameraOf(*image.frame);
  const cv::Mat grey =
      ReadGreyImage(image.path, camera.width, camera.height, sequence_.image_orientation);
  return undistorter_ ? undistorter_->Undistort(grey) : grey;
}

cv::Mat FrameImageReader::ReadColour(const FrameImage& image) const {
  const Camera& camera = sequence_.CameraOf(*image.frame);
  const cv::Mat colour =
      ReadColourImage(image.path, camera.width, camera.height, sequence_.image_orientation);
  return undistorter_ ? undistorter_->Undistort(colour) : colour;
}

namespace {

namespace fs = std::filesystem;

// Checks the image size, as nearest edges are stored as 16-bit coordinates.
void CheckCamera(const Camera& camera, const fs::path& sequence_file) {
  constexpr int kMaxSide = std::numeric_limits<std::int16_t>::max();
  if (std::max(camera.width, camera.height) > kMaxSide) {
    throw InputError(fmt::format("{}: camera is {} x {} pixels; expected at most {} a side",
                                 sequence_file.string(), camera.width, camera.height, kMaxSide));
  }
}

}  // namespace

void RunEdges(const EdgesOptions& options, const StageFiles& files, int threads) {
  options.Check();
  const fs::path& sequence_file = files.at("sequence");
  const Sequence sequence = ReadSequence(sequence_file, PlaneNeed::kNotNeeded);
  const std::vector<FrameImage> images = FrameImages(sequence, files);
  std::vector<fs::path> inputs = {sequence_file};
  for (const FrameImage& image : images) {
    CheckCamera(sequence.CameraOf(*image.frame), sequence_file);
    inputs.push_back(image.path);
  }
  EdgesWriter writer(files.at("output"), {OptionsToJson(options), inputs});

  const FrameImageReader reader(sequence);
  const int frames = static_cast<int>(images.size());
  Progress progress("frames", frames);
  const int batch = 4 * threads;  // limits the maps in memory that wait to be written
  for (int begin = 0; begin < frames; begin += batch) {
    std::vector<EdgeMaps> maps(static_cast<size_t>(std::min(batch, frames - begin)));
    ParallelFor(static_cast<int>(maps.size()), threads, [&](int i) {
      const cv::Mat grey = reader.ReadGrey(images[static_cast<size_t>(begin + i)]);
      maps[static_cast<size_t>(i)] = ComputeEdgeMaps(grey, options);
      progress.Step();
    });
    for (size_t i = 0; i < maps.size(); ++i) {
      writer.Write(images[static_cast<size_t>(begin) + i].frame->id, maps[i]);
    }
  }
  writer.Commit();
  if (images.size() < sequence.frames.size()) {
    fmt::print("{} of {} frames have an image\n", images.size(), sequence.frames.size());
  }
}

namespace {

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
