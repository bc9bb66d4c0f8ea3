// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "soslam/artefact/dataset_folder.h"
#include "soslam/artefact/described_json.h"
#include "soslam/base/parallel.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/synthesis/render.h"
#include "soslam/synthesis/simulate.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

using nlohmann::ordered_json;

std::string TrajectoryText(const Scene& scene, const std::vector<Rigid3d>& world_from_camera) {
  std::string text = "# timestamp tx ty tz qx qy qz qw  (world_from_camera, metres)\n";
  for (int i = 0; i < scene.trajectory.frames; ++i) {
    text += TrajectoryLine({i * scene.trajectory.frame_interval, world_from_camera[i]});
  }
  return text;
}

constexpr int kNoObjectId = -1;  // of boxes of nothing

std::string BoxesText(const Scene& scene, const std::vector<SimulatedBox>& boxes, bool scores) {
  std::string text = fmt::format("frame,object_id,label,{}x1,y1,x2,y2\n", scores ? "score," : "");
  for (const SimulatedBox& row : boxes) {
    const SceneObject& object = scene.objects[row.object_index];
    text += fmt::format("{},{},{},{}{},{},{},{}\n", row.frame_index,
                        row.is_false ? kNoObjectId : object.id, object.label,
                        scores ? fmt::format("{:#},", row.score) : "", row.box.x_min, row.box.y_min,
                        row.box.x_max, row.box.y_max);
  }
  return text;
}

// One entry per line.
std::string ArrayText(const ordered_json& entries) {
  std::string text = "[";
  for (size_t i = 0; i < entries.size(); ++i) {
    text += (i == 0 ? "\n " : ",\n ") + entries[i].dump();
  }
  return text + "\n]\n";
}

std::string ObjectsText(const Scene& scene) {
  ordered_json entries = ordered_json::array();
  for (const SceneObject& object : scene.objects) {
    const GroundTruth truth = ObjectGroundTruth(scene, object);
    const Rigid3d& world_from_object = truth.landmark_in_world.frame_from_object;
    entries.push_back({{"id", object.id},
                       {"label", object.label},
                       {"model", kShapeNames[static_cast<size_t>(object.shape)]},
                       {"center", world_from_object.translation},
                       {"quaternion_xyzw", world_from_object.rotation.coeffs()},
                       {"half_axes", truth.landmark_in_world.half_axes},
                       {"mirror_symmetric", truth.mirror_symmetric},
                       {"mirror_symmetric_yz", truth.mirror_symmetric_yz},
                       {"rotationally_symmetric", truth.rotationally_symmetric},
                       {"support_plane", scene.planes[object.plane_index].id}});
    if (object.rests_on != RestingFace::kBottom) {
      entries.back()["rests_on"] = kRestingFaceNames[static_cast<size_t>(object.rests_on)];
    }
  }
  return ArrayText(entries);
}

std::string ReadmeText(const Scene& scene, bool has_noise, const std::string& mark) {
  const std::string boxed_part =
      scene.boxes == BoxedPart::kWhole
          ? "the box of each whole object, also where another one covers a part;\n"
            "  only objects that are wholly inside the image with their centre in sight"
          : fmt::format(
                "the box of the visible part of each object of which at least\n"
                "  {} of the silhouette is visible",
                scene.min_visible_share);
  const SceneNoise& noise = scene.noise;
  std::string noise_in_words = "None: detections and odometry are exact.\n";
  if (has_noise) {
    noise_in_words = fmt::format(
        "Seed {}. Box edges: standard deviation {} of the box's width or height and {} px; {} of "
        "the\n"
        "detections missing; boxes cut at the image border. Odometry: random walk of {} m per\n"
        "square-root metre on each axis, scale error of standard deviation {}, rotation random "
        "walk\n"
        "of {} degrees per square root of (metres + turn / 30 degrees). Images: {} grey levels.\n",
        scene.seed, noise.box_edge_sigma, noise.box_sigma_px, noise.miss_probability,
        noise.odometry_translation_sigma, noise.odometry_scale_sigma,
        noise.odometry_rotation_sigma_deg, noise.image_sigma);
    if (noise.false_share != 0.0) {
      noise_in_words += fmt::format("Boxes of nothing, with object_id {}: {} for each detection.\n",
                                    kNoObjectId, noise.false_share);
    }
  }
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
      "- `boxes_exact.csv`: {}.\n"
      "- `detections.csv`: the same as a detector finds them.\n"
      "- `objects.json`: `mirror_symmetric` and `mirror_symmetric_yz` are of shape and texture,\n"
      "  `rotationally_symmetric` of the shape.\n\n"
      "## Noise\n\n{}",
      mark, scene.name, scene.trajectory.frames, scene.objects.size(), boxed_part, noise_in_words);
}

void WriteImage(const Scene& scene, bool noise, int frame_index, const Rigid3d& world_from_camera,
                const DatasetFolder& output) {
  cv::Mat image = RenderFrame(SceneAt(scene, frame_index), world_from_camera);
  if (noise && scene.noise.image_sigma != 0.0) {
    auto random = NoiseGenerator(scene.seed, NoiseKind::kImage, frame_index, 0);
    std::normal_distribution<double> normal(0.0, scene.noise.image_sigma);
    for (cv::Vec3b& pixel : cv::Mat_<cv::Vec3b>(image)) {
      for (int channel = 0; channel < 3; ++channel) {
        pixel[channel] = cv::saturate_cast<uchar>(pixel[channel] + normal(random));
      }
    }
  }
  std::vector<uchar> bytes;
  cv::imencode(".png", image, bytes);
  output.Write(ImageName(frame_index), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace

void WriteDataset(const Scene& scene, bool noise, const fs::path& folder, int threads) {
  DatasetFolder output(folder, "soslam-synthesise");
  const Simulation simulation = Simulate(scene, noise);
  output.Write("README.md", ReadmeText(scene, noise, output.Mark()));
  std::string image_list = "# timestamp filename\n";
  for (int i = 0; i < scene.trajectory.frames; ++i) {
    image_list += fmt::format("{} {}\n", i * scene.trajectory.frame_interval, ImageName(i));
  }
  output.Write("rgb.txt", image_list);
  output.Write("groundtruth.txt", TrajectoryText(scene, simulation.true_world_from_camera));
  output.Write("odometry.txt", TrajectoryText(scene, simulation.odometry_world_from_camera));
  const Camera& camera = scene.camera;
  const ordered_json intrinsics = {
      {"model", "pinhole"}, {"width", camera.width}, {"height", camera.height}, {"fx", camera.fx},
      {"fy", camera.fy},    {"cx", camera.cx},       {"cy", camera.cy}};
  output.Write("camera.json", intrinsics.dump() + "\n");
  ordered_json planes = ordered_json::array();
  for (const ScenePlane& plane : scene.planes) {
    planes.push_back({{"id", plane.id},
                      {"label", plane.label},
                      {"normal", plane.plane_in_world.normal},
                      {"d", plane.plane_in_world.offset}});
  }
  output.Write("planes.json", ArrayText(planes));
  output.Write("objects.json", ObjectsText(scene));
  output.Write("detections.csv", BoxesText(scene, simulation.detections, true));
  output.Write("boxes_exact.csv", BoxesText(scene, simulation.exact_boxes, false));
  fs::create_directory(output.Temporary() / "rgb");
  ParallelFor("frames", scene.trajectory.frames, threads, [&](int i) {
    WriteImage(scene, noise, i, simulation.true_world_from_camera[i], output);
  });
  output.Commit();
}

}  // namespace soslam
