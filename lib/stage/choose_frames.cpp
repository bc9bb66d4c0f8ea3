// SPDX-License-Identifier: BSD-3-Clause
#include "stage/choose_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "base/error.h"
#include "base/parallel.h"
#include "base/paths.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/read_image.h"
#include "image/video_file.h"

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

void SetSize(int max_image_px, ChosenFrames* chosen) {
  const cv::Size size = SizeWithin(chosen->source_size, max_image_px);
  chosen->record.width = size.width;
  chosen->record.height = size.height;
}

void MeasurePhoto(const Photo& photo, SourceFrame* frame, FrameView* view) {
  try {
    *view = ViewOf(ReadImage(photo.path, cv::IMREAD_GRAYSCALE));
    frame->sharpness = view->sharpness;
  } catch (const InputError& error) {
    const std::string message = error.what(), place = photo.path.string() + ": ";
    frame->rejection = FrameRejection::kUnreadable;
    frame->detail = OneLine(message.starts_with(place) ? message.substr(place.size()) : message);
  }
}

std::string ExtensionOf(const Photo& photo, int max_image_px) {
  if (!IsCopied(photo, max_image_px)) return ".jpg";
  return LowerCase(photo.path.extension().string());
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

}  // namespace

bool IsCopied(const Photo& photo, int max_image_px) {
  const ImageSize& size = photo.header.stored;
  return photo.header.orientation == 1 && std::max(size.width, size.height) <= max_image_px;
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

}  // namespace soslam
