// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "soslam/artefact/dataset_folder.h"
#include "soslam/artefact/json_file.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/cli/command_line.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/photo_folder.h"
#include "soslam/dataset/text_file.h"
#include "soslam/image/frame_choice.h"
#include "soslam/image/image_format.h"
#include "soslam/image/read_image.h"
#include "soslam/image/tiff_file.h"
#include "soslam/image/video_file.h"
#include "soslam/model/finding.h"
#include "soslam/model/reasons.h"
#include "soslam/stage/choose_frames.h"
#include "soslam/stage/stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Number of frames that were left out, by reason.
std::map<std::string, int> CountLeftOut(const std::vector<SourceFrame>& frames) {
  std::map<std::string, int> counts;
  for (const SourceFrame& frame : frames) {
    if (frame.rejection) ++counts[NameOf(*frame.rejection)];
  }
  return counts;
}

constexpr int kFewestToJudge = 6;

bool IsMoreThanAThird(int part, int all) { return all >= kFewestToJudge && 3 * part > all; }

// The findings about the video, more than a third of the images left out for one reason, and times
// that contradict the order of more than a third of the photos.
std::vector<Finding> CheckFrames(const ChosenFrames& chosen, const std::vector<Photo>& photos) {
  const FramesRecord& record = chosen.record;
  std::vector<Finding> findings = chosen.findings;
  const int all = static_cast<int>(record.frames.size());
  const auto counts = CountLeftOut(record.frames);
  for (const auto rejection : {FrameRejection::kUnreadable, FrameRejection::kOtherSize,
                               FrameRejection::kOtherFocalLength, FrameRejection::kBlurred}) {
    const std::string name = NameOf(rejection);
    const Reason reason = ReasonOf(name);
    const auto found = counts.find(name);
    if (found == counts.end() || !IsMoreThanAThird(found->second, all)) continue;
    const bool are_raw = rejection == FrameRejection::kUnreadable &&
                         2 * std::ranges::count_if(photos, &Photo::is_raw) > found->second;
    findings.push_back(
        {"frames_" + name, Severity::kWarning,
         fmt::format("{} of {} images are left out as {}", found->second, all, name),
         "at most a third left out for one reason",
         are_raw ? "RAW photos, which are not read" : reason.cause,
         are_raw ? fmt::format("{}; nothing if these are here", kRawRemedy) : reason.remedy});
  }
  const PhotoOrder& order = chosen.order;
  if (!order.is_by_time && IsMoreThanAThird(order.steps_back, order.usable)) {
    findings.push_back(
        {"photo_order", Severity::kWarning,
         fmt::format("in the order of their names, {} of {} photos were taken before the photo "
                     "that precedes them, by their EXIF times",
                     order.steps_back, order.usable),
         "names that count in the order in which photos were taken",
         "numbers in names that do not count, or clocks that were set",
         "if the times are right, rename the photos: exiftool '-FileName<DateTimeOriginal' -d "
         "%Y%m%d_%H%M%S%%-c.%%e FOLDER"});
  }
  return findings;
}

// `focal_over_diagonal`, if known, becomes part of the file, where reconstructions look for it.
void WriteJpeg(const cv::Mat& image, int max_image_px,
               const std::optional<double>& focal_over_diagonal, const std::string& name,
               const DatasetFolder& output) {
  constexpr int kQuality = 95;
  std::vector<uchar> bytes;
  cv::imencode(".jpg", ScaledDown(image, max_image_px), bytes,
               {cv::IMWRITE_JPEG_QUALITY, kQuality});
  std::string jpeg(bytes.begin(), bytes.end());
  constexpr size_t kAfterStart = 2;
  if (focal_over_diagonal) jpeg.insert(kAfterStart, FocalLengthSegment(*focal_over_diagonal));
  output.Write(name, jpeg);
}

