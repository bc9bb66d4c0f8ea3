// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "soslam/geometry/box.h"

namespace soslam {

// A camera 2 that is 0.1 m left of, 0.02 m below and 0.01 m behind camera 0 would have this fourth
// column: a point's coordinates grow by (0.1, -0.02, 0.01).
inline constexpr double kKittiFocal = 700.0;
inline constexpr double kKittiCx = 600.0;
inline constexpr double kKittiCy = 180.0;
inline const Eigen::Vector3d kCamera2FromCamera0(0.1, -0.02, 0.01);

inline Eigen::Matrix<double, 3, 4> KittiP2() {
  Eigen::Matrix3d intrinsics;
  intrinsics << kKittiFocal, 0, kKittiCx, 0, kKittiFocal, kKittiCy, 0, 0, 1;
  Eigen::Matrix<double, 3, 4> p2;
  p2 << intrinsics, intrinsics * kCamera2FromCamera0;
  return p2;
}

inline std::string KittiCalibrationText() {
  const auto p2 = KittiP2();
  std::string text = "P0: 1 0 0 0 0 1 0 0 0 0 1 0\nP2:";
  for (int i = 0; i < 12; ++i) text += fmt::format(" {:.12e}", p2(i / 4, i % 4));
  return text + "\nR0_rect: 1 0 0 0 1 0 0 0 1\n";
}

// A labelled box as KITTI describes it, in the rectified frame of camera 0.
struct KittiBox {
  double x = 0.0, y = 1.6, z = 10.0;  // centre of the bottom face
  double rotation_y = 0.0;
  double height = 1.5, width = 1.7, length = 4.0;

  // The corners by the formulas of KITTI's description: X = R_y X_object + (x, y, z).
  std::array<Eigen::Vector3d, 8> Corners() const {
    std::array<Eigen::Vector3d, 8> corners;
    for (int i = 0; i < 8; ++i) {
      const double ox = (i & 1 ? 0.5 : -0.5) * length;
      const double oy = i & 2 ? 0.0 : -height;
      const double oz = (i & 4 ? 0.5 : -0.5) * width;
      const double c = std::cos(rotation_y);
      const double s = std::sin(rotation_y);
      corners[i] = {c * ox + s * oz + x, oy + y, -s * ox + c * oz + z};
    }
    return corners;
  }
  // Around the projections with P2, without regard to the image's border.
  Box Image() const {
    Eigen::AlignedBox2d around;
    for (const Eigen::Vector3d& corner : Corners()) {
      around.extend((KittiP2() * corner.homogeneous()).hnormalized().eval());
    }
    return {around.min().x(), around.min().y(), around.max().x(), around.max().y()};
  }
  // The 15 columns of the object benchmark.
  std::string Columns(const std::string& type = "Car", const std::string& truncated = "0",
                      int occluded = 0) const {
    const Box box = Image();
    return fmt::format("{} {} {} 0 {} {} {} {} {} {} {} {} {} {} {}\n", type, truncated, occluded,
                       box.x_min, box.y_min, box.x_max, box.y_max, height, width, length, x, y, z,
                       rotation_y);
  }
};

inline constexpr const char* kKittiDontCare =
    "DontCare -1 -1 -10 10 20 30 40 -1000 -1000 -1000 -10 -1 -1 -1\n";

// The text files of a small dataset in KITTI's tracking format, for a test to change before writing
// them. Two recordings with four frames each; the camera drives forwards by 1 m a frame, as the
// poses say in units of half a metre. Recording 0003: track 0, a parked car; track 1, a car that
// drives 1 m a frame ahead of it; track 2, a partly hidden pedestrian in frame 0 only. Recording
// 0007: track 0, a parked van; frame 1 has a region without labels.
struct KittiTrackingFixture {
  static constexpr int kFrames = 4;
  std::map<std::string, std::string> files;

  static KittiBox Parked(int frame) { return {3.0, 1.6, 14.0 - frame, 0.3}; }
  static KittiBox Driving(int /*frame*/) { return {-2.0, 1.7, 12.0, -1.5}; }
  static KittiBox Pedestrian() { return {0.5, 1.6, 9.0, 0.0, 1.8, 0.5, 0.4}; }

  KittiTrackingFixture() {
    for (const char* recording : {"0003", "0007"}) {
      files[fmt::format("calib/{}.txt", recording)] = KittiCalibrationText();
      std::string& poses = files[fmt::format("poses/{}.txt", recording)];
      for (int i = 0; i < kFrames; ++i) poses += fmt::format("1 0 0 0 0 1 0 0 0 0 1 {}\n", 2 * i);
    }
    for (int i = 0; i < kFrames; ++i) {
      files["label_02/0003.txt"] += fmt::format("{} 0 {}", i, Parked(i).Columns());
      files["label_02/0003.txt"] += fmt::format("{} 1 {}", i, Driving(i).Columns());
      files["label_02/0007.txt"] += fmt::format("{} 0 {}", i, Parked(i).Columns("Van"));
    }
    files["label_02/0003.txt"] += fmt::format("0 2 {}", Pedestrian().Columns("Pedestrian", "0", 1));
    files["label_02/0007.txt"] += fmt::format("1 -1 {}", kKittiDontCare);
  }
};

}  // namespace soslam
