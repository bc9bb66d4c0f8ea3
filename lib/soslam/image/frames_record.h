// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "soslam/base/description.h"
#include "soslam/image/frame_choice.h"

namespace soslam {

// A photo, or a frame of a video.
struct SourceFrame {
  std::string source;               // name of its file, without folders
  std::optional<int> frame_number;  // in a video, from 0
  std::optional<double> time_s;     // in a video, since its first frame
  std::optional<double> sharpness;  // none if it was not measured
  std::optional<FrameRejection> rejection;
  std::string detail = {};  // of the rejection, in words
  std::string image = {};   // path in the dataset folder; empty if it was left out
};

// A focal length that a reconstruction may start from: a guess, no calibration.
struct FocalHint {
  double focal_px;  // in the images of the dataset
  int images;       // number of chosen photos whose EXIF data have one
};

struct FramesRecord {
  std::string name;  // of the folder or video
  int width = 0;     // of the images of the dataset, px
  int height = 0;
  std::optional<FocalHint> focal_hint;
  std::string ordered_by = "time";  // of the video, or in the EXIF data of photos; or "name"
  std::vector<SourceFrame> frames;  // all, in this order; in frames.json chosen ones first
};

template <typename Visitor>
void Describe(Visitor& visit, FocalHint& hint) {
  visit.Field("focal_px", &hint.focal_px, "median over the chosen photos", kPositive);
  visit.Field("images", &hint.images, "chosen photos with a focal length in EXIF", kAtLeastOne);
}

// A frame with its image, or else with the reason why it has none.
template <typename Visitor>
void DescribeFrame(Visitor& visit, SourceFrame& frame, bool is_chosen) {
  visit.Field("source", &frame.source, "name of the photo or video, without folders");
  visit.Field("frame_number", &frame.frame_number, "in the video, from 0; null for photos",
              kNotNegative);
  visit.Field("time_s", &frame.time_s, "since the first frame of the video; null for photos",
              kNotNegative);
  visit.Field("sharpness", &frame.sharpness,
              "variance of the Laplacian of the image scaled to at most 640 px; null: not measured",
              kNotNegative);
  if (is_chosen) {
    visit.Field("image", &frame.image, "path in the dataset folder");
    return;
  }
  FrameRejection reason = frame.rejection.value_or(FrameRejection::kUnreadable);
  visit.Field("reason", &reason,
              "unreadable: cannot be decoded, or a RAW photo; duplicate: the same file as another "
              "photo; other_size, other_focal_length: not that of most images; blurred: less sharp "
              "than the images before and after; no_motion: shows the same as a chosen one; "
              "over_limit: max_frames others were chosen");
  visit.AfterReading([&] { frame.rejection = reason; });
  visit.Field("detail", &frame.detail, "the reason in words; may be empty");
}

// frames.json.
template <typename Visitor>
void Describe(Visitor& visit, FramesRecord& record) {
  visit.Field("name", &record.name, "of the folder of photos, or of the video");
  visit.Field("width", &record.width, "of the images of the dataset, px", kAtLeastOne);
  visit.Field("height", &record.height, "of the images of the dataset, px", kAtLeastOne);
  visit.Field("focal_hint", &record.focal_hint,
              "from EXIF data, for a reconstruction to start from; null without");
  visit.OrDefault("ordered_by", &record.ordered_by, std::string("time"),
                  "time, that of the video or in the EXIF data of photos; or name, with numbers as "
                  "numbers");
  visit.Check([&] { return NotOneOf("ordered_by", record.ordered_by, {"time", "name"}); });
  std::vector<SourceFrame> chosen, left_out;
  for (const SourceFrame& frame : record.frames) {
    (frame.rejection ? left_out : chosen).push_back(frame);
  }
  const auto describe = [](bool is_chosen) {
    return [is_chosen](auto& visit, SourceFrame& frame) { DescribeFrame(visit, frame, is_chosen); };
  };
  visit.Field("frames", &chosen, "chosen images, in the order of rgb.txt", {.least_items = 1},
              describe(true));
  visit.Field("left_out", &left_out,
              "all other images, in the same order; photos without a time come last", {},
              describe(false));
  visit.AfterReading([&] {
    record.frames = chosen;
    record.frames.insert(record.frames.end(), left_out.begin(), left_out.end());
  });
}

}  // namespace soslam
