// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <utility>
#include <vector>

#include "soslam/base/options.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/image/feature_tracks.h"

namespace soslam {

struct MatchOptions {
  int max_features = 2000;
  double contrast_threshold = 0.02;
  double max_epipolar_px = 3.0;
  double max_descriptor_distance = 0.7;
  double max_ratio = 0.85;
  double max_reprojection_error_px = 5.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Features");
    visit.Integer("max_features", &max_features, {1, 1000000},
                  "features of each image, those with the highest contrast");
    visit.Real("contrast_threshold", &contrast_threshold, {1e-6, 1.0},
               "lowest contrast of a feature, as a fraction of the grey values' range");
    visit.Group("Matches");
    visit.Real(
        "max_epipolar_px", &max_epipolar_px, {0.1, 1000.0},
        "largest distance of a feature from the epipolar line of the one that it matches, in "
        "both images; from where the rotation moves that one, if the camera only turns");
    visit.Real("max_descriptor_distance", &max_descriptor_distance, {0.01, 1.5},
               "largest distance between the descriptors of a match, unit vectors");
    visit.Real("max_ratio", &max_ratio, {0.01, 1.0},
               "largest descriptor distance of a match, as a fraction of that of the next best "
               "feature elsewhere in the same image");
    visit.Group("Tracks");
    visit.Real("max_reprojection_error_px", &max_reprojection_error_px, {0.1, 1e6},
               "two tracks are not joined if a pixel would be further from the projection of the "
               "point that fits all of them");
  }
};

// Features of one image by the scale-invariant feature transform (SIFT).
struct ImageFeatures {
  // Square roots of the shares of a histogram of gradients (RootSIFT), times kDescriptorScale: a
  // unit vector in bytes. The few shares above (255 / 512)^2 are cut.
  using Descriptors = Eigen::Matrix<std::uint8_t, 128, Eigen::Dynamic>;
  static constexpr float kDescriptorScale = 512.0F;

  Eigen::Matrix2Xd pixels;  // one column per feature; features of one pixel are neighbours
  Descriptors descriptors;
};

ImageFeatures FindFeatures(const cv::Mat& grey, const MatchOptions& options);

// Features of an image without lens distortion, and the camera that took it.
struct FeatureView {
  Camera camera;
  Rigid3d world_from_camera;
  ImageFeatures features;
};

// Indices of two features that show the same point, and the distance between their descriptors.
struct FeatureMatch {
  int first;
  int second;
  float distance;
};

// Matches between two views of a static scene, by the first view's features. They lie on each
// other's epipolar lines and meet in front of both cameras, or at infinity; each is the best match
// of the other, and no feature elsewhere in its image is nearly as good.
std::vector<FeatureMatch> MatchFeatures(const FeatureView& first, const FeatureView& second,
                                        const MatchOptions& options);

// Pairs of images to be matched, by their positions in a list with the segment of each image.
std::vector<std::pair<int, int>> ImagePairs(const std::vector<int>& segments);

// Tracks of at least two images, by first image, then feature: matches joined in the order of their
// descriptor distances, unless a track would then have two pixels of an image, or pixels that no
// one point explains. `matches` has those of each pair of views.
std::vector<FeatureTrack> JoinMatches(const std::vector<FeatureView>& views,
                                      const std::vector<std::pair<int, int>>& pairs,
                                      const std::vector<std::vector<FeatureMatch>>& matches,
                                      const MatchOptions& options);

}  // namespace soslam
