// SPDX-License-Identifier: BSD-3-Clause
#include "image/line_segments.h"

#include <opencv2/imgproc.hpp>

namespace soslam {

std::vector<LineSegment> FindLineSegments(const cv::Mat& grey, double min_length_px) {
  std::vector<cv::Vec4f> found;
  cv::createLineSegmentDetector()->detect(grey, found);
  std::vector<LineSegment> segments;
  for (const cv::Vec4f& line : found) {
    const LineSegment segment{{line[0], line[1]}, {line[2], line[3]}};
    if ((segment.end - segment.begin).norm() >= min_length_px) segments.push_back(segment);
  }
  return segments;
}

}  // namespace soslam
