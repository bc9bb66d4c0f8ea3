// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/cli/command_line.h"
#include "soslam/dataset/dataset_json.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/reconstruct_options.h"
#include "soslam/dataset/reconstruction.h"
#include "soslam/dataset/soslam_folder.h"
#include "soslam/dataset/text_file.h"
#include "soslam/geometry/image_size.h"
#include "soslam/image/image_format.h"
#include "soslam/image/read_image.h"
#include "soslam/model/moving_things.h"
#include "soslam/stage/colmap_programs.h"
#include "soslam/stage/stages.h"
#include "soslam/stage/track_points.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// The beginning of an odometry.txt that this stage wrote, and may replace.
const std::string kOdometryMark = fmt::format("# {}:", kReconstructed);

// Knowledge before COLMAP runs.
struct Given {
  std::vector<ListedImage> images;
  std::optional<LensCamera> camera;
  bool camera_is_fixed = false;
  std::vector<std::optional<Rigid3d>> poses;  // one per image; empty: they are estimated
};

Given ReadGiven(const fs::path& dataset, const ReconstructOptions& options) {
  Given given;
  const fs::path list = dataset / "rgb.txt", camera = dataset / "camera.json";
  given.images = ReadImageList(list);
  if (given.images.size() < 2) {
    throw InputError(list.string() + ": has a single image; expected several, from places apart");
  }
  for (ListedImage& image : given.images) image.image = NameInDataset(dataset, image.image);
  CalibrationChoice calibration = options.calibration;
  if (calibration == CalibrationChoice::kAuto) {
    const bool is_given = Exists(camera) && SourceOfCamera(camera) != kReconstructed;
    calibration = is_given ? CalibrationChoice::kGiven : CalibrationChoice::kEstimated;
  }
  if (calibration != CalibrationChoice::kEstimated) given.camera = ReadCamera(camera);
  given.camera_is_fixed = calibration == CalibrationChoice::kGiven;
  if (options.poses == PoseChoice::kEstimated) return given;
  if (!given.camera_is_fixed) {
    throw SettingsError(
        "poses: given poses need a given camera; expected a camera.json, and "
        "calibration given or auto");
  }
  const fs::path odometry = dataset / "odometry.txt";
  const std::vector<TimedPose> trajectory = ReadTrajectory(odometry);
  for (const ListedImage& image : given.images) {
    const auto pose = NearestPose(trajectory, image.timestamp, options.max_time_difference_s);
    given.poses.push_back(pose ? std::optional(pose->world_from_camera) : std::nullopt);
  }
  const auto count =
      std::ranges::count_if(given.poses, [](const auto& pose) { return bool(pose); });
  if (count >= 2) return given;
  throw InputError(fmt::format("{}: {} of {} images have a pose within {} s; expected two at least",
                               odometry.string(), count, given.images.size(),
                               options.max_time_difference_s));
}

// Throws SettingsError if the output would replace poses of another source.
void CheckReplaceable(const fs::path& odometry, const ReconstructOptions& options) {
  if (options.poses == PoseChoice::kGiven || !IsFile(odometry)) return;
  const auto lines = RawLines(ReadWholeFile(odometry), odometry.string());
  if (lines.empty() || lines.front().text.starts_with(kOdometryMark)) return;
  throw SettingsError(fmt::format(
      "{}: has poses that are not of soslam-reconstruct, which would be replaced; expected "
      "poses given, to keep them, another --output, or no such file",
      odometry.string()));
}

// Throws SettingsError if the output would replace a calibration of another source.
void CheckReplaceable(const fs::path& camera, bool camera_is_fixed) {
  if (camera_is_fixed || !IsFile(camera) || SourceOfCamera(camera) == kReconstructed) return;
  throw SettingsError(fmt::format(
      "{}: has a calibration that is not of soslam-reconstruct, which would be replaced; expected "
      "calibration given, to keep it, or another --output",
      camera.string()));
}

