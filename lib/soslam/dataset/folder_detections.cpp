// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <variant>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/class_names.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/kitti_label.h"
#include "soslam/dataset/soslam_folder.h"
#include "soslam/dataset/yolo_boxes.h"
#include "soslam/image/distort_pixels.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Reads a file of one class, or a folder with one folder per class, each with one file.
std::vector<LabelledBox> ReadKittiClasses(const fs::path& path) {
  if (!IsFolder(path)) return ReadKittiBoxes(path);
  std::vector<LabelledBox> boxes;
  for (const fs::path& class_folder : FolderEntries(path)) {
    if (!IsFolder(class_folder)) continue;
    const std::vector<fs::path> files = FolderEntries(class_folder);
    if (files.size() != 1) {
      throw InputError(fmt::format("{}: has {} files; expected one, that of this sequence",
                                   class_folder.string(), files.size()));
    }
    const std::vector<LabelledBox> of_class = ReadKittiBoxes(files.front());
    boxes.insert(boxes.end(), of_class.begin(), of_class.end());
  }
  return boxes;
}

// Prints that class numbers without names are taken as COCO's, with the labels that this gives.
void PrintAssumedLabels(const std::vector<LabelledBox>& boxes, const fs::path& file) {
  if (boxes.empty()) return;
  std::set<std::string> labels;
  for (const LabelledBox& box : boxes) labels.insert(box.label);
  fmt::print(
      "{}: has no names of its classes; takes COCO's 80, of which {} occur, {}; class_names gives "
      "others\n",
      file.filename().string(), labels.size(), fmt::join(labels, ", "));
}

FolderBoxes ReadCocoBoxes(const DatasetFiles& files) {
  FolderBoxes boxes = ReadCocoResults(files.detections, files.class_names);
  if (!boxes.class_names.empty()) PrintAssumedLabels(boxes.boxes, files.detections);
  const auto oblique = std::ranges::count_if(boxes.boxes, [](const LabelledBox& box) {
    return box.as_drawn && box.as_drawn->IsOblique();
  });
  if (oblique > 0) {
    boxes.findings.push_back(
        {"oblique_boxes", Severity::kWarning,
         fmt::format("{}: {} of {} boxes are drawn at an angle, and replaced by the upright boxes "
                     "around them",
                     files.detections.filename().string(), oblique, boxes.boxes.size()),
         "upright boxes, whose edges touch the object", "rotated rectangles of an annotation tool",
         "draw these boxes upright: those around rotated ones are larger than their objects"});
  }
  return boxes;
}

}  // namespace

FolderBoxes ReadFolderBoxes(const fs::path& folder, const ImportOptions& options,
                            const Camera& camera, DatasetFiles* files) {
  const fs::path& path = files->detections;
  const DetectionsFormat format = options.folder.detections_format;
  if (format == DetectionsFormat::kCsv) return {ReadDetectionsCsv(path)};
  if (format == DetectionsFormat::kKitti) return {ReadKittiClasses(path)};
  if (format == DetectionsFormat::kCoco) return ReadCocoBoxes(*files);
  FolderBoxes read;
  const bool is_oa_slam = format == DetectionsFormat::kOaSlam;
  const YoloTexts texts = is_oa_slam ? YoloTexts() : ReadYoloTexts(path);
  if (files->class_names) {
    read.class_names = ReadLabelFile(*files->class_names);
  } else if (!is_oa_slam) {
    // Names among the labels or around them.
    std::vector<ClassNames> lists = texts.names;
    for (const fs::path& file : FindLabelFiles(path, folder)) {
      lists.push_back(FindLabels(file, [&] { return ReadWholeFile(file); }));
    }
    if (const auto nearest = NearestNames(std::move(lists), &read.findings)) {
      read.class_names = nearest->names;
      if (IsFile(nearest->place)) files->class_names = nearest->place;
      fmt::print("{}: names of {} classes, {}\n", nearest->place.string(), nearest->names.size(),
                 fmt::join(nearest->names, ", "));
    }
  }
  const bool has_names = !read.class_names.empty();
  if (!has_names) read.class_names = CocoLabels();
  if (is_oa_slam) {
    read.boxes = ReadOaSlamBoxes(path, read.class_names);
  } else if (format == DetectionsFormat::kYoloPixels) {
    read.boxes = ReadPixelYoloBoxes(texts, read.class_names);
  } else {
    read.boxes = ReadNormalisedYoloBoxes(texts, read.class_names, camera.width, camera.height,
                                         &read.corrected);
  }
  if (!has_names) PrintAssumedLabels(read.boxes, path);
  return read;
}

