// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/appearance/crop.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace soslam {
namespace {

constexpr double kMargin = 1.2;  // side of the crop over the longer side of the box
constexpr int kGrey = 114;       // padding in the training of YOLO networks

// Axes of the level camera: z along the ray, x horizontal.
Eigen::Matrix3d LevelFromCamera(const Eigen::Vector3d& ray, const Eigen::Vector3d& up) {
  Eigen::Vector3d x = ray.cross(up);
  if (x.norm() < 1e-6) x = Eigen::Vector3d::UnitX() - ray.x() * ray;  // straight up or down
  Eigen::Matrix3d level_from_camera;
  level_from_camera.row(0) = x.normalized();
  level_from_camera.row(2) = ray;
  level_from_camera.row(1) = ray.cross(x.normalized());
  return level_from_camera;
}

}  // namespace

Crop RenderCrop(const cv::Mat& image, const Camera& camera, const Box& box,
                const Eigen::Vector3d& up_in_camera, int side) {
  const Eigen::Vector3d ray = camera.Ray(box.Centre()).normalized();
  const Eigen::Matrix3d level_from_camera = LevelFromCamera(ray, up_in_camera);

  // The extent in the level view, at unit depth, of the ellipse that touches the box in the middles
  // of its edges: corners that no part of the object touches would make it larger.
  const auto in_level = [&](double x, double y) -> Eigen::Vector2d {
    const Eigen::Vector3d point = level_from_camera * camera.Ray({x, y});
    return point.head<2>() / std::max(point.z(), 1e-3);
  };
  const Eigen::Vector2d middle_px = box.Centre();
  const Eigen::Vector2d left = in_level(box.x_min, middle_px.y());
  const Eigen::Vector2d right = in_level(box.x_max, middle_px.y());
  const Eigen::Vector2d top = in_level(middle_px.x(), box.y_min);
  const Eigen::Vector2d bottom = in_level(middle_px.x(), box.y_max);
  const Eigen::Vector2d centre = 0.25 * (left + right + top + bottom);
  const Eigen::Vector2d size =
      ((right - left).cwiseAbs2() + (bottom - top).cwiseAbs2()).cwiseSqrt().cwiseMax(1e-6);

  // The homography from pixels of the image to pixels of the crop.
  const double scale = side / (kMargin * size.maxCoeff());  // pixels of the crop at unit depth
  const double middle = 0.5 * (side - 1);
  Eigen::Matrix3d crop_from_level;
  crop_from_level << scale, 0, middle - scale * centre.x(), 0, scale, middle - scale * centre.y(),
      0, 0, 1;
  const Eigen::Matrix3d crop_from_image =
      crop_from_level * level_from_camera * camera.Intrinsics().inverse();
  cv::Matx33d homography;
  for (int i = 0; i < 9; ++i) homography.val[i] = crop_from_image(i / 3, i % 3);

  // Where the crop is smaller than the box, the image is blurred before it is sampled.
  const double shrinking = kMargin * std::max(box.Width(), box.Height()) / side;
  cv::Mat source = image;
  if (shrinking > 1.0) {
    // Only the neighbourhood of the box is seen.
    const cv::Rect all(0, 0, image.cols, image.rows);
    const double reach = 1.5 * std::max(box.Width(), box.Height());
    const Eigen::Vector2d centre = box.Centre();
    const cv::Rect near =
        cv::Rect(
            cv::Point(static_cast<int>(centre.x() - reach), static_cast<int>(centre.y() - reach)),
            cv::Point(static_cast<int>(centre.x() + reach), static_cast<int>(centre.y() + reach))) &
        all;
    if (near.area() > 0) {
      source = image.clone();
      cv::Mat part = source(near);
      cv::GaussianBlur(image(near), part, {}, 0.5 * shrinking);
    }
  }
  Crop crop;
  cv::warpPerspective(source, crop.image, homography, cv::Size(side, side), cv::INTER_LINEAR,
                      cv::BORDER_CONSTANT, cv::Scalar::all(kGrey));
  crop.direction = {ray, -std::asin(std::clamp(ray.dot(up_in_camera), -1.0, 1.0)),
                    std::log(size.x() / size.y())};
  return crop;
}

}  // namespace soslam
