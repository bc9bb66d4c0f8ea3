// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/stage/export_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <string>
#include <utility>

#include "soslam/artefact/atomic_file.h"
#include "soslam/base/parallel.h"
#include "soslam/base/progress.h"
#include "soslam/image/image_format.h"
#include "soslam/image/read_image.h"
#include "soslam/inspection/canvas.h"
#include "soslam/inspection/overlay.h"
#include "soslam/stage/read_evidence.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

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

}  // namespace

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

size_t WriteOverlays(const Sequence& sequence, const std::vector<World>& worlds,
                     const StageFiles& files, int threads) {
  const std::vector<PlacedImage> images = PlacedImages(sequence, files, worlds);
  const fs::path folder = FolderOfImages(worlds);
  std::set<fs::path> jpegs;
  for (const PlacedImage& placed : images) {
    jpegs.insert(fs::path(placed.frame->image).replace_extension(".jpg"));
  }
  std::map<std::string, std::string> names;  // by image
  for (const PlacedImage& placed : images) {
    fs::path name = fs::path(placed.frame->image).lexically_relative(folder);
    if (jpegs.size() == images.size()) {
      name.replace_extension(".jpg");
    } else {
      name += ".jpg";
    }
    names[placed.frame->image] = name.string();
  }
  const FrameImageReader reader(sequence);
  Progress progress("overlays", static_cast<int>(images.size()));
  const size_t batch = 4 * static_cast<size_t>(threads);  // limits the pictures in memory
  for (size_t begin = 0; begin < images.size(); begin += batch) {
    std::vector<std::vector<uchar>> pictures(std::min(batch, images.size() - begin));
    ParallelFor(pictures.size(), threads, [&](size_t i) {
      const auto& [image, world, frame] = images[begin + i];
      cv::Mat picture = DrawingGround(reader.Read(image, cv::IMREAD_COLOR));
      DrawOverlay(OverlayOfWorld(*world, *frame), &picture);
      constexpr int kJpegQuality = 90;
      cv::imencode(".jpg", picture, pictures[i], {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
      progress.Step();
    });
    for (size_t i = 0; i < pictures.size(); ++i) {
      const fs::path path = files.at("overlays") / names.at(images[begin + i].frame->image);
      fs::create_directories(path.parent_path());
      WriteTextFile(path, {reinterpret_cast<const char*>(pictures[i].data()), pictures[i].size()});
    }
  }
  return images.size();
}

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

}  // namespace soslam
