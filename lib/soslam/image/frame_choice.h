// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "soslam/base/options.h"

namespace soslam {

// How frames are chosen from photos or a video.
struct FrameOptions {
  int max_frames = 120;
  double min_motion = 0.005;
  double min_sharpness = 0.35;
  int max_image_px = 1600;
  bool keep_exif_turn = false;

  void Describe(OptionVisitor& visit) {
    visit.Group("Choice");
    visit.Integer("max_frames", &max_frames, {2, 10000},
                  "frames to choose at most, spread over all that differ");
    visit.Real("min_motion", &min_motion, {0, 1},
               "median displacement of features since the chosen frame before, as a fraction of "
               "the image's longer side, below which a frame is left out");
    visit.Real("min_sharpness", &min_sharpness, {0, 1},
               "sharpness (variance of the Laplacian) relative to the median of the frames before "
               "and after, below which a frame is left out as blurred");
    visit.Group("Images");
    visit.Integer("max_image_px", &max_image_px, {64, 16384},
                  "longer side of the images; larger ones are scaled down");
    visit.Flag("keep_exif_turn", &keep_exif_turn,
               "photos that EXIF turns are copied with their note, as a finished model of COLMAP "
               "needs it; otherwise they are turned upright. All stages read them upright");
  }
};

// Reasons for leaving out an image.
enum class FrameRejection {
  kUnreadable,        // cannot be decoded
  kDuplicate,         // its file has the same bytes as that of another photo
  kOtherSize,         // not of the size that most images have
  kOtherFocalLength,  // EXIF states another focal length than that of most images
  kBlurred,
  kNoMotion,   // shows the same as a chosen one
  kOverLimit,  // others were chosen in its place
};
inline constexpr std::array kFrameRejectionNames = {"unreadable",         "duplicate", "other_size",
                                                    "other_focal_length", "blurred",   "no_motion",
                                                    "over_limit"};
inline constexpr const auto& NamesOf(FrameRejection) { return kFrameRejectionNames; }

// The size of an image whose longer side is scaled down to `longer_side`, if it is longer.
cv::Size SizeWithin(const cv::Size& size, int longer_side);
// The image in this size.
cv::Mat ScaledDown(const cv::Mat& image, int longer_side);

// The properties of an image that decide whether it is chosen.
struct FrameView {
  double sharpness = 0.0;  // variance of the Laplacian at a common size
  cv::Mat small;           // CV_8UC1, for tracking
};
FrameView MakeFrameView(const cv::Mat& grey);

// Finds the features of one small image in others.
class MotionTracker {
 public:
  explicit MotionTracker(const cv::Mat& small);

  // Median displacement of the features as a fraction of the image's longer side. None if fewer
  // than a third of them are found again, or the image has none.
  std::optional<double> MedianDisplacement(const cv::Mat& small) const;

 private:
  cv::Mat small_;
  cv::Mat features_;
};

// A frame that may be chosen.
struct FrameCandidate {
  size_t frame;  // index among all frames
  FrameView view;
};

// The sharpest frame of each place: a place ends where the motion since its first frame is large
// enough, or where nothing is found again.
class DistinctFrames {
 public:
  explicit DistinctFrames(double min_motion) : min_motion_(min_motion) {}

  void Add(FrameCandidate candidate);
  const std::vector<FrameCandidate>& sharpest() const { return sharpest_; }

 private:
  double min_motion_;
  std::optional<MotionTracker> begin_of_place_;
  std::vector<FrameCandidate> sharpest_;
};

// Chooses frames that are sharp, differ from each other, and are spread over all.
class FrameSelector {
 public:
  explicit FrameSelector(const FrameOptions& options)
      : options_(options), distinct_(options.min_motion) {}

  // The next frame in the order in which they were taken.
  void Add(FrameView view) { distinct_.Add({count_++, std::move(view)}); }

  // The reason for leaving out each of the frames; none for the chosen ones.
  std::vector<std::optional<FrameRejection>> Choose() const;

 private:
  std::vector<FrameCandidate> Thinned(std::vector<FrameCandidate> candidates) const;

  FrameOptions options_;
  DistinctFrames distinct_;
  size_t count_ = 0;
};

}  // namespace soslam
