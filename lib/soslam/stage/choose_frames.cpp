// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/stage/choose_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/base/paths.h"
#include "soslam/base/progress.h"
#include "soslam/base/text.h"
#include "soslam/image/read_image.h"
#include "soslam/image/video_file.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Applies the choice to all frames that have no rejection yet; `reasons` are for these, in order.
void Reject(const std::vector<std::optional<FrameRejection>>& reasons,
            std::vector<SourceFrame>* frames) {
  auto reason = reasons.begin();
  for (SourceFrame& frame : *frames) {
    if (!IsLeftOut(frame)) frame.rejection = *reason++;
  }
}

// Gives each chosen frame a name of its own, that of its photo where it is plain.
void NameImages(const std::vector<std::string>& extensions, std::vector<SourceFrame>* frames) {
  std::set<std::string> stems;
  for (size_t i = 0; i < frames->size(); ++i) {
    SourceFrame& frame = (*frames)[i];
    if (IsLeftOut(frame)) continue;
    std::string plain = frame.frame_number ? fmt::format("{:06}", *frame.frame_number)
                                           : fs::path(frame.source).stem().string();
    // Every program can read letters, digits and ._- in a name.
    for (char& character : plain) {
      const bool is_plain = std::isalnum(static_cast<unsigned char>(character)) != 0 ||
                            character == '.' || character == '-';
      if (!is_plain) character = '_';
    }
    if (plain.front() == '-') plain.front() = '_';
    std::string stem = plain;
    for (int count = 2; !stems.insert(stem).second; ++count) {
      stem = fmt::format("{}_{}", plain, count);
    }
    frame.image = "rgb/" + stem + extensions[i];
  }
}

void RejectOtherCameras(const std::vector<Photo>& photos, const CommonCamera& camera,
                        std::vector<SourceFrame>* frames) {
  for (size_t i = 0; i < photos.size(); ++i) {
    if (IsLeftOut((*frames)[i])) continue;
    if (const auto other = FindOtherCamera(photos[i], camera)) {
      (*frames)[i].rejection = other->reason;
      (*frames)[i].detail = other->detail;
    }
  }
}

void SetSize(const ImageSize& source, int max_image_px, ChosenFrames* chosen) {
  chosen->source_size = {static_cast<int>(source.width), static_cast<int>(source.height)};
  const cv::Size size = SizeWithin(chosen->source_size, max_image_px);
  chosen->record.width = size.width;
  chosen->record.height = size.height;
}

// Finds a video that was cut short or is damaged, after its last frame, and one that may lie on its
// side.
std::vector<Finding> CheckVideo(const VideoReader& video, const FramesRecord& record) {
  std::vector<Finding> findings;
  const auto damaged = std::ranges::count_if(record.frames, IsLeftOut);
  if (video.is_cut_short()) {
    findings.push_back({"video_cut_short", Severity::kWarning,
                        fmt::format("{}: {} frames can be decoded, fewer than it announces",
                                    record.name, std::ssize(record.frames) - damaged),
                        "all frames", "a file that was copied or recorded incompletely",
                        "copy it again"});
  }
  if (video.has_errors() || damaged > 0) {
    findings.push_back({"video_damaged", Severity::kWarning,
                        fmt::format("{}: parts of it cannot be decoded, and {} of its {} frames "
                                    "are damaged, or predicted from damaged ones",
                                    record.name, damaged, record.frames.size()),
                        "a video without errors", "a file that was copied or recorded with errors",
                        "copy it again"});
  }
  if (const std::string degrees = video.ignored_rotation(); !degrees.empty()) {
    findings.push_back({"video_rotation", Severity::kWarning,
                        fmt::format("{}: its tag `rotate` is {}, and it has no display matrix",
                                    record.name, OneLine(degrees)),
                        "a display matrix, by which players turn videos",
                        "a copy by an old program that kept only the tag",
                        "if the images lie on their side, turn the video: ffmpeg -i VIDEO -vf "
                        "transpose=1 -crf 15 NEW.mp4"});
  }
  return findings;
}

}  // namespace

bool IsCopied(const Photo& photo, const FrameOptions& options) {
  const ImageSize& size = photo.header.stored;
  return (photo.header.orientation == 1 || options.keep_exif_turn) &&
         std::max(size.width, size.height) <= options.max_image_px;
}

