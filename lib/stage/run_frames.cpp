// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/core/types.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "artefact/dataset_folder.h"
#include "base/error.h"
#include "base/parallel.h"
#include "base/paths.h"
#include "base/progress.h"
#include "base/text.h"
#include "cli/command_line.h"
#include "dataset/labelled_box.h"
#include "dataset/photo_folder.h"
#include "dataset/text_file.h"
#include "image/frame_choice.h"
#include "image/read_image.h"
#include "image/tiff_file.h"
#include "image/video_file.h"
#include "model/finding.h"
#include "stage/stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Frames with what they were chosen from.
struct ChosenFrames {
  FramesRecord record;
  cv::Size source_size;  // of the images that were chosen from, upright
  std::vector<fs::path> inputs;
  bool is_cut_short = false;  // the video has fewer frames than it announces
};

bool IsLeftOut(const SourceFrame& frame) { return frame.rejection.has_value(); }

// First line of detections.csv.
constexpr std::string_view kFrameBoxesMark = "# Written by soslam-frames";

// The likely cause and the remedy where much is left out for one reason.
struct FrameAdvice {
  FrameRejection reason;
  const char* cause;
  const char* remedy;
};
constexpr std::array kAdvice = {
    FrameAdvice{FrameRejection::kUnreadable, "files of another format, or copied incompletely",
                "convert them to JPEG, or copy them again"},
    FrameAdvice{FrameRejection::kOtherSize,
                "photos of several cameras, or upright ones among others",
                "take all photos with one camera that is held in one way"},
    FrameAdvice{FrameRejection::kOtherFocalLength, "a zoom, or several lenses of one telephone",
                "take all photos with one lens, without zoom"},
    FrameAdvice{FrameRejection::kBlurred, "a camera that moved while the image was taken",
                "move more slowly, with more light; or lower min_sharpness"}};

// Coordinate of a pixel after scaling; both count from the centre of the first pixel.
double Scaled(double coordinate, double scale) { return (coordinate + 0.5) * scale - 0.5; }

// Boxes of soslam-detect name their images, which are all of the frames.
void RefuseBoxesOfOtherImages(const fs::path& path, size_t frames) {
  std::ifstream stream(path);
  size_t images = 0;
  for (std::string line; std::getline(stream, line) && line.starts_with('#');) {
    if (line.starts_with("# input ")) ++images;
  }
  if (images == 0 || images == frames) return;
  throw InputError(fmt::format(
      "{}: is of {} images; expected boxes of all {} photos or video frames: were they detected in "
      "images that soslam-frames had chosen? Give the network instead",
      path.string(), images, frames));
}

// Number of frames that were left out, by reason.
std::map<std::string, int> CountLeftOut(const std::vector<SourceFrame>& frames) {
  std::map<std::string, int> counts;
  for (const SourceFrame& frame : frames) {
    if (frame.rejection) ++counts[kFrameRejectionNames[static_cast<size_t>(*frame.rejection)]];
  }
  return counts;
}

// Finds more than a third of the images left out for one reason, and a video that was cut short.
std::vector<Finding> CheckFrames(const ChosenFrames& chosen) {
  constexpr int kFewest = 6;
  const FramesRecord& record = chosen.record;
  std::vector<Finding> findings;
  const int all = static_cast<int>(record.frames.size());
  const auto counts = CountLeftOut(record.frames);
  for (const FrameAdvice& advice : kAdvice) {
    const std::string name = kFrameRejectionNames[static_cast<size_t>(advice.reason)];
    const auto found = counts.find(name);
    if (found == counts.end() || all < kFewest || 3 * found->second <= all) continue;
    findings.push_back({"frames_" + name, Severity::kWarning,
                        fmt::format("{} of {} images are left out as {}", found->second, all, name),
                        "at most a third left out for one reason", advice.cause, advice.remedy});
  }
  if (chosen.is_cut_short) {
    findings.push_back(
        {"video_cut_short", Severity::kWarning,
         fmt::format("{}: {} frames can be decoded, fewer than it announces", record.name, all),
         "all frames", "a file that was copied or recorded incompletely", "copy it again"});
  }
  return findings;
}