// Throws InputError unless the images have one size in this orientation, that of a given camera,
// and unless COLMAP, if it is to run, reads them in it.
void CheckImages(const fs::path& dataset, const Given& given, ImageOrientation read_as,
                 bool has_model) {
  const std::string list = (dataset / "rgb.txt").string();
  std::optional<ImageSize> first;
  if (given.camera) first = {given.camera->camera.width, given.camera->camera.height};
  for (const ListedImage& image : given.images) {
    const fs::path path = ImagePath(dataset, image.image, list);
    const auto header = ReadImageHeader(path);
    if (!header) {
      ReadImage(path, cv::IMREAD_GRAYSCALE);  // its error has the reason
      throw InputError(path.string() + ": cannot be read; expected a JPEG, PNG, WebP, BMP or TIFF");
    }
    if (header->orientation != 1 && read_as == ImageOrientation::kUpright && !has_model) {
      throw InputError(fmt::format(
          "{}: EXIF turns this image, and COLMAP reads images as they are stored; expected upright "
          "files: turn them (exiftran -ai), or let soslam-frames write upright ones",
          path.string()));
    }
    const ImageSize size = header->Size(read_as);
    if (!first) first = size;
    if (size.width == first->width && size.height == first->height) continue;
    throw InputError(
        fmt::format("{}: is {} x {} pixels{}; expected {} x {}, as {}", path.string(), size.width,
                    size.height, size != header->stored ? " as viewers show it" : "", first->width,
                    first->height, given.camera ? "camera.json has" : "the first image is"));
  }
}

std::vector<fs::path> MakeModels(const ReconstructOptions& options, const Given& given,
                                 const fs::path& dataset, const fs::path& output, int threads,
                                 std::string* version) {
  ColmapJob job{.dataset = fs::absolute(dataset),
                .images = {},
                .camera = given.camera,
                .camera_is_fixed = given.camera_is_fixed,
                .poses = given.poses,
                .masked = {},
                .threads = threads};
  // Boxes of things that move are masked.
  if (const fs::path file = dataset / "detections.csv"; Exists(file)) {
    Sequence boxes;  // without poses and objects
    boxes.moving_labels = options.moving_labels;
    for (const ListedImage& image : given.images) {
      const ImageSize size = ReadImageHeader(dataset / image.image).value().stored;
      boxes.frames.emplace_back().camera =
          Camera{.width = static_cast<int>(size.width), .height = static_cast<int>(size.height)};
    }
    for (const DetectionRow& row : RowsWithoutObject(ReadDetectionsCsv(file), given.images)) {
      boxes.rejected.push_back({row.frame_id, row.label, row.score, row.box, {}, {}, ""});
    }
    const std::vector<Finding> findings = CheckMovingThings(boxes);
    if (!findings.empty()) {
      fmt::print("{}: {}\n", file.string(), findings.front().found);
      job.masked = BoxesOfMovingThings(boxes);
    }
  }
  for (const ListedImage& image : given.images) job.images.push_back(image.image);
  job.exhaustive = options.matching == ImageMatching::kAuto
                       ? std::ssize(job.images) <= options.exhaustive_max_images
                       : options.matching == ImageMatching::kExhaustive;
  return RunColmap(job, output / "colmap", version);
}

// The largest model; lists all in `components`.
ColmapModel ReadLargestModel(const std::vector<fs::path>& folders,
                             std::vector<ReconstructionSummary::Component>* components) {
  using Component = ReconstructionSummary::Component;
  const auto is_larger = [](const Component& a, const Component& b) {
    return std::pair(a.images, a.points) > std::pair(b.images, b.points);
  };
  ColmapModel largest;
  for (const fs::path& folder : folders) {
    ColmapModel model = ReadColmapModel(folder);
    const Component component{static_cast<int>(model.images.size()),
                              static_cast<int>(model.points.size()),
                              folders.size() > 1 ? folder.filename().string() : ""};
    const bool is_largest = components->empty() || is_larger(component, components->front());
    components->insert(is_largest ? components->begin() : components->end(), component);
    if (is_largest) largest = std::move(model);
  }
  std::ranges::stable_sort(*components, is_larger);
  return largest;
}

