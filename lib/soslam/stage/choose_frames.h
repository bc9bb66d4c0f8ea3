// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/types.hpp>
#include <vector>

#include "soslam/dataset/photo_folder.h"
#include "soslam/image/frame_choice.h"
#include "soslam/image/frames_record.h"
#include "soslam/model/finding.h"

namespace soslam {

// Frames with what they were chosen from.
struct ChosenFrames {
  FramesRecord record;
  cv::Size source_size;  // of the images that were chosen from, upright
  std::vector<std::filesystem::path> inputs;
  std::vector<Finding> findings;  // about the video
  PhotoOrder order;               // of photos
};

// True if the frame is not among the chosen ones.
inline bool IsLeftOut(const SourceFrame& frame) { return frame.rejection.has_value(); }

// True if the image of a chosen photo is its file, unchanged; otherwise it is a new JPEG.
bool IsCopied(const Photo& photo, const FrameOptions& options);

// Chooses among the photos of a folder. `photos` becomes all of them, one per frame of the record.
// Throws InputError as ListPhotos and FindCommonCamera.
ChosenFrames ChoosePhotos(const FrameOptions& options, const std::filesystem::path& folder,
                          int threads, std::vector<Photo>* photos);

// Chooses among the frames of a video that are whole and of the size that most have. Throws
// InputError as VideoReader, and when there are none.
ChosenFrames ChooseFromVideo(const FrameOptions& options, const std::filesystem::path& path);

}  // namespace soslam
