// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <optional>

namespace soslam {

// An axis-aligned rectangle in the image, pixels, (0, 0) the centre of the top-left pixel.
struct Box {
  double x_min = 0.0;
  double y_min = 0.0;
  double x_max = 0.0;
  double y_max = 0.0;

  bool operator==(const Box&) const = default;

  double Width() const { return x_max - x_min; }
  double Height() const { return y_max - y_min; }
  double Area() const { return Width() * Height(); }
  Eigen::Vector2d Centre() const { return {0.5 * (x_min + x_max), 0.5 * (y_min + y_max)}; }
  bool Contains(const Eigen::Vector2d& pixel) const {
    return pixel.x() >= x_min && pixel.x() <= x_max && pixel.y() >= y_min && pixel.y() <= y_max;
  }
  // The edges as homogeneous lines l with l . (u, v, 1) = 0: left, top, right, bottom.
  std::array<Eigen::Vector3d, 4> EdgeLines() const {
    return {Eigen::Vector3d(1, 0, -x_min), Eigen::Vector3d(0, 1, -y_min),
            Eigen::Vector3d(1, 0, -x_max), Eigen::Vector3d(0, 1, -y_max)};
  }
};

// The smallest signed distance (px) from an edge of the box to the border of an image of
// width x height pixels, which covers [-0.5, width - 0.5] x [-0.5, height - 0.5]. Negative when the
// box reaches outside.
inline double DistanceToBorder(const Box& box, int width, int height) {
  return std::min(
      {box.x_min + 0.5, box.y_min + 0.5, width - 0.5 - box.x_max, height - 0.5 - box.y_max});
}

// The part of the box in an image of width x height pixels; none if there is no such part.
inline std::optional<Box> CutToImage(const Box& box, int width, int height) {
  const Box cut = {std::max(box.x_min, -0.5), std::max(box.y_min, -0.5),
                   std::min(box.x_max, width - 0.5), std::min(box.y_max, height - 0.5)};
  return cut.Width() > 0.0 && cut.Height() > 0.0 ? std::optional(cut) : std::nullopt;
}

// The area (px^2) of the intersection of two boxes.
inline double CommonArea(const Box& one, const Box& other) {
  const double width = std::min(one.x_max, other.x_max) - std::max(one.x_min, other.x_min);
  const double height = std::min(one.y_max, other.y_max) - std::max(one.y_min, other.y_min);
  return std::max(0.0, width) * std::max(0.0, height);
}

// The intersection over union of two boxes; 0 unless they have an area in common.
inline double BoxOverlap(const Box& one, const Box& other) {
  const double both = CommonArea(one, other);
  return both > 0.0 ? both / (one.Area() + other.Area() - both) : 0.0;
}

}  // namespace soslam
