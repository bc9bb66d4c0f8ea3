// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/dataset_files.h"
#include "soslam/dataset/dataset_json.h"
#include "soslam/dataset/json_entry.h"
#include "soslam/dataset/text_file.h"
#include "soslam/dataset/trajectories.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kIdsPerProblem = 10000;
constexpr const char* kLabel = "ellipsoid";

// Reads one problem into the content.
class Problem {
 public:
  Problem(const fs::path& file, int number, const ImportOptions& options, DatasetContent* content)
      : file_(file),
        number_(number),
        options_(options),
        content_(content),
        document_(ParseJsonFile(file)),
        entry_(document_, file.string()) {}

  void Add() {
    content_->files.push_back(file_);
    AddFrames();
    AddObjects();
    AddRows();
  }

 private:
  int Id(int number) const { return number_ * kIdsPerProblem + number; }
  std::string Place(const char* list) const { return fmt::format("{}#/{}", file_.string(), list); }

  const json& ShortList(const char* name) const {
    const json& list = entry_.List(name);
    if (list.size() > kIdsPerProblem) {
      entry_.Refuse(name, fmt::format("at most {} entries", kIdsPerProblem));
    }
    return list;
  }

  std::vector<Rigid3d> Poses(const char* name) const {
    std::vector<Rigid3d> poses;
    const json& list = ShortList(name);
    for (size_t i = 0; i < list.size(); ++i) {
      const std::string place = fmt::format("{}/{}", Place(name), i);
      const auto matrix = MatrixFromJson<Eigen::Matrix4d>(list[i]);
      if (!matrix) throw InputError(place + ": is not a pose; expected 4 rows of 4 numbers");
      poses.push_back(
          {NearestRotation(matrix->topLeftCorner<3, 3>(), place), matrix->topRightCorner<3, 1>()});
    }
    return poses;
  }

  void AddFrames() {
    const JsonEntry fields(entry_.Field("camera"), Place("camera"));
    fields.Positive("fy");
    const Camera camera = ParseCamera(fields);
    if (content_->frames.empty()) content_->sequence.camera = camera;
    const auto truth = Poses("T_wc");
    const auto odometry = Poses("init_T_wc");
    frames_ = static_cast<int>(truth.size());
    if (odometry.size() != truth.size()) {
      throw InputError(fmt::format("{}: init_T_wc has {} poses; expected {}, as many as T_wc",
                                   file_.string(), odometry.size(), frames_));
    }
    const bool wants_odometry = options_.trajectory == TrajectorySource::kOdometry;
    for (int i = 0; i < frames_; ++i) {
      Frame frame;
      frame.id = Id(i);
      frame.timestamp = i;
      frame.world_from_camera = wants_odometry ? odometry[i] : truth[i];
      frame.true_world_from_camera = truth[i];
      frame.segment = number_;
      if (camera != content_->sequence.camera) frame.camera = camera;
      content_->frames.push_back({std::move(frame), true});
    }
  }

  void AddObjects() {
    const Eigen::Vector4d plane = entry_.Vector<4>("support_plane_world");
    const double length = plane.head<3>().norm();
    if (!(length > 0.0)) entry_.Refuse("support_plane_world", "nx, ny, nz, d");
    const int plane_index = static_cast<int>(content_->sequence.planes.size());
    content_->sequence.planes.push_back({number_, {plane.head<3>() / length, plane[3] / length}});
    for (const JsonEntry& entry : ListEntries(ShortList("objects"), Place("objects"))) {
      Landmark landmark;
      landmark.frame_from_object = {
          Eigen::Quaterniond(Eigen::AngleAxisd(entry.Real("yaw"), Eigen::Vector3d::UnitZ())),
          entry.Vector<3>("center")};
      landmark.half_axes = entry.Vector<3>("half");
      if (!(landmark.half_axes.minCoeff() > 0.0)) entry.Refuse("half", "3 numbers above 0");
      Object object;
      object.id = Id(objects_++);
      object.label = kLabel;
      object.plane_index = plane_index;
      object.ground_truth.emplace().landmark_in_world = landmark;
      content_->sequence.true_objects.push_back(
          {object.id, object.label, *object.ground_truth, number_});
      content_->sequence.objects.push_back(std::move(object));
    }
  }

  // An index in a list of this size.
  static int Index(const JsonEntry& entry, const char* field, int size) {
    const int index = entry.Integer(field);
    if (index < 0 || index >= size) entry.Refuse(field, fmt::format("0 to {}", size - 1));
    return index;
  }

  void AddRows() {
    for (const JsonEntry& entry : ListEntries(entry_.List("boxes"), Place("boxes"))) {
      const Eigen::Vector4d box = entry.Vector<4>("box");
      content_->rows.push_back({entry.place(), Id(Index(entry, "frame", frames_)),
                                Id(Index(entry, "object", objects_)), kLabel, 1.0,
                                Box{box[0], box[1], box[2], box[3]}});
    }
  }

  fs::path file_;
  int number_;
  const ImportOptions& options_;
  DatasetContent* content_;
  json document_;
  JsonEntry entry_;
  int frames_ = 0;
  int objects_ = 0;
};

}  // namespace

DatasetContent ReadSlamSynthetic(const fs::path& folder, const ImportOptions& options) {
  std::vector<fs::path> files = FolderEntries(folder);
  std::erase_if(files, [](const fs::path& file) { return file.extension() != ".json"; });
  if (files.empty()) {
    throw InputError(folder.string() + ": has no *.json; expected one for each problem");
  }
  const auto chosen = SplitWords(options.kitti.sequences);
  for (const std::string_view name : chosen) {
    if (std::ranges::find(files, name, [](const fs::path& file) { return file.stem(); }) !=
        files.end()) {
      continue;
    }
    RefuseSetting("sequences", name, fmt::format("the name of a *.json in {}", folder.string()));
  }
  DatasetContent content;
  content.has_true_poses = true;
  for (size_t i = 0; i < files.size(); ++i) {
    const bool is_chosen =
        chosen.empty() || std::ranges::find(chosen, files[i].stem()) != chosen.end();
    if (is_chosen) Problem(files[i], static_cast<int>(i), options, &content).Add();
  }
  return content;
}

}  // namespace soslam
