// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "geometry/camera.h"

namespace soslam {

// Colours of Okabe and Ito, which readers of any colour vision tell apart: blue, green, red.
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

// Draws in the coordinates of a camera on a picture that shows what it sees: CV_8UC3, of the
// camera's size or a multiple of it. Lines and texts stand out from any background by a dark seam.
class Canvas {
 public:
  // `picture` has to outlive the canvas.
  Canvas(const Camera& camera, cv::Mat* picture);

  // Pixels of the camera; they may be outside the image.
  void Lines(const std::vector<Eigen::Vector2d>& pixels, bool closed, const Stroke& stroke);
  void Disc(const Eigen::Vector2d& pixel, const cv::Scalar& colour);
  // Above the pixel, or below it at the upper border; cut at no border. Other characters than those
  // of ASCII become question marks.
  void Text(const Eigen::Vector2d& pixel, const std::string& text, const cv::Scalar& colour);
  // Points in the camera's frame; what is behind the camera is left out.
  void Segment(const Eigen::Vector3d& begin_in_camera, const Eigen::Vector3d& end_in_camera,
               const Stroke& stroke);
  void Arrow(const Eigen::Vector3d& begin_in_camera, const Eigen::Vector3d& end_in_camera,
             const Stroke& stroke);

 private:
  // The picture's pixels of a camera's pixel, times 2^kFractionBits.
  cv::Point Place(const Eigen::Vector2d& pixel) const;

  Camera camera_;
  cv::Mat* picture_;
  double scale_;
};

// A line of a caption: a text, and a line in its colour before it.
struct CaptionEntry {
  std::string text;
  cv::Scalar colour = palette::kWhite;
  bool has_line = false;
};

// The picture (CV_8UC3) with a dark band below that says what it shows.
cv::Mat WithCaption(const cv::Mat& picture, const std::vector<CaptionEntry>& entries);

// Enough for fine lines and texts (px); for one of two pictures side by side.
inline constexpr int kPictureWidth = 1200;
inline constexpr int kTileWidth = kPictureWidth / 2;

// A picture in grey or colour (CV_8UC1, CV_8UC3) in colour, enlarged by the smallest whole factor
// that makes it so wide.
cv::Mat DrawingGround(const cv::Mat& image, int min_width = kPictureWidth);

}  // namespace soslam
