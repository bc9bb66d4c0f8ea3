// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <variant>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/dataset/dataset_checks.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/nerfstudio.h"
#include "soslam/dataset/soslam_folder.h"
#include "soslam/dataset/text_file.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Poses per image; none where there is no pose near enough in time. Those without time stamps have
// that of their image.
using ImagePoses = std::vector<std::optional<TimedPose>>;

std::vector<ListedImage> ImagesOfBoxes(const std::vector<LabelledBox>& boxes) {
  std::map<double, ListedImage> images;
  for (const LabelledBox& box : boxes) {
    const auto* name = std::get_if<std::string>(&box.frame);
    if (name == nullptr) {
      throw InputError(fmt::format(
          "{}: image is row {} of a list; expected a list of images, or a name that is a timestamp",
          box.place, std::get<int>(box.frame)));
    }
    // The name may lack an extension: that of "12.5" is a part of the number.
    const fs::path file = fs::path(*name).filename();
    const bool is_decimals = std::ranges::all_of(
        file.extension().string(), [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
    const double timestamp = ParseReal((is_decimals ? file : file.stem()).string(), box.place,
                                       "timestamp as which the image is named");
    images.try_emplace(timestamp, ListedImage{timestamp, *name});
  }
  if (images.empty()) throw InputError("the detections name no image; expected a list of images");
  std::vector<ListedImage> listed;
  for (const auto& [timestamp, image] : images) listed.push_back(image);
  return listed;
}

// Seconds of an ICL-NUIM frame number.
double SecondsOfFrameNumber(double number, const std::string& place) {
  if (number >= 0.0 && number == std::floor(number)) return number / kIclNuimFramesPerSecond;
  throw InputError(fmt::format(
      "{}: timestamp is {}; expected the number of a frame, as ICL-NUIM has it", place, number));
}

ImagePoses PosesByTime(const fs::path& path, TrajectoryFormat format, const ImportOptions& options,
                       const std::vector<ListedImage>& images, std::vector<Finding>* findings) {
  std::vector<TimedPose> trajectory =
      format == TrajectoryFormat::kEuroc ? ReadEurocTrajectory(path) : ReadTrajectory(path);
  if (options.format == DatasetFormat::kIclNuim) {
    for (TimedPose& pose : trajectory) {
      pose.timestamp = SecondsOfFrameNumber(pose.timestamp, path.string());
    }
  }
  std::ranges::move(
      CheckTimestamps(images, trajectory, path.filename().string(), options.max_time_difference_s),
      std::back_inserter(*findings));
  ImagePoses poses;
  size_t matched = 0;
  double largest_s = 0.0;
  for (const ListedImage& image : images) {
    const auto pose = NearestPose(trajectory, image.timestamp, options.max_time_difference_s);
    poses.push_back(pose);
    if (!pose) continue;
    ++matched;
    largest_s = std::max(largest_s, std::abs(pose->timestamp - image.timestamp));
  }
  fmt::print(
      "{}: {} of {} images have a pose, at most {:.1f} ms away; {} have none within {:g} ms\n",
      path.filename().string(), matched, images.size(), 1e3 * largest_s, images.size() - matched,
      1e3 * options.max_time_difference_s);
  return poses;
}

ImagePoses PosesByName(const fs::path& path, const std::vector<NamedPose>& named,
                       const std::vector<ListedImage>& images) {
  ImagePoses poses(images.size());
  const auto rows = RowsOfPoses(named, images);
  for (size_t i = 0; i < rows.size(); ++i) {
    if (rows[i]) poses[*rows[i]] = {images[*rows[i]].timestamp, named[i].world_from_camera};
  }
  const auto unlisted = std::ranges::count_if(rows, [](const auto& row) { return !row; });
  fmt::print("{}: {} of {} images have a pose; {} poses are of images that are not listed\n",
             path.filename().string(), std::ssize(rows) - unlisted, images.size(), unlisted);
  return poses;
}

ImagePoses ReadPoses(const fs::path& path, TrajectoryFormat format, const ImportOptions& options,
                     const std::vector<ListedImage>& images,
                     const std::optional<Rigid3d>& body_from_camera,
                     std::vector<Finding>* findings) {
  const bool is_mirrored = options.format == DatasetFormat::kIclNuim;
  if (is_mirrored && format != TrajectoryFormat::kTum && format != TrajectoryFormat::kKitti) {
    throw SettingsError(
        "trajectory_format, groundtruth_format: expected tum or kitti for format icl_nuim");
  }
  ImagePoses poses;
  if (format == TrajectoryFormat::kKitti) {
    const std::vector<Rigid3d> trajectory = ReadKittiTrajectory(path);
    if (trajectory.size() != images.size()) {
      throw InputError(fmt::format("{}: has {} poses; expected {}, one for each listed image",
                                   path.string(), trajectory.size(), images.size()));
    }
    for (size_t i = 0; i < images.size(); ++i) {
      poses.push_back(TimedPose{images[i].timestamp, trajectory[i]});
    }
  } else if (format == TrajectoryFormat::kColmap) {
    poses = PosesByName(path, ReadColmapPoses(path), images);
  } else if (format == TrajectoryFormat::kNerfstudio) {
    poses = PosesByName(path, ReadNerfstudioPoses(path, findings), images);
  } else {
    poses = PosesByTime(path, format, options, images, findings);
  }
  for (auto& timed : poses) {
    if (!timed) continue;
    Rigid3d& pose = timed->world_from_camera;
    if (is_mirrored) pose = MirroredInY(pose);
    if (format == TrajectoryFormat::kEuroc && body_from_camera) pose = pose * *body_from_camera;
  }
  return poses;
}

// Moves all estimates together so that the first one with a true pose equals it.
void AlignAtFirst(const ImagePoses& truth, const fs::path& file, ImagePoses* estimates) {
  for (size_t i = 0; i < truth.size(); ++i) {
    if (!truth[i] || !(*estimates)[i]) continue;
    const Rigid3d true_from_estimated =
        truth[i]->world_from_camera * (*estimates)[i]->world_from_camera.Inverse();
    for (auto& pose : *estimates) {
      if (pose) pose->world_from_camera = true_from_estimated * pose->world_from_camera;
    }
    return;
  }
  throw InputError(fmt::format(
      "{}: no image has a pose of it and a true one; expected one at least for align_odometry",
      file.string()));
}

}  // namespace

std::vector<ListedImage> ListImages(const fs::path& folder, const DatasetFiles& files,
                                    const ImportOptions& options,
                                    const std::vector<LabelledBox>& boxes) {
  const bool is_icl_nuim = options.format == DatasetFormat::kIclNuim;
  std::vector<ListedImage> images;
  if (!files.images) {
    images = ImagesOfBoxes(boxes);
  } else if (files.images->extension() == ".json") {
    images = ReadNerfstudioImages(*files.images);
  } else if (options.format == DatasetFormat::kSoslam) {
    images = ReadImageList(*files.images);
    // EuRoC's images are in the folder "data" beside their list, which has only file names.
    const fs::path data = files.images->parent_path() / "data";
    if (files.images->extension() == ".csv" && IsFolder(data)) {
      for (ListedImage& image : images) {
        if (fs::path(image.image).has_parent_path()) continue;
        image.image = (data.lexically_relative(folder) / image.image).string();
      }
    }
  } else {
    images = ReadPairedImageList(*files.images,
                                 is_icl_nuim ? PairOrder::kImageSecond : PairOrder::kImageFirst);
  }
  for (ListedImage& image : images) image.image = NameInDataset(folder, image.image);
  if (!is_icl_nuim) return images;
  for (ListedImage& image : images) {
    image.timestamp =
        SecondsOfFrameNumber(image.timestamp, files.images.value_or(files.detections).string());
  }
  return images;
}

std::vector<ListedFrame> ReadFolderFrames(const fs::path& folder, const DatasetFiles& files,
                                          const ImportOptions& options,
                                          const std::vector<ListedImage>& images,
                                          const std::optional<Rigid3d>& body_from_camera,
                                          std::vector<Finding>* findings) {
  const TrajectoryFormat of_odometry = options.folder.trajectory_format;
  const TrajectoryFormat of_truth = options.folder.groundtruth_format == TrajectoryFormat::kSame
                                        ? of_odometry
                                        : options.folder.groundtruth_format;
  const bool is_truth = files.groundtruth == files.trajectory;
  ImagePoses estimates = ReadPoses(files.trajectory, is_truth ? of_truth : of_odometry, options,
                                   images, body_from_camera, findings);
  ImagePoses truth(images.size());
  if (is_truth) {
    truth = estimates;
  } else if (files.groundtruth) {
    truth = ReadPoses(*files.groundtruth, of_truth, options, images, body_from_camera, findings);
  }
  if (options.folder.align_odometry) AlignAtFirst(truth, files.trajectory, &estimates);
  const std::string list = files.images.value_or(files.detections).string();
  const bool are_required = options.format == DatasetFormat::kSoslam && files.images;
  std::vector<ListedFrame> frames;
  size_t absent = 0;
  for (size_t i = 0; i < images.size(); ++i) {
    Frame frame;
    frame.id = static_cast<int>(i);
    frame.timestamp = images[i].timestamp;
    const fs::path path = ImagePath(folder, images[i].image, list);
    if (are_required || Exists(path)) frame.image = images[i].image;
    ListedFrame listed{frame, estimates[i].has_value()};
    if (estimates[i]) {
      listed.frame.world_from_camera = estimates[i]->world_from_camera;
      listed.pose_timestamp = estimates[i]->timestamp;
    }
    if (truth[i]) listed.frame.true_world_from_camera = truth[i]->world_from_camera;
    if (frame.image.empty() || !Exists(folder / frame.image)) ++absent;
    frames.push_back(std::move(listed));
  }
  if (absent > 0) {
    fmt::print("{}: {} of {} image files are not there\n", folder.string(), absent, images.size());
  }
  return frames;
}

}  // namespace soslam
