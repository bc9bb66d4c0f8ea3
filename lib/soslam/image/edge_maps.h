// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "soslam/base/options.h"

namespace soslam {

// The nearest edge pixel u^E of each pixel, eq. (20), exact: CV_16SC2, (x, y). Of several at the
// same distance it is the leftmost, and in a column the upper one. (-1, -1) everywhere when there
// is no edge. `edges` is CV_8UC1, not 0 on edge pixels, with at most 32767 pixels a side.
cv::Mat NearestEdgeMap(const cv::Mat& edges);

// Distance (px) from each pixel to its entry in such a map, eq. (17): CV_32FC1; infinite where
// there is no edge.
cv::Mat DistanceMap(const cv::Mat& nearest_edge);

struct EdgesOptions {
  double blur_sigma_px = 1.0;
  double canny_low = 50.0;
  double canny_high = 150.0;
  int max_corners = 2000;
  double corner_quality = 0.01;
  double corner_min_distance_px = 4.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Edges");
    visit.Real("blur_sigma_px", &blur_sigma_px, {0, 100},
               "Gaussian blur before edges and corners are detected; 0 for none");
    visit.Real("canny_low", &canny_low, {0, 1e4},
               "Canny: gradient that continues an edge (3 x 3 Sobel, grey values 0 to 255)");
    visit.Real("canny_high", &canny_high, {0, 1e4},
               "Canny: gradient that starts an edge; not below canny_low");
    visit.Group("Corners");
    visit.Integer("max_corners", &max_corners, {1, 1e6}, "Corners kept per image, strongest first");
    visit.Real("corner_quality", &corner_quality, {1e-6, 1},
               "Weakest corner kept, as a fraction of the strongest one's smaller eigenvalue");
    visit.Real("corner_min_distance_px", &corner_min_distance_px, {0, 1e4},
               "Smallest distance between two corners");
  }
  // Throws SettingsError when canny_low is above canny_high.
  void Check() const;
};

// Data of one image for the symmetry descriptors. All maps have the image's size. Without any
// edge every nearest edge is (-1, -1) and every distance infinite.
struct EdgeMaps {
  cv::Mat grey;          // CV_8UC1
  cv::Mat edges;         // CV_8UC1: 255 on an edge pixel, 0 elsewhere
  cv::Mat distance;      // CV_32FC1, px: distance to the nearest edge pixel, eq. (17)
  cv::Mat nearest_edge;  // CV_16SC2: (x, y) of that pixel, u^E of eq. (20)
  std::vector<Eigen::Vector2f> corners;  // pixels, strongest first
};

// `grey` is CV_8UC1 and not empty.
EdgeMaps ComputeEdgeMaps(const cv::Mat& grey, const EdgesOptions& options);

// The edge pixel nearest to the centre of the pixel that `pixel` lies in. None outside the image,
// and when the image has no edges.
std::optional<Eigen::Vector2d> NearestEdge(const EdgeMaps& maps, const Eigen::Vector2d& pixel);

// A straight edge in an image, pixels.
struct LineSegment {
  Eigen::Vector2d begin;
  Eigen::Vector2d end;
};

// The straight edges of a grey image (CV_8UC1) that are at least this long (px): the line segment
// detector of Grompone von Gioi et al. (2010).
std::vector<LineSegment> FindLineSegments(const cv::Mat& grey, double min_length_px);

struct Sample {
  double value;
  Eigen::Vector2d gradient;  // d value / d pixel, of the bilinear patch (one-sided on its border)
};

// Bilinear interpolation of a CV_8UC1 or CV_32FC1 map. Domain: [0, width - 1] x [0, height - 1] of
// maps of at least 2 x 2 pixels; none outside it (no clamping, which would have zero gradients),
// and none where one of the four pixels around is not finite.
std::optional<Sample> SampleBilinear(const cv::Mat& map, const Eigen::Vector2d& pixel);
// True if a pixel is in that domain, whatever the map's values.
bool IsBetweenPixelCentres(const cv::Mat& map, const Eigen::Vector2d& pixel);

}  // namespace soslam
