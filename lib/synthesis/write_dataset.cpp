// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/write_dataset.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <system_error>

#include "base/error.h"
#include "base/parallel.h"
#include "base/paths.h"
#include "base/run_log.h"
#include "synthesis/render.h"
#include "synthesis/simulate.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

bool IsSynthesised(const fs::path& folder) {
  std::ifstream readme(folder / "README.md");
  std::string first_line;
  return std::getline(readme, first_line) && first_line.rfind(kSynthesisedMark, 0) == 0;
}

[[noreturn]] void Refuse(const fs::path& folder, const std::string& why) {
  throw SettingsError(fmt::format("{}: {}", folder.string(), why));
}

void CheckReplaceable(const fs::path& folder) {
  std::error_code error;
  if (!Exists(folder)) return;
  if (!IsFolder(folder)) Refuse(folder, "is not a folder; expected one, or nothing");
  if (!fs::is_empty(folder, error) && !IsSynthesised(folder)) {
    Refuse(folder, "is not empty and was not written by soslam-synthesise; expected a new folder");
  }
}

fs::path Sibling(const fs::path& folder, const std::string& purpose) {
  return folder.parent_path() /
         fmt::format(".{}.{}-{}", folder.filename().string(), purpose, getpid());
}

// Flushes the disk of a folder; returns the errno of a failure, else 0.
int SyncDiskOf(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int error = ::syncfs(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  return error;
}

// Atomic, so that there is a folder of that name at any moment. Not all file systems support it.
bool Exchange(const fs::path& one, const fs::path& other) {
  return ::renameat2(AT_FDCWD, one.c_str(), AT_FDCWD, other.c_str(), RENAME_EXCHANGE) == 0;
}

}  // namespace

DatasetFolder::DatasetFolder(const fs::path& folder)
    : folder_(PlainPath(folder)), temporary_(Sibling(folder_, "new")) {
  CheckReplaceable(folder_);
  std::error_code error;
  fs::create_directories(folder_.parent_path(), error);
  fs::remove_all(temporary_, error);
  if (!fs::create_directory(temporary_, error)) Refuse(folder_, "cannot be written");
}

DatasetFolder::~DatasetFolder() {
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

void DatasetFolder::Commit() {
  CheckInputsUnchanged();
  CheckReplaceable(folder_);
  if (const int error = SyncDiskOf(temporary_)) {
    Refuse(folder_, fmt::format("cannot be written: {}", std::strerror(error)));
  }
  if (!Exists(folder_) || !Exchange(temporary_, folder_)) Replace();
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    if (entry.is_regular_file()) RecordOutput(entry.path());
  }
}

void DatasetFolder::Replace() {
  const fs::path old = Sibling(folder_, "old");
  std::error_code error;
  const bool replaces = Exists(folder_);
  if (replaces) fs::rename(folder_, old, error);
  if (!error) fs::rename(temporary_, folder_, error);
  if (error) {
    const std::string why = "cannot be written: " + error.message();
    if (replaces && !Exists(folder_)) fs::rename(old, folder_, error);
    Refuse(folder_, why);
  }
  fs::remove_all(old, error);
}

namespace {

using nlohmann::ordered_json;

void WriteText(const fs::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) throw SettingsError(path.string() + ": cannot be written; is the disk full?");
}

std::string Timestamp(const Scene& scene, int frame_index) {
  return fmt::format("{}", frame_index * scene.trajectory.frame_interval);
}

std::string ImageListText(const Scene& scene) {
  std::string text = "# timestamp filename\n";
  for (int i = 0; i < scene.trajectory.frames; ++i) {
    text += fmt::format("{} {}\n", Timestamp(scene, i), ImageName(i));
  }
  return text;
}

