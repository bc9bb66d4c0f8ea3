// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "soslam/base/options.h"
#include "soslam/geometry/image_size.h"
#include "soslam/model/sequence.h"

namespace soslam {

enum class DatasetFormat {
  kSoslam,
  kTumRgbd,
  kIclNuim,
  kKittiTracking,
  kKittiObject,
  kSlamSynthetic
};
inline constexpr const char* kDatasetFormatNames[] = {
    "soslam", "tum_rgbd", "icl_nuim", "kitti_tracking", "kitti_object", "slam_synthetic"};

enum class TrajectorySource { kOdometry, kGroundTruth };
inline constexpr const char* kTrajectorySourceNames[] = {"odometry", "groundtruth"};

enum class PlanePoses { kGroundTruth, kTrajectory };
inline constexpr const char* kPlanePosesNames[] = {"groundtruth", "trajectory"};

enum class HeldOutFrames {
  kNone,
  kOdd,  // every other used frame, starting with the second
};
inline constexpr const char* kHeldOutFramesNames[] = {"none", "odd"};

enum class TrajectoryFormat { kTum, kKitti, kEuroc, kColmap, kNerfstudio, kSame };
inline constexpr const char* kTrajectoryFormatNames[] = {"tum",    "kitti",      "euroc",
                                                         "colmap", "nerfstudio", "same"};

enum class DetectionsFormat { kCsv, kYolo, kYoloPixels, kCoco, kOaSlam, kKitti };
inline constexpr const char* kDetectionsFormatNames[] = {"csv",  "yolo",    "yolo_pixels",
                                                         "coco", "oa_slam", "kitti"};

// Files of a folder of images and their formats. Paths are relative to the dataset folder, or
// absolute.
struct FolderOptions {
  std::string images = "rgb.txt";
  std::string odometry = "odometry.txt";
  std::string groundtruth = "groundtruth.txt";
  TrajectoryFormat trajectory_format = TrajectoryFormat::kTum;
  TrajectoryFormat groundtruth_format = TrajectoryFormat::kSame;
  bool align_odometry = false;
  bool odometry_has_own_scale = false;
  std::string camera;
  std::string camera_file;
  std::string distortion;
  DetectionsFormat detections_format = DetectionsFormat::kCsv;
  std::string class_names;

