// SPDX-License-Identifier: BSD-3-Clause
// Covariances of the back end for what the edges in images say.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "image/edge_maps.h"
#include "orientation/model_edges.h"
#include "support/calibration.h"

namespace soslam::calibration {
namespace {

// The model that the edge term assumes: pieces of edges of one length, each off by an error of its
// own. Long against the errors, so that the nearest edge is a piece's own.
constexpr double kPiecePx = 25.0;
constexpr double kSigmaPx = 1.5;

// The visible edges of a body in pieces, each drawn to one side of where it is.
EdgeImage DisplacedEdges(const Camera& camera, const Landmark& landmark_in_camera) {
  EdgeMaps maps;
  maps.grey = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
  maps.edges = cv::Mat::zeros(camera.height, camera.width, CV_8UC1);
  constexpr int kFractionBits = 8;
  const auto to_image = [](const Eigen::Vector2d& pixel) {
    return cv::Point(static_cast<int>(std::lround(pixel.x() * (1 << kFractionBits))),
                     static_cast<int>(std::lround(pixel.y() * (1 << kFractionBits))));
  };
  for (const ModelPoint& point : VisibleModelPoints(camera, landmark_in_camera, kPiecePx)) {
    const auto pixel =
        camera.Project(landmark_in_camera.frame_from_object *
                       landmark_in_camera.half_axes.cwiseProduct(point.in_unit_body));
    const Eigen::Vector2d across(-point.along.y(), point.along.x());
    const Eigen::Vector2d middle = *pixel + Normal(kSigmaPx) * across;
    const Eigen::Vector2d half = 0.5 * kPiecePx * point.along;
    cv::line(maps.edges, to_image(middle - half), to_image(middle + half), cv::Scalar(255), 1,
             cv::LINE_8, kFractionBits);
  }
  maps.nearest_edge = NearestEdgeMap(maps.edges);
  maps.distance = DistanceMap(maps.nearest_edge);
  return {std::make_shared<const FrameEdges>(maps), *OutlineBox(camera, landmark_in_camera), {}};
}

EdgeImages DisplacedEdgesOfAllViews(const Truth& truth) {
  EdgeImages images;
  for (size_t i = 0; i < truth.world_from_camera.size(); ++i) {
    const Landmark in_camera =
        Transform(truth.world_from_camera[i].Inverse(), truth.landmark_in_world);
    images[static_cast<int>(i)] =
        std::make_shared<const EdgeImage>(DisplacedEdges(TestCamera(), in_camera));
  }
  return images;
}

// The edge_correlation_px with which each piece counts as one: the perimeter of a box for each
// piece of the edges in it, on average.
double PerimeterPerPiece() {
  double perimeters = 0.0;
  double pieces = 0.0;
  for (int i = 0; i < 50; ++i) {
    const Truth truth = RandomTruth(Case(), ModelOptions());
    for (const Rigid3d& world_from_camera : truth.world_from_camera) {
      const Landmark in_camera = Transform(world_from_camera.Inverse(), truth.landmark_in_world);
      const Box box = *OutlineBox(TestCamera(), in_camera);
      perimeters += 2.0 * (box.Width() + box.Height());
      pieces += static_cast<double>(VisibleModelPoints(TestCamera(), in_camera, kPiecePx).size());
    }
  }
  return perimeters / pieces;
}

TEST(EdgeCalibration, CovariancesAreHonestWherePiecesOfEdgesErrIndependently) {
  Case c;
  c.scenes = 100;
  c.edge_images = DisplacedEdgesOfAllViews;
  EdgeOptions& edges = c.assumed.edges;
  edges.edge_sigma_px = kSigmaPx;
  edges.edge_spacing_px = kPiecePx;
  edges.edge_correlation_px = PerimeterPerPiece();
  edges.edge_truncation_px = 20.0 * kSigmaPx;  // no outliers
  edges.edge_direction_tolerance_deg = 90.0;   // no grey values to take directions from
  ExpectHonest(MeanNees(c), c.scenes);
}

}  // namespace
}  // namespace soslam::calibration