// The text of rgb.txt. Times are those of the video; photos are numbered.
std::string FrameListText(const std::vector<SourceFrame>& frames) {
  std::string text = "# timestamp filename\n";
  int count = 0;
  for (const SourceFrame& frame : frames) {
    if (IsLeftOut(frame)) continue;
    text += fmt::format("{} {}\n", frame.time_s.value_or(count), frame.image);
    ++count;
  }
  return text;
}

// The text of detections.csv: the boxes of the chosen images among those of all images in the file
// `path`. Prints how many they are. Throws InputError if there are none.
std::string FrameBoxesText(const fs::path& path, const ChosenFrames& chosen) {
  std::vector<std::optional<int>> rows;
  int row = 0;
  for (const SourceFrame& frame : chosen.record.frames) {
    rows.push_back(IsLeftOut(frame) ? std::nullopt : std::optional(row++));
  }
  const double scale_x = static_cast<double>(chosen.record.width) / chosen.source_size.width;
  const double scale_y = static_cast<double>(chosen.record.height) / chosen.source_size.height;
  RefuseBoxesOfOtherImages(path, chosen.record.frames.size());
  const std::vector<LabelledBox> boxes = ReadDetectionsCsv(path);
  std::vector<LabelledBox> of_chosen;
  int left_out = 0, unknown = 0;
  for (LabelledBox box : boxes) {
    const int number = std::get<int>(box.frame);
    const bool is_known = number >= 0 && number < std::ssize(rows);
    const auto of_frame = is_known ? rows[number] : std::nullopt;
    if (!of_frame) {
      ++(is_known ? left_out : unknown);
      continue;
    }
    box.frame = *of_frame;
    box.box = {Scaled(box.box.x_min, scale_x), Scaled(box.box.y_min, scale_y),
               Scaled(box.box.x_max, scale_x), Scaled(box.box.y_max, scale_y)};
    of_chosen.push_back(std::move(box));
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
  return fmt::format("{} from {}\n{}", kFrameBoxesMark, OneLine(path.filename().string()),
                     LabelledBoxesText(of_chosen));
}

// What is in the folder beside the images.
constexpr std::array kFiles = {"README.md", "rgb.txt", "frames.json", "run.json", "timing.json"};

bool IsOwnFile(const fs::path& path) {
  const std::string name = path.filename().string();
  std::string first_line;
  if (name == "detections.csv") {
    std::ifstream stream(path);
    std::getline(stream, first_line);
  }
  return name == "rgb" || std::ranges::find(kFiles, name) != kFiles.end() ||
         first_line.starts_with(kFrameBoxesMark);
}

// Files that others put into the folder would be lost with it.
void RefuseFilesOfOthers(const fs::path& folder) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (IsOwnFile(entry.path())) continue;
    throw SettingsError(fmt::format(
        "{}: has {}, which would be lost; expected a new folder, or one with the files of "
        "soslam-frames only",
        folder.string(), entry.path().filename().string()));
  }
}

// Applies the choice to all frames that have no rejection yet; `reasons` are for these, in order.
void Reject(const std::vector<std::optional<FrameRejection>>& reasons,
            std::vector<SourceFrame>* frames) {
  auto reason = reasons.begin();
  for (SourceFrame& frame : *frames) {
    if (!IsLeftOut(frame)) frame.rejection = *reason++;
  }
}

// The stem with letters, digits and ._- only, which every program can read.
std::string PlainStem(const std::string& name) {
  std::string stem = fs::path(name).stem().string();
  for (char& character : stem) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(character)) != 0 ||
                          character == '.' || character == '-';
    if (!is_plain) character = '_';
  }
  if (stem.front() == '-') stem.front() = '_';
  return stem;
}

