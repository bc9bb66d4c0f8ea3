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

// A list of a problem, each of whose entries has an id.
const json& ShortList(const JsonEntry& problem, const char* name) {
  const json& list = problem.List(name);
  if (list.size() > kIdsPerProblem) {
    problem.Refuse(name, fmt::format("at most {} entries", kIdsPerProblem));
  }
  return list;
}

std::vector<Rigid3d> ReadPosesOfProblem(const JsonEntry& problem, const char* name) {
  std::vector<Rigid3d> poses;
  const json& list = ShortList(problem, name);
  for (size_t i = 0; i < list.size(); ++i) {
    const std::string place = fmt::format("{}#/{}/{}", problem.place(), name, i);
    const auto matrix = MatrixFromJson<Eigen::Matrix4d>(list[i]);
    if (!matrix) throw InputError(place + ": is not a pose; expected 4 rows of 4 numbers");
    poses.push_back(
        {NearestRotation(matrix->topLeftCorner<3, 3>(), place), matrix->topRightCorner<3, 1>()});
  }
  return poses;
}

// An index in a list of this size.
int IndexBelow(int size, const JsonEntry& entry, const char* field) {
  const int index = entry.Integer(field);
  if (index < 0 || index >= size) entry.Refuse(field, fmt::format("0 to {}", size - 1));
  return index;
}

// Reads one problem into the content.
void ReadProblem(const fs::path& file, int number, const ImportOptions& options,
                 DatasetContent* content) {
  const json document = ParseJsonFile(file);
  const JsonEntry problem(document, file.string());
  const auto id_of = [&](int index) { return number * kIdsPerProblem + index; };
  content->files.push_back(file);
  const JsonEntry intrinsics(problem.Field("camera"), problem.place() + "#/camera");
  intrinsics.Positive("fy");
  const Camera camera = ParseCamera(intrinsics);
  const auto truth = ReadPosesOfProblem(problem, "T_wc");
  const auto odometry = ReadPosesOfProblem(problem, "init_T_wc");
  const int frames = static_cast<int>(truth.size());
  if (odometry.size() != truth.size()) {
    throw InputError(fmt::format("{}: init_T_wc has {} poses; expected {}, as many as T_wc",
                                 file.string(), odometry.size(), frames));
  }
  const bool wants_odometry = options.trajectory == TrajectorySource::kOdometry;
  for (int i = 0; i < frames; ++i) {
    Frame frame;
    frame.id = id_of(i);
    frame.timestamp = i;
    frame.world_from_camera = wants_odometry ? odometry[i] : truth[i];
    frame.true_world_from_camera = truth[i];
    frame.segment = number;
    content->AddFrame(std::move(frame), camera);
  }
  const Eigen::Vector4d plane = problem.Vector<4>("support_plane_world");
  const double length = plane.head<3>().norm();
  if (!(length > 0.0)) problem.Refuse("support_plane_world", "nx, ny, nz, d");
  Sequence& sequence = content->sequence;
  const int plane_index = static_cast<int>(sequence.planes.size());
  sequence.planes.push_back({number, {plane.head<3>() / length, plane[3] / length}});
  int objects = 0;
  for (const JsonEntry& entry :
       ListEntries(ShortList(problem, "objects"), problem.place() + "#/objects")) {
    Landmark landmark;
    landmark.frame_from_object = {
        Eigen::Quaterniond(Eigen::AngleAxisd(entry.Real("yaw"), Eigen::Vector3d::UnitZ())),
        entry.Vector<3>("center")};
    landmark.half_axes = entry.Vector<3>("half");
    if (!(landmark.half_axes.minCoeff() > 0.0)) entry.Refuse("half", "3 numbers above 0");
    Object object{id_of(objects++), kLabel, plane_index, GroundTruth()};
    object.ground_truth->landmark_in_world = landmark;
    sequence.true_objects.push_back({object.id, object.label, *object.ground_truth, number});
    sequence.objects.push_back(std::move(object));
  }
  for (const JsonEntry& entry : ListEntries(problem.List("boxes"), problem.place() + "#/boxes")) {
    const Eigen::Vector4d box = entry.Vector<4>("box");
    content->rows.push_back({entry.place(), id_of(IndexBelow(frames, entry, "frame")),
                             id_of(IndexBelow(objects, entry, "object")), kLabel, 1.0,
                             Box{box[0], box[1], box[2], box[3]}});
  }
}

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
    if (is_chosen) ReadProblem(files[i], static_cast<int>(i), options, &content);
  }
  return content;
}

}  // namespace soslam
