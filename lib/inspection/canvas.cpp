// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/canvas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "inspection/projection.h"

namespace soslam {
namespace {

constexpr int kFractionBits = 4;  // of pixels, in the coordinates of OpenCV's drawing
constexpr int kSeam = 1;          // px of the picture, on both sides

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kFontScale = 0.5;
constexpr int kTextMargin = 4;  // px of the picture

std::string AsciiOf(const std::string& text) {
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

TextSize SizeOf(const std::string& text) {
  int descent = 0;
  const cv::Size size = cv::getTextSize(text, kFont, kFontScale, 1, &descent);
  return {{size.width + 2 * kTextMargin, size.height + descent + 2 * kTextMargin},
          size.height + kTextMargin};
}

void PutText(const std::string& text, const cv::Point& corner, const cv::Scalar& colour,
             cv::Mat* picture) {
  cv::putText(*picture, text, corner + cv::Point(kTextMargin, SizeOf(text).baseline), kFont,
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
  const std::string ascii = AsciiOf(text);
  const cv::Size size = SizeOf(ascii).size;
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
  const int line_height = SizeOf("Ag").size.height + kTextMargin;
  std::vector<cv::Point> corners;
  cv::Point corner(kTextMargin, kTextMargin);
  for (const CaptionEntry& entry : entries) {
    const int width = SizeOf(AsciiOf(entry.text)).size.width + (entry.has_line ? kLineLength : 0);
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
    PutText(AsciiOf(entries[i].text), text, entries[i].colour, &band);
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

namespace {

// A camera of which only the size matters, for drawing in pixels.
Camera CameraOfSize(const cv::Mat& image) { return {.width = image.cols, .height = image.rows}; }

cv::Mat WithCorners(const EdgeMaps& maps, int min_width) {
  cv::Mat picture = DrawingGround(maps.grey, min_width);
  Canvas canvas(CameraOfSize(maps.grey), &picture);
  for (const Eigen::Vector2f& corner : maps.corners) {
    canvas.Disc(corner.cast<double>(), palette::kYellow);
  }
  return picture;
}

// Infinite distances (an image without edges) are dark.
cv::Mat DistancePicture(const cv::Mat& distance, double largest) {
  cv::Mat scaled = cv::Mat::zeros(distance.size(), CV_8UC1);
  if (largest > 0.0) distance.convertTo(scaled, CV_8U, 255.0 / largest);
  cv::Mat picture;
  cv::applyColorMap(scaled, picture, cv::COLORMAP_VIRIDIS);
  return picture;
}

// Red for right, then by the angle clockwise, as the image's y axis points down.
cv::Vec3b HueOf(const cv::Point2f& direction) {
  const float degrees = cv::fastAtan2(direction.y, direction.x);
  const auto hue = static_cast<uchar>(std::lround(0.5F * degrees) % 180);  // OpenCV's unit: 2 deg
  return {hue, 200, 255};
}

// A legend of the colours of all directions, at the lower right.
void DrawColourWheel(cv::Mat* hues) {
  const int radius = std::min(hues->rows, hues->cols) / 10;
  const cv::Point centre(hues->cols - radius - 4, hues->rows - radius - 4);
  cv::circle(*hues, centre, radius + 2, {0, 0, 255}, cv::FILLED);
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      if (x * x + y * y > radius * radius) continue;
      hues->at<cv::Vec3b>(centre + cv::Point(x, y)) =
          HueOf({static_cast<float>(x), static_cast<float>(y)});
    }
  }
}

// Edge pixels are black; without edges all pixels are.
cv::Mat DirectionPicture(const cv::Mat& nearest_edge) {
  cv::Mat hues = cv::Mat::zeros(nearest_edge.size(), CV_8UC3);
  for (int y = 0; y < hues.rows; ++y) {
    for (int x = 0; x < hues.cols; ++x) {
      const auto& edge = nearest_edge.at<cv::Vec2s>(y, x);
      const cv::Point2f direction(static_cast<float>(edge[0] - x), static_cast<float>(edge[1] - y));
      if (edge[0] >= 0 && direction != cv::Point2f()) hues.at<cv::Vec3b>(y, x) = HueOf(direction);
    }
  }
  DrawColourWheel(&hues);
  cv::Mat picture;
  cv::cvtColor(hues, picture, cv::COLOR_HSV2BGR);
  return picture;
}

cv::Mat LayerPicture(const EdgeMaps& maps, EdgeLayer layer, const std::string& title,
                     int min_width) {
  const int edges = cv::countNonZero(maps.edges);
  double largest = 0.0;
  if (edges > 0) cv::minMaxLoc(maps.distance, nullptr, &largest);
  const auto captioned = [&](const cv::Mat& picture, const std::string& text) {
    return WithCaption(DrawingGround(picture, min_width), {{title}, {text}});
  };
  switch (layer) {
    case EdgeLayer::kGrey:
      return captioned(WithCorners(maps, min_width),
                       fmt::format("{} corners", maps.corners.size()));
    case EdgeLayer::kEdges:
      return captioned(maps.edges, fmt::format("{} edge pixels", edges));
    case EdgeLayer::kDistance:
      return captioned(
          DistancePicture(maps.distance, largest),
          fmt::format("distance to the nearest edge, 0 (dark) to {:.1f} px (bright)", largest));
    default:
      return captioned(DirectionPicture(maps.nearest_edge),
                       "direction to the nearest edge, by the colours of the wheel");
  }
}

// The part of an image around pairs of pixels, with a margin in proportion to its size.
cv::Rect AroundPairs(const SymmetryRecord& record, const cv::Size& size) {
  std::vector<cv::Point2f> points;
  for (const auto* pixels : {&record.samples, &record.mirrored}) {
    for (const Eigen::Vector2f& pixel : *pixels) points.emplace_back(pixel.x(), pixel.y());
  }
  const cv::Rect image({0, 0}, size);
  if (points.empty()) return image;
  const cv::Rect tight = cv::boundingRect(points);
  const int margin = std::max(tight.width, tight.height) / 3 + 4;
  const cv::Rect wide(tight.x - margin, tight.y - margin, tight.width + 2 * margin,
                      tight.height + 2 * margin);
  const cv::Rect part = wide & image;
  return part.empty() ? image : part;
}

}  // namespace

cv::Mat EdgesPicture(const EdgeMaps& maps, EdgeLayer layer, const std::string& title) {
  if (layer != EdgeLayer::kAll) return LayerPicture(maps, layer, title, kPictureWidth);
  const auto row = [&](EdgeLayer left, EdgeLayer right) {
    cv::Mat tiles;
    cv::hconcat(LayerPicture(maps, left, title, kTileWidth),
                LayerPicture(maps, right, title, kTileWidth), tiles);
    return tiles;
  };
  cv::Mat tiles;
  cv::vconcat(row(EdgeLayer::kGrey, EdgeLayer::kEdges),
              row(EdgeLayer::kDistance, EdgeLayer::kNearest), tiles);
  return tiles;
}

cv::Mat SymmetryPicture(const SymmetryRecord& record, const cv::Mat& image,
                        const std::string& title) {
  constexpr double kLineOpacity = 0.4;
  const cv::Rect part = AroundPairs(record, image.size());
  cv::Mat picture = DrawingGround(image(part));
  cv::Mat lines = picture.clone();
  Canvas line_canvas(CameraOfSize(image(part)), &lines);
  const auto place = [&](const Eigen::Vector2f& pixel) -> Eigen::Vector2d {
    return pixel.cast<double>() - Eigen::Vector2d(part.x, part.y);
  };
  for (size_t i = 0; i < record.samples.size(); ++i) {
    line_canvas.Lines({place(record.samples[i]), place(record.mirrored[i])}, false,
                      {palette::kWhite, 1});
  }
  picture = (1.0 - kLineOpacity) * picture + kLineOpacity * lines;
  Canvas canvas(CameraOfSize(image(part)), &picture);
  for (const auto& pixel : record.samples) canvas.Disc(place(pixel), palette::kYellow);
  for (const auto& pixel : record.mirrored) canvas.Disc(place(pixel), palette::kSkyBlue);
  return WithCaption(picture,
                     {{title},
                      {fmt::format("{} pixels", record.samples.size()), palette::kYellow, true},
                      {"their mirror pixels", palette::kSkyBlue, true}});
}

}  // namespace soslam
