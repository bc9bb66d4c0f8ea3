// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <bitset>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace soslam {

// Fraction of bits that differ, in [0, 1].
template <size_t Bits>
double HammingDistance(const std::bitset<Bits>& a, const std::bitset<Bits>& b) {
  return static_cast<double>((a ^ b).count()) / static_cast<double>(Bits);
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

// Descriptors of an image that compare grey values of a patch, one bit per comparison. The plain
// and the mirrored ones of all pixels in `region` are made on first use. Thread-safe; copies share
// them.
template <size_t Bits>
class BinaryDescriptors {
 public:
  using Descriptor = std::optional<std::bitset<Bits>>;
  // The descriptor of a pixel, none where its patch reaches out of the image.
  using Describe = std::function<Descriptor(const Eigen::Vector2d& pixel, bool mirrored)>;
  // Prepares an image to be described.
  using Prepare = std::function<Describe(const cv::Mat& grey)>;

  BinaryDescriptors(const cv::Mat& grey, const cv::Rect& region, Prepare prepare)
      : grey_(grey), region_(region), prepare_(std::move(prepare)) {}

  // Hamming distance between the plain descriptor of one pixel and the mirrored one of another.
  // None where either has none.
  std::optional<double> Distance(const Eigen::Vector2d& pixel,
                                 const Eigen::Vector2d& mirror_pixel) const {
    std::call_once(made_->once, [this] { Make(); });
    const Descriptor plain = At(pixel, false);
    const Descriptor mirrored = At(mirror_pixel, true);
    if (!plain || !mirrored) return std::nullopt;
    return HammingDistance(*plain, *mirrored);
  }

 private:
  struct Made {
    std::once_flag once;
    Describe describe;
    std::vector<Descriptor> plain;  // of the region, row by row
    std::vector<Descriptor> mirrored;
  };

  void Make() const {
    made_->describe = prepare_(grey_);
    for (int y = region_.y; y < region_.y + region_.height; ++y) {
      for (int x = region_.x; x < region_.x + region_.width; ++x) {
        made_->plain.push_back(made_->describe(Eigen::Vector2d(x, y), false));
        made_->mirrored.push_back(made_->describe(Eigen::Vector2d(x, y), true));
      }
    }
  }

  Descriptor At(const Eigen::Vector2d& pixel, bool mirrored) const {
    const auto closest = PatchCentre(grey_.size(), pixel, 0);
    if (!closest) return std::nullopt;
    if (!region_.contains(*closest)) return made_->describe(pixel, mirrored);
    const int index = (closest->y - region_.y) * region_.width + closest->x - region_.x;
    return (mirrored ? made_->mirrored : made_->plain)[static_cast<size_t>(index)];
  }

  cv::Mat grey_;
  cv::Rect region_;
  Prepare prepare_;
  std::shared_ptr<Made> made_ = std::make_shared<Made>();
};

}  // namespace soslam