std::vector<DetectionRow> RowsWithoutObject(const std::vector<LabelledBox>& boxes,
                                            const std::vector<ListedImage>& images) {
  FrameLookup lookup(images);
  std::vector<DetectionRow> rows;
  for (const LabelledBox& box : boxes) {
    const auto frame = lookup.Find(box.frame, box.place);
    if (frame) rows.push_back({box.place, *frame, kNoObject, box.label, box.score, box.box});
  }
  return rows;
}

namespace {

// The likely meaning of the numbers of images, other than rows, as the end of a message.
std::string LikelyNumbers(const std::vector<LabelledBox>& boxes, const fs::path& file, int images) {
  const bool count_from_one = std::ranges::all_of(boxes, [&](const LabelledBox& box) {
    const int* number = std::get_if<int>(&box.frame);
    return number == nullptr || (*number >= 1 && *number <= images);
  });
  const bool is_coco = file.extension() == ".json";
  return fmt::format("{}{}", count_from_one ? ": are images counted from 1? Subtract 1" : "",
                     is_coco ? "; ids of a COCO file are read with that file as class_names" : "");
}

}  // namespace

std::vector<DetectionRow> RowsOfBoxes(const std::vector<LabelledBox>& boxes,
                                      const DatasetFiles& files,
                                      const std::vector<ListedImage>& images,
                                      std::int64_t first_free_id, RejectionCounts* rejected) {
  FrameLookup lookup(images);
  const std::string list = files.images.value_or(files.detections).filename().string();
  const auto last_id = first_free_id + static_cast<std::int64_t>(boxes.size()) - 1;
  constexpr int kLargestId = std::numeric_limits<int>::max();
  if (!HaveObjectIds(boxes) && last_id > kLargestId) {
    throw InputError(fmt::format(
        "{}: has {} boxes without ids, which get ids above the {} of {}; expected ids in that file "
        "that leave room for them below {}",
        files.detections.string(), boxes.size(), first_free_id - 1,
        files.objects.value_or("objects.json").filename().string(), kLargestId));
  }
  std::vector<DetectionRow> rows;
  for (size_t i = 0; i < boxes.size(); ++i) {
    const LabelledBox& box = boxes[i];
    const auto frame = lookup.Find(box.frame, box.place);
    if (const int* row = std::get_if<int>(&box.frame); row != nullptr && !frame) {
      throw InputError(
          fmt::format("{}: frame is {}; expected a row of {}, 0 to {}{}", box.place, *row, list,
                      images.size() - 1,
                      LikelyNumbers(boxes, files.detections, static_cast<int>(images.size()))));
    }
    if (!frame) continue;
    const int object_id = box.object_id
                              ? *box.object_id
                              : static_cast<int>(first_free_id + static_cast<std::int64_t>(i));
    rows.push_back({box.place, *frame, object_id, box.label, box.score, box.box});
    rows.back().image_size = box.image_size;
    rows.back().as_drawn = box.as_drawn;
  }
  if (const size_t other_names = lookup.CountOtherNames(); other_names > 0) {
    fmt::print(
        "{}: {} images are found by names with another ending, or of copies, as Roboflow and Label "
        "Studio write them; their boxes have to be those of the whole images, neither cropped nor "
        "padded\n",
        files.detections.filename().string(), other_names);
  }
  const size_t unlisted = boxes.size() - rows.size();
  if (unlisted == 0) return rows;
  if (rows.empty()) {
    throw InputError(fmt::format(
        "{}: image '{}' is not listed, nor that of any other box; expected images of {}",
        boxes.front().place, std::get<std::string>(boxes.front().frame), list));
  }
  (*rejected)[NameOf(RejectReason::kFrameNotListed)] += static_cast<int>(unlisted);
  fmt::print("{}: {} of {} detections are of listed images\n", files.detections.filename().string(),
             rows.size(), boxes.size());
  return rows;
}

std::vector<DetectionRow> Undistorted(std::vector<DetectionRow> rows, const Camera& camera,
                                      const Distortion& distortion, RejectionCounts* rejected) {
  std::vector<DetectionRow> undistorted;
  for (DetectionRow& row : rows) {
    const auto box = UndistortBox(camera, distortion, row.box);
    if (!box) {
      ++(*rejected)[NameOf(RejectReason::kBeyondLensModel)];
      continue;
    }
    row.box_in_image_file = row.box;
    row.box = *box;
    undistorted.push_back(std::move(row));
  }
  return undistorted;
}

}  // namespace soslam
