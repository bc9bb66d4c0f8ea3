// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/base/upper_median.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/dataset_files.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/kitti_label.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/evaluation/statistics.h"

namespace soslam {
namespace {

// Median of each coordinate.
template <typename Vector>
Eigen::Vector3d Median(const std::vector<Landmark>& landmarks, const Vector& vector) {
  Eigen::Vector3d median;
  for (int i = 0; i < 3; ++i) {
    const auto value = [&](const Landmark& landmark) { return std::invoke(vector, landmark)[i]; };
    median[i] = UpperMedian(CollectValues(landmarks, value));
  }
  return median;
}

Landmark MedianLandmark(const std::vector<Landmark>& landmarks) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  Eigen::Vector3d front = Eigen::Vector3d::Zero();
  for (const Landmark& landmark : landmarks) {
    up += landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
    front += landmark.frame_from_object.rotation * Eigen::Vector3d::UnitX();
  }
  up.normalize();
  front = (front - front.dot(up) * up).normalized();
  Landmark median = landmarks.front();
  median.frame_from_object = {UprightRotation(front, up), Median(landmarks, &Landmark::Centre)};
  median.half_axes = Median(landmarks, &Landmark::half_axes);
  return median;
}

namespace fs = std::filesystem;

constexpr int kIdsPerRecording = 10000;
constexpr double kFrameInterval = 0.1;  // seconds

// Reads one recording into the content.
class Recording {
 public:
  Recording(const fs::path& folder, const NumberedPath& labels, const ImportOptions& options,
            DatasetContent* content)
      : folder_(folder),
        number_(labels.number),
        file_(labels.path.filename()),
        options_(options),
        content_(content) {
    calibration_ = ReadKittiCalibration(Read(folder / "calib" / file_));
    labels_ = ReadKittiLabels(Read(labels.path), /*has_tracks=*/true);
    poses_ = ReadKittiTrajectory(Read(folder / options_.kitti.poses / file_));
    const double scale =
        RecordingValues("translation_scale", options_.kitti.translation_scale).PositiveOf(number_);
    for (Rigid3d& pose : poses_) pose.translation *= scale;
    CheckIds();
  }

  void Add() {
    AddFrames();
    AddObjects();
    if (options_.detections.empty() || options_.detections == "labels") {
      for (const KittiLabel& label : labels_) AddRow(label, label.box, label.score);
    } else {
      AddFoundBoxes();
    }
  }

 private:
  fs::path Read(const fs::path& path) {
    content_->files.push_back(RequiredFile(path));
    return path;
  }

  int Id(int number_in_recording) const { return number_ * kIdsPerRecording + number_in_recording; }

  void CheckIds() const {
    const int frames = static_cast<int>(poses_.size());
    for (const KittiLabel& label : labels_) {
      if (label.frame < 0 || label.frame >= frames) {
        throw InputError(fmt::format("{}: frame is {}; expected 0 to {}, as there are {} poses",
                                     label.place, label.frame, frames - 1, frames));
      }
      if (label.track < 0 || label.track >= kIdsPerRecording) {
        throw InputError(fmt::format("{}: track is {}; expected 0 to {}", label.place, label.track,
                                     kIdsPerRecording - 1));
      }
    }
    if (frames > kIdsPerRecording || number_ < 0 || number_ >= kIdsPerRecording) {
      throw InputError(fmt::format("{}: has {} frames; expected recordings and frames below {}",
                                   file_.string(), frames, kIdsPerRecording));
    }
  }

  void AddFrames() {
    const fs::path images = fs::path("image_02") / file_.stem();
    std::vector<Frame> frames(poses_.size());
    std::optional<fs::path> any_image;
    for (size_t i = 0; i < frames.size(); ++i) {
      Frame& frame = frames[i];
      frame.id = Id(static_cast<int>(i));
      frame.timestamp = kFrameInterval * static_cast<double>(i);
      frame.world_from_camera = poses_[i];
      frame.segment = number_;
      const fs::path image = images / fmt::format("{:06d}.png", i);
      const fs::path path = ImagePath(folder_, image.string(), folder_.string());
      if (!Exists(path)) continue;
      frame.image = image.string();
      if (!any_image) any_image = path;
    }
    camera_ = WithImageSize(calibration_.camera, any_image, options_.image_orientation,
                            RecordingValues("image_size", options_.kitti.image_size), number_);
    for (Frame& frame : frames) content_->AddFrame(std::move(frame), camera_);
  }