ChosenFrames ChoosePhotos(const FrameOptions& options, const fs::path& folder, int threads,
                          std::vector<Photo>* photos) {
  *photos = ListPhotos(folder);
  const CommonCamera camera = FindCommonCamera(folder, *photos);
  ChosenFrames chosen;
  chosen.order = OrderByTime(camera, photos);
  chosen.record.ordered_by = chosen.order.is_by_time ? "time" : "name";
  chosen.record.name = PlainPath(folder).filename().string();
  std::vector<SourceFrame>& frames = chosen.record.frames;
  for (const Photo& photo : *photos) {
    frames.push_back({photo.path.filename().string(), {}, {}, {}, {}});
    if (!photo.original.empty()) {
      frames.back().rejection = FrameRejection::kDuplicate;
      frames.back().detail = "the same file as " + photo.original;
    }
  }
  RejectOtherCameras(*photos, camera, &frames);
  std::vector<FrameView> views(photos->size());
  ParallelFor("photos", photos->size(), threads, [&](size_t i) {
    if (IsLeftOut(frames[i])) return;
    const fs::path& path = (*photos)[i].path;
    try {
      views[i] = MakeFrameView(ReadImage(path, cv::IMREAD_GRAYSCALE));
      frames[i].sharpness = views[i].sharpness;
    } catch (const InputError& error) {
      const std::string message = error.what(), place = path.string() + ": ";
      frames[i].rejection = FrameRejection::kUnreadable;
      frames[i].detail =
          OneLine(message.starts_with(place) ? message.substr(place.size()) : message);
    }
  });
  FrameSelector selector(options);
  for (size_t i = 0; i < views.size(); ++i) {
    if (IsLeftOut(frames[i])) continue;
    selector.Add(std::move(views[i]));
    chosen.inputs.push_back((*photos)[i].path);
  }
  Reject(selector.Choose(), &frames);
  SetSize(camera.size, options.max_image_px, &chosen);
  int with_focal_length = 0;
  std::vector<std::string> extensions;
  for (size_t i = 0; i < frames.size(); ++i) {
    const Photo& photo = (*photos)[i];
    with_focal_length += !IsLeftOut(frames[i]) && photo.header.focal_over_diagonal ? 1 : 0;
    extensions.push_back(IsCopied(photo, options) ? LowerCase(photo.path.extension().string())
                                                  : ".jpg");
  }
  if (with_focal_length > 0) {
    const double diagonal_px = std::hypot(chosen.record.width, chosen.record.height);
    chosen.record.focal_hint = {*camera.focal_over_diagonal * diagonal_px, with_focal_length};
  }
  NameImages(extensions, &frames);
  return chosen;
}

ChosenFrames ChooseFromVideo(const FrameOptions& options, const fs::path& path) {
  if (IsFile(path) && ReadImageHeader(path)) {
    throw InputError(
        path.string() +
        ": is one image; expected a folder of several, taken from different places, or "
        "a video");
  }
  VideoReader video(path);
  const int announced = video.announced_frames();
  ChosenFrames chosen;
  chosen.record.name = path.filename().string();
  chosen.inputs = {path};
  std::vector<SourceFrame>& frames = chosen.record.frames;
  std::vector<Photo> photos;  // the frames; damaged ones have no size
  std::map<ImageSize, FrameSelector> selectors;
  Progress progress("frames", announced > 0 ? announced : Progress::kUnknownCount);
  for (; video.Next(); progress.Step()) {
    frames.push_back({chosen.record.name, static_cast<int>(frames.size()), video.time_s(), {}, {}});
    photos.push_back({path, {}});
    if (video.is_damaged()) {
      frames.back().rejection = FrameRejection::kUnreadable;
      frames.back().detail = "damaged, or predicted from a damaged frame";
      continue;
    }
    const cv::Mat grey = video.Image(cv::IMREAD_GRAYSCALE);
    const ImageSize size = {grey.cols, grey.rows};
    const FrameView view = MakeFrameView(grey);
    photos.back().header.stored = size;
    frames.back().sharpness = view.sharpness;
    selectors.try_emplace(size, options).first->second.Add(view);
  }
  if (selectors.empty()) {
    throw InputError(path.string() +
                     ": has no frame that can be decoded; expected at least 2: is it cut short?");
  }
  chosen.findings = CheckVideo(video, chosen.record);
  const CommonCamera camera = FindCommonCamera(path, photos);
  RejectOtherCameras(photos, camera, &frames);
  SetSize(camera.size, options.max_image_px, &chosen);
  Reject(selectors.at(camera.size).Choose(), &frames);
  NameImages(std::vector<std::string>(frames.size(), ".jpg"), &frames);
  return chosen;
}

}  // namespace soslam
