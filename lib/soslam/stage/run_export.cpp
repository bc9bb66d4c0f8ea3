// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/cli/command_line.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/exchange/exports.h"
#include "soslam/exchange/world.h"
#include "soslam/image/image_format.h"
#include "soslam/image/read_image.h"
#include "soslam/inspection/canvas.h"
#include "soslam/inspection/overlay.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr std::array kOutputs = {"trajectory", "ply",   "gltf",   "coco",       "coco_dataset",
                                 "csv",        "boxes", "colmap", "transforms", "overlays"};
// Outputs of poses alone, which need no objects.
constexpr std::array kPoseOutputs = {"trajectory", "colmap", "transforms"};

struct Output {
  fs::path path;
  std::string bytes;
};

bool OnlyPoses(const StageFiles& files) {
  return std::ranges::none_of(kOutputs, [&](const std::string& output) {
    return files.contains(output) && std::ranges::find(kPoseOutputs, output) == kPoseOutputs.end();
  });
}

void CheckFiles(const ExportOptions& options, const StageFiles& files) {
  if (std::ranges::none_of(kOutputs, [&](const char* output) { return files.contains(output); })) {
    throw SettingsError(fmt::format("nothing to write; expected at least one of --{}",
                                    fmt::join(kOutputs, ", --")));
  }
  const bool has_map = files.contains("map"), has_metrics = files.contains("metrics");
  const std::pair<bool, const char*> faults[] = {
      {options.truth && has_map, "truth is true and --map is given; expected one of them"},
      {!options.truth && !has_map && !OnlyPoses(files),
       "there are no objects; expected --map, or truth = true"},
      {has_metrics && !has_map,
       "--metrics is given without --map; expected the map that it evaluates"},
      {options.aligned && !has_metrics,
       "aligned is true without --metrics; expected metrics.json of the map"},
      {files.contains("points") && !files.contains("colmap"),
       "--points is given without --colmap; expected the model that they belong to"},
      {files.contains("overlays") && !files.contains("dataset"),
       "--overlays is given without --dataset; expected the folder with the images"}};
  for (const auto& [is_fault, message] : faults) {
    if (is_fault) throw SettingsError(message);
  }
  const auto gltf = files.find("gltf");
  if (gltf == files.end()) return;
  const fs::path extension = gltf->second.extension();
  if (extension != ".glb" && extension != ".gltf") {
    throw SettingsError(
        fmt::format("{}: has another extension; expected .glb or .gltf", gltf->second.string()));
  }
}

std::vector<World> ReadWorlds(const Sequence& sequence, const ExportOptions& options,
                              const StageFiles& files) {
  if (options.truth) return WorldsOfTruth(sequence);
  if (!files.contains("map")) return WorldsOfOdometry(sequence);
  CheckWasMadeOf(files.at("map"), "map", files.at("sequence"));
  std::vector<World> worlds = WorldsOfMap(sequence, ReadMap(files.at("map"), sequence));
  if (!files.contains("metrics")) return worlds;
  const fs::path& metrics = files.at("metrics");
  CheckWasMadeOf(metrics, "metrics", files.at("map"));
  const auto quality = ReadArtefact(metrics, "metrics").value("map_quality", nlohmann::json());
  if (!quality.is_null()) {
    AddVerdicts(quality, &worlds);
    if (options.aligned) AlignWorlds(quality, &worlds);
  } else if (options.aligned) {
    throw NothingUsableError(metrics.string() +
                             ": has no map_quality, so no alignment; expected metrics of a map "
                             "whose dataset says what is true (objects.json)");
  }
  return worlds;
}

// Largest median reprojection error of points with which poses are those of their images.
constexpr double kMaxMedianErrorPx = 4.0;

bool HasImage(const World& world) {
  return std::ranges::any_of(world.frames,
                             [](const WorldFrame& frame) { return !frame.image.empty(); });
}