  void AddObjects() {
    std::map<int, std::vector<const KittiLabel*>> tracks;
    for (const KittiLabel& label : labels_) tracks[label.track].push_back(&label);
    for (auto& [track, labels] : tracks) {
      std::ranges::stable_sort(labels, {}, &KittiLabel::frame);
      const auto again = std::ranges::adjacent_find(labels, {}, &KittiLabel::frame);
      if (again != labels.end()) {
        throw InputError(
            fmt::format("{}: track {} again in frame {}; expected each track once a frame",
                        (*std::next(again))->place, track, (*again)->frame));
      }
      std::vector<Landmark> in_world;
      for (const KittiLabel* label : labels) {
        if (label->type != labels.front()->type) {
          throw InputError(fmt::format("{}: type of track {} is '{}'; expected '{}', as before",
                                       label->place, track, label->type, labels.front()->type));
        }
        const Landmark landmark_in_camera = LandmarkInCamera(*label, calibration_);
        in_world.push_back(Transform(poses_[label->frame], landmark_in_camera));
        content_->labels_in_frames.push_back({Id(label->frame), Id(track), landmark_in_camera});
      }
      Object object;
      object.id = Id(track);
      object.label = LowerCase(labels.front()->type);
      const Landmark median = MedianLandmark(in_world);
      const auto near = std::ranges::count_if(in_world, [&](const Landmark& view) {
        return (view.Centre() - median.Centre()).norm() <= options_.kitti.static_radius_m;
      });
      const auto views = static_cast<double>(in_world.size());
      object.is_static = static_cast<int>(in_world.size()) >= options_.kitti.static_min_views &&
                         static_cast<double>(near) >= options_.kitti.static_share * views;
      object.ground_truth.emplace().landmark_in_world =
          object.is_static ? median : in_world.front();
      AddLabelledObject(std::move(object), number_, &content_->sequence);
    }
  }

  void AddRow(const KittiLabel& label, const Box& box, double score) {
    DetectionRow row = RowOfLabel(label, box, score, calibration_, camera_);
    row.frame_id = Id(label.frame);
    row.object_id = Id(label.track);
    content_->rows.push_back(std::move(row));
  }

  // Adds the detector's boxes from one folder per object type.
  void AddFoundBoxes() {
    const fs::path folder = folder_ / options_.detections;
    std::vector<fs::path> types;
    if (IsFolder(folder))
      std::ranges::copy_if(FolderEntries(folder), std::back_inserter(types), &IsFolder);
    if (types.empty()) {
      throw InputError(
          fmt::format("{}: has no folders; expected one for each type of object", folder.string()));
    }
    for (const fs::path& type : types) {
      std::map<int, std::vector<LabelledBox>> found_by_frame;
      for (LabelledBox& found : ReadKittiBoxes(Read(type / file_))) {
        found_by_frame[std::get<int>(found.frame)].push_back(std::move(found));
      }
      for (const auto& [frame, found] : found_by_frame) AddMatches(frame, found);
    }
  }

  // `found`: the boxes of one type in this frame.
  void AddMatches(int frame, const std::vector<LabelledBox>& found) {
    std::vector<const KittiLabel*> labels;
    std::vector<Box> given;
    for (const KittiLabel& label : labels_) {
      if (label.frame != frame || label.type != found.front().label) continue;
      labels.push_back(&label);
      given.push_back(label.box);
    }
    const auto matches = MatchBoxes(found, given, options_.kitti.match_min_iou);
    for (size_t i = 0; i < matches.size(); ++i) {
      if (matches[i]) {
        AddRow(*labels[*matches[i]], found[i].box, found[i].score);
      } else if (frame < static_cast<int>(poses_.size())) {
        content_->rejected.Add({found[i].place, Id(frame), kNoObject, LowerCase(found[i].label),
                                found[i].score, found[i].box},
                               RejectReason::kMatchesNoLabel);
      } else {
        ++content_->rejected.counts[NameOf(RejectReason::kMatchesNoLabel)];
      }
    }
  }

  fs::path folder_;
  int number_;
  fs::path file_;  // SSSS.txt
  const ImportOptions& options_;
  DatasetContent* content_;
  KittiCalibration calibration_;
  Camera camera_;
  std::vector<KittiLabel> labels_;
  std::vector<Rigid3d> poses_;
};

}  // namespace

DatasetContent ReadKittiTracking(const fs::path& folder, const ImportOptions& options) {
  std::vector<NumberedPath> recordings = NumberedFiles(folder / "label_02", ".txt");
  const auto ranges = ParseRecordings("sequences", options.kitti.sequences);
  const auto is_in = [](const RecordingRange& range, const NumberedPath& recording) {
    return range.Contains(recording.number);
  };
  for (const RecordingRange& range : ranges) {
    if (std::ranges::any_of(recordings, [&](const auto& file) { return is_in(range, file); })) {
      continue;
    }
    throw SettingsError(fmt::format("sequences: {:04d} to {:04d}: no such recording in {}",
                                    range.first, range.last, (folder / "label_02").string()));
  }
  std::erase_if(recordings, [&](const NumberedPath& file) {
    const auto has_file = [&](const auto& range) { return is_in(range, file); };
    return !ranges.empty() && std::ranges::none_of(ranges, has_file);
  });
  DatasetContent content;
  for (const NumberedPath& labels : recordings) {
    Recording(folder, labels, options, &content).Add();
  }
  return content;
}

}  // namespace soslam
