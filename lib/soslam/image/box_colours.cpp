// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/box_colours.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace soslam {

BoxColours ColoursIn(const cv::Mat& bgr, const Box& box) {
  constexpr int kSide = 32;      // of the patch that the box is scaled to, px
  constexpr double kReach = 12;  // from its middle, where the weight is 1/e, px
  // Ranges of L*, a* and b*: of the colours of most things.
  constexpr std::array kLowest = {0.0, -60.0, -60.0};
  constexpr std::array kRange = {100.0, 120.0, 120.0};
  constexpr std::array kBins = {kLightnessBins, kChromaBins, kChromaBins};
  const int left = std::clamp(static_cast<int>(std::lround(box.x_min)), 0, bgr.cols - 1);
  const int top = std::clamp(static_cast<int>(std::lround(box.y_min)), 0, bgr.rows - 1);
  const int right = std::clamp(static_cast<int>(std::lround(box.x_max)), left, bgr.cols - 1);
  const int bottom = std::clamp(static_cast<int>(std::lround(box.y_max)), top, bgr.rows - 1);
  cv::Mat patch;
  cv::resize(bgr(cv::Range(top, bottom + 1), cv::Range(left, right + 1)), patch, {kSide, kSide},
             0.0, 0.0, cv::INTER_AREA);
  patch.convertTo(patch, CV_32F, 1.0 / 255.0);
  cv::cvtColor(patch, patch, cv::COLOR_BGR2Lab);

  Eigen::VectorXd shares = Eigen::VectorXd::Zero(BoxColours::SizeAtCompileTime);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      constexpr double kMiddle = 0.5 * (kSide - 1);
      const double weight = std::exp(
          -((x - kMiddle) * (x - kMiddle) + (y - kMiddle) * (y - kMiddle)) / (kReach * kReach));
      // Each colour counts for the eight bins next to it, linearly.
      std::array<int, 3> bin;
      std::array<double, 3> of_next;
      for (int i = 0; i < 3; ++i) {
        const double value = patch.at<cv::Vec3f>(y, x)[i];
        const double at = std::clamp((value - kLowest[i]) / kRange[i] * kBins[i] - 0.5, 0.0,
                                     static_cast<double>(kBins[i] - 1));
        bin[i] = std::min(static_cast<int>(at), kBins[i] - 2);
        of_next[i] = at - bin[i];
      }
      for (int corner = 0; corner < 8; ++corner) {
        double share = weight;
        int index = 0;
        for (int i = 0; i < 3; ++i) {
          const int next = (corner >> i) & 1;
          share *= next == 1 ? of_next[i] : 1.0 - of_next[i];
          index = index * kBins[i] + bin[i] + next;
        }
        shares[index] += share;
      }
    }
  }
  return (255.0 * (shares / shares.sum()).array().sqrt()).round().cast<std::uint8_t>().matrix();
}

}  // namespace soslam