  void Describe(OptionVisitor& visit) {
    visit.Group("Files of a folder of images");
    visit.OnlyWhere({{"format", {"soslam", "tum_rgbd", "icl_nuim"}}}, [&] {
      visit.Text(
          "images", &images,
          "the list of images, lines \"timestamp filename\" (or EuRoC's, with a comma); of "
          "tum_rgbd and icl_nuim also pairs of colour and depth images; a *.json: nerfstudio's "
          "frames; empty: the images are those that the detections name by their timestamps");
      visit.Text("odometry", &odometry, "the file with the pose estimates");
      visit.Text("groundtruth", &groundtruth, "the file with the true poses");
      visit.Choice("trajectory_format", &trajectory_format,
                   std::span(kTrajectoryFormatNames).first(5),  // not "same"
                   "format of the poses of the odometry: timestamp tx ty tz qx qy qz qw (tum, "
                   "ORB-SLAM); 12 numbers, one line for each listed image (kitti); EuRoC's CSV, "
                   "nanoseconds, qw first (euroc); by the names of the images COLMAP's images.txt "
                   "or images.bin (colmap) or nerfstudio's transforms.json (nerfstudio)");
      visit.Choice("groundtruth_format", &groundtruth_format, kTrajectoryFormatNames,
                   "format of the poses of the ground truth; same: as trajectory_format says");
    });
    visit.Flag("align_odometry", &align_odometry,
               "the odometry has a world of its own: it is moved as a "
               "whole so that its first pose that has a true one is that");
    visit.Flag("odometry_has_own_scale", &odometry_has_own_scale,
               "the unit of the odometry is not the metre, as that of a single camera: maps are "
               "compared with the truth at the scale that fits best");
    visit.OnlyWhere({{"format", {"soslam", "tum_rgbd", "icl_nuim"}}}, [&] {
      visit.Text("camera", &camera,
                 "\"width height fx fy cx cy\" in pixels; empty: the camera file says it");
      visit.Text("camera_file", &camera_file,
                 "the file with the camera: camera.json, ROS', OpenCV's or Kalibr's calibration "
                 "(.yaml, .xml), COLMAP's cameras.txt or cameras.bin, nerfstudio's "
                 "transforms.json; empty: camera.json");
      visit.Text("distortion", &distortion,
                 "distortion of images and boxes by the lens: \"k1 k2 p1 p2 k3\" as OpenCV has "
                 "them, or 4, 8, 12 "
                 "or 14 of its coefficients; empty: the camera file says it, or nothing");
      visit.Choice("detections_format", &detections_format, kDetectionsFormatNames,
                   "format of `detections`: detections.csv with or without object ids (csv); a "
                   "folder or archive of text files with fractions of the image (yolo) or pixels "
                   "from the upper left corner (yolo_pixels); COCO's results (coco); OA-SLAM's "
                   "JSON (oa_slam); <class>/<name>.txt, or a folder of such class folders (kitti)");
      visit.OnlyWhere({{"detections_format", {"yolo", "yolo_pixels", "oa_slam", "coco"}}}, [&] {
        visit.Text("class_names", &class_names,
                   "the file with the names of the classes, one a line; coco: the JSON file of the "
                   "dataset; empty: COCO's");
      });
    });
  }
};

// Settings of the readers of KITTI's formats.
struct KittiOptions {
  std::string sequences;
  double match_min_iou = 0.5;
  std::string poses = "poses";
  std::string translation_scale = "1";
  std::string image_size = "1242x375";
  double static_radius_m = 1.0;
  double static_share = 0.9;
  int static_min_views = 10;

  void Describe(OptionVisitor& visit) {
    visit.Group("Recordings of KITTI and other problems");
    visit.OnlyWhere({{"format", {"kitti_tracking", "slam_synthetic"}}}, [&] {
      visit.Text("sequences", &sequences,
                 "kitti_tracking: the recordings to read, as in \"0001 0003-0005\"; "
                 "slam_synthetic: the names of the problems; empty: all");
    });
    visit.OnlyWhere({{"format", {"kitti_tracking"}}}, [&] {
      visit.Real("match_min_iou", &match_min_iou, {1e-6, 1},
                 "a detector's box matches a labelled one with at least this overlap "
                 "(intersection over union, 2D)");
      visit.Text("poses", &poses, "the folder with the camera poses");
      visit.Text("translation_scale", &translation_scale,
                 "what the poses' translations are multiplied by; by recording as in "
                 "\"0000-0013:0.969 0020:0.988\", or one number for all");
    });
    visit.OnlyWhere({{"format", {"kitti_tracking", "kitti_object"}}}, [&] {
      visit.Text("image_size", &image_size,
                 "width and height of recordings without any image in pixels, by recording as in "
                 "\"0000-0013:1242x375\", or one for all");
    });
    visit.OnlyWhere({{"format", {"kitti_tracking"}}}, [&] {
      visit.Real("static_radius_m", &static_radius_m, {0, 1e6},
                 "an object is static when, seen often enough, most of its labelled "
                 "positions in the world are at most this far from their median");
      visit.Real("static_share", &static_share, {0, 1},
                 "how many of a static object's positions have to be that near");
      visit.Integer("static_min_views", &static_min_views, {1, 1000000},
                    "objects with fewer labels are not known to be static");
    });
  }
};

struct ImportOptions {
  DatasetFormat format = DatasetFormat::kSoslam;
  TrajectorySource trajectory = TrajectorySource::kOdometry;
  std::string odometry_source;
  PlanePoses camera_planes = PlanePoses::kGroundTruth;
  std::string detections;
  ImageOrientation image_orientation = ImageOrientation::kUpright;
  int first_frame = 0;
  int frame_stride = 1;
  HeldOutFrames held_out = HeldOutFrames::kNone;
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
  std::string moving_labels = kMovingLabels;
  bool scene_axes = true;
  FolderOptions folder;
  KittiOptions kitti;

