// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/imgproc.hpp>
#include <string>

#include "soslam/cli/command_line.h"
#include "soslam/model/sequence.h"
#include "support/drawn_photos.h"
#include "support/folder_test.h"
#include "support/image_files.h"

namespace soslam {

// A camera that moves along a wall with a picture, and its images in the test's folder.
class WallSequenceTest : public FolderTest {
 protected:
  static constexpr double kFocalPx = 300.0;
  static constexpr double kDepthM = 3.0;  // of the picture that all cameras look at
  static constexpr int kShiftPx = 6;      // per image
  static constexpr int kImages = 9;       // more than one batch of two threads

  WallSequenceTest() {
    sequence_.name = "wall";
    sequence_.camera = {320, 240, kFocalPx, kFocalPx, 159.5, 119.5};
    for (int i = 0; i < kImages; ++i) {
      const std::string name = "rgb/" + std::to_string(i) + ".png";
      const Eigen::Vector3d place(i * kShiftPx * kDepthM / kFocalPx, 0.0, 0.0);
      sequence_.frames.push_back(
          {5 * i, 0.1 * i, name, {Eigen::Quaterniond::Identity(), place}, {}});
      cv::Mat soft;
      cv::GaussianBlur(DrawnView(i * kShiftPx), soft, {}, 1.0);
      Write(name, EncodedImage(".png", soft));
    }
  }

  StageFiles files_ = {{"dataset", folder_.path()},
                       {"sequence", folder_ / "sequence.json"},
                       {"output", folder_ / "output.h5"}};
  Sequence sequence_;
};

}  // namespace soslam