// Creates all outputs before any is written, so that a failure leaves no partial result.
std::vector<Output> MakeOutputs(const std::vector<World>& worlds, const ExportOptions& options,
                                const StageFiles& files) {
  std::vector<Output> outputs;
  const auto add = [&](const std::string& name,
                       const std::function<std::string(const std::vector<World>&)>& text) {
    if (files.contains(name)) outputs.push_back({files.at(name), text(worlds)});
  };
  // With several segments, segment 3 of map.ply becomes map-3.ply.
  const auto path_of = [&](const std::string& name, const World& world) {
    const fs::path path = PlainPath(files.at(name));
    if (worlds.size() == 1) return files.at(name);
    return path.parent_path() /
           fmt::format("{}-{}{}", path.stem().string(), world.segment, path.extension().string());
  };
  const auto add_each = [&](const std::string& name,
                            const std::function<std::string(const World&)>& text) {
    if (!files.contains(name)) return;
    for (const World& world : worlds) outputs.push_back({path_of(name, world), text(world)});
  };
  const LabelColours colours = ColoursOfLabels(worlds);
  add_each("trajectory", TumTrajectoryText);
  add_each("ply", [&](const World& world) { return PlyText(world, colours); });
  add_each("gltf", [&](const World& world) {
    return files.at("gltf").extension() == ".glb" ? GlbBytes(world, colours)
                                                  : GltfText(world, colours);
  });
  add("coco", CocoResultsText);
  add("coco_dataset", [&](const std::vector<World>& all) {
    return CocoDatasetText(all,
                           options.truth ? CocoAnnotations::kVisibleBoxes : CocoAnnotations::kNone);
  });
  add("csv", LandmarksCsvText);
  add_each("boxes", BoxesCsvText);
  const fs::path images = FolderOfImages(worlds);
  for (const World& world : worlds) {
    if (!HasImage(world)) continue;
    if (files.contains("colmap")) {
      const fs::path folder = path_of("colmap", world);
      const ColmapTexts texts = ColmapModelTexts(world, images);
      outputs.push_back({folder / "cameras.txt", texts.cameras});
      outputs.push_back({folder / "images.txt", texts.images});
      outputs.push_back({folder / "points3D.txt", texts.points3D});
    }
    if (files.contains("transforms")) {
      const fs::path file = path_of("transforms", world);
      // The dataset folder as seen from that of the file; empty if it is not known.
      const auto dataset = files.find("dataset");
      const fs::path seen = dataset == files.end()
                                ? fs::path()
                                : fs::relative(dataset->second, PlainPath(file).parent_path());
      outputs.push_back({file, TransformsText(world, seen)});
    }
  }
  return outputs;
}

// Throws NothingUsableError if there is nothing of what is asked for.
void CheckWorlds(const std::vector<World>& worlds, const StageFiles& files) {
  const std::string sequence = files.at("sequence").string();
  const auto any = [&](const auto& has) { return std::ranges::any_of(worlds, has); };
  if (files.contains("trajectory") &&
      !any([](const World& world) { return !world.frames.empty(); })) {
    throw NothingUsableError(sequence + ": has no poses of this kind");
  }
  const bool needs_images =
      files.contains("colmap") || files.contains("transforms") || files.contains("overlays");
  if (needs_images && !any(HasImage)) {
    throw NothingUsableError(sequence + ": has no frame with an image and a pose of this kind");
  }
  const bool has_landmark = any([](const World& world) {
    return std::ranges::any_of(world.objects, [](const WorldObject& object) {
      return object.estimate.landmark_in_world.has_value();
    });
  });
  if (!OnlyPoses(files) && !has_landmark) {
    throw NothingUsableError(files.at(files.contains("map") ? "map" : "sequence").string() +
                             ": has no landmarks of this kind");
  }
}

// A frame of a world and its image.
struct PlacedImage {
  FrameImage image;
  const World* world;
  const WorldFrame* frame;
};