std::string TrajectoryText(const Scene& scene, const std::vector<Rigid3d>& world_from_camera) {
  std::string text = "# timestamp tx ty tz qx qy qz qw  (world_from_camera, metres)\n";
  for (int i = 0; i < scene.trajectory.frames; ++i) {
    const Eigen::Vector3d& t = world_from_camera[i].translation;
    const Eigen::Quaterniond& q = world_from_camera[i].rotation;
    text += fmt::format("{} {} {} {} {} {} {} {}\n", Timestamp(scene, i), t.x(), t.y(), t.z(),
                        q.x(), q.y(), q.z(), q.w());
  }
  return text;
}

std::string BoxesText(const Scene& scene, const std::vector<SimulatedBox>& boxes, bool scores) {
  std::string text = fmt::format("frame,object_id,label,{}x1,y1,x2,y2\n", scores ? "score," : "");
  for (const SimulatedBox& row : boxes) {
    const SceneObject& object = scene.objects[row.object_index];
    text += fmt::format("{},{},{},{}{},{},{},{}\n", row.frame_index, object.id, object.label,
                        scores ? "1.0," : "", row.box.x_min, row.box.y_min, row.box.x_max,
                        row.box.y_max);
  }
  return text;
}

std::string CameraText(const Camera& camera) {
  const ordered_json document = {
      {"model", "pinhole"}, {"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
      {"fy", camera.fy},    {"cx", camera.cx},       {"cy", camera.cy}};
  return document.dump() + "\n";
}

template <typename Vector>
std::vector<double> Numbers(const Vector& vector) {
  return {vector.begin(), vector.end()};
}

// One entry per line.
std::string ArrayText(const ordered_json& entries) {
  std::string text = "[";
  for (size_t i = 0; i < entries.size(); ++i) {
    text += (i == 0 ? "\n " : ",\n ") + entries[i].dump();
  }
  return text + "\n]\n";
}

std::string PlanesText(const Scene& scene) {
  ordered_json entries = ordered_json::array();
  for (const ScenePlane& plane : scene.planes) {
    entries.push_back({{"id", plane.id},
                       {"label", plane.label},
                       {"normal", Numbers(plane.plane_in_world.normal)},
                       {"d", plane.plane_in_world.offset}});
  }
  return ArrayText(entries);
}

std::string ObjectsText(const Scene& scene) {
  constexpr const char* kShapeNames[] = {"box", "ellipsoid", "cylinder"};
  ordered_json entries = ordered_json::array();
  for (const SceneObject& object : scene.objects) {
    const GroundTruth truth = ObjectGroundTruth(scene, object);
    const Rigid3d& world_from_object = truth.landmark_in_world.frame_from_object;
    entries.push_back({{"id", object.id},
                       {"label", object.label},
                       {"model", kShapeNames[static_cast<int>(object.shape)]},
                       {"center", Numbers(world_from_object.translation)},
                       {"quaternion_xyzw", Numbers(world_from_object.rotation.coeffs())},
                       {"half_axes", Numbers(truth.landmark_in_world.half_axes)},
                       {"mirror_symmetric", truth.mirror_symmetric},
                       {"mirror_symmetric_yz", truth.mirror_symmetric_yz},
                       {"rotationally_symmetric", truth.rotationally_symmetric},
                       {"support_plane", scene.planes[object.plane_index].id}});
  }
  return ArrayText(entries);
}

std::string NoiseText(const Scene& scene) {
  const SceneNoise& noise = scene.noise;
  return fmt::format(
      "Seed {}. Box edges: standard deviation {} of the box's width or height and {} px; {} of "
      "the\n"
      "detections missing; boxes cut at the image border. Odometry: random walk of {} m per\n"
      "square-root metre on each axis, scale error of standard deviation {}, rotation random walk\n"
      "of {} degrees per square root of (metres + turn / 30 degrees). Images: {} grey levels.\n",
      scene.seed, noise.box_edge_sigma, noise.box_sigma_px, noise.miss_probability,
      noise.odometry_translation_sigma, noise.odometry_scale_sigma,
      noise.odometry_rotation_sigma_deg, noise.image_sigma);
}

std::string ReadmeText(const Scene& scene, bool noise) {
  return fmt::format(
      "{} from a scene description; the next run into this folder replaces it. -->\n"
      "# {}\n\n"
      "A synthetic sequence: {} frames, {} objects, rendered solids with mirror-symmetric "
      "texture.\n\n"
      "Metres, seconds, pixels with (0, 0) the centre of the top-left pixel. Camera frame: x "
      "right,\n"
      "y down, z forward. Object frame: origin at the centre, z away from the support plane, x "
      "the\n"
      "front; the mirror plane is the xz plane. Quaternions x, y, z, w. Plane: normal . x + d = "
      "0.\n"
      "Line k of `rgb.txt` (from 0, comments not counted), image k and `frame` k of the tables "
      "are\n"
      "the same frame.\n\n"
      "- `groundtruth.txt`: true camera poses, world_from_camera. `odometry.txt`: as measured.\n"
      "- `boxes_exact.csv`: the box of each whole object, also where another one covers a part;\n"
      "  only objects that are wholly inside the image with their centre in sight.\n"
      "- `detections.csv`: the same as a detector finds them.\n"
      "- `objects.json`: `mirror_symmetric` and `mirror_symmetric_yz` are of shape and texture,\n"
      "  `rotationally_symmetric` of the shape.\n\n"
      "## Noise\n\n{}",
      kSynthesisedMark, scene.name, scene.trajectory.frames, scene.objects.size(),
      noise ? NoiseText(scene) : "None: detections and odometry are exact.\n");
}

void AddImageNoise(const Scene& scene, int frame_index, cv::Mat* image) {
  if (scene.noise.image_sigma == 0.0) return;
  auto random = NoiseGenerator(scene.seed, NoiseKind::kImage, frame_index, 0);
  std::normal_distribution<double> normal(0.0, scene.noise.image_sigma);
  for (cv::Vec3b& pixel : cv::Mat_<cv::Vec3b>(*image)) {
    for (int channel = 0; channel < 3; ++channel) {
      pixel[channel] = cv::saturate_cast<uchar>(pixel[channel] + normal(random));
    }
  }
}

void WriteImage(const Scene& scene, bool noise, int frame_index, const Rigid3d& world_from_camera,
                const fs::path& folder) {
  cv::Mat image = RenderFrame(scene, world_from_camera);
  if (noise) AddImageNoise(scene, frame_index, &image);
  std::vector<uchar> bytes;
  cv::imencode(".png", image, bytes);
  WriteText(folder / ImageName(frame_index), std::string(bytes.begin(), bytes.end()));
}

}  // namespace

