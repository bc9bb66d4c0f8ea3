// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/frame_choice.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "soslam/base/upper_median.h"

namespace soslam {

cv::Size SizeWithin(const cv::Size& size, int longer_side) {
  const double scale = static_cast<double>(longer_side) / std::max(size.width, size.height);
  if (scale >= 1.0) return size;
  return {std::max(1, cvRound(scale * size.width)), std::max(1, cvRound(scale * size.height))};
}

cv::Mat ScaledDown(const cv::Mat& image, int longer_side) {
  const cv::Size size = SizeWithin(image.size(), longer_side);
  if (size == image.size()) return image;
  cv::Mat scaled;
  cv::resize(image, scaled, size, 0, 0, cv::INTER_AREA);
  return scaled;
}

namespace {

using Points = cv::Mat_<cv::Point2f>;

// The points in the other image; `found` has a zero for those that are lost.
Points Track(const cv::Mat& from, const cv::Mat& to, const Points& points,
             std::vector<uchar>* found) {
  Points tracked;
  cv::calcOpticalFlowPyrLK(from, to, points, tracked, *found, cv::noArray(), {15, 15}, 3);
  return tracked;
}

}  // namespace

FrameView MakeFrameView(const cv::Mat& grey) {
  constexpr int kSharpnessSide = 640, kTrackingSide = 240;
  const cv::Mat medium = ScaledDown(grey, kSharpnessSide);
  cv::Mat laplacian;
  cv::Laplacian(medium, laplacian, CV_16S);
  cv::Scalar mean, deviation;
  cv::meanStdDev(laplacian, mean, deviation);
  return {deviation[0] * deviation[0], ScaledDown(medium, kTrackingSide).clone()};
}

MotionTracker::MotionTracker(const cv::Mat& small) : small_(small) {
  constexpr int kMaxFeatures = 200;
  constexpr double kQuality = 0.01, kMinDistancePx = 6.0;
  cv::goodFeaturesToTrack(small_, features_, kMaxFeatures, kQuality, kMinDistancePx);
}

std::optional<double> MotionTracker::MedianDisplacement(const cv::Mat& small) const {
  constexpr double kMaxReturnErrorPx = 1.0;
  if (features_.empty() || small.size() != small_.size()) return std::nullopt;
  std::vector<uchar> is_found, is_returned;
  const Points from = features_;
  const Points to = Track(small_, small, from, &is_found);
  const Points returned = Track(small, small_, to, &is_returned);
  std::vector<double> displacements;
  for (int i = 0; i < from.rows; ++i) {
    if (is_found[i] == 0 || is_returned[i] == 0) continue;
    if (cv::norm(returned(i) - from(i)) > kMaxReturnErrorPx) continue;
    displacements.push_back(cv::norm(to(i) - from(i)));
  }
  if (3 * displacements.size() < static_cast<size_t>(from.rows)) return std::nullopt;
  return UpperMedian(std::move(displacements)) / std::max(small_.cols, small_.rows);
}

void DistinctFrames::Add(FrameCandidate candidate) {
  const auto motion =
      begin_of_place_ ? begin_of_place_->MedianDisplacement(candidate.view.small) : std::nullopt;
  if (!motion || *motion >= min_motion_) {
    begin_of_place_.emplace(candidate.view.small);
    sharpest_.push_back(std::move(candidate));
  } else if (candidate.view.sharpness > sharpest_.back().view.sharpness) {
    sharpest_.back() = std::move(candidate);
  }
}

// Larger steps leave less of a camera that was held still by hand than equal parts would; equal
// parts then give the exact number.
std::vector<FrameCandidate> FrameSelector::Thinned(std::vector<FrameCandidate> candidates) const {
  constexpr double kFactor = 1.5, kMaxMotion = 0.5;
  const auto limit = static_cast<size_t>(options_.max_frames);
  if (candidates.size() <= limit) return candidates;
  for (double motion = std::max(options_.min_motion, 1e-3); motion < kMaxMotion;) {
    motion *= kFactor;
    DistinctFrames distinct(motion);
    for (const FrameCandidate& candidate : candidates) distinct.Add(candidate);
    if (distinct.sharpest().size() < limit) break;
    candidates = distinct.sharpest();
  }
  std::vector<FrameCandidate> thinned;
  for (size_t i = 0; i < limit; ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(i * candidates.size() / limit);
    const auto end = static_cast<std::ptrdiff_t>((i + 1) * candidates.size() / limit);
    thinned.push_back(*std::ranges::max_element(
        candidates.begin() + begin, candidates.begin() + end, {},
        [](const FrameCandidate& candidate) { return candidate.view.sharpness; }));
  }
  return thinned;
}

std::vector<std::optional<FrameRejection>> FrameSelector::Choose() const {
  std::vector<std::optional<FrameRejection>> reasons(count_, FrameRejection::kNoMotion);
  const std::vector<FrameCandidate>& distinct = distinct_.sharpest();
  constexpr size_t kNeighbours = 5;  // on each side
  std::vector<FrameCandidate> sharp;
  for (size_t i = 0; i < distinct.size(); ++i) {
    std::vector<double> around;
    const size_t end = std::min(distinct.size(), i + kNeighbours + 1);
    for (size_t j = i < kNeighbours ? 0 : i - kNeighbours; j < end; ++j) {
      around.push_back(distinct[j].view.sharpness);
    }
    const bool is_blurred =
        distinct[i].view.sharpness < options_.min_sharpness * UpperMedian(std::move(around));
    reasons[distinct[i].frame] = is_blurred ? FrameRejection::kBlurred : FrameRejection::kOverLimit;
    if (!is_blurred) sharp.push_back(distinct[i]);
  }
  for (const FrameCandidate& chosen : Thinned(std::move(sharp))) {
    reasons[chosen.frame] = std::nullopt;
  }
  return reasons;
}

}  // namespace soslam
