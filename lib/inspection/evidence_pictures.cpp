// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/evidence_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "inspection/canvas.h"

namespace soslam {
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