// All images of frames that have a pose, in the order of the sequence.
std::vector<PlacedImage> PlacedImages(const Sequence& sequence, const StageFiles& files,
                                      const std::vector<World>& worlds) {
  std::map<int, std::pair<const World*, const WorldFrame*>> places;  // by frame id
  for (const World& world : worlds) {
    for (const WorldFrame& frame : world.frames) places[frame.id] = {&world, &frame};
  }
  std::vector<PlacedImage> placed;
  for (const FrameImage& image : FrameImages(sequence, files.at("dataset"), files.at("sequence"))) {
    const auto place = places.find(image.frame->id);
    if (place == places.end()) continue;
    placed.push_back({image, place->second.first, place->second.second});
  }
  return placed;
}

// Gives the points the mean colour of their pixels.
void ColourPoints(const Sequence& sequence, const StageFiles& files, int threads,
                  std::vector<World>* worlds) {
  const std::vector<PlacedImage> images = PlacedImages(sequence, files, *worlds);
  std::map<int, size_t> image_of_frame;  // by frame id
  for (size_t i = 0; i < images.size(); ++i) image_of_frame[images[i].frame->id] = i;
  struct Sample {
    WorldPoint* point;
    Eigen::Vector2d pixel;
    cv::Vec3b bgr;
  };
  std::vector<std::vector<Sample>> samples(images.size());
  for (World& world : *worlds) {
    for (WorldPoint& point : world.points) {
      for (const PointObservation& observation : point.observations) {
        const auto image = image_of_frame.find(observation.frame_id);
        if (image == image_of_frame.end()) continue;
        samples[image->second].push_back({&point, observation.pixel, {}});
      }
    }
  }
  ParallelFor("images", images.size(), threads, [&](size_t i) {
    if (samples[i].empty()) return;
    const Camera& camera = images[i].frame->camera;
    const cv::Mat image =
        ReadImage(images[i].image.path, cv::IMREAD_COLOR, sequence.image_orientation,
                  cv::Size(camera.width, camera.height));
    for (Sample& sample : samples[i]) {
      const int x = std::clamp(static_cast<int>(std::lround(sample.pixel.x())), 0, image.cols - 1);
      const int y = std::clamp(static_cast<int>(std::lround(sample.pixel.y())), 0, image.rows - 1);
      sample.bgr = image.at<cv::Vec3b>(y, x);
    }
  });
  std::map<WorldPoint*, std::pair<cv::Vec3i, int>> sums;
  for (const auto& of_image : samples) {
    for (const Sample& sample : of_image) {
      auto& [sum, count] = sums[sample.point];
      sum += cv::Vec3i(sample.bgr);
      ++count;
    }
  }
  for (const auto& [point, of_point] : sums) {
    const auto& [sum, count] = of_point;
    point->rgb = {sum[2] / count, sum[1] / count, sum[0] / count};
  }
}

