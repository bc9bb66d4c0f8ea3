// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <opencv2/imgproc.hpp>
#include <random>

#include "soslam/image/binary_descriptor.h"

namespace soslam {
namespace {

constexpr int kPatchSize = 31;
constexpr int kPatchRadius = kPatchSize / 2;
constexpr std::uint32_t kPatternSeed = 2010;

struct PointPair {
  cv::Point first;  // offsets from the centre of the patch, px
  cv::Point second;
};
using Pattern = std::array<PointPair, BriefBits().size()>;

// Pairs from an isotropic Gaussian, sigma = patch / 5: the best of the five patterns that Calonder
// et al. compare. Offsets outside the patch, and pairs of a point with itself, are drawn again.
Pattern DrawPattern() {
  std::mt19937 random(kPatternSeed);
  std::normal_distribution<double> gaussian(0.0, kPatchSize / 5.0);
  const auto draw_offset = [&] {
    for (;;) {
      const int offset = static_cast<int>(std::lround(gaussian(random)));
      if (std::abs(offset) <= kPatchRadius) return offset;
    }
  };
  const auto draw_point = [&] {
    const int x = draw_offset();
    return cv::Point(x, draw_offset());
  };
  Pattern pattern;
  for (PointPair& pair : pattern) {
    pair.first = draw_point();
    do {
      pair.second = draw_point();
    } while (pair.second == pair.first);
  }
  return pattern;
}

}  // namespace

cv::Mat SmoothForBrief(const cv::Mat& grey) {
  cv::Mat smoothed;
  constexpr double kSigmaPx = 2.0;
  cv::GaussianBlur(grey, smoothed, cv::Size(9, 9), kSigmaPx);
  return smoothed;
}

std::optional<BriefBits> BriefDescriptor(const cv::Mat& smoothed_grey, const Eigen::Vector2d& pixel,
                                         bool mirrored) {
  CV_Assert(smoothed_grey.type() == CV_8UC1);
  static const Pattern pattern = DrawPattern();
  const auto centre = PatchCentre(smoothed_grey.size(), pixel, kPatchRadius);
  if (!centre) return std::nullopt;
  const std::uint8_t* grey = smoothed_grey.ptr(centre->y, centre->x);
  const auto step = static_cast<std::ptrdiff_t>(smoothed_grey.step1());
  const std::ptrdiff_t side = mirrored ? -1 : 1;
  const auto grey_at = [&](const cv::Point& offset) {
    return grey[offset.y * step + offset.x * side];
  };
  return BitsWhere<BriefBits().size()>(
      [&](size_t i) { return grey_at(pattern[i].first) < grey_at(pattern[i].second); });
}

}  // namespace soslam
