// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/base/progress.h"
#include "soslam/base/text.h"
#include "soslam/dataset/class_names.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/image/detector.h"
#include "soslam/image/detector_options.h"
#include "soslam/image/image_turn.h"
#include "soslam/image/read_image.h"
#include "soslam/model/image_turns.h"
#include "soslam/model/label_groups.h"
#include "soslam/planes/turn_evidence.h"
#include "soslam/stage/stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Throws SettingsError if no class has this label, which an option names.
void CheckIsClass(const std::string& label, const std::vector<std::string>& classes,
                  const char* option) {
  if (std::ranges::find(classes, label) != classes.end()) return;
  throw SettingsError(fmt::format("{} has '{}'; expected labels of the network: {}", option, label,
                                  fmt::join(classes, ", ")));
}

}  // namespace

DetectorLabels LabelsForDetector(std::vector<std::string> classes, const DetectorOptions& options) {
  DetectorLabels labels;
  std::map<std::string, std::string> renames;
  if (!Trimmed(options.rename_labels).empty()) {
    for (const std::string_view field : SplitFields(options.rename_labels)) {
      const size_t equals = std::min(field.find('='), field.size());
      const std::string from{Trimmed(field.substr(0, equals))};
      const std::string to{Trimmed(field.substr(std::min(equals + 1, field.size())))};
      if (from.empty() || to.empty() || !renames.emplace(from, to).second) {
        throw SettingsError(fmt::format(
            "rename_labels has '{}'; expected 'tv=monitor, couch=sofa', each label once", field));
      }
    }
  }
  for (const auto& [from, to] : renames) CheckIsClass(from, classes, "rename_labels");
  for (std::string& label : classes) {
    if (const auto found = renames.find(label); found != renames.end()) label = found->second;
  }
  if (!Trimmed(options.keep_labels).empty()) {
    for (const std::string_view label : SplitFields(options.keep_labels)) {
      CheckIsClass(std::string(label), classes, "keep_labels");
    }
  }
  const LabelGroups groups(options.interchangeable_labels);
  std::map<std::string, int> indices;
  for (const std::string& label : classes) {
    labels.are_kept.push_back(IsListed(label, options.keep_labels));
    const std::string& group = options.class_agnostic ? "" : groups.Group(label);
    labels.groups.push_back(indices.emplace(group, indices.size()).first->second);
  }
  labels.names = std::move(classes);
  return labels;
}