// Writes each image with the bodies of its world as a JPEG file into folder "overlays", in the size
// of DrawingGround, without lens distortion. It has the name of the image within FolderOfImages,
// with .jpg as extension, which is appended where two images differ by theirs alone. Returns the
// number of files.
size_t WriteOverlays(const Sequence& sequence, const std::vector<World>& worlds,
                     const StageFiles& files, int threads) {
  const std::vector<PlacedImage> images = PlacedImages(sequence, files, worlds);
  const fs::path folder = FolderOfImages(worlds);
  std::set<fs::path> jpegs;
  for (const PlacedImage& placed : images) {
    jpegs.insert(fs::path(placed.frame->image).replace_extension(".jpg"));
  }
  const FrameImageReader reader(sequence);
  MakeInOrder(
      "overlays", images.size(), threads,
      [&](size_t i) {
        const auto& [image, world, frame] = images[i];
        cv::Mat picture = DrawingGround(reader.Read(image, cv::IMREAD_COLOR));
        DrawOverlay(OverlayOfWorld(*world, *frame), &picture);
        constexpr int kJpegQuality = 90;
        std::vector<uchar> bytes;
        cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
        return bytes;
      },
      [&](size_t i, const std::vector<uchar>& bytes) {
        fs::path name = fs::path(images[i].frame->image).lexically_relative(folder);
        if (jpegs.size() == images.size()) {
          name.replace_extension(".jpg");
        } else {
          name += ".jpg";
        }
        const fs::path path = files.at("overlays") / name;
        fs::create_directories(path.parent_path());
        WriteTextFile(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
      });
  return images.size();
}

// Images that EXIF turns, of a sequence whose cameras are those of upright images: other programs
// read them as they are stored.
std::vector<Finding> CheckTurnedImages(const Sequence& sequence, const StageFiles& files) {
  if (sequence.image_orientation != ImageOrientation::kUpright) return {};
  const std::vector<FrameImage> images =
      FrameImages(sequence, files.at("dataset"), files.at("sequence"));
  const auto turned = std::ranges::count_if(images, [](const FrameImage& image) {
    const auto header = ReadImageHeader(image.path);
    return header && header->orientation != 1;
  });
  if (turned == 0) return {};
  return {{"turned_images", Severity::kWarning,
           fmt::format("{} of {} images are turned by EXIF; cameras and poses are those of upright "
                       "images",
                       turned, images.size()),
           "images without a note in EXIF by which they are turned",
           "photos of a telephone; COLMAP up to 3.12 and nerfstudio read them as they are stored",
           "turn copies of the files (exiftran -ai) before other programs read them"}};
}

}  // namespace

void RunExport(const ExportOptions& options, const StageFiles& files, int threads) {
  CheckFiles(options, files);
  const PlaneNeed need = OnlyPoses(files) ? PlaneNeed::kNotNeeded : PlaneNeed::kNeeded;
  const Sequence sequence = ReadSequence(files.at("sequence"), need);
  std::vector<World> worlds = ReadWorlds(sequence, options, files);
  CheckWorlds(worlds, files);
  if (files.contains("points")) {
    const std::vector<MapPoint> points = ReadCheckedPoints(sequence, files);
    AddPoints(sequence, points, &worlds);
    std::vector<double> errors_px;
    for (const World& world : worlds) {
      for (const WorldPoint& point : world.points) {
        errors_px.push_back(point.reprojection_error_px);
      }
    }
    const size_t placed = errors_px.size();
    const std::optional<double> median_px = MedianOf(errors_px);
    if (2 * placed < points.size() || !(median_px.value_or(0.0) <= kMaxMedianErrorPx)) {
      ReportFindings(
          "export",
          {{"points_and_poses", Severity::kWarning,
            fmt::format("{}: {} of {} points can be placed by the poses that are written, at a "
                        "median reprojection error of {:.1f} px",
                        files.at("points").string(), placed, points.size(),
                        median_px.value_or(0.0)),
            fmt::format("most of them, at less than {} px", kMaxMedianErrorPx),
            "points of other images, or poses that drift",
            "points that were made of these images"}});
    }
    if (files.contains("dataset")) ColourPoints(sequence, files, threads, &worlds);
  }
  // Other programs may read images as they are stored, where EXIF turns them.
  if (files.contains("dataset") && (files.contains("colmap") || files.contains("transforms"))) {
    ReportFindings("export", CheckTurnedImages(sequence, files));
  }
  const std::vector<Output> outputs = MakeOutputs(worlds, options, files);
  if (files.contains("overlays")) {
    const size_t count = WriteOverlays(sequence, worlds, files, threads);
    fmt::print("{}: {}\n", files.at("overlays").string(), Counted(count, "image"));
  }
  for (const Output& output : outputs) {
    std::error_code ignored;  // writing says what is wrong
    fs::create_directories(output.path.parent_path(), ignored);
    WriteTextFile(output.path, output.bytes);
    fmt::print("{}\n", output.path.string());
  }
}

}  // namespace soslam
