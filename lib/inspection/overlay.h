// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "geometry/box.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "inspection/canvas.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// What is drawn over one frame's image. Everything is in the frame of its camera.
struct OverlayInput {
  struct DetectedBox {
    Box box;
    std::string caption;
  };
  struct Body {
    Landmark landmark_in_camera;
    std::string caption;  // empty where the detection has it
  };
  struct Ground {
    Plane plane_in_camera;
    std::vector<Eigen::Vector3d> feet_in_camera;  // on the plane: a grid is drawn around them
  };

  Camera camera = {};
  std::vector<Ground> grounds = {};
  std::vector<Landmark> truths_in_camera = {};
  std::vector<DetectedBox> detections = {};
  std::vector<Body> landmarks = {};
};

// What a frame of the sequence says: its detections, the ground truth of what was detected, and the
// support planes below.
OverlayInput OverlayOfFrame(const Sequence& sequence, int frame_index);

// The same, and the landmarks of the frame's observations: the best hypothesis of each; or where
// there are no estimates from single frames, those of the objects that are in the image, seen from
// the estimated pose.
OverlayInput OverlayOfLandmarks(const Sequence& sequence, const LandmarkEstimates& estimates,
                                int frame_index);

// The same, and the landmarks of the map that are in the image, with poses and planes of the map.
OverlayInput OverlayOfMap(const Sequence& sequence, const MapEstimate& map, int frame_index);

// Draws on `image`, CV_8UC3, what the camera of `input` sees, of its size or a whole multiple of it
// (see DrawingGround): detections as boxes, landmarks by their outline and axes, the ground truth
// as boxes circumscribed about it, as for IoU, support planes as grids. An arrow is a body's front.
void DrawOverlay(const OverlayInput& input, cv::Mat* image);

// What DrawOverlay draws, for WithCaption.
std::vector<CaptionEntry> OverlayLegend(const OverlayInput& input);

}  // namespace soslam
