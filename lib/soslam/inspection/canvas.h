// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "soslam/geometry/camera.h"

namespace soslam {

// Okabe and Ito's palette, which people with any colour vision can distinguish: blue, green, red.
namespace palette {
inline const cv::Scalar kYellow(66, 228, 240);
inline const cv::Scalar kSkyBlue(233, 180, 86);
inline const cv::Scalar kVermilion(0, 94, 213);
inline const cv::Scalar kWhite(255, 255, 255);
inline const cv::Scalar kDark(32, 32, 32);
}  // namespace palette

// A line: `width` in pixels of the picture.
struct Stroke {
  cv::Scalar colour;
  int width = 1;
};

// Draws in the coordinates of a camera on a picture of its view: CV_8UC3, of the camera's size or a
// multiple of it. Lines and texts have a dark outline to stand out from any background.
class Canvas {
 public:
  // `picture` must outlive the canvas.
  Canvas(const Camera& camera, cv::Mat* picture);

  // Pixels of the camera; they may be outside the image.
  void Lines(const std::vector<Eigen::Vector2d>& pixels, bool closed, const Stroke& stroke);
  void Disc(const Eigen::Vector2d& pixel, const cv::Scalar& colour);
  // Above the pixel, or below it at the upper border; shifted to be within all borders. Characters
  // outside ASCII become question marks.
  void Text(const Eigen::Vector2d& pixel, const std::string& text, const cv::Scalar& colour);
  // Points in the camera's frame; the part behind the camera is left out.
  void Segment(const Eigen::Vector3d& begin_in_camera, const Eigen::Vector3d& end_in_camera,
               const Stroke& stroke);
  void Arrow(const Eigen::Vector3d& begin_in_camera, const Eigen::Vector3d& end_in_camera,
             const Stroke& stroke);

 private:
  // Converts a camera's pixel to the picture's pixels, times 2^kFractionBits.
  cv::Point Place(const Eigen::Vector2d& pixel) const;

  Camera camera_;
  cv::Mat* picture_;
  double scale_;
};

// A line of a caption: a text, preceded by a line in its colour if `has_line`.
struct CaptionEntry {
  std::string text;
  cv::Scalar colour = palette::kWhite;
  bool has_line = false;
};

// The picture (CV_8UC3) with the caption on a dark band below it.
cv::Mat WithCaption(const cv::Mat& picture, const std::vector<CaptionEntry>& entries);

// Minimal width (px) for fine lines and texts; and of one of two pictures side by side.
inline constexpr int kPictureWidth = 1200;
inline constexpr int kTileWidth = kPictureWidth / 2;

// A grey or colour picture (CV_8UC1, CV_8UC3) in colour, enlarged by the smallest whole factor that
// gives it this width.
cv::Mat DrawingGround(const cv::Mat& image, int min_width = kPictureWidth);

}  // namespace soslam