// Gives each chosen frame a name of its own, that of its photo where it is plain.
void NameImages(const std::vector<std::string>& extensions, std::vector<SourceFrame>* frames) {
  std::set<std::string> stems;
  for (size_t i = 0; i < frames->size(); ++i) {
    SourceFrame& frame = (*frames)[i];
    if (IsLeftOut(frame)) continue;
    const std::string plain =
        frame.frame_number ? fmt::format("{:06}", *frame.frame_number) : PlainStem(frame.source);
    std::string stem = plain;
    for (int count = 2; !stems.insert(stem).second; ++count) {
      stem = fmt::format("{}_{}", plain, count);
    }
    frame.image = "rgb/" + stem + extensions[i];
  }
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

void SetSize(int max_image_px, ChosenFrames* chosen) {
  const cv::Size size = SizeWithin(chosen->source_size, max_image_px);
  chosen->record.width = size.width;
  chosen->record.height = size.height;
}

void CheckEnough(const FramesRecord& record, const fs::path& images) {
  const auto left_out = std::ranges::count_if(record.frames, IsLeftOut);
  if (std::ssize(record.frames) - left_out >= 2) return;
  throw NothingUsableError(fmt::format(
      "{}: {} of {} images can be used ({}); expected at least 2 from different places: move the "
      "camera sideways, not only turn it",
      images.string(), std::ssize(record.frames) - left_out, record.frames.size(),
      CountsText(CountLeftOut(record.frames))));
}

// Photos.

void MeasurePhoto(const Photo& photo, SourceFrame* frame, FrameView* view) {
  try {
    *view = ViewOf(ReadGreyImage(photo.path));
    frame->sharpness = view->sharpness;
  } catch (const InputError& error) {
    const std::string message = error.what(), place = photo.path.string() + ": ";
    frame->rejection = FrameRejection::kUnreadable;
    frame->detail = OneLine(message.starts_with(place) ? message.substr(place.size()) : message);
  }
}

bool IsCopied(const Photo& photo, int max_image_px) {
  const ImageSize& size = photo.header.stored;
  return photo.header.orientation == 1 && std::max(size.width, size.height) <= max_image_px;
}

std::string ExtensionOf(const Photo& photo, int max_image_px) {
  if (!IsCopied(photo, max_image_px)) return ".jpg";
  return LowerCase(photo.path.extension().string());
}

void WritePhoto(const Photo& photo, int max_image_px, const std::string& name,
                const DatasetFolder& output) {
  if (!IsCopied(photo, max_image_px)) {
    return WriteJpeg(ReadColourImage(photo.path), max_image_px, photo.header.focal_over_diagonal,
                     name, output);
  }
  output.Write(name, ReadWholeFile(photo.path, "photo"));
}

std::optional<FocalHint> HintOf(const CommonCamera& camera, const FramesRecord& record,
                                const std::vector<Photo>& photos) {
  int count = 0;
  for (size_t i = 0; i < photos.size(); ++i) {
    count += !IsLeftOut(record.frames[i]) && photos[i].header.focal_over_diagonal ? 1 : 0;
  }
  if (count == 0) return std::nullopt;
  return FocalHint{*camera.focal_over_diagonal * std::hypot(record.width, record.height), count};
}

ChosenFrames ChoosePhotos(const FrameOptions& options, const fs::path& folder, int threads,
                          std::vector<Photo>* photos) {
  *photos = ListPhotos(folder);
  const CommonCamera camera = FindCommonCamera(folder, *photos);
  ChosenFrames chosen;
  chosen.record.name = PlainPath(folder).filename().string();
  std::vector<SourceFrame>& frames = chosen.record.frames;
  for (const Photo& photo : *photos) {
    frames.push_back({photo.path.filename().string(), {}, {}, {}, {}});
    if (const auto other = FindOtherCamera(photo, camera)) {
      frames.back().rejection = other->reason;
      frames.back().detail = other->detail;
    }
  }
  std::vector<FrameView> views(photos->size());
  ParallelFor("photos", static_cast<int>(photos->size()), threads, [&](int index) {
    const auto i = static_cast<size_t>(index);
    if (!IsLeftOut(frames[i])) MeasurePhoto((*photos)[i], &frames[i], &views[i]);
  });
  FrameSelector selector(options);
  for (size_t i = 0; i < views.size(); ++i) {
    if (IsLeftOut(frames[i])) continue;
    selector.Add(std::move(views[i]));
    chosen.inputs.push_back((*photos)[i].path);
  }
  Reject(selector.Choose(), &frames);
  chosen.source_size = {static_cast<int>(camera.size.width), static_cast<int>(camera.size.height)};
  SetSize(options.max_image_px, &chosen);
  chosen.record.focal_hint = HintOf(camera, chosen.record, *photos);
  std::vector<std::string> extensions;
  for (const Photo& photo : *photos) {
    extensions.push_back(ExtensionOf(photo, options.max_image_px));
  }
  NameImages(extensions, &frames);
  return chosen;
}

// Videos.

ChosenFrames ChooseFromVideo(const FrameOptions& options, const fs::path& path) {
  VideoReader video(path);
  const int announced = video.announced_frames();
  ChosenFrames chosen;
  chosen.record.name = path.filename().string();
  chosen.inputs = {path};
  std::vector<SourceFrame>& frames = chosen.record.frames;
  FrameSelector selector(options);
  Progress progress("frames", announced > 0 ? announced : Progress::kUnknownCount);
  cv::Mat grey;
  for (; video.Next(); progress.Step()) {
    cv::cvtColor(video.image(), grey, cv::COLOR_BGR2GRAY);
    const FrameView view = ViewOf(grey);
    selector.Add(view);
    frames.push_back(
        {chosen.record.name, static_cast<int>(frames.size()), video.time_s(), view.sharpness, {}});
    chosen.source_size = grey.size();
  }
  SetSize(options.max_image_px, &chosen);
  chosen.is_cut_short = 10 * std::ssize(frames) < 9 * static_cast<std::ptrdiff_t>(announced);
  Reject(selector.Choose(), &frames);
  NameImages(std::vector<std::string>(frames.size(), ".jpg"), &frames);
  return chosen;
}

void WriteVideoFrames(const FramesRecord& record, const fs::path& path, int max_image_px,
                      const DatasetFolder& output) {
  VideoReader video(path);
  for (const SourceFrame& frame : record.frames) {
    if (!video.Next()) throw InputError(path.string() + ": cannot be decoded a second time");
    if (!IsLeftOut(frame)) WriteJpeg(video.image(), max_image_px, {}, frame.image, output);
  }
}

std::string ReadmeText(const DatasetFolder& output) {
  return output.Mark() +
         "; the next run into this folder replaces it. -->\n\n"
         "Images that were chosen from photos or a video: `rgb/`, listed in `rgb.txt` in the "
         "order\n"
         "in which they were taken; times are seconds for videos, and count from 0 for photos.\n"
         "`frames.json` says where each image comes from, and what was left out, and why. Its\n"
         "`focal_hint` is no calibration.\n";
}

}  // namespace

