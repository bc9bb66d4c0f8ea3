// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/feature_tracks.h"

#include <algorithm>
#include <iterator>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace soslam {

void FeatureTracker::Add(const cv::Mat& grey, const Eigen::Matrix3d& pixel_from_last_pixel,
                         const cv::Mat& mask) {
  std::vector<cv::Mat> pyramid;
  cv::buildOpticalFlowPyramid(grey, pyramid, {options_.window_px, options_.window_px},
                              options_.pyramid_levels);
  if (!last_points_.empty()) Follow(pyramid, pixel_from_last_pixel, mask);
  Detect(grey, mask);
  last_pyramid_ = std::move(pyramid);
  ++images_;
}

void FeatureTracker::Cut() {
  last_points_.clear();
  last_tracks_.clear();
}

void FeatureTracker::Follow(const std::vector<cv::Mat>& pyramid,
                            const Eigen::Matrix3d& pixel_from_last_pixel, const cv::Mat& mask) {
  const cv::TermCriteria settled(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 30, 0.01);
  const cv::Size window(options_.window_px, options_.window_px);
  std::vector<cv::Point2f> forward;
  for (const cv::Point2f& point : last_points_) {
    const Eigen::Vector3d target = pixel_from_last_pixel * Eigen::Vector3d(point.x, point.y, 1.0);
    const bool is_in_front = target.z() > 0.0;
    forward.push_back(is_in_front ? cv::Point2f(static_cast<float>(target.x() / target.z()),
                                                static_cast<float>(target.y() / target.z()))
                                  : point);
  }
  std::vector<cv::Point2f> back = last_points_;
  std::vector<uchar> is_forward, is_back;
  cv::calcOpticalFlowPyrLK(last_pyramid_, pyramid, last_points_, forward, is_forward, cv::noArray(),
                           window, options_.pyramid_levels, settled, cv::OPTFLOW_USE_INITIAL_FLOW);
  cv::calcOpticalFlowPyrLK(pyramid, last_pyramid_, forward, back, is_back, cv::noArray(), window,
                           options_.pyramid_levels, settled, cv::OPTFLOW_USE_INITIAL_FLOW);
  const cv::Rect2f image(0.0F, 0.0F, static_cast<float>(pyramid.front().cols - 1),
                         static_cast<float>(pyramid.front().rows - 1));
  std::vector<cv::Point2f> points;
  std::vector<size_t> tracks;
  for (size_t i = 0; i < forward.size(); ++i) {
    const bool is_followed = is_forward[i] != 0 && is_back[i] != 0 &&
                             cv::norm(back[i] - last_points_[i]) <= options_.return_error_px;
    if (!is_followed || !image.contains(forward[i]) ||
        (!mask.empty() && mask.at<uchar>(cv::Point(forward[i])) == 0)) {
      continue;
    }
    points.push_back(forward[i]);
    tracks.push_back(last_tracks_[i]);
    tracks_[tracks.back()].places.push_back({images_, {forward[i].x, forward[i].y}});
  }
  last_points_ = std::move(points);
  last_tracks_ = std::move(tracks);
}

void FeatureTracker::Detect(const cv::Mat& grey, const cv::Mat& mask) {
  const int missing = options_.max_features - static_cast<int>(last_points_.size());
  if (missing <= 0) return;
  cv::Mat is_free = mask.empty() ? cv::Mat(grey.size(), CV_8UC1, cv::Scalar(255)) : mask.clone();
  for (const cv::Point2f& point : last_points_) {
    cv::circle(is_free, point, static_cast<int>(options_.feature_distance_px), cv::Scalar(0), -1);
  }
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(grey, corners, missing, options_.feature_quality,
                          options_.feature_distance_px, is_free);
  for (const cv::Point2f& corner : corners) {
    last_points_.push_back(corner);
    last_tracks_.push_back(tracks_.size());
    tracks_.push_back({{{images_, {corner.x, corner.y}}}});
  }
}

std::vector<FeatureTrack> FeatureTracker::Tracks() const {
  std::vector<FeatureTrack> tracks;
  std::ranges::copy_if(tracks_, std::back_inserter(tracks),
                       [](const FeatureTrack& track) { return track.places.size() > 1; });
  return tracks;
}

}  // namespace soslam
