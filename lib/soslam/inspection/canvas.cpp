// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/canvas.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "soslam/inspection/projection.h"

namespace soslam {
namespace {

constexpr int kFractionBits = 4;  // of pixels, in the coordinates of OpenCV's drawing
constexpr int kSeam = 1;          // px of the picture, on both sides

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.5;
constexpr int kTextMargin = 4;  // px of the picture

std::string ToAscii(const std::string& text) {
  std::string ascii;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_continuation = (byte & 0xc0) == 0x80;  // of a UTF-8 character
    if (!is_continuation) ascii += byte >= 32 && byte < 127 ? c : '?';
  }
  return ascii;
}

struct TextSize {
  cv::Size size;  // with margins
  int baseline;   // px from the upper border
};

TextSize MeasureText(const std::string& text) {
  int descent = 0;
  const cv::Size size = cv::getTextSize(text, kFont, kFontScale, 1, &descent);
  return {{size.width + 2 * kTextMargin, size.height + descent + 2 * kTextMargin},
          size.height + kTextMargin};
}

void PutText(const std::string& text, const cv::Point& corner, const cv::Scalar& colour,
             cv::Mat* picture) {
  cv::putText(*picture, text, corner + cv::Point(kTextMargin, MeasureText(text).baseline), kFont,
              kFontScale, colour, 1, cv::LINE_AA);
}

}  // namespace

Canvas::Canvas(const Camera& camera, cv::Mat* picture)
    : camera_(camera),
      picture_(picture),
      scale_(static_cast<double>(picture->cols) / static_cast<double>(camera.width)) {}

cv::Point Canvas::Place(const Eigen::Vector2d& pixel) const {
  // (0, 0) is the centre of the first pixel, both of the camera and of the picture.
  const Eigen::Vector2d place =
      (1 << kFractionBits) *
      (scale_ * (pixel + Eigen::Vector2d::Constant(0.5)) - Eigen::Vector2d::Constant(0.5));
  return {static_cast<int>(std::lround(place.x())), static_cast<int>(std::lround(place.y()))};
}

void Canvas::Lines(const std::vector<Eigen::Vector2d>& pixels, bool closed, const Stroke& stroke) {
  std::vector<cv::Point> places;
  for (const Eigen::Vector2d& pixel : pixels) places.push_back(Place(pixel));
  cv::polylines(*picture_, places, closed, palette::kDark, stroke.width + 2 * kSeam, cv::LINE_AA,
                kFractionBits);
  cv::polylines(*picture_, places, closed, stroke.colour, stroke.width, cv::LINE_AA, kFractionBits);
}

void Canvas::Disc(const Eigen::Vector2d& pixel, const cv::Scalar& colour) {
  constexpr int kRadius = 3;
  const auto disc = [&](int radius, const cv::Scalar& fill) {
    cv::circle(*picture_, Place(pixel), radius << kFractionBits, fill, cv::FILLED, cv::LINE_AA,
               kFractionBits);
  };
  disc(kRadius + kSeam, palette::kDark);
  disc(kRadius, colour);
}

void Canvas::Text(const Eigen::Vector2d& pixel, const std::string& text, const cv::Scalar& colour) {
  const std::string ascii = ToAscii(text);
  const cv::Size size = MeasureText(ascii).size;
  cv::Point corner = Place(pixel) / (1 << kFractionBits);
  if (corner.y >= size.height) corner.y -= size.height;
  corner.x = std::clamp(corner.x, 0, std::max(0, picture_->cols - size.width));
  corner.y = std::clamp(corner.y, 0, std::max(0, picture_->rows - size.height));
  cv::rectangle(*picture_, {corner, size}, palette::kDark, cv::FILLED);
  PutText(ascii, corner, colour, picture_);
}

void Canvas::Segment(const Eigen::Vector3d& begin_in_camera, const Eigen::Vector3d& end_in_camera,
                     const Stroke& stroke) {
  const auto visible = ProjectSegment(camera_, {begin_in_camera, end_in_camera});
  if (visible) Lines({(*visible)[0], (*visible)[1]}, false, stroke);
}

void Canvas::Arrow(const Eigen::Vector3d& begin_in_camera, const Eigen::Vector3d& end_in_camera,
                   const Stroke& stroke) {
  if (begin_in_camera.z() < kNearM || end_in_camera.z() < kNearM) return;
  constexpr double kHeadPx = 9.0;  // in pixels of the picture
  const Eigen::Vector2d begin = *camera_.Project(begin_in_camera);
  const Eigen::Vector2d end = *camera_.Project(end_in_camera);
  const Eigen::Vector2d shaft = end - begin;
  const double length = std::min(shaft.norm(), kHeadPx / scale_);
  const Eigen::Vector2d back = -length * shaft.stableNormalized();
  const Eigen::Vector2d side(-0.5 * back.y(), 0.5 * back.x());
  Lines({begin, end}, false, stroke);
  Lines({end + back + side, end, end + back - side}, false, stroke);
}

cv::Mat WithCaption(const cv::Mat& picture, const std::vector<CaptionEntry>& entries) {
  constexpr int kLineLength = 24;
  constexpr int kGap = 12;
  const int line_height = MeasureText("Ag").size.height + kTextMargin;
  std::vector<cv::Point> corners;
  cv::Point corner(kTextMargin, kTextMargin);
  for (const CaptionEntry& entry : entries) {
    const int width =
        MeasureText(ToAscii(entry.text)).size.width + (entry.has_line ? kLineLength : 0);
    if (corner.x > kTextMargin && corner.x + width > picture.cols) {
      corner = {kTextMargin, corner.y + line_height};
    }
    corners.push_back(corner);
    corner.x += width + kGap;
  }
  cv::Mat band(corner.y + line_height, picture.cols, CV_8UC3, palette::kDark);
  for (size_t i = 0; i < entries.size(); ++i) {
    cv::Point text = corners[i];
    if (entries[i].has_line) {
      const cv::Point begin = text + cv::Point(0, line_height / 2);
      cv::line(band, begin, begin + cv::Point(kLineLength - kTextMargin, 0), entries[i].colour, 2,
               cv::LINE_AA);
      text.x += kLineLength;
    }
    PutText(ToAscii(entries[i].text), text, entries[i].colour, &band);
  }
  cv::Mat captioned;
  cv::vconcat(picture, band, captioned);
  return captioned;
}

cv::Mat DrawingGround(const cv::Mat& image, int min_width) {
  cv::Mat colour = image;
  if (image.channels() == 1) cv::cvtColor(image, colour, cv::COLOR_GRAY2BGR);
  const double factor = std::max(1.0, std::ceil(static_cast<double>(min_width) / image.cols));
  cv::Mat ground;
  cv::resize(colour, ground, cv::Size(), factor, factor, cv::INTER_CUBIC);
  return ground;
}

}  // namespace soslam
