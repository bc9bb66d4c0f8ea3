// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <unordered_map>

namespace soslam {

// Fraction of bits that differ, in [0, 1].
template <size_t Bits>
double HammingDistance(const std::bitset<Bits>& a, const std::bitset<Bits>& b) {
  return static_cast<double>((a ^ b).count()) / static_cast<double>(Bits);
}

// The bits of a descriptor: is_set(i) for each. Word by word, in half the time of bit by bit.
template <size_t Bits, typename IsSet>
std::bitset<Bits> BitsWhere(const IsSet& is_set) {
  constexpr size_t kWordSize = 64;
  static_assert(Bits % kWordSize == 0);
  std::bitset<Bits> bits;
  for (size_t end = Bits; end > 0; end -= kWordSize) {
    std::uint64_t word = 0;
    for (size_t i = 0; i < kWordSize; ++i) {
      word |= static_cast<std::uint64_t>(is_set(end - kWordSize + i)) << i;
    }
    bits = bits << kWordSize | std::bitset<Bits>(word);
  }
  return bits;
}

// The pixel of an image closest to `pixel`. None where a patch that reaches `radius` px to all
// sides of it reaches out of the image, and for NaN.
inline std::optional<cv::Point> PatchCentre(const cv::Size& image, const Eigen::Vector2d& pixel,
                                            int radius) {
  const Eigen::Vector2d closest = (pixel.array() + 0.5).floor();
  const bool inside = closest.x() >= radius && closest.x() < image.width - radius &&
                      closest.y() >= radius && closest.y() < image.height - radius;
  if (!inside) return std::nullopt;
  return cv::Point(static_cast<int>(closest.x()), static_cast<int>(closest.y()));
}

// Descriptors of an image that compare grey values of a patch, one bit per comparison. The image is
// smoothed and each pixel is described on first use. Thread-safe; copies share what is described.
template <auto kSmooth, auto kDescribe>
class BinaryDescriptors {
 public:
  explicit BinaryDescriptors(const cv::Mat& grey) : grey_(grey) {}

  // Hamming distance between the plain descriptor of one pixel and the mirrored one of another.
  // Empty where one of them has no descriptor.
  std::optional<double> Distance(const Eigen::Vector2d& pixel,
                                 const Eigen::Vector2d& mirror_pixel) const {
    const std::scoped_lock lock(described_->mutex);
    const Descriptor plain = At(pixel, false);
    const Descriptor mirrored = At(mirror_pixel, true);
    if (!plain || !mirrored) return std::nullopt;
    return HammingDistance(*plain, *mirrored);
  }

 private:
  using Smoothed = decltype(kSmooth(cv::Mat()));
  using Descriptor = decltype(kDescribe(Smoothed(), Eigen::Vector2d(), false));

  struct Described {
    std::mutex mutex;
    std::optional<Smoothed> smoothed;
    std::array<std::unordered_map<int, Descriptor>, 2> by_pixel;  // plain, mirrored
  };

  Descriptor At(const Eigen::Vector2d& pixel, bool mirrored) const {
    const auto closest = PatchCentre(grey_.size(), pixel, 0);
    if (!closest) return std::nullopt;
    if (!described_->smoothed) described_->smoothed = kSmooth(grey_);
    auto& known = described_->by_pixel[mirrored ? 1 : 0];
    const int index = closest->y * grey_.cols + closest->x;
    const auto found = known.find(index);
    if (found != known.end()) return found->second;
    return known.emplace(index, kDescribe(*described_->smoothed, pixel, mirrored)).first->second;
  }

  cv::Mat grey_;
  std::shared_ptr<Described> described_ = std::make_shared<Described>();
};

// BRIEF: Calonder, Lepetit, Strecha and Fua, "BRIEF: Binary robust independent elementary features"
// (ECCV 2010). One bit per pair of pixels of a 31 x 31 px patch: is the first one darker?
using BriefBits = std::bitset<256>;

// Smoothing that makes single pixels comparable (Calonder et al.: sigma 2 px). CV_8UC1 to CV_8UC1.
cv::Mat SmoothForBrief(const cv::Mat& grey);

// The descriptor of the patch around the pixel that contains `pixel`. `mirrored` negates the x
// offsets of the pattern (section V-B, fig. 3(a)): its descriptor at a mirror pixel equals the
// plain one at the original pixel. None when the patch reaches out of the image.
std::optional<BriefBits> BriefDescriptor(const cv::Mat& smoothed_grey, const Eigen::Vector2d& pixel,
                                         bool mirrored);

// FREAK: Alahi, Ortiz and Vandergheynst, "FREAK: Fast retina keypoint" (CVPR 2012), upright and at
// its smallest scale. One bit per pair of 43 receptive fields, which lie as in a retina: seven
// rings of six and the centre, wide and sparse outside, narrow and dense inside. Is the first field
// darker?
using FreakBits = std::bitset<512>;

// Fields of one ring have one size.
inline constexpr size_t kFreakRings = 8;
// The image smoothed to the fields' size of each ring, the outer one first, the centre last.
using FreakImage = std::array<cv::Mat, kFreakRings>;

// Smooths CV_8UC1 to CV_8UC1.
FreakImage SmoothForFreak(const cv::Mat& grey);

// The descriptor of the patch of 45 x 45 px around the pixel that contains `pixel`. `mirrored`
// negates the x offsets of the fields: see BriefDescriptor. None when the patch reaches out of the
// image.
std::optional<FreakBits> FreakDescriptor(const FreakImage& smoothed, const Eigen::Vector2d& pixel,
                                         bool mirrored);

}  // namespace soslam