void WriteFramesOfVideo(const fs::path& path, const std::vector<SourceFrame>& frames,
                        int max_image_px, const DatasetFolder& output) {
  VideoReader video(path);
  for (const SourceFrame& frame : frames) {
    if (!video.Next()) throw InputError(path.string() + ": cannot be decoded a second time");
    if (IsLeftOut(frame)) continue;
    WriteJpeg(video.Image(cv::IMREAD_COLOR), max_image_px, {}, frame.image, output);
  }
}

void WritePhotos(const std::vector<Photo>& photos, const std::vector<SourceFrame>& frames,
                 const FrameOptions& options, int threads, const DatasetFolder& output) {
  ParallelFor("images", photos.size(), threads, [&](size_t i) {
    if (IsLeftOut(frames[i])) return;
    const Photo& photo = photos[i];
    const std::string& name = frames[i].image;
    if (IsCopied(photo, options)) {
      output.Write(name, ReadWholeFile(photo.path, "photo"));
    } else {
      WriteJpeg(ReadImage(photo.path, cv::IMREAD_COLOR), options.max_image_px,
                photo.header.focal_over_diagonal, name, output);
    }
  });
}

// Coordinate of a pixel after scaling; both count from the centre of the first pixel.
double Scaled(double coordinate, double scale) { return (coordinate + 0.5) * scale - 0.5; }

// The images that detectors number, in the order of their names: the row of each among the chosen
// ones, or none.
std::vector<std::optional<int>> RowsOfImages(const std::vector<SourceFrame>& frames) {
  using NameAndRow = std::pair<std::pair<std::string, std::string>, std::optional<int>>;
  std::vector<NameAndRow> named;
  int row = 0;
  for (const SourceFrame& frame : frames) {
    if (HasNameOfRawPhoto(frame.source)) continue;  // detectors read the JPEGs beside them
    named.emplace_back(OrderOfName(frame.source),
                       IsLeftOut(frame) ? std::nullopt : std::optional(row++));
  }
  // All frames of a video have one name.
  std::ranges::stable_sort(named, {}, &NameAndRow::first);
  std::vector<std::optional<int>> rows;
  for (const auto& [name, row_of_image] : named) rows.push_back(row_of_image);
  return rows;
}

// Throws InputError for a file of soslam-detect, which lists its images, of more or fewer images.
void CheckCountOfImages(const fs::path& path, size_t expected) {
  std::ifstream stream(path);
  size_t images = 0;
  for (std::string line; std::getline(stream, line) && line.starts_with('#');) {
    if (line.starts_with("# input ")) ++images;
  }
  if (images > 0 && images != expected) {
    throw InputError(
        fmt::format("{}: is of {} images; expected boxes of all {} photos or video frames: were "
                    "they detected in "
                    "images that soslam-frames had chosen? Give the network instead",
                    path.string(), images, expected));
  }
}

// The text of a detections.csv of the chosen images, from the file `path` with the boxes of all
// images, upright. Prints how many boxes there are. Throws InputError as ReadDetectionsCsv, when
// there are none, and for a file of other images.
std::string FrameBoxesText(const fs::path& path, const ChosenFrames& chosen) {
  const std::vector<std::optional<int>> rows = RowsOfImages(chosen.record.frames);
  const double scale_x = static_cast<double>(chosen.record.width) / chosen.source_size.width;
  const double scale_y = static_cast<double>(chosen.record.height) / chosen.source_size.height;
  CheckCountOfImages(path, rows.size());
  const std::vector<LabelledBox> boxes = ReadDetectionsCsv(path);
  std::vector<LabelledBox> of_chosen;
  int left_out = 0, unknown = 0;
  for (LabelledBox box : boxes) {
    const int number = std::get<int>(box.frame);
    const bool is_known = number >= 0 && number < std::ssize(rows);
    if (!is_known || !rows[number]) {
      ++(is_known ? left_out : unknown);
      continue;
    }
    box.frame = *rows[number];
    box.box = {Scaled(box.box.x_min, scale_x), Scaled(box.box.y_min, scale_y),
               Scaled(box.box.x_max, scale_x), Scaled(box.box.y_max, scale_y)};
    of_chosen.push_back(std::move(box));
  }
  if (unknown > 0 && rows.size() < chosen.record.frames.size()) {
    throw InputError(fmt::format(
        "{}: has boxes of images beyond the {} that are no RAW photos; expected `frame` to count "
        "these alone: move the {} RAW photos elsewhere, or count without them",
        path.string(), rows.size(), chosen.record.frames.size() - rows.size()));
  }
  if (of_chosen.empty()) {
    throw InputError(fmt::format(
        "{}: none of its {} boxes is of a chosen image; expected as `frame` the number of the "
        "image, from 0, in the order of their names or of the video",
        path.string(), boxes.size()));
  }
  fmt::print("{}: {} boxes of chosen images, {} of images that were left out, {} of others\n",
             path.filename().string(), of_chosen.size(), left_out, unknown);
  std::ranges::stable_sort(of_chosen, {},
                           [](const LabelledBox& box) { return std::get<int>(box.frame); });
  return fmt::format("# Written by soslam-frames from {}\n{}", OneLine(path.filename().string()),
                     LabelledBoxesText(of_chosen));
}

