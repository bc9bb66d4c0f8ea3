// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/cli/command_line.h"
#include "soslam/dataset/dataset_json.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/import_options.h"
#include "soslam/dataset/text_file.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/image/frames_record.h"
#include "soslam/stage/stages.h"

namespace soslam {

namespace fs = std::filesystem;

void RunTruth(const NoOptions& /*options*/, const StageFiles& files, int /*threads*/) {
  constexpr int kFewest = 3;  // poses that determine a similarity
  const fs::path &truth = files.at("truth"), &output = files.at("output");
  const fs::path& dataset = files.at("dataset");
  const auto record = ReadDescribed<FramesRecord>(dataset / "frames.json", "frames").body;
  std::vector<ListedImage> photos = ReadImageList(dataset / "rgb.txt");
  for (ListedImage& photo : photos) {
    const auto frame = std::ranges::find(record.frames, photo.image, &SourceFrame::image);
    if (frame == record.frames.end()) {
      throw InputError(
          fmt::format("{}: lists '{}', which frames.json does not; expected the files "
                      "of one run of soslam-frames",
                      (dataset / "rgb.txt").string(), photo.image));
    }
    if (frame->frame_number) {
      throw InputError(
          fmt::format("{}: '{}' is of a video, '{}'; expected photos, whose names tell "
                      "their true poses",
                      (dataset / "frames.json").string(), photo.image, frame->source));
    }
    photo.image = frame->source;
  }
  const fs::path list = truth / "rgb.txt";
  const std::vector<TimedPose> given = ReadTrajectory(truth / "groundtruth.txt");
  std::vector<NamedPose> poses;
  for (const ListedImage& image : ReadImageList(list)) {
    const auto pose = NearestPose(given, image.timestamp, ImportOptions().max_time_difference_s);
    if (pose) poses.push_back({list.string(), image.image, pose->world_from_camera});
  }
  if (poses.empty()) {
    throw InputError(list.string() +
                     ": no image has a pose in groundtruth.txt; expected poses at "
                     "the times of the images");
  }
  const std::vector<std::optional<int>> rows = RowsOfPoses(poses, photos);
  std::string trajectory = "# timestamp tx ty tz qx qy qz qw\n";
  int matched = 0;
  for (size_t row = 0; row < photos.size(); ++row) {
    const auto pose = std::ranges::find(rows, std::optional(static_cast<int>(row)));
    if (pose == rows.end()) continue;
    trajectory +=
        TrajectoryLine({photos[row].timestamp, poses[pose - rows.begin()].world_from_camera});
    ++matched;
  }
  if (matched < kFewest) {
    throw InputError(fmt::format(
        "{}: {} of {} photos have the name of an image with a true pose; expected at least {}",
        truth.string(), matched, photos.size(), kFewest));
  }
  const fs::path objects = truth / "objects.json";
  const size_t listed = ReadObjects(objects).objects.size();
  fs::create_directories(output);
  WriteTextFile(output / "groundtruth.txt", trajectory);
  WriteTextFile(output / "objects.json", ReadWholeFile(objects));
  fmt::print("{}: {} of {} photos have a true pose; {} true objects\n", truth.string(), matched,
             photos.size(), listed);
}

}  // namespace soslam