namespace {

// The detections of each image, and the number of all boxes that were found. Each worker has its
// own network, which runs on one thread, so that the result does not depend on the number of
// workers.
struct AllDetections {
  std::vector<std::vector<NetworkDetection>> of_image;
  BoxTally tally;
};
AllDetections DetectAll(const std::vector<fs::path>& images, const NetworkFile& network,
                        const NetworkFormat& format, const DetectorLabels& labels,
                        const DetectorOptions& options, ImageOrientation orientation,
                        const ImageTurn& turn, int threads) {
  const int count = static_cast<int>(images.size());
  const int workers = std::min(threads, count);
  AllDetections all{std::vector<std::vector<NetworkDetection>>(images.size()), {}};
  std::vector<BoxTally> tallies(static_cast<size_t>(workers));
  Progress progress("images", count);
  ParallelFor(workers, workers, [&](int worker) {
    Detector detector(network, format, labels.groups, options);
    for (int i = worker; i < count; i += workers) {
      const cv::Mat image = Turned(ReadImage(images[i], cv::IMREAD_COLOR, orientation), turn);
      all.of_image[i] = detector.Detect(image);
      for (NetworkDetection& detection : all.of_image[i]) {
        detection.box = Turned(detection.box, {image.cols, image.rows}, turn.Inverse());
      }
      progress.Step();
    }
    tallies[worker] = detector.tally();
  });
  for (const BoxTally& tally : tallies) all.tally += tally;
  return all;
}

double SumOfScores(const std::vector<NetworkDetection>& detections) {
  double sum = 0.0;
  for (const NetworkDetection& detection : detections) sum += detection.score;
  return sum;
}

using DetectIn =
    std::function<AllDetections(const std::vector<fs::path>& images, ImageOrientation orientation)>;

// The detections in pixels of images in `orientation`; kSurer becomes the one that they were found
// in. Networks want upright images, but EXIF may be wrong, as where the camera looked down: they
// see the images that it turns in both orientations, and the one in which they are surer of these
// together counts.
AllDetections DetectInBoth(const std::vector<fs::path>& images, const DetectIn& detect,
                           BoxOrientation* orientation) {
  AllDetections all = detect(images, ImageOrientation::kUpright);
  std::vector<fs::path> turned;
  std::vector<std::vector<NetworkDetection>*> detections;
  double sum = 0.0;
  for (size_t i = 0; i < images.size(); ++i) {
    if (ReadImageHeader(images[i]).value().orientation == 1) continue;
    turned.push_back(images[i]);
    detections.push_back(&all.of_image[i]);
    sum += SumOfScores(all.of_image[i]);
  }
  AllDetections stored;
  if (!turned.empty()) stored = detect(turned, ImageOrientation::kStored);
  for (const auto& of_image : stored.of_image) sum -= SumOfScores(of_image);
  const bool is_stored = sum < 0.0;
  const auto found_in = is_stored ? BoxOrientation::kStored : BoxOrientation::kUpright;
  if (*orientation == BoxOrientation::kSurer) *orientation = found_in;
  for (size_t i = 0; i < turned.size(); ++i) {
    if (is_stored) *detections[i] = stored.of_image[i];
    if (*orientation == found_in) continue;
    const ImageHeader header = ReadImageHeader(turned[i]).value();
    const ImageTurn turn = ExifTurn(header.orientation);
    for (NetworkDetection& detection : *detections[i]) {
      detection.box = is_stored ? Turned(detection.box, header.stored, turn)
                                : Turned(detection.box, header.Size(ImageOrientation::kUpright),
                                         turn.Inverse());
    }
  }
  return all;
}

// Detections in some images as they are and turned by quarters.
ImageTurns SeenInTurns(const std::vector<ListedImage>& listed, const std::vector<fs::path>& paths,
                       const std::function<AllDetections(const std::vector<fs::path>& images,
                                                         const ImageTurn& turn)>& detect) {
  constexpr size_t kImages = 10;
  ImageTurns turns;
  std::vector<int> all(paths.size());
  std::iota(all.begin(), all.end(), 0);
  std::vector<fs::path> seen;
  for (const int i : SpreadOver(all, kImages)) {
    turns.images.push_back({listed[i].image, {}});
    seen.push_back(paths[i]);
  }
  for (size_t turn = 0; turn < kQuarterTurns; ++turn) {
    const AllDetections found = detect(seen, QuarterTurn(static_cast<int>(turn)));
    for (size_t i = 0; i < seen.size(); ++i) {
      turns.images[i].scores[turn] = SumOfScores(found.of_image[i]);
    }
  }
  ChooseTurn(&turns);
  return turns;
}

// The artefact header as comments: one line, then one per input.
std::string Comments(const ArtefactInfo& info, NetworkBackend backend) {
  nlohmann::json header = ArtefactHeader("detections", info);
  header["backend"] = BackendVersion(backend);
  const nlohmann::json inputs = header["inputs"];
  header.erase("inputs");
  std::string text = fmt::format("# {}\n", JsonText(header));
  for (const nlohmann::json& input : inputs) text += fmt::format("# input {}\n", JsonText(input));
  return text;
}

// The class names in the metadata of a network, from class 0 on, as Ultralytics writes them in
// Python's notation, which is also YAML unless it escapes characters.
std::vector<std::string> NamesIn(const NetworkFile& network) {
  const auto names = network.header.metadata.find("names");
  if (names == network.header.metadata.end()) return CocoLabels();
  const std::string& text = names->second;
  try {
    if (!text.starts_with('{') && !text.starts_with('[')) throw InputError("is one name");
    if (text.find('\\') != text.npos) throw InputError("has an escaped character");
    return ParseLabels("names: " + text, "names.yaml");
  } catch (const InputError&) {
    constexpr size_t kShown = 100;
    throw InputError(
        fmt::format("{}: its class names are '{}'; expected {{0: 'cup', 1: 'book', ...}}, no name "
                    "with a comma (--labels FILE gives others)",
                    network.name, text.substr(0, kShown)));
  }
}

// The boxes with labels that are kept. Throws NothingUsableError if there are none.
std::vector<LabelledBox> KeptBoxes(const AllDetections& all, const DetectorLabels& labels,
                                   const DetectorOptions& options, const NetworkFile& network,
                                   const NetworkFormat& format) {
  std::vector<LabelledBox> boxes;
  for (size_t i = 0; i < all.of_image.size(); ++i) {
    for (const NetworkDetection& found : all.of_image[i]) {
      const int index = found.class_index;
      if (!labels.are_kept[index]) continue;
      boxes.push_back({"", static_cast<int>(i), labels.names[index], found.score, found.box});
    }
  }
  if (!boxes.empty()) return boxes;
  throw NothingUsableError(fmt::format(
      "{}: nothing was detected in {} images with a score of at least {}{}; taken for {}: do "
      "these and the labels suit the network?",
      network.name, all.of_image.size(), options.min_score,
      all.tally.boxes > 0 ? fmt::format(" ({} boxes of labels that are not kept)", all.tally.boxes)
                          : "",
      format.Text()));
}

}  // namespace