constexpr const char* kReadme =
    "; the next run into this folder replaces it. -->\n\n"
    "Images that were chosen from photos or a video: `rgb/`, listed in `rgb.txt` in the order\n"
    "in which they were taken; times are seconds for videos, and count from 0 for photos.\n"
    "`frames.json` says where each image comes from, and what was left out, and why. Its\n"
    "`focal_hint` is no calibration.\n";

}  // namespace

void RunFrames(const FrameOptions& options, const StageFiles& files, int threads) {
  const fs::path &images = files.at("images"), &folder = files.at("output");
  DatasetFolder output(folder, "soslam-frames");
  std::vector<Photo> photos;
  const bool is_video = !IsFolder(images);
  ChosenFrames chosen =
      is_video ? ChooseFromVideo(options, images) : ChoosePhotos(options, images, threads, &photos);
  const FramesRecord& record = chosen.record;
  const auto usable = std::ranges::count_if(record.frames, std::not_fn(IsLeftOut));
  const std::string left_out = CountsInWords(ReasonsInWords(CountLeftOut(record.frames)));
  if (usable < 2) {
    throw NothingUsableError(fmt::format(
        "{}: {} of {} images can be used ({}); expected at least 2 from different places: move the "
        "camera sideways, not only turn it",
        images.string(), usable, record.frames.size(), left_out));
  }
  const std::vector<Finding> findings = CheckFrames(chosen, photos);
  ReportFindings("frames", findings);
  fs::create_directory(output.Temporary() / "rgb");
  if (is_video) {
    WriteFramesOfVideo(images, record.frames, options.max_image_px, output);
  } else {
    WritePhotos(photos, record.frames, options, threads, output);
  }
  if (files.contains("detections")) {
    output.Write("detections.csv", FrameBoxesText(files.at("detections"), chosen));
    chosen.inputs.push_back(files.at("detections"));
  }
  output.Write("README.md", output.Mark() + kReadme);
  std::string list = "# timestamp filename\n";
  int count = 0;
  for (const SourceFrame& frame : record.frames) {
    if (IsLeftOut(frame)) continue;
    list += fmt::format("{} {}\n", frame.time_s.value_or(count), frame.image);
    ++count;
  }
  output.Write("rgb.txt", list);
  output.Write("frames.json",
               ArtefactText(folder / "frames.json", "frames",
                            {OptionsToJson(options), chosen.inputs, findings, "frames"},
                            DescribedToJson(record)));
  output.Commit();
  fmt::print(
      "{}: {} of {} images chosen, {} x {} px; left out: {}{}\n", record.name, usable,
      record.frames.size(), record.width, record.height, left_out,
      chosen.order.is_by_time ? "; in the order of their EXIF times, not of their names" : "");
}

}  // namespace soslam