void WriteDataset(const Scene& scene, bool noise, const fs::path& folder, int threads) {
  DatasetFolder output(folder);
  const fs::path& temporary = output.Temporary();
  const Simulation simulation = Simulate(scene, noise);
  WriteText(temporary / "README.md", ReadmeText(scene, noise));
  WriteText(temporary / "rgb.txt", ImageListText(scene));
  WriteText(temporary / "groundtruth.txt",
            TrajectoryText(scene, simulation.true_world_from_camera));
  WriteText(temporary / "odometry.txt",
            TrajectoryText(scene, simulation.odometry_world_from_camera));
  WriteText(temporary / "camera.json", CameraText(scene.camera));
  WriteText(temporary / "planes.json", PlanesText(scene));
  WriteText(temporary / "objects.json", ObjectsText(scene));
  WriteText(temporary / "detections.csv", BoxesText(scene, simulation.detections, true));
  WriteText(temporary / "boxes_exact.csv", BoxesText(scene, simulation.exact_boxes, false));
  fs::create_directory(temporary / "rgb");
  ParallelFor("frames", scene.trajectory.frames, threads, [&](int i) {
    WriteImage(scene, noise, i, simulation.true_world_from_camera[i], temporary);
  });
  output.Commit();
}

}  // namespace soslam