// Throws InputError if the model has another camera than the one that was given.
void CheckCamera(const ColmapModel& model, const Given& given, const fs::path& dataset) {
  constexpr double kRoundingPx = 0.01;
  if (!given.camera_is_fixed) return;
  const double displacement_px = DisplacementPx(model.camera, *given.camera);
  if (displacement_px < kRoundingPx) return;
  const double limit_px = UnseenDisplacementPx(given.camera->camera);
  const std::string found = fmt::format(
      "{}: image points are {:.2g} px (root mean square) from those of the model's camera (fx "
      "{:.2f}, not {:.2f})",
      (dataset / "camera.json").string(), displacement_px, model.camera.camera.fx,
      given.camera->camera.fx);
  if (displacement_px >= limit_px) {
    throw InputError(fmt::format(
        "{}; expected a model of this camera, to {:.2g} px; with calibration estimated, the "
        "output gets the model's camera, and this file stays as it is",
        found, limit_px));
  }
  fmt::print("{}; this file is used, as boxes do not show less than {:.2g} px\n", found, limit_px);
}

// Throws InputError unless the model's poses are those that were given.
void CheckPoses(const Reconstruction& reconstruction, const Given& given) {
  constexpr double kTolerance = 1e-6;
  for (size_t i = 0; i < given.poses.size(); ++i) {
    const auto& found = reconstruction.world_from_camera[i];
    if (!found || !given.poses[i]) continue;
    const Rigid3d change = given.poses[i]->Inverse() * *found;
    const double size = std::max(1.0, given.poses[i]->translation.norm());
    if (change.translation.norm() < kTolerance * size &&
        change.rotation.vec().norm() < kTolerance) {
      continue;
    }
    throw InputError(
        fmt::format("{}: the model has another pose than odometry.txt; expected a "
                    "model of the given poses, or poses estimated",
                    given.images[i].image));
  }
}

// Adds points of tracked features to a finished model whose own points no image shows, as those of
// networks.
void AddTrackedPoints(const ColmapModel& model, const fs::path& folder, const fs::path& dataset,
                      const std::vector<ListedImage>& listed, ImageOrientation orientation,
                      int threads, Reconstruction* reconstruction, ArtefactInfo* info) {
  Sequence sequence;  // the images that have a pose
  sequence.camera = model.camera.camera;
  sequence.image_distortion = model.camera.distortion;
  sequence.image_orientation = orientation;
  for (size_t i = 0; i < listed.size(); ++i) {
    const auto& pose = reconstruction->world_from_camera[i];
    if (!pose) continue;
    sequence.frames.push_back(
        {static_cast<int>(i), listed[i].timestamp, listed[i].image, *pose, std::nullopt});
  }
  const std::vector<FrameImage> images = FrameImages(sequence, dataset, dataset / "rgb.txt");
  for (const FrameImage& image : images) info->inputs.push_back(image.path);
  TrackedPoints tracked = TrackPoints(sequence, images, {}, threads);
  reconstruction->points = std::move(tracked.points);
  info->findings.push_back(
      {"model_without_tracks", Severity::kWarning,
       fmt::format("{}: the model has {}; used are its poses and its camera, with {} points of "
                   "features that are followed through the images",
                   folder.string(),
                   model.points.empty()
                       ? "no points"
                       : fmt::format("{} points without tracks", model.points.size()),
                   reconstruction->points.size()),
       "points with the images that show them",
       "poses of a network (VGGT, MASt3R, ViPE), or image points that were left out",
       "nothing where poses are right to a pixel; otherwise triangulate points with COLMAP"});
  std::ranges::move(tracked.findings, std::back_inserter(info->findings));
}

void CopyInto(const fs::path& output, const fs::path& file) {
  if (PlainPath(file.parent_path()) == PlainPath(output)) return;
  WriteTextFile(output / file.filename(), ReadWholeFile(file));
}

void WriteAll(const fs::path& dataset, const fs::path& output, const Given& given,
              const ColmapModel& model, const Reconstruction& reconstruction,
              const ReconstructionSummary& summary, const ArtefactInfo& info) {
  WritePoints(output / "points.h5", reconstruction.points, info);
  if (summary.poses == DataSource::kGiven) {
    CopyInto(output, dataset / "odometry.txt");
  } else {
    std::string text = kOdometryMark +
                       " timestamp tx ty tz qx qy qz qw, world_from_camera, in a unit of its own\n";
    for (size_t i = 0; i < given.images.size(); ++i) {
      const auto& pose = reconstruction.world_from_camera[i];
      if (pose) text += TrajectoryLine({given.images[i].timestamp, *pose});
    }
    WriteTextFile(output / "odometry.txt", text);
  }
  if (summary.camera == DataSource::kGiven) {
    CopyInto(output, dataset / "camera.json");
  } else {
    WriteTextFile(output / "camera.json", CameraText(model.camera, kReconstructed));
  }
  WriteReconstruction(output / "reconstruction.json", summary, info);
}

