// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "soslam/cli/command_line.h"
#include "soslam/constraints/point_cost.h"
#include "soslam/image/edge_maps.h"
#include "soslam/image/read_image.h"
#include "soslam/model/map_points.h"
#include "soslam/model/sequence.h"
#include "soslam/planes/up_prior.h"

namespace soslam {

// Edge maps of a frame. Thread-safe. Throws InputError when the frame is missing, or its maps are
// not of its camera's size, as those of other images.
using EdgeSource = std::function<EdgeMaps(const Frame&)>;
// The edge maps in file "edges". Both arguments must outlive what is returned.
EdgeSource EdgesOfSequence(const Sequence& sequence, const StageFiles& files);

// Throws SettingsError if points are to be used and no file "points" is given.
void CheckHasPoints(const PointOptions& options, const StageFiles& files);

// The file "points". Throws InputError if the frames of the sequence see none of them, as of points
// of another dataset, which would silently be no evidence. A file without points is no error:
// soslam-track has warned of it.
std::vector<MapPoint> ReadCheckedPoints(const Sequence& sequence, const StageFiles& files);

// Gives the detections the parts of file "appearance" that are asked for, and adds it to `inputs`.
// Throws SettingsError without a file, InputError for one of another sequence, and as
// AddAppearance.
void AddPictureEvidence(const PictureOptions& asked, const StageFiles& files, Sequence* sequence,
                        std::vector<std::filesystem::path>* inputs);

// A frame of a sequence, which must outlive this, and the path of its image in the dataset folder.
struct FrameImage {
  const Frame* frame;
  std::filesystem::path path;
};

// All frames that have an image in the folder `dataset`, in order. `sequence_file` is for messages.
// Throws InputError for a path that leaves the folder, NothingUsableError when no frame has an
// image.
std::vector<FrameImage> FrameImages(const Sequence& sequence, const std::filesystem::path& dataset,
                                    const std::filesystem::path& sequence_file);

// Reads undistorted images for the cameras of a sequence, which must outlive it.
class FrameImageReader {
 public:
  explicit FrameImageReader(const Sequence& sequence);
  // The image in a mode of ReadImage, of the camera's size. Thread-safe. Throws InputError, also
  // when the file has another size.
  cv::Mat Read(const FrameImage& image, int mode) const;

 private:
  const Sequence& sequence_;
  std::optional<ImageUndistorter> undistorter_;
};

// Line segments in the images of folder "dataset", per frame; none if vertical edges are not used
// or no frame has an image. The images are added to `inputs`. Throws SettingsError without a
// folder.
std::vector<SegmentView> ViewsOfSegments(const Sequence& sequence, const VerticalOptions& options,
                                         const StageFiles& files, int threads,
                                         std::vector<std::filesystem::path>* inputs);

// Sets the scene axes of a sequence's planes from images of the dataset folder, if the sequence has
// one world. Images that are missing or damaged are left out. Those read are added to `inputs`.
void AddSceneAxes(const std::filesystem::path& folder, int threads, Sequence* sequence,
                  std::vector<std::filesystem::path>* inputs);

}  // namespace soslam