  void Describe(OptionVisitor& visit) {
    visit.Group("Dataset");
    visit.Choice("format", &format, kDatasetFormatNames, "what the dataset folder holds");
    visit.OnlyWhere({{"format", {"soslam", "tum_rgbd", "icl_nuim", "slam_synthetic"}}}, [&] {
      visit.Choice("trajectory", &trajectory, kTrajectorySourceNames,
                   "which poses are the estimates; the others when a folder does not have them");
    });
    visit.Text("odometry_source", &odometry_source,
               "source of the pose estimates, as tables of maps name it: ORB-SLAM2, COLMAP, "
               "simulated; empty: not said");
    visit.Choice("camera_planes", &camera_planes, kPlanePosesNames,
                 "the poses that carry annotated world planes into each frame; the trajectory when "
                 "there is no ground truth");
    visit.Text("detections", &detections,
               "the file or folder with the boxes; empty: detections.csv, of kitti_tracking the "
               "boxes of its labels (\"labels\"). For kitti_tracking the folder of a detector, "
               "whose boxes take the objects of the labels that they match");
    visit.Choice("image_orientation", &image_orientation, kImageOrientationNames,
                 "where EXIF turns images: camera and boxes refer to the image as viewers show it, "
                 "or to the pixels as the file stores them");
    visit.Real("max_time_difference_s", &max_time_difference_s, {0, 1e6},
               "an image takes the pose nearest in time, at most this far away");
    visit.Group("Frames");
    visit.Integer("first_frame", &first_frame, {0, 1000000},
                  "images before this one, counted from 0 in each segment, are not used");
    visit.Integer("frame_stride", &frame_stride, {1, 1000000},
                  "of the images from first_frame on every n-th is used");
    visit.Choice("held_out", &held_out, kHeldOutFramesNames,
                 "which of the used frames no estimate gets to see; what was detected there is "
                 "kept to judge landmarks by (odd: the second, the fourth, ... of each segment)");
    visit.Flag("images_only", &images_only, "frames whose image the dataset lacks are not used");
    visit.Group("Detections that are used");
    visit.Text("labels", &labels,
               "detections of other labels are dropped; commas between several, empty: all are "
               "used");
    visit.Real("min_score", &min_score, {0, 1}, "detections with a lower score are dropped");
    visit.Real("border_px", &border_px, {0, 1e5},
               "boxes closer to the image border than this are dropped");
    visit.Real("min_box_height_px", &min_box_height_px, {0, 1e5}, "lower boxes are dropped");
    visit.Real("max_truncation", &max_truncation, {0, 100},
               "detections whose label says that more is outside the image are dropped; in the "
               "dataset's measure (kitti_tracking: 0, 1, 2; kitti_object: share)");
    visit.Integer("max_occlusion", &max_occlusion, {0, 100},
                  "detections whose label says that more is hidden are dropped; in the dataset's "
                  "measure (kitti: 0 visible, 1 partly, 2 largely hidden, 3 unknown)");
    visit.Integer("min_observations", &min_observations, {1, 1000000},
                  "objects with fewer usable detections lose them all; of no effect where "
                  "detections do not say which object they are of");
    visit.Real("hidden_edge_fraction", &hidden_edge_fraction, {0, 1},
               "the share of a box's lower edge that must lie inside boxes of nearer objects for "
               "it to be one-sided: the object may extend beyond it");
    visit.Text("moving_labels", &moving_labels,
               "labels of things that move, separated by commas: they get no place in a map made "
               "of boxes without ids, and points in any of their boxes are no evidence; empty: "
               "none");
    visit.Flag("scene_axes", &scene_axes,
               "the directions along which the straight edges of the images lie on the support "
               "planes are estimated, for later stages to prefer them for objects");
    folder.Describe(visit);
    kitti.Describe(visit);
  }
};

}  // namespace soslam