void RunDetect(const DetectorOptions& options, const StageFiles& files, int threads) {
  const fs::path& dataset = files.at("dataset");
  const NetworkFile network = ReadNetworkFile(files.at("network"), options.backend);
  const DetectorLabels labels = LabelsForDetector(
      files.contains("labels") ? ReadLabelFile(files.at("labels")) : NamesIn(network), options);
  const fs::path list = dataset / "rgb.txt";
  const std::vector<ListedImage> listed = ReadImageList(list);
  std::vector<fs::path> images;
  for (const ListedImage& image : listed) {
    images.push_back(ImagePath(dataset, image.image, list.string()));
  }
  const cv::Size size = ReadImage(images.front(), cv::IMREAD_COLOR).size();
  const auto format_of = [&](const ImageTurn& turn) {
    return FindFormat(network, static_cast<int>(labels.names.size()), options,
                      turn.swaps_axes ? cv::Size(size.height, size.width) : size);
  };
  ImageTurns turns;
  if (files.contains("turns")) {
    turns =
        SeenInTurns(listed, images, [&](const std::vector<fs::path>& some, const ImageTurn& turn) {
          return DetectAll(some, network, format_of(turn), labels, options,
                           ImageOrientation::kUpright, turn, threads);
        });
  }
  const ImageTurn upright = QuarterTurn(turns.upright_turn_deg / 90);
  const NetworkFormat format = format_of(upright);
  const auto detect = [&](const std::vector<fs::path>& some, ImageOrientation orientation) {
    return DetectAll(some, network, format, labels, options, orientation, upright, threads);
  };
  // The values found in place of "auto" and "surer", which give the same result again.
  DetectorOptions found = options;
  const AllDetections all = DetectInBoth(images, detect, &found.image_orientation);
  CheckBoxesArePossible(all.tally, format, network.name);
  const std::vector<LabelledBox> boxes = KeptBoxes(all, labels, options, network, format);
  std::vector<fs::path> inputs = images;
  inputs.insert(inputs.end(), {list, files.at("network")});
  if (files.contains("labels")) inputs.push_back(files.at("labels"));
  found.output_layout = format.layout;
  found.pixel_values = format.pixel_values;
  found.input_width = format.input.width;
  found.input_height = format.input.height;
  const ArtefactInfo info = {OptionsToJson(found), inputs, {}, "detect"};
  WriteTextFile(files.at("output"), Comments(info, options.backend) + LabelledBoxesText(boxes));
  if (files.contains("turns")) WriteTurns(files.at("turns"), turns, info);
  fmt::print("{}: {}\n{}: {} images{}, {} detections\n", network.name, format.Text(),
             dataset.string(), images.size(),
             turns.upright_turn_deg == 0
                 ? ""
                 : fmt::format(" turned clockwise by {} degrees, in which they are upright with a "
                               "probability of {:.3f}",
                               turns.upright_turn_deg, turns.probability),
             boxes.size());
}

}  // namespace soslam