std::string InWords(const std::optional<double>& value, const char* unit) {
  return value ? fmt::format("{:.2f} {}", *value, unit) : "unknown";
}

// `unlisted`: images of the model that the dataset does not list.
void PrintReconstructionSummary(const fs::path& dataset, const ReconstructionSummary& summary,
                                const std::vector<std::string>& unlisted) {
  fmt::print(
      "{}: registered {} of {} images, {} points, median reprojection error {}, median "
      "triangulation angle {}{}\n",
      dataset.string(), summary.registered, summary.images, summary.points,
      InWords(summary.median_reprojection_error_px, "px"),
      InWords(summary.median_triangulation_angle_deg, "degrees"),
      summary.components.size() > 1
          ? fmt::format("; {} images in a second component", summary.components[1].images)
          : "");
  if (!summary.images_without_pose.empty()) {
    fmt::print("{}: without a pose, and not used: {}\n", dataset.string(),
               NamesInWords(summary.images_without_pose));
  }
  if (!unlisted.empty()) {
    fmt::print("{}: {} in the model, but not in rgb.txt: {}\n", dataset.string(),
               Counted(unlisted.size(), "image"), NamesInWords(unlisted));
  }
}

}  // namespace

void RunReconstruct(const ReconstructOptions& options, const StageFiles& files, int threads) {
  const fs::path& dataset = files.at("dataset");
  const fs::path& output = files.at("output");
  const Given given = ReadGiven(dataset, options);
  CheckReplaceable(output / "odometry.txt", options);
  CheckReplaceable(output / "camera.json", given.camera_is_fixed);
  const bool has_model = files.contains("model");
  CheckImages(dataset, given, options.image_orientation, has_model);
  std::error_code ignored;  // the first file that is written reports it
  fs::create_directories(output, ignored);

  ReconstructionSummary summary;
  const std::vector<fs::path> models =
      has_model ? ColmapModelsIn(files.at("model"))
                : MakeModels(options, given, dataset, output, threads, &summary.colmap);
  if (has_model && models.empty()) {
    throw InputError(files.at("model").string() +
                     ": has no model of COLMAP; expected cameras, images and points3D (.bin or "
                     ".txt), or numbered folders of them");
  }
  ColmapModel model = ReadLargestModel(models, &summary.components);
  if (has_model) {
    TurnModel(given.images, dataset, options.image_orientation, &model);
  }
  Reconstruction reconstruction = BuildReconstruction(model, given.images);
  CheckCamera(model, given, dataset);
  CheckPoses(reconstruction, given);
  ArtefactInfo info{OptionsToJson(options), model.files, model.findings, "reconstruct"};
  info.inputs.push_back(dataset / "rgb.txt");
  if (reconstruction.points.empty() && has_model) {
    AddTrackedPoints(model, files.at("model"), dataset, given.images, options.image_orientation,
                     threads, &reconstruction, &info);
  }
  if (reconstruction.points.empty()) {
    throw NothingUsableError(
        fmt::format("{}: the model has no points; expected some: do the poses fit the images?",
                    dataset.string()));
  }
  if (!given.poses.empty()) summary.poses = DataSource::kGiven;
  if (given.camera_is_fixed) summary.camera = DataSource::kGiven;
  Summarise(reconstruction, given.images, &summary);
  std::ranges::move(CheckReconstruction(summary, reconstruction.unlisted),
                    std::back_inserter(info.findings));
  ReportFindings("reconstruct", info.findings);
  WriteAll(dataset, output, given, model, reconstruction, summary, info);
  PrintReconstructionSummary(dataset, summary, reconstruction.unlisted);
}

}  // namespace soslam
