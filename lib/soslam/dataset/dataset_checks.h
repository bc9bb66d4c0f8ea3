// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/import_options.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/model/finding.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Input of the checks of a dataset: the content that its reader found, and the sequence left after
// the gates.
struct ImportView {
  const std::filesystem::path& folder;
  const ImportOptions& options;
  const DatasetContent& content;
  const Sequence& sequence;
};

// The likely cause of a finding, and what to do.
struct Advice {
  std::string cause;
  std::string remedy;
};

// Checks for common mistakes in datasets. They return their findings and throw nothing.

// Plausibility of the intrinsics: normalised, in millimetres, of another image size; and of the
// lens.
std::vector<Finding> CheckCamera(const ImportView& view);
// The camera's image size against the headers of the image files, and images with an EXIF rotation.
std::vector<Finding> CheckImages(const ImportView& view);
// Boxes in another convention or of another image size.
std::vector<Finding> CheckBoxes(const ImportView& view);
// Scores outside 0 to 1.
std::vector<Finding> CheckScores(const ImportView& view);
// Class numbers that count from 1 where the list of names counts from 0, or the reverse.
std::vector<Finding> CheckClassNumbers(const ImportView& view);

// Labels of the setting `labels` that nothing in the dataset has.
std::vector<Finding> CheckLabels(const ImportView& view);
// Blank lines between names, which count as classes for programs that identify names by line.
std::vector<Finding> CheckBlankLines(const ImportView& view);
// Gates that reject more than a third of the detections.
std::vector<Finding> CheckRejections(const ImportView& view);
// The trajectory against the true one: inverse, another world, another order of the quaternion.
std::vector<Finding> CheckTruth(const ImportView& view);
// The poses against the boxes: another pose convention, or mirrored boxes (kPoseConvention), frames
// in another order (kFrameOrder), poses of an IMU, poses of other times (CheckLag); or poses,
// frames or ids that contradict the boxes in another way (kBoxesAgainstPoses).
inline constexpr const char* kPoseConvention = "pose_convention";
inline constexpr const char* kFrameOrder = "frame_order";
inline constexpr const char* kPoseLag = "pose_lag";
inline constexpr const char* kRepeatedPoses = "repeated_poses";
inline constexpr const char* kBoxesAgainstPoses = "boxes_against_poses";
std::vector<Finding> CheckPoses(const ImportView& view);
// True if a frame has exactly the pose of that before in its segment.
bool RepeatsPose(const std::vector<ListedFrame>& frames, size_t i);
// Consecutive frames with exactly the same pose whose images or boxes move.
std::vector<Finding> CheckRepeatedPoses(const ImportView& view);
// True objects against the boxes with their ids, and against their planes: another world, ids
// counted from 1, full sizes instead of half axes; quaternions with qw first.
std::vector<Finding> CheckObjects(const ImportView& view);
std::vector<Finding> CheckObjectAxes(const ImportView& view);
// The support plane of most objects against cameras and objects.
std::vector<Finding> CheckPlanes(const ImportView& view);

// Time stamps of images against those of a trajectory, which is not empty.
std::vector<Finding> CheckTimestamps(const std::vector<ListedImage>& images,
                                     const std::vector<TimedPose>& trajectory,
                                     const std::string& trajectory_file, double max_difference_s);

// All checks of a dataset, including the findings of its reader; errors first.
std::vector<Finding> CheckDataset(const ImportView& view);

}  // namespace soslam
