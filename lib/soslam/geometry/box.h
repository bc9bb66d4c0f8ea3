// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "soslam/geometry/angles.h"

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

template <typename Visitor>
void Describe(Visitor& visit, Box& box) {
  visit.Item(&box.x_min, "x_min, pixels");
  visit.Item(&box.y_min, "y_min");
  visit.Item(&box.x_max, "x_max");
  visit.Item(&box.y_max, "y_max");
}

// In the order of Box::EdgeLines.
enum class BoxSide { kLeft, kTop, kRight, kBottom };
inline constexpr std::array kEdgeNames = {"left", "top", "right", "bottom"};
inline constexpr const auto& NamesOf(BoxSide) { return kEdgeNames; }

// A box that is turned about its centre by an angle, clockwise in the image.
struct TurnedBox {
  Box box;
  double angle_deg = 0.0;

  // Upper left, upper right, lower right and lower left corner of `box`, turned.
  std::array<Eigen::Vector2d, 4> Corners() const {
    const Eigen::Rotation2Dd turn(kRadPerDeg * angle_deg);
    const Eigen::Vector2d centre = box.Centre();
    const Eigen::Vector2d right = turn * Eigen::Vector2d(0.5 * box.Width(), 0.0);
    const Eigen::Vector2d down = turn * Eigen::Vector2d(0.0, 0.5 * box.Height());
    return {centre - right - down, centre + right - down, centre + right + down,
            centre - right + down};
  }
  // The upright box around it.
  Box Around() const {
    Eigen::AlignedBox2d around;
    for (const Eigen::Vector2d& corner : Corners()) around.extend(corner);
    return {around.min().x(), around.min().y(), around.max().x(), around.max().y()};
  }
  // True if the upright box around it is larger than after the nearest quarter turn by more than a
  // pixel, which annotators do not see.
  bool IsOblique() const {
    constexpr double kSeenPx = 1.0;
    const Box around = Around();
    const Box quarter = TurnedBox{box, 90.0 * std::round(angle_deg / 90.0)}.Around();
    return around.Width() - quarter.Width() > kSeenPx ||
           around.Height() - quarter.Height() > kSeenPx;
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
