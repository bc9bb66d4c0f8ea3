// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "soslam/exchange/world.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/image/edge_maps.h"
#include "soslam/inspection/canvas.h"
#include "soslam/model/estimates.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Items to draw over one frame's image. All are in the frame of its camera.
struct OverlayInput {
  struct DetectedBox {
    Box box;
    std::string caption;
  };
  struct Body {
    Landmark landmark_in_camera;
    std::string caption;             // empty if the detection has the caption
    std::string front_caption = {};  // empty unless its front is known
  };
  struct TrueBody {
    Landmark landmark_in_camera;
    bool may_have_front = true;  // GroundTruth::MayHaveFront
  };
  struct Ground {
    Plane plane_in_camera;
    std::vector<Eigen::Vector3d> feet_in_camera;  // contact points: a grid is drawn around them
  };

  Camera camera = {};
  std::vector<Ground> grounds = {};
  std::vector<TrueBody> truths_in_camera = {};
  std::vector<DetectedBox> detections = {};
  std::vector<Body> landmarks = {};
};

// The data of a frame of the sequence: its detections, the ground truth of the detected objects,
// and the support planes.
OverlayInput OverlayOfFrame(const Sequence& sequence, int frame_index);

// OverlayOfFrame with the landmarks of the frame's observations: the best hypothesis of each. If
// there are no single-frame estimates, the landmarks of the objects that are in the image, seen
// from the estimated pose.
OverlayInput OverlayOfLandmarks(const Sequence& sequence, const LandmarkEstimates& estimates,
                                int frame_index);

// OverlayOfFrame with the landmarks of the map that are in the image, and its poses and planes.
OverlayInput OverlayOfMap(const Sequence& sequence, const MapEstimate& map, int frame_index);

// The bodies of a world that are in the image of one of its frames, each with its caption.
OverlayInput OverlayOfWorld(const World& world, const WorldFrame& frame);

// Draws on `image` (CV_8UC3), which shows the view of `input`'s camera in its size or a whole
// multiple of it (see DrawingGround): detections as boxes, landmarks by their silhouette and axes,
// the ground truth as circumscribed boxes as for IoU, support planes as grids. The x axis of an
// estimate whose front is known, and of a true object that may have a front, is an arrow; other x
// axes are drawn both ways.
void DrawOverlay(const OverlayInput& input, cv::Mat* image);

// Legend of DrawOverlay, for WithCaption.
std::vector<CaptionEntry> OverlayLegend(const OverlayInput& input);

// Layers of a picture of a frame's edge maps.
enum class EdgeLayer { kAll, kGrey, kEdges, kDistance, kNearest };
inline constexpr std::array kEdgeLayerNames = {"all", "grey", "edges", "distance", "nearest"};

// One layer, or all of them side by side, in colour (CV_8UC3), each with a caption: the image with
// its corners; the edges; the distance transform, bright for large distances; the direction to the
// nearest edge as hue.
cv::Mat EdgesPicture(const EdgeMaps& maps, EdgeLayer layer, const std::string& title);

// The pixels that are used for symmetry and their mirror pixels, joined in pairs, on the part of
// `image` (CV_8UC1) around them.
cv::Mat SymmetryPicture(const SymmetryRecord& record, const cv::Mat& image,
                        const std::string& title);

}  // namespace soslam
