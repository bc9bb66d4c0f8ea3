// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "soslam/artefact/files.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/inspection/projection.h"
#include "soslam/model/associations.h"
#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"
#include "soslam/report/results_tree.h"

namespace soslam {

// The images of frames (indices into Sequence::frames) in colour, undistorted. `read` throws
// InputError for damaged images.
struct ImageSource {
  std::function<bool(int frame_index)> has;
  std::function<cv::Mat(int frame_index)> read;  // only for frames that have an image
};

// JPEG files in base 64, by frame.
struct EncodedImages {
  struct Image {
    int frame_index;
    std::string base64;
  };
  std::vector<Image> images;
  int scaled_to_px = 0;  // the width; 0 if there was room for the largest
  size_t left_out = 0;   // number of readable images that were left out for lack of room
  std::vector<std::string> failures;  // why other images cannot be read
};

// The images of those frames that have one, in at most max_bytes: scaled down, all alike, as far as
// necessary. If that is not enough, only some of them, evenly spaced.
EncodedImages EncodeImages(const std::vector<int>& frames, const ImageSource& source,
                           size_t max_bytes, int threads);

// A part of a frame's image with the outline of something.
struct Picture {
  int frame_index = 0;
  cv::Rect part = {};     // of the image, px
  Polygon outline = {};   // px of the image
  bool is_body = false;   // the outline is that of a landmark, not a box
  std::string jpeg = {};  // base 64; empty where there is none
};

// A box with what is around it, no flatter or slimmer than a picture should be.
Picture PictureOfBox(int frame_index, const Box& box, const Camera& camera);

// Cuts the pictures out of their images, each of which is read once, at most max_px wide and high.
// Pictures that are empty, or of frames whose image cannot be read, remain without.
void AddJpegs(const std::vector<Picture*>& pictures, int max_px, const ImageSource& source,
              int threads);

// The picture, or its outline alone, as HTML. `name`: for people who do not see it; `id`: of the
// element that others can show as well, none if empty.
std::string PictureSvg(const Picture& picture, const std::string& name, const std::string& id);

// A map's statements about an object, in words.

// The scale of a map's world.
struct ScaleOfMap {
  bool in_metres = true;
  double log_sigma = 0.0;     // standard deviation of the logarithm of the scale; 0: exact
  std::string sentence = {};  // empty where scale and up are given
  std::string warning = {};   // what contradicts scale and up, if anything
  bool up_is_in_doubt = false;
};

// `world`: world.json, or null without it.
ScaleOfMap ScaleFromWorld(const std::optional<Artefact<WorldReport>>& world,
                          const Sequence& sequence);

// Width, depth and height with their 95 % intervals: "52 × 61 × 86 cm (± 5 × 6 × 8)". The
// covariance of a map is for the scale that it has; the error of the scale is independent.
std::string SizeInWords(const ObjectEstimate& estimate, const ScaleOfMap& scale);

// "chair 62 %, or sofa 21 %": its label first, then alternatives of at least 10 %; empty where the
// label is certain. An object has a label that a box has; where another one is more probable by its
// size, this is said.
std::string LabelsInWords(const Object& object);

// Least cosine of the angle between up and the normal of a plane that is no wall.
inline constexpr double kLevel = 0.7;

// "on the floor", "on its side, on plane 2, 72 cm above the floor", ... The lowest plane is called
// the floor if one of its objects is too tall for a table and up is not in doubt.
std::string SupportInWords(const ObjectEstimate& estimate, const Sequence& sequence,
                           const MapEstimate& map, const ScaleOfMap& scale);

// A box of something in a frame (index in Sequence::frames). `is_whole`: no edge is cut off, as far
// as that is known.
struct SeenBox {
  int frame_index = 0;
  Box box;
  bool is_whole = true;
};

std::vector<SeenBox> CollectBoxes(const Sequence& sequence, const std::vector<int>& detections);

// Something that was detected and has no landmark in the map.
struct NotPlaced {
  std::string label;
  std::vector<SeenBox> boxes;
  std::string reason;  // in words
};

// A detection of associations.json in the sequence that its stage wrote, or that later stages made
// of it. Throws InputError where that has no such frame.
SeenBox FindSeenBox(const Associations::DetectionName& name, const Sequence& sequence);

// The tracks that association left out, by associations.json. `sequence` as for FindSeenBox.
std::vector<NotPlaced> TracksLeftOut(const Associations& associations, const Sequence& sequence);

// Things without a landmark in a variant's folder, most boxes first: tracks that association
// left out, and objects without a landmark in the map.
std::vector<NotPlaced> CollectUnplaced(const std::filesystem::path& folder, const MapEstimate& map,
                                       const Sequence& sequence);

// The part of a sequence that is on a page, which must stay small however long the sequence is.
struct PageSelection {
  std::vector<int> frames;  // into Sequence::frames, ascending: the camera's path
  std::vector<int> shown;   // frames whose pixels are shown, ascending
  std::vector<int>
      detections;  // into Sequence::detections, ascending: all in frames that are shown

