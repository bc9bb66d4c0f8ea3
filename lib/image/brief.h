// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>

namespace soslam {

// BRIEF: Calonder, Lepetit, Strecha and Fua, "BRIEF: Binary robust independent elementary features"
// (ECCV 2010). One bit per pair of pixels of a 31 x 31 px patch: is the first one darker?
using BriefBits = std::bitset<256>;

// Smoothing that makes single pixels comparable (Calonder et al.: sigma 2 px). CV_8UC1 to CV_8UC1.
cv::Mat SmoothForBrief(const cv::Mat& grey);

// An image that is smoothed on first use. Thread-safe.
class SmoothedImage {
 public:
  explicit SmoothedImage(const cv::Mat& grey) : grey_(grey) {}
  const cv::Mat& Get() const;

 private:
  struct Smoothed {
    std::once_flag once;
    cv::Mat image;
  };
  cv::Mat grey_;
  std::shared_ptr<Smoothed> smoothed_ = std::make_shared<Smoothed>();  // shared by all copies
};

// The descriptor of the patch around the pixel that contains `pixel`. `mirrored` negates the x
// offsets of the pattern (section V-B, fig. 3(a)): its descriptor at a mirror pixel equals the
// plain one at the original pixel. None when the patch reaches out of the image.
std::optional<BriefBits> BriefDescriptor(const cv::Mat& smoothed_grey, const Eigen::Vector2d& pixel,
                                         bool mirrored);

// Fraction of bits that differ, in [0, 1].
inline double HammingDistance(const BriefBits& a, const BriefBits& b) {
  return static_cast<double>((a ^ b).count()) / static_cast<double>(a.size());
}

}  // namespace soslam
