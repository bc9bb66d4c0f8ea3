// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "soslam/dataset/gate.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/image_size.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Settings for KITTI's numbered recordings, whose files are named by number: "0013.txt". All
// functions throw SettingsError naming the option.

// Recordings `first` to `last`, inclusive.
struct RecordingRange {
  int first = 0;
  int last = 0;
  bool Contains(int recording) const { return recording >= first && recording <= last; }
};

// Parses "0001 0003-0005", blanks between ranges.
std::vector<RecordingRange> ParseRecordings(const std::string& option, std::string_view text);

// Values per recording, "0000-0013:0.969 0020:0.988", or one value for all.
class RecordingValues {
 public:
  RecordingValues(const std::string& option, const std::string& text);
  // Value of a recording. Throws SettingsError when there is none.
  const std::string& Of(int recording) const;
  // Value of a recording as a number above 0.
  double PositiveOf(int recording) const;

 private:
  struct Entry {
    RecordingRange range;
    std::string value;
  };
  std::string option_;
  std::vector<Entry> entries_;
};

// Common parts of KITTI's tracking and object benchmarks. Everything is in the frame of camera 2
// (left colour), which takes the images, except the values of KittiLabel.

// Camera of the projection P2 of a calibration file: pixel = P2 [x; 1], x in the rectified frame of
// camera 0.
struct KittiCalibration {
  Camera camera;                                                   // without its size
  Eigen::Vector3d camera2_from_camera0 = Eigen::Vector3d::Zero();  // translation, m; no rotation
};
// Throws InputError naming the file and line.
KittiCalibration ReadKittiCalibration(const std::filesystem::path& path);

// One labelled object in one frame, as the file has it: rectified frame of camera 0.
struct KittiLabel {
  std::string place;  // "<file>:<line>"
  int frame = 0;
  int track = 0;
  std::string type;        // "Car"
  double truncated = 0.0;  // tracking: 0, 1, 2; object: share
  int occluded = 0;        // 0 visible, 1 partly, 2 largely hidden, 3 unknown
  Box box;
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  // height, width, length, m
  Eigen::Vector3d bottom_centre = Eigen::Vector3d::Zero();
  double rotation_y = 0.0;  // rad; 0: the length along the camera's x axis
  double score = 1.0;       // in results of detectors and trackers
};

// Reads labels: 17 values per line, starting with frame and track (tracking), or 15 without these
// (object: frame 0, track counted from 0), followed by a score in results of detectors and
// trackers. Unlabelled regions (DontCare) are left out. Throws InputError naming the line.
std::vector<KittiLabel> ReadKittiLabels(const std::filesystem::path& path, bool has_tracks);

// Reads 2D detections of a KITTI sequence as trackers exchange them: <class>/<sequence>.txt, lines
// "frame,x1,y1,x2,y2,score", frames counted from 0, pixels as in KITTI's labels. The label is the
// name of the file's folder, unchanged ("Car"). In file order; a file may have no boxes. Throws
// InputError naming the line.
std::vector<LabelledBox> ReadKittiBoxes(const std::filesystem::path& path);

// For each found box the index of its given box, if any. One to one and greedy: found boxes in
// order of descending score take the free given box with the largest overlap of at least
// `min_overlap`.
std::vector<std::optional<size_t>> MatchBoxes(const std::vector<LabelledBox>& found,
                                              const std::vector<Box>& given, double min_overlap);

// A file or folder with a number as its name: "0013.txt".
struct NumberedPath {
  int number;
  std::filesystem::path path;
};
// The numbered files in a folder with this extension, sorted by number. Throws InputError for a
// name that is not a number, and when there is none.
std::vector<NumberedPath> NumberedFiles(const std::filesystem::path& folder,
                                        const std::string& extension);

// The path, if it is a file. Throws InputError otherwise.
std::filesystem::path RequiredFile(const std::filesystem::path& path);

// The camera with the size (px) of the image; without an image the size is that of the setting.
Camera WithImageSize(Camera camera, const std::optional<std::filesystem::path>& image,
                     ImageOrientation orientation, const RecordingValues& image_size,
                     int recording);

// Rotation from an object frame with these directions of its front (x) and of up (z).
Eigen::Quaterniond UprightRotation(const Eigen::Vector3d& front, const Eigen::Vector3d& up);

// The labelled cuboid in the frame of camera 2: x along the length, z up.
Landmark LandmarkInCamera(const KittiLabel& label, const KittiCalibration& calibration);

// Adds an object with a true landmark, and its support plane with the same id: the bottom face of
// that landmark.
void AddLabelledObject(Object object, int segment, Sequence* sequence);

// Converts a label to a detection: `box` cut to the image; plane (the label's bottom face) and
// landmark from the label.
DetectionRow RowOfLabel(const KittiLabel& label, const Box& box, double score,
                        const KittiCalibration& calibration, const Camera& camera);

}  // namespace soslam