  bool Shows(int frame_index) const;
  // Positions in `frames` and `detections`, which must contain the argument.
  int PlaceOfFrame(int frame_index) const;
  int PlaceOfDetection(int detection_index) const;
};

// The ids of at most kMaxShownFrames frames, evenly spaced among those with an image or, if there
// are no images, among all; if these are too many, only those with detections are considered.
inline constexpr size_t kMaxShownFrames = 60;
std::set<int> FramesToShow(const Sequence& sequence,
                           const std::function<bool(int frame_index)>& has_image);

// Shows the frames with these ids. The camera's path has them, and up to kMaxWayFrames frames
// evenly spaced over all.
inline constexpr size_t kMaxWayFrames = 1000;
PageSelection SelectForPage(const Sequence& sequence, const std::set<int>& shown_ids);

// The data of a sequence on a page, whatever the method. Frames and detections are the selected
// ones, and indices refer to these lists:
//   counts: frames, objects, detections of the whole sequence
//   frames: id, timestamp, segment, width, height, pose (odometry) and true_pose or null, shown;
//     of those shown grid: see PageGridInFrame
//   objects: id, label, segment (null if unknown), plane (index or null), truth (landmark or null)
//   detections: frame and object (indices), box, truth (outline or null); the truth is the cuboid
//     around the object, with which estimates are compared
//   planes: see PageGrids
//   segments: up, a direction of the world. Frames and objects have the index of theirs
//   rejected: reason in words -> detections that were not used
nlohmann::json PageSequence(const Sequence& sequence, const PageSelection& selection);

// Short forms for pages, to keep them small. Lengths are rounded to a tenth of a millimetre, pixels
// to a tenth, other numbers to five significant digits. Numbers that are not finite become null.

std::optional<double> OnPage(double value);
nlohmann::json PageNumber(double value);
nlohmann::json PageNumbers(const std::vector<double>& values);
nlohmann::json PageVector(const Eigen::Vector3d& metres);
// [x, y, z, qx, qy, qz, qw]
nlohmann::json PagePose(const Rigid3d& pose);
// {"pose": world_from_object, "half_axes": [a, b, c], "p": shape exponents}
nlohmann::json PageLandmark(const Landmark& landmark_in_world);
// [x, y, x, y, ...] px
nlohmann::json PagePixels(const std::vector<Eigen::Vector2d>& pixels);
// {"outline": pixels, "axes": pixels of ProjectedAxes or null}
nlohmann::json PageOutline(const Camera& camera, const Landmark& landmark_in_camera);

// The lines of a grid on each of Sequence::planes, in the world; none for planes without objects.
using PlaneGrids = std::vector<std::vector<LineSegment3>>;

// Grids on the sequence's planes, around true centres if they are known, else around the contact
// points that its cameras see.
PlaneGrids GridsOfSequence(const Sequence& sequence);
// Grids on the map's planes, around its landmarks.
PlaneGrids GridsOfMap(const MapEstimate& map, const Sequence& sequence);

// Lines [x, y, z, x, y, z] in the world, by plane.
nlohmann::json PageGrids(const PlaneGrids& grids);

// The part of the grids that a frame's camera sees on the planes of its detections: lines as pixels
// [x, y, x, y]. The pose of the camera may depend on the detection.
nlohmann::json PageGridInFrame(
    const Sequence& sequence, int frame_index, const PlaneGrids& grids,
    const std::function<Rigid3d(const Detection&)>& camera_from_world_for);

// The camera pose (camera_from_world) from which the sequence's own planes are drawn for a
// detection: for given planes the true pose if it is known; for estimated planes the pose that
// moves the plane to the detection's plane_in_camera, with which odometry need not agree.
Rigid3d CameraAbovePlane(const Sequence& sequence, const Detection& detection);

// The source of a variant's landmarks: a back end, all frames without one, or each observation.
enum class VariantKind { kMap, kViews, kFrames };
inline constexpr std::array kVariantKindNames = {"map", "views", "frames"};
inline constexpr const auto& NamesOf(VariantKind) { return kVariantKindNames; }

// A variant with metrics on a page.
struct PageVariant {
  std::string name;
  Metrics metrics;  // with ids for indices
  VariantKind kind = VariantKind::kMap;
  size_t sequence = 0;                  // index of the variant's own
  std::optional<size_t> symmetry = {};  // index of its curves
  // One for each object; of single frames the first observations.
  std::vector<ObjectEstimate> objects = {};
  std::optional<SolverSummary> solver = {};
  bool numbers_only = false;  // there was no room for objects, solver and data
  // For scripts:
  //   objects: landmark in the world or null, failure in words, observations; with a covariance
  //   also
  //     centre_covariance (3 x 3, m^2), sigma_centre (m), sigma_log_half_axes, sigma_yaw_deg;
  //     quarter_turn: ObjectEstimate::quarter_turn, where known; front: probability and is_known,
  //     where there is a front_probability
  //   outlines, one per detection that is selected: see PageOutline, or null; with the probability
  //     of the front where that is known
  //   trajectory: poses of the map for the selected frames; solver: iterations, costs, and the
  //     counts of residuals used and left out
  //   planes: those of the map, see PageGrids, and grids, by selected frame, see PageGridInFrame;
  //     both null if they are the sequence's
  //   truth: in the map's world true objects (segment, landmark), and true poses of the selected
  //     frames (segment, pose); null where that is the true one
  //   points: by selected detection the image points of the object's points, [x, y, responsibility
  //     in %, ...], or null; null without any. Of objects that have some: their count, and
  //     of_object, the sum of their responsibilities
  nlohmann::json data = {};
};

// Throws InputError when a file that the variant should have is missing or not valid. `sequence` is
// the variant's own.
PageVariant ReadPageVariant(const VariantResult& result, const Sequence& sequence,
                            const PageSelection& selection);

// Cost over yaw of up to kCurvesPerObject observations of each object, evenly spaced among the
// selected ones: detection (index into the selected ones); yaw_deg: the grid; cost: by name;
// true_yaw_deg, initial_yaw_deg, refined_yaw_deg, yaw_sigma_deg or null; pairs: up to kPairsOfCurve
// pixels with their mirror pixels [x, y, x, y].
inline constexpr size_t kCurvesPerObject = 3;
inline constexpr size_t kPairsOfCurve = 120;
nlohmann::json PageCurves(const std::vector<SymmetryRecord>& records, const Sequence& sequence,
                          const PageSelection& selection);

// Accuracy of each cost's yaw modulo half a turn, over all observations with ground truth, by name:
// observations; median_error_deg of its lowest minimum; within: the fraction of them with an error
// of at most 0, kErrorStepDeg, 2 kErrorStepDeg, ... 90 degrees; known_at_truth: the fraction with a
// cost at the true yaw; near_where_known: of those the fraction with an error of at most 10
// degrees, or null; minima: mean number of local minima over half a turn. Empty without ground
// truth.
inline constexpr int kErrorStepDeg = 5;
nlohmann::json PageDescriptors(const std::vector<SymmetryRecord>& records);

// The first section of a dataset's page, as HTML without scripts: the map of the variant in this
// folder from above, its objects with pictures, what was seen but not placed, and photos without a
// pose; empty where that has no room in `max_bytes`. Throws InputError for files that are not
// valid.
std::string MapSection(const std::string& title, const std::filesystem::path& folder,
                       const Sequence& sequence, const ImageSource& images, size_t max_bytes,
                       int threads);

// The section of a dataset's page with all boxes of each object that association found in this
// variant's folder, as HTML without scripts: crops, those that were not used marked, with the text
// that names a box. Of objects with many boxes some are shown, fewer where `max_bytes` demand it.
// Empty where ids were not estimated, or there is no room. Throws InputError.
std::string BoxesSection(const std::filesystem::path& folder, const Sequence& sequence,
                         const ImageSource& images, size_t max_bytes, int threads);

}  // namespace soslam