void RunFrames(const FrameOptions& options, const StageFiles& files, int threads) {
  const fs::path &images = files.at("images"), &folder = files.at("output");
  DatasetFolder output(folder, "soslam-frames");
  RefuseFilesOfOthers(folder);
  std::vector<Photo> photos;
  const bool is_video = !IsFolder(images);
  ChosenFrames chosen =
      is_video ? ChooseFromVideo(options, images) : ChoosePhotos(options, images, threads, &photos);
  const FramesRecord& record = chosen.record;
  CheckEnough(record, images);
  const std::vector<Finding> findings = CheckFrames(chosen);
  ReportFindings("frames", findings);
  fs::create_directory(output.Temporary() / "rgb");
  if (is_video) WriteVideoFrames(record, images, options.max_image_px, output);
  ParallelFor("images", static_cast<int>(photos.size()), threads, [&](int index) {
    const auto i = static_cast<size_t>(index);
    if (IsLeftOut(record.frames[i])) return;
    WritePhoto(photos[i], options.max_image_px, record.frames[i].image, output);
  });
  if (files.contains("detections")) {
    output.Write("detections.csv", FrameBoxesText(files.at("detections"), chosen));
    chosen.inputs.push_back(files.at("detections"));
  }
  output.Write("README.md", ReadmeText(output));
  output.Write("rgb.txt", FrameListText(record.frames));
  output.Write("frames.json", FramesText(folder / "frames.json", record,
                                         {OptionsToJson(options), chosen.inputs, findings}));
  output.Commit();
  const auto counts = CountLeftOut(record.frames);
  const auto left_out = std::ranges::count_if(record.frames, IsLeftOut);
  fmt::print("{}: {} of {} images chosen, {} x {} px; left out: {}\n", record.name,
             std::ssize(record.frames) - left_out, record.frames.size(), record.width,
             record.height, counts.empty() ? "none" : CountsText(counts));
}

}  // namespace soslam
