// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "base/options.h"

namespace soslam {

enum class DatasetFormat { kSoslam, kKittiTracking, kKittiObject };
inline constexpr const char* kDatasetFormatNames[] = {"soslam", "kitti_tracking", "kitti_object"};

enum class TrajectorySource { kOdometry, kGroundTruth };
inline constexpr const char* kTrajectorySourceNames[] = {"odometry", "groundtruth"};

enum class PlanePoses { kGroundTruth, kTrajectory };
inline constexpr const char* kPlanePosesNames[] = {"groundtruth", "trajectory"};

// What the readers of KITTI's formats need to know beyond the files.
struct KittiOptions {
  std::string sequences;
  std::string detections = "labels";
  double match_min_iou = 0.5;
  std::string poses = "poses";
  std::string translation_scale = "1";
  std::string image_size = "1242x375";
  double static_radius_m = 1.0;
  double static_share = 0.9;
  int static_min_views = 10;

  void Describe(OptionVisitor& visit) {
    visit.Text("sequences", &sequences,
               "kitti_tracking: the recordings to read, as in \"0001 0003-0005\"; empty: all");
    visit.Text("detections", &detections,
               "kitti_tracking: whose boxes to use: those of the labels, or of a detector, by the "
               "name of its folder; its boxes take the objects of the labels that they match");
    visit.Real("match_min_iou", &match_min_iou, {1e-6, 1},
               "kitti_tracking: a detector's box matches a labelled one with at least this overlap "
               "(intersection over union, 2D)");
    visit.Text("poses", &poses, "kitti_tracking: the folder with the camera poses");
    visit.Text("translation_scale", &translation_scale,
               "kitti_tracking: what the poses' translations are multiplied by; by recording as in "
               "\"0000-0013:0.969 0020:0.988\", or one number for all");
    visit.Text("image_size", &image_size,
               "kitti: width and height of recordings without any image (px), by recording as in "
               "\"0000-0013:1242x375\", or one for all");
    visit.Real("static_radius_m", &static_radius_m, {0, 1e6},
               "kitti_tracking: an object is static when, seen often enough, most of its labelled "
               "positions in the world are at most this far from their median (m)");
    visit.Real("static_share", &static_share, {0, 1},
               "kitti_tracking: how many of a static object's positions have to be that near");
    visit.Integer("static_min_views", &static_min_views, {1, 1000000},
                  "kitti_tracking: objects with fewer labels are not known to be static");
  }
};

struct ImportOptions {
  DatasetFormat format = DatasetFormat::kSoslam;
  TrajectorySource trajectory = TrajectorySource::kOdometry;
  PlanePoses camera_planes = PlanePoses::kGroundTruth;
  int frame_stride = 1;
  bool images_only = false;
  std::string labels;
  double max_truncation = 100.0;
  int max_occlusion = 100;
  double min_box_height_px = 0.0;
  double border_px = 30.0;
  int min_observations = 3;
  double max_time_difference_s = 0.02;
  double min_score = 0.0;
  double hidden_edge_fraction = 0.7;
  KittiOptions kitti;

  void Describe(OptionVisitor& visit) {
    visit.Choice("format", &format, kDatasetFormatNames, "what the dataset folder holds");
    visit.Choice("trajectory", &trajectory, kTrajectorySourceNames,
                 "soslam: the file with the pose estimates; the other one when it is absent");
    visit.Choice("camera_planes", &camera_planes, kPlanePosesNames,
                 "the poses that carry annotated world planes into each frame; the trajectory when "
                 "there is no ground truth");
    visit.Integer("frame_stride", &frame_stride, {1, 1000000}, "every n-th image is used");
    visit.Flag("images_only", &images_only, "frames whose image the dataset lacks are not used");
    visit.Text("labels", &labels,
               "detections of other labels are dropped; commas between several, empty: all are "
               "used");
    visit.Real("max_truncation", &max_truncation, {0, 100},
               "detections whose label says that more is outside the image are dropped; in the "
               "dataset's measure (kitti_tracking: 0, 1, 2; kitti_object: share)");
    visit.Integer("max_occlusion", &max_occlusion, {0, 100},
                  "detections whose label says that more is hidden are dropped; in the dataset's "
                  "measure (kitti: 0 visible, 1 partly, 2 largely hidden, 3 unknown)");
    visit.Real("min_box_height_px", &min_box_height_px, {0, 1e5}, "lower boxes are dropped (px)");
    visit.Real("border_px", &border_px, {0, 1e5},
               "boxes closer to the image border than this are dropped (px)");
    visit.Integer("min_observations", &min_observations, {1, 1000000},
                  "objects with fewer usable detections lose them all");
    visit.Real("max_time_difference_s", &max_time_difference_s, {0, 1e6},
               "an image takes the pose nearest in time, at most this far away (s)");
    visit.Real("min_score", &min_score, {0, 1}, "detections with a lower score are dropped");
    visit.Real(
        "hidden_edge_fraction", &hidden_edge_fraction, {0, 1},
        "the share of a box's lower edge that must lie inside boxes of nearer objects for it "
        "to be a lower bound only");
    kitti.Describe(visit);
  }
};

}  // namespace soslam
