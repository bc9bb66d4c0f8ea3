// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

#include "soslam/base/options.h"

namespace soslam {

struct FeatureTrackOptions {
  int max_features = 2000;
  double feature_quality = 0.01;
  double feature_distance_px = 6.0;
  int window_px = 11;
  int pyramid_levels = 4;
  double return_error_px = 1.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Features and tracks");
    visit.Integer("max_features", &max_features, {1, 1000000}, "features followed in each image");
    visit.Real("feature_quality", &feature_quality, {1e-6, 1.0},
               "weakest feature, as a fraction of the strongest one's smaller eigenvalue");
    visit.Real("feature_distance_px", &feature_distance_px, {1.0, 1e4},
               "smallest distance between two features of an image");
    visit.Integer("window_px", &window_px, {5, 101}, "side of the window that is followed");
    visit.Integer("pyramid_levels", &pyramid_levels, {0, 10},
                  "halvings of the image in which large motions are found");
    visit.Real("return_error_px", &return_error_px, {0.01, 100.0},
               "a feature is lost if following it back misses its place by more than this");
  }
};

// Image points of one feature. `image` counts the images that were added.
struct FeatureTrack {
  struct Place {
    int image;
    Eigen::Vector2d pixel;
  };
  std::vector<Place> places;
};

// Follows corners from image to image (Lucas and Kanade's method on pyramids), and looks for new
// ones where none is followed.
class FeatureTracker {
 public:
  explicit FeatureTracker(const FeatureTrackOptions& options) : options_(options) {}

  // The next image, CV_8UC1 and of the size of the one before. Features are looked for about where
  // the homography `pixel_from_last_pixel` moves them, such as that of the camera's rotation; there
  // are none where the mask, CV_8UC1, is 0.
  void Add(const cv::Mat& grey,
           const Eigen::Matrix3d& pixel_from_last_pixel = Eigen::Matrix3d::Identity(),
           const cv::Mat& mask = cv::Mat());
  // The next image has nothing in common with those before, and may have another size.
  void Cut();
  // All tracks over at least two images, in order of their first image.
  std::vector<FeatureTrack> Tracks() const;

 private:
  void Follow(const std::vector<cv::Mat>& pyramid, const Eigen::Matrix3d& pixel_from_last_pixel,
              const cv::Mat& mask);
  void Detect(const cv::Mat& grey, const cv::Mat& mask);

  FeatureTrackOptions options_;
  int images_ = 0;
  std::vector<FeatureTrack> tracks_;
  std::vector<cv::Mat> last_pyramid_;
  // Features in the last image, and their tracks.
  std::vector<cv::Point2f> last_points_;
  std::vector<size_t> last_tracks_;
};

struct TrackOptions {
  FeatureTrackOptions features;
  int min_views = 3;
  double max_reprojection_error_px = 3.0;
  double min_angle_deg = 1.5;

  void Describe(OptionVisitor& visit) {
    features.Describe(visit);
    visit.Group("Points");
    visit.Integer("min_views", &min_views, {2, 1000}, "fewest images that a point is seen in");
    visit.Real("max_reprojection_error_px", &max_reprojection_error_px, {0.1, 1000.0},
               "an image point further from its point's projection is left out");
    visit.Real("min_angle_deg", &min_angle_deg, {0.01, 90.0},
               "smallest angle at a point between the directions to two cameras");
  }
};

}  // namespace soslam
