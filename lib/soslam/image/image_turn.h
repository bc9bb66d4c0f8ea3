// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <opencv2/core.hpp>

#include "soslam/geometry/box.h"
#include "soslam/image/image_format.h"

namespace soslam {

// How a stored image is turned upright: its axes are exchanged, then it is mirrored.
struct ImageTurn {
  bool swaps_axes = false;
  bool mirrors_x = false;
  bool mirrors_y = false;

  // The matrix that turns directions in the image, orthogonal.
  Eigen::Matrix2d Matrix() const {
    const Eigen::Vector2d signs(mirrors_x ? -1.0 : 1.0, mirrors_y ? -1.0 : 1.0);
    const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
    return signs.asDiagonal() * (swaps_axes ? identity.rowwise().reverse().eval() : identity);
  }
  ImageTurn Inverse() const { return swaps_axes ? ImageTurn{true, mirrors_y, mirrors_x} : *this; }
  // The turned position of a pixel; `size` is that of the image before.
  Eigen::Vector2d Turned(const Eigen::Vector2d& pixel, const ImageSize& size) const {
    const Eigen::Vector2d last(static_cast<double>(size.width - 1),
                               static_cast<double>(size.height - 1));
    Eigen::Vector2d turned = pixel, last_turned = last;
    if (swaps_axes) {
      turned.reverseInPlace();
      last_turned.reverseInPlace();
    }
    if (mirrors_x) turned.x() = last_turned.x() - turned.x();
    if (mirrors_y) turned.y() = last_turned.y() - turned.y();
    return turned;
  }
};

// The turn of EXIF's orientation, 1 to 8, which states at which sides of the upright image the
// first stored row and the first stored column are:
//   1 top, left    2 top, right    3 bottom, right    4 bottom, left
//   5 left, top    6 right, top    7 right, bottom    8 left, bottom
constexpr ImageTurn ExifTurn(int orientation) {
  const auto is_between = [&](int a, int b) { return orientation >= a && orientation <= b; };
  return {orientation >= 5, is_between(2, 3) || is_between(6, 7),
          is_between(3, 4) || is_between(7, 8)};
}

// A turn clockwise by 0 to 3 quarters.
constexpr ImageTurn QuarterTurn(int quarters) {
  constexpr std::array kExif = {1, 6, 3, 8};
  return ExifTurn(kExif.at(static_cast<size_t>(quarters)));
}

// The turned box; `size` is that of the image before.
inline Box Turned(const Box& box, const ImageSize& size, const ImageTurn& turn) {
  const Eigen::Vector2d one = turn.Turned({box.x_min, box.y_min}, size);
  const Eigen::Vector2d other = turn.Turned({box.x_max, box.y_max}, size);
  const Eigen::Vector2d least = one.cwiseMin(other), most = one.cwiseMax(other);
  return {least.x(), least.y(), most.x(), most.y()};
}

// May share the pixels of `stored` and change them.
inline cv::Mat Turned(const cv::Mat& stored, const ImageTurn& turn) {
  constexpr int kAboutX = 0, kAboutY = 1;
  cv::Mat image = turn.swaps_axes ? cv::Mat(stored.t()) : stored;
  if (turn.mirrors_x) cv::flip(image, image, kAboutY);
  if (turn.mirrors_y) cv::flip(image, image, kAboutX);
  return image;
}

}  // namespace soslam
