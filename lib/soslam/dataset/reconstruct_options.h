// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/base/options.h"
#include "soslam/geometry/image_size.h"
#include "soslam/model/sequence.h"

namespace soslam {

enum class ImageMatching { kAuto, kExhaustive, kSequential };
inline constexpr const char* kImageMatchingNames[] = {"auto", "exhaustive", "sequential"};

enum class CalibrationChoice { kAuto, kGiven, kInitial, kEstimated };
inline constexpr const char* kCalibrationChoiceNames[] = {"auto", "given", "initial", "estimated"};

enum class PoseChoice { kEstimated, kGiven };
inline constexpr const char* kPoseChoiceNames[] = {"estimated", "given"};

struct ReconstructOptions {
  PoseChoice poses = PoseChoice::kEstimated;
  CalibrationChoice calibration = CalibrationChoice::kAuto;
  ImageMatching matching = ImageMatching::kAuto;
  int exhaustive_max_images = 100;
  double max_time_difference_s = 0.02;
  ImageOrientation image_orientation = ImageOrientation::kUpright;
  std::string moving_labels = kMovingLabels;

  void Describe(OptionVisitor& visit) {
    visit.Group("What is known");
    visit.Choice("poses", &poses, kPoseChoiceNames,
                 "given: the poses of odometry.txt are kept, and points are triangulated from "
                 "them; estimated: COLMAP's, in a world and a unit of their own");
    visit.Choice("calibration", &calibration, kCalibrationChoiceNames,
                 "the camera: that of camera.json as it is (given), or refined (initial); from the "
                 "images, which may state a focal length in EXIF, with one coefficient of "
                 "distortion (estimated); auto: given if there is a camera.json that is not of "
                 "this program, otherwise estimated");
    visit.Real("max_time_difference_s", &max_time_difference_s, {0, 1e6},
               "a given pose belongs to an image if their time stamps differ by no more");
    visit.Group("COLMAP");
    visit.Choice("matching", &matching, kImageMatchingNames,
                 "images are matched with each other (exhaustive), or with those next to them in "
                 "rgb.txt (sequential); auto: by their number");
    visit.Integer("exhaustive_max_images", &exhaustive_max_images, {2, 100000},
                  "the most images for which auto is exhaustive");
    visit.Choice("image_orientation", &image_orientation, kImageOrientationNames,
                 "where EXIF turns images: camera, poses and points are those of the images as "
                 "viewers show them, or as the file stores them, for stages with the same setting. "
                 "A finished model of the others is turned. COLMAP reads images as they are stored "
                 "and runs on no others");
    visit.Text("moving_labels", &moving_labels,
               "labels of things that move, separated by commas: COLMAP finds no features in their "
               "boxes, if the dataset has a detections.csv; empty: none");
  }
};

}  // namespace soslam
